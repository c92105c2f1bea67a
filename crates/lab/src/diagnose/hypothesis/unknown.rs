//! The numbers to be found: their bounds, what was known of them before the tests, and the size that would matter.

use crate::diagnose::formula::Curve;
use crate::experiment::TestData;
use crate::limits::{MOST_OF_LAW, PRIOR_REACH, WIDE_PRIOR};
use mrbd_formula::Parameter;
use mrbd_kernel::model::{Quantity, RockingWall, Wall, WallParameters};

/// Where the value of an unknown goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Slot {
    /// A number of the wall.
    Number(&'static WallNumber),
    /// C_l by its index from 0.
    Coefficient(usize),
    /// Addition by its index, parameter by its index.
    Added(usize, usize),
    /// Parameter of the formula that stands last in the wall, by its index.
    Written(usize),
    /// A number that is sought elsewhere, by its index there.
    Sought(usize),
}

/// One number to be found.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// Key, of the wall file or of the effect.
    pub key: String,
    /// Unit.
    pub unit: &'static str,
    /// Where the search starts: the wall file's value, or the value that does nothing.
    pub start: f64,
    /// A size that matters.
    pub scale: f64,
    /// Least value.
    pub lower: f64,
    /// Largest value.
    pub upper: f64,
    /// Standard deviation known beforehand, about the start.
    pub prior_sd: Option<f64>,
    /// What its value means.
    pub measure: Measure,
    /// Where its value goes.
    pub(super) slot: Slot,
}

/// What the value of an unknown means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Measure {
    /// The number itself.
    Itself,
    /// 1/sqrt(k) of a stiffness k: the width of contact on a bed goes with it, and a sharp edge is zero.
    Softness,
}

impl Measure {
    /// The value of a number of the wall file.
    pub fn value_of(self, number: f64) -> f64 {
        match self {
            Measure::Itself => number,
            Measure::Softness => number.sqrt().recip(),
        }
    }

    /// The number of the wall file that a value means.
    pub fn number(self, value: f64) -> f64 {
        match self {
            Measure::Itself => value,
            Measure::Softness => (value * value).recip(),
        }
    }

    /// The standard deviation of the number by that of the value.
    pub fn sd(self, value: f64, sd: f64) -> f64 {
        match self {
            Measure::Itself => sd,
            Measure::Softness => 2.0 * sd * self.number(value) / value,
        }
    }

    /// The interval of the number by that of the value, its lower end first.
    pub fn interval(self, [low, high]: [f64; 2]) -> [f64; 2] {
        match self {
            Measure::Itself => [low, high],
            Measure::Softness => [self.number(high), self.number(low)],
        }
    }
}

/// A parameter of a formula of the user's own reaches from this share of what is written to this multiple.
const REACH_OF_WRITTEN: [f64; 2] = [1e-3, 10.0];

impl Unknown {
    /// The parameter with this index of a formula of the user's own.
    pub(super) fn of_formula(index: usize, parameter: &Parameter) -> Self {
        let ends = REACH_OF_WRITTEN.map(|share| share * parameter.value);
        Self {
            key: parameter.name.clone(),
            // Units of formulas are the user's: they stand beside the formula.
            unit: "",
            start: parameter.value,
            scale: parameter.value.abs(),
            measure: Measure::Itself,
            lower: ends[0].min(ends[1]),
            upper: ends[0].max(ends[1]),
            prior_sd: None,
            slot: Slot::Written(index),
        }
    }

    /// The force at a knot (part, knot) of a curve, the number with this index of the hypothesis' only addition. A curve of
    /// velocity never feeds the wall.
    pub(super) fn of_knot(index: usize, curve: &Curve, (p, k): (usize, usize)) -> Self {
        let part = &curve.parts[p];
        let most_n = MOST_OF_LAW * part.largest_n();
        let may_push = |side: f64| p == 0 || part.at[k] * side < 0.0;
        Self {
            key: format!("force_n at {:.4} {}", part.at[k], ["m", "m/s"][p]),
            unit: "N",
            start: 0.0,
            scale: part.largest_n(),
            lower: if may_push(-1.0) { -most_n } else { 0.0 },
            upper: if may_push(1.0) { most_n } else { 0.0 },
            prior_sd: None,
            measure: Measure::Itself,
            slot: Slot::Added(0, index),
        }
    }

