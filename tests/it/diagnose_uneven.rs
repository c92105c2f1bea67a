//! Diagnoses of tests as laboratories have them: displacements, unevenly sampled, with gaps.

use std::fmt::Write as _;
use std::path::Path;

use mrbd_kernel::model::{Effect, ImpactLaw};
use rand::RngExt;

use crate::diagnose_twin::{diagnosed, write_twin};
use crate::walls::{rng, table_wall};

/// Rewrites the measured files of a twin: two samples of three, at random, with a gap of 0.2 s in every test; in
/// millimetres at two heights, where the table wall turns by rotations of some hundredths.
fn as_displacements(folder: &Path) {
    for i in 0..3 {
        let file = folder.join(format!("measured_{i}.csv"));
        let text = std::fs::read_to_string(&file).expect("the measured file");
        let mut random = rng(702, i);
        let mut out = String::from("time_s,low_mm,high_mm\n");
        for line in text.lines().skip(1) {
            let cells = line.split(',').map(|cell| cell.parse().expect("a number")).collect::<Vec<f64>>();
            let [time_s, theta1, theta2] = [cells[0], cells[1], cells[2]];
            if random.random_bool(1.0 / 3.0) || (5.0..5.2).contains(&time_s) {
                continue;
            }
            let half_1 = 0.5 * 0.271 * theta1.signum();
            let half_2 = 0.5 * 0.281 * (theta2 - theta1).signum();
            let low = 2.0 * theta1.sin() + half_1 * (1.0 - theta1.cos());
            let crack = 2.191 * theta1.sin() + half_1 * (1.0 - theta1.cos());
            let high = crack + (3.5 - 2.191) * theta2.sin() + half_2 * (theta1.cos() - theta2.cos());
            writeln!(out, "{time_s:.3},{:.5},{:.5}", 1e3 * low, 1e3 * high).expect("text");
        }
        std::fs::write(&file, out).expect("written");
    }
    let experiment = folder.join("experiment.toml");
    let text = std::fs::read_to_string(&experiment).expect("the experiment");
    let channels = "[[channels]]\ncolumn = \"low_mm\"\nheight_m = 2.0\nfactor = 0.001\n\
                    [[channels]]\ncolumn = \"high_mm\"\nheight_m = 3.5\nfactor = 0.001\n";
    std::fs::write(&experiment, format!("{text}\n{channels}")).expect("written");
}

#[test]
fn verified_an_effect_is_named_from_displacements_unevenly_sampled() {
    let folder = tempfile::tempdir().expect("a folder");
    let described = table_wall(ImpactLaw::Contact);
    let mut true_wall = described.clone();
    true_wall.effects.push(Effect::with_parameters("viscous_damping", &[1500.0]).expect("an effect"));
    let experiment = write_twin(folder.path(), &described, &true_wall, |theta| theta);
    as_displacements(folder.path());
    let found = diagnosed(&experiment, &folder.path().join("out"));
    assert_eq!(found["verdict"], "named", "{found:#}");
    assert_eq!(found["effects"][0]["name"], "viscous_damping");
    let damper = found["effects"][0]["parameters"]["coefficient_n_s_per_m"].as_f64().expect("a number");
    // Two samples of three of the even twin, which finds it to 2 %.
    assert!((damper / 1500.0 - 1.0).abs() < 0.05, "{damper}");
    // Noise is found within its scatter: 3e-5 rad of the lower body.
    let noise = found["tests"][0]["noise_rad"][0].as_f64().expect("a number");
    assert!((noise / 3e-5 - 1.0).abs() < 0.15, "{noise}");
}
