//! `mrbd report` and `mrbd simulate --plot` as files: what they hold, where their links lead, what they refuse.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::pipeline_cli::{mrbd, stdout, study};
use crate::pipeline_support::SMALL;

const TABLE_WALL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/inputs/walls/table_wall.toml");

/// A study that was run, and its page.
pub fn sweep_page() -> (tempfile::TempDir, PathBuf) {
    let folder = study(SMALL);
    stdout(&mrbd(folder.path(), &["run", "study.toml"]));
    let told = stdout(&mrbd(folder.path(), &["report", "outputs/small"]));
    let page = folder.path().join(told.trim());
    (folder, page)
}

/// The page of one run that rocks, and what `--json` says of the run.
pub fn run_page() -> (tempfile::TempDir, PathBuf, Value) {
    let folder = study(SMALL);
    let arguments =
        ["simulate", TABLE_WALL, "--record", "pulse_2.csv", "--scale", "0.6", "--json", "--plot", "run.html"];
    let json = serde_json::from_str(&stdout(&mrbd(folder.path(), &arguments))).expect("JSON");
    let page = folder.path().join("run.html");
    (folder, page, json)
}

/// What stands between two marks.
fn between<'a>(text: &'a str, from: &str, to: &str) -> &'a str {
    let rest = text.split_once(from).unwrap_or_else(|| panic!("no {from}")).1;
    rest.split_once(to).unwrap_or_else(|| panic!("no {to} after {from}")).0
}

fn from_address(href: &str) -> String {
    let text = href.replace("&#x2f;", "/");
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let [first, tail @ ..] = rest {
        match (first, tail) {
            (b'%', [a, b, more @ ..]) => {
                let pair = [*a, *b];
                let digits = std::str::from_utf8(&pair).expect("hexadecimal digits");
                bytes.push(u8::from_str_radix(digits, 16).expect("hexadecimal digits"));
                rest = more;
            }
            _ => {
                bytes.push(*first);
                rest = tail;
            }
        }
    }
    String::from_utf8(bytes).expect("UTF-8")
}

#[test]
fn regress_a_sweep_page_holds_figures_conclusions_and_where_they_come_from() {
    let (folder, path) = sweep_page();
    let page = fs::read_to_string(&path).expect("the page");
    // Fig. 12 has one floor here and Fig. 20 the other, two bodies each; Figs. 18 and 19 have both floors; Fig. 11 is one.
    assert_eq!(page.matches("<div class=\"panel\">").count(), 2 + 2 + 2 + 2 + 1);
    for part in [
        "Fig. 12",
        "Fig. 20",
        "Fig. 18",
        "Fig. 19",
        "Fig. 11",
        "give the site with --site",
        "generated, not measured",
        "slenderness h/b",
        "max |θ₁|/α₁",
    ] {
        assert!(page.contains(part), "{part}");
    }
    let manifest =
        fs::read_to_string(folder.path().join("outputs/small/manifest.json")).expect("the manifest");
    let manifest: Value = serde_json::from_str(&manifest).expect("JSON");
    assert!(page.contains(manifest["plan_sha256"].as_str().expect("a hash")));
    let finding = &mrbd::findings::FINDINGS[3];
    assert!(page.contains(finding.name), "{}", finding.name);
    assert!(!page.contains(&folder.path().display().to_string()), "no paths of this machine");
}

#[test]
fn regress_links_of_a_page_lead_to_files() {
    let (_folder, path) = sweep_page();
    let (anchors, files) = followed_links(&path);
    assert!(anchors >= 4 && files >= 6, "{anchors} anchors, {files} files");
}

/// Follows every link of a page; gives the numbers of those within the page and of those to files beside it.
pub fn followed_links(path: &Path) -> (usize, usize) {
    let page = fs::read_to_string(path).expect("the page");
    let beside = path.parent().expect("a folder");
    let links: Vec<String> = page
        .split("<a href=\"")
        .skip(1)
        .map(|rest| from_address(rest.split_once('"').expect("a quoted address").0))
        .collect();
    let (anchors, files): (Vec<_>, Vec<_>) = links.iter().partition(|link| link.starts_with('#'));
    for file in &files {
        assert!(beside.join(file).is_file(), "{file}");
    }
    for anchor in &anchors {
        assert!(page.contains(&format!("id=\"{}\"", &anchor[1..])), "{anchor}");
    }
    (anchors.len(), files.len())
}

#[test]
fn regress_equal_results_give_equal_pages() {
    let (folder, path) = sweep_page();
    let first = fs::read(&path).expect("the page");
    stdout(&mrbd(folder.path(), &["report", "outputs/small"]));
    assert!(first == fs::read(&path).expect("the page"), "the page changed");
}

