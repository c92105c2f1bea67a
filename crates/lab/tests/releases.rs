//! Releases of a strip whose top is held, as laboratories have them: one displacement, unevenly sampled.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use mrbd_kernel::model::{Bed, G_M_S2, RockingWall, State, Wall};
use mrbd_kernel::simulate::{Accuracy, History, Shaking, Simulator, Start};
use mrbd_lab::diagnose::{Experiment, Verdict, diagnose};
use mrbd_lab::experiment::{Freedom, held_state, windows};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};

/// Height of the crack, half the width there, and the error of the transducer, m.
const CRACK_M: f64 = 0.75;
const HALF_WIDTH_M: f64 = 0.055;
const NOISE_M: f64 = 2e-4;

fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../inputs/measured/griffith_2004")
}

/// A release of a wall from a lean, as its transducer reads it: time in s and millimetres, 6 to 20 ms apart.
fn release_text(wall: &Wall, lean_rad: f64, seed: u64) -> String {
    let lean = State { theta: [lean_rad, -lean_rad], omega: [0.0; 2] };
    let start = Start { state: held_state(&RockingWall::new(wall), &lean), ..Start::default() };
    let mut history = History::new(0.001);
    let shaking = Shaking { tail_s: 3.0, ..Shaking::default() };
    Simulator::new(wall, &shaking, Accuracy::default()).run_from(&start, 3.0, &mut history);
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let normal = Normal::new(0.0, NOISE_M).expect("a deviation");
    let mut text = String::from("time_s,crack_mm\n");
    let mut next_s = 0.0;
    for row in &history.rows {
        let (time_s, theta) = (row.time_s, row.theta_rad[0]);
        if time_s >= next_s {
            next_s = time_s + random.random_range(0.006..0.02);
            let u = CRACK_M * theta.sin() + HALF_WIDTH_M * theta.signum() * (1.0 - theta.cos());
            writeln!(text, "{time_s:.3},{:.5}", 1e3 * (u + normal.sample(&mut random))).expect("text");
        }
    }
    text
}

/// Three releases of the strip on beds like those of the measured wall, the last held out. On sharp edges every impact would
/// shake the hold of the top by as much as the transducer's error.
fn write_releases(folder: &Path, lines: &str) -> PathBuf {
    let text = std::fs::read_to_string(shipped().join("wall.toml")).expect("a wall that is shipped");
    let wall_file = folder.join("wall.toml");
    let on_beds = text.replace("= 1e8", "= 4e7").replace("= 5e-3", "= 1e-2");
    std::fs::write(&wall_file, on_beds).expect("written");
    let wall = mrbd_files::load_wall(&wall_file).expect("a wall");
    let mut experiment = format!(
        "wall = \"wall.toml\"\n[prior]\nrestitution = 0.05\n[[channels]]\ncolumn = \"crack_mm\"\n\
         height_m = {CRACK_M}\nfactor = 0.001\nnoise_m = {NOISE_M}\n"
    );
    for (i, lean_rad) in [0.085, 0.07, 0.078].into_iter().enumerate() {
        let text = release_text(&wall, lean_rad, i as u64);
        std::fs::write(folder.join(format!("release_{i}.csv")), text).expect("written");
        let purpose = if i == 2 { "hold-out" } else { "fit" };
        write!(
            experiment,
            "[[tests]]\nname = \"release {i}\"\nmeasured = \"release_{i}.csv\"\nrelease_s = 0.05\n{lines}\
             use = \"{purpose}\"\n"
        )
        .expect("text");
    }
    let path = folder.join("experiment.toml");
    std::fs::write(&path, experiment).expect("written");
    path
}

#[test]
fn verified_nothing_is_named_of_releases_in_which_nothing_hides() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = write_releases(folder.path(), "top_held = true\n");
    let experiment = Experiment::load(&path).expect("an experiment");
    let windows = windows(&experiment.tests);
    assert!(windows.iter().all(|window| window.freedom == Freedom::Held));
    // What follows from the other rotation is no second reading.
    assert!(windows.iter().all(|window| window.readings <= window.samples.len()));
    let summary = diagnose(&experiment, &()).expect("a diagnosis").summary;
    let error = summary.windowed_error.before.expect("windows");
    println!("{:?}, {error:.3} of the noise in {} windows", summary.verdict, windows.len());
    assert!(matches!(summary.verdict, Verdict::None | Verdict::NoPower), "{:?}", summary.verdict);
    // Some twenty windows of some forty readings: their error scatters by some hundredths.
    assert!((0.9..1.1).contains(&error), "{error}");
}

