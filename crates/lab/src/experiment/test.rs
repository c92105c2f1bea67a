//! A test as the search sees it: how the wall was shaken, what was measured, and what a simulation costs.

use std::path::Path;

use super::alignment::{Alignment, aligned};
use super::file::{ExperimentFile, Purpose, TestTable};
use super::measured::Measured;
use super::misfit::{Comparison, Errors, Target};
use super::release::{counted_s, released};
use super::rotations::AtTimes;
use super::segments::{Segment, segments};
use super::shaking::{read_shaking, until};
use mrbd_files::error::{InputError, Result};
use mrbd_kernel::model::{State, Wall};
use mrbd_kernel::simulate::{
    Accuracy, History, Observer, Outcome, Response, Shaking, Simulator, Start, simulate_watched_side_by_side,
};

/// One test of an experiment.
#[derive(Debug, Clone)]
pub struct Test {
    /// Name in results.
    pub name: String,
    /// Whether the search sees it.
    pub purpose: Purpose,
    /// What was measured, in the record's time.
    pub measured: Measured,
    /// What of it counts.
    pub target: Target,
    /// When the measured wall collapsed, s.
    pub collapse_s: Option<f64>,
    /// How the clocks of record and measurement were brought together.
    pub alignment: Alignment,
    /// Whether the top was held sideways.
    pub top_held: bool,
    /// The ground motion as recorded.
    pub shaking: Shaking,
    /// The measured state from which the wall moves by itself; `None`: it starts from rest.
    release: Option<Start>,
    /// The same up to the end of what counts, made ready for the wall as given.
    simulator: Simulator,
    segments: Vec<Segment>,
}

/// What one simulation of one test gave.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulated {
    /// Eq. 8; `None` where the run could not be finished or was abandoned.
    pub wme: Option<f64>,
    /// `stood`, `collapsed`, `failed`, or `abandoned` when Eq. 8 had passed what was worth while.
    pub outcome: &'static str,
    /// When the simulated wall collapsed, s; in windows, the last of them that did.
    pub collapse_s: Option<f64>,
    /// Impacts that were changes of Table 2, C_1 … C_8 in order.
    pub transitions: [u64; 8],
    /// The errors by block.
    pub errors: Errors,
    /// Steps of the integration.
    pub steps: u64,
}

/// The tests of an experiment file at `path`, in its order; beginnings are matched by this wall.
///
/// # Errors
/// As [`Test::load`].
pub fn load_tests(path: &Path, file: &ExperimentFile, wall: &Wall, accuracy: Accuracy) -> Result<Vec<Test>> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let load = |table: &TestTable| {
        table.channels().iter().try_for_each(|channel| channel.check_on_wall(path, table, wall))?;
        Test::load(folder, table, wall, accuracy)
    };
    file.tests.iter().map(load).collect()
}

impl Test {
    /// Reads a test of an experiment; its paths are relative to `folder`.
    ///
    /// # Errors
    /// Input errors of the records or the measured file, or if nothing that was measured counts.
    pub fn load(folder: &Path, table: &TestTable, wall: &Wall, accuracy: Accuracy) -> Result<Self> {
        let shaking = read_shaking(folder, table)?;
        let path = folder.join(&table.measured);
        let measured = Measured::load(&path, table, wall, shaking.horizontal.as_ref())?;
        let (measured, alignment) = aligned(&path, table, measured, wall, &shaking, accuracy)?;
        let release = table.release_s.map(|from_s| released(&path, &measured, from_s)).transpose()?;
        let counts_s = counted_s(table);
        let target = Target::new(&measured, &counts_s, wall).ok_or_else(|| {
            let allowed = "samples in the record's time, inside windows_s, before a collapse, \
                           not all parted by gaps";
            InputError::file(&path, format!("nothing that counts in test {:?}", table.name), allowed)
        })?;
        Ok(Self {
            name: table.name.clone(),
            purpose: table.purpose,
            top_held: table.top_held,
            collapse_s: measured.collapse_s,
            alignment,
            simulator: Simulator::new(wall, &until(&shaking, target.end_s()), accuracy),
            shaking,
            segments: vec![Segment { start: release, ..Segment::whole(&target) }],
            release,
            target,
            measured,
        })
    }

