//! How sure medians are: the records and what no input decides, drawn anew many times.
//!
//! A draw takes as many records as the study has, with replacement (Efron 1979), and of every run one member of its
//! ensemble: the run as planned, one whose motion is changed by up to a millionth, or one at another tolerance or capture
//! velocity. A draw depends on its number alone, so that threads and machines change nothing.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::path::PathBuf;

use polars::prelude::PolarsResult;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::case_runs::{CaseRuns, Drawn, Ended};
use super::medians::{Case, Measure, Medians, Middle, VariantNote};
use super::quantile::quantiles;
use super::stored::Row;
use super::sweep::{CASE, case};
use super::variants::MEMBER_OF;
use crate::store::frame::{Frame, Texts, read};

/// Draws: a share of them has a standard deviation of at most 1.6 %.
pub const DRAWS: u64 = 1000;

/// Of fewer records there are too few different draws for quantiles at 5 %: 35 of four, 126 of five.
pub const FEWEST_RECORDS: usize = 5;

/// Seed of all draws.
const SEED: u64 = 2012;

/// The random numbers of a draw: its own, so that threads and machines change nothing.
pub(super) fn rng_of(draw: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    rng.set_stream(draw);
    rng
}

/// Ends of the interval of a median.
const INTERVAL: [f64; 2] = [0.05, 0.95];

/// The runs of a variant and of what answers for them.
#[derive(Debug, Clone, PartialEq)]
pub struct Draws {
    /// Name of the variant.
    pub variant: String,
    /// How many records the study has run.
    pub records: usize,
    /// How many answer for a run, itself among them.
    pub members: usize,
    cases: Vec<CaseRuns>,
}

/// Which variants answer for the runs of one: itself, the members of its ensemble, and, for the first of the study, those
/// that differ from it by tolerance or capture velocity alone.
fn kin(variants: &[VariantNote], of: usize) -> Vec<&str> {
    let variant = &variants[of];
    let same = |other: &&VariantNote| of == 0 && other.differs_in_accuracy_alone(variant);
    let others = variants.iter().filter(same).map(|other| other.name.as_str());
    std::iter::once(variant.name.as_str()).chain(others).collect()
}

/// The draws of every variant, in their order.
///
/// # Errors
/// Files that cannot be read, and runs without a value that every run has.
pub(super) fn draws(files: &[PathBuf], variants: &[VariantNote]) -> PolarsResult<Vec<Draws>> {
    let mut columns = vec!["run", "record", MEMBER_OF, "outcome", "parameter_value"];
    columns.extend(CASE);
    columns.extend(Measure::ALL.map(Measure::column));
    let frame = read(files, &columns)?;
    let runs = Runs::of(&frame)?;
    (0..variants.len()).map(|of| runs.draws(&kin(variants, of))).collect()
}

/// The columns that draws are made from.
struct Runs<'a> {
    frame: &'a Frame,
    variants: Texts<'a>,
    members_of: Texts<'a>,
    records: Texts<'a>,
    outcomes: Texts<'a>,
}

/// What tells a case apart within a variant, and the rows that answer for it, by record.
type ByCase<'a> = BTreeMap<(&'a str, &'a str, &'a str, u64), BTreeMap<&'a str, Vec<usize>>>;

impl<'a> Runs<'a> {
    fn of(frame: &'a Frame) -> PolarsResult<Self> {
        Ok(Self {
            frame,
            variants: frame.texts("variant")?,
            members_of: frame.texts(MEMBER_OF)?,
            records: frame.texts("record")?,
            outcomes: frame.texts("outcome")?,
        })
    }

    /// The draws of the first of `kin`.
    fn draws(&self, kin: &[&str]) -> PolarsResult<Draws> {
        let by_case = self.by_case(kin)?;
        let mut records: Vec<&str> = by_case.values().flat_map(BTreeMap::keys).copied().collect();
        records.sort_unstable();
        records.dedup();
        let mut cases = Vec::new();
        for rows in by_case.values() {
            cases.extend(self.case(kin[0], &records, rows)?);
        }
        let members = cases.iter().flat_map(|case: &CaseRuns| case.by_record.iter().map(Vec::len)).max();
        Ok(Draws { variant: kin[0].to_owned(), records: records.len(), members: members.unwrap_or(0), cases })
    }

