//! Incremental analyses: the intensity at which a wall first exceeds a limit, by bracketing.
//!
//! Vamvatsikos & Cornell (2002), "Incremental dynamic analysis", Earthquake Engng Struct. Dyn. 31, hunt and fill:
//! intensities grow by a factor until one exceeds the limit, and the last step is then halved in the logarithm until it
//! is narrow enough. A rocking wall that fell may stand a stronger record again; what is found is the first fall met on
//! the way up, and steps that are too large can pass over one.

use super::{Finished, Found};
use crate::study::pipeline::Limit;
use crate::study::plan::Growth;

/// Share of the first intensity below which a wall that still exceeds its limit fails the search.
const LEAST: f64 = 1e-6;

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
    let ended = bracketed(&growth, &mut at);
    // All simulations count, those after the one that is kept too.
    Finished { simulations, ..ended }
}

/// The last of two intensities that stood, and the first that exceeded the limit with its run.
struct Bracket {
    below: f64,
    above: f64,
    last: Finished,
}

/// A run that ends the search before a bracket is found: it failed, or nothing exceeded the limit.
type Ended = Box<Finished>;

/// The run at the lowest intensity found to exceed the limit, at the last one where none did, or one that failed.
fn bracketed(growth: &Growth, at: &mut impl FnMut(f64) -> Finished) -> Finished {
    match first_bracket(growth, at).and_then(|bracket| narrowed(growth, bracket, at)) {
        Err(ended) => *ended,
        Ok(Bracket { below, last, .. }) => {
            Finished { found: Some(Found { exceeded: true, stood_intensity: below }), ..last }
        }
    }
}

fn first_bracket(growth: &Growth, at: &mut impl FnMut(f64) -> Finished) -> Result<Bracket, Ended> {
    let [from, to] = growth.range;
    let mut trial = at(from);
    let mut intensity = from;
    if exceeds(growth.limit, &trial)? {
        // The first intensity is too much already.
        while intensity > LEAST * from {
            let (above, last) = (intensity, trial);
            intensity /= growth.growth;
            trial = at(intensity);
            if !exceeds(growth.limit, &trial)? {
                return Ok(Bracket { below: intensity, above, last });
            }
        }
        let reason = "the limit is exceeded at however low an intensity".to_owned();
        return Err(Box::new(Finished { failure: Some(reason), ..trial }));
    }
    while intensity < to {
        let below = intensity;
        intensity = (intensity * growth.growth).min(to);
        trial = at(intensity);
        if exceeds(growth.limit, &trial)? {
            return Ok(Bracket { below, above: intensity, last: trial });
        }
    }
    let found = Found { exceeded: false, stood_intensity: intensity };
    Err(Box::new(Finished { found: Some(found), ..trial }))
}

/// Halves the logarithm of a bracket until it is narrow enough.
fn narrowed(
    growth: &Growth,
    mut bracket: Bracket,
    at: &mut impl FnMut(f64) -> Finished,
) -> Result<Bracket, Ended> {
    while bracket.above / bracket.below > growth.bracket {
        let middle = (bracket.below * bracket.above).sqrt();
        let trial = at(middle);
        bracket = match exceeds(growth.limit, &trial)? {
            true => Bracket { above: middle, last: trial, ..bracket },
            false => Bracket { below: middle, ..bracket },
        };
    }
    Ok(bracket)
}

/// Whether a run exceeded the limit; a run that failed ends the search.
fn exceeds(limit: Limit, trial: &Finished) -> Result<bool, Ended> {
    let Some(response) = trial.usable() else { return Err(Box::new(trial.clone())) };
    Ok(response.collapsed()
        || match limit {
            Limit::Collapse => false,
            Limit::Rotation(over_alpha_i) => response.theta_max_over_own_alpha() > over_alpha_i,
        })
}
