//! A track: a vector that is led to follow the measured motion ever farther.
//!
//! The valley of a free-running test may be 1e-4 of a coefficient wide. Windows that begin anew from a noisy motion
//! lead no nearer than some thousandths. From rest no noise is in the start, and every vector follows the measured
//! motion for a while. The shorter the while, the wider its valley. So each test counts up to where the vector has
//! left the measurement by more than its noise. Gauss-Newton lowers what counts, the vector follows farther, and so
//! on to the end. Slopes are taken along the axes of the valley as the last slopes showed it ([`Axes`]), over
//! differences that cost little. As more counts they get smaller by themselves. Where the model cannot follow the
//! measurement to within the noise, it is let go farther off.

use nalgebra::DMatrix;

use super::least_absolute::Linear;
use super::search::Member;
use super::slopes::{Axes, Fit, Fitted};
use super::staged_search::{Stage, StagedSearch};
use crate::experiment::Test;
use crate::experiment::misfit::{Sample, Target};
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
/// The measurement is left where errors are so many times those of the noise. A vector that leaves it nowhere by more
/// than the lesser has arrived. Noise alone, over the samples looked at together, is five standard deviations off
/// that.
const LEFT: f64 = 2.0;
const ARRIVED: f64 = 1.5;
/// Whenever a vector that is let go is stuck, its errors may be so many times larger, up to so many times the noise.
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
    pub fn follow(self, number: usize, search: &StagedSearch, budget: usize) -> Result<Followed> {
        self.go(number, search, budget, LEFT)
    }

    /// The same, let go farther off the measurement whenever it is stuck.
    ///
    /// # Errors
    /// What the simulation meets.
    pub fn let_go(self, number: usize, search: &StagedSearch, budget: usize) -> Result<Followed> {
        self.go(number, search, budget, MOST_LEFT)
    }

    fn go(mut self, number: usize, search: &StagedSearch, budget: usize, most_left: f64) -> Result<Followed> {
        let names = [Stage::Whole(number), Stage::Parts(number)].map(|stage| stage.name(search.method));
        let [whole_name, parts_name] = &names;
        let mut whole = search.objective(whole_name, &search.experiment.tests);
        let best = Member { values: self.values.clone(), cost: f64::INFINITY };
        let mut followed = Followed { best, axes: self.axes.clone(), arrived: false, vectors: 0 };
        let (mut generation, mut left, mut progress) = (0, LEFT, TrackProgress::default());
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
                (left, progress) = (LET_GO * left, TrackProgress::default());
            }
        }
        Ok(followed)
    }

    /// Moves to the cheapest vector of an iteration, which may be where it stands, and gives its cost.
    fn iterate(
        &mut self,
        generation: u32,
        search: &StagedSearch,
        now: &Fitted,
        fit: &mut dyn Fit,
    ) -> Result<f64> {
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
    fn note(&mut self, search: &StagedSearch, at: &Track, now: &Fitted) {
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
    fn of(search: &StagedSearch, whole: Fitted, times_noise: f64) -> Self {
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

/// Samples looked at together: of their 60 sizes, the mean of normal noise is known to a tenth.
const TOGETHER: usize = 30;
/// Errors smaller than this share of the mean rotation are taken for noise: without any, a run would be held to have left
/// at once.
const LEAST_NOISE: f64 = 0.005;

/// How many samples a run with these errors follows the measurement: up to where they are so many times what the noise
/// alone would make.
pub(super) fn followed(target: &Target, residuals: &[f64], times_noise: f64) -> usize {
    let expected = noise_sizes(target);
    let sizes = residuals.chunks_exact(2).map(|pair| pair[0].abs() + pair[1].abs()).collect::<Vec<_>>();
    let together = TOGETHER.min(sizes.len()).max(1);
    let sum = |part: &[f64]| part.iter().sum::<f64>();
    let mut parts = sizes.windows(together).zip(expected.windows(together));
    let left = parts.position(|(sizes, noise)| sum(sizes) > times_noise * sum(noise));
    left.map_or(sizes.len(), |first| first + together)
}

/// The size of both errors of each sample, as they weigh in Eq. 8, that noise makes on the average: E|noise| = √(2/π) σ.
fn noise_sizes(target: &Target) -> Vec<f64> {
    let (noise, weights, counted_s) = (target.noise_rad(), target.weights(), target.counted_s());
    let size = [0, 1].map(|i| {
        // The weight is 1 / ∫|θ|: a share of the mean rotation weighs the same in every test.
        let least = if counted_s[i] > 0.0 { LEAST_NOISE / counted_s[i] } else { 0.0 };
        (std::f64::consts::FRAC_2_PI.sqrt() * noise[i] * weights[i]).max(least)
    });
    let of_sample = |s: &Sample| s.weight_s[0] * size[0] + s.weight_s[1] * size[1];
    target.samples().iter().map(of_sample).collect()
}

/// An iteration that neither lowers the cost by this share nor follows farther is idle.
const SETTLED: f64 = 0.003;
/// After so many idle iterations, or when so many have led less than this share of all samples farther, a track is
/// stuck. Those that arrive mostly do in 8 to 15.
const MOST_IDLE: usize = 3;
const PATIENCE: usize = 5;
const LEAST_PROGRESS: f64 = 0.02;

/// How a track went.
#[derive(Debug, Default, Clone)]
pub(super) struct TrackProgress {
    idle: usize,
    /// The most samples that ever counted, after each iteration.
    farthest: Vec<usize>,
    all: usize,
}

impl TrackProgress {
    /// Notes an iteration: the samples that counted in it, of all, and the share of the cost that it left.
    pub fn note(&mut self, [counted, all]: [usize; 2], cost_left: f64) {
        let before = self.farthest.last().copied().unwrap_or(0);
        let idle = cost_left > 1.0 - SETTLED && counted <= before;
        self.idle = if idle { self.idle + 1 } else { 0 };
        self.farthest.push(counted.max(before));
        self.all = all;
    }

    /// How many iterations have been idle, up to the last.
    pub fn idle(&self) -> usize {
        self.idle
    }

    /// Whether more iterations are a waste. Where all samples count, only the cost tells.
    pub fn is_stuck(&self) -> bool {
        let now = self.farthest.last().copied().unwrap_or(0);
        let earlier = self.farthest.len().checked_sub(1 + PATIENCE).map(|k| self.farthest[k]);
        let hardly = |earlier: usize| ((now - earlier) as f64) < LEAST_PROGRESS * self.all as f64;
        self.idle >= MOST_IDLE || now < self.all && earlier.is_some_and(hardly)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::Draws;
    use crate::experiment::Measured;
    use mrbd_files::load_wall;
    use rand_distr::{Distribution, StandardNormal};

    #[test]
    fn analytic_a_run_leaves_where_its_errors_are_larger_than_the_noise() {
        let normal =
            |k: usize, i: u32| -> f64 { StandardNormal.sample(&mut Draws::new(1, "").of(0, k as u32, i)) };
        let noise = |k: usize| [1e-3 * normal(k, 0), 2e-3 * normal(k, 1)];
        let theta = |i: usize| (0..=400).map(|k| 0.1 * (0.05 * k as f64).sin() + noise(k)[i]).collect();
        let measured = Measured {
            columns: Vec::new(),
            time_s: (0..=400).map(|k| 0.005 * f64::from(k)).collect(),
            theta_rad: [Some(theta(0)), Some(theta(1))],
            gap_s: 0.01,
            collapse_s: None,
            stated_noise_rad: [None; 2],
        };
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../inputs/walls/table_wall.toml");
        let wall = load_wall(path.as_ref()).expect("the table wall");
        let target = Target::new(&measured, &[], &wall).expect("samples that count");
        let error = |k: usize, i: usize| {
            let times = if k < 200 { 1.0 } else { 3.0 };
            times * target.weights()[i] * target.samples()[k].weight_s[i] * noise(k)[i]
        };
        let errors = (0..=400).flat_map(|k| [error(k, 0), error(k, 1)]).collect::<Vec<_>>();
        // The mean over thirty samples reaches twice the noise when half of them are beyond.
        assert!((205..230).contains(&followed(&target, &errors, 2.0)), "{}", followed(&target, &errors, 2.0));
        // Never five times, and never twice by the noise alone.
        assert_eq!(followed(&target, &errors, 5.0), 401);
        let noise_alone = [&errors[..400], &[0.0; 402]].concat();
        assert_eq!(followed(&target, &noise_alone, 2.0), 401);
    }

    fn stuck_after(counted: impl Fn(usize) -> usize, cost_left: f64) -> usize {
        let mut progress = TrackProgress::default();
        let note = |k: &usize| {
            progress.note([counted(*k), 1000], cost_left);
            progress.is_stuck()
        };
        (1..100).find(note).unwrap_or(100)
    }

    #[test]
    fn analytic_a_track_is_stuck_when_it_gets_no_farther() {
        // One sample more each time is no progress, however the cost falls; ten are, up to where five leave 10 of them.
        assert_eq!(stuck_after(|k| 500 + k, 0.5), 6);
        assert_eq!(stuck_after(|k| (10 * k).min(900), 0.5), 94);
        // The first iteration is never idle, since it follows farther than none did.
        assert_eq!(stuck_after(|_| 500, 1.0), 4);
        assert_eq!(stuck_after(|_| 1000, 1.0), 4);
        // Where all samples count, a cost that still falls is progress.
        assert_eq!(stuck_after(|_| 1000, 0.5), 100);
    }
}
