//! The table of medians: what the tables and the findings are made from.

use std::cmp::Ordering;

use super::draws::Draws;
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
    /// Where the median lies in nine of ten draws of records and ensembles; `None` of too few records.
    pub interval: Option<[Middle; 2]>,
}

/// The middle of a group of runs, some of which may have collapsed; ordered, collapse last.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub enum Middle {
    /// The median rotation.
    Rotation(f64),
    /// The median run collapsed.
    Collapsed,
}

impl Middle {
    /// Order by size: a collapse lies above every rotation.
    pub fn by_size(&self, other: &Self) -> Ordering {
        match (self, other) {
            (Middle::Rotation(a), Middle::Rotation(b)) => a.total_cmp(b),
            (Middle::Collapsed, Middle::Collapsed) => Ordering::Equal,
            (Middle::Rotation(_), Middle::Collapsed) => Ordering::Less,
            (Middle::Collapsed, Middle::Rotation(_)) => Ordering::Greater,
        }
    }

    /// The rotation; `None` of a collapse.
    pub fn rotation(self) -> Option<f64> {
        match self {
            Middle::Rotation(rotation) => Some(rotation),
            Middle::Collapsed => None,
        }
    }
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
#[derive(Debug, Clone, PartialEq, Default)]
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
    /// Free motion after the record, s.
    pub tail_s: f64,
    /// Rotation over α_i at which a wall counts as collapsed.
    pub collapse_rotation_ratio: f64,
    /// Whether vertical components act.
    pub vertical: bool,
    /// What is assumed beside these, such as beds in the joints, as the manifest has it; empty as a rule.
    pub further: String,
}

impl VariantNote {
    /// Whether another variant has the same assumptions but for tolerance or capture velocity, which no wall has.
    pub(super) fn differs_in_accuracy_alone(&self, other: &Self) -> bool {
        let assumed = |note: &Self| {
            let of_wall = [note.length_m, note.density_kg_m3, note.collapse_rotation_ratio, note.tail_s];
            (of_wall.map(f64::to_bits), note.law.clone(), note.vertical, note.further.clone())
        };
        self.name != other.name && assumed(self) == assumed(other)
    }
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
    /// What tells how sure the medians of each variant are, in the order of the variants.
    pub draws: Vec<Draws>,
    rows: Vec<Median>,
    /// The rows of each variant: draws of medians are asked a thousand times over, so texts are compared once, and rows found by
    /// their places.
    of_variants: Vec<OfVariant>,
    slendernesses: Vec<f64>,
}

/// The rows of a variant.
#[derive(Debug, Clone, PartialEq, Default)]
struct OfVariant {
    name: String,
    rows: Vec<usize>,
    /// The row at each [`place_of`].
    at: Vec<Option<usize>>,
    /// Parameters under each floor, in the order of the rows.
    parameters: Vec<(Configuration, Parameter)>,
}

/// What tells a row apart within a variant.
type Key = (Configuration, Parameter, Level, f64, Measure);

/// The place of a key among all that the slendernesses, increasing, allow; `None` of another slenderness.
fn place_of(
    (configuration, parameter, level, slenderness, measure): Key,
    slendernesses: &[f64],
) -> Option<usize> {
    // Slendernesses are inputs, so their bits identify them.
    let slenderness = slendernesses.binary_search_by(|other| other.total_cmp(&slenderness)).ok()?;
    let case = (configuration as usize * Parameter::ALL.len() + parameter as usize) * Level::ALL.len()
        + level.index();
    Some((case * slendernesses.len() + slenderness) * Measure::ALL.len() + measure as usize)
}

impl OfVariant {
    fn add(&mut self, row: usize, median: &Median, slendernesses: &[f64]) {
        let Case { configuration, parameter, level, slenderness, .. } = median.case;
        self.rows.push(row);
        let key = (configuration, parameter, level, slenderness, median.measure);
        if let Some(place) = place_of(key, slendernesses) {
            self.at.resize(self.at.len().max(place + 1), None);
            self.at[place] = Some(row);
        }
        if self.parameters.last() != Some(&(configuration, parameter))
            && !self.parameters.contains(&(configuration, parameter))
        {
            self.parameters.push((configuration, parameter));
        }
    }

