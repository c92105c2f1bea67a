//! Step 7: for hypotheses that these tests cannot tell apart, the test that would.
//!
//! The first hypothesis is taken for the truth: a record there is, scaled, shakes it, and noise is added. The second is
//! fitted to that together with the tests there are. What then speaks more against it than against the first would part
//! them.

use super::answer::Findings;
use super::fit::{Fit, Problem, nats, shaken, windowed_error};
use super::hypothesis::Addition;
use super::trials::{FittedHypothesis, against, kinds};
use super::verdict::Verdict;
use crate::experiment::Sampled;
use crate::experiment::{TestData, Window, windows};
use crate::limits::{EQUIVALENT, NEXT_FACTORS, NEXT_FITTED, NEXT_PULLS};
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{Contact, RockingWall};
use mrbd_kernel::simulate::{Accuracy, Shaking, Simulator};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use serde::{Deserialize, Serialize};

/// Seed of the noise.
const SEED: u64 = 7;

/// What would part two hypotheses.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NextTests {
    /// Their names: the one taken for the truth, the other.
    pub rivals: [String; 2],
    /// Shaking, what parts them best first.
    pub shaking: Vec<NextShaking>,
    /// Slow pulls of the top against its floor.
    pub pull: Vec<NextPull>,
}

/// A record of a test, scaled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NextShaking {
    /// The test whose record it is.
    pub test: String,
    /// Factor on the record as it shook the wall there.
    pub scale: f64,
    /// What the wall of the first hypothesis does: `stood`, `collapsed` or `failed`.
    pub outcome: String,
    /// Windowed error of the second there, in units of the noise.
    pub error: Option<f64>,
    /// What speaks more against the second than against the first, natural logarithms of likelihood.
    pub nats: Option<f64>,
    /// Whether the second was fitted to it; else its values are those of the tests there are.
    pub fitted: bool,
}

/// A slow pull.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NextPull {
    /// Displacement of the top, m.
    pub displacement_m: f64,
    /// Force that holds the top there against its floor and what is added to it, N, under both hypotheses.
    pub force_n: [f64; 2],
}

/// What would part the answer from its nearest rival; `None` where the verdict is no class.
pub fn next_tests(findings: &Findings) -> Option<NextTests> {
    if findings.found.verdict != Verdict::Class {
        return None;
    }
    let first = &findings.found.after;
    let second = nearest_rival(findings);
    let pair = Pair { findings, first, second };
    let mut shaking = pair.candidates();
    shaking.sort_by(|a, b| b.0.nats.unwrap_or(0.0).total_cmp(&a.0.nats.unwrap_or(0.0)));
    for (row, data) in shaking.iter_mut().take(NEXT_FITTED) {
        if let Some(better) = data.as_ref().and_then(|data| pair.fitted(row, data)) {
            *row = better;
        }
    }
    let mut shaking = shaking.into_iter().map(|(row, _)| row).collect::<Vec<_>>();
    shaking.sort_by(|a, b| {
        let of = |row: &NextShaking| (row.fitted, row.nats.unwrap_or(0.0));
        of(b).partial_cmp(&of(a)).unwrap_or(std::cmp::Ordering::Equal)
    });
    Some(NextTests { rivals: [first, second].map(name), shaking, pull: pair.pulls()? })
}

fn name(tried: &FittedHypothesis) -> String {
    let names = tried.hypothesis.additions.iter().map(Addition::name).collect::<Vec<_>>();
    if names.is_empty() { "the wall's own numbers".into() } else { names.join(" + ") }
}

/// The best of what explains the tests as well, without the answer in it if there is such; the wall's own numbers where no addition does.
fn nearest_rival<'f>(findings: &'f Findings) -> &'f FittedHypothesis {
    let (data, found) = (findings.data(), &findings.found);
    let limit = against(&data, &found.after) + EQUIVALENT;
    let other = |t: &&FittedHypothesis| {
        !t.hypothesis.additions.contains(&Addition::Placebo) && kinds(t) != kinds(&found.after)
    };
    let rivals = || found.tried.iter().filter(other).filter(|t| against(&data, t) < limit);
    let has_answer = |t: &FittedHypothesis| {
        found.after.hypothesis.additions.iter().all(|own| t.hypothesis.additions.contains(own))
    };
    rivals().find(|t| !has_answer(t)).or_else(|| rivals().next()).unwrap_or(&found.recalibrated)
}

struct Pair<'a> {
    findings: &'a Findings<'a>,
    first: &'a FittedHypothesis,
    second: &'a FittedHypothesis,
}

/// A simulated test and its windows, numbered after those of the experiment.
struct SimulatedTest {
    tests: Vec<TestData>,
    windows: Vec<Window>,
    /// What speaks against the first in it.
    first_nats: f64,
}

