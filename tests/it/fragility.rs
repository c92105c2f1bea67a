//! Fragilities against independent fits, on data of known fragility, and as a user meets them.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use mrbd::fragility::{Bootstrap, Clusters, Interval, Known, Method, Sample, Settings, analyse};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use serde_json::Value;

use crate::shared;

const PGV: &str = "pga_g*9.80665*pgv_over_pga_s";

fn mrbd(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mrbd")).args(arguments).output().expect("mrbd starts")
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a path in UTF-8")
}

fn json(arguments: &[&str]) -> Value {
    let output = mrbd(arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn rejects(arguments: &[&str], told: &[&str]) {
    let output = mrbd(arguments);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(output.stdout.is_empty(), "data on stdout");
    for part in told {
        assert!(message.contains(part), "no `{part}` in: {message}");
    }
}

fn number(value: &Value, pointer: &str) -> f64 {
    value.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("{pointer} in {value:#}"))
}

#[test]
fn verified_shaking_table_outcomes_against_independent_fits() {
    let Some(folder) = shared::folder("overturning") else { return };
    let table = folder.join("granite_outcomes.csv");
    // tests/python/fragility_reference.py with statsmodels 0.15.0 and scipy 1.17.1:
    // median, β, log-likelihood, standard errors of ln median and β, area under the ROC curve.
    let references = [
        (
            "sp1_overturned",
            PGV,
            [
                0.138_962_500_03,
                0.393_637_693_912,
                -152.481_171_752,
                0.032_513_301_130_6,
                0.032_788_179_446_5,
                0.954_768_928_22,
            ],
        ),
        (
            "sp2_overturned",
            PGV,
            [
                0.179_124_835_788,
                0.457_736_574_257,
                -155.407_787_032,
                0.038_481_346_087_7,
                0.037_328_940_27,
                0.946_521_571_187,
            ],
        ),
        (
            "sp1_overturned",
            "pga_g",
            [
                0.318_416_989_879,
                1.368_459_306_84,
                -326.002_851_125,
                0.081_003_686_792_6,
                0.127_733_420_43,
                0.774_318_074_22,
            ],
        ),
        (
            "sp2_overturned",
            "pga_g",
            [
                0.410_054_114_64,
                0.980_514_633_543,
                -263.384_286_71,
                0.066_951_208_691_8,
                0.080_003_938_970_3,
                0.849_248_105_279,
            ],
        ),
    ];
    for (outcome, intensity, expected) in references {
        let result = json(&[
            "fragility",
            text(&table),
            "--intensity",
            intensity,
            "--outcome",
            outcome,
            "--replicates",
            "0",
            "--json",
        ]);
        assert_eq!(number(&result, "/groups/0/trials"), 582.0);
        let found = [
            "median",
            "beta",
            "log_likelihood",
            "ln_median_standard_error",
            "beta_standard_error",
            "goodness/auc",
        ]
        .map(|key| number(&result, &format!("/groups/0/{key}")));
        for (found, expected) in found.into_iter().zip(expected) {
            // Twelve digits are printed; both optimisers end within 1e-9 of the maximum.
            assert!(
                (found / expected - 1.0).abs() < 1e-8,
                "{outcome} {intensity}: {found} against {expected}"
            );
        }
    }
}

#[test]
fn published_shaking_table_figures() {
    let Some(folder) = shared::folder("overturning") else { return };
    let table = folder.join("granite_outcomes.csv");
    // The figures given with the data, to their three digits.
    for (outcome, figures, pga_auc) in
        [("sp1_overturned", [0.139, 0.394, 0.955], 0.774), ("sp2_overturned", [0.179, 0.458, 0.947], 0.849)]
    {
        let fit = |intensity: &str| {
            json(&[
                "fragility",
                text(&table),
                "--intensity",
                intensity,
                "--outcome",
                outcome,
                "--replicates",
                "0",
                "--json",
            ])
        };
        let pgv = fit(PGV);
        let found = ["median", "beta", "goodness/auc"].map(|key| number(&pgv, &format!("/groups/0/{key}")));
        for (found, figure) in found.into_iter().zip(figures) {
            assert!((found - figure).abs() <= 0.0005, "{outcome}: {found} against {figure}");
        }
        let auc = number(&fit("pga_g"), "/groups/0/goodness/auc");
        assert!((auc - pga_auc).abs() <= 0.0005, "{outcome}: {auc} against {pga_auc}");
    }
}

/// The truth of the synthetic data: ln capacity ~ N(ln ½, 0.45).
const TRUE_MEDIAN: f64 = 0.5;
const TRUE_BETA: f64 = 0.45;

/// Outcomes in clusters of `size` whose ln capacities share the fraction `share` of their variance.
fn synthetic(seed: u64, clusters: usize, size: usize, share: f64) -> Sample {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
    let mut rows = Vec::new();
    for _ in 0..clusters {
        let common = share.sqrt() * normal();
        for _ in 0..size {
            let ln_x = TRUE_MEDIAN.ln() + 0.6 * normal();
            let capacity = TRUE_MEDIAN.ln() + TRUE_BETA * (common + (1.0 - share).sqrt() * normal());
            rows.push((ln_x.exp(), ln_x > capacity));
        }
    }
    Sample::from_outcomes(rows).expect("valid")
}

fn covers(interval: Interval, truth: f64) -> bool {
    interval.lower.is_none_or(|lower| lower <= truth) && interval.upper.is_none_or(|upper| truth <= upper)
}

/// Shares of 500 samples whose intervals hold the true median and the true β.
fn coverage(
    sample: impl Fn(u64) -> Sample + Sync,
    replicates: u32,
    bounds: impl Fn(&Known) -> [Interval; 2] + Sync,
) -> [f64; 2] {
    let bootstrap = Bootstrap { replicates, seed: 7 };
    let settings = Settings { method: Method::Outcomes, bootstrap, level: 0.95 };
    let hits: Vec<[bool; 2]> = (0..500u64)
        .into_par_iter()
        .map(|trial| {
            let known = analyse(&sample(trial), &settings).result.expect("a fragility");
            let [median, beta] = bounds(&known);
            [covers(median, TRUE_MEDIAN), covers(beta, TRUE_BETA)]
        })
        .collect();
    [0, 1].map(|i| hits.iter().filter(|hit| hit[i]).count() as f64 / 500.0)
}

#[test]
fn analytic_profile_intervals_hold_the_truth_as_often_as_they_say() {
    let bounds = |known: &Known| known.profile.map(|b| [b.median, b.beta]).expect("a profile");
    let shares = coverage(|trial| synthetic(trial, 150, 1, 0.0), 0, bounds);
    // 95 % of 500 scatter by √(0.95 · 0.05/500) = 1 %; three of these.
    assert!(shares.iter().all(|share| (0.92..=0.98).contains(share)), "{shares:?}");
}

#[test]
fn analytic_cluster_intervals_hold_the_truth_where_independent_ones_do_not() {
    let clustered = |trial| {
        let sample = synthetic(1000 + trial, 60, 3, 0.8);
        sample.with_clusters(Clusters::new("record", (0..180).map(|row| row / 3)))
    };
    let bounds = |known: &Known| known.best().map(|(_, b)| [b.median, b.beta]).expect("intervals");
    let shares = coverage(clustered, 149, bounds);
    // As above; what 60 clusters and 149 replicates lack of infinity is within it.
    assert!(shares.iter().all(|share| (0.92..=0.98).contains(share)), "{shares:?}");
    let naive = |known: &Known| known.profile.map(|b| [b.median, b.beta]).expect("a profile");
    let [median, _] = coverage(clustered, 0, naive);
    // Fewer by more than chance: the median of three outcomes that fail together is known less well than of three.
    assert!(median < 0.92, "{median}");
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
    use arrow::array::{ArrayRef, BooleanArray, Float64Array, RecordBatch, StringArray};
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
