//! Transducers at heights: rotations come back whatever subset tells them, and what the door refuses.

use mrbd_kernel::model::ImpactLaw;
use mrbd_lab::calibrate::Experiment;

use crate::calibrate_files::{HEADER, rewritten, wme_of_truth};
use crate::calibrate_support::{Twin, record};

const WIDTHS_M: [f64; 2] = [0.271, 0.281];
const CRACK_M: f64 = 2.191;

/// Displacement at a height, m, relative to the table: written down anew, corner by corner.
fn displacement_m(y: f64, [theta1, theta2]: [f64; 2]) -> f64 {
    let half_1 = 0.5 * WIDTHS_M[0] * theta1.signum();
    if y <= CRACK_M {
        return y * theta1.sin() + half_1 * (1.0 - theta1.cos());
    }
    let half_2 = 0.5 * WIDTHS_M[1] * (theta2 - theta1).signum();
    let pivot = half_1 + (half_2 - half_1) * theta1.cos() + CRACK_M * theta1.sin() - half_2;
    pivot + (y - CRACK_M) * theta2.sin() + half_2 * (1.0 - theta2.cos())
}

/// Displacement of the table at its record's samples, m, in a test at 70 %: Simpson's rule over velocities, which are
/// parabolas between samples.
fn table_m() -> Vec<f64> {
    let (record, mut v, mut x) = (record().scaled(0.7), 0.0, 0.0);
    let h = record.step_s();
    let mut path = vec![0.0];
    for pair in record.acceleration_m_s2().windows(2) {
        let middle = v + h * (3.0 * pair[0] + pair[1]) / 8.0;
        let end = v + h * (pair[0] + pair[1]) / 2.0;
        x += h * (v + 4.0 * middle + end) / 6.0;
        v = end;
        path.push(x);
    }
    path
}

fn channel(column: &str, height_m: f64, more: &str) -> String {
    format!("[[tests.channels]]\ncolumn = \"{column}\"\nheight_m = {height_m:?}\n{more}\n")
}

/// Eq. 8 of the truth in a test of these channels, of whose columns a function makes the cells of a sample.
fn wme(lines: &str, header: &str, cells: impl Fn(usize, [f64; 2]) -> Vec<f64>) -> f64 {
    let (_folder, experiment) = rewritten(lines, |k, t, theta| {
        if k == 0 {
            return Some(format!("time_s,{header}"));
        }
        let cells = cells(k - 1, theta).iter().map(|x| format!("{x:?}")).collect::<Vec<_>>();
        Some(format!("{t:?},{}", cells.join(",")))
    });
    assert!(both_count(&experiment), "both bodies count");
    wme_of_truth(&experiment)
}

/// Whether both bodies count in all tests, to their end or the wall's fall.
fn both_count(experiment: &Experiment) -> bool {
    let counts = |test: &mrbd_lab::experiment::Test| {
        test.target.counted_s().iter().all(|counted_s| *counted_s > 0.9 * test.target.end_s())
    };
    experiment.tests.iter().all(counts)
}

// Roundings, magnified where a reading is a difference of larger numbers.
const ROUNDINGS: f64 = 1e-9;

#[test]
fn analytic_any_subset_of_channels_gives_the_rotations_back() {
    // Below and above the crack, in millimetres with the other sign.
    let lines = channel("a", 1.2, "factor = -0.001") + &channel("b", 3.5, "");
    let found =
        wme(&lines, "a,b", |_, theta| vec![-1e3 * displacement_m(1.2, theta), displacement_m(3.5, theta)]);
    assert!(found < ROUNDINGS, "below and above: {found}");
    // Two above the crack.
    let lines = channel("a", 2.6, "") + &channel("b", 3.9, "");
    let found = wme(&lines, "a,b", |_, theta| [2.6, 3.9].map(|y| displacement_m(y, theta)).to_vec());
    assert!(found < ROUNDINGS, "both above: {found}");
    // A rotation of one body by its name, and one channel.
    let lines = channel("a", 3.5, "");
    let found = wme(&lines, "a,theta2_rad", |_, theta| vec![displacement_m(3.5, theta), theta[1]]);
    assert!(found < ROUNDINGS, "with a rotation: {found}");
    // The crack by its column's name, and one channel above it.
    let found = wme(&lines, "a,crack_displacement_m", |_, theta| {
        vec![displacement_m(3.5, theta), displacement_m(CRACK_M, theta)]
    });
    assert!(found < ROUNDINGS, "with a named column: {found}");
}

