//! Whatever is made of a study that has not run to its end says so, and over what it is judged.

use std::fs;
use std::path::Path;
use std::process::Output;

use crate::drawn_support::{drawn, stripes};
use crate::pipeline_cli::{mrbd, stdout, study};
use crate::pipeline_support::SMALL;

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// One block of a study, which is all under the first of its two records, in `part`; the whole study in `whole`.
fn part_and_whole(pipeline: &str) -> tempfile::TempDir {
    let folder = study(pipeline);
    let shard = ["--block-runs", "12", "--shard", "1/1000000"];
    stdout(&mrbd(folder.path(), &[&["run", "study.toml", "--out", "part"][..], &shard].concat()));
    stdout(&mrbd(folder.path(), &["run", "study.toml", "--out", "whole"]));
    folder
}

/// Runs of the plan, by the manifest.
fn planned(folder: &Path) -> u64 {
    let manifest = fs::read_to_string(folder.join("part/manifest.json")).expect("a manifest");
    let manifest: serde_json::Value = serde_json::from_str(&manifest).expect("JSON");
    manifest["runs"].as_u64().expect("a count")
}

/// The values of two columns of a CSV table, in every row.
fn columns(text: &str, names: [&str; 2]) -> Vec<[String; 2]> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().expect("a header").clone();
    let at =
        names.map(|name| header.iter().position(|known| known == name).unwrap_or_else(|| panic!("{name}")));
    let rows: Vec<_> =
        reader.records().map(|row| at.map(|i| row.as_ref().expect("a row")[i].to_owned())).collect();
    assert!(!rows.is_empty(), "{text}");
    rows
}

fn figures_and_tables(page: &str) -> usize {
    page.matches("<figcaption>").count() + page.matches("<caption>").count()
}

/// The page of a part says so at its head and under each figure and table, that of the whole nowhere.
fn pages(folder: &Path, told: &str) -> String {
    let reported = mrbd(folder, &["report", "part"]);
    assert!(stderr(&reported).contains(&format!("the study is unfinished: {told}")), "{}", stderr(&reported));
    let page = fs::read_to_string(folder.join(stdout(&reported).trim())).expect("a page");
    let said = format!("Unfinished: {told}.");
    assert!(figures_and_tables(&page) > 2);
    assert_eq!(page.matches(&said).count(), 1 + figures_and_tables(&page));
    let whole = mrbd(folder, &["report", "whole"]);
    assert!(!stderr(&whole).contains("unfinished"), "{}", stderr(&whole));
    let whole = fs::read_to_string(folder.join(stdout(&whole).trim())).expect("a page");
    assert!(!whole.contains("Unfinished"));
    page
}

#[test]
fn regress_a_part_of_a_sweep_is_said_to_be_one_in_page_table_and_findings() {
    let folder = part_and_whole(SMALL);
    let at = folder.path();
    let all = planned(at).to_string();
    let told = format!("12 of {all} runs, under 1 of 2 records");
    let page = pages(at, &told);
    assert!(page.contains("under one generated ground motion"), "counted are the records with runs");
    assert!(page.contains(&format!("judged over {told}")), "conclusions say over what");
    let aggregated = mrbd(at, &["aggregate", "part"]);
    let text = stdout(&aggregated);
    assert!(stderr(&aggregated).contains(&told), "{}", stderr(&aggregated));
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.matches(&format!("UNFINISHED: the study is unfinished: {told}")).count() == 2, "{text}");
    assert!(words.contains(&format!("judged over {told}")), "{text}");
    for (study, runs) in [("part", "12"), ("whole", all.as_str())] {
        let expected = [runs.to_owned(), all.clone()];
        let findings = fs::read_to_string(at.join(study).join("findings.csv")).expect("findings");
        let medians = stdout(&mrbd(at, &["aggregate", study, "--csv"]));
        for table in [findings, medians] {
            let found = columns(&table, ["study_runs", "planned_runs"]);
            assert!(found.iter().all(|row| *row == expected), "{found:?}");
        }
    }
    assert!(!stdout(&mrbd(at, &["aggregate", "whole"])).contains("UNFINISHED"));
    let accept = ["check", "part", "--baseline", "b.csv", "--accept", "--because", "looks right"];
    let refused = mrbd(at, &accept);
    assert_eq!(refused.status.code(), Some(2), "{}", stderr(&refused));
    assert!(stderr(&refused).contains("run to its end") && !at.join("b.csv").exists());
}

