//! The shipped studies: how many runs they have, and their runs.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use indicatif::ProgressBar;
use mrbd::cli::starter::write_starter;
use mrbd::study::batch::SideBySide;
use mrbd::study::campaign::{Layout, Shard, Standing, Work, compact, run_missing};
use mrbd::study::pipeline::Pipeline;
use mrbd::study::plan::Plan;
use mrbd::study::runs::{Earlier, Manifest, OutputFolder};

use super::ROOT;
use super::block::{Page, grouped};

/// Kinds of studies of drawn façades, and their pipelines.
const DRAWN: [(&str, &str); 4] = [
    ("monte_carlo", "pipelines/monte_carlo.toml"),
    ("cloud", "pipelines/cloud.toml"),
    ("stripes", "pipelines/fragility.toml"),
    ("incremental", "pipelines/incremental.toml"),
];

fn load(path: &Path, suite: Option<&Path>) -> (Pipeline, Plan) {
    let pipeline = Pipeline::load(path).expect("a shipped pipeline");
    let plan = Plan::load(&pipeline, suite).expect("a plan");
    (pipeline, plan)
}

/// How many rows the shipped studies have.
pub fn counts(page: &mut Page) {
    let rows = |path: &Path| grouped(load(path, None).1.len());
    let shipped = |pipeline: &str| rows(&Path::new(ROOT).join(pipeline));
    page.put("rows of the sweep", &shipped("pipelines/sweep.toml"));
    let drawn = DRAWN.map(|(kind, pipeline)| format!("{} (`{kind}`)", shipped(pipeline)));
    page.put_prose(
        "rows of drawn studies",
        &format!("As they are shipped they have {} rows.", drawn.join(", ")),
    );
    let first = tempfile::tempdir().expect("a temporary folder");
    write_starter(first.path(), None).expect("the files to begin with");
    page.put("rows of the first study", &rows(&first.path().join("pipeline.toml")));
}

/// A study that was run.
pub struct Study {
    pub plan: Plan,
    folder: tempfile::TempDir,
}

impl Study {
    /// Runs a shipped study, under another suite where one is given.
    pub fn run(pipeline: &str, suite: Option<&Path>) -> Self {
        let (pipeline, plan) = load(&Path::new(ROOT).join(pipeline), suite);
        let folder = tempfile::tempdir().expect("a temporary folder");
        let suite: PathBuf = suite.map_or_else(|| pipeline.suite.clone(), Path::to_path_buf);
        let manifest = Manifest::of(&plan, &pipeline, &suite, None).expect("a manifest");
        let output = OutputFolder::prepare(folder.path(), &manifest, &pipeline.text, Earlier::Refuse);
        let output = output.expect("an empty folder");
        let layout = Layout::of(output.manifest());
        let standing = || Standing::of(&output, &layout).expect("a readable folder");
        let pool = rayon::ThreadPoolBuilder::new().build().expect("threads");
        let (stop, progress) = (AtomicBool::new(false), ProgressBar::hidden());
        let work = Work {
            plan: &plan,
            folder: &output,
            shard: Shard::WHOLE,
            pool: &pool,
            simulate: &SideBySide,
            stop: &stop,
            progress: &progress,
        };
        run_missing(&work, &standing(), |_| {}).expect("runs");
        compact(&output, &standing()).expect("put together");
        Self { plan, folder }
    }

    pub fn folder(&self) -> &Path {
        self.folder.path()
    }
}
