//! The plan: a list of runs, each computed from its position.

use std::path::Path;
use std::sync::Arc;

use super::fingerprint::Fingerprint;
use super::kinds::DrawnFacades;
use super::kinds::Setting;
use super::kinds::Sweep;
use super::run::Motions;
use super::run::Run;
use crate::error::{InputError, Result};
use crate::study::pipeline::{Drawn, Kind, Pipeline, Study, Variant};
use crate::study::sequence::{Sequence, sequences};
use crate::survey::sampling::Variable;
use crate::survey::{Configuration, Survey};
use mrbd_files::coefficients::CoefficientSets;
use mrbd_kernel::model::Restitution;
use mrbd_records::Suite;

/// Drawn façades whose runs go into the hash of a plan, beside the definition of all of them.
const HASHED_DRAWS: u64 = 16;

/// More runs than this are a slip of the pen: centuries of work.
const MOST_RUNS: u64 = 1_000_000_000_000;

/// A list of runs. Every façade of a sweep is a wall that can exist; of drawn ones a few may not be.
#[derive(Debug, Clone)]
pub struct Plan {
    name: String,
    kind: Kind,
    motions: Arc<Motions>,
    variants: Vec<Arc<Variant>>,
    settings: Settings,
    /// Empty where every record is run by itself.
    sequences: Vec<Arc<Sequence>>,
}

/// What varies under one record and one set of assumptions.
#[derive(Debug, Clone)]
enum Settings {
    Sweep(Box<Sweep>),
    Drawn(Box<DrawnFacades>),
}

/// The suite where the façades stand.
fn on_floor(pipeline: &Pipeline, suite: Suite) -> Result<Suite> {
    let Some(building) = &pipeline.floor else { return Ok(suite) };
    let fault = |e: mrbd_records::InvalidAccelerogram| {
        InputError::key(&pipeline.path, "floor", e.to_string(), "records that a building can follow")
    };
    Ok(suite.on_floor(building).map_err(fault)?)
}

impl Plan {
    /// Reads what the pipeline names and checks it; `suite` replaces the pipeline's own.
    ///
    /// # Errors
    /// Input errors of the files, and of façades that cannot exist.
    pub fn load(pipeline: &Pipeline, suite: Option<&Path>) -> Result<Self> {
        let survey = Survey::load(&pipeline.survey)?;
        let sets = CoefficientSets::load(&pipeline.coefficients)?;
        let suite = on_floor(pipeline, Suite::load(suite.unwrap_or(&pipeline.suite))?)?;
        Self::new(pipeline, survey, sets, suite)
    }

    /// A plan of what was read.
    ///
    /// # Errors
    /// Input errors for an empty suite, a record without the vertical component that a variant asks for or that cannot be
    /// scaled, façades of a sweep that cannot exist, and distributions that cannot.
    pub fn new(pipeline: &Pipeline, survey: Survey, sets: CoefficientSets, suite: Suite) -> Result<Self> {
        check_suite(pipeline, &suite)?;
        let sequences = sequences(&pipeline.path, &pipeline.sequence, &suite)?;
        let settings = match &pipeline.study {
            Study::Sweep(table) => Settings::Sweep(Box::new(Sweep::new(table, survey, sets))),
            Study::Drawn(drawn) => {
                let facades = DrawnFacades::new(pipeline, drawn, &survey, &sets, &suite)?;
                Settings::Drawn(Box::new(facades))
            }
        };
        let plan = Self {
            name: pipeline.name.clone(),
            kind: pipeline.kind,
            motions: Arc::new(Motions::new(suite)),
            variants: pipeline.variants.iter().cloned().map(Arc::new).collect(),
            settings,
            sequences: sequences.into_iter().map(Arc::new).collect(),
        };
        plan.check_length(pipeline)?;
        plan.check_sweep(pipeline)?;
        Ok(plan)
    }

    /// Name of the study.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Kind of the study.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// The records and their hashes.
    pub fn motions(&self) -> &Motions {
        &self.motions
    }

    /// The variants, the one to compare with first.
    pub fn variants(&self) -> impl Iterator<Item = &Variant> {
        self.variants.iter().map(AsRef::as_ref)
    }

    /// What is drawn, and how strongly it is shaken; none for a sweep.
    pub fn drawn(&self) -> Option<&Drawn> {
        match &self.settings {
            Settings::Sweep(_) => None,
            Settings::Drawn(facades) => Some(facades.drawn()),
        }
    }

    /// Probability that truncations took from the survey's distributions, where they took any.
    pub fn truncated(&self) -> Vec<(Configuration, Variable, f64)> {
        match &self.settings {
            Settings::Sweep(_) => Vec::new(),
            Settings::Drawn(facades) => facades.truncated(),
        }
    }

    /// The sequences, in their order; none where every record is run by itself.
    pub fn sequences(&self) -> impl ExactSizeIterator<Item = &Sequence> {
        self.sequences.iter().map(AsRef::as_ref)
    }

    /// Rows of one wall under a motion: one under a record, and of a sequence as many as it has.
    pub fn rows(&self) -> u64 {
        self.sequences.first().map_or(1, |sequence| sequence.rows()) as u64
    }

    /// Records, or sequences of them.
    fn motions_run(&self) -> usize {
        if self.sequences.is_empty() { self.motions.suite.records.len() } else { self.sequences.len() }
    }

