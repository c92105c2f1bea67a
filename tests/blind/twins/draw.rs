//! From a set and a number to a twin.

use rand::RngExt;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

use super::super::cases::draw::{Case, NOISES_RAD, Prior, Simulator, generator, of_kind};
use super::super::cases::kind::Kind;
use super::super::cases::walls::WallNumbers;

/// A wall whose coefficients are known, before anything is simulated.
#[derive(Debug, Clone)]
pub struct Twin {
    pub set: String,
    pub number: u64,
    /// The wall as it is and its tests; nothing is hidden in it. `None`: the example of `mrbd init`.
    pub case: Option<Case>,
    /// Bounds of C_1 … C_8.
    pub bounds: [[f64; 2]; 8],
    /// k_d of the wall file over the true one, where k_d is calibrated too.
    pub stiffness_over_true: Option<f64>,
    /// Shaking of each test, s.
    pub length_s: f64,
    /// Whether the budgets of the search are the program's own, or those of the example.
    pub by_default: bool,
}

/// Bounds β_0 and β_f of the paper's Table 2.
const TABLE_2_BOUNDS: [[f64; 2]; 8] =
    [[0.9, 1.05], [0.9, 1.05], [0.8, 1.0], [0.8, 1.0], [0.8, 1.0], [0.7, 0.8], [0.9, 1.0], [0.9, 1.0]];
/// Bounds about plastic impacts, C_l = 1.
const PLASTIC_BOUNDS: [[f64; 2]; 8] = [[0.85, 1.1]; 8];
/// Every so many twins one is the example of `mrbd init`, under another seed of the search.
const EXAMPLE: u64 = 10;
/// Every so many twins one is searched with the program's own budgets, which take some ten times as long.
const BY_DEFAULT: u64 = 16;
/// Shaking of a test, s; three more are measured after it.
const LENGTHS_S: [f64; 2] = [10.0, 87.0];

/// The twin of this number.
pub fn draw(set: &str, number: u64) -> Twin {
    let example = number % EXAMPLE == EXAMPLE - 1;
    let mut rng = generator(set, number, 40);
    let [shortest, longest] = LENGTHS_S;
    let length_s = shortest * (longest / shortest).powf(rng.random_range(0.0..1.0));
    let plastic = rng.random_range(0.0..1.0) < 0.5;
    let mut twin = Twin {
        set: set.to_owned(),
        number,
        case: None,
        bounds: TABLE_2_BOUNDS,
        stiffness_over_true: None,
        length_s,
        by_default: number % BY_DEFAULT == BY_DEFAULT / 2,
    };
    if example {
        return twin;
    }
    // Both laws in the library's own simulator; the other knows `contact`.
    let (law, simulator) =
        [("contact", Simulator::Own), ("whole", Simulator::Own), ("contact", Simulator::Compliant)]
            [(number % 3) as usize];
    if simulator == Simulator::Compliant && plastic {
        twin.bounds = PLASTIC_BOUNDS;
    }
    let coefficients = match (simulator, plastic) {
        (Simulator::Compliant, true) => [1.0; 8],
        _ => TABLE_2_BOUNDS.map(|[lower, upper]| rng.random_range(lower..upper)),
    };
    if rng.random_range(0.0..1.0) < 0.25 {
        let off = Prior::Known.stiffness() * 3f64.sqrt();
        twin.stiffness_over_true = Some(1.0 + rng.random_range(-off..off));
    }
    twin.case = Some(case(set, number, (law, simulator), coefficients, &mut rng));
    twin
}

fn case(
    set: &str,
    number: u64,
    (law, simulator): (&'static str, Simulator),
    coefficients: [f64; 8],
    rng: &mut ChaCha8Rng,
) -> Case {
    // The noises take turns in every law and simulator, in an order of the set's own.
    let mut noises = NOISES_RAD;
    noises.shuffle(&mut generator(set, 0, 41));
    let drawn = of_kind(set, number, Kind::Nothing, 0);
    let actual = WallNumbers { coefficients, law, ..drawn.described };
    Case {
        simulator,
        noise_rad: noises[(number / 3 % 4) as usize],
        target_rad: rng.random_range(0.10..0.25) * actual.widths_m[0] / actual.height_m * 2.0,
        described: actual.clone(),
        actual,
        hidden: Vec::new(),
        fit_tests: rng.random_range(3..=6),
        hold_out_tests: 0,
        ..drawn
    }
}

/// Motions of a length: the strong parts of those there are, one after another, each beginning with another.
pub fn lengthened(motions: &[Vec<f64>], length_s: f64, step_s: f64) -> Vec<Vec<f64>> {
    let samples = (length_s / step_s).round() as usize;
    let strong = motions.iter().map(|motion| strong_part(motion, step_s)).collect::<Vec<_>>();
    let from = |first: usize| {
        let joined = (0..).flat_map(|k| strong[(first + k) % strong.len()].iter().copied());
        joined.take(samples).collect()
    };
    (0..strong.len()).map(from).collect()
}

/// From half a second before a motion reaches a tenth of its peak to a second after it falls below.
fn strong_part(motion: &[f64], step_s: f64) -> &[f64] {
    let peak = motion.iter().fold(0.0, |peak: f64, a| peak.max(a.abs()));
    let is_strong = |a: &f64| a.abs() > 0.1 * peak;
    let first = motion.iter().position(is_strong).unwrap_or(0);
    let last = motion.iter().rposition(is_strong).unwrap_or(motion.len() - 1);
    let in_samples = |s: f64| (s / step_s).round() as usize;
    &motion[first.saturating_sub(in_samples(0.5))..(last + in_samples(1.0)).min(motion.len())]
}
