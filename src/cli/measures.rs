//! `mrbd measures`: which intensity measure foretells the response of drawn façades.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::Args;

use super::output;
use super::threads::Threads;
use crate::error::{Error, Result};
use crate::sensitivity::measures::{FILES, KIND, Measures, OfFloor, OfMeasure, of_folder};
use crate::store::{WholeFolder, now_unix_s, write_durably};
use crate::text::{TERMINAL, aligned, wrapped};
use mrbd_files::FileNote;

/// Which intensity measure foretells the response of drawn façades: efficiency and sufficiency of each.
///
/// The folder is that of a whole study of kind monte_carlo, cloud or stripes; its first variant is asked. stdout has a table
/// a floor, the most efficient measure first.
///
/// Examples:
///   mrbd measures outputs/cloud
///   mrbd measures outputs/cloud --out outputs/measures --json
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub struct MeasuresCommand {
    /// Output folder of `mrbd run`.
    folder: PathBuf,
    /// Write measures.json and a page into a folder.
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

impl MeasuresCommand {
    /// Runs the command.
    ///
    /// # Errors
    /// Input errors for a folder without such a study; results that cannot be written.
    pub fn execute(self) -> Result<()> {
        let started_unix_s = now_unix_s();
        let folder =
            self.out.as_deref().map(|out| WholeFolder::check(out, &FILES, self.force)).transpose()?;
        let measures = self.threads.pool()?.install(|| of_folder(&self.folder))?;
        if let Some(folder) = folder {
            self.write(folder.cleared()?, &measures, started_unix_s)?;
        }
        if self.json {
            return output::print(&as_json(&measures, Path::new("stdout"))?);
        }
        output::to_stdout(|out| print_tables(out, &measures).map_err(output::failed))
    }

    fn write(&self, folder: &Path, measures: &Measures, started_unix_s: u64) -> Result<()> {
        let [manifest_json, measures_json] = FILES.map(|name| folder.join(name));
        let study = FileNote::of("study", &self.folder.join("manifest.json"))?.seen_from(folder);
        let manifest = serde_json::json!({
            "kind": KIND,
            "name": measures.study,
            "tool_version": env!("CARGO_PKG_VERSION"),
            "suite": measures.suite,
            "generated": measures.generated,
            "inputs": [study],
            "started_unix_s": started_unix_s,
        });
        write_durably(&manifest_json, format!("{manifest:#}\n").as_bytes())?;
        write_durably(&measures_json, as_json(measures, &measures_json)?.as_bytes())?;
        let page = super::report::write_page(folder, None)?;
        eprintln!("mrbd: {}", page.display());
        Ok(())
    }
}

fn as_json(measures: &Measures, path: &Path) -> Result<String> {
    serde_json::to_string_pretty(measures).map_err(|e| Error::io("write the measures", path, e.into()))
}

fn print_tables(out: &mut dyn Write, measures: &Measures) -> io::Result<()> {
    for floor in &measures.floors {
        print_floor(out, floor)?;
    }
    let notes = "efficiency: standard deviation of ln(θ/α_i) of one façade at a known intensity, walls that stood, with its 90 % interval over draws of the records; best: share of the draws in which no measure has less; proficiency: the same over the slope, in ln IM; concordance: share of the pairs of runs of a façade, one fallen, in which that one was shaken the more; p: of what magnitude, distance and duration explain of the rest, record by record. A small p speaks against the measure.";
    writeln!(out, "{}", wrapped(notes, 0, TERMINAL))
}

fn print_floor(out: &mut dyn Write, floor: &OfFloor) -> io::Result<()> {
    let OfFloor { configuration, runs, collapsed, measures } = floor;
    writeln!(out, "{} floor: {runs} runs, of which {collapsed} collapsed", configuration.name())?;
    let head =
        ["measure", "efficiency", "90 %", "best", "slope", "proficiency", "concordance", "p M", "p R", "p D"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    rows.extend(measures.iter().map(row));
    writeln!(out, "{}", aligned(&rows))
}

fn p_value(value: Option<f64>) -> String {
    match value {
        None => "-".to_owned(),
        Some(p) if p < 0.001 => "< 0.001".to_owned(),
        Some(p) => format!("{p:.3}"),
    }
}

fn row(of: &OfMeasure) -> Vec<String> {
    let number = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.3}"));
    let [low, high] = of.efficiency_interval;
    let sufficiency = of.sufficiency;
    vec![
        of.measure.clone(),
        format!("{:.3}", of.efficiency),
        format!("{low:.3} to {high:.3}"),
        format!("{:.0} %", (100.0 * of.best_share).floor()),
        format!("{:.2}", of.slope),
        number(of.proficiency),
        number(of.concordance),
        p_value(sufficiency.magnitude_p),
        p_value(sufficiency.distance_p),
        p_value(sufficiency.duration_p),
    ]
}
