//! A track: a vector that is led to follow the measured motion ever farther.
//!
//! The valley of a free-running test may be 1e-4 of a coefficient wide, and windows that begin anew from a noisy motion
//! lead no nearer than some thousandths. But from rest, where no noise is in the start, every vector follows the measured
//! motion for a while, and the shorter the while, the wider its valley. So each test counts up to where the vector has left
//! the measurement by more than its noise; Gauss-Newton lowers what counts, the vector follows farther, and so on to the
//! end. Slopes are taken along the axes of the valley as the last slopes showed it ([`Axes`]), over differences that cost
//! little: as more counts they get smaller by themselves. Where the model cannot follow the measurement to within the
//! noise, it is let go farther off.

use nalgebra::DMatrix;

use super::axes::Axes;
use super::least_sizes::Linear;
use super::leaving::followed;
use super::progress::Progress;
use super::search::Member;
use super::slopes::{Fit, Fitted};
use super::staged::Staged;
use super::stages::Stage;
use crate::experiment::Test;
use mrbd_files::error::Result;

/// Dampings, in the units of the axes: from a full step to one that hardly leaves where it is.
const DAMPINGS: [f64; 8] = [1e-6, 1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0, 100.0];
/// A length along an axis costs this share more: errors about a tenth of those there are.
const AXES_SHARE: f64 = 0.01;
/// Axes grow no more than so many times in an iteration, and no longer than this share of the bounds.
const MOST_GROWTH: f64 = 3.0;
const WIDEST: f64 = 0.1;
/// Differences after the first idle iteration and after the next: wider ones may still see a way out of a kink that near
/// ones do not.
const AFTER_IDLE: [f64; 2] = [4.0, 0.4];
/// The measurement is left where errors are so many times those of the noise; a vector that leaves it nowhere by more than
/// the lesser has arrived: noise alone, over the samples looked at together, is five standard deviations off that.
const LEFT: f64 = 2.0;
const ARRIVED: f64 = 1.5;
/// Errors of a vector that is let go may be so many times larger whenever it is stuck, up to so many times the noise.
const LET_GO: f64 = 2.0;
const MOST_LEFT: f64 = 100.0;
/// A misfit below which nothing is left to find: rotations agree to a ten-thousandth.
pub(super) const GOOD_ENOUGH: f64 = 1e-4;
/// A misfit of the roundings of the simulations.
const NOTHING_LEFT: f64 = 1e-9;

/// Where a track stands.
#[derive(Debug, Clone)]
pub(super) struct Track {
    pub values: Vec<f64>,
    /// The axes of the valley there.
    pub axes: DMatrix<f64>,
}

/// Where a track was cheapest in the whole tests, and the vectors it took.
#[derive(Debug, Clone)]
pub(super) struct Followed {
    pub best: Member,
    pub axes: DMatrix<f64>,
    /// Whether it follows all tests to within the noise.
    pub arrived: bool,
    pub vectors: usize,
}

/// The tests as far as they count.
struct Parts {
    tests: Vec<Test>,
    /// Samples that count, and all.
    samples: [usize; 2],
    /// The vector's errors in them.
    now: Fitted,
}

impl Track {
    /// Begins at a vector, where nothing is known of the valley.
    pub fn unknown(values: Vec<f64>) -> Self {
        let n = values.len();
        Self { values, axes: DMatrix::identity(n, n) * WIDEST }
    }

    /// Vectors of an iteration.
    pub fn least_vectors(variables: usize) -> usize {
        1 + 2 * variables + DAMPINGS.len()
    }

    /// Follows as the `number`-th track of a search, with so many vectors at most, until it arrives or is stuck.
    ///
    /// # Errors
    /// What the simulation meets.
    pub fn follow(self, number: usize, search: &Staged, budget: usize) -> Result<Followed> {
        self.go(number, search, budget, LEFT)
    }

    /// The same, let go farther off the measurement whenever it is stuck.
    ///
    /// # Errors
    /// What the simulation meets.
    pub fn let_go(self, number: usize, search: &Staged, budget: usize) -> Result<Followed> {
        self.go(number, search, budget, MOST_LEFT)
    }

