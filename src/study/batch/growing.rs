//! Incremental analyses: runs at growing intensities, until one exceeds a limit.

use super::{Finished, Found};
use crate::study::ladder::Search;
use crate::study::pipeline::Limit;
use crate::study::plan::Growth;

/// Searches from a run that is at no intensity yet; `simulate` runs it at the factor it is at.
pub(super) fn search(
    planned: Finished,
    growth: Growth,
    mut simulate: impl FnMut(Finished) -> Finished,
) -> Finished {
    let measures = planned.run.record().intensity;
    let mut simulations = 0;
    let mut at = |intensity: f64| {
        let mut trial = planned.clone();
        trial.run.factor = growth.measure.factor_to(&measures, intensity);
        trial.simulations = simulations;
        let finished = simulate(trial);
        simulations = finished.simulations;
        finished
    };
    let mut judged = |intensity: f64| {
        let trial = at(intensity);
        exceeds(growth.limit, &trial).map(|exceeded| (exceeded, trial))
    };
    let ended = ended(growth.ladder().first_exceeding(&mut judged));
    // All simulations count, those after the one that is kept too.
    Finished { simulations, ..ended }
}

/// A run that ends the search before a bracket is found: it failed.
type Failed = Box<Finished>;

/// The run at the lowest intensity found to exceed the limit, at the last one where none did, or one that failed.
fn ended(search: Result<Search<Finished>, Failed>) -> Finished {
    let found = |exceeded, stood_intensity| Some(Found { exceeded, stood_intensity });
    match search {
        Err(failed) => *failed,
        Ok(Search::Exceeded { below, trial, .. }) => Finished { found: found(true, below), ..trial },
        Ok(Search::Stood { at, trial }) => Finished { found: found(false, at), ..trial },
        Ok(Search::Always { trial }) => {
            let reason = "the limit is exceeded at however low an intensity".to_owned();
            Finished { failure: Some(reason), ..trial }
        }
    }
}

/// Whether a run exceeded the limit; a run that failed ends the search.
fn exceeds(limit: Limit, trial: &Finished) -> Result<bool, Failed> {
    let Some(response) = trial.usable() else { return Err(Box::new(trial.clone())) };
    Ok(limit.exceeded_by(response))
}
