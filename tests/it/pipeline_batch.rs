//! From runs to files to medians, with a simulator that costs nothing.

use std::path::Path;

use mrbd::aggregate::{Case, LEVELS, Measure, Medians, Middle, aggregate};
use mrbd::study::batch::Tally;
use mrbd::study::campaign::Shard;
use mrbd::study::pipeline::Parameter;
use mrbd::study::plan::{Level, Plan};
use mrbd::study::runs::{COLUMNS, Earlier, run_files};
use mrbd::survey::Configuration;
use mrbd_kernel::model::{ImpactLaw, Wall};
use mrbd_kernel::simulate::{Accuracy, Outcome, Response, Shaking};
use parquet::arrow::arrow_reader::{ArrowReaderMetadata, ParquetRecordBatchReaderBuilder};

use crate::campaign::{do_missing, merge, prepare};
use crate::pipeline_support::{SMALL, plan, response, stand_in};

fn run(plan: &Plan, folder: &Path, threads: usize) -> Tally {
    run_with(plan, folder, threads, &stand_in)
}

fn run_with<S>(plan: &Plan, folder: &Path, threads: usize, simulate: &S) -> Tally
where
    S: Fn(&Wall, &Shaking, Accuracy) -> Response + Sync,
{
    let folder = prepare(folder, plan, Earlier::Refuse).expect("an empty folder");
    let tally = do_missing(plan, &folder, (Shard::WHOLE, threads), simulate).expect("a batch");
    merge(&folder).expect("files on disk");
    tally
}

fn study(records: u32) -> (tempfile::TempDir, Tally) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let tally = run(&plan(SMALL, records), folder.path(), 2);
    (folder, tally)
}

fn medians_of(records: u32) -> Medians {
    aggregate(study(records).0.path()).expect("medians")
}

fn case(slenderness: f64) -> Case {
    Case {
        variant: "base".to_owned(),
        configuration: Configuration::Parallel,
        parameter: Parameter::Restitution,
        level: Level::High,
        slenderness,
    }
}

#[test]
fn regress_every_run_is_a_row_failed_and_panicking_ones_too() {
    // Records 1 to 5 stand, 6 to 8 fall, 9 fails, 10 panics; 36 runs each.
    let (folder, tally) = study(10);
    assert_eq!(tally, Tally { stood: 180, collapsed: 108, failed: 72, collapsed_before: 0 });
    let files = run_files(folder.path()).expect("result files");
    assert_eq!(files.len(), 10);
    let rows = |file: &Path| {
        let file = std::fs::File::open(file).expect("a file");
        ParquetRecordBatchReaderBuilder::try_new(file).expect("Parquet").metadata().file_metadata().num_rows()
    };
    assert!(files.iter().all(|file| rows(file) == 36));
    assert!(files[0].ends_with("runs/record=record%201/part-1.parquet"), "{}", files[0].display());
}

#[test]
fn regress_files_do_not_depend_on_threads_or_time() {
    let plan = plan(SMALL, 4);
    let folders = [1, 2, 5].map(|threads| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        run(&plan, folder.path(), threads);
        folder
    });
    let bytes = |folder: &tempfile::TempDir| -> Vec<Vec<u8>> {
        let files = run_files(folder.path()).expect("result files");
        files.iter().map(|file| std::fs::read(file).expect("a file")).collect()
    };
    assert_eq!(bytes(&folders[0]), bytes(&folders[1]));
    assert_eq!(bytes(&folders[0]), bytes(&folders[2]));
}

#[test]
fn regress_files_tell_units_meanings_and_assumptions() {
    let (folder, _) = study(1);
    let file = std::fs::File::open(&run_files(folder.path()).expect("a file")[0]).expect("a file");
    let metadata = ArrowReaderMetadata::load(&file, Default::default()).expect("Parquet");
    assert_eq!(metadata.schema().fields().len(), COLUMNS.len());
    let field = metadata.schema().field_with_name("stiffness_n_per_m").expect("a column").metadata();
    assert_eq!((field["unit"].as_str(), field["description"].is_empty()), ("N/m", false));
    let pairs = metadata.metadata().file_metadata().key_value_metadata().expect("metadata");
    let value = |key: &str| {
        let pair = pairs.iter().find(|pair| pair.key == format!("mrbd.{key}"));
        pair.and_then(|pair| pair.value.clone()).unwrap_or_else(|| panic!("{key} must be there"))
    };
    assert_eq!(value("suite_generated"), "true");
    assert_eq!(value("seed"), "none");
    assert_eq!(value("plan_sha256").len(), 64);
    assert!(value("variants").contains("\"law\":\"contact\""), "{}", value("variants"));
}

#[test]
fn regress_values_that_do_not_exist_are_null() {
    use arrow_array::Array;
    let (folder, _) = study(10);
    let nulls = |record: u32, column: &str| {
        let path = folder.path().join(format!("runs/record=record%20{record}/part-1.parquet"));
        let file = std::fs::File::open(path).expect("a file");
        let reader =
            ParquetRecordBatchReaderBuilder::try_new(file).expect("Parquet").build().expect("a reader");
        let batches = reader.map(|batch| batch.expect("rows"));
        batches
            .map(|batch| batch.column_by_name(column).expect("a column").logical_null_count())
            .sum::<usize>()
    };
    // Of 36 rows: record 1 stood, 6 fell, 9 failed, 10 panicked.
    for (column, expected) in [
        ("theta1_max_rad", [0, 0, 36, 36]),
        ("collapse_time_s", [36, 0, 36, 36]),
        ("collapsed", [0, 0, 36, 36]),
        ("reason", [36, 36, 0, 0]),
        ("steps", [0, 0, 0, 36]),
        ("outcome", [0, 0, 0, 0]),
        ("record_magnitude", [36, 36, 36, 36]),
    ] {
        assert_eq!([1, 6, 9, 10].map(|record| nulls(record, column)), expected, "{column}");
    }
}

