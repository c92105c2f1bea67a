//! How the plan in a folder differs from the one that was asked for.

use serde_json::Value;

use super::manifest::Manifest;

/// Differences told; the first ones show what happened.
const TOLD: usize = 6;

/// What decides results and is not the same: key, what is there, what was asked for. Empty for the same study.
pub(super) fn differences(there: &Manifest, now: &Manifest) -> Vec<String> {
    let mut found = Vec::new();
    compare("", &deciding(there), &deciding(now), &mut found);
    let more = found.len().saturating_sub(TOLD);
    found.truncate(TOLD);
    if more > 0 {
        found.push(format!("and {more} more"));
    }
    found
}

/// A manifest without what does not decide: the time, where files lie, and the pipeline's text, whose comments may
/// change; what the pipeline says is in the plan's hash and the variants.
fn deciding(manifest: &Manifest) -> Value {
    let mut same = Manifest { started_unix_s: 0, ..manifest.clone() };
    same.inputs.retain(|input| input.role != "pipeline");
    for input in &mut same.inputs {
        input.path.clear();
        input.path_from_folder = None;
    }
    serde_json::json!(same)
}

fn compare(key: &str, there: &Value, now: &Value, found: &mut Vec<String>) {
    match (there, now) {
        (Value::Object(a), Value::Object(b)) => {
            let names = a.keys().chain(b.keys().filter(|name| !a.contains_key(*name)));
            for name in names {
                let key = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
                compare(
                    &key,
                    a.get(name).unwrap_or(&Value::Null),
                    b.get(name).unwrap_or(&Value::Null),
                    found,
                );
            }
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            for (i, (a, b)) in a.iter().zip(b).enumerate() {
                compare(&format!("{key}[{i}]"), a, b, found);
            }
        }
        (Value::Array(a), Value::Array(b)) => {
            found.push(format!("{key}: {} entries, now {}", a.len(), b.len()));
        }
        (a, b) if a != b => found.push(format!("{key}: {a}, now {b}")),
        _ => {}
    }
}