    /// A number that is sought elsewhere, by its index there; `start` is its value in the wall file.
    pub fn sought(
        index: usize,
        key: &str,
        start: f64,
        [lower, upper]: [f64; 2],
        prior_sd: Option<f64>,
    ) -> Self {
        let scale = if start == 0.0 { upper - lower } else { start.abs() };
        let slot = Slot::Sought(index);
        Self {
            key: key.into(),
            unit: "",
            start,
            scale,
            lower,
            upper,
            prior_sd,
            measure: Measure::Itself,
            slot,
        }
    }

    /// Whether it is a number of the addition with this index.
    pub fn belongs_to(&self, index: usize) -> bool {
        matches!(self.slot, Slot::Added(i, _) if i == index)
    }

    /// The value nearest to this one between its bounds.
    pub fn within(&self, value: f64) -> f64 {
        value.clamp(self.lower, self.upper)
    }

    /// Whether it tells how much less faster impacts keep.
    pub fn fades(&self) -> bool {
        self.unit == Quantity::ImpactFading.unit()
    }

    /// Whether it is the softness of a bed.
    pub fn is_softness(&self) -> bool {
        self.measure == Measure::Softness
    }

    /// The number of the wall file that a value means.
    pub fn number(&self, value: f64) -> f64 {
        self.measure.number(value)
    }

    /// A value with a share of its distance from the start.
    pub fn with_share(&self, share: f64, value: f64) -> f64 {
        (self.start + share * (value - self.start)).clamp(self.lower, self.upper)
    }
}

/// What was known of a number of the wall before the tests.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Nuisance {
    /// A number, with its relative standard deviation.
    Number(&'static WallNumber, f64),
    /// C_l by its index from 0, with its relative standard deviation.
    Coefficient(usize, f64),
}

impl Nuisance {
    /// Whether what was known says so little that the number was not known.
    pub fn is_wide(&self) -> bool {
        let (Nuisance::Number(_, sd) | Nuisance::Coefficient(_, sd)) = self;
        *sd > WIDE_PRIOR
    }

    /// Its dotted key, or C_l.
    fn key(&self) -> String {
        match self {
            Nuisance::Number(number, _) => number.key.to_owned(),
            Nuisance::Coefficient(l, _) => format!("C_{}", l + 1),
        }
    }

    /// Its value in a wall.
    pub fn value(&self, wall: &WallParameters) -> f64 {
        match self {
            Nuisance::Number(number, _) => (number.get)(wall),
            Nuisance::Coefficient(l, _) => wall.restitution.coefficients[*l],
        }
    }

    /// The number to be found.
    pub(super) fn unknown(&self, base: &WallParameters) -> Unknown {
        let (unit, relative, slot) = match *self {
            Nuisance::Number(number, sd) => (number.quantity.unit(), sd, Slot::Number(number)),
            Nuisance::Coefficient(l, sd) => ("", sd, Slot::Coefficient(l)),
        };
        let value = self.value(base);
        let sd = relative * value.abs();
        let reach = PRIOR_REACH * sd;
        // A prior as wide as the value itself does not reach what no wall has.
        let lower = if value > 0.0 { (value - reach).max(0.02 * value) } else { value - reach };
        Unknown {
            measure: Measure::Itself,
            key: self.key(),
            unit,
            start: value,
            scale: value.abs(),
            lower,
            upper: value + reach,
            prior_sd: Some(sd),
            slot,
        }
    }
}