#[test]
fn analytic_quantiles_run_over_the_records() {
    // Records 1 to 5 rotate by 1 to 5 hundredths: linear, so the q quantile is (1 + 4 q) hundredths.
    let medians = medians_of(5);
    let row = medians.get(&case(14.0), Measure::LowerOwn).expect("a case of the study");
    assert_eq!((row.runs, row.collapsed, row.failed), (5, 0, 0));
    for (level, value) in LEVELS.iter().zip(row.quantiles) {
        let value = value.expect("all stood");
        // Rotations go through θ = ratio × α and back: two roundings of 1e-16 each.
        assert!((value - (1.0 + 4.0 * level) / 100.0).abs() < 1e-15, "{value} at {level}");
    }
    let upper = medians.get(&case(14.0), Measure::UpperOwn).expect("a case of the study").middle();
    assert!(matches!(upper, Some(Middle::Rotation(x)) if (x - 0.06).abs() < 1e-15), "{upper:?}");
}

#[test]
fn analytic_collapses_rank_above_and_failures_take_no_part() {
    // Eight finished records: 5 stood, 3 fell; the median lies between the 4th and the 5th, which stood.
    let medians = medians_of(10);
    let row = medians.get(&case(10.0), Measure::LowerOwn).expect("a case of the study");
    assert_eq!((row.runs, row.collapsed, row.failed), (10, 3, 2));
    assert_eq!(row.share_collapsed(), Some(3.0 / 8.0));
    let middle = row.middle();
    assert!(matches!(middle, Some(Middle::Rotation(x)) if (x - 0.045).abs() < 1e-15), "{middle:?}");
    assert_eq!(row.quantiles[4..], [None; 3], "these land among collapses");
}

#[test]
fn regress_runs_that_come_out_differently_are_counted() {
    // Under the other law record 1 rotates 0.9 % more, record 2 1.1 % more, 3 falls; records 4, 7 and 8 stay.
    let differs = |wall: &Wall, shaking: &Shaking, accuracy: Accuracy| {
        let peak = shaking.horizontal.as_ref().expect("a record").peak_m_s2().round() as u32;
        match (wall.parameters().restitution.law, peak) {
            (ImpactLaw::Contact, 1) => response(wall, 0.01 * 1.009, Outcome::Stood),
            (ImpactLaw::Contact, 2) => response(wall, 0.02 * 1.011, Outcome::Stood),
            (ImpactLaw::Contact, 3) => response(wall, 2.0, Outcome::Collapsed { time_s: 0.3 }),
            _ => stand_in(wall, shaking, accuracy),
        }
    };
    let folder = tempfile::tempdir().expect("a temporary folder");
    run_with(&plan(SMALL, 8), folder.path(), 2, &differs);
    let medians = aggregate(folder.path()).expect("medians");
    let told: Vec<_> = medians.moved.iter().map(|m| (m.variant.as_str(), m.runs, m.moved)).collect();
    // 9 runs a record and floor; records 2 and 3 moved.
    assert_eq!(told, [("contact", 72, 18), ("contact", 72, 18)]);
}

#[test]
fn regress_medians_keep_the_order_and_the_assumptions_of_the_plan() {
    let medians = medians_of(2);
    let names: Vec<_> = medians.variants.iter().map(|v| (v.name.as_str(), v.law.as_str(), v.runs)).collect();
    assert_eq!(names, [("base", "whole", 36), ("contact", "contact", 36)]);
    assert!(medians.variants.iter().all(|v| v.suite_generated && v.suite == "made up"));
    let first: Vec<_> =
        medians.rows().iter().step_by(Measure::ALL.len()).take(4).map(|row| &row.case).collect();
    assert_eq!(first.iter().map(|case| case.slenderness).collect::<Vec<_>>(), [10.0, 14.0, 18.0, 10.0]);
    assert!(first.iter().all(|case| case.configuration == Configuration::Perpendicular));
}

#[test]
fn rejects_folders_that_hold_something_else() {
    let prepare = |folder: &Path, plan: &Plan, earlier| prepare(folder, plan, earlier).map(|_| ());
    let refused = |result: mrbd::Result<()>, why: &str| {
        let error = result.expect_err("must be refused");
        assert!(error.to_string().contains(why), "{error}");
        assert_eq!(error.exit_code(), 2);
    };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (one, two) = (plan(SMALL, 1), plan(SMALL, 2));
    prepare(folder.path(), &one, Earlier::Refuse).expect("an empty folder");
    refused(prepare(folder.path(), &one, Earlier::Refuse), "holds results of this plan already");
    refused(prepare(folder.path(), &two, Earlier::Refuse), "holds another plan");
    run(&one, &folder.path().join("x"), 1);
    prepare(&folder.path().join("x"), &two, Earlier::Replace).expect("an earlier study, replaced");
    assert!(run_files(&folder.path().join("x")).is_err(), "nothing of the earlier study is left");

    let foreign = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(foreign.path().join("thesis.txt"), "years of work").expect("written");
    refused(prepare(foreign.path(), &one, Earlier::Replace), "holds other files");
    assert_eq!(std::fs::read_dir(foreign.path()).expect("readable").count(), 1, "nothing was written");
    refused(prepare(&foreign.path().join("thesis.txt/out"), &one, Earlier::Refuse), "cannot be written");
}
