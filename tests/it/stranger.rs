//! The tour of a stranger: the first steps and the commands of the README as they stand, and odd inputs.
//!
//! Odd inputs are what somebody gives to the program in the first hour. Each is refused or questioned with the place,
//! what was found and what is allowed, or taken, and the exit code says which.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::pipeline_cli::{mrbd, stdout};

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

/// What is done to the starter's files before a command.
enum Odd {
    /// Nothing.
    Nothing,
    /// A text in a file replaced by another.
    Change(&'static str, &'static str, &'static str),
    /// A file that was not there, or is written over.
    Write(&'static str, &'static [u8]),
}
use Odd::{Change, Nothing, Write};

/// A command, what is odd about it, its exit code, and parts of what it says.
type Row = (&'static str, Odd, i32, &'static [&'static str]);

const SIMULATE: &str = "simulate wall.toml --record records/generated_4_600ya.csv";

const WALLS: &[Row] = &[
    (
        SIMULATE,
        Change("wall.toml", "thickness_m = 0.291", "thickness_m = 291"),
        2,
        &["wall.toml: wall.thickness_m: found 291", "allowed: 0.05 to 5 m", "291 mm"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "mass_kg = 3614.0", "density_kg_m3 = 1.8"),
        2,
        &["wall.density_kg_m3: found 1.8", "1.8 t/m3"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "mass_kg = 3614.0", "mass_kg = 3.614"),
        2,
        &["wall.mass_kg: found 3.614", "3.614 t"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "37e3", "37"),
        0,
        &["note: wall.toml: diaphragm.stiffness_n_per_m", "37 kN/m"],
    ),
    (SIMULATE, Change("wall.toml", "37e3", "1e11"), 0, &["The model does not apply"]),
    (
        SIMULATE,
        Change("wall.toml", "0.291", "0,291"),
        2,
        &["wall.toml:6: found `0,291", "decimal comma", "allowed: a decimal point: 0.291"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "0.291", "\"thick\""),
        2,
        &["wall.toml:6: wall.thickness_m", "allowed: a number"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "thickness_m", "thikness_m"),
        2,
        &["thikness_m", "did you mean `thickness_m`?"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "crack_height_m = 2.191", "crack_height_m = 4.5"),
        2,
        &["crack_height_m: found 4.5", "below wall.height_m = 3.984"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "rotation_ratio = 2.0", "rotation_ratio = 1e6"),
        2,
        &["rotation_ratio: found 1000000", "a quarter turn"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "rotation_ratio = 2.0", "rotation_ratio = nan"),
        2,
        &["rotation_ratio: found NaN", "allowed: a finite number above 0"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "0.93, 1.03", "0.93"),
        2,
        &["restitution.coefficients: found invalid length 7", "length 8"],
    ),
    (
        SIMULATE,
        Change("wall.toml", "\"contact\"", "\"contakt\""),
        2,
        &["restitution.law: found unknown variant `contakt`", "`whole` or `contact`"],
    ),
    (SIMULATE, Write("wall.toml", b""), 2, &["wall.toml:1: found missing field `wall`"]),
    (
        SIMULATE,
        Write("wall.toml", b"\xff\xfe\x00wall"),
        2,
        &["wall.toml: found", "allowed: a readable text file in UTF-8"],
    ),
    ("simulate wall.toml", Nothing, 2, &["--record: found no record and a wall at rest"]),
    ("describe nowhere.toml", Nothing, 2, &["nowhere.toml: found No such file"]),
];

const RECORDS: &[Row] = &[
    (
        "simulate wall.toml --record r.csv",
        Write("r.csv", b"time_s;acceleration_m_s2\n0,00;0\n0,01;0,1\n"),
        2,
        &["r.csv:1: found `time_s;acceleration_m_s2`", "--columns 1,2", "--decimal-comma"],
    ),
    (
        "simulate wall.toml --record r.csv",
        Write("r.csv", b"0.00 0.1\n0.01 0.2\n0.02 0.1\n"),
        2,
        &["r.csv:1: found `0.00 0.1`", "--columns"],
    ),
    (
        "simulate wall.toml --record r.csv --columns 1,2 --unit m/s2",
        Write("r.csv", b"0.00 0.1\n0.01 0.2\n0.02 0.1\n"),
        0,
        &["The wall stood"],
    ),
    (
        "simulate wall.toml --record r.csv --columns Time,Acc --unit g --decimal-comma",
        Write("r.csv", b"Time;Acc\n0,00;0,1\n0,01;0,2\n0,02;0,1\n"),
        0,
        &["The wall stood"],
    ),
    (
        "simulate wall.toml --record r.csv --columns Time,Acc --unit g",
        Write("r.csv", b"\xff\xfeT\0i\0m\0e\0\t\0A\0c\0c\0\n\x000\0\t\x000\0\n\x001\0\t\x000\0\n\0"),
        0,
        &["The wall stood"],
    ),
    (
        "simulate wall.toml --record r.csv",
        Write("r.csv", b"time_s,acceleration_m_s2\n0,0.1\n0.01,nan\n0.02,1\n"),
        2,
        &["r.csv:3: found `nan`; allowed: a finite number"],
    ),
    (
        "simulate wall.toml --record r.csv",
        Write("r.csv", b"time_s,acceleration_m_s2\n0,0.1\n"),
        2,
        &["r.csv: found 1 samples; allowed: at least 2"],
    ),
    (
        "simulate wall.toml --record r.csv",
        Write("r.csv", b"time_s,acceleration_m_s2\n0,0.1\n0.01,0.2\n0.03,0.2\n"),
        2,
        &["r.csv:3: found time 0.01 s; allowed: equal steps"],
    ),
    (
        "simulate wall.toml --record r.csv",
        Write("r.csv", b"time_s,acceleration_m_s2\n0,0\n0.01,300\n0.02,0\n"),
        0,
        &["note: r.csv: a peak of 300 m/s2", "is the record in cm/s2?"],
    ),
    (
        "simulate wall.toml --record r.csv --dt -1",
        Write("r.csv", b"0.1\n0.2\n0.1\n"),
        2,
        &["r.csv: found a step of -1 s given for it; allowed: 1e-6 to 10 s"],
    ),
    (
        "simulate wall.toml --record r.csv --dt 0",
        Write("r.csv", b"0.1\n0.2\n0.1\n"),
        2,
        &["r.csv: found a step of 0 s", "allowed: 1e-6 to 10 s"],
    ),
    (
        "simulate wall.toml --record nowhere.csv",
        Nothing,
        2,
        &["nowhere.csv: found No such file", "allowed: a readable record file"],
    ),
    ("simulate wall.toml --record records", Nothing, 2, &["records: found Is a directory"]),
    ("records describe --json records/generated_4_600ya.csv", Nothing, 0, &["\"generated\": null"]),
    (
        "records convert records/generated_4_600ya.csv nowhere/r.csv",
        Nothing,
        2,
        &["OUT: found nowhere/r.csv", "a path that can be written"],
    ),
];

const OPTIONS: &[Row] = &[
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --scale nan",
        Nothing,
        2,
        &["--scale: found NaN; allowed: a finite number"],
    ),
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --tolerance 0.1",
        Nothing,
        2,
        &["--tolerance: found 0.1; allowed: 1e-13 to 1e-2"],
    ),
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --tolerance 1e-13 --alone",
        Nothing,
        0,
        &["The wall stood"],
    ),
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --tail -1",
        Nothing,
        2,
        &["--tail: found -1", "0 or more"],
    ),
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --plot run.gif",
        Nothing,
        2,
        &["run.gif: --plot: found extension \"gif\"; allowed: .svg, .png or .html"],
    ),
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --plot RUN.PNG --history RUN.CSV",
        Nothing,
        0,
        &["The wall stood"],
    ),
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --plot nowhere/run.svg",
        Nothing,
        2,
        &["the folder nowhere, which is not there"],
    ),
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --history nowhere/run.csv",
        Nothing,
        2,
        &["--history: found No such file", "a folder that can be written"],
    ),
    (
        "simulate wall.toml --record records/generated_4_600ya.csv --history wall.toml",
        Nothing,
        2,
        &["--history: found wall.toml, which is read"],
    ),
    ("init wall.toml", Nothing, 2, &["wall.toml"]),
    ("init /proc/nowhere", Nothing, 2, &["/proc/nowhere"]),
    (
        "margin wall.toml --suite records/suite.toml --from 3 --to 2",
        Nothing,
        2,
        &["--from: found from 3 to 2; allowed: finite numbers, 0 < from < to"],
    ),
    ("report nowhere", Nothing, 2, &["nowhere: found nothing there"]),
    ("report records", Nothing, 2, &["records: found no manifest.json"]),
    ("report --help", Nothing, 0, &["mrbd diagnose"]),
];