    fn by_case(&self, kin: &[&str]) -> PolarsResult<ByCase<'a>> {
        let (floors, parameters, levels) =
            (self.frame.texts("configuration")?, self.frame.texts("parameter")?, self.frame.texts("level")?);
        let slendernesses = self.frame.numbers("slenderness")?;
        let mut by_case = ByCase::new();
        for row in 0..self.frame.height() {
            let answers = |name: Option<&str>| name.is_some_and(|name| kin.contains(&name));
            let of_kin = match self.members_of.get(row) {
                // Members answer for the variant that they belong to, not for those like it.
                Some(variant) => variant == kin[0],
                None => answers(self.variants.get(row)),
            };
            let key = (floors.get(row), parameters.get(row), levels.get(row), slendernesses.get(row));
            if let (true, (Some(floor), Some(parameter), Some(level), Some(slenderness)), Some(record)) =
                (of_kin, key, self.records.get(row))
            {
                let case = by_case.entry((floor, parameter, level, slenderness.to_bits())).or_default();
                case.entry(record).or_default().push(row);
            }
        }
        Ok(by_case)
    }

    /// The runs of a case; `None` where the variant itself has none of it, as a study that is not finished.
    fn case(
        &self,
        variant: &str,
        records: &[&str],
        rows: &BTreeMap<&str, Vec<usize>>,
    ) -> PolarsResult<Option<CaseRuns>> {
        let all = rows.values().flatten();
        let Some(&first) = all.into_iter().find(|&&row| self.variants.get(row) == Some(variant)) else {
            return Ok(None);
        };
        let run = Row { frame: self.frame, row: first };
        let ended = |rows: Option<&Vec<usize>>| -> PolarsResult<Vec<Ended>> {
            rows.into_iter().flatten().map(|&row| self.ended(row)).collect()
        };
        Ok(Some(CaseRuns {
            case: case(run)?,
            parameter_value: run.optional_number("parameter_value")?,
            by_record: records.iter().map(|record| ended(rows.get(record))).collect::<PolarsResult<_>>()?,
        }))
    }

    fn ended(&self, row: usize) -> PolarsResult<Ended> {
        let run = Row { frame: self.frame, row };
        match self.outcomes.get(row) {
            Some("stood") => {
                let mut rotations = [0.0; 4];
                for (rotation, measure) in rotations.iter_mut().zip(Measure::ALL) {
                    *rotation = run.number(measure.column())?;
                }
                Ok(Ended::Stood(rotations))
            }
            Some("collapsed") => Ok(Ended::Collapsed),
            _ => Ok(Ended::Failed),
        }
    }
}

impl Draws {
    /// Whether there are records enough to draw from.
    pub fn tell(&self) -> bool {
        self.records >= FEWEST_RECORDS
    }

    /// A table of the medians of these cases, as they are before anything is drawn: of nothing.
    pub fn table(&self) -> Medians {
        let of = |case: &CaseRuns| Measure::ALL.map(|measure| case.nothing(measure));
        Medians::new(Vec::new(), self.cases.iter().flat_map(of).collect())
    }

    /// Puts the medians of a draw of so many records into their [`Draws::table`].
    pub fn draw_into(&self, draw: u64, records: usize, table: &mut Medians) {
        let mut rows = table.rows_mut().iter_mut();
        self.draw(draw, records, |drawn| {
            for (standing, row) in drawn.standing.iter().zip(rows.by_ref()) {
                (row.runs, row.collapsed, row.failed) = (drawn.runs, drawn.collapsed, drawn.failed);
                row.quantiles = quantiles(standing, drawn.collapsed as usize);
            }
        });
    }

