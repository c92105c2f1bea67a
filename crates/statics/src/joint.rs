//! A joint under a steady load: the moment that it carries at a rotation.

use mrbd_kernel::model::JointLaw;

/// A joint of width b along a strip of length L that carries N.
///
/// Without a bed its edges are sharp: it turns about one of them at once. A bed is a layer of springs of stiffness k
/// per area, linear, without tension. It touches over the whole width up to φ_c = 2N/(k L b²), and over
/// c = √(2N/(k L φ)) beyond. k → ∞ is the sharp edge. Its rivals have the laws of the wall that moves
/// ([`JointLaw`]), pushed further than ever before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joint {
    /// Width b between the rocking corners, m.
    pub width_m: f64,
    /// Load N, N.
    pub load_n: f64,
    gives: Gives,
}

/// How a joint gives.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Gives {
    /// About its sharp edges at once.
    Sharp,
    /// On a bed of this k L, N/m².
    Bed(f64),
    /// By another law.
    Law(JointLaw),
}

impl Joint {
    /// A joint that turns about its sharp edges.
    pub fn sharp(width_m: f64, load_n: f64) -> Self {
        Self { width_m, load_n, gives: Gives::Sharp }
    }

    /// A joint on a bed of this stiffness per area, Pa/m, along a strip of this length, m.
    pub fn on_bed(width_m: f64, load_n: f64, stiffness_pa_per_m: f64, length_m: f64) -> Self {
        Self { width_m, load_n, gives: Gives::Bed(stiffness_pa_per_m * length_m) }
    }

    /// A joint by the law of a wall that moves.
    pub fn by_law(width_m: f64, load_n: f64, law: JointLaw) -> Self {
        match law {
            JointLaw::Bed(bed) => Self::on_bed(width_m, load_n, bed.stiffness_pa_per_m, bed.length_m),
            rival => Self { width_m, load_n, gives: Gives::Law(rival) },
        }
    }

    /// Whether it turns about its edges at once.
    pub fn is_sharp(&self) -> bool {
        self.gives == Gives::Sharp
    }

    /// Rotation φ_c at which the joint begins to lose contact, rad; 0 for edges, sharp or worn.
    pub fn opening_rad(&self) -> f64 {
        match self.gives {
            Gives::Sharp => 0.0,
            Gives::Bed(bed) => 2.0 * self.load_n / (bed * self.width_m.powi(2)),
            Gives::Law(law) => law.full_contact_rad(),
        }
    }

    /// Width in contact c on a bed at a rotation, m.
    fn contact_m(&self, bed: f64, phi_rad: f64) -> f64 {
        match phi_rad.abs() > self.opening_rad() {
            true => (2.0 * self.load_n / (bed * phi_rad.abs())).sqrt(),
            false => self.width_m,
        }
    }

    /// Moment about the middle of the joint at a rotation, N m, with the sign of the rotation.
    ///
    /// N b/2 of sharp edges; N (b/2 - c/3) of a bed that is partly open; k L b³ φ/12 of one in full contact.
    pub fn moment_n_m(&self, phi_rad: f64) -> f64 {
        let (n, b) = (self.load_n, self.width_m);
        match self.gives {
            Gives::Bed(bed) if phi_rad.abs() <= self.opening_rad() => bed * b.powi(3) * phi_rad / 12.0,
            Gives::Bed(bed) => n * (b / 2.0 - self.contact_m(bed, phi_rad) / 3.0) * phi_rad.signum(),
            Gives::Sharp => n * b / 2.0 * phi_rad.signum(),
            Gives::Law(law) => law.moment_n_m(phi_rad),
        }
    }

    /// What the joint lacks of the moment of sharp edges, N m: it adds to the work of turning about an edge.
    pub fn lacking_moment_n_m(&self, phi_rad: f64) -> f64 {
        if self.is_sharp() {
            return 0.0;
        }
        self.moment_n_m(phi_rad) - self.load_n * self.width_m / 2.0 * phi_rad.signum()
    }

