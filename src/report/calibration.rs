//! The page of a calibration: measured against simulated, what the tests tell, how the searches converged.

mod convergence;
mod misfits;
mod moments;
mod parameters;

use super::page::{Link, Number, Page};
use crate::results::calibration::MOMENTS;
use crate::summary::{Calibrated, Note};
use mrbd_lab::calibrate::{Calibration, Identifiability, disagreement};

/// The page of a calibration.
pub fn page(calibrated: &Calibrated) -> Page {
    let Calibrated { stored, note, tests, moments } = calibrated;
    let mut files = vec![
        "manifest.json",
        "calibration.json",
        "candidates.parquet",
        "generations.parquet",
        "wall.calibrated.toml",
    ];
    files.extend(moments.as_ref().map(|_| MOMENTS));
    let measured = moments.as_ref().map(moments::section);
    let sections = [
        Some(misfits::histories(tests.as_deref(), stored)),
        measured,
        Some(parameters::section(stored)),
        Some(misfits::section(stored)),
        Some(convergence::section(stored)),
    ];
    Page {
        title: "Calibration".into(),
        lead: lead(stored),
        unfinished: None,
        numbers: numbers(stored),
        notes: notes(stored),
        sections: sections.into_iter().flatten().collect(),
        provenance: origin(stored, note),
        files: files.into_iter().map(Link::to).collect(),
        ..Page::default()
    }
}

fn lead(stored: &Calibration) -> String {
    let fit = stored.tests.iter().filter(|test| test.purpose == "fit").count();
    let held = stored.tests.len() - fit;
    let count = |is: Identifiability| stored.parameters.iter().filter(|p| p.identifiability == is).count();
    let told = match (count(Identifiability::SearchesDisagree), count(Identifiability::NotFollowed)) {
        (0, 0) => format!("{} of them are told by the tests.", count(Identifiability::Identified)),
        (0, _) => "none is identified, for the tests are not followed to their noise.".to_owned(),
        (apart, _) => format!("the searches disagree, so {apart} of the values are to be distrusted."),
    };
    format!(
        "{} numbers of a wall sought in {fit} test{}, {held} held out; {told}",
        stored.parameters.len(),
        if fit == 1 { "" } else { "s" }
    )
}

/// Mean of the misfits that exist.
fn mean(values: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let values: Vec<f64> = values.flatten().collect();
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// A misfit as people read it.
fn wme(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_owned(), |value| format!("{value:.3}"))
}

fn numbers(stored: &Calibration) -> Vec<Number> {
    let of = |purpose: &str, joint: bool| {
        let tests = stored.tests.iter().filter(|test| test.purpose == purpose);
        mean(tests.map(|test| if joint { test.wme_joint } else { test.wme_before }))
    };
    let mut numbers = vec![
        Number::new(wme(of("fit", true)), "mean WME of the tests to fit"),
        Number::new(wme(of("fit", false)), "the same before calibration, C_l = 1"),
    ];
    if stored.tests.iter().any(|test| test.purpose != "fit") {
        numbers.push(Number::new(wme(of("hold-out", true)), "mean WME of the tests held out"));
    }
    numbers.push(Number::new(stored.simulations, "simulations"));
    numbers
}

fn notes(stored: &Calibration) -> Vec<String> {
    let mut notes = vec![format!(
        "Assumed: impact law “{}”, capture velocity {:e} rad/s. WME: mean absolute error of both rotations, each over its mean absolute measured rotation (Eq. 8).",
        stored.law, stored.capture_velocity_rad_s
    )];
    notes.extend(disagreement(&stored.methods, stored.likelihood.as_ref()));
    let on_bound: Vec<&str> =
        stored.parameters.iter().filter(|p| p.on_bound).map(|p| p.name.as_str()).collect();
    if !on_bound.is_empty() {
        notes.push(format!("On a bound, which then decides the value: {}.", on_bound.join(", ")));
    }
    notes
}

fn origin(stored: &Calibration, note: &Note) -> Vec<(String, String)> {
    let pair = |name: &str, value: String| (name.to_owned(), value);
    let mut pairs = note.pairs();
    pairs.extend([
        pair("seed", stored.seed.to_string()),
        pair("inputs together", format!("SHA-256 {}", stored.request_sha256)),
        pair("bounds of C_l", stored.bounds_source.clone()),
        pair("tolerance", format!("{:e} of αᵢ", stored.tolerance)),
    ]);
    pairs
}
