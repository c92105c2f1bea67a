//! The wall of the shaking-table tests, and thirty seconds at 0.005 s of a shipped record.

use std::path::Path;

use mrbd_kernel::model::{ImpactLaw, Restitution, Wall, WallParameters};
use mrbd_records::{Accelerogram, Suite};

/// The calibrated wall of the shaking-table tests (Tables 1 and 2 of the paper).
pub fn table_wall(law: ImpactLaw, capture_velocity_rad_s: f64) -> Wall {
    let coefficients = [0.93, 1.03, 0.825, 0.985, 0.865, 0.76, 0.98, 0.94];
    let parameters = WallParameters {
        thickness_m: 0.291,
        height_m: 3.984,
        crack_height_m: Some(2.191),
        length_m: 1.5,
        mass_kg: 3614.0,
        lower_width_m: 0.271,
        upper_width_m: 0.281,
        diaphragm_mass_kg: 179.0,
        carriage_mass_kg: 663.0,
        stiffness_n_per_m: 37_000.0,
        eccentricity_m: 0.0,
        restitution: Restitution { coefficients, law, capture_velocity_rad_s },
        collapse_rotation_ratio: 2.0,
        initial_rotation_rad: [0.0, 0.0],
        effects: Vec::new(),
        formulas: Vec::new(),
    };
    Wall::new(parameters).expect("the table wall")
}

/// The sixth record of the shipped suite, the one with the largest velocity.
pub fn earthquake() -> Accelerogram {
    let suite = concat!(env!("CARGO_MANIFEST_DIR"), "/inputs/records/emilia7/suite.toml");
    let suite = Suite::load(Path::new(suite)).expect("the shipped suite");
    let record = &suite.records[5].horizontal;
    // Twice as many samples of the same ground motion, for it is linear between them.
    let halves = record.acceleration_m_s2().windows(2).flat_map(|pair| [pair[0], 0.5 * (pair[0] + pair[1])]);
    Accelerogram::new(record.step_s() / 2.0, halves.collect()).expect("a valid record")
}