    /// Work of turning the joint from zero under its load, J: energy in it, and the load that has risen.
    pub fn work_j(&self, phi_rad: f64) -> f64 {
        let (b, n, phi) = (self.width_m, self.load_n, phi_rad.abs());
        let bed = match self.gives {
            Gives::Sharp => return n * b / 2.0 * phi,
            Gives::Law(law) => return law.work_j(phi_rad),
            Gives::Bed(bed) => bed,
        };
        let closed = phi.min(self.opening_rad());
        let full_j = bed * b.powi(3) * closed * closed / 24.0;
        // ∫ N (b/2 - c/3) dφ with c ∝ φ^(-1/2) is N (b φ/2 - 2 c φ/3).
        let at = |phi: f64| n * (b / 2.0 - 2.0 / 3.0 * self.contact_m(bed, phi)) * phi;
        if phi > closed { full_j + at(phi) - at(closed) } else { full_j }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_kernel::model::{Effect, G_M_S2, Wall, WallParameters};

    /// b 0.3 m, N 20 kN, k 1e9 Pa/m along 1.5 m.
    fn bed() -> Joint {
        Joint::on_bed(0.3, 20e3, 1e9, 1.5)
    }

    #[test]
    fn analytic_both_branches_meet_at_a_sixth_of_the_width() {
        let joint = bed();
        let phi_c = joint.opening_rad();
        assert!((phi_c - 2.0 * 20e3 / (1e9 * 1.5 * 0.09)).abs() < 1e-18);
        let [below, above] = [phi_c, phi_c * (1.0 + 1e-12)].map(|phi| joint.moment_n_m(phi));
        // N b/6, the moment at which a section without tension begins to open; roundings of a root.
        assert!((below - 20e3 * 0.3 / 6.0).abs() < 1e-9 && (above - below).abs() < 1e-8);
        assert_eq!(joint.moment_n_m(-0.004), -joint.moment_n_m(0.004));
    }

    #[test]
    fn analytic_work_of_every_law_is_the_integral_of_its_moment() {
        for (name, values) in [
            ("compliant_joint.ground", &[1e9, 0.0][..]),
            ("trilinear_joint.ground", &[0.7, 0.002, 0.012, 0.0]),
            ("crushing_joint.ground", &[1e9, 1e6, 0.0]),
            ("rounded_edges.ground", &[0.04, 3.0]),
        ] {
            let effects = vec![Effect::with_parameters(name, values).expect("an effect")];
            let strip = WallParameters { effects, ..WallParameters::strip(0.3, 4.0, 1800.0) };
            let wall = Wall::new(strip).expect("a wall");
            let law = wall.joint_laws()[0].expect("a law");
            let joint = Joint::by_law(0.3, 1200.0 * 1.8 * G_M_S2, law);
            for phi in [1e-4, 0.001, 0.008, 0.015, 0.05] {
                let step = 1e-6 * phi;
                let slope = (joint.work_j(phi + step) - joint.work_j(phi - step)) / (2.0 * step);
                // As of a bed below; the level of a bed that crushes takes some more roundings.
                assert!((slope / joint.moment_n_m(phi) - 1.0).abs() < 1e-7, "{name} {phi}");
                assert!((law.work_j(phi) / joint.work_j(phi) - 1.0).abs() < 1e-9, "{name} {phi}");
            }
        }
    }

    #[test]
    fn analytic_a_bed_integrated_spring_by_spring_gives_the_closed_form() {
        // Springs without tension under a rigid face: depth s + φ x, x from -b/2 to b/2; s by bisection so that they carry N.
        let (joint, steps) = (bed(), 200_000);
        for phi in [1e-5, 2e-4, 1e-3, 2e-2] {
            let dx = 0.3 / f64::from(steps);
            let places = || (0..steps).map(|i| -0.15 + (f64::from(i) + 0.5) * dx);
            let sums = |s: f64| {
                places().fold((0.0, 0.0), |(force, moment), x| {
                    let pressure = 1.5e9 * (s + phi * x).max(0.0) * dx;
                    (force + pressure, moment + pressure * x)
                })
            };
            let [mut low, mut high] = [-0.01, 0.01];
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if sums(middle).0 > 20e3 { high = middle } else { low = middle }
            }
            // The rule of midpoints leaves a share of (dx/c)², c ≥ 1 mm here: 2e-6.
            assert!((sums(low).1 / joint.moment_n_m(phi) - 1.0).abs() < 5e-6, "{phi}");
        }
    }

    #[test]
    fn analytic_work_is_the_integral_of_the_moment() {
        let joint = bed();
        for phi in [1e-4, 2.0 * joint.opening_rad(), 0.02] {
            let step = 1e-6 * phi;
            let slope = (joint.work_j(phi + step) - joint.work_j(phi - step)) / (2.0 * step);
            // A central difference leaves step² times the third derivative, and roundings of 1e-16/1e-6.
            assert!((slope / joint.moment_n_m(phi) - 1.0).abs() < 1e-8, "{phi}");
        }
    }

    #[test]
    fn analytic_an_endless_stiffness_is_the_sharp_edge() {
        let sharp = Joint::sharp(0.3, 20e3);
        let lacks = |stiffness: f64| {
            let joint = Joint::on_bed(0.3, 20e3, stiffness, 1.5);
            sharp.moment_n_m(0.01) - joint.moment_n_m(0.01)
        };
        // N c/3 with c ∝ k^(-1/2): a hundred times the stiffness, a tenth of what lacks.
        assert!((lacks(1e9) / lacks(1e11) - 10.0).abs() < 1e-9 && lacks(1e15) < 3.0);
        assert_eq!(sharp.lacking_moment_n_m(0.01), 0.0);
    }
}
