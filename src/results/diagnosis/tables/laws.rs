//! `laws.parquet`: what the best hypotheses add to the force at the top.

use std::path::Path;

use super::Tables;
use crate::error::Result;
use crate::store::{Column, Read, write_table};

/// One point of a curve.
#[derive(Debug, Clone)]
struct Row {
    name: String,
    against: &'static str,
    x: f64,
    force_n: f64,
}

static COLUMNS: [Column<Row>; 4] = [
    Column::input("name", "", "hypothesis", Read::Text(|r| Some(r.name.as_str().into()))),
    Column::input(
        "against",
        "",
        "column of force.parquet that x is of",
        Read::Text(|r| Some(r.against.into())),
    ),
    Column::input(
        "x",
        "",
        "displacement, velocity or absolute acceleration of the top, SI",
        Read::Number(|r: &Row| Some(r.x)),
    )
    .distinct(),
    Column::result(
        "force_n",
        "N",
        "force that the hypothesis adds at the top",
        Read::Number(|r| Some(r.force_n)),
    ),
];

impl Tables<'_> {
    pub(super) fn write_laws(&self, path: &Path) -> Result<()> {
        let rows = self.laws.iter().flat_map(|curve| {
            let row = |&(x, force_n): &(f64, f64)| Row {
                name: curve.name.clone(),
                against: curve.against.name(),
                x,
                force_n,
            };
            curve.points.iter().map(row)
        });
        write_table(path, &COLUMNS, &[], &rows.collect::<Vec<_>>())
    }
}
