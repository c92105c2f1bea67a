//! The measured wall: what its releases say of the joints before any law is assumed, beside laws and a push of its twin.

use std::path::{Path, PathBuf};

use mrbd_kernel::model::{Effect, State, Wall, WallParameters};
use mrbd_kernel::simulate::Accuracy;
use mrbd_lab::calibrate::Experiment;
use mrbd_lab::experiment::Test;
use mrbd_lab::release::{FittedLaw, HeldStrip, LawKind, MomentPoint, Moments, Told};

/// The repository.
const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

fn shipped(name: &str) -> PathBuf {
    Path::new(ROOT).join("inputs/measured/griffith_2004").join(name)
}

fn experiment(name: &str) -> Experiment {
    Experiment::load(&shipped(name), None).expect("an experiment that is shipped")
}

/// A row of a table.
fn row<S: AsRef<str>>(cells: &[S]) -> String {
    let cells: Vec<&str> = cells.iter().map(AsRef::as_ref).collect();
    format!("| {} |\n", cells.join(" | "))
}

/// Force over that of the rigid line and displacement over the thickness of the push, from rest on.
fn push(strip: &HeldStrip) -> Vec<(f64, f64)> {
    let text = std::fs::read_to_string(shipped("push.csv")).expect("shipped");
    let row = |line: &str| {
        let (x, force) = line.split_once(',').expect("two columns");
        let [x, force] = [x, force].map(|cell| cell.trim().parse::<f64>().expect("a number"));
        // A point force at the crack of this wall works through h_1 θ_1: τ = (F h_1 + P θ_1)/G.
        (x, force / strip.rigid_force_over_weight() + strip.leaning(x))
    };
    text.lines().skip(1).map(row).collect()
}

/// Between the points of a push.
fn pushed(points: &[(f64, f64)], x: f64) -> Option<f64> {
    let pair = points.windows(2).find(|pair| (pair[0].0..=pair[1].0).contains(&x))?;
    Some(pair[0].1 + (pair[1].1 - pair[0].1) * (x - pair[0].0) / (pair[1].0 - pair[0].0))
}

fn told(told: Option<Told>) -> String {
    told.map_or("–".to_owned(), |t| {
        format!("{:.2} ({:.2} to {:.2})", t.share, t.interval_90[0], t.interval_90[1])
    })
}

#[test]
fn regress_the_guide_tells_the_moment_of_measured_joints() {
    let experiment = experiment("experiment_a.toml");
    let given = experiment.given().expect("a wall");
    let strip = HeldStrip::of(&given).expect("held");
    let moments = Moments::of(&given, &experiment.tests).expect("releases");
    let path = Path::new(ROOT).join("docs/measured-walls.md");
    let before = std::fs::read_to_string(&path).expect("a page of the guide");
    let page = with_block(&before, "moments", &table(&strip, &moments));
    let page = with_block(&page, "laws of moments", &laws(&moments));
    if std::env::var_os("UPDATE_README").is_some() {
        std::fs::write(&path, page).expect("written");
        return;
    }
    assert!(page == before, "docs/measured-walls.md is stale: `make readme` writes\n{page}");
}

/// A page with other lines in a block that is marked.
fn with_block(page: &str, name: &str, lines: &str) -> String {
    let begin = format!("<!-- made by make readme: {name} -->");
    let (before, rest) = page.split_once(&begin).expect("a block of that name");
    let (_, after) = rest.split_once("<!-- end -->").expect("its end");
    format!("{before}{begin}\n{}\n<!-- end -->{after}", lines.trim_end())
}

