//! The weighted mean error between measured and simulated rotations: the paper's Eq. 8.
//!
//! WME = Σ_i ∫|θ_i,exp - θ_i,num| / ∫|θ_i,exp|, each integral by the trapezoidal rule over the measured samples.
//! What the paper leaves open is settled so:
//!
//! - Only the chosen windows count; samples that a gap parts are not joined; a lost channel has no term in the sum.
//! - Where the wall is measured at rest the denominator would vanish: it is at least what a rotation of a thousandth
//!   of α_i would give, so that moving while the measured wall stands is dear but not infinitely so.
//! - After a measured collapse nothing counts. A simulated wall that collapses stays at the rotation it collapsed at.
//! - A free-running impact system is nearly chaotic: over long records WME is a rough function of the coefficients,
//!   with many local minima. Windows that end after some impacts, or begin anew from the measured motion, make it smooth.

use super::local::channel_noise_rad;
use super::measured::Measured;
use super::rotations::Sink;
use mrbd_kernel::model::{Contact, Pair, Reading, Wall};

/// Smallest mean |θ_i,exp| of the denominator, in units of α_i.
const REST_SHARE: f64 = 1e-3;

/// Stretches of equal length a test is divided into, whose errors are kept apart for the bootstrap.
pub const BLOCKS: usize = 24;

/// A sample that counts: its time, measured rotations, and weights in s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sample {
    pub time_s: f64,
    pub theta_rad: Pair,
    /// Length of time each channel's sample stands for; 0 where it is missing.
    pub weight_s: Pair,
    pub block: usize,
}

/// The measured side of Eq. 8 for one test.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    samples: Vec<Sample>,
    /// ∫|θ_i,exp| by block, rad s.
    measured_rad_s: [[f64; BLOCKS]; 2],
    /// Rotation below which the wall counts as at rest, rad.
    floor_share_rad: Pair,
    /// The least each channel's denominator may be, rad s; 0: the channel is lost.
    floor_rad_s: Pair,
    independent_samples: f64,
    noise_rad: Pair,
    gap_s: f64,
}

impl Target {
    /// What counts of a measurement; no windows: all of it.
    ///
    /// `None` if nothing does.
    pub fn new(measured: &Measured, windows_s: &[[f64; 2]], wall: &Wall) -> Option<Self> {
        let weights = [0, 1].map(|i| channel_weights(measured, i, windows_s));
        let counts = |k: &usize| weights[0][*k] > 0.0 || weights[1][*k] > 0.0;
        let kept = (0..measured.time_s.len()).filter(counts).collect::<Vec<_>>();
        let (first, last) = (measured.time_s[*kept.first()?], measured.time_s[*kept.last()?]);
        let block = |t: f64| ((t - first) / (last - first) * BLOCKS as f64) as usize;
        let sample = |k: usize| Sample {
            time_s: measured.time_s[k],
            theta_rad: [0, 1].map(|i| value(measured, i, k).unwrap_or(0.0)),
            weight_s: [weights[0][k], weights[1][k]],
            block: block(measured.time_s[k]).min(BLOCKS - 1),
        };
        let samples = kept.into_iter().map(sample).collect::<Vec<_>>();
        let (time_s, theta_rad) = measured.counted(windows_s);
        let noise_rad = channel_noise_rad(measured, &time_s, &theta_rad).map(|noise| noise.unwrap_or(0.0));
        let floor_share_rad = wall.alpha_i_rad().map(|alpha| REST_SHARE * alpha);
        Some(Self::of_samples(samples, floor_share_rad, noise_rad, measured.gap_s))
    }

    fn of_samples(samples: Vec<Sample>, floor_share_rad: Pair, noise_rad: Pair, gap_s: f64) -> Self {
        let mut measured_rad_s = [[0.0; BLOCKS]; 2];
        for s in &samples {
            for (i, blocks) in measured_rad_s.iter_mut().enumerate() {
                blocks[s.block] += s.weight_s[i] * s.theta_rad[i].abs();
            }
        }
        let floor = |i: usize| floor_share_rad[i] * samples.iter().map(|s| s.weight_s[i]).sum::<f64>();
        let floor_rad_s = [floor(0), floor(1)];
        let independent_samples = independent_samples(&samples);
        Self { samples, measured_rad_s, floor_share_rad, floor_rad_s, independent_samples, noise_rad, gap_s }
    }

    /// The target of these samples, which may count one twice.
    pub(crate) fn counting(&self, samples: Vec<Sample>) -> Self {
        Self::of_samples(samples, self.floor_share_rad, self.noise_rad, self.gap_s)
    }

