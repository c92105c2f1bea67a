//! How the best vector and its misfit depend on the capture velocity, under either law.
//!
//! Under `whole` every impact of a burst scales the whole motion, so the capture velocity, which cuts bursts off,
//! is a parameter of the model, and C_l mean little without it; under `contact` it should not matter.

use super::archive::Archive;
use super::experiment::Experiment;
use super::gauss_newton::GaussNewton;
use super::objective::{Objective, simulate};
use super::result::CaptureRow;
use super::space::ParameterSpace;
use mrbd_files::error::Result;
use mrbd_kernel::model::ImpactLaw;

/// Vectors of each search: three iterations of Gauss and Newton with eight variables, which suffice from the joint
/// vector on where the misfit is smooth.
const VECTORS: usize = 75;

const LAWS: [ImpactLaw; 2] = [ImpactLaw::Whole, ImpactLaw::Contact];

fn name(law: ImpactLaw, velocity_rad_s: f64) -> String {
    format!("capture {} {velocity_rad_s}", law.name())
}

/// The names of the searches.
pub(super) fn names(velocities_rad_s: &[f64]) -> Vec<String> {
    let of_law = |law: &ImpactLaw| velocities_rad_s.iter().map(|v| name(*law, *v)).collect::<Vec<_>>();
    LAWS.iter().flat_map(of_law).collect()
}

/// Repeats the search over the whole of all tests under both laws at every capture velocity, beginning with the joint
/// vector.
pub(super) fn study(
    experiment: &Experiment,
    archive: &Archive,
    fit: &[usize],
    joint: &[f64],
) -> Result<Vec<CaptureRow>> {
    let mut rows = Vec::new();
    for law in LAWS {
        for &velocity in &experiment.settings.capture_study_rad_s {
            let space = experiment.space.under(law, velocity);
            let method = name(law, velocity);
            let mut objective = Objective {
                space: &space,
                tests: &experiment.tests,
                chosen: fit,
                accuracy: experiment.accuracy(),
                archive,
                method: &method,
            };
            let bounds = space.bounds();
            let mut search = GaussNewton::near(joint.to_vec());
            search.minimise(&bounds, VECTORS, &mut objective)?;
            let best = search.values;
            rows.push(CaptureRow {
                law: law.name().to_owned(),
                capture_velocity_rad_s: velocity,
                wme_of_joint: mean_wme(experiment, &space, fit, joint),
                wme_of_best: mean_wme(experiment, &space, fit, &best),
                best,
            });
        }
    }
    Ok(rows)
}

fn mean_wme(experiment: &Experiment, space: &ParameterSpace, fit: &[usize], values: &[f64]) -> Option<f64> {
    let wme = |&k: &usize| simulate(space, &experiment.tests[k], values, experiment.accuracy())?.wme;
    let sum = fit.iter().map(wme).sum::<Option<f64>>()?;
    Some(sum / fit.len() as f64)
}
