//! Studies in parts, stopped, damaged and gone on with, by a simulator that costs nothing.

use std::collections::BTreeMap;
use std::fs;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use indicatif::ProgressBar;
use mrbd::aggregate::aggregate;
use mrbd::study::batch::Simulate;
use mrbd::study::batch::Tally;
use mrbd::study::campaign::{Layout, Shard, Standing, Work, compact, run_missing};
use mrbd::study::plan::Plan;
use mrbd::study::runs::{Earlier, Manifest, OutputFolder, run_files};
use mrbd_files::file_sha256;
use mrbd_kernel::model::Wall;
use mrbd_kernel::simulate::{Accuracy, Shaking};

use crate::pipeline_support::{SMALL, pipeline, plan, stand_in};

/// Blocks of the 36 runs of a record: 7 of 5 and one of a single run.
const BLOCK_RUNS: u64 = 5;

fn manifest(plan: &Plan) -> Manifest {
    manifest_in_blocks(plan, NonZero::new(BLOCK_RUNS))
}

/// A manifest without the files it would hash.
fn manifest_in_blocks(plan: &Plan, block_runs: Option<NonZero<u64>>) -> Manifest {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut pipeline = pipeline(SMALL);
    for path in [&mut pipeline.path, &mut pipeline.survey, &mut pipeline.coefficients, &mut pipeline.suite] {
        *path = folder.path().join("input");
        fs::write(&*path, "some input").expect("written");
    }
    let suite = pipeline.suite.clone();
    Manifest::of(plan, &pipeline, &suite, block_runs).expect("a manifest")
}

pub fn prepare(folder: &Path, plan: &Plan, earlier: Earlier) -> mrbd::Result<OutputFolder> {
    OutputFolder::prepare(folder, &manifest(plan), SMALL, earlier)
}

fn standing(folder: &OutputFolder) -> Standing {
    Standing::of(folder, &Layout::of(folder.manifest())).expect("a readable folder")
}

pub fn merge(folder: &OutputFolder) -> mrbd::Result<()> {
    compact(folder, &standing(folder))
}

fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads")
}

pub fn do_missing(
    plan: &Plan,
    folder: &OutputFolder,
    (shard, threads): (Shard, usize),
    simulate: &(impl Simulate + Sync),
) -> mrbd::Result<Tally> {
    let (stop, progress) = (AtomicBool::new(false), ProgressBar::hidden());
    let pool = &pool(threads);
    let work = Work { plan, folder, shard, pool, simulate, stop: &stop, progress: &progress };
    run_missing(&work, &standing(folder), |_| {})
}

/// The SHA-256 of every file by its path in the folder, but the manifest's, which tells the time.
pub fn contents(folder: &Path) -> BTreeMap<PathBuf, String> {
    let mut all = BTreeMap::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).expect("readable") {
            let path = entry.expect("readable").path();
            match path.is_dir() {
                true => folders.push(path),
                false if path.ends_with("manifest.json") => {}
                false => {
                    let sha256 = file_sha256(&path).expect("readable");
                    all.insert(path.strip_prefix(folder).expect("inside").to_path_buf(), sha256);
                }
            }
        }
    }
    all
}

/// A finished study of 4 records.
fn undisturbed() -> (tempfile::TempDir, BTreeMap<PathBuf, String>) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    finish(folder.path(), Earlier::Refuse);
    let contents = contents(folder.path());
    assert_eq!(contents.keys().filter(|path| path.starts_with("runs")).count(), 4, "{:?}", contents.keys());
    assert!(!contents.keys().any(|path| path.starts_with("blocks")), "{:?}", contents.keys());
    (folder, contents)
}

/// Does what is missing of the study of 4 records and puts it together; the runs done.
fn finish(folder: &Path, earlier: Earlier) -> u64 {
    let plan = plan(SMALL, 4);
    let folder = prepare(folder, &plan, earlier).expect("a fit folder");
    let tally = do_missing(&plan, &folder, (Shard::WHOLE, 2), &stand_in).expect("runs");
    merge(&folder).expect("put together");
    tally.runs()
}

/// Façades of which a record has just more runs than are put together at once.
const MANY: &str = r#"
kind = "monte_carlo"
name = "many"
survey = "survey.toml"
coefficients = "coefficients.toml"
suite = "suite.toml"
configurations = ["perpendicular", "parallel"]

[sampling]
count = 25001
seed = 1
design = "sobol"

[[variants]]
name = "base"
"#;

