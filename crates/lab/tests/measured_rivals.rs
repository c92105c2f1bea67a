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

const LINES: &str = "trilinear_joint.both";
const CRUSHING: &str = "crushing_joint.both";
const WORN: &str = "rounded_edges.both";
const DAMPER: &str = "joint_damping.crack";

/// A law as its numbers were found, the release it was fitted to, and what it leaves of both.
struct Told {
    law: &'static str,
    effects: &'static [(&'static str, &'static [f64])],
    left: [f64; 2],
}

/// What differs by more than 0.1 % of the thickness: the guide has the errors to half of that, and as much for the rounding
/// of the numbers.
fn differing(experiment: &Experiment, told: &[Told]) -> Vec<String> {
    let differs = |told: &Told| {
        let found = errors(experiment, told.effects);
        println!("{}: {found:.4?}, told {:?}", told.law, told.left);
        let same = (0..2).all(|i| (found[i] - told.left[i]).abs() < 0.001);
        (!same).then(|| format!("{}: {found:.4?}, told {:?}", told.law, told.left))
    };
    told.iter().filter_map(differs).collect()
}

const fn told(law: &'static str, effects: &'static [(&'static str, &'static [f64])], left: [f64; 2]) -> Told {
    Told { law, effects, left }
}

#[test]
fn regress_measured_releases_under_the_rivals_of_a_bed() {
    // What `make measured-rivals` finds, as docs/measured-walls.md has it: errors of a, of b.
    let whole = [
        told("lines of a", &[(LINES, &[0.6183, 0.01868, 0.2000, 0.01010])], [0.037, 0.080]),
        told("lines of b", &[(LINES, &[0.6886, 0.02834, 0.4, 0.01274])], [0.067, 0.037]),
        told("crushing of a", &[(CRUSHING, &[3.363e7, 1.142e5, 0.01058])], [0.026, 0.067]),
        told("crushing of b", &[(CRUSHING, &[4.655e7, 1.0e5, 0.01027])], [0.075, 0.027]),
        told("worn of a", &[(WORN, &[0.02606, 0.1192]), (DAMPER, &[12.37])], [0.027, 0.078]),
        told("worn of b", &[(WORN, &[0.02115, 0.04917]), (DAMPER, &[12.11])], [0.073, 0.031]),
    ];
    let after = [
        told("lines of a", &[(LINES, &[0.4636, 0.003816, 0.1253, 0.008124])], [0.010, 0.018]),
        told("lines of b", &[(LINES, &[0.4713, 0.005636, 0.1162, 0.008207])], [0.023, 0.008]),
        told("crushing of a", &[(CRUSHING, &[3.546e7, 1.805e6, 0.009428])], [0.023, 0.028]),
        told("crushing of b", &[(CRUSHING, &[3.965e7, 1.065e6, 0.009203])], [0.027, 0.020]),
        told("worn of a", &[(WORN, &[0.03154, 0.2360]), (DAMPER, &[15.87])], [0.025, 0.036]),
        told("worn of b", &[(WORN, &[0.03128, 0.2505]), (DAMPER, &[17.09])], [0.040, 0.021]),
    ];
    let mut differ = differing(&experiment("experiment_a.toml"), &whole);
    differ.extend(differing(&experiment("after_a.toml"), &after));
    assert!(differ.is_empty(), "{differ:#?}");
}

#[test]
fn analytic_the_experiments_of_the_rivals_load() {
    for law in ["lines", "crushing", "worn"] {
        for fit in ["a", "b", "after_a", "after_b"] {
            let found = experiment(&format!("rivals/{law}_{fit}.toml"));
            assert_eq!(found.tests.len(), 2, "{law} {fit}");
        }
    }
}