    fn go(mut self, number: usize, search: &Staged, budget: usize, most_left: f64) -> Result<Followed> {
        let names = [Stage::Whole(number), Stage::Parts(number)].map(|stage| stage.name(search.method));
        let [whole_name, parts_name] = &names;
        let mut whole = search.objective(whole_name, &search.experiment.tests);
        let best = Member { values: self.values.clone(), cost: f64::INFINITY };
        let mut followed = Followed { best, axes: self.axes.clone(), arrived: false, vectors: 0 };
        let (mut generation, mut left, mut progress) = (0, LEFT, Progress::default());
        let vectors_each = Self::least_vectors(self.values.len());
        while followed.vectors + vectors_each <= budget {
            let Some(now) = whole.fitted(generation, std::slice::from_ref(&self.values))?.pop().flatten()
            else {
                break;
            };
            followed.note(search, &self, &now);
            let parts = Parts::of(search, now, left);
            let name = if parts.are_all() { whole_name } else { parts_name };
            let mut objective = search.objective(name, &parts.tests);
            let cost = self.iterate(generation + 1, search, &parts.now, &mut objective)?;
            followed.vectors += vectors_each;
            generation += 3;
            progress.note(parts.samples, cost / parts.now.cost);
            if let Some(times) = progress.idle().checked_sub(1).and_then(|k| AFTER_IDLE.get(k)) {
                self.axes *= *times;
            }
            let ended = parts.are_all() || LET_GO * left > most_left;
            if cost < NOTHING_LEFT || progress.is_stuck() && ended {
                break;
            }
            if progress.is_stuck() {
                (left, progress) = (LET_GO * left, Progress::default());
            }
        }
        Ok(followed)
    }

    /// Moves to the cheapest vector of an iteration, which may be where it stands, and gives its cost.
    fn iterate(&mut self, generation: u32, search: &Staged, now: &Fitted, fit: &mut dyn Fit) -> Result<f64> {
        let bounds = search.space.bounds();
        let axes = Axes { about: &self.values, root: &self.axes, bounds: &bounds };
        let sides = axes.sides();
        let around = fit.fitted(generation, &sides)?;
        let Some(slopes) = axes.slopes(&sides, &around, now) else { return Ok(now.cost) };
        let linear = Linear::new(&slopes, &now.residuals, axes.prior(&fit.ln_prior(&self.values)));
        let candidates = linear.steps(&DAMPINGS).iter().map(|step| axes.at(step)).collect::<Vec<_>>();
        let tried = fit.fitted(generation + 1, &candidates)?;
        let next_axes = linear.cloud(AXES_SHARE, MOST_GROWTH).and_then(|root| axes.next(&root, WIDEST));
        let all = sides.into_iter().zip(around).chain(candidates.into_iter().zip(tried));
        let finished = all.filter_map(|(values, fitted)| fitted.map(|fitted| (values, fitted.cost)));
        let best = finished.reduce(|a, b| if b.1 < a.1 { b } else { a }).filter(|(_, cost)| *cost < now.cost);
        self.axes = next_axes.unwrap_or_else(|| self.axes.clone());
        let Some((values, cost)) = best else { return Ok(now.cost) };
        self.values = values;
        Ok(cost)
    }
}

impl Followed {
    /// The cheaper of two, the other of equals.
    pub fn or(self, other: Option<Self>) -> Self {
        match other {
            Some(other) if other.best.cost <= self.best.cost => other,
            _ => self,
        }
    }

    /// Whether nothing is left to find.
    pub fn is_perfect(&self) -> bool {
        self.best.cost <= GOOD_ENOUGH
    }

    /// Notes where a track stands, and what that costs in the whole tests.
    fn note(&mut self, search: &Staged, at: &Track, now: &Fitted) {
        if now.cost < self.best.cost {
            self.best = Member { values: at.values.clone(), cost: now.cost };
            self.axes.clone_from(&at.axes);
            self.arrived = Parts::of(search, now.clone(), ARRIVED).are_all();
        }
    }
}

impl Parts {
    fn are_all(&self) -> bool {
        self.samples[0] == self.samples[1]
    }

    /// The tests up to where these errors of the whole leave the measurement by so many times its noise.
    fn of(search: &Staged, whole: Fitted, times_noise: f64) -> Self {
        let mut tests = search.experiment.tests.clone();
        let (mut rest, mut counted) = (whole.residuals.as_slice(), Vec::new());
        let mut samples = [0, 0];
        for &k in search.chosen {
            let all = tests[k].target.samples().len();
            let (own, others) = rest.split_at(2 * all);
            let followed = followed(&tests[k].target, own, times_noise);
            counted.extend_from_slice(&own[..2 * followed]);
            tests[k] = tests[k].first(followed);
            samples = [samples[0] + followed, samples[1] + all];
            rest = others;
        }
        let size = |errors: &[f64]| errors.iter().map(|e| e.abs()).sum::<f64>();
        let cost = whole.cost * (size(&counted) / size(&whole.residuals).max(f64::MIN_POSITIVE));
        Self { tests, samples, now: Fitted { cost, residuals: counted } }
    }
}
