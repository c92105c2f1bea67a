//! The tests: misfits before and after, impacts by change of pattern, and what law and capture velocity do.

use super::super::page::{Section, Table};
use super::wme;
use mrbd_lab::calibrate::{Calibration, TestResult};

/// The section.
pub fn section(stored: &Calibration) -> Section {
    let mut tables = vec![misfits(stored), transitions(stored)];
    if !stored.capture_study.is_empty() {
        tables.push(capture(stored));
    }
    Section { id: "tests".into(), title: "The tests".into(), tables, ..Section::default() }
}

fn misfits(stored: &Calibration) -> Table {
    let time = |s: Option<f64>| s.map_or("–".to_owned(), |s| format!("{s:.2} s"));
    let row = |test: &TestResult| {
        vec![
            test.name.clone(),
            if test.purpose == "fit" { "to fit" } else { "held out" }.to_owned(),
            wme(test.wme_before),
            wme(test.wme_joint),
            wme(test.wme_alone),
            time(test.measured_collapse_s),
            time(test.simulated_collapse_s),
        ]
    };
    let head = [
        "test",
        "use",
        "before",
        "calibrated",
        "best for it alone",
        "measured collapse",
        "simulated collapse",
    ];
    Table::of("WME of each test (Eq. 8)", &head, stored.tests.iter().map(row))
}

fn transitions(stored: &Calibration) -> Table {
    let row = |test: &TestResult| {
        let counts = test.transitions.iter().map(u64::to_string);
        std::iter::once(test.name.clone()).chain(counts).collect::<Vec<_>>()
    };
    let head = ["test", "C_1", "C_2", "C_3", "C_4", "C_5", "C_6", "C_7", "C_8"];
    Table::of(
        "Impacts that each coefficient scales, with the calibrated wall",
        &head,
        stored.tests.iter().map(row),
    )
}

fn capture(stored: &Calibration) -> Table {
    let rows = stored.capture_study.iter().map(|row| {
        let speed = format!("{:e} rad/s", row.capture_velocity_rad_s);
        vec![row.law.clone(), speed, wme(row.wme_of_joint), wme(row.wme_of_best)]
    });
    let head =
        ["impact law", "capture velocity", "mean WME of the calibrated wall", "mean WME of the best there"];
    Table::of("What law and capture velocity do: searches with fewer simulations", &head, rows)
}
