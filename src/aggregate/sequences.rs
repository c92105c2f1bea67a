//! What a record does after others: each wall under it beside the same wall as it was built, row by row.
//!
//! A wall is compared where it stood the parts before and neither of the two runs failed. The ratio is of the largest
//! rotations, each over the slenderness angle of its body as built, the larger of the two bodies. It is told of walls that
//! stand the record alone and rotate under it; one that falls after the others ranks above all numbers.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use polars::prelude::PolarsResult;

use super::medians::VariantNote;
use super::resampled::{Interval, Resampled, intervals};
use super::stored::Row;
use super::variants::variant_notes;
use crate::error::{Error, Result};
use crate::store::frame::{Frame, read};
use crate::study::runs::{Completeness, run_files};
use mrbd_statistics::censored_quantile;

const COLUMNS: [&str; 16] = [
    "run",
    "variant",
    "configuration",
    "sequence",
    "part",
    "alone",
    "record",
    "parameter",
    "level",
    "draw",
    "slenderness",
    "outcome",
    "theta1_max_rad",
    "theta2_max_rad",
    "alpha1_rad",
    "alpha2_rad",
];

/// Levels of the quantiles of ratios.
pub const RATIO_LEVELS: [f64; 3] = [0.16, 0.50, 0.84];

/// A wall under a part after the others, beside the same under its record alone.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Pair {
    /// What tells the wall apart among those of its floor.
    pub wall: WallKey,
    /// Records of its sequence.
    pub records: BTreeSet<String>,
    /// How the two compare.
    pub compared: Compared,
}

/// Draw, or parameter, level and slenderness.
pub(super) type WallKey = (Option<u64>, Option<String>, Option<String>, u64);

/// How the two runs of a wall compare.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Compared {
    /// It had fallen before.
    FellBefore,
    /// One of the two runs failed, or one before.
    Failed,
    /// It stood what came before: did it fall after that, did it fall alone, and rotation after over alone.
    Both { fell_after: bool, fell_alone: bool, ratio: Option<f64> },
}

/// What a later part does after those before it, over the walls of a floor under one sequence or all.
#[derive(Debug, Clone, PartialEq)]
pub struct After {
    /// Name of the set of assumptions.
    pub variant: String,
    /// How the floor runs.
    pub configuration: String,
    /// The sequence; none over all of them.
    pub sequence: Option<String>,
    /// The part, from 1; 2 or more.
    pub part: u64,
    /// Walls, each once a sequence.
    pub walls: u64,
    /// Of these, those of which a run failed.
    pub failed: u64,
    /// Those that had fallen in a part before.
    pub fell_before: u64,
    /// Those that fall in this part after the others.
    pub fell_after: u64,
    /// Those that fall under its record alone.
    pub fell_alone: u64,
    /// Those that fall after the others and stand it alone.
    pub fell_only_after: u64,
    /// Those that fall alone and stand it after the others.
    pub fell_only_alone: u64,
    /// Walls that stand alone and rotate: those of the ratio.
    pub ratios: u64,
    /// Quantiles of rotation after over rotation alone at [`RATIO_LEVELS`]; none where they are falls.
    pub ratio: [Option<f64>; 3],
    /// 90 % interval of its median; none of too few records and walls.
    pub ratio_interval: Option<Interval>,
    /// 90 % interval of [`After::share_only_after`].
    pub share_interval: Option<Interval>,
}

impl After {
    /// Walls that are compared: those that stood the parts before, without failures.
    pub fn compared(&self) -> u64 {
        self.walls - self.failed - self.fell_before
    }

    /// Of the walls that stand the parts before, and the record alone, the share that falls under it after them.
    pub fn share_only_after(&self) -> Option<f64> {
        let stand_alone = self.compared() - self.fell_alone;
        (stand_alone > 0).then(|| self.fell_only_after as f64 / stand_alone as f64)
    }
}

/// What a study of sequences tells.
#[derive(Debug, Clone, PartialEq)]
pub struct Sequences {
    /// Variants in the order of the plan.
    pub variants: Vec<VariantNote>,
    /// How much of its plan the study has run; `None` where nobody knows.
    pub completeness: Option<Completeness>,
    /// Over all sequences first, then one by one, in the order of the plan.
    pub rows: Vec<After>,
}

/// Reads the study of sequences in a folder.
///
/// # Errors
/// An input error for a folder without results; [`Error::Table`] for files that cannot be read.
pub fn sequences(folder: &Path) -> Result<Sequences> {
    let files = run_files(folder)?;
    let completeness = Completeness::of_files(folder, &files)?;
    let read = of_files(&files).map_err(|e| Error::table(folder, e))?;
    Ok(Sequences { completeness, ..read })
}

fn of_files(files: &[PathBuf]) -> PolarsResult<Sequences> {
    let frame = read(files, &COLUMNS)?.sorted_by(&["run"])?;
    let pairs = pairs(&frame)?;
    let mut groups = BTreeMap::<_, (usize, Vec<&Pair>)>::new();
    for (order, (place, pair)) in pairs.iter().enumerate() {
        for sequence in [None, Some(place.sequence.as_str())] {
            let key = (sequence, place.variant.as_str(), place.configuration.as_str(), place.part);
            groups.entry(key).or_insert_with(|| (order, Vec::new())).1.push(pair);
        }
    }
    let mut groups: Vec<_> = groups.into_iter().collect();
    groups.sort_by_key(|((sequence, ..), (order, _))| (sequence.is_some(), *order));
    let rows = groups.into_iter().map(|((sequence, variant, configuration, part), (_, pairs))| {
        let place = Place {
            sequence: sequence.unwrap_or_default().to_owned(),
            variant: variant.to_owned(),
            configuration: configuration.to_owned(),
            part,
        };
        after(place, sequence.is_some(), &pairs)
    });
    Ok(Sequences { variants: variant_notes(files)?, completeness: None, rows: rows.collect() })
}

