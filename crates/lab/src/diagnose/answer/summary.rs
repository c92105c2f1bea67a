//! `diagnosis.json` as one struct: what `mrbd diagnose` writes is what its page and the scorer of blind cases read.
//!
//! A number that does not exist is `null`. Errors over windows are in standard deviations of the measured noise (1 is a
//! perfect model). What speaks against a hypothesis is in natural logarithms of likelihood.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::diagnose::certainty::{Confused, NextTests};
use crate::diagnose::discovery::{Guard, Stability};
use crate::diagnose::verdict::{OtherLaw, Remainder, Verdict};
use crate::experiment::Purpose;
use mrbd_kernel::model::Pair;

/// Kind of results, in `diagnosis.json` and in the manifest of its folder.
pub const KIND: &str = "diagnosis";

/// The verdict, with everything it rests on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Always [`KIND`].
    pub kind: String,
    /// The verdict.
    pub verdict: Verdict,
    /// Where the answer acts, or a force is missing.
    pub place: Option<String>,
    /// The effects of the answer; for `place_only` one without a name.
    pub effects: Vec<FoundEffect>,
    /// Of a class of formulas the others, each as its effects; the simplest stands in `effects`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub equivalent_formulas: Vec<Vec<FoundEffect>>,
    /// A force that no formula holds for, by displacement and then by velocity of the top; empty for any other verdict.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub curves: Vec<ForceCurve>,
    /// How sure the form of a formula is; absent where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stability: Option<Stability>,
    /// A formula fitted to all tests together, where those held out are followed only so; absent where its numbers need not move.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fitted_to_all: Option<FittedToAll>,
    /// Windows of the tests held out that were fitted too, because the tests fitted do not show all of the formula, and those that judge it;
    /// absent where no window held out was fitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shared_held_out: Option<SharedHeldOut>,
    /// Windowed errors of the wall without effects, where it follows the tests fitted and misses those held out, and nothing is known of that;
    /// absent otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub missed_held_out: Option<FitHeldOut<f64>>,
    /// Laws outside the catalogue, and names, that were refused though they fit, with what refused each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub refused: Vec<RefusedLaw>,
    /// Of which laws how many fits ended because they had worked as much as they may: none of these is an answer.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub unfinished: BTreeMap<String, usize>,
    /// Kinds, or numbers of the wall, that these tests cannot tell apart.
    pub equivalent: Vec<String>,
    /// Uncertain numbers of the wall as the answer has them.
    pub wall: Vec<WallFit>,
    /// Errors and noise of every test.
    pub tests: Vec<TestErrors>,
    /// What a named effect takes away and leaves, where it leaves more than noise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub remainder: Option<Remainder>,
    /// Shares of the squared windowed error above noise that a name with a remainder takes away.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub explained: Option<FitHeldOut<f64>>,
    /// Error that no hypothesis takes away, rad: root mean square over windows, without that of the noise. Beside names with a
    /// remainder, and where nothing follows the tests.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub model_error_rad: Option<f64>,
    /// What speaks for another law than the best of the catalogue, where that closes the gap.
    pub other_law: Option<OtherLaw>,
    /// Windowed error over all tests, in standard deviations of the noise.
    pub windowed_error: Stages<Option<f64>>,
    /// What speaks against each wall, in natural logarithms of likelihood.
    pub against: Stages<f64>,
    /// Numbers of windows.
    pub windows: WindowCounts,
    /// How large single effects could still be.
    pub could_hide: Vec<CouldHide>,
    /// Effects that others imitate in these tests, the best imitated first.
    pub confused: Vec<Confused>,
    /// Every hypothesis that was tried, the best first.
    pub rivals: Vec<Rival>,
    /// Laws of the user's own, in the order of the experiment; they do not enter the verdict.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hypotheses: Vec<OwnHypothesis>,
    /// The force that is missing at the top.
    pub missing_force: MissingForce,
    /// Tests that would part a class; `None` for any other verdict.
    pub next_tests: Option<NextTests>,
    /// Name and version of the program.
    pub program: String,
    /// The experiment file, as it was named.
    pub experiment: String,
}

impl Summary {
    /// Whether the verdict gives effects by name.
    pub fn has_names(&self) -> bool {
        matches!(self.verdict, Verdict::Named | Verdict::Class)
    }

    /// Whether the verdict gives a law outside the catalogue as a formula.
    pub fn has_formula(&self) -> bool {
        self.verdict.is_formula()
    }

    /// Whether the updated wall is another than the wall as given.
    pub fn has_updated_wall(&self) -> bool {
        self.has_names()
            || self.has_formula()
            || matches!(self.verdict, Verdict::Recalibrated | Verdict::Curve)
    }
}

/// The wall as given, with its uncertain numbers fitted, and as the answer has it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Stages<T> {
    /// As given.
    pub before: T,
    /// With its uncertain numbers fitted.
    pub recalibrated: T,
    /// As the answer has it.
    pub after: T,
}

