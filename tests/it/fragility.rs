//! Fragilities of shaking-table outcomes against independent fits and published figures.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

use crate::shared;

const PGV: &str = "pga_g*9.80665*pgv_over_pga_s";

pub fn mrbd(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mrbd")).args(arguments).output().expect("mrbd starts")
}

pub fn text(path: &Path) -> &str {
    path.to_str().expect("a path in UTF-8")
}

pub fn json(arguments: &[&str]) -> Value {
    let output = mrbd(arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

pub fn number(value: &Value, pointer: &str) -> f64 {
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
