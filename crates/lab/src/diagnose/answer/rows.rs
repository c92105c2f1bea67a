//! Rows of the tables of a diagnosis, and how they follow from its findings.
//!
//! They hold measured against simulated rotations, by sample and by window. They hold the missing force at the top under
//! the wall as given and as updated, with the laws and the jumps beside it.

use super::Findings;
use super::summary::{ExplainedBy, ForceSize, MissingForce};
use crate::diagnose::certainty::covariance;
use crate::diagnose::fit::{Replay, WindowFit, shaken};
use crate::diagnose::force::{
    Against, CurvePoint, Drawn, ForcePoint, Jump, LawCurve, explained_by, force_points, jumps, law_curves,
    median_share_off_top, stretches,
};
use crate::diagnose::formula::Part;
use crate::diagnose::hypothesis::Physics;
use crate::diagnose::trials::FittedHypothesis;
use crate::diagnose::verdict::Verdict;
use crate::experiment::TestData;
use crate::experiment::{Purpose, Sampled, Window};
use mrbd_kernel::model::{Contact, Pair, Pivot, RockingWall};
use mrbd_kernel::simulate::{Accuracy, Impacts, Simulator};

/// The data behind the figures.
#[derive(Debug, Clone, PartialEq)]
pub struct Tables {
    /// Every sample of every test.
    pub samples: Vec<Sample>,
    /// Every window, in the order of tests and times.
    pub windows: Vec<WindowRow>,
    /// The missing force, stretch by stretch.
    pub force: Vec<ForceRow>,
    /// Velocities after impacts, under the wall as given and then as updated.
    pub jumps: Vec<JumpRow>,
    /// Curves of the laws of the best hypotheses.
    pub laws: Vec<LawPoint>,
    /// Every added number of every hypothesis, the best first.
    pub rivals: Vec<RivalRow>,
}

/// One sample of a test.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// The test.
    pub test: String,
    /// Whether it was fitted or held out.
    pub purpose: Purpose,
    /// Time in the record, s.
    pub time_s: f64,
    /// θ_1 and θ_2 as read, rad; NaN where missing.
    pub measured_rad: Pair,
    /// Contact state, where the measurement leaves no doubt.
    pub measured_contact: Option<Contact>,
    /// Rotations, rad, and contact of whole runs from rest, before and after; `None` beyond a collapse.
    pub simulated: [Option<(Pair, Contact)>; 2],
    /// Measured less simulated over the noise, in windows, before and after.
    pub residual: [Option<Pair>; 2],
}

/// One window.
#[derive(Debug, Clone, PartialEq)]
pub struct WindowRow {
    /// The test.
    pub test: String,
    /// Whether it was fitted or held out.
    pub purpose: Purpose,
    /// First sample, s.
    pub from_s: f64,
    /// Last sample, s.
    pub to_s: f64,
    /// Contact state at its start, as fitted.
    pub contact: Contact,
    /// Impacts of the updated wall in it.
    pub impacts: Impacts,
    /// Root mean square error over the noise: before, recalibrated, after.
    pub error: [Option<f64>; 3],
}

/// The missing force in one stretch.
#[derive(Debug, Clone, PartialEq)]
pub struct ForceRow {
    /// The test.
    pub test: String,
    /// Whether it was fitted or held out.
    pub purpose: Purpose,
    /// What is missing in the wall as given.
    pub point: ForcePoint,
    /// The force that the updated wall leaves there, N.
    pub after_n: Option<f64>,
}

/// One change of pattern, under one wall.
#[derive(Debug, Clone, PartialEq)]
pub struct JumpRow {
    /// The test.
    pub test: String,
    /// `given` or `updated`.
    pub wall: &'static str,
    /// The change.
    pub jump: Jump,
}

/// One point of the law of a hypothesis.
#[derive(Debug, Clone, PartialEq)]
pub struct LawPoint {
    /// The hypothesis.
    pub name: String,
    /// The quantity that x is.
    pub against: Against,
    /// Displacement, velocity or absolute acceleration of the top, SI units.
    pub x: f64,
    /// Force that the hypothesis adds at the top, N.
    pub force_n: f64,
    /// Its 90 % interval, N; `None` where it is not told.
    pub interval_n: Option<[f64; 2]>,
}

/// One added number of one hypothesis.
#[derive(Debug, Clone, PartialEq)]
pub struct RivalRow {
    /// Place of the hypothesis in the order, from 1.
    pub rank: u64,
    /// What is added to the wall.
    pub name: String,
    /// Where the first addition acts.
    pub place: &'static str,
    /// Whether it is an effect, and no number of the wall or placebo.
    pub is_answer: bool,
    /// Key of the number.
    pub parameter: String,
    /// Its unit.
    pub unit: &'static str,
    /// As fitted.
    pub value: f64,
    /// Standard deviation by the curvature of the fit; `None` where it leaves no trace.
    pub sd: Option<f64>,
    /// Windowed error over the noise: tests to fit, tests held out.
    pub error: [Option<f64>; 2],
    /// What speaks against it, in natural logarithms of likelihood.
    pub against: f64,
}

