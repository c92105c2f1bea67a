//! The capacity of a wall: its mechanism, and the acceleration that it bears at a displacement.

use serde::{Deserialize, Serialize};

use mrbd_kernel::model::{G_M_S2, Wall};
use mrbd_statics::{
    Chain, Curve, Edges, LeastCrack, Load, Mechanism, Point, Push, Restraint, Side, VirtualWork,
    least_crack_height,
};

/// Share of the displacement of the crack by which a support that counts as rigid lets the top move.
const RIGID: f64 = 0.01;
/// Share of the displacement of the top below which that of the crack tells nothing: the lower body stands still.
const STILL: f64 = 0.05;
/// d_SLV and d_SLC over d_0 (C8.7.1.2.1.7).
pub const LIMIT_STATES: [f64; 2] = [0.4, 0.6];

/// The mechanism that governs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Governing {
    /// The whole wall, its top free.
    OneBlock,
    /// What is above the crack, its top free.
    UpperBody,
    /// Both bodies, the top held as by a rigid support.
    VerticalBending,
    /// Both bodies, as the springs at the top let them.
    Restrained,
}

impl Governing {
    /// Name in result files.
    pub fn name(self) -> &'static str {
        match self {
            Self::OneBlock => "one_block",
            Self::UpperBody => "upper_body",
            Self::VerticalBending => "vertical_bending",
            Self::Restrained => "restrained",
        }
    }
}

/// The point whose displacement is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Control {
    /// C, at the top.
    Top,
    /// The middle of the crack.
    Crack,
}

/// A point of a capacity curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint {
    /// d: displacement of the equivalent oscillator, m.
    pub d_m: f64,
    /// Displacement of the point that is followed, m.
    pub control_m: f64,
    /// α: multiplier of the weights.
    pub alpha: f64,
    /// Rotations of the bodies, rad.
    pub theta_rad: [f64; 2],
}

/// What a wall bears, and how far.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Capacity {
    /// The mechanism.
    pub mechanism: Governing,
    /// Towards +x (`true`) or -x: the side with the lesser multiplier.
    pub towards_positive: bool,
    /// α_0: of virtual work; of a wall on springs the largest multiplier that it bears.
    pub alpha_0: f64,
    /// Multiplier at which the first joint opens, the springs still without force.
    pub alpha_first: f64,
    /// e* (C8.7.1.5).
    pub e_star: f64,
    /// M*, kg.
    pub m_star_kg: f64,
    /// The point that is followed.
    pub control: Control,
    /// d over the displacement of that point (C8.7.1.4); of a wall on springs, whose bodies change their share on the
    /// way, the ratio at d_0.
    pub d_over_control: f64,
    /// d_0, m.
    pub d_0_m: f64,
    /// Displacement of the point there, m.
    pub d_0_control_m: f64,
    /// Whether the multiplier vanishes at d_0; `false`: it is where the wall counts as fallen.
    pub vanishes: bool,
    /// The sums of virtual work.
    pub work: VirtualWork,
    /// α(d), from rest.
    pub curve: Vec<CurvePoint>,
}

/// Why a wall has no mechanism to check.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoMechanism {
    /// Its top is held and it has no crack.
    #[error("a wall without a crack whose top is held; with a crack at {:.3} m it would bear least", least.height_m)]
    Uncracked {
        /// Where it would crack.
        least: LeastCrack,
    },
    /// It does not stand: its beds or loads let it fall at once.
    #[error(
        "a wall that does not stand by itself: its beds are too soft, or its load too far off the middle"
    )]
    Unstable,
}

impl Capacity {
    /// Of a wall with these edges, towards the side where it bears less.
    ///
    /// # Errors
    /// [`NoMechanism`].
    pub fn of(wall: &Wall, edges: Edges) -> Result<Self, NoMechanism> {
        let [right, left] = [Side::Right, Side::Left].map(|side| Self::towards(wall, edges, side));
        let (right, left) = (right?, left?);
        Ok(if left.alpha_0 < right.alpha_0 { left } else { right })
    }

    fn towards(wall: &Wall, edges: Edges, side: Side) -> Result<Self, NoMechanism> {
        let restraint = Restraint::of(wall, side);
        match restraint.is_free() {
            true => free(wall, edges, side),
            false => restrained(wall, edges, side, restraint),
        }
    }

