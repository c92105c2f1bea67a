//! What is calibrated, and the wall that values of it make.

use std::path::{Path, PathBuf};

use toml::{Table, Value};

use super::parameter::{Parameter, Target};
use super::resolver::Resolver;
use super::search::Bounds;
use crate::experiment::file::{CalibrateTable, ExperimentFile};
use mrbd_files::coefficients::CoefficientSets;
use mrbd_files::error::{InputError, Result};
use mrbd_files::{toml_file, wall_from_table};
use mrbd_kernel::model::{ImpactLaw, Wall, WallParameters};

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
    /// Input errors for a wall or a file of coefficients that cannot be read, a key that is no number of the wall
    /// file, bounds that are missing, in the wrong order or impossible for the wall.
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
