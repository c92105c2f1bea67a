//! The output folder of a calibration.
//!
//! ```text
//! manifest.json            `kind`: `calibration`; program, seed, files that were read; written first
//! calibration.json         everything found
//! candidates.parquet       every simulation, one a row
//! generations.parquet      how every search converged, one generation a row (the paper's Fig. 6)
//! moments.parquet          of releases of a held strip: what moment its joints carried, no law assumed
//! wall.calibrated.toml     the wall with the vector for all tests, for `mrbd simulate`
//! journal.tsv              simulations so far, while the calibration runs
//! ```

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::folder::{MANIFEST, Manifest, entries, refuse};
use super::moments::write_moments;
use crate::error::{Error, InputError, Result};
use crate::store::{Column, Read, now_unix_s, write_durably, write_table};
use arrow_array::{ArrayRef, Float64Array, RecordBatch, StringArray, UInt32Array, UInt64Array};
use arrow_schema::{DataType, Field, Schema};
use mrbd_files::FileNote;
use mrbd_lab::calibrate::{Archive, Calibration, Experiment, MethodResult, Parameter, Row, method_names};
use mrbd_lab::experiment::Test;
use mrbd_lab::release::Moments;
use parquet::arrow::ArrowWriter;
use parquet::basic::{Compression, ZstdLevel};
use parquet::file::properties::WriterProperties;

/// Kind of results, by which a report tells the folder of a calibration from that of a study.
pub const KIND: &str = "calibration";

/// The table of moments; only releases of a held strip have one.
pub const MOMENTS: &str = "moments.parquet";

/// Where things go in the output folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutputNames {
    /// Kind and provenance.
    pub manifest: PathBuf,
    /// Everything found.
    pub calibration: PathBuf,
    /// Every simulation.
    pub candidates: PathBuf,
    /// How every search converged.
    pub generations: PathBuf,
    /// The moment of the joints in every release of a held strip.
    pub moments: PathBuf,
    /// The wall with the joint vector, for `mrbd simulate`.
    pub wall: PathBuf,
    /// Simulations of a calibration that is running or was stopped.
    pub journal: PathBuf,
}

impl OutputNames {
    /// The names in a folder.
    pub fn new(folder: &Path) -> Self {
        Self {
            manifest: folder.join(MANIFEST),
            calibration: folder.join("calibration.json"),
            candidates: folder.join("candidates.parquet"),
            generations: folder.join("generations.parquet"),
            moments: folder.join(MOMENTS),
            wall: folder.join("wall.calibrated.toml"),
            journal: folder.join("journal.tsv"),
        }
    }

    /// Makes the folder ready: it must be empty, or `resume` a calibration that was stopped.
    ///
    /// # Errors
    /// Input errors for a folder that cannot be written, or holds results or other files.
    pub fn prepare(folder: &Path, experiment: &Experiment, resume: bool) -> Result<Self> {
        let entries = entries(folder)?;
        let names = Self::new(folder);
        let stopped = names.journal.exists();
        if stopped && !resume {
            let found = format!("{}, which holds a stopped calibration", folder.display());
            return Err(refuse(found, "an empty folder, or --resume to go on with it").into());
        }
        // Alone it was left by a stop before the first simulation.
        if !stopped && entries.iter().any(|path| *path != names.manifest) {
            let found = format!("{}, which holds other files", folder.display());
            return Err(refuse(found, "an empty folder").into());
        }
        if !stopped {
            write_manifest(folder, experiment)?;
        }
        Ok(names)
    }
}

/// Writes the manifest of a calibration.
///
/// # Errors
/// An input error for a file that cannot be read; [`mrbd_files::Error::Io`] if the disk refuses.
fn write_manifest(folder: &Path, experiment: &Experiment) -> Result<()> {
    let inputs = experiment.files.iter().map(|(role, file)| FileNote::of(role, file));
    let mut manifest = Manifest::new(KIND, inputs.collect::<mrbd_files::Result<_>>()?, now_unix_s());
    manifest.request_sha256 = Some(experiment.request.clone());
    manifest.seed = Some(experiment.settings.seed);
    manifest.write(folder)
}

