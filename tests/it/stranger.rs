//! The tour of a stranger: the first steps and the commands of the README as they stand, and odd inputs.
//!
//! Odd inputs are what somebody gives to the program in the first hour. Each is refused or questioned with the place,
//! what was found and what is allowed, or taken, and the exit code says which.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::pipeline_cli::{mrbd, stdout};
use crate::stranger_inputs::Odd::{Change, Nothing, Write};
use crate::stranger_inputs::{OPTIONS, RECORDS, Row, STUDIES, TABLES, WALLS};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
const RECORD: &str = "records/generated_4_600ya.csv";

/// Runs a line of the docs in a shell, with this program as `mrbd`.
fn shell(folder: &Path, line: &str) -> std::process::Output {
    let program = Path::new(env!("CARGO_BIN_EXE_mrbd")).parent().expect("a folder");
    let path = format!("{}:{}", program.display(), std::env::var("PATH").expect("a path"));
    let mut bash = Command::new("bash");
    bash.args(["-eu", "-c", line]).env("PATH", path).current_dir(folder).output().expect("bash starts")
}

/// Lines of the README's shell blocks that begin with `mrbd`.
fn readme_lines() -> Vec<String> {
    let page = fs::read_to_string(Path::new(ROOT).join("README.md")).expect("the README");
    let blocks = page.split("\n```sh\n").skip(1).filter_map(|rest| Some(rest.split_once("\n```")?.0));
    let lines = blocks.flat_map(str::lines).filter(|line| line.starts_with("mrbd ")).map(str::to_owned);
    lines.collect()
}

/// What the README's commands read: the inputs of the repository, its studies with few façades, one's own study and
/// files of the names that it gives them.
fn readme_folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = folder.path();
    stdout(&mrbd(at, &["init", "own"]));
    std::os::unix::fs::symlink(Path::new(ROOT).join("inputs"), at.join("inputs")).expect("linked");
    fs::create_dir(at.join("pipelines")).expect("made");
    for name in ["monte_carlo", "fragility", "model_comparison", "overturning_spectrum"] {
        let text =
            fs::read_to_string(Path::new(ROOT).join(format!("pipelines/{name}.toml"))).expect("shipped");
        let few =
            |line: &str| if line.starts_with("count = ") { "count = 8".to_owned() } else { line.to_owned() };
        let text: Vec<String> = text.lines().map(few).collect();
        fs::write(at.join(format!("pipelines/{name}.toml")), text.join("\n")).expect("written");
    }
    let mine = fs::read_to_string(at.join("own/pipeline.toml")).expect("the starter's");
    let beside = ["survey.toml", "coefficients.toml", "records/suite.toml"];
    let mine = beside
        .iter()
        .fold(mine, |text, name| text.replace(&format!("{name:?}"), &format!("\"../own/{name}\"")));
    fs::write(at.join("pipelines/mine.toml"), mine).expect("written");
    // PEER's layout: four lines of a header, then accelerations in g.
    let samples: Vec<String> =
        (0..400).map(|k| format!("{:.6E}", 0.3 * (f64::from(k) * 0.06).sin())).collect();
    let head = "PEER STRONG MOTION DATABASE\nNOWHERE, 2000\nACCELERATION TIME HISTORY IN UNITS OF G\nNPTS= 400, DT= .0100 SEC\n";
    fs::write(at.join("quake.AT2"), format!("{head}{}\n", samples.join("\n"))).expect("written");
    let rows: String = (1..60).map(|k| format!("{},{}\n", f64::from(k) / 50.0, (k * 7) % 60 < k)).collect();
    fs::write(at.join("TABLE.csv"), format!("pgv_m_s,collapsed\n{rows}")).expect("written");
    for study in ["monte_carlo", "fragility"] {
        let out = format!("outputs/{study}");
        stdout(&mrbd(at, &["run", &format!("pipelines/{study}.toml"), "--out", &out]));
    }
    folder
}

#[test]
fn regress_every_command_of_the_readme_runs_as_it_stands() {
    let folder = readme_folder();
    let lines = readme_lines();
    assert!(lines.len() > 20, "{} commands", lines.len());
    let mut here = folder.path().to_path_buf();
    for line in &lines {
        // A study that was run, or begun in part, goes on; experiments are the starter's.
        let line = line.replace("EXPERIMENT.toml", "own/experiment.toml").replace("3/16", "1/1");
        // It has 840 runs in seven blocks, too few for 64 tasks.
        let line = line.replace("--tasks 64", "--tasks 7").replace("mine 1234", "mine 123");
        let output = shell(&here, &line);
        let message = String::from_utf8_lossy(&output.stderr);
        // The study is whole already, so there is nothing to merge.
        let nothing_left = line.starts_with("mrbd merge") && message.contains("put together");
        assert!(output.status.success() || nothing_left, "{line}\n{message}");
        if line.contains("cd first") {
            here.push("first");
        } else if here.ends_with("first") {
            assert!(here.join("run.html").is_file(), "the page of the first steps");
            here.pop();
        }
    }
}

#[test]
fn regress_the_picture_of_the_readme_is_that_of_its_first_steps() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    stdout(&mrbd(folder.path(), &["init"]));
    let lines = readme_lines();
    let first = lines.iter().find(|line| line.contains("--plot run.html")).expect("first steps");
    let output = shell(folder.path(), &first.replace("run.html", "run.svg"));
    // An example to begin with is one whose verdict holds.
    let told = stdout(&output);
    assert!(told.starts_with("The wall stood") && told.contains("\nIt stood in 4 of 4"), "{told}");
    let made = fs::read_to_string(folder.path().join("run.svg")).expect("a picture");
    let path = Path::new(ROOT).join("docs/run.svg");
    if std::env::var_os("UPDATE_GUIDE").is_some() {
        fs::write(&path, &made).expect("written");
    }
    let same = fs::read_to_string(&path).is_ok_and(|shown| shown == made);
    assert!(same, "docs/run.svg: UPDATE_GUIDE=1 cargo test --release --locked --test it stranger");
}

