//! The one-at-a-time sweep of the source's section 4.2 as a list of runs.
//!
//! The record varies slowest, so that the runs of a record stand together and end in one file; then variant,
//! configuration and parameter, level, and fastest the slenderness.

use std::path::Path;
use std::sync::Arc;

use super::facade::ImpossibleFacade;
use super::id::Fingerprint;
use super::level::{Level, coefficients, facade};
use super::run::{Motions, Run};
use crate::error::{InputError, Result};
use crate::ground::Suite;
use crate::input::coefficients::CoefficientSets;
use crate::input::pipeline::{Parameter, Pipeline, Variant};
use crate::input::survey::{Configuration, Survey};
use crate::model::Restitution;

/// A list of runs, every one of which is a wall that can exist.
#[derive(Debug, Clone)]
pub struct Plan {
    name: String,
    survey: Survey,
    sets: CoefficientSets,
    motions: Arc<Motions>,
    variants: Vec<Arc<Variant>>,
    /// The reference cases: each configuration with each of its parameters.
    cases: Vec<(Configuration, Parameter)>,
    slenderness: Vec<f64>,
}

/// Where a run stands in the sweep, as positions in its lists.
struct Cell {
    record: usize,
    variant: usize,
    case: usize,
    level: Level,
    slenderness: usize,
}

impl Plan {
    /// Reads what the pipeline names and checks every façade; `suite` replaces the pipeline's own.
    ///
    /// # Errors
    /// Input errors of the files, and of façades that cannot exist.
    pub fn load(pipeline: &Pipeline, suite: Option<&Path>) -> Result<Self> {
        let survey = Survey::load(&pipeline.survey)?;
        let sets = CoefficientSets::load(&pipeline.coefficients)?;
        let suite = Suite::load(suite.unwrap_or(&pipeline.suite))?;
        Self::new(pipeline, survey, sets, suite)
    }

    /// A plan of what was read.
    ///
    /// # Errors
    /// Input errors for an empty suite, a record without the vertical component that a variant asks for,
    /// and façades that cannot exist.
    pub fn new(pipeline: &Pipeline, survey: Survey, sets: CoefficientSets, suite: Suite) -> Result<Self> {
        check_suite(pipeline, &suite)?;
        let cases = Configuration::ALL
            .into_iter()
            .flat_map(|c| pipeline.sweep.parameters(c).iter().map(move |&parameter| (c, parameter)))
            .collect();
        let plan = Self {
            name: pipeline.name.clone(),
            survey,
            sets,
            motions: Arc::new(Motions::new(suite)),
            variants: pipeline.variants.iter().cloned().map(Arc::new).collect(),
            cases,
            slenderness: pipeline.sweep.slenderness.clone(),
        };
        plan.check_facades(pipeline)?;
        Ok(plan)
    }

    /// Name of the study.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The records and their hashes.
    pub fn motions(&self) -> &Motions {
        &self.motions
    }

    /// The variants, the one to compare with first.
    pub fn variants(&self) -> impl Iterator<Item = &Variant> {
        self.variants.iter().map(AsRef::as_ref)
    }

    /// Runs under one record: a record's runs are `runs_per_record` neighbours, in the order of the suite.
    pub fn runs_per_record(&self) -> u64 {
        (self.variants.len() * self.cases.len() * Level::ALL.len() * self.slenderness.len()) as u64
    }

    /// Number of runs.
    pub fn len(&self) -> u64 {
        self.runs_per_record() * self.motions.suite.records.len() as u64
    }

