//! Numbers and names as people read them.

use crate::study::pipeline::Parameter;
use crate::study::plan::Level;
use crate::survey::Configuration;

/// The floor of a configuration, to begin a title with.
pub fn floor(configuration: Configuration) -> &'static str {
    match configuration {
        Configuration::Perpendicular => "Floor perpendicular to the façade",
        Configuration::Parallel => "Floor parallel to the façade",
    }
}

/// A parameter in words.
pub fn parameter(parameter: Parameter) -> &'static str {
    match parameter {
        Parameter::Thickness => "thickness of the façade b",
        Parameter::CrackHeight => "height of the crack h₁/h",
        Parameter::Strength => "compressive strength f",
        Parameter::Stiffness => "stiffness of the floor k_d",
        Parameter::DiaphragmMass => "mass of the floor m_d/m_tot",
        Parameter::CarriageMass => "horizontal mass of the floor m_dp/m_tot",
        Parameter::Restitution => "coefficients of restitution C_l",
    }
}

/// A level with its value in the units of the paper.
pub fn level(parameter: Parameter, level: Level, value: Option<f64>) -> String {
    let name = match (parameter, level) {
        (Parameter::Restitution, Level::Low) => "lower bounds",
        (Parameter::Restitution, Level::Mean) => "best fit",
        (Parameter::Restitution, Level::High) => "upper bounds",
        (_, Level::Low) => "μ − σ",
        (_, Level::Mean) => "μ",
        (_, Level::High) => "μ + σ",
    };
    let Some(value) = value else { return name.to_owned() };
    let value = match parameter {
        Parameter::Thickness => format!("{value:.2} m"),
        Parameter::Strength => format!("{:.2} MPa", value / 1e6),
        Parameter::Stiffness => format!("{:.0} kN/m", value / 1e3),
        _ => format!("{value:.2}"),
    };
    format!("{name}: {value}")
}

/// A measure of intensity with its unit, by the name of its column.
pub fn intensity(column: &str) -> String {
    let name = match column {
        "pga_m_s2" => "PGA m/s²",
        "pga_g" => "PGA g",
        "pgv_m_s" => "PGV m/s",
        "pgd_m" => "PGD m",
        "arias_m_s" => "Arias intensity m/s",
        "cav_m_s" => "CAV m/s",
        "sa_0p5s_m_s2" => "Sa(0.5 s) m/s²",
        "sa_1p0s_m_s2" => "Sa(1.0 s) m/s²",
        "sa_average_m_s2" => "average Sa m/s²",
        "duration_5_95_s" => "duration 5–95 % s",
        other => other,
    };
    name.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_records::ScaledMeasure;

    #[test]
    fn regress_every_measure_has_a_name_and_a_unit() {
        use ScaledMeasure as M;
        let all = [
            M::PgaMS2,
            M::PgaG,
            M::Pgv,
            M::Pgd,
            M::Arias,
            M::Cav,
            M::SaHalfSecond,
            M::SaOneSecond,
            M::SaAverage,
        ];
        for measure in all {
            let name = intensity(measure.name());
            assert!(name.contains(' ') && !name.contains('_'), "{name}");
        }
    }
}
