//! `mrbd assess`: the code's check of a wall, and what the dynamics say of it.

use std::path::{Path, PathBuf};

use clap::Args;

use super::progress::Bar;
use super::threads::Threads;
use super::{Answer, output};
use crate::assessment::governing::{csv_bytes, governing_run};
use crate::assessment::wall::{Assessed, Compared, FILES, KIND, Language, SuiteNote, WallNumbers};
use crate::error::{Error, InputError, Result};
use crate::store::{WholeFolder, write_durably};
use crate::text::aligned;
use mrbd_assessment::{Agreement, Assessment, NoMechanism, Shaken, SiteFile, SiteRecords, motions};
use mrbd_files::{FileNote, load_static_wall};
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::Accuracy;
use mrbd_lab::Progress;
use mrbd_records::Suite;

/// Check a wall against the Italian code, and by its own dynamics under records of the site.
///
/// Circolare 2019, C8.7.1.2.1: α_0 by virtual work in every mechanism, e*, the linear check (q = 2), the nonlinear one with
/// T_SLV, a_g,SLV and ζ, at the ground or on a floor (C7.2.3). With --records also the check by nonlinear dynamic analysis
/// (C8.7.1.2.1.9): beyond d_0 in no run, and the mean of the largest displacements below d_SLV.
/// The site file has `[site]` as `mrbd records check` reads it, and may have `[building]`, `[assessment]` and `[sources]`.
///
/// Examples:
///   mrbd assess wall.toml --site site.toml
///   mrbd assess wall.toml --site site.toml --records records/suite.toml --language it --out outputs/assessment
///   mrbd assess wall.toml --site site.toml --compare tied.toml --json
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct AssessCommand {
    /// Wall file (TOML).
    wall: PathBuf,
    /// Site file (TOML).
    #[arg(long, value_name = "FILE")]
    site: PathBuf,
    /// Suite of records compatible with the site: the dynamics too.
    #[arg(long, value_name = "FILE")]
    records: Option<PathBuf>,
    /// Another wall file at the same site: with a tie, with a stiffer floor.
    #[arg(long, value_name = "FILE")]
    compare: Option<PathBuf>,
    /// Language of the page.
    #[arg(long, value_enum, default_value = "en")]
    language: Language,
    /// Write assessment.json and the page to hand in into a folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace the results in that folder.
    #[arg(long, requires = "out")]
    force: bool,
    /// Print everything as JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    threads: Threads,
}

/// What shakes a wall, brought to where it stands.
type Motions = Vec<(String, Accelerogram)>;

