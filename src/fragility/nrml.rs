//! Fragilities as OpenQuake reads them: a `fragilityModel` of NRML 0.5 with log-normal functions.
//!
//! OpenQuake takes the mean m and standard deviation s of the intensity of failure itself, not of its logarithm, and
//! turns them back by σ² = ln(1 + s²/m²) and median = m²/√(m² + s²). It samples the curve between minIML and maxIML and
//! takes the probability as 0 below noDamageLimit, so these stand where the probability is 0.1 % and 99.9 %.

use std::fmt::Write;

use super::method::LogNormal;
use crate::text::escaped;

/// Probability at minIML and noDamageLimit; one minus it at maxIML.
const TAIL: f64 = 1e-3;

/// An intensity measure of OpenQuake, and what brings the intensities to its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct IntensityMeasure {
    name: String,
    factor: f64,
}

/// Why a name and factor are no intensity measure.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NotAMeasure {
    /// OpenQuake does not know the name.
    #[error("{0:?}; allowed: PGA, PGV, PGD, or SA(T) with T in seconds above 0")]
    Name(String),
    /// The unit of the intensity cannot be told.
    #[error(
        "no factor to {unit}, the unit of {name} in OpenQuake, for {intensity}; allowed: a column whose name ends in \
         {endings}, or --imt-factor"
    )]
    Unit {
        /// The measure.
        name: String,
        /// Its unit.
        unit: &'static str,
        /// What the intensity is.
        intensity: String,
        /// Endings of names that tell a unit of it.
        endings: String,
    },
}

/// Endings of column names that tell a unit, and the factor from it.
type Endings = &'static [(&'static str, f64)];

const ACCELERATIONS: (&str, Endings) =
    ("g", &[("_g", 1.0), ("_m_s2", 1.0 / 9.80665), ("_cm_s2", 1.0 / 980.665)]);
const VELOCITIES: (&str, Endings) = ("cm/s", &[("_cm_s", 1.0), ("_m_s", 100.0)]);
const DISPLACEMENTS: (&str, Endings) = ("cm", &[("_cm", 1.0), ("_m", 100.0)]);

impl IntensityMeasure {
    /// The measure `name`; without a `factor` the unit is told by the ending of the column's name.
    ///
    /// # Errors
    /// [`NotAMeasure`].
    pub fn new(name: &str, factor: Option<f64>, column: Option<&str>) -> Result<Self, NotAMeasure> {
        let (unit, endings) = unit_of(name).ok_or_else(|| NotAMeasure::Name(name.to_owned()))?;
        let told = || column.and_then(|column| endings.iter().find(|(end, _)| column.ends_with(end)));
        let factor = factor.or_else(|| told().map(|(_, factor)| *factor));
        let endings: Vec<&str> = endings.iter().map(|(end, _)| *end).collect();
        let unknown = || NotAMeasure::Unit {
            name: name.to_owned(),
            unit,
            intensity: column.map_or("an expression".to_owned(), |column| format!("column {column:?}")),
            endings: endings.join(", "),
        };
        Ok(Self { name: name.to_owned(), factor: factor.ok_or_else(unknown)? })
    }
}

/// OpenQuake's unit of a measure, and the endings that tell units of its kind.
fn unit_of(name: &str) -> Option<(&'static str, Endings)> {
    match name {
        "PGA" => Some(ACCELERATIONS),
        "PGV" => Some(VELOCITIES),
        "PGD" => Some(DISPLACEMENTS),
        other => {
            let period = other.strip_prefix("SA(")?.strip_suffix(')')?;
            let period: f64 = period.parse().ok()?;
            (period.is_finite() && period > 0.0).then_some(ACCELERATIONS)
        }
    }
}

/// The document: functions by their ids, each with one curve a limit state. `note` is what else is to be said of them.
pub fn document(
    measure: &IntensityMeasure,
    limit_states: &[String],
    functions: &[(String, Vec<LogNormal>)],
    note: Option<&str>,
) -> String {
    let mut text = String::from(concat!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n",
        "<nrml xmlns=\"http://openquake.org/xmlns/nrml/0.5\">\n",
        "  <fragilityModel id=\"mrbd\" assetCategory=\"buildings\" lossCategory=\"structural\">\n",
    ));
    let limit_states: Vec<String> = limit_states.iter().map(|state| escaped(state).into_owned()).collect();
    let note = note.map_or(String::new(), |note| format!("; {}", escaped(note)));
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "    <description>Log-normal fragility functions of rocking walls{note}</description>"
    );
    let _ = writeln!(text, "    <limitStates>{}</limitStates>", limit_states.join(" "));
    for (id, curves) in functions {
        let _ = write!(text, "{}", function(measure, &limit_states, id, curves));
    }
    text + "  </fragilityModel>\n</nrml>\n"
}

