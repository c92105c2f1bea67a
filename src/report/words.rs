//! Numbers and names as people read them.

use crate::study::pipeline::Parameter;
use crate::study::plan::Level;
use crate::survey::Configuration;

/// A number beside an axis: as few digits as tell it.
pub fn tick(value: f64) -> String {
    let text = format!("{value:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text.strip_prefix('-') {
        Some("0") => "0".to_owned(),
        Some(digits) => format!("−{digits}"),
        None => text.to_owned(),
    }
}

/// The least of 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that is not below a positive value.
pub fn rounded_up(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    let steps = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0];
    let fits = |step: &&f64| **step * power >= value * (1.0 - 1e-9);
    steps.iter().find(fits).unwrap_or(&10.0) * power
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_ticks_have_no_idle_digits() {
        assert_eq!([0.0, 0.05, 8.0, -0.00001, -1.25].map(tick), ["0", "0.05", "8", "0", "−1.25"]);
    }

    #[test]
    fn analytic_rounding_up_is_least_and_not_below() {
        for (value, round) in
            [(0.222, 0.25), (0.25, 0.25), (0.81, 1.0), (1.0, 1.0), (37.0, 40.0), (0.003, 0.003)]
        {
            assert!((rounded_up(value) / round - 1.0).abs() < 1e-12, "{value}");
        }
    }
}
