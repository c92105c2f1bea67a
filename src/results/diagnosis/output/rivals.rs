//! The figures of every hypothesis that was tried.

use rayon::prelude::*;
use serde_json::{Value, json};

use super::summary::sd;
use super::tests::whole_wme;
use mrbd_kernel::model::Wall;
use mrbd_lab::diagnose::certainty::ensemble;
use mrbd_lab::diagnose::experiment::Experiment;
use mrbd_lab::diagnose::hypothesis::Addition;
use mrbd_lab::diagnose::trials::{Data, Tried, against};
use mrbd_lab::diagnose::verdict::names;
use mrbd_lab::experiment::Test;
use mrbd_lab::experiment_file::Purpose;

/// One hypothesis that was tried, with the figures of every other.
pub fn rival(experiment: &Experiment, data: &Data, tried: &Tried) -> Value {
    let h = &tried.hypothesis;
    let added = h.nuisances..h.unknowns.len();
    let [fit, held_out] = tried.errors();
    let [against_fit, against_held_out] = tried.against(data);
    // The vertical motion of the placebo is not in its wall.
    let is_placebo = h.additions.contains(&Addition::Placebo);
    let walls = if is_placebo { Vec::new() } else { ensemble(tried).unwrap_or_default() };
    let wme = |purpose| walls.par_iter().map(|wall| mean_wme(experiment, wall, purpose)).collect::<Vec<_>>();
    let [wme_fit, wme_held_out] = [Purpose::Fit, Purpose::HoldOut].map(wme);
    let fitted = |all: &[Option<f64>]| all.first().copied().flatten();
    json!({
        "name": h.additions.iter().map(|a| a.name()).collect::<Vec<_>>().join(" + "),
        "kinds": names(tried),
        "place": h.additions.first().map(|a| a.place()),
        "parameters": added.map(|i| json!({"key": h.unknowns[i].key, "unit": h.unknowns[i].unit,
            "value": tried.fit.values[i], "sd": sd(tried, i)})).collect::<Vec<_>>(),
        "windowed_error": {"fit": fit, "held_out": held_out},
        "against": {"fit": against_fit, "held_out": against_held_out, "all": against(data, tried)},
        "wme": {"fit": fitted(&wme_fit), "held_out": fitted(&wme_held_out)},
        "wme_range": {"fit": range(&wme_fit), "held_out": range(&wme_held_out)},
    })
}

/// Least and largest of the errors of an ensemble; none where there are less than two.
fn range(errors: &[Option<f64>]) -> Option<[f64; 2]> {
    let told = errors.iter().flatten().copied().collect::<Vec<_>>();
    (told.len() > 1).then(|| {
        let most = told.iter().fold(f64::NEG_INFINITY, |m, x| m.max(*x));
        [told.iter().fold(f64::INFINITY, |m, x| m.min(*x)), most]
    })
}

/// Mean of Eq. 8 over whole runs of the tests of a purpose; none if a run failed or there is no such test.
fn mean_wme(experiment: &Experiment, wall: &Wall, purpose: Purpose) -> Option<f64> {
    let of = |test: &&Test| test.purpose == purpose;
    let all = experiment.whole.iter().filter(of).map(|t| whole_wme(t, wall)).collect::<Option<Vec<_>>>()?;
    (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64)
}
