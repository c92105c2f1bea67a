//! Overturning spectra: the boundaries of Zhang and Makris (2001), and what a study file may say.

use std::path::Path;
use std::process::Command;

use mrbd::classics::overturning::{Study, picture, spectrum};

const SHIPPED: &str = include_str!("../../pipelines/overturning_spectrum.toml");

/// The shipped study with replacements, in a folder of its own.
fn study_file(folder: &Path, replacements: &[(&str, &str)]) -> std::path::PathBuf {
    let inputs = concat!("\"", env!("CARGO_MANIFEST_DIR"), "/inputs");
    let mut text = SHIPPED.replace("\"../inputs", inputs);
    for (old, new) in replacements {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    let path = folder.join("study.toml");
    std::fs::write(&path, text).expect("the study");
    path
}

#[test]
fn published_boundaries_of_zhang_and_makris() {
    let folder = tempfile::tempdir().expect("a folder");
    let frequencies = ("from = 1.0, to = 8.0, count = 29", "from = 4.0, to = 5.0, count = 2");
    let study = Study::load(&study_file(folder.path(), &[frequencies])).expect("valid").expect("a spectrum");
    let found = spectrum(&study, || ()).expect("every run ends");
    let at_five: Vec<_> = found.boundaries.iter().filter(|b| b.frequency_over_p == 5.0).collect();
    let published = [(3.0186, true), (6.3180, false), (7.1681, true)];
    assert_eq!(at_five.len(), published.len(), "{at_five:?}");
    for (boundary, (amplitude, overturns_above)) in at_five.iter().zip(published) {
        assert_eq!(boundary.overturns_above, overturns_above, "{boundary:?}");
        // Half the last digit that is printed and the width to which the study narrows.
        let off = (boundary.below_over_alpha_g - amplitude).abs();
        assert!(off <= 0.5e-4 + study.boundary_tolerance, "{boundary:?} against {amplitude}");
    }
    let drawn = picture(&found);
    assert!(drawn.contains('#') && drawn.contains("overturns"), "{drawn}");
}

#[test]
fn regress_a_spectrum_is_stored_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    let small = [("count = 29", "count = 3"), ("count = 39", "count = 5"), ("= 4000", "= 200")];
    let study = study_file(folder.path(), &small);
    let out = folder.path().join("out");
    let run = |threads: &str| {
        let output = Command::new(env!("CARGO_BIN_EXE_mrbd"))
            .args(["run", study.to_str().expect("UTF-8"), "--threads", threads, "--force", "--out"])
            .arg(&out)
            .output()
            .expect("mrbd starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let file = std::fs::read(out.join("trials.parquet")).expect("the trials");
        (output.stdout, file)
    };
    assert_eq!(run("1"), run("2"), "results depend on threads");
    let again =
        Command::new(env!("CARGO_BIN_EXE_mrbd")).arg("run").arg(&study).arg("--out").arg(&out).output();
    let again = again.expect("mrbd starts");
    let told = String::from_utf8_lossy(&again.stderr);
    assert!(again.status.code() == Some(2) && told.contains("--force"), "{told}");
    let file = std::fs::File::open(out.join("trials.parquet")).expect("the trials");
    let reader =
        parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder::try_new(file).expect("Parquet");
    assert_eq!(reader.metadata().file_metadata().num_rows(), 15);
}

#[test]
fn rejects_studies_that_cannot_be() {
    let folder = tempfile::tempdir().expect("a folder");
    for (old, new, told) in [
        ("count = 29", "count = 1", "frequency_over_p"),
        ("from = 0.5", "from = -0.5", "amplitude_over_alpha_g"),
        ("pulse = \"one_sine\"", "pulse = \"two_sines\"", "one_cosine"),
        ("tolerance = 1e-8", "tolerance = 1.0", "tolerance"),
        ("slender_block.toml", "nothing.toml", "nothing.toml"),
        ("boundary_tolerance", "boundary_tolerence", "boundary_tolerence"),
    ] {
        let path = study_file(folder.path(), &[(old, new)]);
        let error = Study::load(&path).expect_err("must be refused");
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains(told), "{told}: {error}");
    }
}