/// The wall as given, and as the answer has it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BeforeAfter<T> {
    /// As given.
    pub before: T,
    /// As the answer has it.
    pub after: T,
}

/// Tests to fit, and tests held out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FitHeldOut<T> {
    /// Tests to fit.
    pub fit: T,
    /// Tests held out.
    pub held_out: T,
}

/// How many windows of the tests held out were fitted too, and how many judge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct SharedHeldOut {
    /// Fitted.
    pub fitted: usize,
    /// Held out still.
    pub judging: usize,
}

/// A formula with numbers that the tests fitted leave open, as all tests together want them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FittedToAll {
    /// The formula so.
    pub effects: Vec<FoundEffect>,
    /// Its windowed errors, in standard deviations of the noise; the tests held out are fitted here.
    pub windowed_error: FitHeldOut<Option<f64>>,
    /// What the tests fitted lose by it, in natural logarithms of likelihood.
    pub lost: f64,
}

/// An effect of the answer.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct FoundEffect {
    /// Its kind in wall files; `None` for a law outside the catalogue.
    pub kind: Option<String>,
    /// Kind and variant, such as `joint_damping.ground`; absent for a law outside the catalogue.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Where it acts.
    pub place: String,
    /// Its numbers by key, in the units that the keys say.
    pub parameters: BTreeMap<String, f64>,
    /// Their 90 % intervals, in the same units.
    pub interval: BTreeMap<String, [f64; 2]>,
    /// The effect in the wall file that it is, where that goes by another name, or two with ` + ` between.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub written_as: Option<String>,
    /// Displacement over which friction sets in, m, where it does not jump.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sets_in_over_m: Option<f64>,
    /// A law outside the catalogue: the force or moment on the wall, as formulas of wall files have it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub formula: Option<String>,
    /// Of a formula with round exponents: how far from round they may be.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub round_exponents: Option<RoundExponents>,
    /// The states that it carries along.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub states: Vec<FoundState>,
    /// Units of its parameters by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub units: BTreeMap<String, String>,
    /// What the tests excited of its variables: `x_m` and `v_m_s` at the top, `phi_rad` and `w_rad_s` at joints.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub range: BTreeMap<String, [f64; 2]>,
}

/// Exponents that a formula has as round numbers, because another does no better.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RoundExponents {
    /// The formula with these as parameters.
    pub formula: String,
    /// What they are told as.
    pub told: BTreeMap<String, f64>,
    /// Their 90 % intervals where they are fitted, widened to what they are told as.
    pub interval: BTreeMap<String, [f64; 2]>,
    /// Those of thresholds and the like beside exponents that are fitted, in their own units.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub beside: BTreeMap<String, [f64; 2]>,
}

/// A state that a law carries along, as formulas of wall files have it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FoundState {
    /// Its name in the formula.
    pub name: String,
    /// How fast it changes.
    pub rate: String,
    /// Its value at the start.
    pub start: f64,
    /// Its unit; empty for a pure number.
    pub unit: String,
}

/// A law that was refused.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RefusedLaw {
    /// Its formulas with their places, or the names of effects.
    pub name: String,
    /// Its formulas with their numbers, without intervals; empty for a name.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub effects: Vec<FoundEffect>,
    /// Uncertain numbers of the wall beside it, by key.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub wall: BTreeMap<String, f64>,
    /// What refused it. [`Guard::Bend`] and [`Guard::Trend`] are asked of a law alone that at most one other guard refuses, and
    /// whose windows are followed.
    pub guards: Vec<Guard>,
    /// Windowed error, in standard deviations of the noise; absent where points alone have seen it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub windowed_error: Option<FitHeldOut<Option<f64>>>,
}

/// A force on the wall against one quantity, straight between knots, and nothing at rest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ForceCurve {
    /// `displacement_m` or `velocity_m_s`, of the top.
    pub against: String,
    /// Knots, in that unit.
    pub at: Vec<f64>,
    /// Force, N.
    pub force_n: Vec<f64>,
    /// Its 90 % interval, N.
    pub interval_n: Vec<[f64; 2]>,
    /// What the tests excited.
    pub range: [f64; 2],
}

/// An uncertain number of the wall.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WallFit {
    /// Its dotted key, or C_l.
    pub key: String,
    /// Unit of all values.
    pub unit: String,
    /// In the wall file.
    pub before: f64,
    /// Standard deviation known beforehand.
    pub prior_sd: Option<f64>,
    /// As fitted.
    pub after: f64,
    /// Standard deviation by the curvature of the fit; `None` where it leaves no trace.
    pub sd: Option<f64>,
}

