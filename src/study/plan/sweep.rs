//! The one-at-a-time sweep of the source's section 4.2: configuration and parameter vary slowest, then the level, and
//! fastest the slenderness.

use super::id::Fingerprint;
use super::level::{Level, coefficients, facade};
use super::run::{Origin, Scaling};
use super::setting::Setting;
use crate::study::pipeline::{Parameter, SweepTable};
use crate::survey::Assumptions;
use crate::survey::{Configuration, Survey};
use mrbd_files::coefficients::CoefficientSets;

/// The settings of a sweep.
#[derive(Debug, Clone)]
pub(super) struct Sweep {
    survey: Survey,
    sets: CoefficientSets,
    /// The reference cases: each configuration with each of its parameters.
    cases: Vec<(Configuration, Parameter)>,
    slenderness: Vec<f64>,
}

impl Sweep {
    pub fn new(table: &SweepTable, survey: Survey, sets: CoefficientSets) -> Self {
        let cases = Configuration::ALL
            .into_iter()
            .flat_map(|c| table.parameters(c).iter().map(move |&parameter| (c, parameter)))
            .collect();
        Self { survey, sets, cases, slenderness: table.slenderness.clone() }
    }

    /// Number of settings.
    pub fn len(&self) -> u64 {
        (self.cases.len() * Level::ALL.len() * self.slenderness.len()) as u64
    }

    /// The setting at a position below [`Sweep::len`].
    pub fn at(&self, position: u64, assumptions: &Assumptions) -> Setting {
        let position = position as usize;
        let slenderness = self.slenderness[position % self.slenderness.len()];
        let rest = position / self.slenderness.len();
        let level = Level::ALL[rest % Level::ALL.len()];
        let (configuration, parameter) = self.cases[rest / Level::ALL.len()];
        Setting {
            configuration,
            origin: Origin::Level(parameter, level),
            facade: facade(&self.survey, configuration, (parameter, level), slenderness, assumptions),
            coefficients: coefficients(&self.sets, parameter, level),
            scaling: Scaling::Factor(1.0),
        }
    }

    /// For messages: where a setting stands.
    pub fn place(setting: &Setting) -> String {
        let Origin::Level(parameter, level) = setting.origin else { return String::new() };
        format!(
            "{} floor, {} at {}, slenderness {}",
            setting.configuration.name(),
            parameter.name(),
            level.name(parameter),
            setting.facade.slenderness
        )
    }

    /// Adds what decides the list to a hash, which the ids of its runs do.
    pub fn hashed(hash: Fingerprint, ids: impl Iterator<Item = String>) -> Fingerprint {
        ids.fold(hash, |hash, id| hash.text("run", &id))
    }
}