#[test]
fn regress_the_version_names_the_commit_where_the_build_knew_it() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let version = env!("CARGO_PKG_VERSION");
    let commit = option_env!("MRBD_COMMIT").filter(|commit| !commit.is_empty());
    let expected =
        commit.map_or(format!("mrbd {version}\n"), |commit| format!("mrbd {version} ({commit})\n"));
    assert_eq!(stdout(&mrbd(folder.path(), &["--version"])), expected);
}

/// The starter's files with what the rows need: a study that was run, a margin, a comparison of models.
fn prepared() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = folder.path();
    stdout(&mrbd(at, &["init"]));
    stdout(&mrbd(at, &["run", "pipeline.toml"]));
    stdout(&mrbd(at, &["margin", "wall.toml", "--suite", "records/suite.toml", "--out", "margin"]));
    let models = "name = \"models\"\nwall = \"wall.toml\"\ncoefficients = \"coefficients.toml\"\n\
                  suite = \"records/suite.toml\"\n[comparison]\nscales = [1.0]\nlaws = [\"contact\"]\n\
                  tail_s = 1.0\ntolerance = 1e-6\n";
    fs::write(at.join("models.toml"), models).expect("written");
    stdout(&mrbd(at, &["run", "models.toml", "--out", "models"]));
    folder
}

/// What is wrong with the answer to a row; `None` where it is as it should be.
fn wrong(folder: &Path, (command, odd, code, told): &Row) -> Option<String> {
    let (Change(file, ..) | Write(file, _)) = odd else {
        return wrong_answer(folder, command, *code, told);
    };
    let path = folder.join(file);
    let before = fs::read(&path).ok();
    let now = match odd {
        Change(_, from, to) => {
            let text = String::from_utf8(before.clone().expect("a starter file")).expect("text");
            assert!(text.contains(from), "{from} in {file}");
            text.replacen(from, to, 1).into_bytes()
        }
        Write(_, bytes) => bytes.to_vec(),
        Nothing => Vec::new(),
    };
    fs::write(&path, now).expect("written");
    let wrong = wrong_answer(folder, command, *code, told);
    match before {
        Some(before) => fs::write(&path, before).expect("written"),
        None => fs::remove_file(&path).expect("removed"),
    }
    wrong
}

fn wrong_answer(folder: &Path, command: &str, code: i32, told: &[&str]) -> Option<String> {
    let arguments: Vec<&str> = command.split(' ').collect();
    let output = mrbd(folder, &arguments);
    let said = [&output.stdout[..], &output.stderr].concat();
    let said = String::from_utf8_lossy(&said);
    let missing: Vec<_> = told.iter().filter(|part| !said.contains(**part)).collect();
    let is_right = output.status.code() == Some(code) && missing.is_empty();
    (!is_right).then(|| {
        format!("{command}: code {:?}, not {code}, or no {missing:?} in {said}", output.status.code())
    })
}

#[test]
fn rejects_or_questions_odd_inputs_with_place_found_and_allowed() {
    let folder = prepared();
    let tables = [WALLS, RECORDS, OPTIONS, STUDIES, TABLES];
    assert!(tables.iter().map(|rows| rows.len()).sum::<usize>() > 60);
    let wrong: Vec<String> =
        tables.into_iter().flatten().filter_map(|row| wrong(folder.path(), row)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    // The files of the rows are as they were, so what follows runs as before.
    stdout(&mrbd(folder.path(), &["simulate", "wall.toml", "--record", RECORD]));
}

#[test]
fn regress_a_tolerance_that_shortens_no_step_says_so() {
    let folder = prepared();
    let run = |scale: &str, tolerance: &str| {
        let asked = ["simulate", "wall.toml", "--record", RECORD, "--alone", "--json"];
        let told = stdout(&mrbd(
            folder.path(),
            &[&asked[..], &["--scale", scale, "--tolerance", tolerance]].concat(),
        ));
        let mut json: serde_json::Value = serde_json::from_str(&told).expect("JSON");
        let steps = json["tolerance_steps"].take().as_u64().expect("a count");
        (steps, json)
    };
    let (at_6, at_2, at_9) = (run("2", "1e-6"), run("2", "1e-2"), run("2", "1e-9"));
    assert_eq!(at_6.0, 0);
    assert_eq!(at_6, at_2, "the same bits");
    assert!(at_9.0 > 0 && at_9.1 != at_6.1);
    let text = |tolerance: &str| {
        stdout(&mrbd(
            folder.path(),
            &["simulate", "wall.toml", "--record", RECORD, "--scale", "2", "--tolerance", tolerance],
        ))
    };
    let said = "tolerance   shortened no step";
    assert!(text("1e-6").contains(said) && !text("1e-9").contains(said));
}

#[test]
fn regress_a_folder_with_blanks_is_quoted_where_it_is_to_be_copied() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let output = mrbd(folder.path(), &["init", "né w d"]);
    let message = String::from_utf8_lossy(&output.stderr);
    let enter = message.lines().find(|line| line.trim().starts_with("cd ")).expect("how to go on");
    assert!(shell(folder.path(), enter.trim()).status.success(), "{enter}");
}
