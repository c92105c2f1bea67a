//! What the searches found, evaluated. Each search's best vector is run in every test, and every test under the one
//! vector. The search is repeated under other laws and capture velocities.
//!
//! Under `whole` every impact of a burst scales the whole motion. So the capture velocity, which cuts bursts off, is a
//! parameter of the model, and C_l mean little without it. Under `contact` it should not matter.

use rayon::prelude::*;

use super::archive::Archive;
use super::flow::Experiment;
use super::gauss_newton::GaussNewton;
use super::identifiability::Judge;
use super::objective::{Objective, simulate};
use super::parameters::ParameterSpace;
use super::result::{CaptureRow, MethodResult, TestResult, Vector};
use super::search::Found;
use crate::experiment::Simulated;
use mrbd_files::error::Result;
use mrbd_kernel::model::ImpactLaw;

/// Puts results together for an experiment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Evaluation<'a> {
    pub experiment: &'a Experiment,
    /// Numbers of the tests to fit.
    pub fit: &'a [usize],
}

impl Evaluation<'_> {
    /// The searches in the order they are told.
    pub fn methods(
        &self,
        paper: &[Found],
        adaptive: &[Found],
        similar: Option<(Vec<f64>, f64)>,
        [joint, refined]: [&Found; 2],
    ) -> Vec<MethodResult> {
        let mut methods = Vec::new();
        for (method, all) in [("paper", paper), ("adaptive", adaptive)] {
            for (found, &test) in all.iter().zip(self.fit) {
                let name = Some(self.experiment.tests[test].name.clone());
                methods.push(self.method(method, name, found, 1));
            }
        }
        if let Some((values, similarity)) = similar {
            methods.push(MethodResult {
                method: "similarity".into(),
                test: None,
                best: self.vector(&values),
                simulations: paper.iter().map(|found| found.evaluations).sum(),
                generations: paper.iter().map(|found| found.best_costs.len() - 1).max().unwrap_or(0),
                vectors: Vec::new(),
                best_costs: Vec::new(),
                cost_sums: Vec::new(),
                similarity: Some(similarity),
            });
        }
        methods.push(self.method("joint", None, joint, self.fit.len()));
        methods.push(self.method("refined", None, refined, self.fit.len()));
        methods
    }

    fn method(&self, method: &str, test: Option<String>, found: &Found, runs_each: usize) -> MethodResult {
        MethodResult {
            method: method.to_owned(),
            test,
            best: self.vector(&found.best().values),
            simulations: found.evaluations * runs_each,
            generations: found.best_costs.len() - 1,
            vectors: found.vectors.clone(),
            best_costs: found.best_costs.clone(),
            cost_sums: found.cost_sums.clone(),
            similarity: None,
        }
    }

    /// A vector in every test.
    pub fn vector(&self, values: &[f64]) -> Vector {
        let wme = self.simulated(values).into_iter().map(|s| s.and_then(|s| s.wme)).collect::<Vec<_>>();
        let sum = self.fit.iter().map(|&k| wme[k]).sum::<Option<f64>>();
        let mean_wme = sum.map(|sum| sum / self.fit.len() as f64);
        Vector { values: values.to_vec(), mean_wme, wme }
    }

    fn simulated(&self, values: &[f64]) -> Vec<Option<Simulated>> {
        let Experiment { space, tests, .. } = self.experiment;
        tests.par_iter().map(|test| simulate(space, test, values, self.experiment.accuracy())).collect()
    }

    /// The vector with the coefficients that never act in it at 1, which changes none of its runs.
    pub fn without_idle(&self, vector: &Vector) -> Vector {
        let acting = Judge::acting(&self.simulated(&vector.values), self.fit);
        let parameters = &self.experiment.space.parameters;
        let law = self.experiment.space.base().restitution.law;
        let values =
            vector.values.iter().zip(parameters).map(|(&value, parameter)| match parameter.coefficient() {
                Some(l) if Judge::idle(l, &acting, law).is_some() => 1.0,
                _ => value,
            });
        self.vector(&values.collect::<Vec<_>>())
    }

    /// Every test under the vector for all.
    pub fn tests(&self, joint: &Vector, methods: &[MethodResult]) -> Vec<TestResult> {
        let before = self.simulated(&self.experiment.space.nominal());
        let after = self.simulated(&joint.values);
        let rms = |k: usize, values: &[f64]| {
            let Experiment { space, tests, .. } = self.experiment;
            let wall = space.wall(values).ok();
            wall.map_or([None; 2], |wall| tests[k].rms_rad(&wall, self.experiment.accuracy()))
        };
        let result = |k: usize| {
            let test = &self.experiment.tests[k];
            let own = methods.iter().filter(|m| m.test.as_ref() == Some(&test.name));
            let alone = own.filter_map(|m| m.best.wme[k]).reduce(f64::min);
            TestResult {
                name: test.name.clone(),
                purpose: test.purpose.name().to_owned(),
                wme_before: before[k].as_ref().and_then(|s| s.wme),
                wme_joint: after[k].as_ref().and_then(|s| s.wme),
                rms_rad_before: rms(k, &self.experiment.space.nominal()),
                rms_rad_joint: rms(k, &joint.values),
                wme_alone: alone,
                transitions: after[k].as_ref().map_or([0; 8], |s| s.transitions),
                measured_collapse_s: test.collapse_s,
                simulated_collapse_s: after[k].as_ref().and_then(|s| s.collapse_s),
                lost_channels: test.target.counted_s().map(|s| s == 0.0),
                channels_at_rest: test.target.at_rest(),
                alignment: test.alignment,
                independent_samples: test.target.independent_samples(),
            }
        };
        (0..self.experiment.tests.len()).map(result).collect()
    }
}

/// Vectors of each search: three iterations of Gauss and Newton with eight variables, which suffice from the joint
/// vector on where the misfit is smooth.
const VECTORS: usize = 75;

const LAWS: [ImpactLaw; 2] = [ImpactLaw::Whole, ImpactLaw::Contact];

fn capture_name(law: ImpactLaw, velocity_rad_s: f64) -> String {
    format!("capture {} {velocity_rad_s}", law.name())
}

/// The names of the searches.
pub(super) fn capture_names(velocities_rad_s: &[f64]) -> Vec<String> {
    let of_law =
        |law: &ImpactLaw| velocities_rad_s.iter().map(|v| capture_name(*law, *v)).collect::<Vec<_>>();
    LAWS.iter().flat_map(of_law).collect()
}

/// Repeats the search over the whole of all tests under both laws at every capture velocity, beginning with the joint
/// vector.
pub(super) fn capture_study(
    experiment: &Experiment,
    archive: &Archive,
    fit: &[usize],
    joint: &[f64],
) -> Result<Vec<CaptureRow>> {
    let mut rows = Vec::new();
    for law in LAWS {
        for &velocity in &experiment.settings.capture_study_rad_s {
            let space = experiment.space.under(law, velocity);
            let method = capture_name(law, velocity);
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
