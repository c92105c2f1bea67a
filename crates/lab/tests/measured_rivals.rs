//! The measured wall under the rivals of a bed: what each leaves, on the release it was fitted to and on the other.

use std::path::Path;

use mrbd_kernel::model::{Effect, Wall, WallParameters};
use mrbd_kernel::simulate::Accuracy;
use mrbd_lab::calibrate::Experiment;
use mrbd_lab::experiment::Test;

fn experiment(name: &str) -> Experiment {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../inputs/measured/griffith_2004");
    Experiment::load(&folder.join(name), None).expect("an experiment that is shipped")
}

/// Errors of the displacement of the crack over the thickness in both releases, root mean square.
fn errors(experiment: &Experiment, effects: &[(&str, &[f64])]) -> [f64; 2] {
    let base = experiment.space.base();
    let of = |(name, numbers): &(&str, &[f64])| Effect::with_parameters(name, numbers).expect("an effect");
    let effects = effects.iter().map(of).collect();
    let wall = Wall::new(WallParameters { effects, ..base.clone() }).expect("a wall");
    let over_thickness = base.crack_height_m.expect("cracked") / base.thickness_m;
    let rms = |test: &Test| over_thickness * test.rms_rad(&wall, Accuracy::default())[0].expect("θ_1");
    [rms(&experiment.tests[0]), rms(&experiment.tests[1])]
}

/// Half a percent of the thickness more or less for other rounding of the numbers.
const ROUNDING: f64 = 0.005;

fn check(experiment: &Experiment, law: &str, effects: &[(&str, &[f64])], told: [f64; 2]) {
    let found = errors(experiment, effects);
    println!("{law}: {found:.4?}, told {told:?}");
    for i in 0..2 {
        assert!((found[i] - told[i]).abs() < ROUNDING, "{law}: {found:?}, told {told:?}");
    }
}

#[test]
fn measured_releases_under_the_rivals_of_a_bed() {
    // What `make measured-rivals` finds, as docs/measured-walls.md has it: fitted to a, fitted to b; errors of a, of b.
    let both = experiment("experiment_a.toml");
    let lines: [&[f64]; 2] = [&[0.6536, 0.02423, 0.2703, 0.01044], &[0.6886, 0.02834, 0.4, 0.01274]];
    check(&both, "lines of a", &[("trilinear_joint.both", lines[0])], [0.0, 0.0]);
    check(&both, "lines of b", &[("trilinear_joint.both", lines[1])], [0.0, 0.0]);
    let crushing: [&[f64]; 2] = [&[3.360e7, 1.150e5, 0.0105], &[4.593e7, 1.0e5, 0.0102]];
    check(&both, "crushing of a", &[("crushing_joint.both", crushing[0])], [0.0, 0.0]);
    check(&both, "crushing of b", &[("crushing_joint.both", crushing[1])], [0.0, 0.0]);
    let worn: [&[f64]; 2] = [&[0.02655, 0.1259], &[0.02296, 0.0676]];
    let dampers = [[5.06, 11.43], [13.34, 10.10]];
    for (k, name) in ["worn of a", "worn of b"].into_iter().enumerate() {
        let [ground, crack] = dampers[k].map(|c| [c]);
        let effects: [(&str, &[f64]); 3] = [
            ("rounded_edges.both", worn[k]),
            ("joint_damping.ground", &ground),
            ("joint_damping.crack", &crack),
        ];
        check(&both, name, &effects, [0.0, 0.0]);
    }
}
