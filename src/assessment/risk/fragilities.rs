//! Fragilities as mrbd writes them: `mrbd margin` and `mrbd fragility --json`, and NRML.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::nrml;
use crate::assessment::margin::Margin;
use crate::error::{InputError, Result};
use mrbd_files::toml_file;

/// What a fragility file is.
const ALLOWED: &str =
    "margin.json of `mrbd margin`, the output of `mrbd fragility --json`, or a fragilityModel in NRML 0.5";

/// A log-normal fragility of a limit state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LimitState {
    /// Its name, and of what.
    pub name: String,
    /// Measure of intensity with its unit; `None` where the file does not say.
    pub measure: Option<String>,
    /// Median θ.
    pub median: f64,
    /// Its 95 % interval over records and façades; `None` where it is open or not told.
    pub median_interval: Option<[f64; 2]>,
    /// Dispersion β.
    pub beta: f64,
    /// Its interval.
    pub beta_interval: Option<[f64; 2]>,
}

/// Reads fragilities; of a file with several measures those of the one that is asked for.
///
/// # Errors
/// Input errors with the file; one without any fragility of this measure.
pub fn read_fragilities(path: &Path, measure: &str) -> Result<Vec<LimitState>> {
    let text = toml_file::read(path)?;
    let all = match text.trim_start().starts_with('<') {
        true => from_nrml(path, &text)?,
        false => from_json(path, &text)?,
    };
    let measures: Vec<&str> = all.iter().filter_map(|state| state.measure.as_deref()).collect();
    let given = measures.join(", ");
    let same = |state: &LimitState| state.measure.as_deref().is_none_or(|known| known == measure);
    let found: Vec<LimitState> = all.iter().filter(|state| same(state)).cloned().collect();
    if found.is_empty() {
        let found =
            if given.is_empty() { "no fragility".to_owned() } else { format!("fragilities in {given}") };
        return Err(
            InputError::file(path, found, format!("one in {measure}, as the hazard curve has it")).into()
        );
    }
    Ok(found)
}

fn ends([low, high]: [Option<f64>; 2]) -> Option<[f64; 2]> {
    Some([low.filter(|x| *x > 0.0)?, high?])
}

fn from_json(path: &Path, text: &str) -> Result<Vec<LimitState>> {
    let value: Value =
        serde_json::from_str(text).map_err(|e| InputError::line(path, e.line(), e.to_string(), ALLOWED))?;
    if let Some(groups) = value["groups"].as_array() {
        return Ok(groups.iter().filter_map(of_group).collect());
    }
    let margin: Margin =
        serde_json::from_value(value).map_err(|e| InputError::file(path, e.to_string(), ALLOWED))?;
    let state = |curve: crate::assessment::margin::Curve| {
        Some(LimitState {
            name: format!("{}, {}", margin.wall, margin.limit),
            measure: Some(curve.measure),
            median: curve.median?,
            median_interval: ends(curve.median_interval),
            beta: curve.beta?,
            beta_interval: ends(curve.beta_interval),
        })
    };
    Ok(margin.fragility.into_iter().filter_map(state).collect())
}

/// A group of `mrbd fragility --json`; `None` where it tells no fragility.
fn of_group(group: &Value) -> Option<LimitState> {
    let number = |value: &Value, key: &str| value[key].as_f64();
    let (median, beta) = (number(group, "median")?, number(group, "beta")?);
    let bootstrap = &group["bootstrap"];
    let best = [&bootstrap["bca"], &bootstrap["percentile"], &group["profile"]];
    let best = best.into_iter().find(|bounds| bounds.is_object());
    let interval = |key: &str| ends([0, 1].map(|end| best.and_then(|bounds| bounds[key][end].as_f64())));
    let names = group["group"].as_object().into_iter().flatten();
    let names: Vec<String> =
        names.map(|(key, value)| format!("{key}={}", value.as_str().unwrap_or_default())).collect();
    let name = if names.is_empty() { "fragility".to_owned() } else { names.join(",") };
    Some(LimitState {
        name,
        measure: None,
        median,
        median_interval: interval("median"),
        beta,
        beta_interval: interval("beta"),
    })
}

fn from_nrml(path: &Path, text: &str) -> Result<Vec<LimitState>> {
    let document = nrml::parse(path, text)?;
    let mut states = Vec::new();
    for function in nrml::elements(document.root_element(), "fragilityFunction") {
        let imls = nrml::elements(function, "imls").next();
        let imt = imls.and_then(|imls| nrml::attribute(imls, &["imt"]));
        for params in nrml::elements(function, "params") {
            let attribute = |name: &str| {
                let missing = || InputError::file(path, format!("params without {name}"), ALLOWED);
                Ok::<_, crate::error::Error>(params.attribute(name).ok_or_else(missing)?)
            };
            let mean = nrml::number(path, params, attribute("mean")?)?;
            let deviation = nrml::number(path, params, attribute("stddev")?)?;
            // Back as OpenQuake does it: β² = ln(1 + s²/m²), θ = m²/√(m² + s²).
            let beta = (deviation / mean).powi(2).ln_1p().sqrt();
            states.push(LimitState {
                name: format!("{}, {}", function.attribute("id").unwrap_or("fragility"), attribute("ls")?),
                measure: imt.map(nrml::measure),
                median: mean * mean / mean.hypot(deviation),
                median_interval: None,
                beta,
                beta_interval: None,
            });
        }
    }
    Ok(states)
}
