//! Records one after another: what a plan makes of them, what is carried on, and that nothing else decides the rows.

use std::fs;
use std::path::Path;

use indicatif::ProgressBar;
use mrbd::study::batch::{Finished, SideBySide, run_all, run_one};
use mrbd::study::plan::Plan;
use mrbd::study::runs::SCHEMA_VERSION;
use mrbd_kernel::simulate::simulate;
use serde_json::Value;

use crate::campaign::contents;
use crate::pipeline_cli::{mrbd, stdout, study};
use crate::pipeline_support::{SMALL, plan, stand_in, suite, try_plan};

/// Two façades under sequences; the tables of them go behind.
const FACADES: &str = r#"
kind = "sequence"
name = "after"
survey = "survey.toml"
coefficients = "coefficients.toml"
suite = "suite.toml"

[sampling]
count = 2
seed = 3
design = "latin_hypercube"

[[variants]]
name = "as new"

[[variants]]
name = "keeps"
set = { floor_yield_m = 1e-3, crushing_stays = true }
"#;

fn sequences(tables: &str) -> String {
    format!("{FACADES}\n{tables}")
}

fn pairs() -> String {
    sequences("[[sequence]]\npairs = \"all\"\nrest_s = 10.0\n")
}

fn all(plan: &Plan, simulate: &(impl mrbd::study::batch::Simulate + Sync)) -> Vec<Finished> {
    run_all(plan, (0..plan.len()).collect(), simulate, &ProgressBar::hidden())
}

#[test]
fn analytic_every_pair_is_three_rows_of_every_facade() {
    let plan = plan(&pairs(), 3);
    // 9 pairs, 2 variants, 2 floors, 2 façades, 3 rows.
    assert_eq!((plan.sequences().len(), plan.rows(), plan.len()), (9, 3, 9 * 2 * 2 * 2 * 3));
    let names: Vec<&str> = plan.sequences().map(|sequence| sequence.name.as_str()).collect();
    assert_eq!((names[0], names[1]), ("record 1-then-record 1", "record 1-then-record 2"));
    let rows: Vec<_> = (24..27).map(|position| plan.run(position)).collect();
    assert!(rows.iter().all(|run| run.facade == rows[0].facade));
    let told = rows.iter().map(|run| {
        let (sequence, place) = run.sequence.as_ref().expect("a row of a sequence");
        (sequence.name.as_str(), run.record().name.as_str(), place.part, place.alone, run.tail_s())
    });
    let of = "record 1-then-record 2";
    let expected =
        [(of, "record 1", 0, false, 10.0), (of, "record 2", 1, false, 5.0), (of, "record 2", 1, true, 5.0)];
    assert_eq!(told.collect::<Vec<_>>(), expected);
    let mut ids: Vec<String> = (0..plan.len()).map(|position| plan.run(position).id).collect();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len() as u64, plan.len(), "no two rows are alike in what goes into them");
}

#[test]
fn regress_scales_and_rests_go_into_the_plan() {
    let of = |table: &str| plan(&sequences(&format!("[[sequence]]\npairs = \"different\"\n{table}")), 3);
    let [one, other, longer] =
        ["rest_s = 10.0", "rest_s = 10.0\nscale = [1.0, 0.5]", "rest_s = 11.0"].map(of);
    assert_eq!(one.sequences().len(), 6);
    assert_eq!(other.run(1).shaking().horizontal.expect("a record").peak_m_s2(), 1.0);
    assert_eq!(one.run(1).shaking().horizontal.expect("a record").peak_m_s2(), 2.0);
    assert_ne!(one.sha256(), other.sha256());
    assert_ne!(one.sha256(), longer.sha256());
    assert_ne!(one.run(0).id, longer.run(0).id);
}

