//! The moment of the joints that releases say: of motions whose law is known.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use mrbd_kernel::model::{Effect, Wall, WallParameters};
use mrbd_kernel::simulate::Accuracy;
use mrbd_lab::calibrate::Experiment;
use mrbd_lab::release::{HeldStrip, LawKind, Moments, Told};

fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../inputs/measured/griffith_2004")
}

/// What a wall on these effects does in release b, read where that was measured, as an experiment.
fn made_up(effects: &[Effect]) -> Moments {
    let given = Experiment::load(&shipped().join("experiment_b.toml"), None).expect("shipped");
    let parameters = WallParameters { effects: effects.to_vec(), ..given.space.base().clone() };
    let wall = Wall::new(parameters).expect("a wall");
    let test = &given.tests[0];
    let rows = test.history(&wall, Accuracy::default(), 1e-3).rows;
    let mut text = "time_s,theta1_rad\n".to_owned();
    let from_s = test.release_s().expect("a release");
    for time_s in test.measured.time_s.iter().filter(|t| **t >= from_s) {
        let row = rows.iter().min_by(|a, b| (a.time_s - time_s).abs().total_cmp(&(b.time_s - time_s).abs()));
        writeln!(text, "{time_s},{:e}", row.expect("rows").theta_rad[0]).expect("room");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let put = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("room");
    put("made_up.csv", &text);
    put("wall.toml", &std::fs::read_to_string(shipped().join("wall.toml")).expect("shipped"));
    put(
        "experiment.toml",
        "wall = \"wall.toml\"\n[[tests]]\nname = \"made up\"\nmeasured = \"made_up.csv\"\nrelease_s = 0.2\ntop_held = true\n",
    );
    let experiment = Experiment::load(&folder.path().join("experiment.toml"), None).expect("an experiment");
    Moments::of(&wall, &experiment.tests).expect("a release")
}

fn print(moments: &Moments) {
    for release in &moments.releases {
        println!("{} {} left {:.4}", release.test, release.test_functions, release.left);
        for p in &release.points {
            let told = |t: Option<Told>| t.map(|t| [t.share, t.interval_90[0], t.interval_90[1]]);
            println!("{:.3} {:.4} {:.3?} {:.3?}", p.displacement, p.crack_rotation_rad, told(p.opening), told(p.closing));
        }
    }
    for law in &moments.laws {
        println!("{} {:.4?} to {}: {:.4?}", law.law.kind.name(), law.law.values, law.fitted_to, law.left);
    }
}

#[test]
fn analytic_the_law_of_a_made_up_release_comes_back() {
    let bed = Effect::with_parameters("compliant_joint.both", &[4e7, 0.01]).expect("a bed");
    let moments = made_up(&[bed]);
    print(&moments);
    print(&made_up(&[]));
    let given = Experiment::load(&shipped().join("experiment_a.toml"), None).expect("shipped");
    print(&Moments::of(&given.given().expect("a wall"), &given.tests).expect("releases"));
    let _ = (HeldStrip::of, LawKind::ALL);
}
