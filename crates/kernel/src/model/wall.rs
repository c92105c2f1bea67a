//! The wall: geometry, masses, restraint and impact law, checked once.

use std::borrow::Cow;

use super::bed::{Bed, Carries, JointLaw, law_at};
use super::effect::{self, EffectSums, Lanes, Reading};
use super::formula::{FormulaLaw, ImpactFactors, checked};
use super::parameters::WallParameters;

/// Acceleration of gravity, m/s².
pub const G_M_S2: f64 = 9.81;

/// Why a wall cannot exist: the key of the wall file, what was found, what is allowed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{key}: found {found}; allowed: {allowed}")]
pub struct ImpossibleWall {
    /// Dotted key of the wall file.
    pub key: Cow<'static, str>,
    /// The value found.
    pub found: String,
    /// What is allowed.
    pub allowed: String,
}

/// A wall that can exist, with the quantities that follow from its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Wall {
    parameters: WallParameters,
    /// Heights of the bodies h_1, h_2, m; an uncracked wall is all lower body.
    pub(crate) height_m: [f64; 2],
    /// Masses of the bodies m_1, m_2, kg.
    pub(crate) mass_kg: [f64; 2],
    /// Polar moments about the centres of mass I_1, I_2, kg m².
    pub(crate) inertia_kg_m2: [f64; 2],
    /// Slenderness angles α_1, α_2, rad.
    pub(crate) alpha_i_rad: [f64; 2],
    /// Widths b_1, b_2 between the rocking corners, m, as the effects leave them.
    pub(crate) width_m: [f64; 2],
    /// Laws of the joints in place of sharp edges, at the ground and at the crack.
    pub(crate) joint_laws: [Option<JointLaw>; 2],
    /// The sums of the effects.
    pub(crate) effects: EffectSums,
    /// The laws of motion among the formulas ...
    pub(crate) formulas: Vec<FormulaLaw>,
    /// ... and those of impacts.
    pub(crate) impact_factors: ImpactFactors,
}

impl Wall {
    /// Checks the parameters and derives masses, inertias and slenderness angles.
    ///
    /// # Errors
    /// [`ImpossibleWall`] names the first parameter that cannot be.
    pub fn new(parameters: WallParameters) -> Result<Self, ImpossibleWall> {
        let effects = sums(&parameters);
        check(&parameters, &effects)?;
        let p = &parameters;
        let h1 = p.crack_height_m.unwrap_or(p.height_m);
        let height_m = [h1, p.height_m - h1];
        let mass_kg = height_m.map(|h_i| p.mass_kg * h_i / p.height_m);
        // Full width b, not the width between corners: the crushed strip keeps its mass.
        let inertia = |m_i: f64, h_i: f64| m_i * (p.thickness_m.powi(2) + h_i.powi(2)) / 12.0;
        let inertia_kg_m2 = [inertia(mass_kg[0], height_m[0]), inertia(mass_kg[1], height_m[1])];
        let [inwards_1, inwards_2] = effects.indentation_m;
        let width_m = [p.lower_width_m - inwards_1, p.upper_width_m - inwards_2];
        let alpha_1 = (width_m[0] / height_m[0]).atan();
        let alpha_2 = match p.crack_height_m {
            Some(_) => (width_m[1] / height_m[1]).atan(),
            None => alpha_1,
        };
        let alpha_i_rad = [alpha_1, alpha_2];
        check_collapse(p.collapse_rotation_ratio, alpha_i_rad)?;
        let above_kg = above_kg(p, mass_kg);
        let mut joint_laws = [None; 2];
        for (j, said) in effects.joints.into_iter().enumerate() {
            let Some(said) = said else { continue };
            let carries = Carries { width_m: width_m[j], length_m: p.length_m, load_n: above_kg[j] * G_M_S2 };
            joint_laws[j] = Some(carries.law(said).map_err(|refusal| refusal.at(&parameters, j))?);
        }
        let mut wall = Self {
            height_m,
            mass_kg,
            inertia_kg_m2,
            alpha_i_rad,
            width_m,
            joint_laws,
            effects,
            parameters,
            formulas: Vec::new(),
            impact_factors: ImpactFactors::default(),
        };
        wall.check_beds()?;
        wall.formulas = checked(&wall)?;
        wall.impact_factors = ImpactFactors::of(&wall)?;
        Ok(wall)
    }

