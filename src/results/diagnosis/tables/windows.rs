//! `windows.parquet`: how well every window is followed, and what happens in it.

use std::path::Path;

use super::Tables;
use crate::error::Result;
use crate::store::{Column, Read, write_table};
use mrbd_kernel::simulate::Impacts;
use mrbd_lab::diagnose::fit::{Replay, WindowFit};
use mrbd_lab::diagnose::trials::Tried;

/// One window.
#[derive(Debug, Clone)]
struct Row {
    test: String,
    purpose: &'static str,
    from_s: f64,
    to_s: f64,
    pattern: &'static str,
    impacts: Impacts,
    /// Root of the squared error over the squared noise: before, recalibrated, after.
    error: [Option<f64>; 3],
}

macro_rules! impacts {
    ($name:literal, $meaning:literal, $l:literal) => {
        Column::result($name, "", $meaning, Read::Count(|r| Some(r.impacts.table2[$l])))
    };
}

static COLUMNS: [Column<Row>; 17] = [
    Column::input("test", "", "test", Read::Text(|r| Some(r.test.as_str().into()))),
    Column::input("use", "", "fit or hold-out", Read::Text(|r| Some(r.purpose.into()))),
    Column::input("from_s", "s", "first sample", Read::Number(|r: &Row| Some(r.from_s))).distinct(),
    Column::input("to_s", "s", "last sample", Read::Number(|r: &Row| Some(r.to_s))).distinct(),
    Column::input("pattern", "", "pattern at its start", Read::Text(|r| Some(r.pattern.into()))),
    Column::result(
        "error_before",
        "",
        "root mean square error over the noise, wall as given",
        Read::Number(|r| r.error[0]),
    ),
    Column::result(
        "error_recalibrated",
        "",
        "the same, its uncertain numbers fitted",
        Read::Number(|r| r.error[1]),
    ),
    Column::result("error_after", "", "the same, updated wall", Read::Number(|r| r.error[2])),
    impacts!("impacts_c1", "impacts 1a to 2a of the updated wall in it", 0),
    impacts!("impacts_c2", "2a to 1a", 1),
    impacts!("impacts_c3", "1a to 2b", 2),
    impacts!("impacts_c4", "2a to 1b", 3),
    impacts!("impacts_c5", "3a to 1b", 4),
    impacts!("impacts_c6", "3a to 3b", 5),
    impacts!("impacts_c7", "1a to 3a", 6),
    impacts!("impacts_c8", "2a to 3a", 7),
    Column::result("impacts_other", "", "impacts not in Table 2", Read::Count(|r| Some(r.impacts.other))),
];

impl Tables<'_> {
    pub(super) fn write_windows(&self, path: &Path) -> Result<()> {
        let replay = Replay::new(&self.experiment.tests, &self.physics[1]);
        let after = self.diagnosis.found.kept();
        let fits = [&self.diagnosis.found.before, &self.diagnosis.found.recalibrated, after].map(fits_of);
        let row = |(i, (window, x)): (usize, (&mrbd_lab::diagnose::measured::Window, &[f64]))| {
            let test = &self.experiment.tests[window.test];
            Row {
                test: test.name.clone(),
                purpose: test.purpose.name(),
                from_s: test.time_s[window.samples.start],
                to_s: test.time_s[window.samples.end - 1],
                pattern: window.freedom.state(x).1.name(),
                impacts: replay.run(window, x, &mut ()).impacts,
                error: fits.each_ref().map(|fits| Some(fits[i].reduced().sqrt()).filter(|e| e.is_finite())),
            }
        };
        let mut rows = self.windows_of(after).enumerate().map(row).collect::<Vec<_>>();
        let order = |r: &Row| self.experiment.tests.iter().position(|t| t.name == r.test);
        rows.sort_by(|a, b| {
            (order(a), a.from_s).partial_cmp(&(order(b), b.from_s)).unwrap_or(std::cmp::Ordering::Equal)
        });
        write_table(path, &COLUMNS, &[], &rows)
    }
}

/// Windows to fit, then those held out.
fn fits_of(tried: &Tried) -> Vec<&WindowFit> {
    tried.fit.windows.iter().chain(&tried.held_out.windows).collect()
}