#[test]
fn analytic_more_channels_than_rotations_agree_and_a_missing_one_is_no_loss() {
    let heights = [0.8, 2.0, 2.6, 3.9];
    let names = ["a", "b", "c", "d"];
    let lines = heights.iter().zip(names).map(|(y, name)| channel(name, *y, "noise_m = 1e-3"));
    let found = wme(&lines.collect::<String>(), "a,b,c,d", |k, theta| {
        let lost = |j: usize| k % 7 == j || (j == 1 && k > 300);
        let read = |(j, y): (usize, &f64)| if lost(j) { f64::NAN } else { displacement_m(*y, theta) };
        heights.iter().enumerate().map(read).collect()
    });
    assert!(found < ROUNDINGS, "{found}");
}

#[test]
fn analytic_absolute_displacements_lose_the_path_of_the_table() {
    let path = table_m();
    // After the record's last sample it moves on as it did.
    let at = |k: usize| match path.get(k) {
        Some(x) => *x,
        None => path[1200] + (k - 1200) as f64 * (path[1200] - path[1199]),
    };
    let absolute = "frame = \"absolute\"";
    let lines = channel("a", 1.2, absolute) + &channel("b", 3.5, absolute);
    let cells = |k: usize, theta: [f64; 2]| [1.2, 3.5].map(|y| displacement_m(y, theta) + at(k)).to_vec();
    let found = wme(&format!("windows_s = [[0.0, 5.9]]\n{lines}"), "a,b", cells);
    // The integral of some 1200 samples: roundings of 1e-13 m over arms of metres.
    assert!(found < ROUNDINGS, "the record integrated: {found}");
    // A column of the table instead, whatever it says; here it does not follow the record.
    let other = |k: usize| 0.01 * (0.003 * k as f64).sin();
    let lines = lines + &channel("table", 0.0, "frame = \"absolute\"\nfactor = 0.001");
    let found = wme(&lines, "a,b,table", |k, theta| {
        vec![displacement_m(1.2, theta) + other(k), displacement_m(3.5, theta) + other(k), 1e3 * other(k)]
    });
    assert!(found < ROUNDINGS, "a column of the table: {found}");
}

#[test]
fn analytic_channels_of_the_experiment_serve_every_test_without_its_own() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let twin = Twin { scales: vec![0.7, 0.8], ..Twin::of(ImpactLaw::Contact) };
    let path = twin.write(folder.path());
    for k in 0..2 {
        let file = folder.path().join(format!("measured_{k}.csv"));
        let text = std::fs::read_to_string(&file).expect("the measured file");
        let mut rows = text.lines();
        assert_eq!(rows.next(), Some(HEADER));
        let moved = rows.map(|line| {
            let cells = line.split(',').map(|cell| cell.parse().expect("a number")).collect::<Vec<f64>>();
            let theta = [cells[1], cells[2]];
            format!("{:?},{:?},{:?}\n", cells[0], displacement_m(2.0, theta), displacement_m(3.0, theta))
        });
        std::fs::write(&file, format!("time_s,low,high\n{}", moved.collect::<String>())).expect("writable");
    }
    let text = std::fs::read_to_string(&path).expect("the experiment");
    let shared =
        "[[channels]]\ncolumn = \"low\"\nheight_m = 2.0\n[[channels]]\ncolumn = \"high\"\nheight_m = 3.0\n";
    std::fs::write(&path, format!("{text}\n{shared}")).expect("writable");
    let experiment = Experiment::load(&path, None).expect("a valid experiment");
    assert!(wme_of_truth(&experiment) < ROUNDINGS);
    assert!(both_count(&experiment));
}

