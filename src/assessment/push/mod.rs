//! A slow push of a wall: force against displacement, the rigid line beside it, and a push that was measured.

mod measured;

pub use measured::{Measured, MeasuredPoint};

use serde::{Deserialize, Serialize};

use mrbd_kernel::model::{Effect, Role, Wall};
use mrbd_statics::{Chain, Curve, Edges, Joint, Load, Point, Push, Restraint, Side};

/// What a manifest says such results are.
pub const KIND: &str = "push";

/// What is written beside the page.
pub const FILES: [&str; 3] = ["manifest.json", "push.json", "push.csv"];

/// What is asked of a wall.
#[derive(Debug, Clone, Copy)]
pub struct Question {
    /// Where it is pushed.
    pub load: Load,
    /// Towards which side.
    pub side: Side,
    /// A bed in both joints instead of the wall's own, Pa/m.
    pub bed_pa_per_m: Option<f64>,
    /// Whether the top is held by a rigid support instead of the wall's own springs.
    pub held: bool,
}

/// A push of a wall, as results keep it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pushed {
    /// Name of the wall file.
    pub wall: String,
    /// `crack`, `uniform` or `top`.
    pub at: String,
    /// `crack` or `top`: the place whose displacement is `displacement_m`.
    pub displacement_of: String,
    /// `free`, `springs` or `held`.
    pub top: String,
    /// Thickness b, m.
    pub thickness_m: f64,
    /// Weight of the wall, N.
    pub weight_n: f64,
    /// Beds at ground and crack, Pa/m; `None` for sharp edges.
    pub beds_pa_per_m: [Option<f64>; 2],
    /// Kinds of the effects that give the joints at ground and crack another law than a bed; `None` where there is none.
    #[serde(default)]
    pub joint_laws: [Option<String>; 2],
    /// The wall as it is.
    pub curve: PushCurve,
    /// The same wall on the sharp edges of its full thickness.
    pub rigid: PushCurve,
    /// A measured push, where one was given.
    pub measured: Option<Measured>,
}

/// Force against displacement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PushCurve {
    /// Largest force over the weight.
    pub largest_force_over_weight: f64,
    /// Displacement there, m.
    pub largest_at_m: f64,
    /// Displacement at which the force vanishes, m; `None` where the wall counts as fallen before.
    pub end_m: Option<f64>,
    /// From rest on.
    pub points: Vec<PushPoint>,
}

/// A state of a push.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PushPoint {
    /// Displacement of the place that the results name, m.
    pub displacement_m: f64,
    /// Force, N; of a uniform acceleration the sum over the masses.
    pub force_n: f64,
    /// Force over the weight of the wall.
    pub force_over_weight: f64,
    /// Displacement of the middle of the crack, m.
    pub crack_displacement_m: f64,
    /// Displacement of the top, m.
    pub top_displacement_m: f64,
    /// θ_1, rad.
    pub theta1_rad: f64,
    /// θ_2, rad.
    pub theta2_rad: f64,
}

impl Question {
    /// Pushes a wall of this name.
    pub fn answer(&self, wall: &Wall, name: &str) -> Pushed {
        let restraint = if self.held { Restraint::Held } else { Restraint::of(wall, self.side) };
        let chain = self.chain(wall);
        let own_beds = wall.beds().map(|bed| Some(bed?.stiffness_pa_per_m));
        let follows_crack = match self.load {
            Load::Crack => true,
            Load::Top => false,
            Load::Uniform => chain.cracked && !restraint.is_free(),
        };
        let curve = |chain| {
            let fallen_rad = wall.collapse_rotation_rad();
            let push = Push { chain, restraint: restraint.clone(), load: self.load, fallen_rad };
            PushCurve::of(&push.curve(), chain.weight_n(), follows_crack)
        };
        Pushed {
            wall: name.to_owned(),
            at: self.load.name().to_owned(),
            displacement_of: if follows_crack { "crack" } else { "top" }.to_owned(),
            top: match restraint {
                Restraint::Free => "free",
                Restraint::Held => "held",
                Restraint::Springs(_) => "springs",
            }
            .to_owned(),
            thickness_m: wall.parameters().thickness_m,
            weight_n: chain.weight_n(),
            beds_pa_per_m: self.bed_pa_per_m.map_or(own_beds, |bed| [Some(bed); 2]),
            joint_laws: if self.bed_pa_per_m.is_some() { [None, None] } else { rivals(wall) },
            curve: curve(chain),
            rigid: curve(Chain::of(wall, Edges::Full, self.side)),
            measured: None,
        }
    }

    fn chain(&self, wall: &Wall) -> Chain {
        let chain = Chain::of(wall, Edges::AsTheyAre, self.side);
        let Some(bed) = self.bed_pa_per_m else { return chain };
        let length_m = wall.parameters().length_m;
        Chain {
            joints: chain.joints.map(|joint| Joint::on_bed(joint.width_m, joint.load_n, bed, length_m)),
            ..chain
        }
    }
}

/// Kinds of the effects that are rivals of beds, by joint. A rival may be a bed all the same: one that never crushes.
fn rivals(wall: &Wall) -> [Option<String>; 2] {
    let mut kinds = [None, None];
    let is_rival = |effect: &&Effect| effect.entry().role == Role::JointLaw && !effect.is_neutral();
    for effect in wall.parameters().effects.iter().filter(is_rival) {
        let joints = effect.variant().joints().iter().map(|joint| *joint as usize);
        for joint in joints.filter(|joint| wall.beds()[*joint].is_none()) {
            kinds[joint] = Some(effect.kind().name().to_owned());
        }
    }
    kinds
}

impl PushCurve {
    fn of(curve: &Curve, weight_n: f64, follows_crack: bool) -> Self {
        let displacement_m = |point: &Point| if follows_crack { point.crack_m } else { point.top_m };
        let row = |point: &Point| PushPoint {
            displacement_m: displacement_m(point),
            force_n: point.force_n,
            force_over_weight: point.force_n / weight_n,
            crack_displacement_m: point.crack_m,
            top_displacement_m: point.top_m,
            theta1_rad: point.theta_rad[0],
            theta2_rad: point.theta_rad[1],
        };
        Self {
            largest_force_over_weight: curve.peak.force_n / weight_n,
            largest_at_m: displacement_m(&curve.peak),
            end_m: curve.end.as_ref().map(displacement_m),
            points: curve.points.iter().map(row).collect(),
        }
    }

    /// Force over the weight at a displacement, m; linear between points, 0 beyond the last.
    pub fn force_over_weight(&self, displacement_m: f64) -> f64 {
        let after = self.points.partition_point(|point| point.displacement_m < displacement_m);
        if after == 0 || after == self.points.len() {
            return 0.0;
        }
        let [a, b] = [after - 1, after].map(|i| self.points[i]);
        let share = (displacement_m - a.displacement_m) / (b.displacement_m - a.displacement_m);
        a.force_over_weight + share * (b.force_over_weight - a.force_over_weight)
    }
}
