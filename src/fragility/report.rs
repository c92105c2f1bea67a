//! Analyses as people and scripts read them: a table, JSON, curves as CSV.

use serde_json::{Map, Value, json};

use super::analysis::{Analysis, BootstrapResult, Bounds, Known, Settings};
use super::goodness::Goodness;
use super::interval::Interval;
use super::shares::Share;
use crate::study::runs::Completeness;

/// Points of a curve: 100 steps, even in the logarithm.
const CURVE_STEPS: u32 = 100;

/// An analysis and the group it belongs to.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupAnalysis {
    /// Values of the group columns.
    pub key: Vec<String>,
    /// Rows without an outcome.
    pub without_outcome: usize,
    /// What the others tell.
    pub analysis: Analysis,
}

/// Groups by name: `column=value` joined by commas, or `fragility` where there are no groups.
pub fn name_of(columns: &[String], key: &[String]) -> String {
    if key.is_empty() {
        return "fragility".into();
    }
    let parts: Vec<String> = columns.iter().zip(key).map(|(name, value)| format!("{name}={value}")).collect();
    parts.join(",")
}

/// One line a group: trials, failures, median and β with their intervals, fit; or why there is no fragility.
///
/// A last line tells of an unfinished study.
pub fn table(
    columns: &[String],
    groups: &[GroupAnalysis],
    settings: &Settings,
    study: Option<Completeness>,
) -> String {
    let names: Vec<String> = groups.iter().map(|group| name_of(columns, &group.key)).collect();
    let width = names.iter().map(|name| name.chars().count()).max().unwrap_or(0).max(5);
    let head = format!("{:.0} % interval", 100.0 * settings.level);
    let mut lines = vec![format!(
        "{:<width$} {:>8} {:>8} {:>10} {:<22} {:>7} {:<18} {:<10} {:>6} {:>8}  {}",
        "group",
        "trials",
        "failures",
        "median",
        head,
        "beta",
        head,
        "by",
        "AUC",
        "McFadden",
        "shares of variance"
    )];
    for (name, group) in names.iter().zip(groups) {
        lines.push(line(name, width, &group.analysis));
    }
    lines.extend(study.and_then(|study| study.note()).map(|note| format!("UNFINISHED: {note}")));
    lines.join("\n")
}

fn line(name: &str, width: usize, analysis: &Analysis) -> String {
    let Analysis { failures, trials, result, .. } = analysis;
    let start = format!("{name:<width$} {trials:>8} {failures:>8}");
    let known = match result {
        Err(unknown) => return format!("{start} unknown: {unknown}"),
        Ok(known) => known,
    };
    let curve = known.fitted.curve;
    let (by, bounds) = known.best().map_or(("", None), |(by, bounds)| (by, Some(bounds)));
    let interval = |of: fn(&Bounds) -> Interval| bounds.as_ref().map_or(String::new(), |b| range(of(b)));
    let fit = known.goodness.as_ref().map(|fit| format!(" {:>6.3} {:>8.3}", fit.auc, fit.mcfadden));
    let shares = known.shares.iter().flatten().map(|share| format!("{} {:.2}", share.name, share.share));
    let shares: Vec<String> = shares.collect();
    format!(
        "{start} {:>10.4} {:<22} {:>7.3} {:<18} {by:<10}{}  {}",
        curve.median(),
        interval(|b| b.median),
        curve.beta(),
        interval(|b| b.beta),
        fit.unwrap_or_else(|| format!("{:16}", "")),
        shares.join(", ")
    )
}

fn range(interval: Interval) -> String {
    let bound = |value: Option<f64>| value.map_or("?".to_owned(), |value| format!("{value:.4}"));
    format!("[{}, {}]", bound(interval.lower), bound(interval.upper))
}

/// Everything as JSON; `study` is how much of its plan the study has run, null for other tables.
pub fn as_json(
    columns: &[String],
    groups: &[GroupAnalysis],
    settings: &Settings,
    study: Option<Completeness>,
) -> Value {
    let group = |group: &GroupAnalysis| {
        let key: Map<String, Value> =
            columns.iter().zip(&group.key).map(|(name, value)| (name.clone(), json!(value))).collect();
        let Analysis { failures, trials, range, result } = &group.analysis;
        let mut value = json!({
            "group": key,
            "trials": trials,
            "failures": failures,
            "without_outcome": group.without_outcome,
            "intensity_range": range,
            "extrapolated": group.analysis.extrapolates(),
        });
        match result {
            Ok(known) => merge(&mut value, known_as_json(known, settings)),
            Err(unknown) => merge(
                &mut value,
                json!({"status": "unknown", "reason": unknown.name(), "message": unknown.to_string()}),
            ),
        }
        value
    };
    json!({
        "method": settings.method.name(),
        "level": settings.level,
        "seed": settings.bootstrap.seed,
        "study": study,
        "groups": groups.iter().map(group).collect::<Vec<_>>(),
    })
}