#[test]
fn regress_large_records_are_put_together_while_others_run_to_the_same_bits() {
    let plan = plan(MANY, 2);
    let run = |shards: &[Shard]| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let study =
            OutputFolder::prepare(folder.path(), &manifest_in_blocks(&plan, None), MANY, Earlier::Refuse);
        let study = study.expect("an empty folder");
        for shard in shards {
            do_missing(&plan, &study, (*shard, 2), &stand_in).expect("runs");
        }
        let put_together = standing(&study).parts.len();
        merge(&study).expect("put together");
        (put_together, contents(folder.path()))
    };
    let [first, second] = [1, 2].map(|part| Shard::new(part, 2).expect("a shard"));
    let (in_the_run, whole) = run(&[Shard::WHOLE]);
    // Another process may still be at work where a study is divided.
    let (at_the_end, divided) = run(&[second, first]);
    assert_eq!([in_the_run, at_the_end], [2, 0]);
    assert_eq!(whole, divided);
    // Of a study that is gone on with, blocks that were there before go between those that come, or before them.
    for before in [first, second] {
        let (in_the_run, gone_on_with) = run(&[before, Shard::WHOLE]);
        assert_eq!(in_the_run, 2);
        assert_eq!(whole, gone_on_with);
    }
}

#[test]
fn regress_shards_in_any_order_give_the_bits_of_one_process() {
    let plan = plan(SMALL, 4);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut runs = 0;
    for (index, threads) in [(2, 1), (3, 5), (1, 2)] {
        let shared = prepare(folder.path(), &plan, Earlier::Share).expect("the same plan");
        assert!(merge(&shared).is_err(), "not all runs are there");
        let shard = Shard::new(index, 3).expect("a shard");
        runs += do_missing(&plan, &shared, (shard, threads), &stand_in).expect("runs").runs();
        assert_eq!(do_missing(&plan, &shared, (shard, 1), &stand_in).expect("nothing").runs(), 0);
    }
    assert_eq!(runs, plan.len(), "every run once");
    merge(&OutputFolder::take(folder.path()).expect("a study")).expect("complete");
    assert_eq!(contents(folder.path()), undisturbed().1);
}

#[test]
fn regress_a_study_that_is_stopped_again_and_again_ends_in_the_same_bits() {
    let plan = plan(SMALL, 4);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (mut stops, mut runs) = (0, 0);
    loop {
        let output = prepare(folder.path(), &plan, Earlier::Resume).expect("the same plan");
        let (stop, progress, calls) = (AtomicBool::new(false), ProgressBar::hidden(), AtomicU64::new(0));
        // The 12th run asks to stop; a block has up to 5 runs.
        let simulate = |wall: &Wall, shaking: &Shaking, accuracy: Accuracy| {
            stop.store(calls.fetch_add(1, Ordering::Relaxed) >= 11, Ordering::Relaxed);
            stand_in(wall, shaking, accuracy)
        };
        let work = Work {
            plan: &plan,
            folder: &output,
            shard: Shard::WHOLE,
            pool: &pool(1),
            simulate: &simulate,
            stop: &stop,
            progress: &progress,
        };
        let done = run_missing(&work, &standing(&output), |_| {}).expect("runs").runs();
        runs += done;
        if runs == plan.len() {
            merge(&output).expect("complete");
            break;
        }
        stops += 1;
        assert_eq!(standing(&output).runs(&Layout::of(output.manifest())), runs, "what was done is stored");
        assert!((12..=16).contains(&done), "the block at work is finished, no other is begun: {done}");
    }
    assert!(stops >= 8, "{stops}");
    assert_eq!(contents(folder.path()), undisturbed().1);
}

#[test]
fn regress_damaged_files_are_found_and_done_again() {
    let (folder, before) = undisturbed();
    let part = run_files(folder.path()).expect("files").swap_remove(2);
    let bytes = fs::read(&part).expect("readable");
    let mut flipped = bytes.clone();
    flipped[bytes.len() / 3] ^= 1;
    for damaged in [&flipped[..], &bytes[..bytes.len() - 1], &[]] {
        fs::write(&part, damaged).expect("written");
        let output = OutputFolder::look(folder.path()).expect("a study");
        assert_eq!(standing(&output).damaged, std::slice::from_ref(&part));
        assert_eq!(finish(folder.path(), Earlier::Resume), 36, "one record is done again");
        assert_eq!(contents(folder.path()), before);
    }
    fs::remove_file(&part).expect("removed");
    assert_eq!(finish(folder.path(), Earlier::Resume), 36);
    assert_eq!(contents(folder.path()), before);
}

