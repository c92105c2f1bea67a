//! `diagnosis.json`: the verdict, with everything it rests on.

use serde_json::{Value, json};

use super::KIND;
use super::rivals::rival;
use super::tests::tests;
use mrbd_lab::diagnose::certainty::{confused, intervals};
use mrbd_lab::diagnose::experiment::Experiment;
use mrbd_lab::diagnose::flow::Diagnosis;
use mrbd_lab::diagnose::hypothesis::Unknown;
use mrbd_lab::diagnose::trials::{Data, FRICTION, Tried, against, giving_friction, joint_error};
use mrbd_lab::diagnose::verdict::{Found, Verdict, power};

/// Everything the verdict rests on.
pub fn summary(experiment: &Experiment, diagnosis: &Diagnosis) -> Value {
    let data = diagnosis.data(experiment);
    let found = &diagnosis.found;
    let answered = matches!(found.verdict, Verdict::Named | Verdict::Class);
    let effects = if answered { effects(&data, &found.after) } else { Vec::new() };
    let unknown = json!({"kind": null, "place": found.place, "parameters": {}, "interval": {}});
    let effects = if found.verdict == Verdict::PlaceOnly { vec![unknown] } else { effects };
    let rivals = found.tried.iter().map(|tried| rival(experiment, &data, tried)).collect::<Vec<_>>();
    json!({
        "kind": KIND,
        "verdict": found.verdict,
        "place": found.place.or(answered.then(|| found.after.hypothesis.additions[0].place())),
        "effects": effects,
        "equivalent": found.equivalent,
        "wall": numbers(&found.after, 0..found.after.hypothesis.nuisances),
        "tests": tests(experiment, diagnosis),
        "other_law": found.other_law,
        "windowed_error": {
            "before": joint_error(&found.before),
            "recalibrated": joint_error(&found.recalibrated),
            "after": joint_error(found.kept()),
        },
        "against": {
            "before": against(&data, &found.before),
            "recalibrated": against(&data, &found.recalibrated),
            "after": against(&data, found.kept()),
        },
        "windows": {
            "fit": data.fit.windows.len(),
            "held_out": data.held_out.windows.len(),
            "opened": diagnosis.windows.iter().flatten().filter(|window| window.opened).count(),
        },
        "could_hide": could_hide(&data, found),
        "confused": confused(&data, &found.recalibrated, &found.tried),
        "rivals": rivals,
        "program": concat!("mrbd ", env!("CARGO_PKG_VERSION")),
        "experiment": experiment.path.display().to_string(),
    })
}

/// The effects of an answer with their numbers and 90 % intervals.
fn effects(data: &Data, after: &Tried) -> Vec<Value> {
    let h = &after.hypothesis;
    let intervals = intervals(data, after);
    let mut from = h.nuisances;
    let mut all = Vec::new();
    for (index, addition) in h.additions.iter().enumerate() {
        let count = h.unknowns.iter().filter(|u| u.belongs_to(index)).count();
        let range = from..from + count;
        from += count;
        if let Some(friction) = giving_friction(h, &after.fit.values, index) {
            all.push(json!({
                "kind": FRICTION,
                "name": FRICTION,
                "place": addition.place(),
                "parameters": {"force_n": after.fit.values[friction.force]},
                "interval": {"force_n": intervals[friction.force]},
                "written_as": addition.name(),
                "sets_in_over_m": friction.onset_m,
            }));
            continue;
        }
        let of = |f: &dyn Fn(usize) -> Value| {
            range.clone().map(|i| (h.unknowns[i].key.clone(), f(i))).collect::<serde_json::Map<_, _>>()
        };
        all.push(json!({
            "kind": addition.kind(),
            "name": addition.name(),
            "place": addition.place(),
            "parameters": of(&|i| json!(after.fit.values[i])),
            "interval": of(&|i| json!(intervals[i])),
        }));
    }
    all
}

/// Fitted numbers of the wall with their standard deviations, and what they were.
fn numbers(tried: &Tried, range: std::ops::Range<usize>) -> Vec<Value> {
    let h = &tried.hypothesis;
    range
        .map(|i| {
            let Unknown { key, unit, start, prior_sd, .. } = &h.unknowns[i];
            json!({"key": key, "unit": unit, "before": start, "prior_sd": prior_sd,
                   "after": tried.fit.values[i], "sd": sd(tried, i)})
        })
        .collect()
}

/// Standard deviation of a fitted number; none where it leaves no trace.
pub fn sd(tried: &Tried, i: usize) -> Option<f64> {
    tried.fit.covariance.as_ref().map(|c| c[(i, i)].max(0.0).sqrt())
}

/// For each kind, the smallest sizes that would have been told from nothing and named, and the size at which it would matter.
fn could_hide(data: &Data, found: &Found) -> Vec<Value> {
    let singles = found.tried.iter().filter(|t| t.hypothesis.additions.len() == 1);
    let row = |tried: &Tried| {
        let power = power(data, &found.recalibrated, tried)?;
        let h = &tried.hypothesis;
        let unknown = &h.unknowns[h.nuisances];
        Some(json!({
            "kind": h.additions[0].kind()?, "name": h.additions[0].name(),
            "parameter": unknown.key, "unit": unknown.unit,
            "estimate": tried.fit.values[h.nuisances] - unknown.start, "sd": power.sd,
            "smallest_detectable": power.detected_from, "named_from": power.named_from, "matters": power.matters,
        }))
    };
    singles.filter_map(row).collect()
}
