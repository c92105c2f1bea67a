//! Fragilities of tables as a user meets them.

use std::path::{Path, PathBuf};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::fragility::{json, mrbd, number, text};

fn rejects(arguments: &[&str], told: &[&str]) {
    let output = mrbd(arguments);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(output.stdout.is_empty(), "data on stdout");
    for part in told {
        assert!(message.contains(part), "no `{part}` in: {message}");
    }
}

/// A table of runs as a study writes them, with what can happen to a run.
fn runs(folder: &Path) -> PathBuf {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let mut text = String::from("record,facade,floor,pgv_m_s,outcome,theta\n");
    for record in 0..30 {
        for facade in 0..20 {
            let (x, floor) = (0.1 + rng.random::<f64>(), ["perpendicular", "parallel"][facade % 2]);
            let [normal, noise]: [f64; 2] = [0, 1].map(|_| StandardNormal.sample(&mut rng));
            let failed = x > 0.5 * (0.4 * normal).exp();
            let outcome = match (failed, (record * facade) % 50 == 49) {
                (_, true) => "failed",
                (true, _) => "collapsed",
                _ => "stood",
            };
            text += &format!(
                "r{record},{facade},{floor},{x:.6},{outcome},{:.6}\n",
                0.3 * x * (0.3 * noise).exp()
            );
        }
    }
    // A group in which nothing collapsed.
    (0..5).for_each(|i| text += &format!("r{i},0,rigid,0.{},stood,0.1\n", i + 1));
    let path = folder.join("runs.csv");
    std::fs::write(&path, text).expect("the table");
    path
}

#[test]
fn regress_groups_clusters_curves_and_what_is_unknown() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (table, curves, model) =
        (runs(folder.path()), folder.path().join("c.csv"), folder.path().join("f.xml"));
    let arguments = [
        "fragility",
        text(&table),
        "--intensity",
        "pgv_m_s",
        "--outcome",
        "outcome",
        "--group",
        "floor",
        "--cluster",
        "record",
        "--cluster",
        "facade",
        "--replicates",
        "200",
        "--out",
        text(&curves),
        "--nrml",
        text(&model),
        "--imt",
        "PGV",
        "--json",
    ];
    let result = json(&arguments);
    assert_eq!(result, json(&arguments), "a seed decides every draw");
    let groups = result["groups"].as_array().expect("groups");
    let names: Vec<&str> = groups.iter().filter_map(|group| group["group"]["floor"].as_str()).collect();
    assert_eq!(names, ["perpendicular", "parallel", "rigid"]);
    for group in &groups[..2] {
        let (low, high) = (
            number(group, "/bootstrap/percentile/median/0"),
            number(group, "/bootstrap/percentile/median/1"),
        );
        // 300 outcomes tell ln ½ to 5 %; drawing both clusters triples the variance of what is independent, and 10
        // façades expand the interval to 2.4 of it: 21 %. Here 35 %.
        assert!(
            0.35 < low && low < number(group, "/median") && number(group, "/median") < high && high < 0.7
        );
        let shares =
            ["record", "facade", "rest"].map(|key| number(group, &format!("/variance_shares/{key}")));
        // The rest is one minus the others: rounding.
        assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
    assert_eq!((&groups[2]["status"], &groups[2]["reason"]), (&"unknown".into(), &"no_failures".into()));
    assert!(groups[2].get("median").is_none(), "no number for what is unknown");
    let lost: f64 = groups.iter().map(|group| number(group, "/without_outcome")).sum();
    let failed = std::fs::read_to_string(&table).expect("the table").matches(",failed,").count();
    assert!(failed > 0 && lost == failed as f64, "{lost} of {failed}");
    let mut reader = csv::Reader::from_path(&curves).expect("the curves");
    let header: Vec<String> = reader.headers().expect("a header").iter().map(str::to_owned).collect();
    assert_eq!(header, ["floor", "intensity", "probability", "lower", "upper"]);
    let rows: Vec<(String, f64, f64, f64, f64)> =
        reader.deserialize().map(|row| row.expect("a row")).collect();
    assert_eq!(rows.len(), 202, "101 points for each of two curves");
    // A pointwise percentile interval need not hold the estimate, but does where replicates scatter about it.
    let middle = &rows[50];
    assert!(middle.3 < middle.2 && middle.2 < middle.4, "{middle:?}");
    let xml = std::fs::read_to_string(&model).expect("the model");
    assert_eq!(xml.matches("<fragilityFunction ").count(), 2);
    assert!(xml.contains("id=\"floor=parallel\""), "{xml}");
}

