//! Where a page comes from: the manifest, what is generated or assumed, and the files behind it.

use std::path::Path;

use super::page::{Link, address};
use crate::aggregate::Medians;
use crate::error::Result;
use crate::store::{Manifest, run_files};

/// The manifest as names and values.
pub fn of(manifest: &Manifest) -> Vec<(String, String)> {
    let pair = |name: &str, value: String| (name.to_owned(), value);
    let mut pairs = vec![
        pair(
            "program",
            format!("mrbd {}, result columns version {}", manifest.tool_version, manifest.schema_version),
        ),
        pair("plan", format!("{}, {} runs, SHA-256 {}", manifest.plan, manifest.runs, manifest.plan_sha256)),
        pair("seed", manifest.seed.map_or("none: nothing is drawn".to_owned(), |seed| seed.to_string())),
        pair("begun", format!("{} (UTC)", utc(manifest.started_unix_s))),
        pair("gravity", format!("{} m/s²", manifest.gravity_m_s2)),
    ];
    pairs.extend(manifest.inputs.iter().map(|file| {
        // The folder a file lay in says nothing to who reads the page.
        let name =
            Path::new(&file.path).file_name().map_or(file.path.clone(), |n| n.to_string_lossy().into_owned());
        (file.role.clone(), format!("{name}, SHA-256 {}", file.sha256))
    }));
    pairs.extend(manifest.suite.records.iter().map(|record| {
        let event = if record.event.is_empty() { String::new() } else { format!(", {}", record.event) };
        let text = format!("{}{event}, scaled by {}, SHA-256 {}", record.name, record.scale, record.sha256);
        ("record".to_owned(), text)
    }));
    pairs
}

/// What a reader must know before the figures: generated records, assumptions, failed runs.
pub fn notes(manifest: &Manifest, medians: &Medians) -> Vec<String> {
    let suite = &manifest.suite;
    let mut notes = vec![if suite.generated {
        format!(
            "The records of suite “{}” are generated, not measured: the figures say what the model does under such motions, not what the paper’s records did.",
            suite.name
        )
    } else {
        format!(
            "The records of suite “{}” are measured; the paper’s own are another selection for the same spectrum.",
            suite.name
        )
    }];
    if let Some(base) = medians.variants.first() {
        notes.push(format!(
            "Assumed where the paper is silent (variant “{}”): strip of {} m, density {} kg/m³, impact law “{}”, capture velocity {:e} rad/s.",
            base.name, base.length_m, base.density_kg_m3, base.law, base.capture_velocity_rad_s
        ));
    }
    let failed: u64 = medians.variants.iter().map(|variant| variant.failed).sum();
    if failed > 0 {
        notes.push(format!("{failed} runs failed and take no part in the medians."));
    }
    notes
}

/// Links to the run files, one a record and part.
///
/// # Errors
/// As [`run_files`].
pub fn run_links(folder: &Path) -> Result<Vec<Link>> {
    let link = |path: &std::path::PathBuf| {
        let relative = path.strip_prefix(folder).unwrap_or(path).to_string_lossy().replace('\\', "/");
        let text = relative.strip_prefix("runs/record=").unwrap_or(&relative).to_owned();
        Link { text, href: address(&relative) }
    };
    Ok(run_files(folder)?.iter().map(link).collect())
}

/// All files behind a page.
pub fn files(runs: Vec<Link>) -> Vec<Link> {
    let named = |name: &str| Link { text: name.to_owned(), href: name.to_owned() };
    let mut files = vec![named("manifest.json"), named("plan.toml"), named("medians.parquet")];
    files.extend(runs);
    files
}

/// A time as people write it, by the civil calendar (days to dates after Howard Hinnant, public domain).
fn utc(unix_s: u64) -> String {
    let (days, second) = (unix_s / 86_400, unix_s % 86_400);
    let z = days + 719_468;
    let era_day = z % 146_097;
    let era_year = (era_day - era_day / 1_460 + era_day / 36_524 - era_day / 146_096) / 365;
    let year_day = era_day - (365 * era_year + era_year / 4 - era_year / 100);
    let shifted_month = (5 * year_day + 2) / 153;
    let day = year_day - (153 * shifted_month + 2) / 5 + 1;
    let month = if shifted_month < 10 { shifted_month + 3 } else { shifted_month - 9 };
    let year = era_year + (z / 146_097) * 400 + u64::from(month <= 2);
    format!("{year}-{month:02}-{day:02} {:02}:{:02}:{:02}", second / 3600, second / 60 % 60, second % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_times_of_the_civil_calendar() {
        assert_eq!(utc(0), "1970-01-01 00:00:00");
        assert_eq!(utc(951_782_400), "2000-02-29 00:00:00");
        assert_eq!(utc(1_338_271_203), "2012-05-29 06:00:03");
        assert_eq!(utc(4_102_444_799), "2099-12-31 23:59:59");
    }
}
