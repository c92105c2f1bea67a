//! What a kind of study says of a run: everything but the record and the assumptions.
//!
//! The one-at-a-time sweep is the source's section 4.2. In it configuration and parameter vary slowest, then the level, and
//! fastest the slenderness.
//!
//! Of façades drawn from the survey the configuration varies slowest, then the intensity or the limit, and fastest the
//! draw. Both configurations, all intensities and all variants have the same draws, so that what differs between them is
//! not chance. A façade that no wall is stays in the list, and fails. In a study of variance the matrix stands in the
//! place of the intensity, see `pick_freeze.rs`.

use std::path::Path;

use super::fingerprint::Fingerprint;
use super::level::{Level, coefficients, facade};
use super::pick_freeze::PickFreeze;
use super::run::{Growth, Origin, Scaling};
use crate::error::{InputError, Result};
use crate::study::pipeline::{Drawn, Loading, Parameter, Pipeline, SweepTable};
use crate::survey::sampling::{FacadeSampler, Refused, Variable};
use crate::survey::{Assumptions, Configuration, Facade, Survey};
use mrbd_files::coefficients::CoefficientSets;
use mrbd_kernel::model::{Effect, ImpactLaw};
use mrbd_records::{Suite, SuiteRecord};

/// A façade and how it is shaken.
pub(super) struct Setting {
    pub configuration: Configuration,
    pub origin: Origin,
    pub facade: Facade,
    /// C_l.
    pub coefficients: [f64; 8],
    pub scaling: Scaling,
    pub assumed: Assumed,
}

/// What may be assumed otherwise from run to run.
pub(super) struct Assumed {
    /// What the C_l scale.
    pub law: ImpactLaw,
    /// What lies in both joints; `None` for sharp edges.
    pub bed: Option<Effect>,
    /// Number in the ensemble; 0 is the run as planned.
    pub member: usize,
}

impl Assumed {
    /// As all runs of a variant have it.
    fn by(assumptions: &Assumptions) -> Self {
        // Values beyond those of the effect were refused on reading.
        let bed = assumptions.bed.and_then(|bed| bed.effect().ok().flatten());
        Self { law: assumptions.law, bed, member: 0 }
    }
}

impl Setting {
    /// The factor on a record of the suite, at first.
    pub fn factor(&self, record: &SuiteRecord) -> f64 {
        match self.scaling {
            Scaling::Factor(factor) => factor,
            Scaling::To(measure, value) => measure.factor_to(&record.intensity, value),
            Scaling::Growing(growth) => growth.measure.factor_to(&record.intensity, growth.range[0]),
        }
    }
}

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
            assumed: Assumed::by(assumptions),
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

/// The settings of a study of drawn façades.
#[derive(Debug, Clone)]
pub(super) struct DrawnFacades {
    samplers: Vec<(Configuration, FacadeSampler)>,
    coefficients: [f64; 8],
    drawn: Drawn,
    /// The points of a study of variance.
    pick_freeze: Option<PickFreeze>,
}

impl DrawnFacades {
    /// Settings of a pipeline's study.
    ///
    /// # Errors
    /// Input errors for distributions, truncations or correlations that cannot be, and for records that cannot be scaled.
    pub fn new(
        pipeline: &Pipeline,
        drawn: &Drawn,
        survey: &Survey,
        sets: &CoefficientSets,
        suite: &Suite,
    ) -> Result<Self> {
        let sampler = |&configuration: &Configuration| {
            let sampler = FacadeSampler::new(survey, configuration, &drawn.sampling);
            Ok((configuration, sampler.map_err(|refused| placed(refused, pipeline))?))
        };
        let samplers = drawn.configurations.iter().map(sampler).collect::<Result<_>>()?;
        check_scalable(&pipeline.path, &drawn.loading, suite)?;
        let pick_freeze = match &drawn.loading {
            Loading::Variance(variance) => {
                let members = pipeline.variants.len() - 1;
                let points = PickFreeze::new(variance, &drawn.sampling, sets, members);
                Some(points.map_err(|refused| placed(refused, pipeline))?)
            }
            _ => None,
        };
        Ok(Self { samplers, coefficients: sets.best_fit, drawn: drawn.clone(), pick_freeze })
    }

    /// Number of settings.
    pub fn len(&self) -> u64 {
        self.drawn.runs_per_draw() as u64 * self.drawn.sampling.count
    }

