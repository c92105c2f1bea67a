//! A test in windows that begin anew from the measured motion.
//!
//! A free-running impact system forgets: after some impacts a small error of a coefficient, or of the model, is a large
//! one of the motion, and Eq. 8 over a whole test is a rough function with many local minima. Each window starts from the
//! measured motion just before some impacts, so its error tells of these alone, and the sum over all windows is smooth.

use super::misfit::{Sample, Target};
use super::start_state::StartFit;
use super::stretches::{Stretch, noise_rad, stretches};
use mrbd_kernel::simulate::{Simulator, Start};

/// A part of a test that is simulated in one go.
#[derive(Debug, Clone)]
pub(super) struct Window {
    /// Where it starts; none: with the run itself, from rest.
    pub start: Option<Start>,
    pub end_s: f64,
    pub samples: Vec<Sample>,
}

impl Window {
    /// The whole of a test.
    pub fn whole(target: &Target) -> Self {
        Self { start: None, end_s: target.end_s(), samples: target.samples().to_vec() }
    }
}

/// Windows from each stretch without impacts to the end of the next; the first starts from rest, as the test did. The
/// simulator is of a wall whose motion between impacts is that of the measured one.
pub(super) fn windows(target: &Target, simulator: &Simulator) -> Vec<Window> {
    let samples = target.samples();
    let noise_rad = noise_rad(samples);
    let start = |stretch: Stretch| {
        let part = &samples[stretch.first..stretch.end];
        let fit = StartFit { simulator, samples: part, contact: stretch.contact, noise_rad };
        fit.start().map(|start| (start, stretch))
    };
    let starts = stretches(samples, noise_rad).into_iter().filter_map(start).collect::<Vec<_>>();
    // Number k starts at the k-th stretch, number 0 from rest.
    let first = |k: usize| k.checked_sub(1).map_or(0, |k| starts[k].1.first);
    let end = |k: usize| starts.get(k.wrapping_sub(1)).map_or(samples.len(), |(_, stretch)| stretch.end);
    let window = |k: usize| {
        let part = &samples[first(k)..end(k + 1)];
        let end_s = part.last().map_or(0.0, |s| s.time_s);
        Window { start: k.checked_sub(1).map(|k| starts[k].0), end_s, samples: part.to_vec() }
    };
    (0..=starts.len()).map(window).filter(|w| w.samples.len() >= 2).collect()
}