    /// Weights above the ground and above the crack, N.
    pub(crate) fn weights_n(&self) -> [f64; 2] {
        above_kg(&self.parameters, self.mass_kg).map(|mass_kg| mass_kg * G_M_S2)
    }

    /// Whether a joint gives: turns under any moment, as on a bed.
    #[inline]
    pub fn gives(&self) -> bool {
        self.joint_laws.iter().flatten().any(JointLaw::gives)
    }

    /// Whether a joint has another law than that of sharp edges.
    #[inline]
    pub(crate) fn rolls(&self) -> bool {
        self.joint_laws.iter().any(Option::is_some)
    }

    /// Laws of the joints in place of sharp edges, at the ground and at the crack.
    pub fn joint_laws(&self) -> [Option<JointLaw>; 2] {
        self.joint_laws
    }

    /// Beds of the joints that lie on elastic ones, at the ground and at the crack.
    pub fn beds(&self) -> [Option<Bed>; 2] {
        self.joint_laws.map(|law| match law {
            Some(JointLaw::Bed(bed)) => Some(bed),
            _ => None,
        })
    }

    /// A wall on beds must stand upright by itself.
    ///
    /// Stiffness of the beds and of the floor's spring less what the weight takes, on θ_1 and θ_2. Joints on
    /// sharp edges do not open from rest.
    fn check_beds(&self) -> Result<(), ImpossibleWall> {
        let [h1, h2] = self.height_m;
        let [m1, m2] = self.mass_kg;
        let (m_d, k_d) = (self.parameters.diaphragm_mass_kg, self.parameters.stiffness_n_per_m);
        let falls = [(m1 / 2.0 + m2 + m_d) * h1, (m2 / 2.0 + m_d) * h2].map(|moment| moment * G_M_S2);
        let gives = |law: Option<JointLaw>| law.filter(JointLaw::gives);
        let stiffness = self.joint_laws.map(|law| gives(law).map(|law| law.rotational_stiffness_n_m()));
        let stands = match stiffness {
            [None, None] => true,
            [Some(ground), None] => ground + k_d * (h1 + h2).powi(2) > falls[0] + falls[1],
            [None, Some(crack)] => crack + k_d * h2 * h2 > falls[1],
            [Some(ground), Some(crack)] => {
                let lower = ground + crack + k_d * h1 * h1 - falls[0];
                let upper = crack + k_d * h2 * h2 - falls[1];
                lower > 0.0 && lower * upper > (crack - k_d * h1 * h2).powi(2)
            }
        };
        if stands {
            return Ok(());
        }
        let softest = if stiffness[0].unwrap_or(f64::INFINITY) <= stiffness[1].unwrap_or(f64::INFINITY) {
            0
        } else {
            1
        };
        Err(self.too_soft(softest))
    }

    /// Says that the law of a joint lets the wall fall at once.
    fn too_soft(&self, joint: usize) -> ImpossibleWall {
        let (key, found) = match &self.joint_laws[joint] {
            Some(JointLaw::Trilinear(lines)) => ("first_rotation_rad", lines.first_rad),
            Some(JointLaw::Bed(bed)) => ("stiffness_pa_per_m", bed.stiffness_pa_per_m),
            Some(JointLaw::Crushing(bed)) => ("stiffness_pa_per_m", bed.stiffness_pa_per_m),
            Some(JointLaw::Rounded(_)) | None => ("kind", 0.0),
        };
        let of = if key == "first_rotation_rad" { "a smaller one" } else { "stiffer beds" };
        let allowed = format!("{of}: on these the wall falls by its own weight");
        let key = Cow::Owned(format!("effects.{}.{key}", law_at(&self.parameters, joint)));
        ImpossibleWall { key, found: format!("{found:e}"), allowed }
    }

    /// This wall with sharp edges in place of the joints that give, under these laws.
    #[must_use]
    pub(crate) fn with_sharp_edges(&self, laws: &[Option<JointLaw>; 2]) -> Self {
        let mut sharp = self.clone();
        for (j, law) in laws.iter().enumerate() {
            if let Some(law) = law.filter(JointLaw::gives) {
                sharp.width_m[j] = law.edge_width_m();
                sharp.joint_laws[j] = None;
            }
        }
        sharp
    }

    /// The parameters the wall was made from.
    pub fn parameters(&self) -> &WallParameters {
        &self.parameters
    }

    /// Whether the wall is cracked into two bodies.
    pub fn is_cracked(&self) -> bool {
        self.parameters.crack_height_m.is_some()
    }