    fn row(&self, key: Key, slendernesses: &[f64]) -> Option<usize> {
        *self.at.get(place_of(key, slendernesses)?)?
    }
}

/// The rows of each variant, in the order of the rows.
fn of_variants(rows: &[Median], slendernesses: &[f64]) -> Vec<OfVariant> {
    let mut all: Vec<OfVariant> = Vec::new();
    for (row, median) in rows.iter().enumerate() {
        let place = all.iter().rposition(|variant| variant.name == median.case.variant);
        let place = place.unwrap_or_else(|| {
            all.push(OfVariant { name: median.case.variant.clone(), ..OfVariant::default() });
            all.len() - 1
        });
        all[place].add(row, median, slendernesses);
    }
    all
}

impl Medians {
    /// A table of these rows, in their order.
    pub fn new(variants: Vec<VariantNote>, rows: Vec<Median>) -> Self {
        let mut slendernesses: Vec<f64> = rows.iter().map(|row| row.case.slenderness).collect();
        slendernesses.sort_unstable_by(f64::total_cmp);
        slendernesses.dedup();
        let of_variants = of_variants(&rows, &slendernesses);
        let (moved, draws) = (Vec::new(), Vec::new());
        Self { variants, moved, completeness: None, draws, rows, of_variants, slendernesses }
    }

    /// The same table with the interval of every median.
    #[must_use]
    pub fn with_draws(mut self, draws: Vec<Draws>) -> Self {
        for of_variant in draws.iter().filter(|draws| draws.tell()) {
            for (case, measure, interval) in of_variant.intervals() {
                if let Some(row) = self.place(case, measure) {
                    self.rows[row].interval = interval;
                }
            }
        }
        self.draws = draws;
        self
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

    /// The same rows, whose cases and measures stay.
    pub(super) fn rows_mut(&mut self) -> &mut [Median] {
        &mut self.rows
    }

    /// The row of a case; none if the study has no such case.
    pub fn get(&self, case: &Case, measure: Measure) -> Option<&Median> {
        self.place(case, measure).map(|row| &self.rows[row])
    }

    fn place(&self, case: &Case, measure: Measure) -> Option<usize> {
        let Case { configuration, parameter, level, slenderness, .. } = *case;
        let key = (configuration, parameter, level, slenderness, measure);
        self.of_variants.get(self.variant(&case.variant)?)?.row(key, &self.slendernesses)
    }

    /// The place of a variant among those that have rows.
    pub(crate) fn variant(&self, name: &str) -> Option<usize> {
        self.of_variants.iter().position(|variant| variant.name == name)
    }

    /// The row of a case of the variant at a place; none if the study has no such case.
    pub(crate) fn row(
        &self,
        variant: usize,
        (configuration, parameter, level): (Configuration, Parameter, Level),
        (slenderness, measure): (f64, Measure),
    ) -> Option<&Median> {
        let key = (configuration, parameter, level, slenderness, measure);
        self.of_variants[variant].row(key, &self.slendernesses).map(|row| &self.rows[row])
    }

    /// The rows of the variant at a place.
    pub(crate) fn rows_of(&self, variant: usize) -> impl Iterator<Item = &Median> {
        self.of_variants[variant].rows.iter().map(|&row| &self.rows[row])
    }

    /// The parameters of the variant at a place, by floor, in the order of the rows.
    pub(crate) fn parameters(&self, variant: usize) -> &[(Configuration, Parameter)] {
        &self.of_variants[variant].parameters
    }

    /// The slendernesses of the study, increasing.
    pub fn slendernesses(&self) -> &[f64] {
        &self.slendernesses
    }
}
