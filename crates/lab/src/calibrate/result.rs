//! What a calibration found, as it is written to `calibration.json`.

use serde::{Deserialize, Deserializer, Serialize};

use super::likelihood::ByLikelihood;
use crate::experiment::Alignment;

/// Everything a calibration found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// Version of the program.
    pub tool_version: String,
    /// SHA-256 of program, settings and files.
    pub request_sha256: String,
    /// Seed of every random number.
    pub seed: u64,
    /// Impact law.
    pub law: String,
    /// Capture velocity, rad/s.
    pub capture_velocity_rad_s: f64,
    /// Accuracy of the simulations.
    pub tolerance: f64,
    /// Where the bounds of C_l come from.
    pub bounds_source: String,
    /// The searches, at equal numbers of simulations but for `refined`, which has its own.
    pub methods: Vec<MethodResult>,
    /// The numbers fitted by likelihood; null where no windows could be cut from the tests.
    #[serde(default)]
    pub likelihood: Option<ByLikelihood>,
    /// The one vector for all tests.
    pub joint: Vector,
    /// Where it comes from: `likelihood` where that follows the tests to their noise; else `similarity`, `joint` or
    /// `refined`, whichever has the lowest mean WME, raised by a prior.
    pub joint_from: String,
    /// What the tests tell about each parameter.
    pub parameters: Vec<Estimate>,
    /// Correlations of the parameters with an interval, in the order of `parameters`; null where one has none.
    pub correlation: Vec<Vec<Option<f64>>>,
    /// The tests, held-out ones too.
    pub tests: Vec<TestResult>,
    /// How result and misfit depend on law and capture velocity.
    pub capture_study: Vec<CaptureRow>,
    /// Simulations of the whole calibration: as many after a stop as without one.
    pub simulations: usize,
    /// Time of the paper's own part (every test and the similarity), s; of a resumed calibration since it was resumed.
    pub paper_seconds: f64,
    /// Simulations of the paper's own part.
    pub paper_simulations: usize,
    /// Time of the whole, s; of a resumed calibration since it was resumed.
    pub seconds: f64,
    /// Simulations a second that were run in this time; those taken from the journal are none.
    pub simulations_per_second: f64,
}

impl Calibration {
    /// WME of what a search found, where it searched: in its test, or the mean of those to fit.
    pub fn wme_of(&self, method: &MethodResult) -> Option<f64> {
        match &method.test {
            Some(name) => {
                let k = self.tests.iter().position(|test| test.name == *name)?;
                *method.best.wme.get(k)?
            }
            None => method.best.mean_wme,
        }
    }
}

/// A vector and its misfits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Vector {
    /// Values, in the order of `parameters`; coefficients that never act are 1.
    pub values: Vec<f64>,
    /// Mean WME over the tests to fit.
    pub mean_wme: Option<f64>,
    /// WME in every test, held-out ones too; null where the run could not be finished.
    pub wme: Vec<Option<f64>>,
}

/// What a search found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MethodResult {
    /// `paper`, `adaptive`, `similarity`, `joint` or `refined`.
    pub method: String,
    /// The test, for searches in one.
    pub test: Option<String>,
    /// Its best vector.
    pub best: Vector,
    /// Simulations it took.
    pub simulations: usize,
    /// Generations after the first.
    pub generations: usize,
    /// Vectors simulated up to the end of each generation.
    pub vectors: Vec<usize>,
    /// Lowest cost after each generation; null while no vector has a finite one.
    #[serde(deserialize_with = "null_as_infinity")]
    pub best_costs: Vec<f64>,
    /// Sum of costs after each generation; null while a vector of the population has no finite cost (Fig. 6).
    #[serde(deserialize_with = "null_as_infinity")]
    pub cost_sums: Vec<f64>,
    /// Eq. 10, for the similarity.
    pub similarity: Option<f64>,
}

/// JSON has no infinity: costs that are not finite are written as null.
fn null_as_infinity<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
    let costs = Vec::<Option<f64>>::deserialize(deserializer)?;
    Ok(costs.into_iter().map(|cost| cost.unwrap_or(f64::INFINITY)).collect())
}

/// Whether the tests tell a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Identifiability {
    /// The interval is narrower than the bounds.
    Identified,
    /// The interval reaches over nearly all of the bounds: it acts, but these tests do not tell its value.
    NotToldByTheTests,
    /// It acts, but the searches ended apart: at least one has not arrived, and nothing is known of its value.
    SearchesDisagree,
    /// It acts, but the best vector leaves more of the tests than noise: the model is not the wall, or the search has
    /// not arrived. An interval is how far the tests let it scatter, and promises nothing.
    NotFollowed,
    /// Its transition never happens in a test to fit; left at 1.
    NeverActs,
    /// Its transition happens, but under this law there is nothing for it to scale; left at 1.
    NothingToScale,
}

impl Identifiability {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Identifiability::Identified => "identified",
            Identifiability::NotToldByTheTests => "not told by these tests",
            Identifiability::SearchesDisagree => "not identified: the searches disagree",
            Identifiability::NotFollowed => "not identified: the tests are not followed to their noise",
            Identifiability::NeverActs => "never acts, left at 1",
            Identifiability::NothingToScale => "nothing to scale, left at 1",
        }
    }
}

/// A point of a profile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ProfilePoint {
    /// From this value of the parameter ...
    pub from: f64,
    /// ... to this.
    pub to: f64,
    /// The lowest mean WME of all vectors simulated there; null where there are none.
    pub mean_wme: Option<f64>,
}