/// What the door says of channels over columns `a`, `b`, `theta2_rad` and `top_displacement_m`.
fn refused(lines: &str, header: &str) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let twin = Twin { scales: vec![0.7], test_lines: lines.into(), ..Twin::of(ImpactLaw::Contact) };
    let path = twin.write(folder.path());
    let rows = (0..400).map(|k| {
        let (t, x) = (0.005 * f64::from(k), 0.01 * (0.05 * f64::from(k)).sin());
        let cells = (0..header.split(',').count()).map(|j| format!(",{:?}", x * (1.0 + j as f64)));
        format!("{t:?}{}\n", cells.collect::<String>())
    });
    let text = format!("time_s,{header}\n{}", rows.collect::<String>());
    std::fs::write(folder.path().join("measured_0.csv"), text).expect("writable");
    let error = Experiment::load(&path, None).expect_err(lines);
    assert_eq!(error.exit_code(), 2, "{error}");
    error.to_string()
}

#[test]
fn rejects_channels_that_cannot_be_with_file_key_and_what_is_allowed() {
    let (a, b) = (channel("a", 1.0, ""), channel("b", 3.0, ""));
    let absolute = channel("a", 1.0, "frame = \"absolute\"");
    let free = |lines: &str| lines.replace("[[tests", "release_s = 0.5\n[[tests");
    let cases = [
        (channel("a", 4.2, ""), "channels[0].height_m: found 4.2", "up to the top of the wall at 3.984 m"),
        (channel("a", -1.0, ""), "channels[0].height_m: found -1", "metres above the base"),
        (
            a.clone() + &channel("b", 1.0, ""),
            "channels[1].height_m: found 1, as column \"a\"",
            "each height once",
        ),
        (a.clone() + &channel("a", 2.0, ""), "channels[1].column: found \"a\" again", "each column once"),
        (channel("c", 1.0, ""), "no column \"c\", which tests[0].channels[0].column", "one of time_s, a, b"),
        (channel("", 1.0, ""), "channels[0].column", "a column's name"),
        (channel("a", 1.0, "frame = \"table\""), "unknown variant `table`", "`ground` or `absolute`"),
        (
            channel("a", 0.0, ""),
            "channels[0].frame: found the ground, at height 0",
            "the table's displacement",
        ),
        (channel("a", 1.0, "factor = 0.0"), "channels[0].factor: found 0", "not 0"),
        (channel("a", 1.0, "noise_m = -1.0"), "channels[0].noise_m", "above 0"),
        (channel("a", 1.0, "sign = 1.0"), "unknown field `sign`", "column"),
        (
            a.clone() + &channel("b", 0.0, "frame = \"absolute\""),
            "channels[1].height_m: found 0, the table, which no channel needs",
            "beside a channel with frame = \"absolute\"",
        ),
        (
            format!("start_s = \"match\"\n{absolute}{b}"),
            "channels[0].frame: found \"absolute\", and test \"70 %\" has start_s",
            "start_s in seconds",
        ),
        (
            format!("lower_reading = {{ column = \"a\", height_m = 1.0 }}\n{b}"),
            "channels[0]: found channels beside lower_reading",
            "one way",
        ),
        (format!("top_held = true\n{}", channel("a", 3.984, "")), "which is held", "no top_held"),
        (
            b.clone(),
            "displacements above the crack, which move with both bodies",
            "a channel up to the crack",
        ),
    ];
    for (lines, found, allowed) in &cases {
        let message = refused(lines, "a,b");
        assert!(message.contains(found) && message.contains(allowed), "{lines}: {message}");
    }
    let twice = refused(&(a.clone() + &channel("b", 3.984, "")), "a,b,top_displacement_m");
    assert!(twice.contains("columns top_displacement_m and \"b\", both at 3.984 m"), "{twice}");
    let contradict = refused(&(a + &channel("b", 2.0, "factor = -1.0") + &b.replace('b', "c")), "a,b,c");
    assert!(contradict.contains("contradicts the others by"), "{contradict}");
    let unshaken = free(&absolute);
    let text = format!("wall = \"w.toml\"\n[[tests]]\nname = \"one\"\nmeasured = \"m.csv\"\n{unshaken}");
    let path = std::path::Path::new("experiment.toml");
    let error =
        mrbd_lab::experiment_file::ExperimentFile::parse(path, &text).expect_err("no record").to_string();
    assert!(error.contains("tests[0].channels[0].frame") && error.contains("has no record"), "{error}");
}