/// A test: how well it is followed, and its noise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TestErrors {
    /// Name in the experiment.
    pub name: String,
    /// Whether it was fitted or held out.
    #[serde(rename = "use")]
    pub purpose: Purpose,
    /// Windowed error, in standard deviations of the noise; `None` where the wall does not move.
    pub windowed_error: BeforeAfter<Option<f64>>,
    /// Error of a whole run (Eq. 8); `None` if the run failed.
    pub wme: BeforeAfter<Option<f64>>,
    /// Windowed error that noise alone leaves, in its standard deviations: 1.
    pub noise_floor: f64,
    /// Standard deviation of the noise of θ_1 and θ_2, rad.
    pub noise_rad: Pair,
    /// Gains of the sensors without which patterns were read.
    pub read_gain: Pair,
}

/// Numbers of windows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct WindowCounts {
    /// Fitted.
    pub fit: usize,
    /// Held out.
    pub held_out: usize,
    /// Of both, with a joint open at the start by less than the noise.
    pub opened: usize,
}

/// How large an effect could be without a name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CouldHide {
    /// Its kind in wall files.
    pub kind: String,
    /// Kind and variant.
    pub name: String,
    /// Key of its first number, of which all sizes are.
    pub parameter: String,
    /// Unit of the sizes.
    pub unit: String,
    /// Fitted size, less that which does nothing.
    pub estimate: f64,
    /// Its standard deviation.
    pub sd: f64,
    /// Smallest size that differs from nothing by more than chance.
    pub smallest_detectable: f64,
    /// Smallest size that would be named.
    pub named_from: f64,
    /// Size that would matter.
    pub matters: f64,
}

/// A hypothesis that was tried.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rival {
    /// What is added to the wall.
    pub name: String,
    /// The same by the names of answers.
    pub kinds: Vec<String>,
    /// Where the first addition acts.
    pub place: Option<String>,
    /// The numbers of the additions.
    pub parameters: Vec<FittedNumber>,
    /// Windowed error, in standard deviations of the noise.
    pub windowed_error: FitHeldOut<Option<f64>>,
    /// What speaks against it, in natural logarithms of likelihood.
    pub against: Against,
    /// Mean error of whole runs (Eq. 8).
    pub wme: FitHeldOut<Option<f64>>,
    /// Least and largest of that error over numbers that fit as well.
    pub wme_range: FitHeldOut<Option<[f64; 2]>>,
}

/// A law of the user's own, fitted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OwnHypothesis {
    /// Its name in the experiment.
    pub name: String,
    /// Where it acts.
    pub place: String,
    /// The formula.
    pub formula: String,
    /// Its numbers as fitted, in their units; empty where no fit makes a wall.
    pub parameters: Vec<FittedNumber>,
    /// Windowed error, in standard deviations of the noise.
    pub windowed_error: FitHeldOut<Option<f64>>,
    /// What speaks against it, in natural logarithms of likelihood; `None` where no fit makes a wall.
    pub against: Option<Against>,
    /// Whether what it leaves is near enough to noise to be the truth, in tests held out too.
    pub closes_gap: bool,
}

/// What speaks against a hypothesis, in natural logarithms of likelihood.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Against {
    /// In the tests to fit, with the price of every added number.
    pub fit: f64,
    /// In the tests held out.
    pub held_out: f64,
    /// In all tests.
    pub all: f64,
}

/// A fitted number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FittedNumber {
    /// Key, of the wall file or of the effect.
    pub key: String,
    /// Unit of value and deviation.
    pub unit: String,
    /// As fitted.
    pub value: f64,
    /// Standard deviation by the curvature of the fit; `None` where it leaves no trace.
    pub sd: Option<f64>,
}

/// The force missing at the top, measured without a hypothesis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MissingForce {
    /// Stretches in which it was measured.
    pub points: usize,
    /// Under the wall as given.
    pub before: ForceSize,
    /// Under the updated wall.
    pub after: ForceSize,
    /// Share of the squared moments off the direction of such a force, the median over stretches.
    pub median_share_off_top: Option<f64>,
    /// How much of it is a curve against one quantity alone.
    pub explained_by: ExplainedBy,
    /// Stretches clear of the noise in which the moments have a direction.
    pub points_with_direction: usize,
    /// Arms of a force at the top about the joints, upright: of θ_1 and θ_2, m.
    pub arms_of_top_m: Pair,
}

/// Size of a force over stretches.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ForceSize {
    /// Root mean square, N.
    pub rms_n: f64,
    /// What the noise of the rotations alone makes of it, N.
    pub noise_rms_n: f64,
}

/// Shares of the squared missing force that are a curve against one quantity; `None` where it is hardly more than noise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ExplainedBy {
    /// Displacement of the top.
    pub displacement_m: Option<f64>,
    /// Its velocity.
    pub velocity_m_s: Option<f64>,
    /// Its absolute acceleration.
    pub acceleration_m_s2: Option<f64>,
}