#[test]
fn rejects_sequences_that_cannot_be() {
    let refused = |tables: &str| try_plan(&sequences(tables), suite(2)).expect_err("refused").to_string();
    let of = |names: &str| format!("[[sequence]]\nrecords = [{names}]\nrest_s = 1.0\n");
    let told = refused(&of("\"record 1\", \"record 7\""));
    assert!(told.contains("sequence[0].records: found \"record 7\"") && told.contains("record 2"), "{told}");
    let twice = of("\"record 1\", \"record 2\"").repeat(2);
    assert!(refused(&twice).contains("two sequences named \"record 1-then-record 2\""));
    let longer = of("\"record 1\", \"record 2\"") + &of("\"record 1\", \"record 2\", \"record 1\"");
    assert!(refused(&longer).contains("of 3 records beside one of 2"));
    let parse = |text: String| {
        mrbd::study::pipeline::Pipeline::parse(Path::new("p.toml"), text).expect_err("refused").to_string()
    };
    assert!(parse(FACADES.to_owned()).contains("missing field `sequence`"));
    let sweep = format!("{SMALL}\n[[sequence]]\npairs = \"all\"\nrest_s = 1.0\n");
    assert!(parse(sweep).contains("only in a study of its own kind"));
    let neither = pairs().replace("[sampling]\ncount = 2\nseed = 3\ndesign = \"latin_hypercube\"\n", "");
    assert!(parse(neither).contains("neither or both of [sweep] and [sampling]"));
    let members = pairs().replacen("name = \"as new\"", "name = \"as new\"\nmembers = 2", 1);
    assert!(parse(members).contains("members only in a sweep"));
    let yields = pairs().replace("floor_yield_m = 1e-3", "floor_yield_m = 0.0");
    assert!(parse(yields).contains("variants[1].set.floor_yield_m: found 0"));
}

#[test]
fn regress_facades_of_a_sweep_have_sequences_too() {
    let sweep = SMALL.replacen("name = \"small\"", "kind = \"sequence\"\nname = \"small\"", 1);
    let plan = plan(&format!("{sweep}\n[[sequence]]\npairs = \"all\"\nrest_s = 1.0\n"), 2);
    // 4 pairs, 2 variants, 18 façades, 3 rows.
    assert_eq!(plan.len(), 4 * 2 * 18 * 3);
    assert!(plan.drawn().is_none());
}

/// Walls of this simulator fall above 5 m/s², fail at 9 and panic at 10.
#[test]
fn regress_every_part_is_a_row_whatever_went_before() {
    let tables = "[[sequence]]\nrecords = [\"record 7\", \"record 1\", \"record 2\"]\nrest_s = 1.0\n\
                  [[sequence]]\nrecords = [\"record 9\", \"record 1\", \"record 2\"]\nrest_s = 1.0\n\
                  [[sequence]]\nrecords = [\"record 10\", \"record 1\", \"record 2\"]\nrest_s = 1.0\n";
    let plan = plan(&sequences(tables), 10);
    let finished = all(&plan, &stand_in);
    assert_eq!(finished.len() as u64, plan.len());
    for (position, finished) in finished.iter().enumerate() {
        assert_eq!(finished.run.position, position as u64);
        assert_eq!(finished.run.id, plan.run(position as u64).id);
        let (sequence, place) = finished.run.sequence.as_ref().expect("a sequence");
        let expected = match (place.part, place.alone) {
            (_, true) => "stood",
            (0, _) if sequence.name.starts_with("record 7") => "collapsed",
            (_, _) if sequence.name.starts_with("record 7") => "collapsed before",
            _ => "failed",
        };
        assert_eq!(finished.outcome(), expected, "{} {place:?}", sequence.name);
        let reason = finished.failure.as_deref().unwrap_or_default();
        match (expected, place.part) {
            ("collapsed before", _) => assert_eq!((finished.fell_in, &finished.response), (Some(0), &None)),
            ("failed", 1) => assert!(reason.starts_with("part 1 failed: "), "{reason}"),
            ("failed", 2) => assert!(reason.starts_with("part 2 failed: part 1 failed: "), "{reason}"),
            _ => {}
        }
    }
}

#[test]
fn analytic_a_row_is_the_same_alone_and_after_the_rest_of_its_sequence() {
    // Peaks of 1 to 5 m/s² over two steps of 10 ms hardly move a wall; what they do is theirs to the bit.
    let plan = plan(&pairs(), 5);
    let finished = all(&plan, &SideBySide);
    for (position, finished) in finished.iter().enumerate() {
        let again = run_one(plan.run(position as u64), &SideBySide);
        assert_eq!(again.response, finished.response, "row {position}");
        assert_eq!(again.run.id, finished.run.id);
    }
    let alone = |finished: &&Finished| finished.run.parts_before() == 0;
    for finished in finished.iter().filter(alone) {
        let wall = finished.run.wall.as_ref().expect("a wall");
        let by_itself = simulate(wall, &finished.run.shaking(), finished.run.accuracy());
        assert_eq!(finished.response, Some(by_itself));
    }
}

/// The rows of a study as CSV tells them: by column.
fn rows(csv: &str) -> Vec<std::collections::HashMap<String, String>> {
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    reader.deserialize().map(|row| row.expect("a row")).collect()
}