fn table(strip: &HeldStrip, moments: &Moments) -> String {
    let [a, b] = [0, 1].map(|k| &moments.releases[k]);
    let points = push(strip);
    let head = [
        "displacement over thickness",
        "crack turned by, rad",
        "a, opening",
        "a, closing",
        "b, opening",
        "b, closing",
        "push of the twin",
        "bed",
        "three lines",
        "worn edges",
    ];
    let rows = a
        .points
        .iter()
        .zip(&b.points)
        .filter(|(a, b)| [a.opening, a.closing, b.opening, b.closing].iter().any(Option::is_some));
    let row_of = |(of_a, of_b): (&MomentPoint, &MomentPoint)| {
        let x = of_a.displacement;
        let law = |kind: LawKind| {
            let law = moments.laws.iter().find(|law| law.law.kind == kind).expect("every law");
            format!("{:.2}", law.law.share(strip, x))
        };
        let mut cells = vec![format!("{x}"), format!("{:.3}", of_a.crack_rotation_rad)];
        cells.extend([of_a.opening, of_a.closing, of_b.opening, of_b.closing].map(told));
        cells.push(pushed(&points, x).map_or("–".to_owned(), |share| format!("{share:.2}")));
        cells.extend([LawKind::Bed, LawKind::Trilinear, LawKind::Rounded].map(law));
        row(&cells)
    };
    row(&head) + &row(&["---"; 10]) + &rows.map(row_of).collect::<String>()
}

fn laws(moments: &Moments) -> String {
    let head = ["law", "fitted to", "numbers", "left of a", "left of b"];
    let name = |kind: LawKind| match kind {
        LawKind::Sharp => "sharp edges",
        LawKind::Bed => "bed",
        LawKind::Trilinear => "three lines",
        LawKind::Rounded => "worn edges",
    };
    let row_of = |fitted: &FittedLaw| {
        let number = |k: usize| fitted.law.values[k];
        let numbers = match fitted.law.kind {
            LawKind::Sharp => "–".to_owned(),
            LawKind::Bed => format!("k {:.0} MPa/m", number(0) / 1e6),
            LawKind::Trilinear => format!(
                "first stiffness {:.1} a thickness, plateau {:.2}, no force at {:.2} of the thickness",
                number(0),
                number(1),
                number(2)
            ),
            LawKind::Rounded => {
                format!("worn over {:.2} of the width, radius {:.1} widths", number(0), number(1))
            }
        };
        let left = fitted.left.iter().zip(&moments.releases).map(|(left, release)| {
            if release.test == fitted.fitted_to { format!("{left:.3}") } else { format!("**{left:.3}**") }
        });
        let cells = [name(fitted.law.kind).to_owned(), fitted.fitted_to.clone(), numbers];
        row(&cells.into_iter().chain(left).collect::<Vec<_>>())
    };
    row(&head) + &row(&["---"; 5]) + &moments.laws.iter().map(row_of).collect::<String>()
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
    let rms = |test: &Test| test.rms_rad(&wall, Accuracy::default())[0].expect("θ_1");
    experiment.tests.iter().map(|test| over_thickness * rms(test)).collect()
}

#[test]
fn measured_releases_are_followed_from_after_their_first_passage() {
    let late = experiment("after_a.toml");
    // What `make measured` finds from 0.55 s on.
    let of_a = errors(&late, Some([3.52e7, 0.0094]), 1.0);
    let of_b = errors(&late, Some([3.97e7, 0.0091]), 1.0);
    println!("from 0.55 s on, over the thickness: joints of a {of_a:.4?}, of b {of_b:.4?}");
    // Half a percent more than found for other rounding of the numbers; the target held out is 4 %.
    assert!(of_a[0] < 0.030 && of_b[1] < 0.030, "to fit: {of_a:?} {of_b:?}");
    assert!(of_a[1] < 0.040 && of_b[0] < 0.040, "held out: {of_a:?} {of_b:?}");
}

/// Displacements of the crack over the thickness in a release, straight between its samples.
fn displacement(test: &Test, over_thickness: f64, time_s: f64) -> Option<f64> {
    let theta = test.measured.theta_rad[0].as_ref()?;
    let after = test.measured.time_s.iter().position(|t| *t > time_s)?;
    let [t0, t1] = [after - 1, after].map(|k| test.measured.time_s[k]);
    let [x0, x1] = [after - 1, after].map(|k| over_thickness * theta[k]);
    Some(x0 + (x1 - x0) * (time_s - t0) / (t1 - t0))
}

