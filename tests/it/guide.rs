//! The guide under `docs/`: its commands run, its table of columns is the schema's, its links lead somewhere.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use mrbd::store::{Column, Stage};
use mrbd::study::runs::COLUMNS;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn text(name: &str) -> String {
    fs::read_to_string(Path::new(ROOT).join(name)).expect("a file of the repository")
}

/// The blocks of shell commands of a page, in order.
fn shell_blocks(page: &str) -> Vec<&str> {
    page.split("\n```sh\n").skip(1).filter_map(|rest| Some(rest.split_once("\n```")?.0)).collect()
}

#[test]
fn regress_the_commands_of_the_guide_run_as_they_stand() {
    run_as_they_stand("docs/commands.md", 15);
}

#[test]
fn regress_the_commands_of_the_calibration_run_as_they_stand() {
    run_as_they_stand("docs/calibration.md", 3);
}

#[test]
fn regress_the_commands_of_the_laboratory_run_as_they_stand() {
    run_as_they_stand("docs/laboratory.md", 4);
}

#[test]
fn regress_the_commands_of_the_assessment_run_as_they_stand() {
    run_as_they_stand("docs/assessment.md", 3);
}

/// Runs the blocks of a page one after another, more than `least` of them.
fn run_as_they_stand(page: &str, least: usize) {
    let page = text(page);
    let blocks = shell_blocks(&page);
    assert!(blocks.len() > least, "{} blocks", blocks.len());
    let folder = tempfile::tempdir().expect("a temporary folder");
    let program = Path::new(env!("CARGO_BIN_EXE_mrbd")).parent().expect("a folder");
    let path = format!("{}:{}", program.display(), std::env::var("PATH").expect("a path"));
    let run = |script: &str| {
        let script = format!("{script}\npwd > \"$HERE\"\n");
        let here = folder.path().join(".here");
        let place = fs::read_to_string(&here).map_or(folder.path().into(), |at| PathBuf::from(at.trim()));
        let mut shell = Command::new("bash");
        shell.args(["-eu", "-o", "pipefail", "-c", &script]).current_dir(place);
        shell.env("PATH", &path).env("HERE", &here).output().expect("bash starts")
    };
    let mut told = String::new();
    for block in blocks {
        let output = run(block);
        assert!(output.status.success(), "{block}\n{}", String::from_utf8_lossy(&output.stderr));
        told += &String::from_utf8_lossy(&output.stdout);
    }
    // What the guide shows of the answers is what they are.
    let shown: Vec<&str> =
        page.split("\n```text\n").skip(1).filter_map(|rest| rest.split_once("\n```")).map(|x| x.0).collect();
    assert!(!shown.is_empty() && shown.iter().all(|part| told.contains(part)), "{shown:?} in {told}");
}

/// The table of columns as the guide shows it.
fn columns_page() -> String {
    let row = |c: &Column<_>| {
        let unit = if c.unit.is_empty() { "–" } else { c.unit };
        format!("| `{}` | {unit} | {} |\n", c.name, c.meaning.replace('|', "\\|"))
    };
    let table = |stage: Stage| -> String {
        let head = "| column | unit | meaning |\n| --- | --- | --- |\n".to_owned();
        head + &COLUMNS.iter().filter(|c| c.stage == stage).map(row).collect::<String>()
    };
    format!(
        "# Columns\n\n\
         One row a run, in `runs/record=*/part-*.parquet` of a study's folder. Unit and meaning stand in the files too, in the \
         metadata of each field. A value that does not exist is null. This page is made from the program's own table by \
         `UPDATE_GUIDE=1 cargo test --release --locked --test it guide`.\n\n\
         PyArrow takes the names of folders for a column: `pyarrow.dataset.dataset(folder, partitioning=None)` reads the files' own \
         `record` (with `partitioning=\"hive\"` the two types differ, and it refuses). Counts are unsigned: make them signed before \
         subtracting.\n\n\
         ## Known before the run\n\n{}\n## Results\n\n{}",
        table(Stage::Input),
        table(Stage::Result)
    )
}

#[test]
fn regress_the_guide_has_every_column() {
    let made = columns_page();
    let path = Path::new(ROOT).join("docs/columns.md");
    if std::env::var_os("UPDATE_GUIDE").is_some() {
        fs::write(&path, &made).expect("written");
    }
    let same = fs::read_to_string(&path).is_ok_and(|page| page == made);
    assert!(
        same,
        "docs/columns.md is behind the schema: UPDATE_GUIDE=1 cargo test --release --locked --test it guide"
    );
}

/// A heading as the anchor that a link names.
fn anchor(heading: &str) -> String {
    let kept = heading.trim_start_matches('#').trim().to_lowercase();
    kept.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c)).collect::<String>().replace(' ', "-")
}

#[test]
fn regress_links_of_readme_and_guide_lead_somewhere() {
    let mut pages = vec!["README.md".to_owned()];
    for entry in fs::read_dir(Path::new(ROOT).join("docs")).expect("the guide") {
        let name = entry.expect("an entry").file_name().to_string_lossy().into_owned();
        pages.extend(name.ends_with(".md").then(|| format!("docs/{name}")));
    }
    let mut followed = 0;
    for page in &pages {
        let folder = Path::new(ROOT).join(page).parent().expect("a folder").to_path_buf();
        let source = text(page);
        for link in source.split("](").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0)) {
            if link.starts_with("http") {
                continue;
            }
            let (file, place) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { Path::new(ROOT).join(page) } else { folder.join(file) };
            assert!(target.exists(), "{link} of {page}");
            if !place.is_empty() {
                let target = fs::read_to_string(&target).expect("a page");
                let headings = target.lines().filter(|line| line.starts_with('#'));
                assert!(headings.map(anchor).any(|a| a == place), "{link} of {page}");
            }
            followed += 1;
        }
    }
    assert!(followed > 8, "{followed} links");
}