#[test]
fn regress_a_damaged_block_is_found_and_done_again() {
    let plan = plan(SMALL, 4);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let shard = Shard::new(1, 2).expect("a shard");
    let output = prepare(folder.path(), &plan, Earlier::Share).expect("an empty folder");
    do_missing(&plan, &output, (shard, 2), &stand_in).expect("runs");
    let block = run_files(folder.path()).expect("blocks").swap_remove(3);
    let mut bytes = fs::read(&block).expect("readable");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x40;
    fs::write(&block, bytes).expect("written");
    assert_eq!(standing(&output).damaged, [block]);
    let again = do_missing(&plan, &output, (shard, 2), &stand_in).expect("runs").runs();
    assert!((1..=BLOCK_RUNS).contains(&again), "{again}");
    drop(output);
    finish(folder.path(), Earlier::Resume);
    assert_eq!(contents(folder.path()), undisturbed().1);
}

#[test]
fn regress_a_stop_while_putting_together_loses_nothing() {
    let plan = plan(SMALL, 4);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let output = prepare(folder.path(), &plan, Earlier::Share).expect("an empty folder");
    do_missing(&plan, &output, (Shard::WHOLE, 2), &stand_in).expect("runs");
    let whole = standing(&output);
    // The first record is together, its blocks are still there; the second has a file that does not count yet,
    // and something half-written lies about.
    let part = output.write_part("record 1", whole.blocks.range(0..8).map(|(_, file)| file));
    output.keep_part("record 1", part.expect("written")).expect("kept");
    let second = folder.path().join("runs/record=record%202");
    fs::create_dir_all(&second).expect("made");
    fs::write(second.join("part-1.parquet"), "half of a file").expect("written");
    fs::write(second.join(".unfinished-x"), "less").expect("written");
    assert_eq!(aggregate(folder.path()).expect("medians").variants[0].runs, plan.len() / 2, "no run twice");
    drop(output);
    assert_eq!(finish(folder.path(), Earlier::Resume), 0, "nothing is run again");
    assert_eq!(contents(folder.path()), undisturbed().1);
}

#[test]
fn regress_an_unfinished_study_can_be_aggregated() {
    let plan = plan(SMALL, 4);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let output = prepare(folder.path(), &plan, Earlier::Share).expect("an empty folder");
    do_missing(&plan, &output, (Shard::new(2, 2).expect("a shard"), 2), &stand_in).expect("runs");
    let done: u64 = aggregate(folder.path()).expect("medians").variants.iter().map(|v| v.runs).sum();
    // Of the 8 blocks of a record the second half of the pairs: 4 blocks, one of them of a single run.
    assert_eq!(done, 4 * (3 * 5 + 1));
}

#[test]
fn rejects_going_on_with_another_plan_and_says_what_differs() {
    let (folder, before) = undisturbed();
    for (other, told) in [
        (plan(SMALL, 3), "runs: 144, now 108"),
        (plan(&SMALL.replace("10.0, 14.0", "11.0, 14.0"), 4), "plan_sha256"),
        (plan(&SMALL.replace("law = \"contact\"", "length_m = 2.0"), 4), "length_m: 1.0, now 2.0"),
    ] {
        let error = prepare(folder.path(), &other, Earlier::Resume).expect_err("another plan");
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains(told), "{told} in {error}");
    }
    let empty = plan(SMALL, 4);
    let error = {
        let manifest = Manifest { block_runs: 6, ..manifest(&empty) };
        OutputFolder::prepare(folder.path(), &manifest, SMALL, Earlier::Resume).expect_err("other blocks")
    };
    assert!(error.to_string().contains("block_runs: 5, now 6"), "{error}");
    assert_eq!(contents(folder.path()), before, "nothing was touched");
}

#[test]
fn rejects_a_second_process_in_the_folder() {
    let plan = plan(SMALL, 1);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let first = prepare(folder.path(), &plan, Earlier::Share).expect("an empty folder");
    let second = prepare(folder.path(), &plan, Earlier::Share).expect("shards share");
    let error = prepare(folder.path(), &plan, Earlier::Resume).expect_err("others are at work");
    assert!(error.to_string().contains("another process"), "{error}");
    assert!(OutputFolder::take(folder.path()).is_err() && OutputFolder::look(folder.path()).is_ok());
    drop((first, second));
    prepare(folder.path(), &plan, Earlier::Resume).expect("they are gone");
}