    /// The same test in windows from each stretch without impacts; between impacts the wall moves as the measured
    /// one.
    #[must_use]
    pub fn in_windows(&self, wall: &Wall, accuracy: Accuracy) -> Self {
        let mut segments = segments(&self.target, &self.simulator.with_wall(wall, accuracy));
        segments.iter_mut().filter(|segment| segment.start.is_none()).for_each(|s| s.start = self.release);
        let samples = segments.iter().flat_map(|segment| segment.samples.iter().copied()).collect();
        Self { target: self.target.counting(samples), segments, ..self.clone() }
    }

    /// The same test up to its first so many samples; each weighs as in the whole.
    #[must_use]
    pub(crate) fn first(&self, samples: usize) -> Self {
        let samples = self.target.samples()[..samples].to_vec();
        let end_s = samples.last().map_or(0.0, |s| s.time_s);
        Self { segments: vec![Segment { start: self.release, end_s, samples }], ..self.clone() }
    }

    /// Rotations of a wall in the free-running test up to the end of what counts, a row every `step_s` seconds.
    pub fn history(&self, wall: &Wall, accuracy: Accuracy, step_s: f64) -> History {
        let simulator = self.simulator.with_wall(wall, accuracy);
        let mut history = History::new(step_s);
        let start = self.release.unwrap_or_else(|| simulator.release());
        simulator.run_from(&start, self.target.end_s(), &mut history);
        history
    }

    /// Root mean square of the error of each rotation over what counts of the free-running test, rad; of a lost
    /// channel, or after the simulated wall fell, `None`.
    pub fn rms_rad(&self, wall: &Wall, accuracy: Accuracy) -> [Option<f64>; 2] {
        let rows = self.history(wall, accuracy, RMS_STEP_S).rows;
        let at = |time_s: f64, i: usize| {
            let after = rows.partition_point(|row| row.time_s < time_s).clamp(1, rows.len().max(2) - 1);
            let (a, b) = (rows.get(after - 1)?, rows.get(after)?);
            let share = (time_s - a.time_s) / (b.time_s - a.time_s);
            (-0.01..=1.01)
                .contains(&share)
                .then(|| a.theta_rad[i] + share * (b.theta_rad[i] - a.theta_rad[i]))
        };
        [0, 1].map(|i| {
            let counted = self.target.samples().iter().filter(|s| s.weight_s[i] > 0.0);
            let (mut squares, mut length_s) = (0.0, 0.0);
            for sample in counted {
                let error = at(sample.time_s, i)? - sample.theta_rad[i];
                squares += sample.weight_s[i] * error * error;
                length_s += sample.weight_s[i];
            }
            (length_s > 0.0).then(|| (squares / length_s).sqrt())
        })
    }

    /// When the wall was released, s, and its state there; `None`: it starts from rest.
    pub fn release(&self) -> Option<(f64, State)> {
        self.release.map(|start| (start.time_s, start.state))
    }

    /// Where the simulation starts; `None`: at rest.
    pub(crate) fn start(&self) -> Option<Start> {
        self.release
    }

    /// The same test released from another state, at the same time.
    #[must_use]
    pub fn released_from(&self, state: State) -> Self {
        let release = self.release.map(|start| Start { state, ..start });
        let mut other = Self { release, ..self.clone() };
        other.segments.iter_mut().take(1).for_each(|first| first.start = release);
        other
    }

    /// How many segments it is simulated in.
    pub fn segment_count(&self) -> usize {
        self.segments.len()
    }

    /// Runs a wall through the test and compares.
    pub fn simulate(&self, wall: &Wall, accuracy: Accuracy) -> Simulated {
        self.simulate_below(wall, accuracy, f64::INFINITY)
    }

