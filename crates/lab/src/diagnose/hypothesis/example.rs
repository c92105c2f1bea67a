//! Hypotheses for tests of what is made of them.

use std::path::Path;

use super::Hypothesis;
use super::addition::candidates;
use super::beds;
use super::unknown::Scales;
use mrbd_files::parse_wall;

/// Sizes as in a test of some strength.
pub const SCALES: Scales = Scales {
    displacement_m: 0.05,
    rotation_rad: 0.02,
    frequency_rad_s: 5.0,
    force_n: 1000.0,
    moment_n_m: 2000.0,
    width_m: 0.3,
    sensor_gain_sd: None,
    length_m: 1.0,
};

/// The starter's wall with the effects of these names.
pub fn starter_with(names: &[&str]) -> Hypothesis {
    let wall = parse_wall(Path::new("wall.toml"), include_str!("../../../../../src/cli/starter/wall.toml"))
        .expect("the starter's wall");
    let all = candidates(wall.parameters()).into_iter().chain(beds()).collect::<Vec<_>>();
    let named = |name: &&str| {
        *all.iter().find(|a| a.name() == *name).unwrap_or_else(|| panic!("{name} in the catalogue"))
    };
    let additions = names.iter().map(named).collect::<Vec<_>>();
    Hypothesis::new(wall.parameters(), &SCALES, &[], &additions)
}