impl AssessCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// Bad input; results that cannot be written; a run that could not be finished.
    pub fn execute(self) -> Result<()> {
        self.answer(&Bar::of_counted_runs())?.print(self.json)
    }

    /// Assesses the wall and writes what is to be written; nothing is printed.
    ///
    /// # Errors
    /// As [`AssessCommand::execute`].
    pub fn answer(&self, told: &dyn Progress) -> Result<Answer> {
        let wall = load_static_wall(&self.wall)?;
        let site = SiteFile::load(&self.site)?;
        let other = self.compare.as_deref().map(load_static_wall).transpose()?;
        let suite = self.records.as_deref().map(Suite::load).transpose()?;
        let folder =
            self.out.as_deref().map(|out| WholeFolder::check(out, &FILES, self.force)).transpose()?;
        let motions = suite.as_ref().map(|suite| motions(&suite.records, site.floor()));
        let under = |path: &Path, wall: &Wall| self.assess((path, wall), &site, motions.as_ref(), told);
        let assessment = under(&self.wall, &wall)?;
        let compared = match (&self.compare, &other) {
            (Some(path), Some(other)) => {
                Some(Compared { wall: WallNumbers::of(&name(path), other), assessment: under(path, other)? })
            }
            _ => None,
        };
        let assessed = Assessed {
            wall: WallNumbers::of(&name(&self.wall), &wall),
            assessment,
            suite: suite.as_ref().map(|suite| SuiteNote::of(suite, &site.site)),
            compared,
            language: self.language,
        };
        let write = |folder: WholeFolder| {
            self.write(folder.cleared()?, &wall, &assessed, suite.as_ref(), motions.as_ref())
        };
        let page = folder.map(write).transpose()?;
        Ok(Answer { json: as_json(&assessed)?, text: text(&assessed), notes: notes(&assessed), page })
    }

    fn assess(
        &self,
        (path, wall): (&Path, &Wall),
        site: &SiteFile,
        motions: Option<&Motions>,
        told: &dyn Progress,
    ) -> Result<Assessment> {
        let assessment = Assessment::of(wall, site).map_err(|reason| no_mechanism(path, reason))?;
        let Some(motions) = motions else { return Ok(assessment) };
        told.begin("runs", motions.len());
        let shaken = Shaken { wall, capacity: &assessment.capacity, accuracy: Accuracy::default() };
        let dynamic = self.threads.pool()?.install(|| shaken.check(motions, || told.advance(1)));
        let dynamic = dynamic.map_err(|e| Error::Run {
            time_s: e.time_s,
            reason: format!("{}, under {}", e.reason, e.record),
        })?;
        Ok(assessment.with_site_records(motions).with_dynamic(dynamic))
    }

    fn write(
        &self,
        folder: &Path,
        wall: &Wall,
        assessed: &Assessed,
        suite: Option<&Suite>,
        motions: Option<&Motions>,
    ) -> Result<PathBuf> {
        let [manifest, json, run] = FILES.map(|name| folder.join(name));
        let inputs = [
            ("wall", Some(&self.wall)),
            ("site", Some(&self.site)),
            ("suite", self.records.as_ref()),
            ("compared wall", self.compare.as_ref()),
        ];
        let given = inputs.into_iter().filter_map(|(role, path)| Some((role, path?)));
        let notes = given.map(|(role, path)| FileNote::of(role, path).map(|note| note.seen_from(folder)));
        let notes = notes.collect::<mrbd_files::Result<_>>()?;
        output::write_manifest(&manifest, KIND, &assessed.wall.name, notes, suite)?;
        write_durably(&json, as_json(assessed)?.as_bytes())?;
        if let Some(motion) = governing(assessed, motions) {
            let rows = governing_run(wall, &assessed.assessment.capacity, motion);
            write_durably(&run, &csv_bytes(&rows)?)?;
        }
        super::report::write_page(folder, None)
    }
}

/// The last part of a path.
fn name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

fn no_mechanism(path: &Path, reason: NoMechanism) -> Error {
    let (key, allowed) = match &reason {
        NoMechanism::Uncracked { .. } => ("wall.crack_height_m", "a crack, or a top without springs"),
        NoMechanism::Unstable => ("effects", "beds that carry the wall"),
    };
    InputError::key(path, key, reason.to_string(), allowed).into()
}

/// The motion under which the wall was displaced most.
fn governing<'a>(assessed: &Assessed, motions: Option<&'a Motions>) -> Option<&'a Accelerogram> {
    let records = &assessed.assessment.dynamic.as_ref()?.records;
    let most =
        (0..records.len()).max_by(|&a, &b| records[a].largest_d_m.total_cmp(&records[b].largest_d_m))?;
    motions.map(|motions| &motions[most].1)
}

fn as_json(assessed: &Assessed) -> Result<String> {
    let text = serde_json::to_string_pretty(assessed);
    text.map_err(|e| Error::io("write the assessment", Path::new("assessment.json"), e.into()))
}

