//! Walls on beds that another program moved: two free bodies on springs, without kinematics of rocking or impacts.

use mrbd_kernel::model::{Effect, Wall, WallParameters};
use mrbd_lab::diagnose::{Experiment, windowed_errors};

use crate::shared;

/// Damping time of the springs of the other program, s.
const DAMPING_S: f64 = 4e-4;

/// Windowed errors over tests to fit and held out with the beds as given, and on sharp edges.
fn errors(folder: &std::path::Path) -> [[f64; 2]; 2] {
    let experiment = Experiment::load(&folder.join("experiment.toml")).expect("an experiment");
    let answer = std::fs::read_to_string(folder.join("answer.json")).expect("an answer");
    let answer: serde_json::Value = serde_json::from_str(&answer).expect("JSON");
    let bed = |joint: &str| {
        let stiffness = answer["stiffness_pa_per_m"][joint].as_f64().expect("a stiffness");
        Effect::with_parameters(&format!("compliant_joint.{joint}"), &[stiffness, DAMPING_S]).expect("a bed")
    };
    let sharp = experiment.wall.parameters().clone();
    let on_beds = WallParameters { effects: vec![bed("ground"), bed("crack")], ..sharp.clone() };
    [on_beds, sharp].map(|parameters| {
        let wall = Wall::new(parameters).expect("a wall");
        windowed_errors(&experiment, &wall).map(|error| error.expect("windows in which the wall moves"))
    })
}

#[test]
fn measured_walls_on_beds_are_followed_to_a_few_noises() {
    let Some(measured) = shared::folder("measured") else { return };
    // What docs/model.md says of the tests, rounded up: the load of the motion itself is left, and of a bed of
    // 5e10 Pa/m what stands between an impact and none.
    for (name, most, sharp_at_least) in
        [("bed_a_table_wall", 1.4, 20.0), ("bed_b_other_wall", 1.8, 40.0), ("bed_c_crack_only", 3.1, 30.0)]
    {
        let [on_beds, sharp] = errors(&measured.join(name));
        println!("{name}: on its beds {on_beds:.2?}, on sharp edges {sharp:.1?} noises");
        assert!(on_beds[0] < most, "{name}: {on_beds:?}");
        assert!(sharp[0] > sharp_at_least, "{name}: {sharp:?}");
    }
}
