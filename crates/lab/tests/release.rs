//! The moment of the joints that releases say: of motions whose law is known.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use mrbd_kernel::model::{Effect, Wall, WallParameters};
use mrbd_kernel::simulate::Accuracy;
use mrbd_lab::calibrate::Experiment;
use mrbd_lab::release::{FittedLaw, HeldStrip, LawKind, Moments};

fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../inputs/measured/griffith_2004")
}

/// What a wall with these effects does in release b, read when that was measured.
fn made_up(effects: &[Effect]) -> (Wall, Moments) {
    let given = Experiment::load(&shipped().join("experiment_b.toml"), None).expect("shipped");
    let parameters = WallParameters { effects: effects.to_vec(), ..given.space.base().clone() };
    let wall = Wall::new(parameters).expect("a wall");
    let test = &given.tests[0];
    let (from_s, _) = test.release().expect("a release");
    let rows = test.history(&wall, Accuracy::default(), 1e-3).rows;
    let mut text = "time_s,theta1_rad\n".to_owned();
    for time_s in test.measured.time_s.iter().filter(|t| **t >= from_s) {
        // Samples were taken at whole hundredths, rows are at whole thousandths from the release on.
        let row = rows.iter().min_by(|a, b| (a.time_s - time_s).abs().total_cmp(&(b.time_s - time_s).abs()));
        writeln!(text, "{time_s},{:e}", row.expect("rows").theta_rad[0]).expect("room");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let put = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("room");
    put("made_up.csv", &text);
    put("wall.toml", &std::fs::read_to_string(shipped().join("wall.toml")).expect("shipped"));
    put(
        "experiment.toml",
        "wall = \"wall.toml\"\n[[tests]]\nname = \"made up\"\nmeasured = \"made_up.csv\"\nrelease_s = 0.2\n\
         top_held = true\n",
    );
    let experiment = Experiment::load(&folder.path().join("experiment.toml"), None).expect("an experiment");
    let moments = Moments::of(&wall, &experiment.tests).expect("a release");
    (wall, moments)
}

fn law(moments: &Moments, kind: LawKind) -> &FittedLaw {
    moments.laws.iter().find(|law| law.law.kind == kind).expect("every law")
}

#[test]
fn analytic_the_bed_of_a_made_up_release_comes_back() {
    let bed = Effect::with_parameters("compliant_joint.both", &[4e7, 0.01]).expect("a bed");
    let (wall, moments) = made_up(&[bed]);
    let strip = HeldStrip::of(&wall).expect("held");
    let beds = wall.beds().map(|bed| bed.expect("both"));
    for point in moments.releases[0].points.iter().filter(|p| p.displacement > 0.1) {
        let known = strip.share(point.displacement, |joint, phi| beds[joint].moment_n_m(phi));
        for told in [point.opening, point.closing].into_iter().flatten() {
            // Beyond the band: the damper, and arms (b - c)/2 of the bed where those of the moment are b/2 - c/3.
            let [low, high] = told.interval_90;
            assert!((low - 0.03..high + 0.03).contains(&known), "{known}: {point:?}");
        }
    }
    let [bed, trilinear, rounded, sharp] =
        [LawKind::Bed, LawKind::Trilinear, LawKind::Rounded, LawKind::Sharp].map(|kind| law(&moments, kind));
    // The loss of the damper is given two numbers, not its own law: 5 % of the stiffness.
    assert!((bed.law.values[0] / 4e7 - 1.0).abs() < 0.05, "{bed:?}");
    assert!(bed.left[0] < 0.015 && 1.5 * bed.left[0] < trilinear.left[0], "{bed:?} {trilinear:?}");
    assert!(
        4.0 * bed.left[0] < rounded.left[0] && 20.0 * bed.left[0] < sharp.left[0],
        "{rounded:?} {sharp:?}"
    );
}

#[test]
fn analytic_sharp_edges_carry_their_moment() {
    let (_, moments) = made_up(&[]);
    let told = moments.releases[0].points.iter().flat_map(|p| [p.opening, p.closing]).flatten();
    // An impact within a test function is a force of its own there, which spreads over neighbouring knots; the band knows.
    for told in told {
        let [low, high] = told.interval_90;
        assert!((low - 0.1..high + 0.1).contains(&1.0), "{told:?}");
    }
    let bed = law(&moments, LawKind::Bed);
    assert!(bed.law.values[0] > 1e9 && law(&moments, LawKind::Sharp).left[0] < 0.05, "{bed:?}");
}