/// What the calibration that is finished in a folder found; `None` where none is.
///
/// A journal beside it was left by a stop after the last result was written, and is removed.
///
/// # Errors
/// Input errors for results of other inputs, or that cannot be read; [`mrbd_files::Error::Io`] if the disk refuses.
pub fn finished(folder: &Path, experiment: &Experiment) -> Result<Option<Calibration>> {
    let names = OutputNames::new(folder);
    if !names.calibration.exists() {
        return Ok(None);
    }
    let bytes = std::fs::read(&names.calibration).map_err(|e| Error::io("read", &names.calibration, e))?;
    let refuse = |found: String, allowed: &str| InputError::file(&names.calibration, found, allowed);
    let stored: Calibration = serde_json::from_slice(&bytes)
        .map_err(|e| refuse(e.to_string(), "results as `mrbd calibrate` writes them"))?;
    if stored.request_sha256 != experiment.request {
        let allowed = "the output folder of this calibration, with the same inputs and seed, or a new folder";
        return Err(refuse("the results of another calibration".into(), allowed).into());
    }
    if names.journal.exists() {
        std::fs::remove_file(&names.journal).map_err(|e| Error::io("remove", &names.journal, e))?;
    }
    Ok(Some(stored))
}

/// Writes everything a calibration found; the files are whole or absent.
///
/// # Errors
/// [`mrbd_files::Error::Io`] or [`Error::Table`] if the disk refuses.
pub fn write_results(
    names: &OutputNames,
    experiment: &Experiment,
    calibration: &Calibration,
    moments: Option<&Moments>,
    archive: Archive,
) -> Result<()> {
    let rows = archive.rows(&method_names(experiment));
    write_candidates(&names.candidates, &rows, &experiment.space.parameters, &experiment.tests)?;
    write_generations(&names.generations, &calibration.methods)?;
    if let Some(moments) = moments {
        write_moments(&names.moments, moments)?;
    }
    write_durably(&names.wall, wall_text(experiment, calibration).as_bytes())?;
    let json = serde_json::to_string_pretty(calibration)
        .map_err(|e| Error::io("write the results", &names.calibration, e.into()))?;
    write_durably(&names.calibration, (json + "\n").as_bytes())?;
    Ok(archive.close()?)
}

fn wall_text(experiment: &Experiment, calibration: &Calibration) -> String {
    let table = experiment.space.table_with(&calibration.joint.values);
    let wme = calibration.joint.mean_wme.map_or_else(|| "none".to_owned(), |wme| format!("{wme:.4}"));
    format!(
        "# Calibrated by mrbd {} to {} test(s); mean WME {wme}; seed {}.\n\n{table}",
        calibration.tool_version,
        experiment.fit_tests().len(),
        calibration.seed,
    )
}

/// Writes the rows; the columns are `method, test, generation, index`, the parameters by name, `wme, outcome` and the
/// `steps` of the integration, and the numbers of impacts `impacts_C_1` … `impacts_C_8`.
///
/// # Errors
/// [`Error::Table`] or [`mrbd_files::Error::Io`] if the file cannot be written.
fn write_candidates(path: &Path, rows: &[Row], parameters: &[Parameter], tests: &[Test]) -> Result<()> {
    let columns = columns(rows, parameters, tests);
    let fields = columns.iter().map(|(name, unit, about, array)| field(name, unit, about, array));
    let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
    let arrays = columns.iter().map(|(_, _, _, array)| Arc::clone(array)).collect();
    let bytes = RecordBatch::try_new(Arc::clone(&schema), arrays)
        .map_err(parquet::errors::ParquetError::from)
        .and_then(|batch| encoded(&batch))
        .map_err(|e| Error::table(path, e))?;
    write_durably(path, &bytes)
}