/// One number of the wall file.
#[derive(Debug)]
pub struct WallNumber {
    /// Dotted key of the wall file.
    pub key: &'static str,
    /// What it measures, from which its unit follows.
    pub quantity: Quantity,
    /// Reads it.
    pub get: fn(&WallParameters) -> f64,
    /// Changes it.
    pub set: fn(&mut WallParameters, f64),
}

impl PartialEq for WallNumber {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

macro_rules! number {
    ($key:literal, $quantity:ident, $field:ident) => {
        WallNumber {
            key: $key,
            quantity: Quantity::$quantity,
            get: |p| p.$field,
            set: |p, value| p.$field = value,
        }
    };
}

/// Every number a prior or a rival may name; the first with a given last word is meant by that word alone.
pub static WALL_NUMBERS: [WallNumber; 10] = [
    number!("wall.mass_kg", TopMass, mass_kg),
    number!("wall.thickness_m", TopDisplacement, thickness_m),
    number!("wall.height_m", TopDisplacement, height_m),
    WallNumber {
        key: "wall.crack_height_m",
        quantity: Quantity::TopDisplacement,
        get: |p| p.crack_height_m.unwrap_or(p.height_m),
        set: |p, value| p.crack_height_m = p.crack_height_m.map(|_| value),
    },
    number!("corners.lower_width_m", CornerWidth, lower_width_m),
    number!("corners.upper_width_m", CornerWidth, upper_width_m),
    number!("diaphragm.mass_kg", TopMass, diaphragm_mass_kg),
    number!("diaphragm.carriage_mass_kg", TopMass, carriage_mass_kg),
    number!("diaphragm.stiffness_n_per_m", TopStiffness, stiffness_n_per_m),
    number!("diaphragm.eccentricity_m", TopDisplacement, eccentricity_m),
];

/// The number a key names, with or without its table.
pub fn wall_number(key: &str) -> Option<&'static WallNumber> {
    let last = |number: &&WallNumber| number.key.rsplit('.').next() == Some(key);
    WALL_NUMBERS.iter().find(|number| number.key == key).or_else(|| WALL_NUMBERS.iter().find(last))
}

/// Sizes of the measured motion of the top and of the forces there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// Largest displacement of the top while the wall stands, m.
    pub displacement_m: f64,
    /// Largest rotation while the wall stands, rad.
    pub rotation_rad: f64,
    /// Frequency of the wall on its floor, rad/s.
    pub frequency_rad_s: f64,
    /// Force of the floor at the largest displacement, or a tenth of the weight, N.
    pub force_n: f64,
    /// Moment that a joint takes to open, m g b/2, N m.
    pub moment_n_m: f64,
    /// Width between corners, m.
    pub width_m: f64,
    /// Length of the strip, m.
    pub length_m: f64,
    /// What was known of the gains of the sensors: a standard deviation about 1; `None`: nothing.
    pub sensor_gain_sd: Option<f64>,
}

/// At a fading of the size that matters, impacts at the speed of the largest swing keep exp of minus this: a quarter less.
pub const FADES: f64 = 0.3;

impl Scales {
    /// Of a wall in its tests.
    pub fn of(wall: &Wall, tests: &[TestData]) -> Self {
        let p = wall.parameters();
        let largest = |test: &TestData| {
            let theta = |i: usize| test.theta_rad.iter().map(|pair| pair[i]).collect::<Vec<_>>();
            [0, 1].map(|i| largest_rad(&theta(i), wall.alpha_i_rad()[i]))
        };
        let rotation_rad = tests.iter().flat_map(largest).fold(0.0, f64::max);
        let displacement_m = rotation_rad * p.height_m;
        let weight_n = p.mass_kg * mrbd_kernel::model::G_M_S2;
        Self {
            displacement_m,
            rotation_rad,
            frequency_rad_s: 1.0 / RockingWall::new(wall).response_time_s(),
            force_n: (p.stiffness_n_per_m * displacement_m).max(0.1 * weight_n),
            moment_n_m: 0.5 * weight_n * p.lower_width_m,
            width_m: p.lower_width_m,
            length_m: p.length_m,
            sensor_gain_sd: None,
        }
    }

