//! Studies of variance: what a run takes from its point, the same bits in parts, shares and their page, and what is refused.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::campaign::contents;
use crate::drawn_support::{drawn, monte_carlo};
use crate::pipeline_cli::{mrbd, stdout, study};

const TABLE: &str = "[variance]\nlaws = [\"whole\", \"contact\"]\nlength_m = [1.0, 4.0]\ndensity_kg_m3 = [1600.0, 2000.0]\n\
                     beds = [{ stiffness_pa_per_m = 1e13 }, { stiffness_pa_per_m = 1e8, damping_s = 4e-3 }]\nfactor = 1.5\n";

/// Six points in 19 matrices, both configurations and under two pulses.
fn variance() -> String {
    drawn("variance", TABLE).replacen("name = \"base\"", "name = \"base\"\nmembers = 2", 1)
}

/// The same on sharp edges, which takes no time.
pub fn sharp() -> String {
    let from = TABLE.find("beds").expect("beds");
    let to = TABLE.find("factor").expect("a factor");
    let sharp = format!("{}beds = [{{ stiffness_pa_per_m = 1e13 }}]\n{}", &TABLE[..from], &TABLE[to..]);
    variance().replacen(TABLE, &sharp, 1)
}

fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = mrbd(folder, arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Columns that an input of a run decides, by the matrix that takes it from B; those of the wall follow from several.
const OF_INPUT: [(&str, &[&str]); 12] = [
    ("thickness_m", &["thickness_m"]),
    ("slenderness", &["slenderness"]),
    ("crack_height_ratio", &["crack_height_ratio"]),
    ("compressive_strength_pa", &["compressive_strength_pa"]),
    ("stiffness_n_per_m", &["stiffness_n_per_m"]),
    ("diaphragm_mass_ratio", &["diaphragm_mass_ratio"]),
    ("carriage_mass_ratio", &["carriage_mass_ratio"]),
    ("law", &["law"]),
    ("length_m", &["length_m"]),
    ("density_kg_m3", &["density_kg_m3"]),
    ("bed", &["effects"]),
    ("chaos", &["variant", "member"]),
];

/// What each group is made of; the coefficients are eight columns of one input.
fn parts(matrix: &str) -> Vec<&str> {
    let facade = ["thickness_m", "slenderness", "crack_height_ratio", "compressive_strength_pa"];
    let floor = ["stiffness_n_per_m", "diaphragm_mass_ratio", "carriage_mass_ratio"];
    match matrix {
        "a" => vec![],
        "b" => OF_INPUT.iter().map(|(name, _)| *name).chain(["coefficients"]).collect(),
        "facade" => [&facade[..], &floor].concat(),
        "wall" => facade.to_vec(),
        "floor" => floor.to_vec(),
        "assumptions" => vec!["law", "length_m", "density_kg_m3", "bed"],
        other => vec![other],
    }
}

#[test]
fn analytic_each_matrix_takes_its_inputs_from_b_and_all_others_from_a() {
    let folder = study(&variance());
    let plan = stdout(&mrbd(folder.path(), &["run", "study.toml", "--dry-run"]));
    let mut csv = csv::Reader::from_reader(plan.as_bytes());
    let rows: Vec<BTreeMap<String, String>> = csv.deserialize().map(|row| row.expect("a row")).collect();
    assert_eq!(rows.len(), 6 * 19 * 2 * 2);
    let ids: BTreeSet<&String> = rows.iter().map(|row| &row["id"]).collect();
    assert_eq!(ids.len(), rows.len(), "every run has an id of its own");
    let of = |row: &BTreeMap<String, String>, matrix: &str| -> usize {
        let same = |other: &&BTreeMap<String, String>| {
            ["draw", "record", "configuration"].iter().all(|key| other[*key] == row[*key])
                && other["matrix"] == matrix
        };
        rows.iter().position(|other| same(&other)).expect("a run")
    };
    for row in &rows {
        let (a, b) = (&rows[of(row, "a")], &rows[of(row, "b")]);
        let taken = parts(&row["matrix"]);
        let check = |input: &str, column: &str| {
            let expected = if taken.contains(&input) { b } else { a };
            // A façade that is no wall has no effects to tell of.
            let is_told = column != "effects" || !(row[column].is_empty() || expected[column].is_empty());
            assert!(!is_told || row[column] == expected[column], "{column} in matrix {}", row["matrix"]);
        };
        OF_INPUT.iter().for_each(|(input, columns)| columns.iter().for_each(|column| check(input, column)));
        (1..=8).for_each(|l| check("coefficients", &format!("restitution_c{l}")));
        assert_eq!(row["factor"], "1.5");
        assert!(row["variant"] == "base" || row["member_of"] == "base", "{row:?}");
    }
    // Levels and members are all met.
    let values = |column: &str| rows.iter().map(|row| row[column].as_str()).collect::<BTreeSet<_>>();
    assert_eq!(values("law"), ["contact", "whole"].into());
    assert_eq!(values("variant"), ["base", "base ~1", "base ~2"].into());
    assert!(
        values("effects").contains("[]") && values("effects").iter().any(|text| text.contains("compliant"))
    );
    let numbers = |column: &str| {
        rows.iter().map(|row| row[column].parse::<f64>().expect("a number")).collect::<Vec<_>>()
    };
    assert!(numbers("length_m").iter().all(|x| (1.0..=4.0).contains(x)));
    assert!(numbers("restitution_c6").iter().all(|x| (0.7..=0.8).contains(x)));
}

#[test]
fn regress_a_study_of_variance_in_parts_has_the_bits_of_one_process_and_its_shares() {
    let folder = study(&sharp());
    let at = folder.path();
    let told = stdout(&mrbd(at, &["run", "study.toml", "--out", "whole", "--threads", "1"]));
    assert!(told.contains("perpendicular floor: 6 points") && told.contains("chaos"), "{told}");
    for shard in ["2/2", "1/2"] {
        stdout(&mrbd(at, &["run", "study.toml", "--out", "parts", "--block-runs", "512", "--shard", shard]));
    }
    assert_eq!(stdout(&mrbd(at, &["merge", "parts"])), told);
    assert_eq!(contents(&at.join("parts")), contents(&at.join("whole")));
    let json = stdout(&mrbd(at, &["variance", "whole", "--out", "shares", "--json"]));
    let shares: Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(shares["runs"].as_u64(), Some(6 * 18 * 2 * 2));
    let outputs = shares["floors"][0]["outputs"].as_array().expect("a list");
    let names: Vec<&str> =
        outputs[0]["shares"].as_array().expect("a list").iter().filter_map(|s| s["input"].as_str()).collect();
    assert_eq!(names[..5], ["record", "facade", "coefficients", "assumptions", "chaos"]);
    assert!(!names.contains(&"bed"), "nothing is asked of what does not vary");
    let page = fs::read_to_string(at.join("shares/report.html")).expect("a page");
    assert!(page.contains("share of the variance") && page.contains("façade, all of it"));
    let csv = fs::read_to_string(at.join("shares/indices.csv")).expect("a table");
    assert_eq!(csv, stdout(&mrbd(at, &["variance", "whole", "--csv"])));
    assert_eq!(csv.lines().filter(|line| line.starts_with("parallel,theta1_rank,")).count(), 17);
    assert!(at.join("shares/indices.parquet").is_file() && at.join("whole/indices.parquet").is_file());
}

#[test]
fn rejects_what_is_no_whole_study_of_variance_and_commands_for_other_studies() {
    let folder = study(&sharp());
    let at = folder.path();
    stdout(&mrbd(at, &["run", "study.toml", "--out", "whole"]));
    assert!(refused(at, &["measures", "whole"]).contains("monte_carlo, cloud or stripes"));
    assert!(refused(at, &["fragility", "whole", "--intensity", "pgv_m_s"]).contains("--outcome"));
    assert!(refused(at, &["report", "whole"]).contains("mrbd variance DIR --out"));
    assert!(refused(at, &["check", "whole", "--baseline", "b.csv"]).contains("a study of variance"));
    fs::remove_dir_all(at.join("whole/runs/record=pulse_1")).expect("removed");
    let told = refused(at, &["variance", "whole"]);
    assert!(told.contains("unfinished") || told.contains("damaged, or gone"), "{told}");
    let other = study(&monte_carlo());
    stdout(&mrbd(other.path(), &["run", "study.toml", "--out", "b"]));
    assert!(refused(other.path(), &["variance", "b"]).contains("no manifest of such a study"));
    assert!(refused(other.path(), &["variance", "nowhere"]).contains("no manifest of such a study"));
}

#[test]
fn rejects_tables_of_variance_under_their_keys() {
    let refused = |from: &str, to: &str| {
        let text = variance();
        assert!(text.contains(from), "{from}");
        let folder = study(&text.replacen(from, to, 1));
        refused(folder.path(), &["run", "study.toml", "--dry-run"])
    };
    assert!(
        refused("members = 2", "members = 0").contains("variants[0].members: found 0; allowed: 1 to 100")
    );
    assert!(refused("[variance]", "[[variants]]\nname = \"b\"\n[variance]").contains("variants: found 2"));
    assert!(
        refused("seed = 3", "rank_correlation = [[\"thickness_m\", \"slenderness\", 0.5]]")
            .contains("sampling.rank_correlation: found 1 pairs")
    );
    assert!(refused("[\"whole\", \"contact\"]", "[]").contains("variance.laws: found []"));
    assert!(refused("[\"whole\", \"contact\"]", "[\"whole\", \"whole\"]").contains("each once"));
    assert!(refused("[1.0, 4.0]", "[4.0, 1.0]").contains("variance.length_m: found 4 to 1"));
    assert!(refused("1600.0", "-1.0").contains("variance.density_kg_m3: found -1 to 2000"));
    assert!(refused("1e8", "1e3").contains("variance.beds: found 1000"));
    assert!(refused("factor = 1.5", "factor = 0.0").contains("variance.factor: found 0"));
    assert!(refused("latin_hypercube", "sobel").contains("sampling"));
    assert!(refused("kind = \"variance\"", "kind = \"monte_carlo\"").contains("variance"));
}
