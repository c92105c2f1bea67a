//! Walls with answers from an independent program that shares no code with this one.

use std::path::Path;

use mrbd_files::load_wall;
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{Accuracy, History, Outcome, Response, Shaking, simulate_observed};
use serde::Deserialize;

use crate::shared;

#[derive(Deserialize)]
struct Case {
    record: Option<String>,
    scale: f64,
    vertical_record: Option<String>,
    vertical_scale: Option<f64>,
    dt_s: f64,
    tail_s: f64,
    capture_velocity_rad_s: f64,
    expected: Expected,
    tolerance: f64,
}

#[derive(Deserialize)]
struct Expected {
    theta1_max_over_alpha1: Option<f64>,
    theta2_max_over_alpha2: Option<f64>,
    collapsed: bool,
    collapse_time_s: Option<f64>,
}

#[derive(Deserialize)]
struct Row {
    time_s: f64,
    theta1_rad: f64,
    theta2_rad: f64,
}

fn record(folder: &Path, name: &str, dt_s: f64, scale: f64) -> Accelerogram {
    let text = std::fs::read_to_string(folder.join(name)).expect("the record");
    let samples = text.split_whitespace().map(|s| s.parse::<f64>().expect("a number") * scale).collect();
    Accelerogram::new(dt_s, samples).expect("a valid record")
}

fn shaking(case: &Case, records: &Path) -> Shaking {
    let vertical_scale = case.vertical_scale.unwrap_or(1.0);
    Shaking {
        horizontal: case.record.as_ref().map(|name| record(records, name, case.dt_s, case.scale)),
        vertical: case.vertical_record.as_ref().map(|name| record(records, name, case.dt_s, vertical_scale)),
        tail_s: case.tail_s,
    }
}

/// The wall of a case at the capture velocity of the reference.
fn wall(folder: &Path, case: &Case) -> Wall {
    let mut parameters = load_wall(&folder.join("wall.toml")).expect("the wall").parameters().clone();
    parameters.restitution.capture_velocity_rad_s = case.capture_velocity_rad_s;
    Wall::new(parameters).expect("a wall that can exist")
}

fn verify(name: &str) {
    let Some(folder) = shared::folder(&format!("verification/{name}")) else { return };
    let Some(records) = shared::folder("records/natural7") else { return };
    let text = std::fs::read_to_string(folder.join("expected.json")).expect("the answer");
    let case: Case = serde_json::from_str(&text).expect("the answer");
    let wall = wall(&folder, &case);
    let shaking = shaking(&case, &records);
    let mut history = History::new(case.dt_s);
    let response = simulate_observed(&wall, &shaking, Accuracy { tolerance: 1e-10 }, &mut history);
    compare_history(&folder, &history, &response, case.tolerance);
    compare_maxima(&case, &response);
}

fn compare_maxima(case: &Case, response: &Response) {
    let expected = &case.expected;
    assert_eq!(response.collapsed(), expected.collapsed);
    let found = response.theta_max_over_alpha_i();
    for (found, expected) in
        found.iter().zip([expected.theta1_max_over_alpha1, expected.theta2_max_over_alpha2])
    {
        if let Some(expected) = expected {
            let error = (found - expected).abs() / expected;
            assert!(error <= case.tolerance, "maximum {found} against {expected}: {error:e}");
        }
    }
    if let (Outcome::Collapsed { time_s }, Some(expected)) = (&response.outcome, expected.collapse_time_s) {
        // The reference looks for collapse at the samples only.
        assert!((time_s - expected).abs() <= case.dt_s, "collapse at {time_s} against {expected}");
    }
}

fn compare_history(folder: &Path, history: &History, response: &Response, tolerance: f64) {
    let mut reader = csv::Reader::from_path(folder.join("history.csv")).expect("the history");
    let largest = response.theta_max_rad.map(|peak| peak.value.abs());
    let mut compared = 0;
    let mut worst = (0.0, 0.0);
    for row in reader.deserialize() {
        let row: Row = row.expect("a row");
        let index = (row.time_s / history.step_s()).round() as usize;
        let Some(found) = history.rows.get(index) else {
            assert!(response.collapsed(), "no row at {} s", row.time_s);
            continue;
        };
        for (i, expected) in [row.theta1_rad, row.theta2_rad].into_iter().enumerate() {
            let error = (found.theta_rad[i] - expected).abs() / largest[i];
            worst = if error > worst.0 { (error, row.time_s) } else { worst };
        }
        compared += 1;
    }
    assert!(compared > 20, "only {compared} rows compared");
    assert!(worst.0 <= tolerance, "{:e} at {} s; allowed {tolerance:e}", worst.0, worst.1);
}

macro_rules! verified {
    ($($name:ident),* $(,)?) => { $(
        paste_test!($name);
    )* };
}

macro_rules! paste_test {
    ($name:ident) => {
        mod $name {
            #[test]
            fn verified_against_the_reference() {
                super::verify(stringify!($name));
            }
        }
    };
}

verified!(
    facade_contact_law,
    facade_parallel,
    facade_perpendicular,
    free_release_monolithic,
    free_release_two_body,
    table_wall_collapse,
    table_wall_contact_law,
    table_wall_friuli,
    table_wall_uncalibrated,
    table_wall_vertical_motion,
);