    /// The samples that count, in order.
    pub(crate) fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// Standard deviation of each channel's white noise, rad; 0 where none shows.
    pub fn noise_rad(&self) -> Pair {
        self.noise_rad
    }

    /// Samples farther apart than this are not joined, s.
    pub(crate) fn gap_s(&self) -> f64 {
        self.gap_s
    }

    /// End of what counts, s.
    pub fn end_s(&self) -> f64 {
        self.samples.last().map_or(0.0, |s| s.time_s)
    }

    /// Time that counts in each channel, s; 0: the channel is lost.
    pub fn counted_s(&self) -> Pair {
        [0, 1].map(|i| self.samples.iter().map(|s| s.weight_s[i]).sum())
    }

    /// Channels whose denominator is the floor: the wall was measured at rest.
    pub fn at_rest(&self) -> [bool; 2] {
        [0, 1].map(|i| {
            let whole = self.measured_rad_s[i].iter().sum::<f64>();
            self.floor_rad_s[i] > 0.0 && whole <= self.floor_rad_s[i]
        })
    }

    /// Eq. 8 with each block's errors counted `times`; once each is the WME itself.
    pub fn wme_of(&self, errors: &Errors, times: &[f64; BLOCKS]) -> f64 {
        let weighted = |blocks: &[f64; BLOCKS]| blocks.iter().zip(times).map(|(x, n)| x * n).sum::<f64>();
        let term = |i: usize| {
            let denominator = weighted(&self.measured_rad_s[i]).max(self.floor_rad_s[i]);
            if self.floor_rad_s[i] > 0.0 { weighted(&errors.rad_s[i]) / denominator } else { 0.0 }
        };
        term(0) + term(1)
    }

    /// Eq. 8 of the true motion, which the measurement's noise alone makes: E|noise| = √(2/π) σ.
    pub fn noise_wme(&self) -> f64 {
        let (noise, counted, weights) = (self.noise_rad, self.counted_s(), self.weights());
        (0..2).map(|i| std::f64::consts::FRAC_2_PI.sqrt() * noise[i] * counted[i] * weights[i]).sum()
    }

    /// The block of each error, as [`super::Test`] gives them: θ_1 and θ_2 of each sample by turns.
    pub(crate) fn error_blocks(&self) -> impl Iterator<Item = usize> {
        self.samples.iter().flat_map(|s| [s.block, s.block])
    }

    /// 1 / ∫|θ_i,exp|, 1/(rad s), by which each channel's error counts in Eq. 8; 0: the channel is lost.
    pub(crate) fn weights(&self) -> Pair {
        [0, 1].map(|i| {
            let denominator = self.measured_rad_s[i].iter().sum::<f64>().max(self.floor_rad_s[i]);
            if self.floor_rad_s[i] > 0.0 { 1.0 / denominator } else { 0.0 }
        })
    }

    /// Eq. 8.
    pub fn wme(&self, errors: &Errors) -> f64 {
        self.wme_of(errors, &[1.0; BLOCKS])
    }

    /// How many samples of the errors are independent: time over twice the correlation time of the measured rotation,
    /// at least one.
    pub fn independent_samples(&self) -> f64 {
        self.independent_samples
    }
}

fn independent_samples(samples: &[Sample]) -> f64 {
    let counted_s = [0, 1].map(|i| samples.iter().map(|s| s.weight_s[i]).sum::<f64>());
    let channel = usize::from(counted_s[1] > counted_s[0]);
    let theta = samples.iter().map(|s| s.theta_rad[channel]).collect::<Vec<_>>();
    (0.5 * samples.len() as f64 / correlation_steps(&theta)).max(1.0)
}

/// Sum of the autocorrelation up to its first zero, in steps.
fn correlation_steps(x: &[f64]) -> f64 {
    let at = |lag: usize| x.iter().zip(&x[lag..]).map(|(a, b)| a * b).sum::<f64>();
    let whole = at(0);
    if whole == 0.0 {
        return 1.0;
    }
    let positive = (1..x.len()).map(|lag| at(lag) / whole).take_while(|r| *r > 0.0);
    0.5 + positive.sum::<f64>()
}

fn value(measured: &Measured, channel: usize, k: usize) -> Option<f64> {
    measured.theta_rad[channel].as_ref().map(|theta| theta[k]).filter(|theta| theta.is_finite())
}