    /// Slenderness angles of the bodies α_i = atan(b_i / h_i), rad; both are α for an uncracked wall.
    pub fn alpha_i_rad(&self) -> [f64; 2] {
        self.alpha_i_rad
    }

    /// Slenderness angle of the uncracked wall α = atan(b_1 / h), rad.
    pub fn alpha_rad(&self) -> f64 {
        (self.width_m[0] / self.parameters.height_m).atan()
    }

    /// Widths b_1, b_2 between the rocking corners, m: those of the parameters less what effects take.
    pub fn width_m(&self) -> [f64; 2] {
        self.width_m
    }

    /// The parameters with the corners where effects put them.
    pub fn indented(&self) -> WallParameters {
        let [lower_width_m, upper_width_m] = self.width_m;
        WallParameters { lower_width_m, upper_width_m, ..self.parameters.clone() }
    }

    /// Coefficients C_1 … C_8: those of the parameters times the factors of effects.
    pub fn coefficients(&self) -> [f64; 8] {
        let (own, factors) = (self.parameters.restitution.coefficients, self.effects.impact_factors);
        std::array::from_fn(|l| own[l] * factors[l])
    }

    /// Plastic displacement of the wall's yielding spring, m, once the top is displaced so far, from that
    /// before. The turning points of a path are enough to follow it. Without such a spring it stays.
    pub fn plastic_displacement_m(&self, before_m: f64, top_displacement_m: f64) -> f64 {
        match self.effects.yielding {
            Some(spring) => spring.plastic_m(before_m, top_displacement_m),
            None => before_m,
        }
    }

    /// How the rotations of this wall are read by the sensors of its effects.
    pub fn reading(&self) -> Reading {
        self.effects.reading
    }

    /// Rotations at which the wall counts as collapsed, rad.
    pub fn collapse_rotation_rad(&self) -> [f64; 2] {
        self.alpha_i_rad.map(|alpha| alpha * self.parameters.collapse_rotation_ratio)
    }
}

/// The sums of all effects. The lanes do formulas, but not those of which friction holds the top, nor carried states.
fn sums(p: &WallParameters) -> EffectSums {
    let sums = EffectSums::of(&p.effects);
    if p.formulas.is_empty() {
        sums
    } else {
        let carries = p.formulas.iter().any(|formula| !formula.states().is_empty());
        let lanes = if carries { Lanes::Unknown } else { Lanes::WhileSliding };
        EffectSums { lanes: sums.lanes.max(lanes), ..sums }
    }
}

/// Masses above the ground and above the crack, kg.
fn above_kg(p: &WallParameters, mass_kg: [f64; 2]) -> [f64; 2] {
    let upper_kg = mass_kg[1] + p.diaphragm_mass_kg;
    [mass_kg[0] + upper_kg, upper_kg]
}

/// Stiffer than any floor by many powers of ten, N/m: beyond it steps become too short to get anywhere.
const MOST_STIFFNESS_N_PER_M: f64 = 1e15;

fn check(p: &WallParameters, effects: &EffectSums) -> Result<(), ImpossibleWall> {
    positive("wall.thickness_m", p.thickness_m)?;
    positive("wall.height_m", p.height_m)?;
    positive("wall.length_m", p.length_m)?;
    positive("wall.mass_kg", p.mass_kg)?;
    if let Some(h1) = p.crack_height_m {
        let allowed = || format!("above 0 and below wall.height_m = {}", p.height_m);
        require("wall.crack_height_m", h1, h1 > 0.0 && h1 < p.height_m, allowed)?;
        width("corners.upper_width_m", p.upper_width_m, p.thickness_m)?;
    }
    width("corners.lower_width_m", p.lower_width_m, p.thickness_m)?;
    not_negative("diaphragm.mass_kg", p.diaphragm_mass_kg)?;
    not_negative("diaphragm.carriage_mass_kg", p.carriage_mass_kg)?;
    let allowed = || format!("0 to {MOST_STIFFNESS_N_PER_M:e}");
    let possible = (0.0..=MOST_STIFFNESS_N_PER_M).contains(&p.stiffness_n_per_m);
    require("diaphragm.stiffness_n_per_m", p.stiffness_n_per_m, possible, allowed)?;
    let allowed = || format!("within half the thickness, ±{}", p.thickness_m / 2.0);
    let within = p.eccentricity_m.abs() <= p.thickness_m / 2.0;
    require("diaphragm.eccentricity_m", p.eccentricity_m, within, allowed)?;
    for c in p.restitution.coefficients {
        let allowed = || "0 to 2 for each C_l".to_owned();
        require("restitution.coefficients", c, (0.0..=2.0).contains(&c), allowed)?;
    }
    not_negative("restitution.capture_velocity_rad_s", p.restitution.capture_velocity_rad_s)?;
    positive("collapse.rotation_ratio", p.collapse_rotation_ratio)?;
    check_initial(p)?;
    effect::check(p, effects)
}