    /// α at a displacement of the equivalent oscillator, m; linear between points.
    pub fn alpha(&self, d_m: f64) -> f64 {
        let after = self.curve.partition_point(|point| point.d_m < d_m).clamp(1, self.curve.len() - 1);
        let [a, b] = [after - 1, after].map(|i| self.curve[i]);
        a.alpha + (b.alpha - a.alpha) * (d_m - a.d_m) / (b.d_m - a.d_m)
    }

    /// d at a displacement of the point that is followed, m: by the constant ratio of a mechanism, or along the curve of a
    /// wall on springs; beyond its end by the ratio there.
    pub fn d_of_control_m(&self, control_m: f64) -> f64 {
        if self.mechanism != Governing::Restrained || control_m >= self.d_0_control_m {
            return self.d_over_control * control_m;
        }
        let after = self.curve.partition_point(|point| point.control_m < control_m);
        let [a, b] = [after.max(1) - 1, after.max(1)].map(|i| self.curve[i.min(self.curve.len() - 1)]);
        let share = if b.control_m > a.control_m {
            (control_m - a.control_m) / (b.control_m - a.control_m)
        } else {
            1.0
        };
        a.d_m + share * (b.d_m - a.d_m)
    }

    /// a(d) = α g/(e* FC) (C8.7.1.3), m/s².
    pub fn acceleration_m_s2(&self, d_m: f64, confidence_factor: f64) -> f64 {
        self.alpha(d_m) * G_M_S2 / (self.e_star * confidence_factor)
    }
}

/// α_0 of each mechanism that a wall has, towards the side where it is less, with its virtual work.
pub fn mechanisms(wall: &Wall) -> Vec<(Mechanism, VirtualWork)> {
    let chains = [Side::Right, Side::Left].map(|side| Chain::of(wall, Edges::Crushed, side));
    let less = |a: VirtualWork, b: VirtualWork| if b.alpha_0() < a.alpha_0() { b } else { a };
    let work = |mechanism: Mechanism| chains.iter().filter_map(|chain| mechanism.work(chain)).reduce(less);
    Mechanism::ALL.into_iter().filter_map(|mechanism| Some((mechanism, work(mechanism)?))).collect()
}

/// The crack of least α_0 with the top held.
pub fn least_crack(wall: &Wall) -> LeastCrack {
    let [right, left] =
        [Side::Right, Side::Left].map(|side| least_crack_height(&Chain::of(wall, Edges::Crushed, side)));
    if left.alpha_0 < right.alpha_0 { left } else { right }
}

/// A wall whose top is free falls in the mechanism that needs least.
fn free(wall: &Wall, edges: Edges, side: Side) -> Result<Capacity, NoMechanism> {
    let alpha = |mechanism: Mechanism| {
        let work = mechanism.work(&Chain::of(wall, Edges::Crushed, side));
        work.map_or(f64::INFINITY, |work| work.alpha_0())
    };
    let upper = alpha(Mechanism::UpperBody) < alpha(Mechanism::OneBlock);
    let part = |chain: Chain| if upper { chain.above_crack() } else { chain.without_crack() };
    let [sharp, chain] = [Edges::Crushed, edges].map(|edges| part(Chain::of(wall, edges, side)));
    let work = VirtualWork::of(if edges == Edges::Full { &chain } else { &sharp }, [1.0; 2], [1.0; 2]);
    // A part counts as fallen as the wall does.
    let fallen_rad = [wall.collapse_rotation_rad()[usize::from(upper)]; 2];
    let curve = Push { chain, restraint: Restraint::Free, load: Load::Uniform, fallen_rad }.curve();
    let mechanism = if upper { Governing::UpperBody } else { Governing::OneBlock };
    let found = Found {
        mechanism,
        side,
        alpha_0: work.alpha_0(),
        alpha_first: work.alpha_0(),
        work,
        control: Control::Top,
    };
    found.capacity(&curve, &chain)
}

