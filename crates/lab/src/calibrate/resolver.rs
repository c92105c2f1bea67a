//! From the keys of an experiment to the variables of a search.

use std::path::Path;

use toml::{Table, Value};

use super::parameter::{Parameter, Target};
use super::search::Bounds;
use crate::experiment_file::{ExperimentFile, ParameterTable};
use mrbd_files::coefficients::CoefficientSets;
use mrbd_files::error::{InputError, Result};
use mrbd_files::suggestion::with_suggestion;
use mrbd_kernel::written;

/// Tables in which a bare key is looked for, in this order: `mass_kg` is the wall's.
const TABLES: [&str; 6] = ["wall", "corners", "diaphragm", "restitution", "collapse", "initial"];

/// Bounds of a parameter known beforehand reach this many standard deviations.
const PRIOR_REACH: f64 = 3.0;

/// From the keys of an experiment to variables.
pub(super) struct Resolver<'a> {
    /// The experiment's file.
    pub path: &'a Path,
    /// The wall's file.
    pub table: &'a Table,
    pub experiment: &'a ExperimentFile,
    pub sets: &'a CoefficientSets,
}

impl Resolver<'_> {
    /// The variables, in the order of the experiment.
    ///
    /// # Errors
    /// Input errors for a key that is no number of the wall file, given twice, or without bounds in the right order.
    pub fn parameters(&self) -> Result<Vec<Parameter>> {
        let all = [ParameterTable { key: "restitution".into(), lower: None, upper: None }];
        let given = &self.experiment.calibrate.parameters;
        let wanted = if given.is_empty() { &all[..] } else { given };
        let mut parameters: Vec<Parameter> = Vec::new();
        for (i, table) in wanted.iter().enumerate() {
            for name in self.expand(&table.key) {
                let parameter = self.parameter(i, &name, table)?;
                if parameters.iter().any(|p| p.target == parameter.target) {
                    return Err(self
                        .fault(i, "key", format!("{:?} again", table.key), "each key once")
                        .into());
                }
                parameters.push(parameter);
            }
        }
        self.check_prior_keys()?;
        Ok(parameters)
    }

    /// One key may stand for several variables.
    fn expand(&self, key: &str) -> Vec<String> {
        match key {
            "restitution" => (1..=8).map(|l| format!("C_{l}")).collect(),
            "corner_widths" => ["corners.lower_width_m", "corners.upper_width_m"].map(Into::into).to_vec(),
            key => vec![key.to_owned()],
        }
    }

    fn parameter(&self, i: usize, name: &str, table: &ParameterTable) -> Result<Parameter, InputError> {
        let (name, target, nominal) = self.resolve(name).ok_or_else(|| {
            let allowed = "C_1 to C_8, restitution, corner_widths, or a number that stands in the wall file, \
                           such as diaphragm.stiffness_n_per_m or effects.0.coefficient_n_s_per_m";
            self.fault(i, "key", format!("{name:?}"), &self.suggested(allowed, name))
        })?;
        let relative = self.prior_sd(&target);
        if nominal == 0.0 && relative.is_some() {
            let found = format!("{name}, which is 0 in the wall file, with a prior");
            return Err(self.fault(i, "key", found, "bounds alone: a prior is a share of the number"));
        }
        let prior_sd = relative.map(|relative| relative * nominal.abs());
        let default = match (&target, prior_sd) {
            (Target::Coefficient(l), _) => Some([self.sets.lower[*l], self.sets.upper[*l]]),
            (_, Some(sd)) => Some([nominal - PRIOR_REACH * sd, nominal + PRIOR_REACH * sd]),
            _ => None,
        };
        let bound = |given: Option<f64>, side: usize, field: &str| {
            let allowed = "a bound, or a standard deviation under [prior]";
            given
                .or(default.map(|both| both[side]))
                .ok_or_else(|| self.fault(i, field, format!("none for {name}"), allowed))
        };
        let bounds =
            Bounds { lower: bound(table.lower, 0, "lower")?, upper: bound(table.upper, 1, "upper")? };
        if !(bounds.lower.is_finite() && bounds.upper.is_finite() && bounds.lower < bounds.upper) {
            let found = format!("{} to {} for {name}", written(bounds.lower), written(bounds.upper));
            return Err(self.fault(i, "lower", found, "finite bounds with lower < upper"));
        }
        Ok(Parameter { name, target, bounds, nominal, prior_sd })
    }

    fn resolve(&self, key: &str) -> Option<(String, Target, f64)> {
        if let Some(l) = key.strip_prefix("C_").and_then(|l| l.parse::<usize>().ok()) {
            return (1..=8).contains(&l).then(|| (key.to_owned(), Target::Coefficient(l - 1), 1.0));
        }
        let steps = self.steps(key)?;
        let nominal = number(find(self.table, &steps)?)?;
        Some((steps.join("."), Target::Key(steps), nominal))
    }

    fn steps(&self, key: &str) -> Option<Vec<String>> {
        if key.contains('.') {
            return Some(key.split('.').map(str::to_owned).collect());
        }
        let holds = |table: &&&str| self.table.get(**table).and_then(|t| t.get(key)).is_some();
        TABLES.iter().find(holds).map(|table| vec![(*table).to_owned(), key.to_owned()])
    }

    fn prior_sd(&self, target: &Target) -> Option<f64> {
        let names = |key: &String| self.expand(key).into_iter().filter_map(|name| self.resolve(&name));
        let prior = &self.experiment.prior;
        prior.iter().find(|(key, _)| names(key).any(|(_, t, _)| t == *target)).map(|(_, sd)| *sd)
    }

    fn check_prior_keys(&self) -> Result<(), InputError> {
        for key in self.experiment.prior.keys() {
            let known = key == "corner_widths" || key == "restitution" || self.resolve(key).is_some();
            // Absent from the file but with a default, such as an eccentricity of zero, is known exactly.
            if !known {
                let allowed = "a number that stands in the wall file, restitution or corner_widths";
                let allowed = self.suggested(allowed, key);
                return Err(InputError::key(self.path, format!("prior.{key}"), "no such key", allowed));
            }
        }
        Ok(())
    }

    /// What is allowed, with the key of the wall file that was likely meant, dotted if what was found is.
    fn suggested(&self, allowed: &str, found: &str) -> String {
        let inner = |(table, value): (&String, &Value)| -> Vec<String> {
            let keys = value.as_table().into_iter().flat_map(Table::keys);
            keys.map(|key| if found.contains('.') { format!("{table}.{key}") } else { key.clone() }).collect()
        };
        let known: Vec<String> = self.table.iter().flat_map(inner).collect();
        with_suggestion(allowed.to_owned(), found, known.iter().map(String::as_str))
    }

    fn fault(&self, i: usize, field: &str, found: impl Into<String>, allowed: &str) -> InputError {
        InputError::key(self.path, format!("calibrate.parameters[{i}].{field}"), found, allowed)
    }
}

fn find<'t>(table: &'t Table, steps: &[String]) -> Option<&'t Value> {
    let (first, rest) = steps.split_first()?;
    rest.iter().try_fold(table.get(first)?, |value, step| match value {
        Value::Table(inner) => inner.get(step),
        Value::Array(list) => list.get(step.parse::<usize>().ok()?),
        _ => None,
    })
}

fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Float(x) => Some(*x),
        Value::Integer(i) => Some(*i as f64),
        _ => None,
    }
}