/// A knot of a force without a formula.
fn knot(part: &Part, x: f64) -> CurvePoint {
    let (force_n, interval_n) = part.told_n(x);
    CurvePoint { x, force_n, interval_n: Some(interval_n) }
}

/// Laws outside the catalogue that are drawn: beside them stands the best of the catalogue.
const LAWS_DRAWN: usize = 2;

/// Both joints open: the arms of a force at the top are the heights of the crack and of the upper body.
const UPRIGHT: Contact = Contact { ground: Pivot::Right, crack: Pivot::Right };

/// The missing force in every stretch.
#[derive(Debug)]
pub(super) struct ForceBeforeAfter {
    before: Vec<ForcePoint>,
    after: Vec<ForcePoint>,
}

impl ForceBeforeAfter {
    /// Measures it under the wall as given and as updated.
    pub fn new(tests: &[TestData], [before, after]: &[Physics; 2]) -> Self {
        Self { before: force_points(tests, before), after: force_points(tests, after) }
    }

    /// What it comes to.
    pub fn summary(&self, [before, _]: &[Physics; 2]) -> MissingForce {
        let direction = median_share_off_top(&self.before);
        let [displacement_m, velocity_m_s, acceleration_m_s2] =
            Against::ALL.map(|against| explained_by(&self.before, against));
        MissingForce {
            points: self.before.len(),
            before: size(&self.before),
            after: size(&self.after),
            median_share_off_top: direction.map(|(share, _)| share),
            explained_by: ExplainedBy { displacement_m, velocity_m_s, acceleration_m_s2 },
            points_with_direction: direction.map_or(0, |(_, points)| points),
            arms_of_top_m: RockingWall::new(&before.wall).top_arms_m(UPRIGHT, [0.0; 2]),
        }
    }

    /// Its rows, with what the updated wall leaves of it.
    pub fn rows(&self, tests: &[TestData]) -> Vec<ForceRow> {
        let row = |point: &ForcePoint| {
            // Sensors of the updated wall may move the stretches.
            let same = |p: &&ForcePoint| p.test == point.test && p.time_s == point.time_s;
            ForceRow {
                test: tests[point.test].name.clone(),
                purpose: tests[point.test].purpose,
                point: point.clone(),
                after_n: self.after.iter().find(same).map(|p| p.force_n),
            }
        };
        self.before.iter().map(row).collect()
    }
}

impl Findings<'_> {
    /// The laws of the best hypotheses, to be drawn through the force: those outside the catalogue that hold first, with their
    /// intervals.
    pub(super) fn law_points(&self, force: &ForceBeforeAfter) -> Vec<LawPoint> {
        let point = |curve: &LawCurve, p: &CurvePoint| LawPoint {
            name: curve.name.clone(),
            against: curve.against,
            x: p.x,
            force_n: p.force_n,
            interval_n: p.interval_n,
        };
        let data = self.data();
        let laws = self.found.discovered.iter().flat_map(|found| &found.equals).take(LAWS_DRAWN);
        let laws = laws.map(|tried| Drawn { tried, covariance: covariance(&data, tried) });
        let known = self.found.tried.iter().map(|tried| Drawn { tried, covariance: None });
        let laws = law_curves(&self.experiment.wall, &laws.chain(known).collect::<Vec<_>>(), &force.before);
        let curves = self.without_formula().chain(laws).collect::<Vec<_>>();
        curves.iter().flat_map(|curve| curve.points.iter().map(|p| point(curve, p))).collect()
    }

    /// The force that no formula holds for, where that is the answer.
    fn without_formula(&self) -> impl Iterator<Item = LawCurve> {
        let own = self.found.verdict == Verdict::Curve;
        let curves = self.found.after.hypothesis.curve.iter().filter(move |_| own);
        let against = [Against::Displacement, Against::Velocity];
        curves.flat_map(move |curve| {
            curve.parts.into_iter().zip(against).map(|(part, against)| LawCurve {
                name: "no formula".to_owned(),
                against,
                points: part.at.map(|x| knot(&part, x)).to_vec(),
            })
        })
    }

    /// Velocities after impacts over those of the wall as given, then over those of the updated one.
    pub(super) fn jump_rows(&self, physics: &[Physics; 2]) -> Vec<JumpRow> {
        let rows = |(wall, physics): (&'static str, &Physics)| {
            let jumps = jumps(&self.tests, physics).into_iter();
            jumps
                .map(|jump| JumpRow { test: self.tests[jump.test].name.clone(), wall, jump })
                .collect::<Vec<_>>()
        };
        ["given", "updated"].into_iter().zip(physics).flat_map(rows).collect()
    }
}

