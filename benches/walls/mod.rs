//! Façades of the survey, and the records they stand under.

use std::path::{Path, PathBuf};

use mrbd::survey::Assumptions;
use mrbd::survey::sampling::{FacadeSampler, Sampling};
use mrbd::survey::{Configuration, Survey};
use mrbd_files::coefficients::CoefficientSets;
use mrbd_kernel::model::{Restitution, Wall};
use mrbd_kernel::simulate::Shaking;
use mrbd_records::{Accelerogram, Suite};

fn shipped(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The seven shipped records.
pub fn records() -> Vec<Accelerogram> {
    let suite = Suite::load(&shipped("inputs/records/emilia7/suite.toml")).expect("the shipped suite");
    suite.records.into_iter().map(|record| record.horizontal).collect()
}

/// A record and five seconds of free motion.
pub fn shaking(record: &Accelerogram) -> Shaking {
    Shaking { horizontal: Some(record.clone()), vertical: None, tail_s: Assumptions::default().tail_s }
}

/// So many draws of each configuration of Table 3, but for those whose corners crush away.
pub fn facades(draws: u64) -> Vec<Wall> {
    let survey = Survey::load(&shipped("inputs/survey.toml")).expect("the shipped survey");
    let sets = CoefficientSets::load(&shipped("inputs/coefficients.toml")).expect("the shipped coefficients");
    let assumptions = Assumptions::default();
    let restitution = Restitution {
        coefficients: sets.best_fit,
        law: assumptions.law,
        capture_velocity_rad_s: assumptions.capture_velocity_rad_s,
    };
    let walls = |configuration: Configuration| {
        let sampling = Sampling::plain(draws, 1);
        let sampler = FacadeSampler::new(&survey, configuration, &sampling).expect("distributions");
        let wall = |i| sampler.facade(i, &assumptions).wall(restitution, assumptions.collapse_rotation_ratio);
        (0..draws).filter_map(|i| wall(i).ok()).collect::<Vec<_>>()
    };
    Configuration::ALL.into_iter().flat_map(walls).collect()
}