    /// Whether there is nothing to run; a plan that was made has runs.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The run at a position, from 0.
    ///
    /// # Errors
    /// [`ImpossibleFacade`]; a plan that was made has none.
    ///
    /// # Panics
    /// At or beyond [`Plan::len`].
    pub fn run(&self, position: u64) -> Result<Run, ImpossibleFacade> {
        assert!(position < self.len(), "run {position} of {}", self.len());
        let cell = self.cell(position);
        let variant = Arc::clone(&self.variants[cell.variant]);
        let (configuration, parameter) = self.cases[cell.case];
        let assumptions = &variant.assumptions;
        let slenderness = self.slenderness[cell.slenderness];
        let facade = facade(&self.survey, configuration, (parameter, cell.level), slenderness, assumptions);
        let restitution = Restitution {
            coefficients: coefficients(&self.sets, parameter, cell.level),
            law: assumptions.law,
            capture_velocity_rad_s: assumptions.capture_velocity_rad_s,
        };
        let wall = facade.wall(restitution, assumptions.collapse_rotation_ratio)?;
        let run = Run {
            position,
            id: String::new(),
            motions: Arc::clone(&self.motions),
            record_index: cell.record,
            variant,
            configuration,
            parameter,
            level: cell.level,
            facade,
            wall,
        };
        Ok(run.with_id())
    }

    /// SHA-256 of everything that decides the list: equal plans have equal hashes.
    ///
    /// # Errors
    /// [`ImpossibleFacade`]; a plan that was made has none.
    pub fn sha256(&self) -> Result<String, ImpossibleFacade> {
        let mut hash = Fingerprint::of("plan").text("name", &self.name);
        // The runs of the other records differ from the first one's in the record alone.
        for position in 0..self.runs_per_record() {
            hash = hash.text("run", &self.run(position)?.id);
        }
        let suite = &self.motions.suite;
        for (record, motion) in suite.records.iter().zip(&self.motions.hashes) {
            hash = hash.text("record", &record.name).text("horizontal", &motion.horizontal);
            hash = hash.text("vertical", motion.vertical.as_deref().unwrap_or("none"));
        }
        Ok(hash.text("suite", &suite.name).hex())
    }

    fn cell(&self, position: u64) -> Cell {
        let mut rest = position as usize;
        let mut digit = |count: usize| {
            let digit = rest % count;
            rest /= count;
            digit
        };
        let slenderness = digit(self.slenderness.len());
        let level = Level::ALL[digit(Level::ALL.len())];
        let case = digit(self.cases.len());
        let variant = digit(self.variants.len());
        Cell { record: rest, variant, case, level, slenderness }
    }

    /// Façades do not depend on the record: one record's runs tell of all.
    fn check_facades(&self, pipeline: &Pipeline) -> Result<()> {
        for position in 0..self.runs_per_record() {
            if let Err(impossible) = self.run(position) {
                let cell = self.cell(position);
                let (configuration, parameter) = self.cases[cell.case];
                let found = format!(
                    "variant {:?}, {} floor, {} at {}, slenderness {}: {impossible}",
                    self.variants[cell.variant].name,
                    configuration.name(),
                    parameter.name(),
                    cell.level.name(parameter),
                    self.slenderness[cell.slenderness],
                );
                return Err(InputError::key(&pipeline.path, "sweep", found, "façades that can stand").into());
            }
        }
        Ok(())
    }
}

fn check_suite(pipeline: &Pipeline, suite: &Suite) -> Result<()> {
    let refuse = |found: String, allowed: &str| {
        Err(InputError::key(&pipeline.path, "suite", format!("suite {:?} with {found}", suite.name), allowed)
            .into())
    };
    if suite.records.is_empty() {
        return refuse("no records".into(), "at least one record");
    }
    let vertical = pipeline.variants.iter().any(|variant| variant.assumptions.vertical);
    if let Some(record) = suite.records.iter().find(|record| vertical && record.vertical.is_none()) {
        let allowed = "a vertical component for every record where a variant sets `vertical`";
        return refuse(format!("record {:?} without a vertical component", record.name), allowed);
    }
    let mut names: Vec<&str> = suite.records.iter().map(|record| record.name.as_str()).collect();
    names.sort_unstable();
    match names.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(twice) => refuse(format!("two records named {:?}", twice[0]), "a name for each record"),
        None => Ok(()),
    }
}
