//! What is calibrated: the variables of a search from the keys of an experiment, and the wall that values of them make.

use std::path::{Path, PathBuf};

use toml::{Table, Value};

use super::search::Bounds;
use crate::diagnose::experiment::SENSOR_GAIN;
use crate::diagnose::hypothesis::Walls;
use crate::experiment::file::{CalibrateTable, ExperimentFile, ParameterTable};
use mrbd_files::coefficients::CoefficientSets;
use mrbd_files::error::{InputError, Result};
use mrbd_files::suggestion::with_suggestion;
use mrbd_files::{toml_file, wall_from_table};
use mrbd_kernel::model::{ImpactLaw, Wall, WallParameters};
use mrbd_kernel::written;

/// Where a parameter stands in the wall.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// C_l, by its index from 0.
    Coefficient(usize),
    /// A number of the wall file, by the steps to it.
    Key(Vec<String>),
}

/// One variable of the search.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// `C_1` … or a dotted key.
    pub name: String,
    /// Where it stands.
    pub target: Target,
    /// β_0 and β_f.
    pub bounds: Bounds,
    /// Value in the wall file; 1 for C_l, which is what an impact without calibration has.
    pub nominal: f64,
    /// Standard deviation known beforehand, in the parameter's unit.
    pub prior_sd: Option<f64>,
}

impl Parameter {
    /// The index of its coefficient, if it is one.
    pub fn coefficient(&self) -> Option<usize> {
        match self.target {
            Target::Coefficient(l) => Some(l),
            Target::Key(_) => None,
        }
    }
}

/// Bounds of C_1 … C_8 where the user gives none.
const TABLE_2: &str = include_str!("../../../../inputs/coefficients.toml");

/// The variables of a search, and the wall they make.
#[derive(Debug, Clone)]
pub struct ParameterSpace {
    path: PathBuf,
    table: Table,
    base: WallParameters,
    /// The variables, in order.
    pub parameters: Vec<Parameter>,
    /// Where the bounds of C_l come from.
    pub bounds_source: String,
}

impl ParameterSpace {
    /// Resolves what an experiment calibrates.
    ///
    /// # Errors
    /// Input errors for a wall or a file of coefficients that cannot be read, and for a key that is no number of the
    /// wall file. Also for bounds that are missing, in the wrong order or impossible for the wall.
    pub fn load(experiment_path: &Path, experiment: &ExperimentFile) -> Result<Self> {
        let folder = experiment_path.parent().unwrap_or(Path::new(""));
        let path = folder.join(&experiment.wall);
        mrbd_files::load_wall(&path)?;
        let mut table: Table = toml_file::load(&path)?;
        let settings = &experiment.calibrate;
        override_law(&mut table, settings);
        let base = wall_from_table(&path, table.clone())?.parameters().clone();
        let sets = match &settings.coefficients {
            Some(file) => CoefficientSets::load(&folder.join(file))?,
            None => CoefficientSets::parse(Path::new("Table 2"), TABLE_2)?,
        };
        let resolver = Resolver { path: experiment_path, table: &table, experiment, sets: &sets };
        let parameters = resolver.parameters()?;
        let space = Self { path, table, base, parameters, bounds_source: sets.source };
        space.check_bounds(experiment_path)?;
        Ok(space)
    }

    /// β_0 and β_f of every variable.
    pub fn bounds(&self) -> Vec<Bounds> {
        self.parameters.iter().map(|p| p.bounds).collect()
    }

