//! A joint under a steady load: the moment that it carries at a rotation.

use mrbd_kernel::model::{Effect, Wall};

/// Kind of the effect that lays a bed of springs into a joint, and the key of its stiffness.
const BED: (&str, &str) = ("compliant_joint", "stiffness_pa_per_m");

/// A joint of width b along a strip of length L that carries N.
///
/// Without a bed its edges are sharp: it turns about one of them at once. A bed is a layer of springs of stiffness k
/// per area, linear, without tension. It touches over the whole width up to φ_c = 2N/(k L b²), and over
/// c = √(2N/(k L φ)) beyond. k → ∞ is the sharp edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joint {
    /// Width b between the rocking corners, m.
    pub width_m: f64,
    /// Load N, N.
    pub load_n: f64,
    /// k L, N/m²; `None` for sharp edges.
    bed_n_per_m2: Option<f64>,
}

impl Joint {
    /// A joint that turns about its sharp edges.
    pub fn sharp(width_m: f64, load_n: f64) -> Self {
        Self { width_m, load_n, bed_n_per_m2: None }
    }

    /// A joint on a bed of this stiffness per area, Pa/m, along a strip of this length, m.
    pub fn on_bed(width_m: f64, load_n: f64, stiffness_pa_per_m: f64, length_m: f64) -> Self {
        Self { width_m, load_n, bed_n_per_m2: Some(stiffness_pa_per_m * length_m) }
    }

    /// Whether it turns about its edges at once.
    pub fn is_sharp(&self) -> bool {
        self.bed_n_per_m2.is_none()
    }

    /// Rotation φ_c at which the bed begins to lose contact, rad; 0 for sharp edges.
    pub fn opening_rad(&self) -> f64 {
        self.bed_n_per_m2.map_or(0.0, |bed| 2.0 * self.load_n / (bed * self.width_m.powi(2)))
    }

    /// Width in contact c at a rotation, m; 0 for sharp edges that have turned.
    pub fn contact_m(&self, phi_rad: f64) -> f64 {
        let Some(bed) = self.bed_n_per_m2 else { return 0.0 };
        match phi_rad.abs() > self.opening_rad() {
            true => (2.0 * self.load_n / (bed * phi_rad.abs())).sqrt(),
            false => self.width_m,
        }
    }

    /// Moment about the middle of the joint at a rotation, N m, with the sign of the rotation.
    ///
    /// N b/2 of sharp edges; N (b/2 - c/3) of a bed that is partly open; k L b³ φ/12 of one in full contact.
    pub fn moment_n_m(&self, phi_rad: f64) -> f64 {
        let b = self.width_m;
        match self.bed_n_per_m2 {
            Some(bed) if phi_rad.abs() <= self.opening_rad() => bed * b.powi(3) * phi_rad / 12.0,
            _ => self.load_n * (b / 2.0 - self.contact_m(phi_rad) / 3.0) * phi_rad.signum(),
        }
    }

    /// What the joint lacks of the moment of sharp edges, N m: it adds to the work of turning about an edge.
    pub fn lacking_moment_n_m(&self, phi_rad: f64) -> f64 {
        if self.is_sharp() {
            return 0.0;
        }
        self.moment_n_m(phi_rad) - self.load_n * self.width_m / 2.0 * phi_rad.signum()
    }

    /// Work of turning the joint from zero under its load, J: energy in the bed, and the load that has risen.
    pub fn work_j(&self, phi_rad: f64) -> f64 {
        let (b, n, phi) = (self.width_m, self.load_n, phi_rad.abs());
        let Some(bed) = self.bed_n_per_m2 else { return n * b / 2.0 * phi };
        let closed = phi.min(self.opening_rad());
        let full_j = bed * b.powi(3) * closed * closed / 24.0;
        // ∫ N (b/2 - c/3) dφ with c ∝ φ^(-1/2) is N (b φ/2 - 2 c φ/3).
        let at = |phi: f64| n * (b / 2.0 - 2.0 / 3.0 * self.contact_m(phi)) * phi;
        if phi > closed { full_j + at(phi) - at(closed) } else { full_j }
    }
}

/// Stiffness of the beds at the ground and at the crack, Pa/m, from the effects of a wall; `None` for sharp edges.
pub fn beds_pa_per_m(wall: &Wall) -> [Option<f64>; 2] {
    let mut beds = [None; 2];
    for effect in &wall.parameters().effects {
        let Some((joint, stiffness)) = bed(effect) else { continue };
        for (place, bed) in ["ground", "crack"].iter().zip(&mut beds) {
            if joint == *place || joint == "both" {
                *bed = Some(stiffness);
            }
        }
    }
    beds
}

/// The joint and the stiffness of an effect that is a bed.
fn bed(effect: &Effect) -> Option<(&'static str, f64)> {
    let entry = effect.entry();
    let key = entry.parameters.iter().position(|parameter| parameter.key == BED.1)?;
    (entry.name == BED.0).then_some((effect.variant().choice?, effect.parameters()[key]))
}

#[cfg(test)]
mod tests {
    use super::*;

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