#[test]
fn measured_the_releases_differ_by_more_than_their_starts() {
    let releases = experiment("experiment_a.toml");
    let p = releases.space.base();
    let over_thickness = p.crack_height_m.expect("cracked") / p.thickness_m;
    let [a, b] = [&releases.tests[0], &releases.tests[1]];
    let apart = |shift_s: f64| {
        let times = (0..600).map(|k| 0.13 + 0.005 * f64::from(k));
        let at = |t: f64| {
            let pair = [displacement(a, over_thickness, t + shift_s), displacement(b, over_thickness, t)];
            Some(pair[0]? - pair[1]?)
        };
        let apart = times.filter_map(at).map(|x| x * x).collect::<Vec<_>>();
        (apart.iter().sum::<f64>() / apart.len() as f64).sqrt()
    };
    let as_they_are = apart(0.0);
    let nearest = (-10..=10).map(|k| apart(0.005 * f64::from(k))).fold(f64::INFINITY, f64::min);
    let starts = [a, b].map(|test| over_thickness * test.release().expect("a release").1.theta[0]);
    println!(
        "releases apart by {as_they_are:.4} of the thickness, {nearest:.4} at the best shift; {starts:.4?}"
    );
    // docs/measured-walls.md: 6.5 and 5.3 %, from starts that differ by 0.4 % of the thickness.
    assert!((as_they_are - 0.065).abs() < 0.002 && (nearest - 0.053).abs() < 0.002);
    assert!((starts[0] - starts[1]).abs() < 0.005, "{starts:?}");
}

#[test]
fn measured_a_start_fitted_to_the_first_fall_does_not_help_what_comes_after() {
    let releases = experiment("experiment_a.toml");
    let bed = |k: f64, zeta: f64| {
        let effect = Effect::with_parameters("compliant_joint.both", &[k, zeta]).expect("a bed");
        Wall::new(WallParameters { effects: vec![effect], ..releases.space.base().clone() }).expect("a wall")
    };
    let over_thickness = releases.space.base().crack_height_m.expect("cracked") / 0.110;
    // Numbers of one release on the other; starts within 1 % of θ and 40 % of θ', both beyond their own errors.
    for (k, zeta, held_out) in [(3.50e7, 0.0103, 1), (3.93e7, 0.0113, 0)] {
        let (wall, test) = (bed(k, zeta), &releases.tests[held_out]);
        let (_, state) = test.release().expect("a release");
        let from = |[theta, omega]: [f64; 2]| {
            let state =
                State { theta: state.theta.map(|x| theta * x), omega: state.omega.map(|x| omega * x) };
            test.released_from(state)
        };
        let shares = |reach: f64| (-2..=2).map(move |k| 1.0 + 0.5 * reach * f64::from(k));
        let starts = shares(0.01).flat_map(|theta| shares(0.4).map(move |omega| [theta, omega]));
        let seen = |start: &[f64; 2]| missed(&from(*start), &wall, over_thickness, 0.40);
        let best = starts.min_by(|x, y| seen(x).total_cmp(&seen(y))).expect("starts");
        let [before, after] = [[1.0; 2], best].map(|start| missed(&from(start), &wall, over_thickness, 9.0));
        println!("held out {}: {before:.4} and from {best:?} {after:.4}", test.name);
        assert!(after > 0.045, "{}: {after}", test.name);
    }
}

/// Error of a release up to a time, root mean square over the samples, over the thickness.
fn missed(test: &Test, wall: &Wall, over_thickness: f64, until_s: f64) -> f64 {
    let rows = test.history(wall, Accuracy::default(), 1e-3).rows;
    let theta = test.measured.theta_rad[0].as_ref().expect("θ_1");
    let (from_s, _) = test.release().expect("a release");
    let read = test.measured.time_s.iter().zip(theta).filter(|(t, _)| (from_s..=until_s).contains(*t));
    let squares = read.map(|(t, theta)| {
        let after = rows.partition_point(|row| row.time_s < *t).min(rows.len() - 1);
        (over_thickness * (rows[after].theta_rad[0] - theta)).powi(2)
    });
    let squares = squares.collect::<Vec<_>>();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}
