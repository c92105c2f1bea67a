//! Where a page comes from: the manifest, what is generated or assumed, and the files behind it.

use std::path::{Path, PathBuf};

use super::page::{Link, address};
use crate::aggregate::VariantNote;
use crate::study::runs::{Completeness, Manifest};
pub use crate::summary::{Note, read_json};
use crate::text::utc;
use mrbd_files::FileNote;

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
    pairs.extend(inputs(&manifest.inputs));
    pairs.extend(manifest.suite.records.iter().map(|record| {
        let event = if record.event.is_empty() { String::new() } else { format!(", {}", record.event) };
        let text = format!("{}{event}, scaled by {}, SHA-256 {}", record.name, record.scale, record.sha256);
        ("record".to_owned(), text)
    }));
    pairs
}

/// The files that were read, by role.
pub fn inputs(files: &[FileNote]) -> impl Iterator<Item = (String, String)> {
    files.iter().map(|file| {
        // The folder a file lay in says nothing to who reads the page.
        let name =
            Path::new(&file.path).file_name().map_or(file.path.clone(), |n| n.to_string_lossy().into_owned());
        (file.role.clone(), format!("{name}, SHA-256 {}", file.sha256))
    })
}

impl Note {
    /// The manifest as names and values.
    pub fn pairs(&self) -> Vec<(String, String)> {
        let pair = |name: &str, value: String| (name.to_owned(), value);
        let mut pairs = vec![
            pair("program", format!("mrbd {}", self.tool_version)),
            pair("begun", format!("{} (UTC)", utc(self.started_unix_s))),
        ];
        pairs.extend(self.suite.iter().map(|suite| pair("suite", suite.clone())));
        pairs.extend(inputs(&self.inputs));
        pairs
    }

    /// A sentence on generated records; `None` where they are recorded.
    pub fn generated_note(&self) -> Option<String> {
        let suite = self.suite.as_deref().filter(|_| self.generated)?;
        Some(format!("The records of suite “{suite}” are generated, not measured."))
    }
}

/// What stands at the head of the page of an unfinished study, and under each of its figures and tables.
pub fn unfinished(study: Option<Completeness>) -> Option<String> {
    let study = study.filter(|study| !study.is_whole())?;
    Some(format!("Unfinished: {study}."))
}

/// What a reader must know before the figures: generated records, assumptions, failed runs.
pub fn notes(manifest: &Manifest, variants: &[VariantNote]) -> Vec<String> {
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
    if let Some(base) = variants.first() {
        notes.push(format!(
            "Assumed where the paper is silent (variant “{}”): strip of {} m, density {} kg/m³, impact law “{}”, capture velocity {:e} rad/s.",
            base.name, base.length_m, base.density_kg_m3, base.law, base.capture_velocity_rad_s
        ));
    }
    let failed: u64 = variants.iter().map(|variant| variant.failed).sum();
    if failed > 0 {
        notes.push(format!("{failed} runs failed and take no part in the medians."));
    }
    notes
}

/// Links to the run files: a record's name where it has one file, else with the name of the file.
pub fn run_links(files: &[PathBuf]) -> Vec<Link> {
    let record = |file: &PathBuf| file.parent().map(Path::to_path_buf);
    let link = |file: &PathBuf| {
        let path = file.to_string_lossy().replace('\\', "/");
        let prefixes = ["runs/record=", "runs/sequence="];
        let name = prefixes.iter().find_map(|prefix| path.strip_prefix(prefix)).unwrap_or(&path);
        let alone = files.iter().filter(|other| record(other) == record(file)).count() == 1;
        let name = if alone { name.strip_suffix("/part-1.parquet").unwrap_or(name) } else { name };
        Link { text: name.to_owned(), href: address(&path) }
    };
    files.iter().map(link).collect()
}

/// All files behind a page.
pub fn files(runs: Vec<Link>) -> Vec<Link> {
    let named = |name: &str| Link { text: name.to_owned(), href: name.to_owned() };
    let mut files = vec![named("manifest.json"), named("plan.toml"), named("medians.parquet")];
    files.extend(runs);
    files
}
