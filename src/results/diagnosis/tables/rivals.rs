//! `rivals.parquet`: every hypothesis that was tried.

use std::path::Path;

use super::Tables;
use crate::error::Result;
use crate::store::{Column, Read, write_table};
use mrbd_lab::diagnose::trials::{Tried, against, kinds};

/// One number of one hypothesis.
#[derive(Debug, Clone)]
struct Row {
    rank: u64,
    name: String,
    place: &'static str,
    is_answer: bool,
    parameter: String,
    unit: &'static str,
    value: f64,
    sd: Option<f64>,
    error: [Option<f64>; 2],
    against: f64,
}

static COLUMNS: [Column<Row>; 11] = [
    Column::input("rank", "", "1: what least speaks against", Read::Count(|r| Some(r.rank))),
    Column::input("name", "", "what is added to the wall", Read::Text(|r| Some(r.name.as_str().into()))),
    Column::input("place", "", "where it acts", Read::Text(|r| Some(r.place.into()))),
    Column::input(
        "is_answer",
        "",
        "an effect, no number of the wall and no placebo",
        Read::Flag(|r| Some(r.is_answer)),
    ),
    Column::input("parameter", "", "its number", Read::Text(|r| Some(r.parameter.as_str().into()))),
    Column::input("unit", "", "unit of the value", Read::Text(|r| Some(r.unit.into()))),
    Column::result("value", "", "fitted value", Read::Number(|r| Some(r.value))),
    Column::result("sd", "", "standard deviation by the curvature of the fit", Read::Number(|r| r.sd)),
    Column::result(
        "error_fit",
        "",
        "windowed error over the noise, tests to fit",
        Read::Number(|r| r.error[0]),
    ),
    Column::result("error_held_out", "", "the same, tests held out", Read::Number(|r| r.error[1])),
    Column::result(
        "against",
        "",
        "what speaks against it, natural logarithms of likelihood",
        Read::Number(|r| Some(r.against)),
    ),
];

impl Tables<'_> {
    pub(super) fn write_rivals(&self, path: &Path) -> Result<()> {
        let rows =
            self.diagnosis.found.tried.iter().zip(1..).flat_map(|(tried, rank)| self.rival(tried, rank));
        write_table(path, &COLUMNS, &[], &rows.collect::<Vec<_>>())
    }

    fn rival(&self, tried: &Tried, rank: u64) -> Vec<Row> {
        let data = self.diagnosis.data(self.experiment);
        let h = &tried.hypothesis;
        let row = |i: usize| Row {
            rank,
            name: h.additions.iter().map(|a| a.name()).collect::<Vec<_>>().join(" + "),
            place: h.additions.first().map_or("none", |a| a.place()),
            is_answer: kinds(tried).is_some(),
            parameter: h.unknowns[i].key.clone(),
            unit: h.unknowns[i].unit,
            value: tried.fit.values[i],
            sd: tried.fit.covariance.as_ref().map(|c| c[(i, i)].max(0.0).sqrt()),
            error: tried.errors(),
            against: against(&data, tried),
        };
        (h.nuisances..h.unknowns.len()).map(row).collect()
    }
}