#[test]
fn regress_a_study_of_sequences_runs_from_pipeline_to_page() {
    let folder = study(&pairs());
    let at = folder.path();
    let told =
        stdout(&mrbd(at, &["run", "study.toml", "--out", "out", "--block-runs", "2", "--threads", "1"]));
    assert!(told.contains("What a record does after others"), "{told}");
    let by_sequence = told.split("The same by sequence").nth(1).expect("a table by sequence");
    assert!(by_sequence.contains("pulse_1-then-pulse_2"), "{told}");
    let whole = told.lines().take_while(|line| !line.contains("by sequence"));
    assert!(whole.into_iter().all(|line| line.chars().count() <= 120), "tables fit a terminal\n{told}");
    assert_eq!(stdout(&mrbd(at, &["aggregate", "out"])), told, "the same from the files");
    let table = rows(&stdout(&mrbd(at, &["aggregate", "out", "--csv"])));
    // Over all, and 4 pairs; 2 variants; 2 floors.
    assert_eq!(table.len(), 5 * 2 * 2);
    for row in table.iter().filter(|row| row["variant"] == "as new" && row["ratios"] != "0") {
        // A wall that keeps nothing and has come to rest is as new, to the bit.
        assert_eq!(
            (&*row["ratio_q16"], &*row["ratio_median"], &*row["ratio_q84"]),
            ("1", "1", "1"),
            "{row:?}"
        );
    }
    let kept: Vec<&str> =
        table.iter().filter(|row| row["variant"] == "keeps").map(|row| &*row["ratio_median"]).collect();
    assert!(kept.iter().any(|ratio| *ratio != "1"), "what is kept is felt: {kept:?}");
    // Neither threads, shards nor stops decide; blocks of two runs cut the three rows of a wall.
    for shard in ["2/3", "1/3", "3/3"] {
        stdout(&mrbd(at, &["run", "study.toml", "--out", "parts", "--block-runs", "2", "--shard", shard]));
    }
    stdout(&mrbd(at, &["merge", "parts"]));
    let one = contents(&at.join("out"));
    assert_eq!(one, contents(&at.join("parts")));
    assert!(
        one.keys().any(|file| file.to_string_lossy().contains("sequence=pulse_1-then-pulse_2")),
        "{one:?}"
    );
    let victim = at.join("out/runs/sequence=pulse_1-then-pulse_2/part-1.parquet");
    fs::write(&victim, "damaged").expect("written");
    stdout(&mrbd(at, &["run", "study.toml", "--out", "out", "--block-runs", "2", "--resume"]));
    assert_eq!(one, contents(&at.join("out")));
    let status = stdout(&mrbd(at, &["status", "out"]));
    assert!(status.contains("96 of 96 runs"), "{status}");
    let page = stdout(&mrbd(at, &["report", "out"]));
    let page = fs::read_to_string(at.join(page.trim())).expect("a page");
    for part in [
        "What a record does after others",
        "With a floor that yields and keeps what it has yielded: “keeps”.",
        "sequences.parquet",
    ] {
        assert!(page.contains(part), "{part}");
    }
    for run in ["0", "1", "2", "25"] {
        let replayed = mrbd(at, &["replay", "out", run, "--history", "h.csv"]);
        let told = String::from_utf8_lossy(&replayed.stderr).into_owned();
        assert!(told.contains("the same bits as stored"), "{told}");
    }
    for command in
        [&["check", "out", "--baseline", "b.csv"][..], &["check-tolerance", "out"], &["fragility", "out"]]
    {
        assert_eq!(mrbd(at, command).status.code(), Some(2), "{command:?}");
    }
}

#[test]
fn regress_results_of_the_version_before_are_read_and_not_gone_on_with() {
    let folder = study(SMALL);
    let at = folder.path();
    let told = stdout(&mrbd(at, &["run", "study.toml", "--out", "out"]));
    let path = at.join("out/manifest.json");
    let text = fs::read_to_string(&path).expect("a manifest");
    let now = format!("\"schema_version\": {SCHEMA_VERSION}");
    assert!(text.contains(&now));
    fs::write(&path, text.replace(&now, "\"schema_version\": 3")).expect("written");
    assert_eq!(stdout(&mrbd(at, &["aggregate", "out"])), told);
    let resumed = mrbd(at, &["run", "study.toml", "--out", "out", "--resume"]);
    assert_eq!(resumed.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&resumed.stderr).contains("schema_version: 3, now 4"));
}