impl Pair<'_> {
    fn candidates(&self) -> Vec<(NextShaking, Option<SimulatedTest>)> {
        let tests = self.findings.tests.iter();
        let each = tests.flat_map(|test| NEXT_FACTORS.map(|factor| (test, factor)));
        // The tests there are have told what they can.
        let scaled = each.filter(|(_, factor)| *factor != 1.0);
        scaled.map(|(test, factor)| self.candidate(test, factor)).collect()
    }

    /// One candidate, the second hypothesis with its values as they are.
    fn candidate(&self, test: &TestData, factor: f64) -> (NextShaking, Option<SimulatedTest>) {
        let mut row = NextShaking {
            test: test.name.clone(),
            scale: factor,
            outcome: "failed".to_owned(),
            error: None,
            nats: None,
            fitted: false,
        };
        let made = self.simulated(test, factor, &mut row.outcome);
        if let Some(made) = &made
            && let Some(fit) = states(made, self.second, &self.second.fit.values)
        {
            row.error = windowed_error(&fit.windows);
            row.nats = Some(nats(&fit.windows) - made.first_nats);
        }
        (row, made)
    }

    /// The first hypothesis under a scaled record, as it would be measured.
    fn simulated(&self, test: &TestData, factor: f64, outcome: &mut String) -> Option<SimulatedTest> {
        let physics = self.first.hypothesis.physics(&self.first.fit.values)?;
        let scaled = |record: &Accelerogram| record.scaled(factor);
        let shaking = Shaking {
            horizontal: test.shaking.horizontal.as_ref().map(scaled),
            vertical: test.shaking.vertical.as_ref().map(scaled),
            tail_s: test.shaking.tail_s,
        };
        let simulator =
            Simulator::new(&physics.wall, &shaken(&shaking, physics.reversed_ratio), Accuracy::default());
        let mut sampled = Sampled::at(&test.time_s);
        *outcome = simulator.run(&mut sampled).outcome.name().to_owned();
        let normal = test.noise_rad.map(|sd| Normal::new(0.0, sd));
        let [Ok(lower), Ok(upper)] = normal else { return None };
        let mut random = ChaCha8Rng::seed_from_u64(SEED);
        let reading = physics.wall.reading();
        let mut read = |(theta, _): &([f64; 2], Contact)| {
            let [one, two] = reading.of(*theta);
            [one + lower.sample(&mut random), two + upper.sample(&mut random)]
        };
        let theta_rad = sampled.rows().iter().map(&mut read).collect::<Vec<_>>();
        let time_s = test.time_s[..theta_rad.len()].to_vec();
        let made = TestData { shaking, theta_rad, time_s, ..test.clone() };
        let mut windows = windows(std::slice::from_ref(&made));
        windows.iter_mut().for_each(|w| w.test = self.findings.tests.len());
        let mut tests = self.findings.tests.clone();
        tests.push(made);
        let mut made = SimulatedTest { tests, windows, first_nats: 0.0 };
        let own = states(&made, self.first, &self.first.fit.values)?;
        made.first_nats = nats(&own.windows);
        Some(made)
    }

    /// The second hypothesis fitted to the tests to fit and to a simulated one.
    fn fitted(&self, row: &NextShaking, made: &SimulatedTest) -> Option<NextShaking> {
        let old = &self.findings.windows[0];
        let windows = [&old[..], &made.windows].concat();
        let problem = Problem { tests: &made.tests, windows: &windows, budget: None };
        let second = self.second;
        let new = states(made, second, &second.fit.values)?;
        let x = second.fit.windows.iter().chain(&new.windows).map(|w| w.x.clone()).collect::<Vec<_>>();
        let start = problem.states(&second.hypothesis, &second.fit.values, &x, 1, false)?;
        let fit = problem.fit_finely(&second.hypothesis, start)?;
        let cost = |tried: &FittedHypothesis, values: &[f64]| 0.5 * tried.hypothesis.prior_penalty(values);
        let first = nats(&self.first.fit.windows) + cost(self.first, &self.first.fit.values);
        let both = nats(&fit.windows) + cost(second, &fit.values);
        Some(NextShaking {
            error: windowed_error(&fit.windows[old.len()..]),
            nats: Some(both - first - made.first_nats),
            fitted: true,
            ..row.clone()
        })
    }

    fn pulls(&self) -> Option<Vec<NextPull>> {
        let wall = |tried: &FittedHypothesis| {
            Some(RockingWall::new(&tried.hypothesis.physics(&tried.fit.values)?.wall))
        };
        let walls = [wall(self.first)?, wall(self.second)?];
        let thickness_m = self.findings.experiment.wall.parameters().thickness_m;
        let pull = |share: f64| {
            let displacement_m = (share * thickness_m).min(self.findings.experiment.scales.displacement_m);
            let force_n = walls.each_ref().map(|wall| -wall.top_force_n(displacement_m, 0.0, 0.0));
            NextPull { displacement_m, force_n }
        };
        Some(NEXT_PULLS.map(pull).to_vec())
    }
}

/// The states of the windows of a simulated test under a hypothesis.
fn states(made: &SimulatedTest, tried: &FittedHypothesis, values: &[f64]) -> Option<Fit> {
    let problem = Problem { tests: &made.tests, windows: &made.windows, budget: None };
    problem.states(&tried.hypothesis, values, &problem.measured_states(), 4, true)
}