/// Trapezoidal weights of the samples of a channel that count.
fn channel_weights(measured: &Measured, channel: usize, windows_s: &[[f64; 2]]) -> Vec<f64> {
    let end_s = measured.collapse_s.unwrap_or(f64::INFINITY);
    let mut weights = vec![0.0; measured.time_s.len()];
    let mut previous: Option<(usize, usize)> = None;
    for (k, &t) in measured.time_s.iter().enumerate() {
        let window = if windows_s.is_empty() {
            Some(0)
        } else {
            windows_s.iter().position(|w| w[0] <= t && t <= w[1])
        };
        let valid = t >= 0.0 && t <= end_s && value(measured, channel, k).is_some();
        let Some(window) = window.filter(|_| valid) else { continue };
        if let Some((last, last_window)) = previous {
            let step_s = t - measured.time_s[last];
            if last_window == window && step_s <= measured.gap_s {
                weights[last] += 0.5 * step_s;
                weights[k] += 0.5 * step_s;
            }
        }
        previous = Some((k, window));
    }
    weights
}

/// ∫|θ_i,exp - θ_i,num| by channel and block, rad s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// By channel and block.
    pub rad_s: [[f64; BLOCKS]; 2],
}

impl Errors {
    /// None.
    pub const NONE: Self = Self { rad_s: [[0.0; BLOCKS]; 2] };

    /// Adds those of another window.
    pub fn add(&mut self, other: &Self) {
        for (blocks, others) in self.rad_s.iter_mut().zip(&other.rad_s) {
            blocks.iter_mut().zip(others).for_each(|(sum, error)| *sum += error);
        }
    }
}

/// Compares a run with its target while it goes, and ends it when its part of Eq. 8 has passed what is worth while.
#[derive(Debug)]
pub struct Comparison<'a> {
    samples: &'a [Sample],
    reading: Reading,
    next: usize,
    errors: Errors,
    /// 1 / ∫|θ_i,exp| of the whole test.
    weights: Pair,
    wme: f64,
    most_wme: f64,
    residuals: Option<Vec<f64>>,
}

impl<'a> Comparison<'a> {
    /// Before the run; `weights` are the channels' in Eq. 8 of the whole test.
    pub(crate) fn new(samples: &'a [Sample], weights: Pair, most_wme: f64) -> Self {
        let reading = Reading::TRUE;
        Self { samples, reading, next: 0, errors: Errors::NONE, weights, wme: 0.0, most_wme, residuals: None }
    }

    /// Keeps the signed errors of all samples as they weigh in Eq. 8: the sum of their sizes is the WME.
    pub(crate) fn keeping_residuals(mut self) -> Self {
        self.residuals = Some(Vec::with_capacity(2 * self.samples.len()));
        self
    }

    /// The signed errors, if they were to be kept.
    pub(crate) fn into_residuals(self) -> Vec<f64> {
        self.residuals.unwrap_or_default()
    }

    /// Compares what sensors read of the rotations.
    #[must_use]
    pub fn read_by(self, reading: Reading) -> Self {
        Self { reading, ..self }
    }

    /// After the run.
    pub fn errors(&self) -> Errors {
        self.errors
    }

    /// This run's part of Eq. 8 so far; it only grows.
    pub fn wme(&self) -> f64 {
        self.wme
    }
}

impl Sink for Comparison<'_> {
    fn next_s(&self) -> Option<f64> {
        self.samples.get(self.next).map(|sample| sample.time_s)
    }

    fn take(&mut self, theta_rad: Pair, _: Contact) {
        let sample = &self.samples[self.next];
        let theta = self.reading.of(theta_rad);
        for (i, blocks) in self.errors.rad_s.iter_mut().enumerate() {
            let error = sample.weight_s[i] * (sample.theta_rad[i] - theta[i]);
            blocks[sample.block] += error.abs();
            self.wme += self.weights[i] * error.abs();
            if let Some(residuals) = &mut self.residuals {
                residuals.push(self.weights[i] * error);
            }
        }
        self.next += 1;
    }

    /// A wall that collapsed stays at the rotation it collapsed at.
    fn rests_where_it_ended(&self) -> bool {
        true
    }

    fn seen_enough(&self) -> bool {
        self.wme > self.most_wme
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn correlation_of_wave(steps_per_period: usize) -> f64 {
        let wave = |k: usize| (k as f64 * std::f64::consts::TAU / steps_per_period as f64).sin();
        correlation_steps(&(0..100 * steps_per_period).map(wave).collect::<Vec<_>>())
    }

    #[test]
    fn analytic_correlation_time_of_a_wave_is_its_period_over_two_pi() {
        // ∫ cos over a quarter period = period / 2π; the sum is over 400 steps and 100 periods, so within 1 %.
        let expected = 400.0 / std::f64::consts::TAU;
        assert!((correlation_of_wave(400) / expected - 1.0).abs() < 0.01);
    }
}
