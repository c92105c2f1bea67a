//! The pages of results other than a sweep's: calibration, comparison of models, overturning spectrum, history; PNG.

use std::fs;
use std::path::{Path, PathBuf};

use crate::calibrate_cli::quick;
use crate::pipeline_cli::{mrbd, stdout, study};
use crate::pipeline_support::SMALL;
use crate::report_pages::followed_links;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The page of results in a folder.
fn report(folder: &Path, results: &str) -> PathBuf {
    folder.join(stdout(&mrbd(folder, &["report", results])).trim())
}

fn panels(page: &str) -> usize {
    page.matches("<div class=\"panel\">").count()
}

pub fn calibration_page() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    quick().write(folder.path());
    stdout(&mrbd(folder.path(), &["calibrate", "experiment.toml", "--out", "out"]));
    let page = report(folder.path(), "out");
    (folder, page)
}

pub fn comparison_page() -> (tempfile::TempDir, PathBuf) {
    let folder = study(SMALL);
    let pipeline = format!(
        "name = \"models\"\nwall = \"{ROOT}/inputs/walls/table_wall.toml\"\ncoefficients = \"coefficients.toml\"\n\
         suite = \"suite.toml\"\n[comparison]\nscales = [0.5, 1.0, 3.0]\nlaws = [\"whole\", \"contact\"]\n\
         tail_s = 2.0\ntolerance = 1e-6\n"
    );
    fs::write(folder.path().join("models.toml"), pipeline).expect("written");
    stdout(&mrbd(folder.path(), &["run", "models.toml"]));
    let page = report(folder.path(), "outputs/models");
    (folder, page)
}

pub fn overturning_page() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let shipped =
        fs::read_to_string(Path::new(ROOT).join("pipelines/overturning_spectrum.toml")).expect("shipped");
    let study = shipped
        .replace("../inputs", &format!("{ROOT}/inputs"))
        .replace("from = 1.0, to = 8.0, count = 29", "from = 4.0, to = 7.0, count = 3")
        .replace("from = 0.5, to = 10.0, count = 39", "from = 1.0, to = 7.0, count = 4");
    fs::write(folder.path().join("spectrum.toml"), study).expect("written");
    stdout(&mrbd(folder.path(), &["run", "spectrum.toml", "--out", "spectrum"]));
    let page = report(folder.path(), "spectrum");
    (folder, page)
}

pub fn history_page(extension: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = study(SMALL);
    let wall = format!("{ROOT}/inputs/walls/table_wall.toml");
    let history = format!("run.{extension}");
    stdout(&mrbd(folder.path(), &["simulate", &wall, "--record", "pulse_2.csv", "--history", &history]));
    let page = report(folder.path(), &history);
    (folder, page)
}

/// The page of a study of façades drawn from the survey, `tables` telling its kind.
pub fn drawn_page(tables: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = study(SMALL);
    let pipeline = format!(
        "name = \"drawn\"\nsurvey = \"survey.toml\"\ncoefficients = \"coefficients.toml\"\nsuite = \"suite.toml\"\n\
         {tables}\n[sampling]\ncount = 12\n[[variants]]\nname = \"base\"\n[[variants]]\nname = \"contact\"\nset = {{ law = \"contact\" }}\n"
    );
    fs::write(folder.path().join("drawn.toml"), pipeline).expect("written");
    stdout(&mrbd(folder.path(), &["run", "drawn.toml"]));
    let page = report(folder.path(), "outputs/drawn");
    (folder, page)
}

pub const STRIPES: &str = "kind = \"stripes\"\n[stripes]\nmeasure = \"pgv_m_s\"\nlevels = [0.1, 0.4, 1.6]";

#[test]
fn analytic_the_page_of_stripes_has_their_shares_and_the_draws() {
    let (folder, path) = drawn_page(STRIPES);
    let page = fs::read_to_string(&path).expect("the page");
    for part in
        ["generated, not measured", "probability", "pgv_m_s", "collapse", "|θᵢ|/αᵢ &gt; 0.05", "12 façades"]
    {
        assert!(page.contains(part), "{part}");
    }
    // Each floor: a point a stripe and limit, of 12 façades under 2 records.
    let points = page.matches(" of 24 near ").count();
    assert_eq!(points, 2 * 2 * 3, "two floors, two limits, three stripes");
    // Fragility and spectra; quantiles along the intensity, and of two of three stripes by record;
    // draws of the variables that vary, m_dp/m_tot under one floor.
    assert_eq!(panels(&page), 2 + 1 + 2 + 2 * 2 + (6 + 7));
    assert!(followed_links(&path).1 >= 10);
    let survey = folder.path().join("survey.toml");
    let text = fs::read_to_string(&survey).expect("the survey");
    fs::write(&survey, text + "\n# another one\n").expect("written");
    let page = fs::read_to_string(report(folder.path(), "outputs/drawn")).expect("the page");
    assert!(page.contains("or is another one now: its distributions cannot be drawn"));
}

