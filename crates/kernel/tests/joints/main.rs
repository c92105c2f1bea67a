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