    /// A size of this quantity that would matter.
    pub fn size(&self, quantity: Quantity) -> f64 {
        let velocity_m_s = self.displacement_m * self.frequency_rad_s;
        match quantity {
            Quantity::TopForce => self.force_n,
            Quantity::TopStiffness => self.force_n / self.displacement_m,
            Quantity::TopCubicStiffness => self.force_n / self.displacement_m.powi(3),
            Quantity::TopDamping => self.force_n / velocity_m_s,
            Quantity::TopMass => self.force_n / (velocity_m_s * self.frequency_rad_s),
            Quantity::TopDisplacement => self.displacement_m,
            // A quarter of the moment that opens a joint: beside it a damper there is as large as the others at the top.
            Quantity::JointDamping => 0.25 * self.moment_n_m / (self.rotation_rad * self.frequency_rad_s),
            Quantity::CornerWidth => 0.1 * self.width_m,
            // The bed on which the largest rotation has a third of the width in contact: 2 N/(k L φ) = (b/3)².
            Quantity::BedStiffness => {
                36.0 * self.moment_n_m / (self.length_m * self.width_m.powi(3) * self.rotation_rad)
            }
            // A tenth of the width along the largest rotation.
            Quantity::EdgeRadius => 0.1 * self.width_m / self.rotation_rad,
            // What the weight crushes to a tenth of the width: 0.85 f L b/10 = W.
            Quantity::Strength => 20.0 * self.moment_n_m / (0.85 * self.length_m * self.width_m.powi(2)),
            Quantity::JointRotation => 0.3 * self.rotation_rad,
            Quantity::MomentShare => 0.3,
            Quantity::Rotation => 0.1 * self.rotation_rad,
            Quantity::Time => 0.05 / self.frequency_rad_s,
            Quantity::Ratio | Quantity::ImpactFactor => 1.0,
            Quantity::ImpactFading => FADES / (self.width_m * self.rotation_rad * self.frequency_rad_s),
        }
    }
}

/// Largest rotation that a body comes back from, rad. A last swing beyond alpha (rad), where its own weight turns it
/// over, is its fall. It says nothing of a size, unless it is the only swing.
fn largest_rad(theta_rad: &[f64], alpha_rad: f64) -> f64 {
    let theta = theta_rad.iter().copied().filter(|t| t.is_finite()).collect::<Vec<_>>();
    let largest = |part: &[f64]| part.iter().fold(0.0, |most, t| f64::max(most, t.abs()));
    let Some(last) = theta.last().filter(|t| t.abs() > alpha_rad) else { return largest(&theta) };
    let came_back = theta.iter().rposition(|t| t * last <= 0.0);
    came_back.map_or(alpha_rad, |k| largest(&theta[..=k]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::hypothesis::example::SCALES;
    use mrbd_kernel::model::EffectKind;

    #[test]
    fn analytic_every_number_of_the_catalogue_has_a_size_that_matters() {
        for kind in EffectKind::ALL {
            for parameter in kind.entry().parameters {
                let size = SCALES.size(parameter.quantity);
                assert!(size.is_finite() && size > 0.0, "{} {}: {size}", kind.name(), parameter.key);
            }
        }
    }

    #[test]
    fn analytic_the_swing_in_which_a_wall_falls_tells_no_size() {
        let alpha_rad = 0.12;
        let returns = [0.0, 0.03, -0.01, -0.13, f64::NAN, 0.05, 0.02];
        assert_eq!(largest_rad(&returns, alpha_rad), 0.13);
        let falls = [0.0, 0.03, 0.01, -0.04, 0.02, 0.09, f64::NAN, 0.15, 0.3];
        assert_eq!(largest_rad(&falls, alpha_rad), 0.04);
        // Nothing before the fall.
        assert_eq!(largest_rad(&[0.01, 0.2, 0.31], alpha_rad), alpha_rad);
        assert_eq!(largest_rad(&[], alpha_rad), 0.0);
    }
}