    /// The setting at a position below [`DrawnFacades::len`], under the record at `record_index` of the suite.
    pub fn at(&self, position: u64, record_index: usize, assumptions: &Assumptions) -> Setting {
        let count = self.drawn.sampling.count;
        let (draw, rest) = (position % count, (position / count) as usize);
        let (configuration, sampler) = &self.samplers[rest / self.drawn.loading.strata()];
        let stratum = rest % self.drawn.loading.strata();
        if let Some(points) = &self.pick_freeze {
            return points.at((draw, stratum), (*configuration, sampler), assumptions);
        }
        Setting {
            configuration: *configuration,
            origin: Origin::Draw(draw),
            facade: sampler.facade(draw, assumptions),
            coefficients: self.coefficients,
            scaling: self.scaling(stratum, || sampler.further(draw, record_index)),
            assumed: Assumed::by(assumptions),
        }
    }

    /// Probability that truncations took from each variable, by configuration: those above 0.
    pub fn truncated(&self) -> Vec<(Configuration, Variable, f64)> {
        let of = |(configuration, sampler): &(Configuration, FacadeSampler)| {
            let cut = Variable::ALL
                .map(|variable| (*configuration, variable, sampler.marginal(variable).cut_probability()));
            cut.into_iter().filter(|(_, _, probability)| *probability > 0.0).collect::<Vec<_>>()
        };
        self.samplers.iter().flat_map(of).collect()
    }

    /// Adds what decides the list to a hash: what is asked for, and the first draws that came of it.
    pub fn hashed(&self, hash: Fingerprint, ids: impl Iterator<Item = String>) -> Fingerprint {
        // Numbers and texts always serialise.
        let asked = serde_json::to_string(&self.drawn).unwrap_or_default();
        let hash = hash.text("drawn", &asked).numbers("coefficients", &self.coefficients);
        let hash = match &self.pick_freeze {
            Some(points) => hash.text("points", &points.hashed()),
            None => hash,
        };
        let hash = self.samplers.iter().fold(hash, |hash, (configuration, sampler)| {
            let distributions = Variable::ALL.map(|variable| sampler.marginal(variable));
            hash.text(configuration.name(), &format!("{distributions:?}"))
        });
        ids.fold(hash, |hash, id| hash.text("run", &id))
    }

    /// What was asked for.
    pub fn drawn(&self) -> &Drawn {
        &self.drawn
    }

    fn scaling(&self, stratum: usize, uniform: impl Fn() -> f64) -> Scaling {
        match &self.drawn.loading {
            Loading::OwnScale | Loading::Variance(_) => Scaling::Factor(1.0),
            Loading::Cloud(cloud) => {
                let [from, to] = [cloud.from, cloud.to].map(f64::ln);
                Scaling::Factor((from + (to - from) * uniform()).exp())
            }
            Loading::Stripes(stripes) => Scaling::To(stripes.measure, stripes.levels[stratum]),
            Loading::Incremental(of) => Scaling::Growing(Growth {
                limit: of.limits[stratum],
                measure: of.measure,
                range: [of.from, of.to],
                growth: of.growth,
                bracket: of.bracket,
            }),
        }
    }
}

/// A fault of the sampling where it stands: in the pipeline or in the survey.
fn placed(refused: Refused, pipeline: &Pipeline) -> InputError {
    match refused.key.starts_with("sampling.") || refused.key.starts_with("variance.") {
        true => refused.at(&pipeline.path),
        false => refused.at(&pipeline.survey),
    }
}

/// A record without motion has no factor to an intensity.
fn check_scalable(path: &Path, loading: &Loading, suite: &Suite) -> Result<()> {
    let (key, measure) = match loading {
        Loading::OwnScale | Loading::Cloud(_) | Loading::Variance(_) => return Ok(()),
        Loading::Stripes(stripes) => ("stripes.measure", stripes.measure),
        Loading::Incremental(incremental) => ("incremental.measure", incremental.measure),
    };
    let still = |record: &&SuiteRecord| {
        let value = measure.of(&record.intensity);
        !(value.is_finite() && value > 0.0)
    };
    match suite.records.iter().find(still) {
        None => Ok(()),
        Some(record) => {
            let found = format!("{} of record {:?}, which is not above 0", measure.name(), record.name);
            Err(InputError::key(path, key, found, "records that can be scaled to an intensity").into())
        }
    }
}