const STUDIES: &[Row] = &[
    (
        "run pipeline.toml --out out",
        Change("pipeline.toml", "[8.0, 12.0, 16.0, 20.0, 24.0]", "[-8.0]"),
        2,
        &["pipeline.toml: sweep.slenderness: found -8"],
    ),
    (
        "run pipeline.toml --out out",
        Change("pipeline.toml", "records/suite.toml", "records/nowhere.toml"),
        2,
        &["records/nowhere.toml: found No such file"],
    ),
    (
        "run pipeline.toml --out out",
        Change("pipeline.toml", "tolerance = 1e-6", "tolerance = 0.1"),
        2,
        &["assumptions.tolerance: found 0.1; allowed: 1e-13 to 1e-2"],
    ),
    (
        "run pipeline.toml --out out",
        Change("pipeline.toml", "\"contact\"\nset", "\"base\"\nset"),
        2,
        &["variants[1].name: found \"base\"; allowed: a name, each once"],
    ),
    ("run pipeline.toml --out out --threads 100000", Nothing, 2, &["--threads: found 100000; allowed: 1 to"]),
    ("run pipeline.toml --out out --shard 0/3", Nothing, 2, &["--shard: found 0/3"]),
    ("run pipeline.toml --out records", Nothing, 2, &["--out: found records, which holds other files"]),
    (
        "run pipeline.toml --out records --force",
        Nothing,
        2,
        &["--out: found records, which holds other files"],
    ),
    ("run pipeline.toml --out wall.toml", Nothing, 2, &["--out: found wall.toml, which cannot be written"]),
    ("run pipeline.toml", Nothing, 2, &["holds results of this plan already", "--resume", "--force"]),
    (
        "run pipeline.toml --resume",
        Change("pipeline.toml", "1800.0", "1700.0"),
        2,
        &["density_kg_m3: 1800.0, now 1700.0"],
    ),
    ("replay outputs/first 99999", Nothing, 2, &["RUN: found \"99999\"; allowed: a position from 0 to 839"]),
    ("aggregate outputs/first/manifest.json", Nothing, 2, &["Not a directory"]),
    ("aggregate nowhere", Nothing, 2, &["nowhere: found no results"]),
    (
        "check-tolerance outputs/first --tolerance 1e-14",
        Nothing,
        2,
        &["--tolerance: found 1e-14; allowed: 1e-13 or more"],
    ),
    (
        "check outputs/first --baseline b.csv --accept --because x",
        Nothing,
        2,
        &[
            "variants \"base\", \"contact\", none of which differs from the first by a tighter tolerance alone",
        ],
    ),
    ("status margin", Nothing, 2, &["the results of a margin", "from `mrbd run`"]),
    ("aggregate models", Nothing, 2, &["the results of a comparison of models"]),
    ("fragility models", Nothing, 2, &["the results of a comparison of models"]),
];

