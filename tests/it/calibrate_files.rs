//! Measured files as laboratories have them, and what the door refuses.

use std::path::Path;

use mrbd_kernel::model::ImpactLaw;
use mrbd_lab::calibrate::{Experiment, simulate};
use tempfile::TempDir;

use crate::calibrate_support::{TRUE, Twin};

/// An experiment of one test whose measured file a function has rewritten, line by line (header and time given).
pub fn rewritten(
    lines: &str,
    rewrite: impl Fn(usize, f64, [f64; 2]) -> Option<String>,
) -> (TempDir, Experiment) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let twin = Twin { scales: vec![0.7], test_lines: lines.into(), ..Twin::of(ImpactLaw::Contact) };
    let path = twin.write(folder.path());
    let measured = folder.path().join("measured_0.csv");
    let text = std::fs::read_to_string(&measured).expect("the measured file");
    let mut out = vec![rewrite(0, f64::NAN, [f64::NAN; 2]).expect("a header")];
    for (k, line) in text.lines().skip(1).enumerate() {
        let cells = line.split(',').map(|cell| cell.parse().expect("a number")).collect::<Vec<f64>>();
        out.extend(rewrite(k + 1, cells[0], [cells[1], cells[2]]));
    }
    std::fs::write(&measured, out.join("\n")).expect("writable");
    let experiment = Experiment::load(&path, None).expect("a valid experiment");
    (folder, experiment)
}

pub fn wme_of_truth(experiment: &Experiment) -> f64 {
    let run = simulate(&experiment.space, &experiment.tests[0], &TRUE, experiment.accuracy());
    run.expect("a possible wall").wme.expect("a finished run")
}

pub const HEADER: &str = "time_s,theta1_rad,theta2_rad";

#[test]
fn analytic_other_start_times_offsets_rates_and_gaps_leave_no_misfit() {
    // Every third sample, starting 12.5 s later on another clock, with offsets, and a gap from 1.0 to 1.4 s.
    let lines = "start_s = -12.5\nrest_s = 0.2\n";
    let (_folder, experiment) = rewritten(lines, |k, t, [theta1, theta2]| {
        if k == 0 {
            return Some(HEADER.into());
        }
        let kept = k % 3 == 1 && !(1.0..1.4).contains(&t);
        kept.then(|| format!("{:?},{:?},{:?}", t + 12.5, theta1 + 0.003, theta2 - 0.002))
    });
    // Taking off an offset leaves roundings of 1e-16 rad, the clock shifts sample times by roundings of 1e-14 s.
    let wme = wme_of_truth(&experiment);
    assert!(wme < 1e-9, "{wme}");
    let counted = experiment.tests[0].target.counted_s();
    let whole = experiment.tests[0].target.end_s();
    assert!((counted[0] - (whole - 0.4)).abs() < 0.05, "{counted:?} of {whole}: the gap does not count");
}

/// A test whose clock is 12.3456 s late, at half the rate, with noise of some 1e-4 rad; its start is to be matched by a
/// wall of this file.
fn matched(wall: &str) -> mrbd_files::Result<Experiment> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let lines = "start_s = \"match\"\n";
    let twin = Twin { scales: vec![0.7], test_lines: lines.into(), ..Twin::of(ImpactLaw::Contact) };
    let path = twin.write(folder.path());
    std::fs::copy(folder.path().join(wall), folder.path().join("matching.toml")).expect("copied");
    std::fs::rename(folder.path().join("matching.toml"), folder.path().join("wall.toml")).expect("renamed");
    let measured = folder.path().join("measured_0.csv");
    let text = std::fs::read_to_string(&measured).expect("the measured file");
    let mut out = vec![HEADER.to_owned()];
    for line in text.lines().skip(1).step_by(2) {
        let cells = line.split(',').map(|cell| cell.parse().expect("a number")).collect::<Vec<f64>>();
        let noise = 1e-4 * (1e3 * cells[0]).sin();
        out.push(format!("{:?},{:?},{:?}", cells[0] + 12.3456, cells[1] + noise, cells[2] - noise));
    }
    std::fs::write(&measured, out.join("\n")).expect("writable");
    Experiment::load(&path, None)
}

#[test]
fn analytic_another_start_time_is_found_by_matching_the_first_motion() {
    let found = matched("true.toml").expect("a beginning that fits").tests[0].alignment;
    // A tenth of a sample of the record; halving ends at a microsecond.
    assert!(found.matched && (found.start_s + 12.3456).abs() < 5e-4, "{found:?}");
}

