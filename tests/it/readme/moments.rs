//! What the releases of the measured wall say of its joints before any law is assumed, beside laws and a push of its twin.

use std::path::{Path, PathBuf};

use mrbd_lab::calibrate::Experiment;
use mrbd_lab::release::{FittedLaw, HeldStrip, LawKind, MomentPoint, Moments, Told};

use super::ROOT;
use super::block::{Page, row};

fn shipped(name: &str) -> PathBuf {
    Path::new(ROOT).join("inputs/measured/griffith_2004").join(name)
}

/// Both blocks of the page on measured walls.
pub fn blocks(page: &mut Page) {
    let experiment =
        Experiment::load(&shipped("experiment_a.toml"), None).expect("an experiment that is shipped");
    let moments = experiment.moments().expect("a wall").expect("releases");
    page.put_lines("moments", &table(&moments));
    page.put_lines("laws of moments", &laws(&moments));
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

fn table(moments: &Moments) -> String {
    let strip = &moments.strip;
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