const TABLES: &[Row] = &[
    (
        "fragility t.csv --intensity im --outcome y --replicates 1",
        Write("t.csv", b"im,y\n1,0\n2,1\n3,0\n4,1\n"),
        2,
        &["--replicates: found 1; allowed: 0", "39 or more"],
    ),
    (
        "fragility t.csv --intensity im --outcome y",
        Write("t.csv", b"im;y\n0,5;1\n0,7;0\n"),
        2,
        &["t.csv:1: found columns parted by semicolons: `im;y`"],
    ),
    (
        "fragility t.csv --intensity im --outcome y",
        Write("t.csv", b"im,y\n\"0,5\",1\n\"0,7\",0\n"),
        2,
        &["t.csv:2: found im: \"0,5\"; allowed: a finite number with a decimal point: 0.5"],
    ),
    (
        "fragility t.csv --intensity ym --outcome y",
        Write("t.csv", b"im,y\n1,0\n2,1\n"),
        2,
        &["found no column \"ym\"; allowed: one of im, y"],
    ),
    (
        "fragility t.csv --intensity im --outcome y --method cloud",
        Write("t.csv", b"im,y\n1,0\n2,1\n"),
        2,
        &["found no --demand and no --limit"],
    ),
    (
        "fragility T.CSV --intensity im --outcome y --replicates 0",
        Write("T.CSV", b"im,y\n1,0\n2,1\n3,0\n4,1\n"),
        0,
        &["fragility"],
    ),
    ("fragility outputs/first", Nothing, 2, &["--outcome: found nothing; allowed: the column of outcomes"]),
    (
        "fragility outputs/first --intensity pgv_m_s --outcome outcome --replicates 100 --cluster record",
        Nothing,
        0,
        &["an end `?`", "`--replicates 0`"],
    ),
    (
        "calibrate experiment.toml --out c",
        Change("tests/weak.csv", "theta1_rad", "theta1_deg"),
        2,
        &["tests/weak.csv:1: found columns time_s, theta1_deg, theta2_rad", "did you mean \"theta1_deg\"?"],
    ),
];

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
