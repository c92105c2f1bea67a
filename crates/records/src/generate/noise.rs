//! Normal noise under an envelope that rises, stays and fades.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::STEP_S;

/// Quiet before the shaking, s.
pub(super) const LEAD_S: f64 = 0.5;
/// Parts of the envelope in significant durations (Jennings, Housner and Tsai 1968, "Simulated earthquake motions"): a
/// parabola, a plateau, an exponential; with these the significant duration of the whole is 1.02 of what is asked.
const RISE: f64 = 0.15;
const STAY: f64 = 0.60;
const FADE: f64 = 1.40;
const FADE_RATE: f64 = 2.0;

/// The generator of random numbers of one record: it depends on the seed and the record's number alone.
pub(super) fn generator(seed: u64, id: u32) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(u64::from(id));
    rng
}

pub(super) fn under_envelope(duration_s: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let length_s = LEAD_S + (RISE + STAY + FADE) * duration_s;
    let samples = (length_s / STEP_S).ceil() as usize;
    (0..=samples)
        .map(|i| {
            let white: f64 = StandardNormal.sample(rng);
            white * envelope((i as f64 * STEP_S - LEAD_S) / duration_s)
        })
        .collect()
}

/// The envelope at a time in significant durations.
fn envelope(time: f64) -> f64 {
    if time < RISE {
        (time / RISE).max(0.0).powi(2)
    } else if time < RISE + STAY {
        1.0
    } else {
        (-FADE_RATE * (time - RISE - STAY)).exp()
    }
}
