//! Walls that were really measured: what joints that give leave of the error.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use mrbd_kernel::model::{Effect, Wall, WallParameters};
use mrbd_kernel::simulate::Accuracy;
use mrbd_lab::calibrate::Experiment;
use mrbd_lab::experiment_file::ExperimentFile;

use crate::shared;

fn experiment(name: &str) -> Experiment {
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("inputs/measured/griffith_2004").join(name);
    Experiment::load(&file, None).expect("an experiment that is shipped")
}

/// Error of the displacement of the crack over the thickness, root mean square, in the tests of an experiment under
/// joints of k (Pa/m) and ζ (s); `None`: sharp edges that lose what `coefficient` says.
fn errors(experiment: &Experiment, bed: Option<[f64; 2]>, coefficient: f64) -> Vec<f64> {
    let base = experiment.space.base();
    let effects =
        bed.map(|[k, zeta]| Effect::with_parameters("compliant_joint.both", &[k, zeta]).expect("a bed"));
    let mut parameters = WallParameters { effects: effects.into_iter().collect(), ..base.clone() };
    parameters.restitution.coefficients = [coefficient; 8];
    let wall = Wall::new(parameters).expect("a wall");
    // The displacement of the crack is h_1 sin θ_1, to the square of θ_1.
    let over_thickness = base.crack_height_m.expect("cracked") / base.thickness_m;
    let rms = |test: &mrbd_lab::experiment::Test| test.rms_rad(&wall, Accuracy::default())[0].expect("θ_1");
    experiment.tests.iter().map(|test| over_thickness * rms(test)).collect()
}

#[test]
fn measured_releases_are_followed_by_joints_that_give() {
    let releases = experiment("experiment_a.toml");
    // What `make measured` finds, as docs/measured-walls.md has it.
    let of_a = errors(&releases, Some([3.52e7, 0.0105]), 1.0);
    let of_b = errors(&releases, Some([4.08e7, 0.0113]), 1.0);
    println!("over the thickness: joints of a {of_a:.3?}, of b {of_b:.3?}");
    // Fitted 3.2 and 4.3 %, held out 7.4 and 7.1 %: half a percent more for other rounding of the numbers.
    assert!(of_a[0] < 0.037 && of_b[1] < 0.048, "to fit: {of_a:?} {of_b:?}");
    assert!(of_a[1] < 0.079 && of_b[0] < 0.076, "held out: {of_a:?} {of_b:?}");
    for coefficient in [0.7, 0.8, 0.9, 1.0] {
        let sharp = errors(&releases, None, coefficient);
        assert!(sharp.iter().all(|error| *error > 0.145), "C = {coefficient}: {sharp:?}");
    }
}

#[test]
fn measured_releases_are_followed_from_after_their_first_passage() {
    let late = experiment("after_a.toml");
    // What `make measured` finds from 0.55 s on.
    let of_a = errors(&late, Some([3.55e7, 0.0094]), 1.0);
    let of_b = errors(&late, Some([3.97e7, 0.0092]), 1.0);
    println!("from 0.55 s on, over the thickness: joints of a {of_a:.4?}, of b {of_b:.4?}");
    // Half a percent more than found for other rounding of the numbers; the target held out is 4 %.
    assert!(of_a[0] < 0.030 && of_b[1] < 0.030, "to fit: {of_a:?} {of_b:?}");
    assert!(of_a[1] < 0.040 && of_b[0] < 0.040, "held out: {of_a:?} {of_b:?}");
}

#[test]
fn rejects_releases_that_cannot_be() {
    let refused = |test: &str| {
        let text = format!("wall = \"wall.toml\"\n[[tests]]\nname = \"one\"\nmeasured = \"m.csv\"\n{test}");
        ExperimentFile::parse(Path::new("experiment.toml"), &text).expect_err(test).to_string()
    };
    for (test, key) in [
        ("", "tests[0].record"),
        ("release_s = -0.1", "tests[0].release_s"),
        ("release_s = 0.1\nstart_s = \"match\"", "tests[0].start_s"),
        ("release_s = 0.1\nvertical = \"v.csv\"", "tests[0].vertical"),
        (
            "release_s = 0.1\ntop_held = true\nupper_reading = { column = \"u\", height_m = 1.0 }",
            "tests[0].top_held",
        ),
    ] {
        let message = refused(test);
        assert!(message.contains(key) && message.contains("allowed"), "{test:?}: {message}");
    }
}

#[test]
fn rejects_a_release_where_nothing_was_measured() {
    let folder = tempfile::tempdir().expect("a folder");
    let from = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("inputs/measured/griffith_2004");
    for name in ["wall.toml", "release_a.csv", "release_b.csv"] {
        std::fs::copy(from.join(name), folder.path().join(name)).expect("a file that is shipped");
    }
    let load = |change: &dyn Fn(&str) -> String| {
        let text = std::fs::read_to_string(from.join("experiment_a.toml")).expect("a file that is shipped");
        let file = folder.path().join("experiment.toml");
        std::fs::write(&file, change(&text)).expect("room");
        Experiment::load(&file, None).map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(load(&str::to_owned), Ok(()));
    let late = load(&|text| text.replace("release_s = 0.13", "release_s = 7.0")).expect_err("nothing there");
    assert!(late.contains("release_s = 7") && late.contains("four samples"), "{late}");
    let loose = load(&|text| text.replace("top_held = true", "")).expect_err("one rotation only");
    assert!(loose.contains("top_held"), "{loose}");
}

/// Mean and standard deviation of samples.
fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    use statrs::statistics::Statistics;
    (values.mean(), values.std_dev())
}

/// Trials, mean and standard deviation of the first impact over Housner's, by height over thickness.
fn first_impacts(trials: &BTreeMap<u32, Vec<f64>>) -> Vec<String> {
    let row = |(slenderness, ratios): (&u32, &Vec<f64>)| {
        let (mean, deviation) = mean_and_deviation(ratios);
        format!("{slenderness},{},{mean:.4},{deviation:.4}", ratios.len())
    };
    trials.iter().map(row).collect()
}

#[test]
fn published_first_impacts_of_limestone_are_those_of_the_trials() {
    let Some(data) = shared::folder("real/limestone_2026") else { return };
    let shipped = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("inputs/measured/limestone_2026");
    let text = |name: &str| std::fs::read_to_string(shipped.join(name)).expect("a file that is shipped");
    let mut trials = BTreeMap::<u32, Vec<f64>>::new();
    for row in csv::Reader::from_path(data.join("first_impact.csv")).expect("the trials").deserialize() {
        let row: BTreeMap<String, f64> = row.expect("a row of numbers");
        let slenderness = row["height_over_thickness"].round() as u32;
        trials.entry(slenderness).or_default().push(row["first_impact_angular_ratio"] / row["housner_ratio"]);
    }
    let table = text("first_impact_by_slenderness.csv");
    assert_eq!(table.lines().skip(1).collect::<Vec<_>>(), first_impacts(&trials));
    let mut all = trials.into_values().flatten().collect::<Vec<_>>();
    all.sort_by(f64::total_cmp);
    let ((mean, deviation), middle) = (mean_and_deviation(&all), all.len() / 2);
    let median = 0.5 * (all[middle] + all[(all.len() - 1) / 2]);
    let row = format!("| {} | {mean:.3} | {deviation:.3} | {median:.3} |", all.len());
    assert!(text("README.md").contains(&row), "{row}");
}