#[test]
fn analytic_the_same_table_as_parquet_gives_the_same_numbers() {
    use arrow_array::{ArrayRef, BooleanArray, Float64Array, RecordBatch, StringArray};
    use std::sync::Arc;
    let folder = tempfile::tempdir().expect("a temporary folder");
    let outcomes =
        [(0.1, false), (0.2, true), (0.3, false), (0.4, false), (0.5, true), (0.6, true), (0.7, false)];
    let csv = folder.path().join("t.csv");
    let rows = outcomes.map(|(x, failed)| format!("{x},{failed},a\n"));
    std::fs::write(&csv, format!("x,failed,label\n{}", rows.concat())).expect("written");
    let mut with_nan = [0.5; 7];
    with_nan[2] = f64::NAN;
    let columns: [(&str, ArrayRef); 4] = [
        ("x", Arc::new(Float64Array::from_iter_values(outcomes.map(|(x, _)| x)))),
        ("failed", Arc::new(BooleanArray::from_iter(outcomes.map(|(_, failed)| Some(failed))))),
        ("label", Arc::new(StringArray::from_iter_values(["a"; 7]))),
        ("z", Arc::new(Float64Array::from_iter_values(with_nan))),
    ];
    let batch = RecordBatch::try_from_iter(columns).expect("a batch");
    let parquet = folder.path().join("t.parquet");
    let file = std::fs::File::create(&parquet).expect("a file");
    let mut writer = parquet::arrow::ArrowWriter::try_new(file, batch.schema(), None).expect("a writer");
    writer.write(&batch).expect("written");
    writer.close().expect("closed");
    let fit = |path: &Path| {
        json(&[
            "fragility",
            text(path),
            "--intensity",
            "x",
            "--outcome",
            "failed",
            "--group",
            "label",
            "--json",
        ])
    };
    assert_eq!(fit(&csv), fit(&parquet));
    rejects(
        &["fragility", text(&parquet), "--intensity", "x", "--outcome", "z", "--exceeds", "0"],
        &["t.parquet: z", "row 3", "finite numbers"],
    );
}

#[test]
fn regress_incremental_and_cloud_from_a_table() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("t.csv");
    let rows = ["0.31,1", "0.44,1", "0.52,1", "0.58,1", "0.73,1", "0.81,1", "0.97,1", "1,0", "1,0", "1,0"];
    std::fs::write(&path, format!("x,collapsed\n{}\n", rows.join("\n"))).expect("written");
    let result = json(&[
        "fragility",
        text(&path),
        "--intensity",
        "x",
        "--outcome",
        "collapsed",
        "--method",
        "incremental",
        "--json",
    ]);
    // tests/python/fragility_reference.py, "censored"; see the unit test for the tolerance.
    assert!((number(&result, "/groups/0/median") - 0.758_493_069_722).abs() < 1e-7);
    assert!(result["groups"][0]["goodness"].is_null(), "intensities of collapse are no trials");
    let table = runs(folder.path());
    let result = json(&[
        "fragility",
        text(&table),
        "--intensity",
        "pgv_m_s",
        "--outcome",
        "outcome",
        "--method",
        "cloud",
        "--demand",
        "theta",
        "--limit",
        "0.2",
        "--group",
        "floor",
        "--cluster",
        "record",
        "--json",
        "--replicates",
        "100",
    ]);
    let slope = number(&result, "/groups/0/cloud/slope");
    // The demand was made proportional to the intensity; collapse takes away the large ones, so less than 1.
    assert!(slope > 0.5 && slope < 1.1, "{slope}");
    assert!(number(&result, "/groups/0/median") < 0.7, "collapses at ½ m/s bound the median");
}

#[test]
fn rejects_bad_options_and_tables() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let table = runs(folder.path());
    let with = |more: &[&'static str]| {
        let mut arguments = vec!["fragility", text(&table)];
        arguments.extend_from_slice(more);
        arguments.iter().map(|argument| (*argument).to_owned()).collect::<Vec<_>>()
    };
    let cases: [(&[&str], &[&str]); 9] = [
        (&["--intensity", "pgv", "--outcome", "outcome"], &["no column \"pgv\"", "pgv_m_s"]),
        (&["--intensity", "pgv_m_s+1", "--outcome", "outcome"], &["--intensity", "'+' at character 8"]),
        (
            &["--intensity", "pgv_m_s", "--outcome", "floor"],
            &["runs.csv:2", "\"perpendicular\"", "stood or collapsed"],
        ),
        (&["--intensity", "record", "--outcome", "outcome"], &["runs.csv:2", "\"r0\"", "a finite number"]),
        (&["--intensity", "pgv_m_s", "--outcome", "outcome", "--level", "95"], &["--level", "95", "below 1"]),
        (&["--intensity", "pgv_m_s", "--outcome", "outcome", "--method", "cloud"], &["--method", "--demand"]),
        (
            &["--intensity", "2*pgv_m_s", "--outcome", "outcome", "--nrml", "f.xml", "--imt", "PGV"],
            &["--imt", "cm/s", "--imt-factor"],
        ),
        (
            &["--intensity", "pgv_m_s", "--outcome", "outcome", "--nrml", "f.xml", "--imt", "SA"],
            &["--imt", "SA(T)"],
        ),
        (
            &["--intensity", "pgv_m_s", "--outcome", "theta", "--trials", "facade"],
            &["runs.csv:2", "whole numbers"],
        ),
    ];
    for (arguments, told) in cases {
        let arguments = with(arguments);
        rejects(&arguments.iter().map(String::as_str).collect::<Vec<_>>(), told);
    }
    rejects(&["fragility", "none.csv", "--intensity", "x", "--outcome", "y"], &["none.csv"]);
}