    /// The wall file's own values; 1 for C_l.
    pub fn nominal(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| p.nominal).collect()
    }

    /// The wall before calibration, C_l as in its file.
    pub fn base(&self) -> &WallParameters {
        &self.base
    }

    /// The wall with these values; C_l that are not calibrated stay as in the wall file.
    ///
    /// # Errors
    /// An input error if the values together make no possible wall.
    pub fn wall(&self, values: &[f64]) -> Result<Wall, InputError> {
        let only_coefficients = self.parameters.iter().all(|p| p.coefficient().is_some());
        if only_coefficients {
            let mut parameters = self.base.clone();
            for (parameter, &value) in self.parameters.iter().zip(values) {
                if let Some(l) = parameter.coefficient() {
                    parameters.restitution.coefficients[l] = value;
                }
            }
            return Wall::new(parameters).map_err(|e| InputError::key(&self.path, e.key, e.found, e.allowed));
        }
        wall_from_table(&self.path, self.table_with(values))
    }

    /// The table of the wall file with these values.
    pub fn table_with(&self, values: &[f64]) -> Table {
        let mut table = self.table.clone();
        let mut coefficients = self.base.restitution.coefficients;
        for (parameter, &value) in self.parameters.iter().zip(values) {
            match &parameter.target {
                Target::Coefficient(l) => coefficients[*l] = value,
                Target::Key(steps) => {
                    if let Some(place) = find_mut(&mut table, steps) {
                        *place = Value::Float(value);
                    }
                }
            }
        }
        let list = coefficients.iter().map(|c| Value::Float(*c)).collect();
        restitution(&mut table).insert("coefficients".into(), Value::Array(list));
        table
    }

    /// The same variables under another law and capture velocity.
    pub fn under(&self, law: ImpactLaw, capture_velocity_rad_s: f64) -> Self {
        let mut other = self.clone();
        other.base.restitution.law = law;
        other.base.restitution.capture_velocity_rad_s = capture_velocity_rad_s;
        let keys = restitution(&mut other.table);
        keys.insert("law".into(), Value::String(law.name().into()));
        keys.insert("capture_velocity_rad_s".into(), Value::Float(capture_velocity_rad_s));
        other
    }

    fn check_bounds(&self, experiment_path: &Path) -> Result<(), InputError> {
        for (i, parameter) in self.parameters.iter().enumerate() {
            for bound in [parameter.bounds.lower, parameter.bounds.upper] {
                let mut values = self.nominal();
                values[i] = bound;
                self.wall(&values).map_err(|e| {
                    let key = format!("calibrate.parameters: bounds of {}", parameter.name);
                    InputError::key(experiment_path, key, bound.to_string(), e.allowed)
                })?;
            }
        }
        Ok(())
    }
}

impl Walls for ParameterSpace {
    fn wall_of(&self, values: &[f64]) -> Option<Wall> {
        self.wall(values).ok()
    }
}

fn restitution(table: &mut Table) -> &mut Table {
    let entry = table.entry("restitution").or_insert_with(|| Value::Table(Table::new()));
    if !entry.is_table() {
        *entry = Value::Table(Table::new());
    }
    match entry {
        Value::Table(keys) => keys,
        _ => unreachable!("made a table above"),
    }
}

fn override_law(table: &mut Table, settings: &CalibrateTable) {
    if let Some(law) = settings.law {
        restitution(table).insert("law".into(), Value::String(law.name().into()));
    }
    if let Some(velocity) = settings.capture_velocity_rad_s {
        restitution(table).insert("capture_velocity_rad_s".into(), Value::Float(velocity));
    }
}

fn find_mut<'t>(table: &'t mut Table, steps: &[String]) -> Option<&'t mut Value> {
    let (first, rest) = steps.split_first()?;
    rest.iter().try_fold(table.get_mut(first)?, |value, step| match value {
        Value::Table(inner) => inner.get_mut(step),
        Value::Array(list) => list.get_mut(step.parse::<usize>().ok()?),
        _ => None,
    })
}

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
            let by_name = ["corner_widths", "restitution", SENSOR_GAIN].contains(&key.as_str());
            let known = by_name || self.resolve(key).is_some();
            // Absent from the file but with a default, such as an eccentricity of zero, is known exactly.
            if !known {
                let allowed = "a number that stands in the wall file, restitution, C_1 to C_8, corner_widths or sensor_gain";
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