fn merge(into: &mut Value, from: Value) {
    if let (Value::Object(into), Value::Object(from)) = (into, from) {
        into.extend(from);
    }
}

fn known_as_json(known: &Known, settings: &Settings) -> Value {
    let (curve, errors) = (known.fitted.curve, known.errors.as_ref());
    let cloud = known.fitted.cloud.map(|cloud| {
        let collapse = cloud.collapse.map(|line| json!({"intercept": line.intercept, "slope": line.slope}));
        json!({"intercept": cloud.intercept, "slope": cloud.slope, "scatter": cloud.scatter, "collapse": collapse})
    });
    json!({
        "status": "fitted",
        "median": curve.median(),
        "beta": curve.beta(),
        "log_likelihood": known.fitted.log_likelihood,
        "ln_median_standard_error": errors.map(|fit| fit.ln_median_error),
        "beta_standard_error": errors.map(|fit| fit.beta_error),
        "profile": known.profile.as_ref().map(bounds_as_json),
        "bootstrap": known.bootstrap.as_ref().map(|result| bootstrap_as_json(result, settings)),
        "cloud": cloud,
        "goodness": known.goodness.as_ref().map(goodness_as_json),
        "variance_shares": known.shares.as_deref().map(shares_as_json),
    })
}

fn bounds_as_json(bounds: &Bounds) -> Value {
    let pair = |interval: Interval| json!([interval.lower, interval.upper]);
    json!({"median": pair(bounds.median), "beta": pair(bounds.beta)})
}

fn bootstrap_as_json(result: &BootstrapResult, settings: &Settings) -> Value {
    json!({
        "replicates": settings.bootstrap.replicates,
        "percentile_level": result.level,
        "unknown_replicates": result.unknown,
        "percentile": bounds_as_json(&result.percentile),
        "bca": result.bias_corrected.as_ref().map(bounds_as_json),
    })
}

fn goodness_as_json(fit: &Goodness) -> Value {
    let binned = fit.binned.as_ref().map(|check| {
        let bins = check.bins.iter().map(|bin| {
            json!({
                "up_to": bin.up_to,
                "trials": bin.trials,
                "observed": bin.observed,
                "expected": bin.expected,
            })
        });
        json!({"statistic": check.statistic, "p_value": check.p_value, "bins": bins.collect::<Vec<_>>()})
    });
    json!({
        "log_likelihood": fit.log_likelihood,
        "null_log_likelihood": fit.null_log_likelihood,
        "mcfadden": fit.mcfadden,
        "auc": fit.auc,
        "hosmer_lemeshow": binned,
    })
}

fn shares_as_json(shares: &[Share]) -> Value {
    let mut map: Map<String, Value> =
        shares.iter().map(|share| (share.name.clone(), json!(share.share))).collect();
    let explained: f64 = shares.iter().map(|share| share.share).sum();
    // Each share is told from its own pairs, so by chance they may add up to more than 1.
    map.insert("rest".into(), json!((explained <= 1.0).then_some(1.0 - explained)));
    Value::Object(map)
}

/// Header and rows of the curves as CSV: group columns, intensity, probability and its pointwise interval.
///
/// Each curve runs over the intensities of its data and its own from 1 % to 99 %. Groups without one have no rows.
/// Curves of a study have two columns more: its runs that are stored, and those of its plan.
///
/// # Errors
/// What the writer says.
pub fn write_curves(
    out: impl std::io::Write,
    columns: &[String],
    groups: &[GroupAnalysis],
    study: Option<Completeness>,
) -> csv::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    let header = columns.iter().map(String::as_str).chain(["intensity", "probability", "lower", "upper"]);
    let names = study.map(|_| ["study_runs", "planned_runs"]);
    writer.write_record(header.chain(names.into_iter().flatten()))?;
    let counts = study.map(|study| [study.runs, study.planned_runs].map(|runs| runs.to_string()));
    for group in groups {
        let (Ok(known), Some(range)) = (&group.analysis.result, group.analysis.range) else { continue };
        for [x, p, lower, upper] in curve(known, range) {
            // Debug writes small numbers with an exponent.
            let cell = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:?}"));
            let numbers = [x, p, lower, upper].map(cell);
            let counts = counts.iter().flatten();
            writer.write_record(group.key.iter().chain(&numbers).chain(counts))?;
        }
    }
    writer.flush()?;
    Ok(())
}

fn curve(known: &Known, range: [f64; 2]) -> Vec<[Option<f64>; 4]> {
    let low = known.fitted.curve.intensity_at(0.01).min(range[0]).ln();
    let high = known.fitted.curve.intensity_at(0.99).max(range[1]).ln();
    let point = |i: u32| {
        let x = low + (high - low) * f64::from(i) / f64::from(CURVE_STEPS);
        let interval = known.bootstrap.as_ref().map(|result| result.probability_at_ln(x));
        let Interval { lower, upper } = interval.unwrap_or_default();
        [Some(x.exp()), Some(known.fitted.probability_at_ln(x)), lower, upper]
    };
    (0..=CURVE_STEPS).map(point).collect()
}