#[test]
fn rejects_folders_without_results_and_damaged_ones() {
    let (folder, _) = sweep_page();
    fs::create_dir(folder.path().join("empty")).expect("made");
    let refused = |place: &str, told: &str| {
        let output = mrbd(folder.path(), &["report", place]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(told) && message.contains("allowed"), "{told} in {message}");
        assert!(output.stdout.is_empty());
    };
    refused("nowhere", "nothing there");
    refused("study.toml", "extension");
    refused("empty", "no manifest.json");
    let runs = folder.path().join("outputs/small/runs");
    let part = runs.join("record=pulse_1/part-1.parquet");
    let whole = fs::read(&part).expect("a part");
    fs::write(&part, &whole[..whole.len() / 2]).expect("damaged");
    refused("outputs/small", "found");
    fs::remove_dir_all(&runs).expect("removed");
    refused("outputs/small", "part-1.parquet");
    fs::write(folder.path().join("outputs/small/manifest.json"), "{}").expect("damaged");
    refused("outputs/small", "manifest.json");
}

#[test]
fn analytic_a_run_page_holds_the_run() {
    let (_folder, path, json) = run_page();
    let page = fs::read_to_string(path).expect("the page");
    let data: Value =
        serde_json::from_str(between(&page, "class=\"motion-data\">", "</script>")).expect("JSON");
    let impacts = data["impacts"].as_array().expect("impacts");
    assert_eq!(impacts.len() as u64, json["impacts"].as_u64().expect("a count"));
    assert!(impacts.len() > 5, "the record must rock the wall");
    for (name, key) in [("theta1", "theta1_max_rad"), ("theta2", "theta2_max_rad")] {
        let largest =
            data[name].as_array().expect("samples").iter().filter_map(Value::as_i64).map(i64::abs).max();
        let largest = largest.expect("samples") as f64 / 1e6;
        let truth = json[key].as_f64().expect("a number");
        // Samples miss the top of a swing by the square of a step's share of it; 1e-6 is half the last digit told.
        assert!(largest <= truth + 1e-6 && largest > 0.99 * truth, "{name}: {largest} against {truth}");
    }
    assert_eq!(page.matches("data-from=").count(), 1, "a short run is shown once");
}

#[test]
fn analytic_every_impact_is_seen_under_long_shaking() {
    let folder = study(SMALL);
    let samples = (0..3000).map(|k| {
        let t = 0.005 * f64::from(k);
        format!("{t:.3},{:.5}\n", 1.4 * (9.0 * t).sin() + 1.2 * (23.0 * t).sin() + 0.8 * (3.0 * t).sin())
    });
    let record = format!("time_s,acceleration_m_s2\n{}", samples.collect::<String>());
    fs::write(folder.path().join("long.csv"), record).expect("written");
    let arguments = ["simulate", TABLE_WALL, "--record", "long.csv", "--json", "--plot", "run.html"];
    let json: Value = serde_json::from_str(&stdout(&mrbd(folder.path(), &arguments))).expect("JSON");
    let page = fs::read_to_string(folder.path().join("run.html")).expect("the page");
    let data: Value =
        serde_json::from_str(between(&page, "class=\"motion-data\">", "</script>")).expect("JSON");
    let seen = data["impacts"].as_array().expect("impacts").len() as u64;
    assert!(seen > 50 && seen == json["impacts"].as_u64().expect("a count"), "{seen} of {}", json["impacts"]);
}

#[test]
fn regress_a_plot_alone_is_an_svg_and_does_not_change_the_run() {
    let folder = study(SMALL);
    let simulate = |more: &[&str]| {
        let mut arguments = vec!["simulate", TABLE_WALL, "--record", "pulse_2.csv", "--json"];
        arguments.extend(more);
        stdout(&mrbd(folder.path(), &arguments))
    };
    assert_eq!(simulate(&[]), simulate(&["--plot", "run.svg"]));
    let svg = fs::read_to_string(folder.path().join("run.svg")).expect("the picture");
    assert!(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\"") && svg.ends_with("</svg>\n"));
    for part in ["time s", "ground m/s²", "rotation θᵢ/αᵢ", "pattern", "impacts"] {
        assert!(svg.contains(part), "{part}");
    }
}

#[test]
fn rejects_pictures_before_running() {
    let folder = study(SMALL);
    for (picture, told) in [("run.gif", ".svg, .png or .html"), ("no/folder/run.svg", "not there")] {
        let arguments = ["simulate", TABLE_WALL, "--record", "pulse_2.csv", "--plot", picture];
        let output = mrbd(folder.path(), &arguments);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains("--plot") && message.contains(told), "{message}");
        assert!(output.stdout.is_empty() && !Path::new(&folder.path().join(picture)).exists());
    }
}