#[test]
fn regress_pages_of_every_kind_of_drawn_study() {
    let incremental = "kind = \"incremental\"\nconfigurations = [\"parallel\"]\n[incremental]\nlimits = [\"collapse\", 0.1]\n\
                       measure = \"pga_g\"\nfrom = 0.2\nto = 4.0\ngrowth = 1.5\nbracket = 1.2";
    let cloud = "kind = \"cloud\"\n[cloud]\nfrom = 0.2\nto = 3.0";
    for (tables, title) in [
        ("kind = \"monte_carlo\"", "Monte Carlo study “drawn”"),
        (cloud, "Cloud of runs “drawn”"),
        (incremental, "Incremental analyses “drawn”"),
    ] {
        let (_folder, path) = drawn_page(tables);
        let page = fs::read_to_string(&path).expect("the page");
        assert!(page.contains(title) && !page.contains("NaN"), "{title}");
        assert!(followed_links(&path).1 >= 8, "{title}");
    }
}

#[test]
fn regress_a_calibration_page_draws_its_tests_again_while_they_are_the_same() {
    let (folder, path) = calibration_page();
    let page = fs::read_to_string(&path).expect("the page");
    for part in ["Figs. 7 and 8", "Fig. 6", "95 % interval", "never acts, left at 1", "capture velocity 1e-3"]
    {
        assert!(page.contains(part), "{part}");
    }
    // So few vectors leave the searches apart: nothing is told, and the page says so.
    assert!(page.contains("not identified: the searches disagree") && !page.contains("told by the tests"));
    // Two tests of two bodies, the values, a panel a test and one for all.
    assert_eq!(panels(&page), 2 * 2 + 1 + 3);
    assert!(followed_links(&path).1 >= 8);
    let measured = folder.path().join("measured_0.csv");
    let text = fs::read_to_string(&measured).expect("measured");
    fs::write(&measured, text + "1000.0,0,0\n").expect("written");
    let page = fs::read_to_string(report(folder.path(), "out")).expect("the page");
    assert!(page.contains("are other ones now") && !page.contains("Figs. 7 and 8"));
}

#[test]
fn regress_a_comparison_page_has_a_panel_a_record_and_the_claims() {
    let (_folder, path) = comparison_page();
    let page = fs::read_to_string(&path).expect("the page");
    // Two laws: two records, and one of them in time at the lowest and the highest factor, two bodies.
    assert_eq!(panels(&page), 2 * (2 + 2 * 2));
    for part in [
        "Fig. 9",
        "In time, under pulse_",
        "lumped",
        "generated, not measured",
        "the calibrated model rotates least of the three",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(followed_links(&path).1 >= 5);
}

#[test]
fn analytic_an_overturning_page_counts_what_the_table_holds() {
    let (_folder, path) = overturning_page();
    let page = fs::read_to_string(&path).expect("the page");
    assert!(page.contains("<b>12</b> pulses") && page.contains("one_sine"), "3 frequencies × 4 amplitudes");
    // Every pulse and every boundary tells its values under the pointer.
    let overturned: usize = page.matches("\noverturned</title>").count();
    let stood = page.matches("\nstood</title>").count();
    assert!(overturned > 0 && stood > 0 && overturned + stood == 12, "{overturned} and {stood}");
    assert!(page.contains(&format!("<b>{overturned}</b> overturned the wall")));
    // Assumptions are told in words, not as the program keeps them.
    assert!(page.contains("narrowed to") && page.contains("m thick") && !page.contains("Study {"));
    assert!(page.contains("boundary at") && followed_links(&path).1 >= 4);
}

#[test]
fn analytic_a_history_gives_the_same_page_from_csv_and_parquet() {
    let ((_first, csv), (_second, parquet)) = (history_page("csv"), history_page("parquet"));
    let [csv, parquet] = [csv, parquet].map(|path| fs::read_to_string(path).expect("the page"));
    assert!(csv.contains("mrad</b> largest |θ₁|") && panels(&csv) == 2);
    assert!(csv.replace("run.csv", "run.parquet") == parquet);
}

#[test]
fn rejects_files_that_are_no_history() {
    let folder = study(SMALL);
    let refused = |name: &str, text: &str, told: &str| {
        fs::write(folder.path().join(name), text).expect("written");
        let output = mrbd(folder.path(), &["report", name]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(told), "{told} in {message}");
    };
    refused("a.csv", "time_s,acceleration_m_s2\n0,1\n", "no column");
    refused("b.csv", "time_s,theta1_rad,theta2_rad,pattern\n0,0,0,5c\n", "5c");
    refused("c.parquet", "no parquet", "c.parquet");
}

#[test]
fn regress_a_plot_can_be_a_png_with_text() {
    let folder = study(SMALL);
    let wall = format!("{ROOT}/inputs/walls/table_wall.toml");
    stdout(&mrbd(folder.path(), &["simulate", &wall, "--record", "pulse_2.csv", "--plot", "run.png"]));
    let bytes = fs::read(folder.path().join("run.png")).expect("the picture");
    assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n") && bytes.ends_with(b"IEND\xaeB`\x82"));
    let data = bytes.windows(4).position(|four| four == b"IDAT").expect("data") + 4;
    let mut rows = Vec::new();
    let mut reader = flate2::read::ZlibDecoder::new(&bytes[data..]);
    std::io::Read::read_to_end(&mut reader, &mut rows).expect("zlib");
    let row = 1 + 3 * 2400;
    assert_eq!(rows.len(), 1400 * row);
    // The strip of the legend holds words: ink between the colours of curves, on the first 72 lines.
    let ink =
        rows.chunks(row).take(72).flat_map(|row| row[1..].chunks(3)).filter(|p| p.iter().all(|c| *c < 0x60));
    assert!(ink.count() > 500, "there is text");
}