#[test]
fn regress_measured_releases_make_a_class_of_joints_that_give() {
    for name in ["diagnose_a.toml", "diagnose_b.toml"] {
        let experiment = Experiment::load(&shipped().join(name)).expect("an experiment that is shipped");
        let found = windows(&experiment.tests);
        let of = |test: usize| found.iter().filter(|window| window.test == test).count();
        // Three seconds of each, in windows of about half a second.
        assert!(of(0) >= 5 && of(1) >= 5, "{name}: {} and {}", of(0), of(1));
        // Stated: 0.4 mm at 0.75 m.
        assert!((experiment.tests[0].noise_rad[0] / (4e-4 / 0.75) - 1.0).abs() < 1e-9);
        let summary = diagnose(&experiment, &()).expect("a diagnosis").summary;
        println!("{name}: {:?}, {:?}", summary.verdict, summary.equivalent);
        assert_eq!(summary.verdict, Verdict::Class, "{name}");
        for equal in [
            "compliant_joint.ground",
            "compliant_joint.crack",
            "compliant_joint.both",
            "trilinear_joint.both",
        ] {
            assert!(summary.equivalent.iter().any(|own| own == equal), "{name}: {equal}");
        }
        // The guide has 90 and 93 %, and 2.2 and 2.5 of the error stated: other rounding moves a fit by some hundredths.
        let taken = summary.remainder.expect("more than noise is left").taken_held_out;
        assert!((0.90..0.95).contains(&taken), "{name}: {taken}");
        let after = summary.windowed_error.after.expect("windows");
        assert!((2.0..2.7).contains(&after), "{name}: {after}");
    }
}

#[test]
fn rejects_a_diagnosis_of_one_body_and_says_what_is_needed() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = write_releases(folder.path(), "");
    let error = Experiment::load(&path).expect_err("one body only");
    assert_eq!(error.exit_code(), 2);
    assert!(error.to_string().contains("top_held"), "{error}");
}

/// M/(N b/2) of a bed of a strip 0.95 m long and 0.11 m thick under a load, N, at a rotation.
fn carried(stiffness_pa_per_m: f64, load_n: f64, rotation_rad: f64) -> f64 {
    let (width_m, length_m) = (2.0 * HALF_WIDTH_M, 0.95);
    let bed = Bed { stiffness_pa_per_m, damping_s: 0.0, width_m, length_m, load_n };
    bed.moment_n_m(rotation_rad) / (load_n * HALF_WIDTH_M)
}

#[test]
fn published_the_push_of_the_twin_speaks_against_every_bed_of_the_class() {
    let weight_n = 1800.0 * 0.95 * 0.11 * 1.5 * G_M_S2;
    // Stiffness at ground and crack, Pa/m, of what the diagnosis of release a calls equals; the share at 0.08 and 0.16 of the
    // thickness, as the guide has it.
    let (sharp, ground, crack, both) = (1e15, 1.62e7, 3.80e6, 4.34e7);
    for (beds, told) in
        [([ground, sharp], [0.57, 0.63]), ([sharp, crack], [0.56, 0.62]), ([both, both], [0.51, 0.66])]
    {
        for (displacement, told) in [0.08, 0.16].into_iter().zip(told) {
            let theta = displacement * 0.11 / CRACK_M;
            // Ground and crack carry half each on sharp edges: N b/2, and twice half of that.
            let share = carried(beds[0], weight_n, theta) + carried(beds[1], weight_n / 2.0, 2.0 * theta);
            // The guide has two digits, of stiffnesses with three.
            assert!((0.5 * share - told).abs() < 0.006, "{beds:?} at {displacement}: {}", 0.5 * share);
        }
    }
    let push = std::fs::read_to_string(shipped().join("push.csv")).expect("a file that is shipped");
    let rows = push
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().expect("a number")).collect());
    let rows = rows.collect::<Vec<Vec<f64>>>();
    let at = |d: f64| {
        let k = rows.iter().position(|row| row[0] >= d).expect("pushed so far");
        let [a, b] = [&rows[k - 1], &rows[k]];
        a[1] + (d - a[0]) / (b[0] - a[0]) * (b[1] - a[1])
    };
    // Over 0.1467, plus what leaning takes.
    let carried = [0.08, 0.16].map(|d| at(d) / 0.1467 + d);
    assert!(carried.iter().all(|share| *share > 0.97), "{carried:?}");
}