fn function(measure: &IntensityMeasure, limit_states: &[String], id: &str, curves: &[LogNormal]) -> String {
    let IntensityMeasure { name, factor } = measure;
    // The limits hold for all curves of a function.
    let low = curves.iter().map(|curve| factor * curve.intensity_at(TAIL)).fold(f64::INFINITY, f64::min);
    let high = curves.iter().map(|curve| factor * curve.intensity_at(1.0 - TAIL)).fold(0.0, f64::max);
    let params = limit_states.iter().zip(curves).map(|(state, curve)| {
        let (mean, stddev) = (factor * curve.mean(), factor * curve.standard_deviation());
        format!("      <params ls=\"{state}\" mean=\"{mean:.9e}\" stddev=\"{stddev:.9e}\"/>\n")
    });
    format!(
        "    <fragilityFunction id=\"{id}\" format=\"continuous\" shape=\"logncdf\">\n\
         \x20     <imls imt=\"{name}\" noDamageLimit=\"{low:.9e}\" minIML=\"{low:.9e}\" maxIML=\"{high:.9e}\"/>\n\
         {params}    </fragilityFunction>\n",
        id = escaped(id),
        params = params.collect::<String>(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_layout_and_back_by_the_rule_of_openquake() {
        let curve = LogNormal::new(0.25f64.ln(), 0.4).expect("valid");
        let measure = IntensityMeasure::new("PGV", None, Some("pgv_m_s")).expect("known");
        let text =
            document(&measure, &["collapse".into()], &[("floor=\"parallel\"".into(), vec![curve])], None);
        let order = [
            "<nrml xmlns=\"http://openquake.org/xmlns/nrml/0.5\">",
            "<fragilityModel id=\"mrbd\" assetCategory=\"buildings\" lossCategory=\"structural\">",
            "<description>",
            "<limitStates>collapse</limitStates>",
            "<fragilityFunction id=\"floor=&quot;parallel&quot;\" format=\"continuous\" shape=\"logncdf\">",
            "<imls imt=\"PGV\" noDamageLimit=",
            "<params ls=\"collapse\" mean=",
        ];
        let places: Vec<usize> = order.iter().map(|part| text.find(part).expect(part)).collect();
        assert!(places.is_sorted(), "{text}");
        let value = |key: &str| -> f64 {
            let after = text.split_once(&format!("{key}=\"")).expect(key).1;
            after.split('"').next().expect("a value").parse().expect("a number")
        };
        let (m, s) = (value("mean"), value("stddev"));
        // Ten digits are printed; the square root of a small difference loses one.
        assert!((m * m / (m * m + s * s).sqrt() / 25.0 - 1.0).abs() < 1e-8, "cm/s: {text}");
        assert!(((1.0 + s * s / (m * m)).ln().sqrt() - 0.4).abs() < 1e-8, "{text}");
        let at = |x: f64| curve.probability_at_ln((x / 100.0).ln());
        assert!(
            (at(value("minIML")) - TAIL).abs() < 1e-10 && (at(value("maxIML")) + TAIL - 1.0).abs() < 1e-10
        );
    }

    #[test]
    fn rejects_measures_and_units_that_cannot_be_told() {
        let measure = |name: &str, column| IntensityMeasure::new(name, None, column);
        assert!(measure("SA", Some("x_g")).is_err());
        assert!(measure("SA(0)", Some("x_g")).is_err());
        assert!(measure("SA(0.3)", Some("sa_g")).is_ok());
        let refused = measure("PGV", Some("pgv")).expect_err("no unit").to_string();
        assert!(refused.contains("cm/s") && refused.contains("_m_s") && refused.contains("--imt-factor"));
        assert!(measure("PGA", None).is_err());
        assert!(IntensityMeasure::new("PGA", Some(1.0), None).is_ok());
    }
}
