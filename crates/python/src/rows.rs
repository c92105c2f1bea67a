//! Walls as rows of a table, under the names of result files: as many as a study draws, without an object for each.

use arrow_array::cast::AsArray;
use arrow_array::types::Float64Type;
use arrow_array::{Array, ArrayRef, Float64Array, StringArray};
use arrow_schema::DataType;
use mrbd::study::runs::COLUMNS;
use mrbd_files::suggestion::with_suggestion;
use mrbd_kernel::model::{Effect, ImpactLaw, Restitution, Wall, WallParameters};
use pyo3::prelude::*;
use pyo3_arrow::PyTable;

use crate::errors::{Error, argument};

/// Numbers that a row may have; a column that is not there has the value of a wall file without its key.
const NUMBERS: [&str; 24] = [
    "thickness_m",
    "height_m",
    "length_m",
    "crack_height_m",
    "mass_kg",
    "density_kg_m3",
    "lower_width_m",
    "upper_width_m",
    "diaphragm_mass_kg",
    "carriage_mass_kg",
    "stiffness_n_per_m",
    "eccentricity_m",
    "restitution_c1",
    "restitution_c2",
    "restitution_c3",
    "restitution_c4",
    "restitution_c5",
    "restitution_c6",
    "restitution_c7",
    "restitution_c8",
    "capture_velocity_rad_s",
    "collapse_rotation_ratio",
    "initial_theta1_rad",
    "initial_theta2_rad",
];
/// Position of C_1 among them.
const C_1: usize = 12;
/// Numbers without which there is no wall.
const NEEDED: usize = 3;

/// A table whose rows are walls.
pub struct Rows {
    len: usize,
    /// One a name of [`NUMBERS`].
    numbers: Vec<Option<Float64Array>>,
    law: Option<StringArray>,
    effects: Option<StringArray>,
}

impl Rows {
    /// Reads and checks the columns of a table.
    ///
    /// # Errors
    /// Input errors for a column that is missing, unknown or of another type.
    pub fn of(table: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (batches, schema) = table.extract::<PyTable>()?.into_inner();
        let names: Vec<&str> = schema.fields().iter().map(|field| field.name().as_str()).collect();
        check(&names)?;
        let joined = |name: &str| -> PyResult<Option<ArrayRef>> {
            if !names.contains(&name) {
                return Ok(None);
            }
            let arrays: Vec<&dyn Array> =
                batches.iter().filter_map(|batch| batch.column_by_name(name)).map(AsRef::as_ref).collect();
            arrow_select::concat::concat(&arrays).map(Some).map_err(|e| Error::new_err(e.to_string()))
        };
        let number = |name: &&str| joined(name)?.map(|array| numbers(name, &array)).transpose();
        let text = |name: &str| joined(name)?.map(|array| texts(name, &array)).transpose();
        Ok(Self {
            len: batches.iter().map(|batch| batch.num_rows()).sum(),
            numbers: NUMBERS.iter().map(number).collect::<PyResult<_>>()?,
            law: text("law")?,
            effects: text("effects")?,
        })
    }

    /// Rows.
    pub fn len(&self) -> usize {
        self.len
    }