/// Where a pair belongs.
#[derive(Debug, Clone, PartialEq)]
struct Place {
    sequence: String,
    variant: String,
    configuration: String,
    part: u64,
}

/// The later parts beside the same records alone, in the order of the plan; a part without its other run is left out.
fn pairs(frame: &Frame) -> PolarsResult<Vec<(Place, Pair)>> {
    let records = records(frame)?;
    let mut alone = BTreeMap::new();
    let mut later = Vec::new();
    for row in 0..frame.height() {
        let run = Row { frame, row };
        let place = Place {
            sequence: run.text("sequence")?,
            variant: run.text("variant")?,
            configuration: run.text("configuration")?,
            part: run.count("part")?,
        };
        let wall: WallKey = (
            frame.counts("draw")?.get(row),
            run.optional_text("parameter")?,
            run.optional_text("level")?,
            run.number("slenderness")?.to_bits(),
        );
        if frame.flags("alone")?.get(row) == Some(true) {
            alone.insert(key(&place, &wall), run);
        } else if place.part > 1 {
            later.push((place, wall, run));
        }
    }
    let paired = later.into_iter().filter_map(|(place, wall, run)| {
        let beside = *alone.get(&key(&place, &wall))?;
        let records = records.get(&place.sequence)?.clone();
        Some(compared(run, beside).map(|compared| (place, Pair { wall, records, compared })))
    });
    paired.collect()
}

fn key(place: &Place, wall: &WallKey) -> (String, String, String, u64, WallKey) {
    let Place { sequence, variant, configuration, part } = place.clone();
    (sequence, variant, configuration, part, wall.clone())
}

/// Records by sequence.
fn records(frame: &Frame) -> PolarsResult<BTreeMap<String, BTreeSet<String>>> {
    let mut records = BTreeMap::<String, BTreeSet<String>>::new();
    let (sequences, names) = (frame.texts("sequence")?, frame.texts("record")?);
    for row in 0..frame.height() {
        if let (Some(sequence), Some(record)) = (sequences.get(row), names.get(row))
            && !records.get(sequence).is_some_and(|of| of.contains(record))
        {
            records.entry(sequence.to_owned()).or_default().insert(record.to_owned());
        }
    }
    Ok(records)
}

fn compared(after: Row, alone: Row) -> PolarsResult<Compared> {
    let fell = |outcome: &str| match outcome {
        "stood" => Some(false),
        "collapsed" => Some(true),
        _ => None,
    };
    let outcome = after.text("outcome")?;
    if outcome == "collapsed before" {
        return Ok(Compared::FellBefore);
    }
    let (Some(fell_after), Some(fell_alone)) = (fell(&outcome), fell(&alone.text("outcome")?)) else {
        return Ok(Compared::Failed);
    };
    let alpha_rad = [alone.number("alpha1_rad")?, alone.number("alpha2_rad")?];
    let largest = |run: Row| -> PolarsResult<f64> {
        let theta_rad = [run.number("theta1_max_rad")?, run.number("theta2_max_rad")?];
        Ok((theta_rad[0] / alpha_rad[0]).max(theta_rad[1] / alpha_rad[1]))
    };
    let by_itself = largest(alone)?;
    let rotates = !fell_alone && by_itself > 0.0;
    let ratio = if rotates { Some(largest(after)? / by_itself) } else { None };
    Ok(Compared::Both { fell_after, fell_alone, ratio })
}

fn after(place: Place, of_one: bool, pairs: &[&Pair]) -> After {
    let count =
        |holds: fn(&Compared) -> bool| pairs.iter().filter(|pair| holds(&pair.compared)).count() as u64;
    let both = |fell: [bool; 2]| {
        let is = |pair: &&&Pair| matches!(pair.compared, Compared::Both { fell_after, fell_alone, .. } if [fell_after, fell_alone] == fell);
        pairs.iter().filter(is).count() as u64
    };
    let (mut standing, mut fallen) = (Vec::new(), 0);
    for pair in pairs {
        match pair.compared {
            Compared::Both { ratio: Some(_), fell_after: true, .. } => fallen += 1,
            Compared::Both { ratio: Some(ratio), .. } => standing.push(ratio),
            _ => {}
        }
    }
    standing.sort_unstable_by(f64::total_cmp);
    let Resampled { ratio, share } = intervals(pairs);
    let [fell_both, fell_only_after, fell_only_alone] = [[true; 2], [true, false], [false, true]].map(both);
    After {
        variant: place.variant,
        configuration: place.configuration,
        sequence: of_one.then_some(place.sequence),
        part: place.part,
        walls: pairs.len() as u64,
        failed: count(|compared| *compared == Compared::Failed),
        fell_before: count(|compared| *compared == Compared::FellBefore),
        fell_after: fell_both + fell_only_after,
        fell_alone: fell_both + fell_only_alone,
        fell_only_after,
        fell_only_alone,
        ratios: (standing.len() + fallen) as u64,
        ratio: RATIO_LEVELS.map(|level| censored_quantile(&standing, fallen, level)),
        ratio_interval: ratio,
        share_interval: share,
    }
}
