//! Cases with nothing hidden, of every formulation in turn: nothing may be named in them.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::super::compliant::corner::Corners;
use super::draw::{Case, Contacts, Simulator, combination, generator, of_kind, plastic};
use super::kind::Kind;

/// Formulations: this library's, and free bodies on corners as near to sharp edges as may be, on corners that are alike, and on
/// rows of springs.
pub const FORMULATIONS: u64 = 4;
/// Stiffness of corners that are alike, N/m: a bed of 6 K/(L b) turns as much, at least 1e11 Pa/m.
pub const CORNERS_N_PER_M: [f64; 2] = [1e10, 1e11];
/// Stiffness of rows of springs, Pa/m.
const SPRINGS_PA_PER_M: [f64; 2] = [3e11, 3e12];
/// Damping time of either, s.
pub const DAMPING_S: [f64; 2] = [2e-4, 6e-4];
/// Tests to fit and held out: as few as cases have elsewhere, so that a hundred of each formulation can be answered.
const TESTS: [usize; 2] = [2, 1];

/// The case of this number.
pub fn draw(set: &str, number: u64) -> Case {
    let formulation = number % FORMULATIONS;
    let turn = number / FORMULATIONS;
    let drawn = of_kind(set, number, Kind::Nothing, turn as usize);
    let mut rng = generator(set, number, 60);
    let (noise_rad, ..) = combination(set, &format!("nothing, {formulation}"), turn as usize);
    let contacts = contacts(formulation, &mut rng);
    let simulator = if formulation == 0 { Simulator::Own } else { Simulator::Compliant };
    let impacts = |wall| if formulation == 0 { wall } else { plastic(wall) };
    let [fit_tests, hold_out_tests] = TESTS;
    Case {
        simulator,
        contacts,
        noise_rad,
        fit_tests,
        hold_out_tests,
        described: impacts(drawn.described.clone()),
        actual: impacts(drawn.actual.clone()),
        ..drawn
    }
}

fn contacts(formulation: u64, rng: &mut ChaCha8Rng) -> Contacts {
    let damping_s = even(DAMPING_S, rng);
    match formulation {
        2 => Contacts::Corners(corners(even(CORNERS_N_PER_M, rng), damping_s)),
        3 => Contacts::Springs { stiffness_pa_per_m: even(SPRINGS_PA_PER_M, rng), damping_s },
        _ => Contacts::SharpEdges,
    }
}

/// Corners of a stiffness, N/m, and a damping time, s.
pub fn corners(stiffness_n_per_m: f64, damping_s: f64) -> Corners {
    Corners { stiffness_n_per_m, damping_n_s_per_m: damping_s * stiffness_n_per_m }
}

/// Drawn evenly by its logarithm.
pub fn even([low, high]: [f64; 2], rng: &mut ChaCha8Rng) -> f64 {
    low * f64::powf(high / low, rng.random_range(0.0..1.0))
}
