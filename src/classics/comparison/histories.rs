//! Histories of the three models under one record (Fig. 9).

use std::path::Path;

use rayon::prelude::*;

use super::{Case, ComparisonRow, ComparisonTable, MODELS};
use crate::error::Result;
use crate::store::{Column, Read, write_table};
use mrbd_kernel::model::Contact;
use mrbd_kernel::simulate::{Accuracy, History, Shaking, simulate_observed};

/// Time between rows, s: a hundred in a swing of such walls.
const STEP_S: f64 = 0.02;

/// One instant of one run.
#[derive(Debug, Clone, PartialEq)]
pub struct HistoryPoint {
    law: &'static str,
    record: String,
    scale: f64,
    model: &'static str,
    time_s: f64,
    theta_over_alpha: [f64; 2],
    contact: Contact,
}

static COLUMNS: [Column<HistoryPoint>; 8] = [
    Column::input("law", "", "impact law", Read::Text(|p| Some(p.law.into()))),
    Column::input("record", "", "record", Read::Text(|p| Some(p.record.as_str().into()))),
    Column::input("scale", "", "factor on the record", Read::Number(|p| Some(p.scale))),
    Column::input("model", "", "calibrated, updated or lumped", Read::Text(|p| Some(p.model.into()))),
    Column::input("time_s", "s", "time, to the end or the collapse", Read::Number(|p| Some(p.time_s))),
    Column::result(
        "theta1_over_alpha1",
        "",
        "rotation of the lower body over its α_1",
        Read::Number(|p| Some(p.theta_over_alpha[0])),
    ),
    Column::result(
        "theta2_over_alpha2",
        "",
        "rotation of the upper body over its α_2",
        Read::Number(|p| Some(p.theta_over_alpha[1])),
    ),
    Column::result("pattern", "", "pattern", Read::Text(|p| Some(p.contact.name().into()))),
];

/// The histories under one record, at every scale and under every law.
pub(super) fn histories(
    cases: &[Case],
    rows: &[[ComparisonRow; 3]],
    settings: &ComparisonTable,
) -> Vec<HistoryPoint> {
    let Some(chosen) = liveliest(rows) else { return Vec::new() };
    let own = cases.par_iter().filter(|case| case.name == chosen);
    own.flat_map_iter(|case| (0..MODELS.len()).flat_map(|model| history(case, model, settings))).collect()
}

/// Of the records under which the calibrated model stands most often, the one that turns it most.
fn liveliest(rows: &[[ComparisonRow; 3]]) -> Option<String> {
    let motion = |record: &str| {
        let own = rows.iter().map(|case| &case[0]).filter(|row| row.record == record);
        let stood = own.filter(|row| row.outcome == "stood");
        let size = |row: &ComparisonRow| row.theta1_max_over_alpha1.max(row.theta2_max_over_alpha2);
        (stood.clone().count(), stood.map(size).sum::<f64>())
    };
    let records = rows.iter().map(|case| case[0].record.as_str());
    // The first of equal ones, in the order of the suite.
    let mut best: Option<(&str, (usize, f64))> = None;
    for record in records {
        let size = motion(record);
        if best.is_none_or(|(_, most)| size > most) {
            best = Some((record, size));
        }
    }
    best.map(|(record, _)| record.to_owned())
}

fn history(case: &Case, model: usize, settings: &ComparisonTable) -> Vec<HistoryPoint> {
    let wall = &case.models[model];
    let shaking =
        Shaking { horizontal: Some(case.record.scaled(case.scale)), vertical: None, tail_s: settings.tail_s };
    let mut history = History::new(STEP_S);
    simulate_observed(wall, &shaking, Accuracy { tolerance: settings.tolerance }, &mut history);
    let alpha = wall.alpha_i_rad();
    let point = |row: mrbd_kernel::simulate::HistoryRow| HistoryPoint {
        law: case.law.name(),
        record: case.name.clone(),
        scale: case.scale,
        model: MODELS[model],
        time_s: row.time_s,
        theta_over_alpha: [0, 1].map(|i| row.theta_rad[i] / alpha[i]),
        contact: row.contact,
    };
    history.rows.into_iter().map(point).collect()
}

/// Writes histories as Parquet.
///
/// # Errors
/// [`crate::Error::Table`] or [`mrbd_files::Error::Io`] if the disk refuses.
pub fn write_histories(path: &Path, histories: &[HistoryPoint]) -> Result<()> {
    write_table(path, &COLUMNS, &[], histories)
}
