//! Runs of a study again at a tighter tolerance.

use std::collections::BTreeMap;

use indicatif::ProgressBar;

use super::conditioning::Again;
use crate::aggregate::{Answer, Compared};
use crate::study::batch::run_all;
use crate::study::plan::Plan;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{Accuracy, Shaking, simulate};

/// The tolerance of the runs again, over that of the study, unless another is given.
const TIGHTER: f64 = 1e-2;

/// Runs that are stored, by position in the plan, and the same at another tolerance, on the threads of the current pool.
///
/// `None` for a hundredth of the tolerance of each run.
pub fn run_again(
    plan: &Plan,
    stored: &BTreeMap<u64, Answer>,
    tolerance: Option<f64>,
    progress: &ProgressBar,
) -> Vec<Again> {
    let tighter = |wall: &Wall, shaking: &Shaking, accuracy: Accuracy| {
        let tolerance = tolerance.unwrap_or(TIGHTER * accuracy.tolerance);
        simulate(wall, shaking, Accuracy { tolerance })
    };
    let compared = Compared::of(plan.kind());
    let runs = run_all(plan, stored.keys().copied().collect(), &tighter, progress).into_iter();
    let again = runs.zip(stored.values()).map(|(finished, stored)| Again {
        variant: finished.run.variant.name.clone(),
        configuration: finished.run.configuration.name().to_owned(),
        stored: stored.clone(),
        tighter: compared.answer(&finished),
    });
    again.collect()
}
