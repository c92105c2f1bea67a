//! Whole runs of a test under several walls, side by side, are those of each wall alone.

use std::path::Path;

use mrbd_files::{load_wall, parse_wall};
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{Accuracy, History, Shaking, simulate_observed};
use mrbd_lab::calibrate::Experiment;

const WALL: &str = include_str!("../../../inputs/walls/table_wall.toml");

/// An experiment of one test of six seconds: the table wall, swept.
fn write(folder: &Path) {
    let put = |name: &str, text: &str| std::fs::write(folder.join(name), text).expect("written");
    put("wall.toml", WALL);
    let ground = |k: i32| 2.5 * (0.035 * f64::from(k)).sin() * (0.0026 * f64::from(k)).sin();
    let samples = (0..=1200).map(ground).collect::<Vec<_>>();
    let row = |(k, a): (usize, &f64)| format!("{:.3},{a:?}\n", 0.005 * k as f64);
    let record = samples.iter().enumerate().map(row).collect::<String>();
    put("record.csv", &format!("time_s,acceleration_m_s2\n{record}"));
    let wall = load_wall(&folder.join("wall.toml")).expect("a wall");
    let horizontal = Some(Accelerogram::new(0.005, samples).expect("a record"));
    let mut history = History::new(0.005);
    simulate_observed(
        &wall,
        &Shaking { horizontal, ..Shaking::default() },
        Accuracy::default(),
        &mut history,
    );
    let row = |r: &mrbd_kernel::simulate::HistoryRow| {
        format!("{:?},{:?},{:?}\n", r.time_s, r.theta_rad[0], r.theta_rad[1])
    };
    let measured = history.rows.iter().map(row).collect::<String>();
    put("measured.csv", &format!("time_s,theta1_rad,theta2_rad\n{measured}"));
    put(
        "experiment.toml",
        "wall = \"wall.toml\"\n[calibrate]\nparameters = [{ key = \"stiffness_n_per_m\", lower = 34e3, \
         upper = 40e3 }]\n[[tests]]\nname = \"one\"\nrecord = \"record.csv\"\nmeasured = \"measured.csv\"\n",
    );
}

#[test]
fn regress_whole_runs_side_by_side_are_those_of_each_wall_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path());
    let experiment = Experiment::load(&folder.path().join("experiment.toml"), None).expect("an experiment");
    let with =
        |effects: &str| parse_wall(Path::new("wall.toml"), &format!("{WALL}\n{effects}")).expect("a wall");
    let effect = |kind: &str, number: &str| with(&format!("[[effects]]\nkind = \"{kind}\"\n{number}\n"));
    let formula = "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"-c*v*abs(v)\"\n\
                   parameters = { c = { value = 9000.0, unit = \"N*(s/m)**2\" } }\n";
    let walls: Vec<Wall> = vec![
        with(""),
        effect("viscous_damping", "coefficient_n_s_per_m = 1500.0"),
        effect("coulomb_friction", "force_n = 300.0"),
        effect("sensor_gain", "body = \"upper\"\ngain = 1.05"),
        with(formula),
        effect("record_gain", "gain = 9.0"),
    ];
    for test in &experiment.tests {
        let alone = walls.iter().map(|wall| test.simulate(wall, Accuracy::default())).collect::<Vec<_>>();
        assert_eq!(test.simulate_all(&walls, Accuracy::default()), alone);
        // Otherwise equality would say nothing: the last one falls.
        assert_eq!(alone[5].outcome, "collapsed", "{:?}", alone[5]);
        let [first, second] = [&alone[0], &alone[1]].map(|run| run.wme.expect("an error"));
        assert!(second > first + 1e-3, "{first} and {second}");
    }
}
