//! Joints that are no sharp edges: beds of springs, and their rivals.

mod beds;
mod laws;

use mrbd_kernel::model::{Effect, ImpactLaw, Restitution, Wall, WallParameters};
use mrbd_kernel::simulate::{Accuracy, History, Response, Shaking, simulate_observed};

const TIGHT: Accuracy = Accuracy { tolerance: 1e-10 };

/// The strip of the paper's Table 1 without anything on its top.
fn block(effects: Vec<Effect>, theta: f64) -> WallParameters {
    let strip = WallParameters::strip(0.291, 3.984, 1800.0);
    WallParameters { length_m: 1.5, mass_kg: 3614.0, initial_rotation_rad: [theta; 2], effects, ..strip }
}

/// The wall of the paper's Table 1 on its full thickness, its impacts plastic.
fn table_wall(effects: Vec<Effect>, initial_rotation_rad: [f64; 2]) -> WallParameters {
    WallParameters {
        crack_height_m: Some(2.191),
        diaphragm_mass_kg: 179.0,
        carriage_mass_kg: 663.0,
        stiffness_n_per_m: 37e3,
        initial_rotation_rad,
        restitution: Restitution { law: ImpactLaw::Contact, ..Restitution::default() },
        ..block(effects, 0.0)
    }
}

fn wall(parameters: WallParameters) -> Wall {
    Wall::new(parameters).expect("a wall that can exist")
}

fn released(parameters: WallParameters, tail_s: f64) -> (Response, History) {
    let mut history = History::new(0.005);
    let free = Shaking { tail_s, ..Shaking::default() };
    let response = simulate_observed(&wall(parameters), &free, TIGHT, &mut history);
    (response, history)
}

/// By how much a block let go at θ_0 is late at upright, and its quarter period by the quadrature of its energy, s; it is
/// simulated for a share of that.
fn late_at_upright_s(
    block: &Wall,
    theta_0: f64,
    energy: impl Fn(f64, f64) -> f64,
    simulated_share: f64,
) -> [f64; 2] {
    let released_j = energy(theta_0, 0.0);
    // θ = θ_0 (1 - u²) takes the singularity at the turning point away.
    let rate = |u: f64| {
        let theta = theta_0 * (1.0 - u * u);
        let half_mass = energy(theta, 1.0) - energy(theta, 0.0);
        2.0 * theta_0 * u * (half_mass / (released_j - energy(theta, 0.0))).sqrt()
    };
    let pieces = 20_000;
    let quarter_s =
        (0..pieces).map(|i| rate((f64::from(i) + 0.5) / f64::from(pieces))).sum::<f64>() / f64::from(pieces);
    let mut history = History::new(quarter_s / 500.0);
    let free = Shaking { tail_s: simulated_share * quarter_s, ..Shaking::default() };
    simulate_observed(block, &free, TIGHT, &mut history);
    let last = history.rows.last().expect("rows");
    let speed = (released_j / (energy(0.0, 1.0) - energy(0.0, 0.0))).sqrt();
    // Along the tangent, from a row that is at most a five-hundredth of the time away.
    [last.theta_rad[0] / speed - (quarter_s - last.time_s), quarter_s]
}