    /// Draws so many records; `each` sees what is drawn of one case after another.
    fn draw(&self, draw: u64, records: usize, mut each: impl FnMut(&Drawn)) {
        let mut rng = rng_of(draw);
        let records: Vec<usize> = (0..records).map(|_| rng.random_range(0..self.records)).collect();
        let mut drawn = Drawn::default();
        for case in &self.cases {
            drawn.draw(case, &records, &mut rng);
            each(&drawn);
        }
    }

    /// The interval of each median over all draws, by case in their order and by measure; `None` where none could be drawn.
    pub(super) fn intervals(&self) -> Vec<(&Case, Measure, Option<[Middle; 2]>)> {
        let middles = |draw| {
            let mut middles = Vec::with_capacity(self.cases.len() * Measure::ALL.len());
            self.draw(draw, self.records, |drawn| middles.extend(drawn.middles()));
            middles
        };
        let drawn: Vec<Vec<Option<Middle>>> = (0..DRAWS).into_par_iter().map(middles).collect();
        let places = self.cases.iter().flat_map(|case| Measure::ALL.map(|measure| (&case.case, measure)));
        let of = |(place, (case, measure))| {
            (case, measure, interval(drawn.iter().filter_map(|draw: &Vec<_>| draw[place]), Middle::by_size))
        };
        places.enumerate().map(of).collect()
    }
}

