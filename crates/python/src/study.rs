//! Studies: a pipeline run into a folder, and the folder of a study read.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use indicatif::ProgressBar;
use mrbd::cli::keep_medians;
use mrbd::store::{PAGE_NAME, write_durably};
use mrbd::study::batch::{SideBySide, Tally};
use mrbd::study::campaign::{Layout, Shard, Standing, Work, compact, run_missing};
use mrbd::study::pipeline::Pipeline;
use mrbd::study::plan::Plan;
use mrbd::study::runs::{Earlier, Manifest, OutputFolder, run_files};
use mrbd::summary::Summary;
use mrbd_records::Site;
use parquet::arrow::ArrowWriter;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use pyo3::prelude::*;
use rayon::ThreadPool;

use crate::errors::{Error, raised};
use crate::table::Table;
use crate::work::{Shown, Watched, pool, watched};

/// Runs what is missing of a study into a folder and puts it together, as `mrbd run` does; asked to stop, it stores what is
/// done.
#[pyfunction]
#[pyo3(signature = (pipeline, out, suite, earlier, threads, progress))]
pub fn run_study(
    py: Python<'_>,
    pipeline: PathBuf,
    out: Option<PathBuf>,
    suite: Option<PathBuf>,
    earlier: &str,
    threads: Option<usize>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<PathBuf> {
    let pipeline = Pipeline::load(&pipeline).map_err(raised)?;
    let plan = Plan::load(&pipeline, suite.as_deref()).map_err(raised)?;
    let out = out.unwrap_or_else(|| Path::new("outputs").join(&pipeline.name));
    let suite = suite.as_deref().unwrap_or(&pipeline.suite);
    let manifest = Manifest::of(&plan, &pipeline, suite, None).map_err(raised)?;
    let earlier = match earlier {
        "resume" => Earlier::Resume,
        "replace" => Earlier::Replace,
        _ => Earlier::Refuse,
    };
    let folder = OutputFolder::prepare(&out, &manifest, &pipeline.text, earlier).map_err(raised)?;
    let pool = pool("study", threads)?;
    let told = Watched::default();
    let shown = Shown::of(progress, plan.len());
    let (done, interrupted) = watched(py, &told, &shown, || run(&plan, &folder, &pool, &told));
    match (done.map_err(raised)?, interrupted) {
        (_, Some(interrupted)) => Err(interrupted),
        (_, None) => Ok(out),
    }
}

fn run(plan: &Plan, folder: &OutputFolder, pool: &ThreadPool, told: &Watched) -> mrbd::Result<()> {
    let layout = Layout::of(folder.manifest());
    let standing = pool.install(|| Standing::of(folder, &layout))?;
    let before = standing.runs(&layout);
    told.done.store(before, Ordering::Relaxed);
    let progress = ProgressBar::hidden();
    let shard = Shard::WHOLE;
    let work =
        Work { plan, folder, shard, pool, simulate: &SideBySide, stop: &told.stop, progress: &progress };
    let mut tally = Tally::default();
    run_missing(&work, &standing, |runs| {
        tally.count(runs);
        told.done.store(before + tally.runs(), Ordering::Relaxed);
    })?;
    if before + tally.runs() < plan.len() {
        return Ok(());
    }
    pool.install(|| compact(folder, &Standing::of(folder, &layout)?))?;
    keep_medians(folder.path())
}

/// The runs of a study, one a row: files that are checked, read without a copy beside them.
#[pyfunction]
pub fn read_runs(py: Python<'_>, folder: PathBuf) -> PyResult<Table> {
    py.detach(|| read(&run_files(&folder).map_err(raised)?))
}

/// The rows of a Parquet file.
#[pyfunction]
pub fn read_parquet(py: Python<'_>, file: PathBuf) -> PyResult<Table> {
    py.detach(|| read(&[file]))
}

fn read(files: &[PathBuf]) -> PyResult<Table> {
    let mut batches = Vec::new();
    let mut schema = None;
    for path in files {
        let failed = |e: &dyn std::fmt::Display| Error::new_err(format!("{}: {e}", path.display()));
        let file = std::fs::File::open(path)?;
        let reader = ParquetRecordBatchReaderBuilder::try_new(file)
            .and_then(|builder| builder.with_batch_size(1 << 16).build())
            .map_err(|e| failed(&e))?;
        schema = Some(arrow_array::RecordBatchReader::schema(&reader));
        for batch in reader {
            batches.push(batch.map_err(|e| failed(&e))?);
        }
    }
    let schema = schema.ok_or_else(|| Error::new_err("no files of runs"))?;
    Ok(Table::new(schema, batches))
}

/// Makes the page of the results in a folder, as `mrbd report`; where it is.
#[pyfunction]
#[pyo3(signature = (folder, site = None))]
pub fn write_page(py: Python<'_>, folder: PathBuf, site: Option<PathBuf>) -> PyResult<PathBuf> {
    py.detach(|| -> mrbd::Result<PathBuf> {
        let site = site.as_deref().map(Site::load).transpose()?;
        let summary = Summary::of(&folder, site.as_ref())?;
        summary.write_tables(&folder)?;
        let page = folder.join(PAGE_NAME);
        write_durably(&page, mrbd::report::html(&summary)?.as_bytes())?;
        Ok(page)
    })
    .map_err(raised)
}

/// Writes a table as a Parquet file.
#[pyfunction]
pub fn write_parquet(py: Python<'_>, table: Py<Table>, file: PathBuf) -> PyResult<()> {
    py.detach(|| {
        let failed = |e: &dyn std::fmt::Display| Error::new_err(format!("{}: {e}", file.display()));
        let table = table.get();
        let mut writer = ArrowWriter::try_new(std::fs::File::create(&file)?, table.schema(), None)
            .map_err(|e| failed(&e))?;
        table.batches().iter().try_for_each(|batch| writer.write(batch)).map_err(|e| failed(&e))?;
        writer.close().map(|_| ()).map_err(|e| failed(&e))
    })
}
