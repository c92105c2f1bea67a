//! `mrbd records floor`: what a record becomes on a floor of a building.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use super::{ReadArgs, print_json, print_table, written};
use crate::error::{InputError, Result};
use mrbd_records::{
    Building, CODE_DAMPING, FloorSpectrum, Mode, Site, floor_motion, spectral_acceleration_m_s2,
    write_two_columns,
};

/// Bring a record to a floor of a building: its absolute acceleration at height z, and its spectrum.
///
/// The building is linear: the first mode has T_1, γ_1 = 3n/(2n + 1) and the shape z/H (Circolare 2019, C7.2.3), further
/// modes are given with their period and γψ(z). What the modes leave of 1 moves with the ground.
/// With --site the code's floor spectra stand beside: C7.2.5 to .10 for any building, C7.2.11 for framed ones.
///
/// Examples:
///   mrbd records floor ground.csv floor.csv --height-ratio 0.67 --period 0.3 --storeys 3
///   mrbd records floor ground.csv floor.csv --height-ratio 1 --period 0.4 --storeys 2 --mode 0.12,-0.3 --site site.toml
#[derive(Debug, Args)]
#[command(verbatim_doc_comment, allow_negative_numbers = true)]
pub struct FloorArgs {
    /// Record file.
    file: PathBuf,
    /// CSV file to write; an existing one is not touched.
    out: PathBuf,
    /// z/H: height of the floor over that of the building.
    #[arg(long, value_name = "X")]
    height_ratio: f64,
    /// T_1, s.
    #[arg(long, value_name = "SECONDS")]
    period: f64,
    /// Number of storeys.
    #[arg(long, value_name = "N")]
    storeys: u32,
    /// Damping of the building relative to critical.
    #[arg(long, value_name = "X", default_value_t = CODE_DAMPING)]
    damping: f64,
    /// A further mode: period in s, and γψ(z); may be given more than once.
    #[arg(long, value_name = "T,GAMMA_PSI", value_parser = mode)]
    mode: Vec<Mode>,
    /// Site file: its floor spectra are printed beside.
    #[arg(long, value_name = "FILE")]
    site: Option<PathBuf>,
    /// Damping of the spectra.
    #[arg(long, value_name = "X", default_value_t = CODE_DAMPING)]
    spectrum_damping: f64,
    /// Print the spectra as JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    read: ReadArgs,
}

/// Periods of the spectra, s.
const PERIODS_S: [f64; 14] = [0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0];

/// Spectral accelerations at a period.
#[derive(Debug, Serialize)]
struct Row {
    period_s: f64,
    ground_m_s2: f64,
    floor_m_s2: f64,
    /// C7.2.5 to C7.2.10.
    code_m_s2: Option<f64>,
    /// C7.2.11.
    framed_m_s2: Option<f64>,
}

fn mode(text: &str) -> Result<Mode, String> {
    let parts: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    match parts[..] {
        [period_s, participation] => Ok(Mode { period_s, participation }),
        _ => Err("a period and a participation, as 0.12,-0.3".to_owned()),
    }
}

pub(super) fn execute(args: &FloorArgs) -> Result<()> {
    if args.out.exists() {
        let found = format!("{}, which exists", args.out.display());
        return Err(InputError::option("OUT", found, "a file that does not exist yet").into());
    }
    let building = args.building()?;
    let site = args.site.as_deref().map(Site::load).transpose()?;
    let record = args.read.read(&args.file)?;
    let floor = floor_motion(&record.accelerogram, &building.all_modes(), building.damping)
        .map_err(|e| InputError::file(&args.file, e.to_string(), "samples that a building can follow"))?;
    written("OUT", write_two_columns(&args.out, &floor))?;
    let damping = args.spectrum_damping;
    let code = site.map(|site| FloorSpectrum { site: Site { damping, ..site }, building: &building });
    let row = |period_s: f64| Row {
        period_s,
        ground_m_s2: spectral_acceleration_m_s2(&record.accelerogram, period_s, damping),
        floor_m_s2: spectral_acceleration_m_s2(&floor, period_s, damping),
        code_m_s2: code.as_ref().map(|code| code.elastic_m_s2(period_s, damping)),
        framed_m_s2: code.as_ref().map(|code| code.framed_m_s2(period_s)),
    };
    let rows = PERIODS_S.map(row);
    if args.json { print_json(&rows) } else { print_rows(&rows) }
}

impl FloorArgs {
    /// The building, checked with the damping of the spectra.
    fn building(&self) -> Result<Building> {
        let building = Building {
            height_ratio: self.height_ratio,
            period_s: self.period,
            storeys: self.storeys,
            damping: self.damping,
            modes: self.mode.clone(),
        };
        building.check(Path::new("command line"), "building")?;
        if !(0.005..=0.3).contains(&self.spectrum_damping) {
            let found = self.spectrum_damping.to_string();
            return Err(InputError::option("--spectrum-damping", found, "0.005 to 0.3").into());
        }
        Ok(building)
    }
}

fn print_rows(rows: &[Row]) -> Result<()> {
    let cell = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.3}"));
    let texts = |row: &Row| {
        let values = [Some(row.ground_m_s2), Some(row.floor_m_s2), row.code_m_s2, row.framed_m_s2];
        std::iter::once(format!("{}", row.period_s)).chain(values.map(cell)).collect::<Vec<String>>()
    };
    let head = ["T, s", "ground, m/s2", "floor, m/s2", "C7.2.5", "C7.2.11"];
    print_table(&head, &rows.iter().map(texts).collect::<Vec<_>>())
}