/// Order statistics of what was drawn at 5 and 95 %, outwards; `None` of nothing.
pub(super) fn interval<T: Copy>(
    drawn: impl Iterator<Item = T>,
    by_size: impl Fn(&T, &T) -> Ordering,
) -> Option<[T; 2]> {
    let mut drawn: Vec<T> = drawn.collect();
    let last = drawn.len().checked_sub(1)? as f64;
    let (low, high) = ((INTERVAL[0] * last).floor() as usize, (INTERVAL[1] * last).ceil() as usize);
    let low = *drawn.select_nth_unstable_by(low, &by_size).1;
    Some([low, *drawn.select_nth_unstable_by(high, by_size).1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::aggregate::Median;
    use crate::study::pipeline::Parameter;
    use crate::study::plan::Level;
    use crate::survey::Configuration;

    fn draws(by_record: Vec<Vec<Ended>>) -> Draws {
        let case = Case {
            variant: "base".into(),
            configuration: Configuration::Parallel,
            parameter: Parameter::Thickness,
            level: Level::Mean,
            slenderness: 12.0,
        };
        let (records, members) = (by_record.len(), by_record[0].len());
        let cases = vec![CaseRuns { case, parameter_value: Some(0.5), by_record }];
        Draws { variant: "base".into(), records, members, cases }
    }

    /// The medians of a draw of so many records.
    fn drawn(draws: &Draws, draw: u64, records: usize) -> Vec<Median> {
        let mut table = draws.table();
        draws.draw_into(draw, records, &mut table);
        table.rows().to_vec()
    }

    fn interval_of(draws: &Draws) -> [Middle; 2] {
        draws.intervals()[0].2.expect("runs")
    }

    fn stood(rotation: f64) -> Ended {
        Ended::Stood([rotation; 4])
    }

    #[test]
    fn analytic_the_median_of_seven_records_lies_between_the_second_and_the_sixth() {
        // The median of a draw is at most the k-th of seven if four or more of its records are among the first k: with a
        // probability of 0.010 for k = 1 and 0.098 for k = 2 (binomial, 7 trials of k/7). By symmetry the same from above.
        let draws = draws((1..=7).map(|i| vec![stood(f64::from(i))]).collect());
        assert_eq!(interval_of(&draws), [Middle::Rotation(2.0), Middle::Rotation(6.0)]);
    }

    #[test]
    fn analytic_records_that_agree_leave_no_doubt() {
        let draws = draws(vec![vec![stood(0.2)]; 7]);
        assert_eq!(interval_of(&draws), [Middle::Rotation(0.2); 2]);
    }

    #[test]
    fn analytic_what_the_members_say_is_drawn_too() {
        // All records agree, and every second member collapses: the median of seven collapses in half of the draws.
        let draws = draws(vec![vec![stood(0.2), Ended::Collapsed]; 7]);
        assert_eq!(interval_of(&draws), [Middle::Rotation(0.2), Middle::Collapsed]);
        let fell = (0..DRAWS).filter(|&draw| drawn(&draws, draw, 7)[0].middle() == Some(Middle::Collapsed));
        // Three standard deviations of a share of a thousand tosses.
        let share = fell.count() as f64 / DRAWS as f64;
        assert!((share - 0.5).abs() < 3.0 * (0.25 / DRAWS as f64).sqrt(), "{share}");
    }

    #[test]
    fn analytic_a_draw_depends_on_its_number_alone() {
        let draws = draws((1..=7).map(|i| vec![stood(f64::from(i)), stood(10.0 + f64::from(i))]).collect());
        let of = |draw| drawn(&draws, draw, 7);
        assert_eq!(of(3), of(3));
        assert_ne!(of(3), of(4));
        let mut table = draws.table();
        [4, 3].into_iter().for_each(|draw| draws.draw_into(draw, 7, &mut table));
        assert_eq!(table.rows(), of(3), "whatever was in its table before");
    }

    #[test]
    fn analytic_middles_are_those_of_the_table() {
        let fallen = vec![stood(0.1), Ended::Collapsed, Ended::Failed];
        let draws = draws([vec![stood(0.3), stood(0.2)], fallen.clone(), fallen, vec![Ended::Failed]].into());
        let mut seen = Vec::new();
        for draw in 0..100 {
            draws.draw(draw, 3, |of_case| seen.extend(of_case.middles()));
            let of_table: Vec<Option<Middle>> = drawn(&draws, draw, 3).iter().map(Median::middle).collect();
            assert_eq!(seen.split_off(seen.len() - 4), of_table, "draw {draw}");
            seen.push(of_table[0]);
        }
        let told = |middle: fn(&Option<Middle>) -> bool| seen.iter().any(middle);
        assert!(told(Option::is_none) && told(|m| *m == Some(Middle::Collapsed)), "{seen:?}");
        assert!(told(|m| matches!(m, Some(Middle::Rotation(_)))), "{seen:?}");
    }

    #[test]
    fn regress_failed_runs_take_no_part() {
        let draws = draws(vec![vec![Ended::Failed], vec![stood(0.1)], vec![stood(0.1)]]);
        let all: Vec<Median> = (0..100).flat_map(|draw| drawn(&draws, draw, 3)).collect();
        assert!(all.iter().any(|median| median.failed > 0 && median.failed < 3));
        let middles = all.iter().filter(|median| median.failed < 3).map(Median::middle);
        assert!(middles.into_iter().all(|middle| middle == Some(Middle::Rotation(0.1))));
        assert!(!draws.tell(), "three records are too few to tell");
    }

    #[test]
    fn regress_variants_of_other_accuracy_answer_for_the_first_alone() {
        let note = |name: &str, tolerance: f64, density_kg_m3: f64| VariantNote {
            name: name.into(),
            length_m: 1.0,
            density_kg_m3,
            law: "whole".into(),
            capture_velocity_rad_s: 1e-3,
            tolerance,
            suite: "s".into(),
            suite_generated: true,
            runs: 1,
            collapsed: 0,
            failed: 0,
            energy_residual: None,
            tail_s: 5.0,
            collapse_rotation_ratio: 2.0,
            vertical: false,
            further: String::new(),
        };
        let variants = [note("base", 1e-6, 1800.0), note("tight", 1e-8, 1800.0), note("light", 1e-6, 1600.0)];
        let soft = VariantNote { further: "bed = 1".into(), ..note("soft", 1e-6, 1800.0) };
        let variants = [&variants[..], &[soft]].concat();
        assert_eq!(kin(&variants, 0), ["base", "tight"]);
        assert_eq!((kin(&variants, 1), kin(&variants, 2)), (vec!["tight"], vec!["light"]));
    }
}