/// What the tests tell about a parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Its name.
    pub name: String,
    /// Lower bound.
    pub lower_bound: f64,
    /// Upper bound.
    pub upper_bound: f64,
    /// Value in the joint vector.
    pub value: f64,
    /// Whether the tests tell it.
    pub identifiability: Identifiability,
    /// By likelihood where that follows the tests to their noise; else 2.5 and 97.5 % quantiles over bootstrap replicates,
    /// widened to the vectors that the misfit does not exclude; null where it is left at 1, and where the searches disagree.
    pub interval_95: Option<[f64; 2]>,
    /// Whether the value lies on a bound, which then decides it.
    pub on_bound: bool,
    /// Best value in each test to fit in which it acts, by the better of the two searches.
    pub by_test: Vec<Option<f64>>,
    /// Standard deviation of those; null for fewer than two.
    pub spread_over_tests: Option<f64>,
    /// Lowest misfit by value.
    pub profile: Vec<ProfilePoint>,
}

impl Estimate {
    /// The same where nothing is identified. About a vector that is not the best one an interval promises what it cannot
    /// hold; about one that leaves more than noise it stays, as how far the tests let the value scatter.
    #[must_use]
    pub(super) fn not_identified(self, why: Identifiability) -> Self {
        let kept = self.interval_95.filter(|_| why == Identifiability::NotFollowed);
        if self.acts() { Self { identifiability: why, interval_95: kept, ..self } } else { self }
    }

    /// The same with another interval, widened to hold the value; over more than a share of the bounds it tells nothing.
    #[must_use]
    pub(super) fn with_interval(self, [low, high]: [f64; 2], tells_nothing: f64) -> Self {
        let interval = [low.min(self.value), high.max(self.value)];
        let wide = interval[1] - interval[0] > tells_nothing * (self.upper_bound - self.lower_bound);
        let told = if wide { Identifiability::NotToldByTheTests } else { Identifiability::Identified };
        if self.acts() { Self { identifiability: told, interval_95: Some(interval), ..self } } else { self }
    }

    fn acts(&self) -> bool {
        !matches!(self.identifiability, Identifiability::NeverActs | Identifiability::NothingToScale)
    }
}

/// A test under the joint vector.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TestResult {
    /// Its name.
    pub name: String,
    /// `fit` or `hold-out`.
    pub purpose: String,
    /// WME with C_l = 1 and the wall as given.
    pub wme_before: Option<f64>,
    /// WME with the joint vector.
    pub wme_joint: Option<f64>,
    /// Root mean square of the error of θ_1 and θ_2 with the wall as given, rad; null for a lost channel, or where
    /// the simulated wall fell.
    pub rms_rad_before: [Option<f64>; 2],
    /// The same with the joint vector.
    pub rms_rad_joint: [Option<f64>; 2],
    /// Best WME of the searches in this test alone; null for held-out tests.
    pub wme_alone: Option<f64>,
    /// Impacts by change of Table 2 with the joint vector.
    pub transitions: [u64; 8],
    /// When the measured wall collapsed, s.
    pub measured_collapse_s: Option<f64>,
    /// When the simulated wall collapsed, before the end of what counts, s.
    pub simulated_collapse_s: Option<f64>,
    /// Channels (θ_1, θ_2) that are lost.
    pub lost_channels: [bool; 2],
    /// Channels (θ_1, θ_2) measured at rest, whose denominator is the floor.
    pub channels_at_rest: [bool; 2],
    /// How the clocks of record and measurement were brought together.
    pub alignment: Alignment,
    /// How many samples of the measurement are independent.
    pub independent_samples: f64,
}

/// The joint search under one law and capture velocity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaptureRow {
    /// Impact law.
    pub law: String,
    /// Capture velocity, rad/s.
    pub capture_velocity_rad_s: f64,
    /// Mean WME of the joint vector, which was found under the experiment's own law and capture velocity.
    pub wme_of_joint: Option<f64>,
    /// Mean WME of the vector that is best here.
    pub wme_of_best: Option<f64>,
    /// The vector that is best here.
    pub best: Vec<f64>,
}

#[cfg(test)]
mod tests {
    use super::Identifiability::{Identified, NeverActs, NotFollowed, NotToldByTheTests, SearchesDisagree};
    use super::*;

    #[test]
    fn analytic_what_is_not_identified_has_no_interval_to_believe() {
        let estimate = |identifiability, interval_95| Estimate {
            name: "C_1".into(),
            lower_bound: 0.9,
            upper_bound: 1.05,
            value: 0.93,
            identifiability,
            interval_95,
            on_bound: false,
            by_test: Vec::new(),
            spread_over_tests: None,
            profile: Vec::new(),
        };
        let given = Some([0.929, 0.931]);
        for told in [Identified, NotToldByTheTests] {
            let apart = estimate(told, given).not_identified(SearchesDisagree);
            assert_eq!(apart, estimate(SearchesDisagree, None));
            assert_eq!(estimate(told, given).not_identified(NotFollowed), estimate(NotFollowed, given));
            for why in [SearchesDisagree, NotFollowed] {
                assert!(why.words().starts_with("not identified"));
            }
        }
        // What is left at 1 by the model stays so, whatever the searches did.
        let idle = estimate(NeverActs, None);
        assert_eq!(idle.clone().not_identified(SearchesDisagree), idle);
        assert_eq!(idle.clone().with_interval([0.9, 1.0], 0.5), idle);
        // 0.05 and 0.06 of bounds 0.15 wide.
        let by = |interval| estimate(NotFollowed, given).with_interval(interval, 0.35).identifiability;
        assert_eq!([by([0.9, 0.95]), by([0.9, 0.96])], [Identified, NotToldByTheTests]);
    }
}
