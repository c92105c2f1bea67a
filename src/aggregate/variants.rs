//! The variants of a study, as their runs tell them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use polars::prelude::PolarsResult;

use super::group::{Group, in_plan_order};
use super::medians::VariantNote;
use super::stored::Row;
use crate::error::Result;
use crate::store::frame::read;
use crate::study::runs::Manifest;

/// What is counted over all runs.
const COUNTED: [&str; 5] = ["run", MEMBER_OF, "variant", "outcome", "energy_residual"];

/// What all runs of a variant share.
const SHARED: [&str; 12] = [
    MEMBER_OF,
    "variant",
    "length_m",
    "density_kg_m3",
    "law",
    "capture_velocity_rad_s",
    "tolerance",
    "suite",
    "suite_generated",
    "tail_s",
    "collapse_rotation_ratio",
    "vertical",
];

/// The column that is null for runs as they are planned, and names the variant of whose ensemble others are members.
pub(super) const MEMBER_OF: &str = "member_of";

/// Assumptions that no column of the runs has.
const FURTHER: [&str; 3] = ["bed", "crushing_stays", "floor_yield_m"];

/// Variants with what the manifest of their study says of them beside the columns of the runs.
///
/// # Errors
/// A manifest that cannot be read.
pub(super) fn with_further(mut notes: Vec<VariantNote>, folder: &Path) -> Result<Vec<VariantNote>> {
    let manifest = Manifest::read(&folder.join("manifest.json"))?;
    let all = manifest.and_then(|manifest| manifest.variants.as_array().cloned()).unwrap_or_default();
    for note in &mut notes {
        let own = all.iter().find(|variant| variant["name"] == note.name.as_str());
        let told = |key: &&str| Some(format!("{key} = {}", own?["assumptions"].get(*key)?));
        note.further = FURTHER.iter().filter_map(told).collect::<Vec<_>>().join(", ");
    }
    Ok(notes)
}

/// The variants in the order of the plan.
///
/// # Errors
/// Files that cannot be read, and runs without a value that every run has.
pub(super) fn variant_notes(files: &[PathBuf]) -> PolarsResult<Vec<VariantNote>> {
    let mut notes = counted(files)?;
    // File by file until all are told of: as a rule the first is enough, and a million runs need not stand in memory.
    let mut untold: BTreeSet<String> = notes.iter().map(|note| note.name.clone()).collect();
    for file in files {
        if untold.is_empty() {
            break;
        }
        let frame = read(std::slice::from_ref(file), &SHARED)?.with_null(MEMBER_OF)?;
        for group in frame.groups(&["variant"])?.iter() {
            let Some(&row) = group.first() else { continue };
            let first = Row { frame: &frame, row };
            let name = first.text("variant")?;
            if untold.remove(&name) {
                let mut told = notes.iter_mut().filter(|note| note.name == name);
                told.try_for_each(|note| tell_shared(note, first))?;
            }
        }
    }
    Ok(notes)
}

/// How many runs of each variant ended how, without what they share.
fn counted(files: &[PathBuf]) -> PolarsResult<Vec<VariantNote>> {
    let frame = read(files, &COUNTED)?.with_null(MEMBER_OF)?;
    let (outcomes, residuals) = (frame.texts("outcome")?, frame.numbers("energy_residual")?);
    let note = |group: &Group| {
        Ok(VariantNote {
            name: group.first(&frame).text("variant")?,
            runs: group.len(),
            collapsed: group.how_many(outcomes, "collapsed"),
            failed: group.how_many(outcomes, "failed"),
            energy_residual: group.rows.iter().filter_map(|&row| residuals.get(row)).reduce(f64::max),
            ..VariantNote::default()
        })
    };
    in_plan_order(&frame, &["variant"])?.iter().map(note).collect()
}

/// What the first run of a variant says of all.
fn tell_shared(note: &mut VariantNote, first: Row) -> PolarsResult<()> {
    note.length_m = first.number("length_m")?;
    note.density_kg_m3 = first.number("density_kg_m3")?;
    note.law = first.text("law")?;
    note.capture_velocity_rad_s = first.number("capture_velocity_rad_s")?;
    note.tolerance = first.number("tolerance")?;
    note.suite = first.text("suite")?;
    note.suite_generated = first.frame.flags("suite_generated")?.get(first.row).unwrap_or(false);
    note.tail_s = first.number("tail_s")?;
    note.collapse_rotation_ratio = first.number("collapse_rotation_ratio")?;
    note.vertical = first.frame.flags("vertical")?.get(first.row).unwrap_or(false);
    Ok(())
}