/// A body that turned by a quarter lies on the ground: the one with the smaller α_i must count as fallen by then.
///
/// The default is allowed for squat bodies too.
fn check_collapse(ratio: f64, [alpha_1, alpha_2]: [f64; 2]) -> Result<(), ImpossibleWall> {
    let quarter_turn = std::f64::consts::FRAC_PI_2 / alpha_1.min(alpha_2);
    let most = quarter_turn.max(WallParameters::DEFAULT_COLLAPSE_RATIO);
    let allowed = || format!("above 0 and at most {most:.4}, a quarter turn or the default of 2");
    require("collapse.rotation_ratio", ratio, ratio <= most, allowed)
}

fn check_initial(p: &WallParameters) -> Result<(), ImpossibleWall> {
    let [theta1, theta2] = p.initial_rotation_rad;
    let quarter_turn = std::f64::consts::FRAC_PI_2;
    let allowed = || "a rotation within a quarter turn".to_owned();
    require("initial.theta1_rad", theta1, theta1.abs() < quarter_turn, allowed)?;
    require("initial.theta2_rad", theta2, theta2.abs() < quarter_turn, allowed)?;
    let allowed = || format!("equal to initial.theta1_rad = {theta1}: an uncracked wall is one block");
    require("initial.theta2_rad", theta2, p.crack_height_m.is_some() || theta1 == theta2, allowed)
}

fn width(key: &'static str, width_m: f64, thickness_m: f64) -> Result<(), ImpossibleWall> {
    let allowed = || format!("above 0 and at most wall.thickness_m = {thickness_m}");
    require(key, width_m, width_m > 0.0 && width_m <= thickness_m, allowed)
}

fn positive(key: &'static str, value: f64) -> Result<(), ImpossibleWall> {
    require(key, value, value > 0.0, || "a finite number above 0".to_owned())
}

fn not_negative(key: &'static str, value: f64) -> Result<(), ImpossibleWall> {
    require(key, value, value >= 0.0, || "a finite number, 0 or more".to_owned())
}

fn require(
    key: &'static str,
    value: f64,
    holds: bool,
    allowed: impl Fn() -> String,
) -> Result<(), ImpossibleWall> {
    if value.is_finite() && holds {
        Ok(())
    } else {
        Err(ImpossibleWall { key: Cow::Borrowed(key), found: value.to_string(), allowed: allowed() })
    }
}

/// Share of the compressive strength in the rectangular stress block.
pub(in crate::model) const BLOCK_STRENGTH: f64 = 0.85;

/// Widths b_1, b_2 between the rocking corners, m.
///
/// The weight N_i above a corner rests on a stress block of depth a = N_i / (0.85 f L). Its resultant lies at
/// a/2 from the face on either side, so that b_i = b - a. `above_kg` are the masses above the ground and
/// above the crack.
///
/// # Errors
/// A strength that is not positive, or so low that a corner crushes through the wall.
pub fn crushed_widths_m(
    thickness_m: f64,
    length_m: f64,
    above_kg: [f64; 2],
    strength_pa: f64,
) -> Result<[f64; 2], ImpossibleWall> {
    let key = "corners.compressive_strength_pa";
    let refuse =
        |allowed: String| ImpossibleWall { key: key.into(), found: strength_pa.to_string(), allowed };
    if !(strength_pa > 0.0 && strength_pa.is_finite()) {
        return Err(refuse("a finite number above 0".to_owned()));
    }
    let depth_m = above_kg.map(|mass_kg| mass_kg * G_M_S2 / (BLOCK_STRENGTH * strength_pa * length_m));
    let deepest_m = depth_m[0].max(depth_m[1]);
    if deepest_m.is_nan() || deepest_m >= thickness_m {
        let least = strength_pa * deepest_m / thickness_m;
        return Err(refuse(format!("above {least:.4e} Pa, below which the corner crushes through the wall")));
    }
    Ok(depth_m.map(|a| thickness_m - a))
}