    /// The same for several walls, whose runs go side by side: each is that of [`Test::simulate`] to the bit.
    pub fn simulate_all(&self, walls: &[Wall], accuracy: Accuracy) -> Vec<Simulated> {
        let [segment] = &self.segments[..] else {
            return walls.iter().map(|wall| self.simulate(wall, accuracy)).collect();
        };
        let simulators =
            walls.iter().map(|wall| self.simulator.with_wall(wall, accuracy)).collect::<Vec<_>>();
        let compared = |wall: &Wall| {
            let comparison = Comparison::new(&segment.samples, self.target.weights(), f64::INFINITY);
            AtTimes(comparison.read_by(wall.reading()))
        };
        let mut comparisons = walls.iter().map(compared).collect::<Vec<_>>();
        let mut waiting = simulators.iter().zip(&mut comparisons).enumerate();
        let mut next = || {
            let (k, (simulator, comparison)) = waiting.next()?;
            let start = segment.start.unwrap_or_else(|| simulator.release());
            let observer: &mut dyn Observer = comparison;
            Some((k, simulator.watched_from(&start, segment.end_s, observer)))
        };
        let mut responses = vec![None; walls.len()];
        simulate_watched_side_by_side(&mut next, &mut |k, response| responses[k] = Some(response));
        let one = |(response, comparison): (Option<Response>, &AtTimes<Comparison>)| {
            let mut simulated = Simulated::NOTHING;
            if let Some(response) = response {
                simulated.add(&response, &comparison.0.errors());
            }
            self.with_wme(simulated)
        };
        responses.into_iter().zip(&comparisons).map(one).collect()
    }

    /// With Eq. 8, where the run could be finished.
    fn with_wme(&self, simulated: Simulated) -> Simulated {
        if simulated.outcome == "failed" {
            return simulated;
        }
        let wme = Some(self.target.wme(&simulated.errors)).filter(|wme| wme.is_finite());
        Simulated { wme, ..simulated }
    }

    /// The same with the signed error of every sample as it weighs in Eq. 8, θ_1 and θ_2 by turns.
    pub(crate) fn residuals(&self, wall: &Wall, accuracy: Accuracy) -> (Simulated, Vec<f64>) {
        let mut residuals = Vec::new();
        let simulated = self.run(wall, accuracy, f64::INFINITY, Some(&mut residuals));
        (simulated, residuals)
    }

    /// The same, abandoned as soon as Eq. 8 is certain to be more than `most_wme`.
    pub fn simulate_below(&self, wall: &Wall, accuracy: Accuracy, most_wme: f64) -> Simulated {
        self.run(wall, accuracy, most_wme, None)
    }

    fn run(
        &self,
        wall: &Wall,
        accuracy: Accuracy,
        most_wme: f64,
        mut residuals: Option<&mut Vec<f64>>,
    ) -> Simulated {
        let simulator = self.simulator.with_wall(wall, accuracy);
        let weights = self.target.weights();
        let mut sum = Simulated::NOTHING;
        let mut wme = 0.0;
        for segment in &self.segments {
            let comparison = Comparison::new(&segment.samples, weights, most_wme - wme);
            let mut comparison = comparison.read_by(wall.reading());
            if residuals.is_some() {
                comparison = comparison.keeping_residuals();
            }
            let mut comparison = AtTimes(comparison);
            let response = match &segment.start {
                None => simulator.run_from(&simulator.release(), segment.end_s, &mut comparison),
                Some(start) => simulator.run_from(start, segment.end_s, &mut comparison),
            };
            let comparison = comparison.0;
            wme += comparison.wme();
            sum.add(&response, &comparison.errors());
            if let Some(residuals) = &mut residuals {
                residuals.extend(comparison.into_residuals());
            }
            if sum.outcome == "failed" {
                return sum;
            }
            if wme > most_wme {
                sum.outcome = "abandoned";
                return sum;
            }
        }
        self.with_wme(sum)
    }
}

impl Simulated {
    /// Before anything is simulated.
    const NOTHING: Self = Self {
        wme: None,
        outcome: "stood",
        collapse_s: None,
        transitions: [0; 8],
        errors: Errors::NONE,
        steps: 0,
    };

    fn add(&mut self, response: &Response, errors: &Errors) {
        match response.outcome {
            Outcome::Stood => {}
            Outcome::Collapsed { time_s } => {
                self.outcome = "collapsed";
                self.collapse_s = Some(time_s);
            }
            Outcome::Failed { .. } => self.outcome = "failed",
        }
        self.errors.add(errors);
        self.transitions.iter_mut().zip(response.impacts.table2).for_each(|(sum, n)| *sum += n);
        self.steps += response.work.steps;
    }
}

/// Rows of a history between which rotations are straight, s: of a swing of some tenths, to 1e-4 of it.
const RMS_STEP_S: f64 = 1e-3;
