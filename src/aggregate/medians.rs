//! The table of medians: what the tables and the findings are made from.

use std::collections::BTreeMap;

use super::quantile::MEDIAN;
use crate::study::pipeline::Parameter;
use crate::study::plan::Level;
use crate::study::runs::Completeness;
use crate::survey::Configuration;

/// A normalised largest rotation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Measure {
    /// θ_1 / α_1, the lower body over its own slenderness angle.
    LowerOwn,
    /// θ_2 / α_2, the upper body over its own slenderness angle.
    UpperOwn,
    /// θ_1 / α, the lower body over that of the uncracked wall.
    LowerWhole,
    /// θ_2 / α, the upper body over that of the uncracked wall.
    UpperWhole,
}

impl Measure {
    /// All four.
    pub const ALL: [Measure; 4] =
        [Measure::LowerOwn, Measure::UpperOwn, Measure::LowerWhole, Measure::UpperWhole];

    /// Lower and upper body over their own slenderness angles, which the source's figures show.
    pub const BODIES: [Measure; 2] = [Measure::LowerOwn, Measure::UpperOwn];

    /// Column of the run files, and name in the table of medians.
    pub fn column(self) -> &'static str {
        match self {
            Measure::LowerOwn => "theta1_max_over_alpha1",
            Measure::UpperOwn => "theta2_max_over_alpha2",
            Measure::LowerWhole => "theta1_max_over_alpha",
            Measure::UpperWhole => "theta2_max_over_alpha",
        }
    }
}

/// What the runs of a group share: everything but the record.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Name of the set of assumptions.
    pub variant: String,
    /// How the floor runs.
    pub configuration: Configuration,
    /// Parameter off its mean.
    pub parameter: Parameter,
    /// Its level.
    pub level: Level,
    /// h_tot / b.
    pub slenderness: f64,
}

/// Quantiles over the records of one normalised rotation of one case.
#[derive(Debug, Clone, PartialEq)]
pub struct Median {
    /// The case.
    pub case: Case,
    /// Value of its parameter, SI; none for the coefficients.
    pub parameter_value: Option<f64>,
    /// The rotation.
    pub measure: Measure,
    /// Runs, failed ones too.
    pub runs: u64,
    /// Runs that collapsed.
    pub collapsed: u64,
    /// Runs that failed and take no part in the quantiles.
    pub failed: u64,
    /// Quantiles at [`super::LEVELS`]; none where they land among collapses.
    pub quantiles: [Option<f64>; 7],
}

/// The middle of a group of runs, some of which may have collapsed; ordered, collapse last.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub enum Middle {
    /// The median rotation.
    Rotation(f64),
    /// The median run collapsed.
    Collapsed,
}

impl Median {
    /// The median; none if no run could be finished.
    pub fn middle(&self) -> Option<Middle> {
        match self.quantiles[MEDIAN] {
            Some(rotation) => Some(Middle::Rotation(rotation)),
            None if self.collapsed > 0 => Some(Middle::Collapsed),
            None => None,
        }
    }

    /// Share of the finished runs that collapsed; none if none was finished.
    pub fn share_collapsed(&self) -> Option<f64> {
        let finished = self.runs - self.failed;
        (finished > 0).then(|| self.collapsed as f64 / finished as f64)
    }

    /// Distance between the 16 and the 84 % quantiles; none where collapses make it endless or nothing finished.
    pub fn spread(&self) -> Option<f64> {
        Some(self.quantiles[MEDIAN + 2]? - self.quantiles[MEDIAN - 2]?)
    }
}

/// The assumptions of a variant, as its runs tell them.
#[derive(Debug, Clone, PartialEq)]
pub struct VariantNote {
    /// Name.
    pub name: String,
    /// Length of the strip, m.
    pub length_m: f64,
    /// Density of the masonry, kg/m³.
    pub density_kg_m3: f64,
    /// What the coefficients scale.
    pub law: String,
    /// Capture velocity, rad/s.
    pub capture_velocity_rad_s: f64,
    /// Tolerance of the solver.
    pub tolerance: f64,
    /// Suite of records.
    pub suite: String,
    /// Whether the suite is generated.
    pub suite_generated: bool,
    /// Runs.
    pub runs: u64,
    /// Runs that collapsed.
    pub collapsed: u64,
    /// Runs that failed.
    pub failed: u64,
    /// Largest energy not accounted for, over the energy that passed through.
    pub energy_residual: Option<f64>,
}

/// How many runs of a variant come out differently from the same runs of the first variant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Moved {
    /// The variant.
    pub variant: String,
    /// How the floor runs.
    pub configuration: String,
    /// Runs compared.
    pub runs: u64,
    /// Runs with another outcome, or another largest rotation.
    pub moved: u64,
}

/// All medians of a study, by case and measure.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Medians {
    /// Variants in the order of the plan, the one to compare with first.
    pub variants: Vec<VariantNote>,
    /// Runs that come out differently, by variant and floor.
    pub moved: Vec<Moved>,
    /// How much of its plan the study has run; `None` where nobody knows.
    pub completeness: Option<Completeness>,
    rows: Vec<Median>,
    by_case: BTreeMap<Key, usize>,
}

/// Slendernesses are inputs, so their bits identify them; positive floats order as their bits do.
type Key = (String, Configuration, Parameter, Level, u64, Measure);

fn key(case: &Case, measure: Measure) -> Key {
    let bits = case.slenderness.to_bits();
    (case.variant.clone(), case.configuration, case.parameter, case.level, bits, measure)
}

impl Medians {
    /// A table of these rows, in their order.
    pub fn new(variants: Vec<VariantNote>, rows: Vec<Median>) -> Self {
        let by_case = rows.iter().enumerate().map(|(i, row)| (key(&row.case, row.measure), i)).collect();
        Self { variants, moved: Vec::new(), completeness: None, rows, by_case }
    }

    /// The same table with what comparing runs with runs told.
    #[must_use]
    pub fn with_moved(mut self, moved: Vec<Moved>) -> Self {
        self.moved = moved;
        self
    }

    /// The same table of a study that has run so much of its plan.
    #[must_use]
    pub fn of_study(mut self, completeness: Option<Completeness>) -> Self {
        self.completeness = completeness;
        self
    }

    /// All rows, in the order of the plan.
    pub fn rows(&self) -> &[Median] {
        &self.rows
    }

    /// The row of a case; none if the study has no such case.
    pub fn get(&self, case: &Case, measure: Measure) -> Option<&Median> {
        self.by_case.get(&key(case, measure)).map(|&i| &self.rows[i])
    }

    /// The slendernesses of the study, increasing.
    pub fn slendernesses(&self) -> Vec<f64> {
        let mut all: Vec<f64> = self.rows.iter().map(|row| row.case.slenderness).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }
}