/// Size of a force over stretches; nothing where there are none.
fn size(points: &[ForcePoint]) -> ForceSize {
    let squares = points.iter().map(|p| p.force_n * p.force_n).sum::<f64>();
    let noise = points.iter().map(|p| p.force_sd_n * p.force_sd_n).sum::<f64>();
    let count = (points.len() as f64).max(1.0);
    ForceSize { rms_n: (squares / count).sqrt(), noise_rms_n: (noise / count).sqrt() }
}

impl Findings<'_> {
    /// Every sample, with whole runs before and after and errors over windows.
    pub(super) fn samples(&self, physics: &[Physics; 2]) -> Vec<Sample> {
        let replays = physics.each_ref().map(|physics| Replay::new(&self.tests, physics));
        let of_test = |(index, test): (usize, &TestData)| {
            let mut samples = whole_runs(test, physics);
            for (which, (replay, tried)) in replays.iter().zip(self.before_and_kept()).enumerate() {
                for (window, x) in self.windows_of(tried).filter(|(w, _)| w.test == index) {
                    let residual = replay.residual(window, x);
                    for (i, k) in window.samples.clone().enumerate() {
                        let channels = test.manner.channels();
                        let measured = test.theta_rad[k][..channels].iter().all(|t| t.is_finite());
                        samples[k].residual[which] = measured.then(|| [residual[2 * i], residual[2 * i + 1]]);
                    }
                }
            }
            samples
        };
        self.tests.iter().enumerate().flat_map(of_test).collect()
    }

    /// Every window with its errors, and the impacts of the updated wall in it, in the order of tests and times.
    pub(super) fn window_rows(&self, [_, updated]: &[Physics; 2]) -> Vec<WindowRow> {
        let replay = Replay::new(&self.tests, updated);
        let after = self.found.kept();
        let fits = [&self.found.before, &self.found.recalibrated, after].map(fits_of);
        let row = |(i, (window, x)): (usize, (&Window, &[f64]))| {
            let test = &self.tests[window.test];
            let row = WindowRow {
                test: test.name.clone(),
                purpose: test.purpose,
                from_s: test.time_s[window.samples.start],
                to_s: test.time_s[window.samples.end - 1],
                contact: window.freedom.state(x).1,
                impacts: replay.run(window, x, &mut ()).impacts,
                error: fits.each_ref().map(|fits| Some(fits[i].reduced().sqrt()).filter(|e| e.is_finite())),
            };
            (window.test, row)
        };
        let mut rows = self.windows_of(after).enumerate().map(row).collect::<Vec<_>>();
        rows.sort_by(|(a, one), (b, two)| a.cmp(b).then(one.from_s.total_cmp(&two.from_s)));
        rows.into_iter().map(|(_, row)| row).collect()
    }
}

/// Windows to fit, then those held out.
fn fits_of(tried: &FittedHypothesis) -> Vec<&WindowFit> {
    tried.fit.windows.iter().chain(&tried.held_out.windows).collect()
}

/// The samples of a test with whole runs from rest, before and after.
fn whole_runs(test: &TestData, physics: &[Physics; 2]) -> Vec<Sample> {
    let runs = physics.each_ref().map(|physics| whole_run(test, physics));
    let mut contacts = vec![None; test.time_s.len()];
    for stretch in stretches(test) {
        contacts[stretch.from..stretch.from + stretch.states.len()].fill(Some(stretch.contact));
    }
    let sample = |k: usize| Sample {
        test: test.name.clone(),
        purpose: test.purpose,
        time_s: test.time_s[k],
        measured_rad: test.theta_rad[k],
        measured_contact: contacts[k],
        simulated: runs.each_ref().map(|rows| rows.get(k).copied().flatten()),
        residual: [None; 2],
    };
    (0..test.time_s.len()).map(sample).collect()
}

/// Rotations as sensors of a wall read them, rad, and contacts of a whole run, as far as it goes: from rest, or from the
/// release and nothing before it.
fn whole_run(test: &TestData, physics: &Physics) -> Vec<Option<(Pair, Contact)>> {
    let start = test.manner.release.unwrap_or_default();
    let from = test.time_s.partition_point(|time_s| *time_s < start.time_s);
    let mut sampled = Sampled::at(&test.time_s[from..]);
    let simulator =
        Simulator::new(&physics.wall, &shaken(&test.shaking, physics.reversed_ratio), Accuracy::default());
    match (test.manner.release, test.time_s.last()) {
        (Some(start), Some(end_s)) => simulator.run_from(&start, *end_s, &mut sampled),
        _ => simulator.run(&mut sampled),
    };
    let read = |(theta, contact): &(Pair, Contact)| Some((physics.wall.reading().of(*theta), *contact));
    std::iter::repeat_n(None, from).chain(sampled.rows().iter().map(read)).collect()
}