type NamedColumn = (String, &'static str, String, ArrayRef);

fn columns(rows: &[Row], parameters: &[Parameter], tests: &[Test]) -> Vec<NamedColumn> {
    let text = |of: &dyn Fn(&Row) -> String| -> ArrayRef {
        Arc::new(rows.iter().map(|row| Some(of(row))).collect::<StringArray>())
    };
    let mut columns: Vec<NamedColumn> = vec![
        (
            "method".into(),
            "",
            "Search that asked for the simulation".into(),
            text(&|r| r.address.method.clone()),
        ),
        ("test".into(), "", "Test simulated".into(), text(&|r| tests[r.address.test].name.clone())),
        ("generation".into(), "", "Generation of the search, from 0".into(), {
            Arc::new(rows.iter().map(|r| r.address.generation).collect::<UInt32Array>())
        }),
        ("index".into(), "", "Place in the generation, from 0".into(), {
            Arc::new(rows.iter().map(|r| r.address.index).collect::<UInt32Array>())
        }),
    ];
    for (v, parameter) in parameters.iter().enumerate() {
        let values = rows.iter().map(|r| Some(r.values[v])).collect::<Float64Array>();
        columns.push((parameter.name.clone(), "", "Value of the parameter".into(), Arc::new(values)));
    }
    let wme = rows.iter().map(|r| r.wme).collect::<Float64Array>();
    columns.push((
        "wme".into(),
        "1",
        "Eq. 8; null where the run could not be finished".into(),
        Arc::new(wme),
    ));
    let about =
        "How the run ended: stood, collapsed, failed, abandoned (hopeless), impossible (no such wall)";
    columns.push(("outcome".into(), "", about.into(), text(&|r| r.outcome.clone())));
    let steps = rows.iter().map(|r| r.steps).collect::<UInt64Array>();
    columns.push(("steps".into(), "", "Steps of the integration".into(), Arc::new(steps)));
    for l in 0..8 {
        let counts = rows.iter().map(|r| r.transitions[l]).collect::<UInt64Array>();
        let about = format!("Impacts scaled by C_{}", l + 1);
        columns.push((format!("impacts_C_{}", l + 1), "", about, Arc::new(counts)));
    }
    columns
}

fn field(name: &str, unit: &str, about: &str, array: &ArrayRef) -> Field {
    let nullable = *array.data_type() == DataType::Float64;
    let metadata = [("unit", unit), ("description", about)];
    let metadata = metadata.map(|(key, value)| (key.to_owned(), value.to_owned()));
    Field::new(name, array.data_type().clone(), nullable).with_metadata(metadata.into_iter().collect())
}

fn encoded(batch: &RecordBatch) -> parquet::errors::Result<Vec<u8>> {
    let zstd = Compression::ZSTD(ZstdLevel::try_new(3)?);
    let properties = WriterProperties::builder().set_compression(zstd).build();
    let mut bytes = Vec::new();
    let mut writer = ArrowWriter::try_new(&mut bytes, batch.schema(), Some(properties))?;
    writer.write(batch)?;
    writer.close()?;
    Ok(bytes)
}

/// One generation of one search.
#[derive(Debug, Clone, PartialEq)]
struct Generation {
    method: String,
    test: Option<String>,
    generation: u64,
    vectors: u64,
    best_wme: Option<f64>,
    sum_wme: Option<f64>,
}

static GENERATIONS: [Column<Generation>; 6] = [
    Column::input("method", "", "search", Read::Text(|g| Some(g.method.as_str().into()))),
    Column::input(
        "test",
        "",
        "test searched; null: all tests to fit, jointly",
        Read::Text(|g| g.test.as_deref().map(Into::into)),
    ),
    Column::input("generation", "", "generation of the search, from 0", Read::Count(|g| Some(g.generation))),
    Column::input("vectors", "", "vectors simulated up to here", Read::Count(|g| Some(g.vectors))),
    Column::result(
        "best_wme",
        "",
        "lowest cost so far: WME, raised by a prior",
        Read::Number(|g| g.best_wme),
    ),
    Column::result(
        "sum_wme",
        "",
        "sum of costs over the population; null while a vector of it has no misfit (Fig. 6)",
        Read::Number(|g| g.sum_wme),
    ),
];

/// Writes the generations of the searches.
///
/// # Errors
/// [`crate::Error::Table`] or [`mrbd_files::Error::Io`] if the file cannot be written.
fn write_generations(path: &Path, methods: &[MethodResult]) -> Result<()> {
    let rows = methods.iter().flat_map(generations).collect::<Vec<_>>();
    write_table(path, &GENERATIONS, &[], &rows)
}

fn generations(m: &MethodResult) -> impl Iterator<Item = Generation> {
    (0..m.best_costs.len()).map(|g| Generation {
        method: m.method.clone(),
        test: m.test.clone(),
        generation: g as u64,
        vectors: m.vectors[g] as u64,
        best_wme: Some(m.best_costs[g]).filter(|cost| cost.is_finite()),
        sum_wme: Some(m.cost_sums[g]).filter(|sum| sum.is_finite()),
    })
}