/// A wall, a record of it and another at the same step, and both joined with zeros between by hand.
fn one_wall() -> tempfile::TempDir {
    let folder = study(&pairs());
    let samples = |name: &str| -> Vec<String> {
        let text = fs::read_to_string(folder.path().join(name)).expect("a record");
        text.lines().skip(1).map(|line| line.split_once(',').expect("two columns").1.to_owned()).collect()
    };
    // 2 s at 5 ms from the last sample of one to the first of the next: 399 zeros.
    let both = [samples("pulse_1.csv"), vec!["0".to_owned(); 399], samples("pulse_2.csv")].concat();
    let rows = both.iter().enumerate().map(|(k, a)| format!("{:.3},{a}\n", 0.005 * k as f64));
    let text = format!("time_s,acceleration_m_s2\n{}", rows.collect::<String>());
    fs::write(folder.path().join("both.csv"), text).expect("written");
    let wall = Path::new(env!("CARGO_MANIFEST_DIR")).join("inputs/walls/table_wall.toml");
    fs::copy(wall, folder.path().join("wall.toml")).expect("copied");
    folder
}

fn simulated(folder: &Path, arguments: &[&str]) -> Value {
    let told = stdout(&mrbd(folder, &[&["simulate", "wall.toml", "--json"], arguments].concat()));
    serde_json::from_str(&told).expect("JSON")
}

#[test]
fn analytic_simulate_then_is_the_joined_record() {
    let folder = one_wall();
    let at = folder.path();
    let then = ["--record", "pulse_1.csv", "--then", "pulse_2.csv", "--rest", "2", "--history", "h.csv"];
    let (mut sequence, joined) =
        (simulated(at, &then), simulated(at, &["--record", "both.csv", "--history", "j.csv"]));
    let parts = sequence["parts"].take();
    sequence.as_object_mut().expect("an object").remove("parts");
    assert_eq!(sequence, joined, "the same run to the bit");
    let read = |name: &str| fs::read(at.join(name)).expect("a history");
    assert_eq!(read("h.csv"), read("j.csv"));
    // The first record lasts 0.5 s.
    assert_eq!((parts[0]["start_s"].as_f64(), parts[1]["start_s"].as_f64()), (Some(0.0), Some(2.5)));
    for name in ["theta1_max_over_alpha1", "theta2_max_over_alpha2"] {
        let of = |part: usize| parts[part][name].as_f64().expect("a number");
        let largest = joined[name].as_f64().expect("a number");
        // A quotient of the same two numbers.
        assert!((of(0).max(of(1)) - largest).abs() <= f64::EPSILON * largest, "{parts}");
        let alone = simulated(at, &["--record", "pulse_2.csv", "--alone"]);
        assert_eq!(parts[1]["alone"][name], alone[name]);
    }
    assert_eq!(parts[0].get("alone"), None, "the first is just that");
    let told = stdout(&mrbd(at, &[&["simulate", "wall.toml", "--plot", "run.html"], &then[..6]].concat()));
    assert!(told.contains("part 2") && told.contains("alone"), "{told}");
    let page = fs::read_to_string(at.join("run.html")).expect("a page");
    assert!(page.contains("Part by part") && page.contains("pulse_1.csv, then pulse_2.csv"));
}

#[test]
fn analytic_a_part_after_a_fall_has_no_rotation() {
    let folder = one_wall();
    let then = ["--record", "pulse_1.csv", "--scale", "20", "--then", "pulse_2.csv", "--rest", "2"];
    let parts = simulated(folder.path(), &then)["parts"].take();
    assert_eq!(parts[0]["collapsed"], true);
    assert_eq!((&parts[1]["collapsed"], &parts[1]["theta1_max_over_alpha1"]), (&Value::Null, &Value::Null));
    assert_eq!(parts[1]["alone"]["collapsed"], false);
}

#[test]
fn rejects_records_that_cannot_follow() {
    let folder = one_wall();
    let at = folder.path();
    fs::write(at.join("coarse.csv"), "time_s,acceleration_m_s2\n0.00,0\n0.01,1\n0.02,0\n").expect("written");
    let refused = |arguments: &[&str], told: &str| {
        let output = mrbd(at, &[&["simulate", "wall.toml", "--record", "pulse_1.csv"], arguments].concat());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(told), "{told} in {message}");
    };
    refused(&["--then", "coarse.csv"], "a step of 0.01 s");
    refused(&["--then", "pulse_2.csv", "--rest", "0.005"], "--rest: found 0.005");
    refused(&["--then", "pulse_2.csv", "--rest", "nan"], "--rest: found NaN");
    refused(&["--then", "pulse_2.csv", "--then-scale", "inf"], "--then-scale: found inf");
    refused(&["--then", "nothing.csv"], "nothing.csv");
    refused(&["--rest", "10"], "--then");
    refused(&["--then", "pulse_2.csv", "--vertical", "pulse_2.csv"], "--vertical");
}
