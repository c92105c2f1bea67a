//! What the searches found, told: each search's best vector in every test, and every test under the one vector.

use rayon::prelude::*;

use super::experiment::Experiment;
use super::identifiability::Judge;
use super::objective::simulate;
use super::result::{MethodResult, TestResult, Vector};
use super::search::Found;
use crate::experiment::Simulated;

/// Puts results together for an experiment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Assembly<'a> {
    pub experiment: &'a Experiment,
    /// Numbers of the tests to fit.
    pub fit: &'a [usize],
}

impl Assembly<'_> {
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
    fn vector(&self, values: &[f64]) -> Vector {
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
        let result = |k: usize| {
            let test = &self.experiment.tests[k];
            let own = methods.iter().filter(|m| m.test.as_ref() == Some(&test.name));
            let alone = own.filter_map(|m| m.best.wme[k]).reduce(f64::min);
            TestResult {
                name: test.name.clone(),
                purpose: test.purpose.name().to_owned(),
                wme_before: before[k].as_ref().and_then(|s| s.wme),
                wme_joint: after[k].as_ref().and_then(|s| s.wme),
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
