//! The three levels of a parameter, and what a façade becomes at them.

use crate::study::pipeline::Parameter;
use crate::survey::Assumptions;
use crate::survey::Facade;
use crate::survey::{Configuration, Survey};
use mrbd_files::coefficients::CoefficientSets;

/// One of the three levels of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// μ − σ of the survey, or the lower bounds β_0 of the coefficients.
    Low,
    /// μ of the survey, or the best fit of the coefficients.
    Mean,
    /// μ + σ of the survey, or the upper bounds β_f of the coefficients.
    High,
}

impl Level {
    /// All three, low to high.
    pub const ALL: [Level; 3] = [Level::Low, Level::Mean, Level::High];

    /// Position among the three.
    pub fn index(self) -> usize {
        self as usize
    }

    /// Name in result files; it says what the level is of this parameter.
    pub fn name(self, parameter: Parameter) -> &'static str {
        match (parameter, self) {
            (Parameter::Restitution, Level::Low) => "lower_bound",
            (Parameter::Restitution, Level::Mean) => "best_fit",
            (Parameter::Restitution, Level::High) => "upper_bound",
            (_, Level::Low) => "mu_minus_sigma",
            (_, Level::Mean) => "mu",
            (_, Level::High) => "mu_plus_sigma",
        }
    }

    /// The level of that name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "lower_bound" | "mu_minus_sigma" => Some(Level::Low),
            "best_fit" | "mu" => Some(Level::Mean),
            "upper_bound" | "mu_plus_sigma" => Some(Level::High),
            _ => None,
        }
    }
}

impl Parameter {
    /// All, in the order of the source's section 4.
    pub const ALL: [Parameter; 7] = [
        Parameter::Thickness,
        Parameter::CrackHeight,
        Parameter::Strength,
        Parameter::Stiffness,
        Parameter::DiaphragmMass,
        Parameter::CarriageMass,
        Parameter::Restitution,
    ];

    /// Name in input and result files.
    pub fn name(self) -> &'static str {
        match self {
            Parameter::Thickness => "thickness",
            Parameter::CrackHeight => "crack_height",
            Parameter::Strength => "strength",
            Parameter::Stiffness => "stiffness",
            Parameter::DiaphragmMass => "diaphragm_mass",
            Parameter::CarriageMass => "carriage_mass",
            Parameter::Restitution => "restitution",
        }
    }

    /// The parameter of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|parameter| parameter.name() == name)
    }

    /// The source's symbol and the unit of [`Parameter::value`].
    pub fn symbol(self) -> (&'static str, &'static str) {
        match self {
            Parameter::Thickness => ("b", "m"),
            Parameter::CrackHeight => ("h1/h_tot", ""),
            Parameter::Strength => ("f", "Pa"),
            Parameter::Stiffness => ("k_d", "N/m"),
            Parameter::DiaphragmMass => ("m_d/m_tot", ""),
            Parameter::CarriageMass => ("m_dp/m_tot", ""),
            Parameter::Restitution => ("C_l", ""),
        }
    }

    /// Its value in a façade, in SI units; none for the coefficients, which are eight.
    pub fn value(self, facade: &Facade) -> Option<f64> {
        match self {
            Parameter::Thickness => Some(facade.thickness_m),
            Parameter::CrackHeight => Some(facade.crack_height_ratio),
            Parameter::Strength => Some(facade.compressive_strength_pa),
            Parameter::Stiffness => Some(facade.stiffness_n_per_m),
            Parameter::DiaphragmMass => Some(facade.diaphragm_mass_ratio),
            Parameter::CarriageMass => Some(facade.carriage_mass_ratio),
            Parameter::Restitution => None,
        }
    }
}

/// The façade of a configuration with one parameter off its mean (the source's section 4.2).
pub fn facade(
    survey: &Survey,
    configuration: Configuration,
    (parameter, level): (Parameter, Level),
    slenderness: f64,
    assumptions: &Assumptions,
) -> Facade {
    let floor = survey.floor(configuration);
    let at = |this: Parameter, levels: [f64; 3]| {
        levels[if this == parameter { level.index() } else { Level::Mean.index() }]
    };
    Facade {
        thickness_m: at(Parameter::Thickness, survey.wall.thickness_m),
        slenderness,
        crack_height_ratio: at(Parameter::CrackHeight, survey.wall.crack_height_ratio),
        compressive_strength_pa: at(Parameter::Strength, survey.wall.compressive_strength_pa),
        stiffness_n_per_m: at(Parameter::Stiffness, floor.stiffness_n_per_m),
        diaphragm_mass_ratio: at(Parameter::DiaphragmMass, floor.diaphragm_mass_ratio),
        carriage_mass_ratio: at(Parameter::CarriageMass, floor.carriage_mass_ratio),
        length_m: assumptions.length_m,
        density_kg_m3: assumptions.density_kg_m3,
    }
}

/// The coefficients C_l that go with it: best fit, unless they are the parameter.
pub fn coefficients(sets: &CoefficientSets, parameter: Parameter, level: Level) -> [f64; 8] {
    match (parameter, level) {
        (Parameter::Restitution, Level::Low) => sets.lower,
        (Parameter::Restitution, Level::High) => sets.upper,
        _ => sets.best_fit,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_names_lead_back_to_levels_and_parameters() {
        for parameter in Parameter::ALL {
            assert_eq!(Parameter::named(parameter.name()), Some(parameter));
            for level in Level::ALL {
                assert_eq!(Level::named(level.name(parameter)), Some(level));
            }
        }
        assert_eq!(Parameter::named("phase_of_the_moon"), None);
        assert_eq!(Level::named(""), None);
    }
}
