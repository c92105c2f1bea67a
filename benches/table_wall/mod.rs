//! The wall of the shaking-table tests, and thirty seconds at 0.005 s of a shipped record.

use std::path::Path;

use mrbd_kernel::model::{ImpactLaw, Restitution, Wall, WallParameters};
use mrbd_records::{Accelerogram, Suite};

/// The calibrated wall of the shaking-table tests, under an impact law and a capture velocity.
pub fn table_wall(law: ImpactLaw, capture_velocity_rad_s: f64) -> Wall {
    let mut parameters = WallParameters::table_wall();
    parameters.restitution = Restitution { law, capture_velocity_rad_s, ..parameters.restitution };
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