/// The numbers as a table for people.
fn text(assessed: &Assessed) -> String {
    let mut columns = vec![(assessed.wall.name.as_str(), &assessed.assessment)];
    columns.extend(assessed.compared.iter().map(|other| (other.wall.name.as_str(), &other.assessment)));
    let head = std::iter::once("").chain(columns.iter().map(|(name, _)| *name)).map(str::to_owned).collect();
    let row = |name: &str, value: fn(&Assessment) -> String| {
        let values = columns.iter().map(|(_, assessment)| value(assessment));
        std::iter::once(name.to_owned()).chain(values).collect::<Vec<String>>()
    };
    let mut rows: Vec<Vec<String>> = vec![head];
    rows.extend([
        row("mechanism", |a| a.mechanism.name().replace('_', " ")),
        row("alpha_0", |a| format!("{:.4}", a.alpha_0)),
        row("e*", |a| format!("{:.4}", a.e_star)),
        row("a_0, m/s2", |a| format!("{:.4}", a.check.a_0_m_s2)),
        row("d_0, m", |a| format!("{:.4}", a.d_0_m)),
        row("d_SLV, m", |a| format!("{:.4}", a.check.d_slv_m)),
        row("T_SLV, s", |a| format!("{:.3}", a.check.t_slv_s)),
        row("a_g,SLD, m/s2", |a| number(a.check.ag_sld_m_s2)),
        row("a_g,SLV, m/s2", |a| number(a.check.ag_slv_m_s2)),
        row("zeta", |a| number(a.check.zeta)),
        row("zeta, linear (q = 2)", |a| number(a.check.linear.zeta)),
        row("static check", |a| accepted(a.check.accepted).to_owned()),
    ]);
    if assessed.assessment.dynamic.is_some() {
        let dynamic = |of: fn(&mrbd_assessment::Dynamic) -> String, a: &Assessment| {
            a.dynamic.as_ref().map_or_else(String::new, of)
        };
        let asked = |of: fn(&SiteRecords) -> String, a: &Assessment| {
            a.site_records.as_ref().map_or_else(String::new, of)
        };
        let mut by_spectra = |name: &str, of: fn(&SiteRecords) -> String| {
            let values = columns.iter().map(|(_, a)| asked(of, a));
            rows.push(std::iter::once(name.to_owned()).chain(values).collect());
        };
        by_spectra("largest S_D of the records, mean, m", |asked| format!("{:.4}", asked.demand_slv_m));
        by_spectra("d_SLV over that", |asked| asked.zeta.map_or("-".to_owned(), |zeta| format!("{zeta:.3}")));
        let mut add = |name: &str, of: fn(&mrbd_assessment::Dynamic) -> String| {
            let values = columns.iter().map(|(_, a)| dynamic(of, a));
            rows.push(std::iter::once(name.to_owned()).chain(values).collect());
        };
        add("runs beyond d_0", |d| format!("{} of {}", d.beyond_d_0, d.runs));
        add("mean of largest d, m", |d| format!("{:.4}", d.mean_largest_m));
        add("dynamic check, SLV", |d| verdict(d.accepted_slv, d.decided_slv));
        add("dynamic check, SLC", |d| verdict(d.accepted_slc, d.decided_slc));
    }
    aligned(&rows)
}

fn number(value: Option<f64>) -> String {
    value.map_or("beyond 10 g".to_owned(), |value| format!("{value:.3}"))
}

fn accepted(accepted: bool) -> &'static str {
    if accepted { "accepted" } else { "refused" }
}

fn verdict(is_accepted: bool, decided: bool) -> String {
    let sure = if decided { "" } else { ", not sure" };
    format!("{}{sure}", accepted(is_accepted))
}

/// What a reader of the numbers should know.
fn notes(assessed: &Assessed) -> Vec<String> {
    let a = &assessed.assessment;
    let mut notes = Vec::new();
    if let Some(suite) = assessed.suite.as_ref().filter(|suite| !suite.compatible) {
        let [low, high] = suite.deviation.map(|d| 100.0 * d);
        notes.push(format!(
            "note: the mean spectrum of suite {} lies {low:+.0} % to {high:+.0} % about the code's: not compatible",
            suite.name
        ));
    }
    if !a.capacity.vanishes {
        notes.push("note: the multiplier does not vanish; d_0 is where the wall counts as fallen".to_owned());
    }
    notes.extend(match a.agreement {
        Some(Agreement::StaticRefuses) => {
            Some("the static check refuses what the dynamics accept".to_owned())
        }
        Some(Agreement::DynamicRefuses) => {
            Some("the static check accepts what the dynamics refuse".to_owned())
        }
        _ => None,
    });
    notes
}
