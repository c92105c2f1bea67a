//! `jumps.parquet`: velocities after impacts.

use std::path::Path;

use super::Tables;
use crate::error::Result;
use crate::store::{Column, Read, write_table};
use mrbd_lab::diagnose::force::Jump;

/// One change of pattern, under the wall as given or updated.
#[derive(Debug, Clone)]
struct Row {
    test: String,
    wall: &'static str,
    jump: Jump,
}

static COLUMNS: [Column<Row>; 9] = [
    Column::input("test", "", "test", Read::Text(|r| Some(r.test.as_str().into()))),
    Column::input("wall", "", "given or updated", Read::Text(|r| Some(r.wall.into()))),
    Column::input(
        "time_s",
        "s",
        "when the pattern was clear again",
        Read::Number(|r: &Row| Some(r.jump.time_s)),
    )
    .distinct(),
    Column::input(
        "pattern_before",
        "",
        "measured pattern before",
        Read::Text(|r| Some(r.jump.contacts[0].name().into())),
    ),
    Column::input(
        "pattern_after",
        "",
        "measured pattern after",
        Read::Text(|r| Some(r.jump.contacts[1].name().into())),
    ),
    Column::result(
        "impacts",
        "",
        "impacts of the model on the way",
        Read::Count(|r| Some(r.jump.impacts.total())),
    ),
    Column::result(
        "coefficient",
        "",
        "1 to 8 where its only impact is that change of Table 2",
        Read::Count(|r| r.jump.coefficient().map(|l| l as u64 + 1)),
    ),
    Column::result(
        "ratio",
        "",
        "velocities measured after it over those of the model; null where the model is in another pattern",
        Read::Number(|r| r.jump.ratio),
    ),
    Column::result(
        "ratio_sd",
        "",
        "standard deviation of the ratio by noise",
        Read::Number(|r| r.jump.ratio_sd),
    ),
];

impl Tables<'_> {
    pub(super) fn write_jumps(&self, path: &Path) -> Result<()> {
        let rows = ["given", "updated"].into_iter().enumerate().flat_map(|(which, wall)| {
            let row = move |jump: Jump| Row { test: self.test_name(jump.test).to_owned(), wall, jump };
            self.jumps_of(which).into_iter().map(row)
        });
        write_table(path, &COLUMNS, &[], &rows.collect::<Vec<_>>())
    }
}