#[test]
fn regress_a_part_of_drawn_facades_is_said_to_be_one_in_page_curves_and_models() {
    let text = stripes().replace("[1.0, 4.0, 9.0]", "[2.0, 20.0]").replace("count = 6", "count = 24");
    let folder = part_and_whole(&text);
    let at = folder.path();
    let all = planned(at);
    let told = format!("12 of {all} runs, under 1 of 2 records");
    let page = pages(at, &told);
    assert!(page.contains("under 1 ground motion,"), "counted are the records with runs");
    let fit = |study: &str, more: &[&str]| {
        let common = ["--replicates", "0", "--out", "curves.csv", "--nrml", "f.xml", "--imt", "PGA"];
        mrbd(at, &[&["fragility", study][..], &common, more].concat())
    };
    for (study, unfinished) in [("part", true), ("whole", false)] {
        let table = fit(study, &[]);
        assert_eq!(stderr(&table).contains(&told), unfinished, "{}", stderr(&table));
        assert_eq!(
            stdout(&table).contains(&format!("UNFINISHED: the study is unfinished: {told}")),
            unfinished
        );
        let model = fs::read_to_string(at.join("f.xml")).expect("a model");
        assert_eq!(model.contains(&told), unfinished, "{model}");
        let json: serde_json::Value = serde_json::from_str(&stdout(&fit(study, &["--json"]))).expect("JSON");
        let runs = if unfinished { 12 } else { all };
        let records = if unfinished { 1 } else { 2 };
        let expected = serde_json::json!({
            "runs": runs, "planned_runs": all, "records": records, "planned_records": 2
        });
        assert_eq!(json["study"], expected);
        let curves = fs::read_to_string(at.join("curves.csv")).expect("curves");
        let header = curves.lines().next().expect("a header");
        assert!(header.ends_with(",study_runs,planned_runs"), "{header}");
        let counts = format!(",{runs},{all}");
        assert!(curves.lines().skip(1).all(|line| line.ends_with(&counts)), "{curves}");
    }
}

#[test]
fn regress_a_table_that_is_no_study_has_no_word_of_one() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let rows: String = (1..40).map(|k| format!("{k},{}\n", u8::from((k * 7) % 40 < k))).collect();
    fs::write(folder.path().join("t.csv"), format!("im,fell\n{rows}")).expect("written");
    let asked = ["fragility", "t.csv", "--intensity", "im", "--outcome", "fell", "--replicates", "0"];
    let told = mrbd(folder.path(), &[&asked[..], &["--out", "c.csv", "--json"]].concat());
    let json: serde_json::Value = serde_json::from_str(&stdout(&told)).expect("JSON");
    assert!(json["study"].is_null());
    let curves = fs::read_to_string(folder.path().join("c.csv")).expect("curves");
    assert!(curves.starts_with("intensity,probability,lower,upper\n"), "{curves}");
}

#[test]
fn regress_a_cloud_that_was_stopped_tells_its_share_in_the_fragility() {
    let folder = part_and_whole(&drawn("cloud", "[cloud]\nfrom = 1.0\nto = 3.0\n"));
    let told = mrbd(folder.path(), &["fragility", "part", "--intensity", "pgv_m_s", "--replicates", "0"]);
    assert!(stderr(&told).contains("the study is unfinished: 12 of 24 runs"), "{}", stderr(&told));
}

#[test]
fn rejects_runs_whose_checksums_are_gone_and_does_them_again() {
    let folder = part_and_whole(SMALL);
    let at = folder.path();
    let before = fs::read(at.join("whole/checksums.json")).expect("checksums");
    fs::remove_file(at.join("whole/checksums.json")).expect("removed");
    for command in ["aggregate", "report"] {
        let refused = mrbd(at, &[command, "whole"]);
        let message = stderr(&refused);
        assert_eq!(refused.status.code(), Some(2), "{message}");
        assert!(message.contains("part-1.parquet: found a file of runs without a checksum"), "{message}");
        assert!(message.contains("--resume"), "{message}");
    }
    let status = stdout(&mrbd(at, &["status", "whole"]));
    assert!(status.contains("(or its checksum is gone)"), "{status}");
    let again = mrbd(at, &["run", "study.toml", "--out", "whole", "--resume"]);
    assert!(stderr(&again).contains("its runs are done again"), "{}", stderr(&again));
    assert!(again.status.success());
    assert_eq!(fs::read(at.join("whole/checksums.json")).expect("checksums"), before, "the same bits");
}