#[test]
fn rejects_a_start_time_that_the_wall_as_given_cannot_match() {
    // Its first visible motion comes after impacts that other coefficients would have made different.
    let refused = matched("wall.toml").expect_err("C_l = 1 does not fit");
    assert_eq!(refused.exit_code(), 2);
    assert!(refused.to_string().contains("the least mismatch is"), "{refused}");
}

#[test]
fn analytic_a_vertical_record_acts() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let twin = Twin {
        scales: vec![0.7],
        test_lines: "vertical = \"up.csv\"\n".into(),
        ..Twin::of(ImpactLaw::Contact)
    };
    let path = twin.write(folder.path());
    let wme = |up: f64| {
        let rows = (0..=1200)
            .map(|k| format!("{:.3},{:?}\n", 0.005 * f64::from(k), up * (0.02 * f64::from(k)).sin()));
        let text = std::iter::once("time_s,acceleration_m_s2\n".to_owned()).chain(rows).collect::<String>();
        std::fs::write(folder.path().join("up.csv"), text).expect("writable");
        wme_of_truth(&Experiment::load(&path, None).expect("a valid experiment"))
    };
    // The twin was simulated without one: none leaves no misfit, two metres a second squared some.
    assert!(wme(0.0) < 1e-9 && wme(2.0) > 0.01, "{} {}", wme(0.0), wme(2.0));
}

#[test]
fn analytic_a_lost_channel_and_missing_samples_drop_their_part_of_the_sum() {
    let (_folder, experiment) = rewritten("", |k, t, [theta1, theta2]| {
        let lost = if k % 7 == 0 { String::new() } else { format!("{:?}", 1.1 * theta1) };
        Some(if k == 0 { HEADER.into() } else { format!("{t:?},{lost},{:?}", f64::NAN * theta2) })
    });
    assert_eq!(experiment.tests[0].target.counted_s()[1], 0.0);
    // θ_1 is measured 10 % too large: |1.1 θ - θ| / |1.1 θ| at every instant.
    let wme = wme_of_truth(&experiment);
    assert!((wme - 0.1 / 1.1).abs() < 1e-9, "{wme}");
}

#[test]
fn analytic_rotations_follow_from_two_displacement_readings() {
    let (b1, b2, h1) = (0.271, 0.281, 2.191);
    let lines = "lower_reading = { column = \"low_m\", height_m = 2.0 }\n\
                 upper_reading = { column = \"high_m\", height_m = 3.5 }\n";
    let (_folder, experiment) = rewritten(lines, |k, t, [theta1, theta2]| {
        let half_1 = 0.5 * b1 * theta1.signum();
        let half_2 = 0.5 * b2 * (theta2 - theta1).signum();
        let low = 2.0 * theta1.sin() + half_1 * (1.0 - theta1.cos());
        let pivot = half_1 + (half_2 - half_1) * theta1.cos() + h1 * theta1.sin() - half_2;
        let high = pivot + (3.5 - h1) * theta2.sin() + half_2 * (1.0 - theta2.cos());
        Some(if k == 0 { "time_s,low_m,high_m".into() } else { format!("{t:?},{low:?},{high:?}") })
    });
    let wme = wme_of_truth(&experiment);
    // Roundings, magnified where a reading is a difference of larger numbers.
    assert!(wme < 1e-9, "{wme}");
}

#[test]
fn analytic_nothing_counts_after_a_measured_collapse_or_outside_windows() {
    let spoiled = |from: f64| {
        move |k: usize, t: f64, [theta1, theta2]: [f64; 2]| {
            let error = if t > from { 0.05 } else { 0.0 };
            Some(if k == 0 { HEADER.into() } else { format!("{t:?},{:?},{theta2:?}", theta1 + error) })
        }
    };
    let (_a, collapsed) = rewritten("collapse_s = 2.5\n", spoiled(2.5));
    let (_b, windowed) = rewritten("windows_s = [[0.5, 1.0], [1.5, 2.0]]\n", spoiled(2.0));
    for experiment in [collapsed, windowed] {
        // Nothing but roundings of the file's numbers, which are exact.
        assert!(wme_of_truth(&experiment) < 1e-9);
    }
}

#[test]
fn analytic_a_wall_measured_at_rest_has_a_finite_misfit() {
    let (_folder, experiment) =
        rewritten("", |k, t, _| Some(if k == 0 { HEADER.into() } else { format!("{t:?},0.0,0.0") }));
    let wme = wme_of_truth(&experiment);
    assert_eq!(experiment.tests[0].target.at_rest(), [true, true]);
    // The wall rotates by up to 2 α where α / 1000 is the floor: a large number, but a number.
    assert!(wme.is_finite() && wme > 10.0, "{wme}");
}