    /// The wall of a row, or why there is none.
    pub fn wall(&self, row: usize) -> Result<Wall, String> {
        let given = |name: &str| {
            let index = NUMBERS.iter().position(|known| *known == name)?;
            self.numbers[index].as_ref().filter(|array| array.is_valid(row)).map(|array| array.value(row))
        };
        let needed = |name: &str| given(name).ok_or_else(|| format!("no {name}"));
        let or_zero = |name: &str| given(name).unwrap_or(0.0);
        let (thickness_m, height_m, length_m) =
            (needed("thickness_m")?, needed("height_m")?, needed("length_m")?);
        let by_density =
            || needed("density_kg_m3").map(|density| density * thickness_m * height_m * length_m);
        let default = Restitution::default();
        let coefficient = |l: usize| given(NUMBERS[C_1 + l]).unwrap_or(default.coefficients[l]);
        let parameters = WallParameters {
            thickness_m,
            height_m,
            crack_height_m: given("crack_height_m"),
            length_m,
            mass_kg: given("mass_kg").map_or_else(by_density, Ok)?,
            lower_width_m: given("lower_width_m").unwrap_or(thickness_m),
            upper_width_m: given("upper_width_m").unwrap_or(thickness_m),
            diaphragm_mass_kg: or_zero("diaphragm_mass_kg"),
            carriage_mass_kg: or_zero("carriage_mass_kg"),
            stiffness_n_per_m: or_zero("stiffness_n_per_m"),
            eccentricity_m: or_zero("eccentricity_m"),
            restitution: Restitution {
                coefficients: std::array::from_fn(coefficient),
                law: self.law(row)?.unwrap_or(default.law),
                capture_velocity_rad_s: given("capture_velocity_rad_s")
                    .unwrap_or(default.capture_velocity_rad_s),
            },
            collapse_rotation_ratio: given("collapse_rotation_ratio")
                .unwrap_or(WallParameters::DEFAULT_COLLAPSE_RATIO),
            initial_rotation_rad: [or_zero("initial_theta1_rad"), or_zero("initial_theta2_rad")],
            effects: self.effects(row)?,
            // A formula is a text of its own, no number of a row: walls of files have them.
            formulas: Vec::new(),
        };
        Wall::new(parameters).map_err(|e| e.to_string())
    }

    fn law(&self, row: usize) -> Result<Option<ImpactLaw>, String> {
        let Some(law) = text(&self.law, row) else { return Ok(None) };
        serde_json::from_value(law.into()).map(Some).map_err(|e| e.to_string())
    }

    fn effects(&self, row: usize) -> Result<Vec<Effect>, String> {
        let Some(effects) = text(&self.effects, row) else { return Ok(Vec::new()) };
        serde_json::from_str(effects).map_err(|e| e.to_string())
    }
}

fn text(column: &Option<StringArray>, row: usize) -> Option<&str> {
    column.as_ref().filter(|texts| texts.is_valid(row)).map(|texts| texts.value(row))
}

/// Names of a wall, and those of result files, which tables of runs have too.
fn check(names: &[&str]) -> PyResult<()> {
    let mut known = NUMBERS.to_vec();
    known.extend(["law", "effects"]);
    let column = |name: &str| COLUMNS.iter().any(|column| column.name == name);
    if let Some(unknown) = names.iter().find(|name| !known.contains(name) && !column(name)) {
        let allowed =
            with_suggestion("columns of walls or of result files".into(), unknown, known.iter().copied());
        return Err(argument("simulate_many", "walls", format!("a column {unknown:?}"), allowed));
    }
    match NUMBERS[..NEEDED].iter().find(|name| !names.contains(name)) {
        Some(missing) => {
            Err(argument("simulate_many", "walls", "a table", format!("a table with a column {missing}")))
        }
        None => Ok(()),
    }
}

fn numbers(name: &str, array: &ArrayRef) -> PyResult<Float64Array> {
    let kind = array.data_type();
    // A cast would read numbers off texts, and take a text that is none for a missing number.
    match arrow_cast::cast(array, &DataType::Float64) {
        Ok(array) if kind.is_numeric() || kind.is_null() => Ok(array.as_primitive::<Float64Type>().clone()),
        _ => Err(argument("simulate_many", name, kind.to_string(), "numbers")),
    }
}

fn texts(name: &str, array: &ArrayRef) -> PyResult<StringArray> {
    match arrow_cast::cast(array, &DataType::Utf8) {
        Ok(array) => Ok(array.as_string::<i32>().clone()),
        Err(_) => Err(argument("simulate_many", name, array.data_type().to_string(), "texts")),
    }
}