/// A wall on springs follows its equilibrium; where they are as good as rigid, that is vertical bending.
fn restrained(wall: &Wall, edges: Edges, side: Side, restraint: Restraint) -> Result<Capacity, NoMechanism> {
    let chain = Chain::of(wall, edges, side);
    let sharp = if edges == Edges::Full { chain } else { Chain::of(wall, Edges::Crushed, side) };
    if !chain.cracked {
        return Err(NoMechanism::Uncracked { least: least_crack(wall) });
    }
    let fallen_rad = wall.collapse_rotation_rad();
    let pushed =
        |chain| Push { chain, restraint: restraint.clone(), load: Load::Uniform, fallen_rad }.curve();
    let curve = pushed(chain);
    let shape = shape(&curve.points);
    let has_beds = edges == Edges::AsTheyAre && wall.joint_laws().iter().any(Option::is_some);
    let first =
        [Mechanism::OneBlock, Mechanism::UpperBody].map(|m| m.work(&sharp).map(|work| work.alpha_0()));
    let alpha_first = first.into_iter().flatten().fold(f64::INFINITY, f64::min);
    let bending =
        Mechanism::VerticalBending.work(&sharp).filter(|_| shape.top_m.abs() < RIGID * shape.crack_m.abs());
    let found = match bending {
        Some(work) => {
            let (mechanism, control) = (Governing::VerticalBending, Control::Crack);
            Found { mechanism, side, alpha_0: work.alpha_0(), alpha_first, work, control }
        }
        None => {
            let peak_n = if has_beds { pushed(sharp).peak.force_n } else { curve.peak.force_n };
            let work = work_of_shape(&sharp, &shape);
            let control =
                if work.crack_m.abs() < STILL * work.top_m.abs() { Control::Top } else { Control::Crack };
            let mechanism = Governing::Restrained;
            Found { mechanism, side, alpha_0: peak_n / chain.pushing_n(), alpha_first, work, control }
        }
    };
    found.capacity(&curve, &chain)
}

/// The state at 0.4 of the displacement at which the wall falls: how it moves on its way there.
fn shape(points: &[Point]) -> Point {
    let last = points[points.len() - 1].displacement_m;
    let at = points.partition_point(|point| point.displacement_m < LIMIT_STATES[0] * last);
    points[at.min(points.len() - 1)]
}

/// Virtual work of rotations in the proportion of a state.
fn work_of_shape(chain: &Chain, shape: &Point) -> VirtualWork {
    let [theta_1, theta_2] = shape.theta_rad;
    let size = theta_1.abs().max(theta_2.abs());
    let sides = [theta_1, theta_2 - theta_1].map(|phi| if phi < 0.0 { -1.0 } else { 1.0 });
    VirtualWork::of(chain, [theta_1 / size, theta_2 / size], sides)
}

/// d of a state: Σ (P + Q) x²/Σ (P + Q) x, C8.7.1.4 with displacements in the place of virtual ones, m.
fn spectral_m(chain: &Chain, point: &Point) -> f64 {
    if point.displacement_m == 0.0 {
        return 0.0;
    }
    let work = work_of_shape(chain, point);
    let size = point.theta_rad[0].abs().max(point.theta_rad[1].abs());
    work.squares_n_m2 / work.pushing_j * size
}

/// A mechanism, before its displacements are known.
struct Found {
    mechanism: Governing,
    side: Side,
    alpha_0: f64,
    alpha_first: f64,
    work: VirtualWork,
    control: Control,
}