/// What the door says of an experiment in which text has been replaced.
fn refused(file: &str, from: &str, to: &str) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let twin = Twin {
        scales: vec![0.7],
        settings: "seed = 1\ntolerance = 1e-6\nparameters = [{ key = \"C_1\" }]\n".into(),
        test_lines: "start_s = 0.0\n".into(),
        ..Twin::of(ImpactLaw::Contact)
    };
    let path = twin.write(folder.path());
    let edited = folder.path().join(file);
    let text = std::fs::read_to_string(&edited).expect("readable");
    assert!(text.contains(from), "{from} is not in {file}");
    std::fs::write(&edited, text.replacen(from, to, 1)).expect("writable");
    let error = Experiment::load(Path::new(&path), None).expect_err("must be refused");
    assert_eq!(error.exit_code(), 2, "{error}");
    error.to_string()
}

#[test]
fn rejects_faults_of_experiments_with_file_and_key() {
    let experiment = |from: &str, to: &str| refused("experiment.toml", from, to);
    assert!(experiment("seed = 1", "sead = 1").contains("sead"));
    assert!(experiment("tolerance = 1e-6", "tolerance = 0.5").contains("calibrate.tolerance: found 0.5"));
    assert!(experiment("\"C_1\"", "\"C_9\"").contains("calibrate.parameters[0].key: found \"C_9\""));
    assert!(experiment("\"C_1\"", "\"stiffness_n_per_m\"").contains("a bound, or a standard deviation"));
    let crossed = "\"C_1\", lower = 1.2, upper = 1.1";
    assert!(experiment("\"C_1\"", crossed).contains("finite bounds with lower < upper"));
    let impossible = "\"corners.lower_width_m\", lower = 0.2, upper = 0.4";
    assert!(experiment("\"C_1\"", impossible).contains("bounds of corners.lower_width_m: found 0.4"));
    assert!(experiment("start_s = 0.0", "use = \"hold-out\"").contains("at least one test with use"));
    assert!(experiment("start_s = 0.0", "use = \"train\"").contains("train"));
    assert!(experiment("start_s = 0.0", "start_s = \"soon\"").contains("finite seconds, or \"match\""));
    assert!(experiment("start_s = 0.0", "vertical_scale = 2.0").contains("beside a vertical record"));
    assert!(experiment("start_s = 0.0", "windows_s = [[2.0, 1.0]]").contains("tests[0].windows_s"));
    assert!(experiment("start_s = 0.0", "windows_s = [[90.0, 91.0]]").contains("nothing that counts"));
    assert!(experiment("record.csv", "none.csv").contains("none.csv"));
    assert!(experiment("[calibrate]", "[prior]\nmas_kg = 0.1\n[calibrate]").contains("prior.mas_kg"));
}

#[test]
fn rejects_a_prior_of_a_number_that_is_zero() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let key = "{ key = \"eccentricity_m\", lower = -0.01, upper = 0.01 }";
    let settings = format!("seed = 1\nparameters = [{key}]\n[prior]\neccentricity_m = 0.1\n");
    let twin = Twin { scales: vec![0.7], settings, ..Twin::of(ImpactLaw::Contact) };
    let path = twin.write(folder.path());
    let wall = folder.path().join("wall.toml");
    let text = std::fs::read_to_string(&wall).expect("readable");
    std::fs::write(&wall, text.replacen("[diaphragm]", "[diaphragm]\neccentricity_m = 0.0", 1))
        .expect("written");
    let told = Experiment::load(Path::new(&path), None).expect_err("must be refused").to_string();
    assert!(told.contains("calibrate.parameters[0].key") && told.contains("is 0 in the wall file"), "{told}");
}

#[test]
fn rejects_faults_of_measured_files_with_line() {
    let measured = |from: &str, to: &str| refused("measured_0.csv", from, to);
    assert!(measured("\n0.0,", "\nzero,").contains("measured_0.csv:2: found \"zero\" under time_s"));
    assert!(measured("\n0.01,", "\n0.001,").contains("measured_0.csv:4: found time_s 0.001"));
    assert!(measured("time_s", "t").contains("a column time_s"));
    assert!(measured("theta1_rad,theta2_rad", "a,b").contains("found columns time_s, a, b"));
    let twice = "time_s,theta1_rad\n0.0,0.0,0.0\n";
    assert!(measured("time_s,theta1_rad,theta2_rad\n", twice).contains("measured_0.csv:2"));
}