    /// Runs under one record, or one sequence of them: neighbours, in the order of the suite or of the sequences.
    pub fn runs_per_record(&self) -> u64 {
        self.layers() as u64 * self.runs_per_variant()
    }

    /// Variants of which each is run in full: all of them, but those of a study of variance, which draws a member for each run.
    fn layers(&self) -> usize {
        if self.kind == Kind::Variance { 1 } else { self.variants.len() }
    }

    /// Number of runs.
    pub fn len(&self) -> u64 {
        self.runs_per_record() * self.motions_run() as u64
    }

    /// Whether there is nothing to run; a plan that was made has runs.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The run at a position, from 0.
    ///
    /// # Panics
    /// At or beyond [`Plan::len`].
    pub fn run(&self, position: u64) -> Run {
        assert!(position < self.len(), "run {position} of {}", self.len());
        let (setting, rest) = (position % self.runs_per_variant(), position / self.runs_per_variant());
        let (row, setting) = ((setting % self.rows()) as usize, setting / self.rows());
        let layers = self.layers() as u64;
        let (variant, motion) = ((rest % layers) as usize, (rest / layers) as usize);
        let sequence = self.sequences.get(motion).map(|sequence| (Arc::clone(sequence), sequence.place(row)));
        let part = sequence.as_ref().map(|(sequence, place)| sequence.parts[place.part]);
        let record_index = part.map_or(motion, |part| part.record_index);
        let assumptions = &self.variants[variant].assumptions;
        let setting = match &self.settings {
            Settings::Sweep(sweep) => sweep.at(setting, assumptions),
            Settings::Drawn(facades) => facades.at(setting, record_index, assumptions),
        };
        let factor =
            part.map_or(1.0, |part| part.scale) * setting.factor(&self.motions.suite.records[record_index]);
        let Setting { configuration, origin, facade, coefficients, scaling, assumed } = setting;
        // The members of an ensemble follow their variant.
        let variant = Arc::clone(&self.variants[variant + assumed.member]);
        let restitution = Restitution {
            coefficients,
            law: assumed.law,
            capture_velocity_rad_s: assumptions.capture_velocity_rad_s,
        };
        let wall = facade.wall_under(restitution, assumptions, assumed.bed);
        let run = Run {
            position,
            id: String::new(),
            motions: Arc::clone(&self.motions),
            record_index,
            sequence,
            variant,
            configuration,
            origin,
            scaling,
            factor,
            facade,
            restitution,
            wall,
        };
        run.with_id()
    }

    /// SHA-256 of everything that decides the list: equal plans have equal hashes.
    pub fn sha256(&self) -> String {
        let hash = Fingerprint::of("plan").text("name", &self.name);
        // The runs of the other records differ from the first one's in the record alone.
        let hash = match &self.settings {
            Settings::Sweep(_) => Sweep::hashed(hash, (0..self.runs_per_record()).map(|i| self.run(i).id)),
            Settings::Drawn(facades) => {
                let variants =
                    self.variants().map(|variant| serde_json::to_string(variant).unwrap_or_default());
                let hash = variants.fold(hash, |hash, variant| hash.text("variant", &variant));
                let first = HASHED_DRAWS.min(self.runs_per_record());
                facades.hashed(hash.text("kind", self.kind.name()), (0..first).map(|i| self.run(i).id))
            }
        };
        let hash = self.sequences.iter().fold(hash, |hash, sequence| {
            // Names and numbers always serialise.
            hash.text("sequence", &serde_json::to_string(&**sequence).unwrap_or_default())
        });
        let suite = &self.motions.suite;
        let records = suite.records.iter().zip(&self.motions.hashes);
        let hash = records.fold(hash, |hash, (record, motion)| {
            hash.text("record", &record.name)
                .text("horizontal", &motion.horizontal)
                .text("vertical", motion.vertical.as_deref().unwrap_or("none"))
        });
        hash.text("suite", &suite.name).hex()
    }

    fn runs_per_variant(&self) -> u64 {
        let facades = match &self.settings {
            Settings::Sweep(sweep) => sweep.len(),
            Settings::Drawn(facades) => facades.len(),
        };
        facades * self.rows()
    }

    fn check_length(&self, pipeline: &Pipeline) -> Result<()> {
        let Some(drawn) = self.drawn() else { return Ok(()) };
        let beside = self.layers() * self.motions_run() * drawn.runs_per_draw() * self.rows() as usize;
        let allowed = MOST_RUNS / beside as u64;
        if drawn.sampling.count <= allowed {
            return Ok(());
        }
        let allowed = format!("1 to {allowed}: with {beside} runs a draw, at most {MOST_RUNS} runs");
        Err(InputError::key(&pipeline.path, "sampling.count", drawn.sampling.count.to_string(), allowed)
            .into())
    }

    /// Façades of a sweep do not depend on the record or sequence: the runs of one tell of all.
    fn check_sweep(&self, pipeline: &Pipeline) -> Result<()> {
        let Settings::Sweep(sweep) = &self.settings else { return Ok(()) };
        for position in 0..self.runs_per_record() {
            let run = self.run(position);
            if let Err(impossible) = &run.wall {
                let setting = position / self.rows() % sweep.len();
                let place = Sweep::place(&sweep.at(setting, &run.variant.assumptions));
                let found = format!("variant {:?}, {place}: {impossible}", run.variant.name);
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