impl Found {
    fn capacity(self, curve: &Curve, chain: &Chain) -> Result<Capacity, NoMechanism> {
        let Self { mechanism, side, alpha_0, alpha_first, work, control } = self;
        let (control_m, of_point): (f64, fn(&Point) -> f64) = match control {
            Control::Top => (work.top_m, |point| point.top_m),
            Control::Crack => (work.crack_m, |point| point.crack_m),
        };
        let ratio = work.spectral_over(control_m.abs());
        let d_m = |point: &Point| match mechanism {
            // C8.7.1.4 with the displacements of the state itself: the bodies change their share on the way.
            Governing::Restrained => spectral_m(chain, point),
            _ => ratio * of_point(point).abs(),
        };
        let mut points: Vec<CurvePoint> = Vec::new();
        for point in &curve.points {
            let (d_m, control_m) = (d_m(point), of_point(point).abs());
            // Where the springs bring the top back d may go back for a while. The later state counts: it leads to the end.
            while points.last().is_some_and(|last| last.d_m >= d_m || last.control_m >= control_m) {
                points.pop();
            }
            let alpha = point.force_n / chain.pushing_n();
            points.push(CurvePoint { d_m, control_m, alpha, theta_rad: point.theta_rad });
        }
        let last = points.last().filter(|_| points.len() > 2).ok_or(NoMechanism::Unstable)?;
        Ok(Capacity {
            mechanism,
            towards_positive: side == Side::Right,
            alpha_0,
            alpha_first,
            e_star: work.e_star(),
            m_star_kg: work.m_star_kg(),
            control,
            d_over_control: last.d_m / last.control_m,
            d_0_m: last.d_m,
            d_0_control_m: last.control_m,
            vanishes: curve.end.is_some(),
            work,
            curve: points,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_kernel::model::WallParameters;

    fn wall(change: impl Fn(&mut WallParameters)) -> Wall {
        let mut parameters = WallParameters::strip(0.3, 4.0, 1800.0);
        change(&mut parameters);
        Wall::new(parameters).expect("a wall")
    }

    fn capacity(wall: &Wall) -> Capacity {
        Capacity::of(wall, Edges::AsTheyAre).expect("a mechanism")
    }

    #[test]
    fn analytic_a_free_block_falls_where_its_centre_is_above_the_corner() {
        let found = capacity(&wall(|_| {}));
        assert_eq!((found.mechanism, found.control), (Governing::OneBlock, Control::Top));
        // tan θ = b/h; the top is then h sin θ + b/2 (1 - cos θ) away, and d is two thirds of it.
        let theta = 0.075_f64.atan();
        let top_m = 4.0 * theta.sin() + 0.15 * (1.0 - theta.cos());
        // The end is found to 1e-9 of a step of 1 % of b; lines between points of the curve do not matter there.
        assert!((found.d_0_m - top_m * 2.0 / 3.0).abs() < 1e-9 && found.vanishes);
        // Half-way it bears half: the cosine of small angles leaves θ²/2 = 3e-3 of that.
        assert!((found.alpha(found.d_0_m / 2.0) / found.alpha_0 - 0.5).abs() < 2e-3);
    }

    #[test]
    fn analytic_stiff_springs_are_vertical_bending_and_soft_ones_are_not() {
        let cracked = |stiffness: f64| {
            capacity(&wall(|p| {
                p.crack_height_m = Some(2.0);
                p.stiffness_n_per_m = stiffness;
            }))
        };
        let stiff = cracked(1e9);
        assert_eq!((stiff.mechanism, stiff.control), (Governing::VerticalBending, Control::Crack));
        assert!((stiff.alpha_0 - 0.3).abs() < 1e-12 && (stiff.e_star - 0.75).abs() < 1e-12);
        // δ_C is 2 m a radian; Σδ²/(δ_C Σδ) of two triangles is 2/3. It falls where the crack is b away, but for θ².
        assert!((stiff.d_over_control - 2.0 / 3.0).abs() < 1e-12);
        assert!((stiff.d_0_control_m / 0.3 - 1.0).abs() < 0.01, "{}", stiff.d_0_control_m);
        let [free, soft, medium] = [0.0, 2e3, 40e3].map(cracked);
        assert_eq!((free.mechanism, medium.mechanism), (Governing::OneBlock, Governing::Restrained));
        assert!(
            free.alpha_0 < soft.alpha_0 && soft.alpha_0 < medium.alpha_0 && medium.alpha_0 < stiff.alpha_0
        );
        assert!((medium.alpha_first - 0.075).abs() < 1e-12);
        // The top comes back while the wall goes on; the crack does not, and tells how far: to b but for θ², as stiffly
        // held, for the spring at the top is slack again.
        assert_eq!(medium.control, Control::Crack);
        let last = medium.curve[medium.curve.len() - 1];
        assert!(
            medium.vanishes && last.alpha.abs() < 1e-9 && (medium.d_0_control_m / 0.3 - 1.0).abs() < 0.01,
            "{} {:e} {}",
            medium.vanishes,
            last.alpha,
            medium.d_0_control_m
        );
    }

    #[test]
    fn analytic_of_two_sides_the_weaker_one_counts() {
        let leaning = |eccentricity_m: f64| {
            capacity(&wall(|p| {
                p.diaphragm_mass_kg = 400.0;
                p.eccentricity_m = eccentricity_m;
            }))
        };
        let [right, left] = [leaning(0.1), leaning(-0.1)];
        assert!(right.towards_positive && !left.towards_positive);
        assert_eq!((right.alpha_0, right.d_0_m), (left.alpha_0, left.d_0_m));
    }

    #[test]
    fn rejects_a_held_wall_without_a_crack() {
        let held = wall(|p| {
            p.stiffness_n_per_m = 1e9;
            p.diaphragm_mass_kg = 2160.0;
        });
        let refused = Capacity::of(&held, Edges::Crushed).expect_err("no mechanism");
        // ν = 1: 3 ξ² - 8 ξ + 4 = 0, ξ = 2/3.
        assert!(refused.to_string().contains("2.667 m"), "{refused}");
    }
}
