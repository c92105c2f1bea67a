//! `mrbd assess` and `mrbd risk`: keys that scripts read, closed forms, pages in two languages, what is refused.

use std::path::Path;

use serde_json::Value;

use crate::pipeline_cli::{mrbd, stdout};

const BLOCK: &str = "[wall]\nthickness_m = 0.4\nheight_m = 3.2\nlength_m = 1.0\ndensity_kg_m3 = 1800.0\n";
const SITE: &str = "name = \"a site\"\nsource = \"made up\"\n[site]\nag_g = 0.2\nf0 = 2.5\ntc_star_s = 0.3\nsoil = \"A\"\n\
    [sources]\nsoil = \"a borehole\"\n";
const FLOOR: &str = "[building]\nheight_ratio = 0.67\nperiod_s = 0.3\nstoreys = 3\n";
const SUITE: &str = "name = \"pulses\"\ngenerated = true\n\
    [[records]]\nid = 1\nname = \"weak\"\nevent = \"\"\nscale = 1.0\nstep_s = 0.005\n\
    pulse = { kind = \"one_sine\", amplitude_m_s2 = 1.6, period_s = 0.8 }\n\
    [[records]]\nid = 2\nname = \"weaker\"\nevent = \"\"\nscale = 1.0\nstep_s = 0.005\n\
    pulse = { kind = \"one_sine\", amplitude_m_s2 = 1.4, period_s = 0.6 }\n";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let cracked = BLOCK.replace("length_m", "crack_height_m = 1.6\nlength_m");
    let spring =
        |stiffness: &str| format!("{cracked}[diaphragm]\nmass_kg = 0.0\nstiffness_n_per_m = {stiffness}\n");
    for (name, text) in [
        ("wall.toml", BLOCK.to_owned()),
        ("held.toml", spring("1e9")),
        ("soft.toml", spring("3e4")),
        ("uncracked.toml", format!("{BLOCK}[diaphragm]\nmass_kg = 0.0\nstiffness_n_per_m = 1e9\n")),
        ("site.toml", SITE.to_owned()),
        ("floor.toml", format!("{SITE}{FLOOR}")),
        ("suite.toml", SUITE.to_owned()),
    ] {
        std::fs::write(folder.path().join(name), text).expect("written");
    }
    folder
}

fn json(folder: &Path, arguments: &[&str]) -> Value {
    serde_json::from_str(&stdout(&mrbd(folder, arguments))).expect("JSON")
}

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or_else(|| panic!("{key} in {value}"))
}

#[test]
fn analytic_a_free_block_and_a_held_wall_have_their_closed_forms_under_the_keys_of_scripts() {
    let folder = folder();
    let block = json(folder.path(), &["assess", "wall.toml", "--site", "site.toml", "--json"]);
    assert_eq!(block["mechanism"], "one_block");
    // b/h and 3/4; a_0 = α_0 g/(e* FC) with limited knowledge; on rock and rigid a_g,SLD is a_0. Roundings.
    assert!(
        (number(&block, "alpha_0") - 0.125).abs() < 1e-12 && (number(&block, "e_star") - 0.75).abs() < 1e-12
    );
    let a_0 = 0.125 * 9.81 / (0.75 * 1.35);
    assert!(
        (number(&block, "a_0_m_s2") - a_0).abs() < 1e-12
            && (number(&block, "ag_sld_m_s2") - a_0).abs() < 1e-9
    );
    assert!((number(&block["linear"], "ag_slv_m_s2") - 2.0 * a_0).abs() < 1e-9);
    let d_0 = number(&block, "d_0_m");
    assert!(
        (number(&block, "d_slv_m") / d_0 - 0.4).abs() < 1e-12
            && (number(&block, "d_slc_m") / d_0 - 0.6).abs() < 1e-12
    );
    for key in ["t_slv_s", "t_slc_s", "ag_slv_m_s2", "zeta"] {
        assert!(number(&block, key) > 0.0, "{key}");
    }
    assert!(block["dynamic"].is_null());
    let held = json(folder.path(), &["assess", "held.toml", "--site", "site.toml", "--json"]);
    assert_eq!(held["mechanism"], "vertical_bending");
    assert!((number(&held, "alpha_0") - 0.5).abs() < 1e-12 && (number(&held, "e_star") - 0.75).abs() < 1e-12);
}

#[test]
fn analytic_a_floor_asks_more_and_its_ground_is_the_ground() {
    let folder = folder();
    let ground = json(folder.path(), &["assess", "wall.toml", "--site", "site.toml", "--json"]);
    let floor = json(folder.path(), &["assess", "wall.toml", "--site", "floor.toml", "--json"]);
    assert_eq!((&ground["place"], &floor["place"]), (&"ground".into(), &"floor".into()));
    assert!(number(&floor, "zeta") < number(&ground, "zeta"), "{floor}");
    assert_eq!(floor["at_ground"]["zeta"], ground["zeta"]);
}

#[test]
fn regress_dynamics_stand_beside_the_check_on_a_page_in_two_languages() {
    let folder = folder();
    let run = ["assess", "wall.toml", "--site", "site.toml", "--records", "suite.toml"];
    let found = json(folder.path(), &[&run[..], &["--out", "en", "--json"]].concat());
    let dynamic = &found["dynamic"];
    assert_eq!((&dynamic["runs"], &dynamic["beyond_d_0"]), (&2.into(), &0.into()));
    assert!(number(dynamic, "mean_largest_m") > 0.0 && dynamic["accepted_slv"] == true);
    // What the run of one record says: the largest displacement of the top, two thirds of which is d.
    let records = dynamic["records"].as_array().expect("records");
    let mean: f64 = records.iter().map(|run| number(run, "largest_d_m")).sum::<f64>() / 2.0;
    assert!((mean - number(dynamic, "mean_largest_m")).abs() < 1e-15);
    stdout(&mrbd(folder.path(), &[&run[..], &["--out", "it", "--language", "it"]].concat()));
    let page =
        |name: &str| std::fs::read_to_string(folder.path().join(name).join("report.html")).expect("a page");
    let (english, italian) = (page("en"), page("it"));
    assert!(english.contains("<html lang=\"en\">") && english.contains("Not checked:"));
    assert!(english.contains("a borehole") && english.contains("made up") && english.contains("C8.7.1.12"));
    assert!(
        italian.contains("<html lang=\"it\">")
            && italian.contains("Non verificati")
            && italian.contains("ribaltamento")
    );
    assert!(
        [&english, &italian].iter().all(|page| !page.contains("NaN") && page.matches("<figure").count() == 4)
    );
    for name in ["assessment.json", "manifest.json", "governing_run.csv"] {
        assert!(folder.path().join("en").join(name).is_file(), "{name}");
    }
    // The page can be made again from the folder alone.
    stdout(&mrbd(folder.path(), &["report", "it"]));
    assert_eq!(page("it"), italian);
}

#[test]
fn regress_two_walls_are_compared() {
    let folder = folder();
    let run = ["assess", "soft.toml", "--site", "site.toml", "--compare", "held.toml"];
    let found = json(folder.path(), &[&run[..], &["--json"]].concat());
    assert_eq!(
        (&found["mechanism"], &found["compared"]["mechanism"]),
        (&"restrained".into(), &"vertical_bending".into())
    );
    // A stiffer floor bears more. Not so ζ: at 0.4 d_0 the wall on a soft floor is at the crest of its capacity, a stiff
    // one at 0.6 of it.
    assert!(number(&found, "alpha_0") < number(&found["compared"], "alpha_0"));
    let table = stdout(&mrbd(folder.path(), &run));
    assert!(table.contains("soft.toml") && table.contains("held.toml") && table.contains("vertical bending"));
}

#[test]
fn rejects_sites_and_walls_that_cannot_be_assessed() {
    let folder = folder();
    for (name, text) in [
        ("knowledge.toml", format!("{SITE}[assessment]\nconfidence_factor = 1.1\n")),
        ("storeys.toml", format!("{SITE}[building]\nheight_ratio = 0.5\nperiod_s = 0.3\nstoreys = 0\n")),
        ("key.toml", SITE.replace("ag_g", "agg_g")),
    ] {
        std::fs::write(folder.path().join(name), text).expect("written");
    }
    for (wall, site, told) in [
        (
            "wall.toml",
            "knowledge.toml",
            &["knowledge.toml", "assessment.confidence_factor", "found 1.1", "1.20"][..],
        ),
        ("wall.toml", "storeys.toml", &["building.storeys", "found 0"]),
        ("wall.toml", "key.toml", &["agg_g", "did you mean `ag_g`"]),
        ("uncracked.toml", "site.toml", &["uncracked.toml", "wall.crack_height_m", "without a crack"]),
    ] {
        let output = mrbd(folder.path(), &["assess", wall, "--site", site]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(told.iter().all(|part| message.contains(part)), "{told:?} in: {message}");
    }
}

/// λ = 1e-3 (s/0.1)^-2 at some intensities, and a fragility of median 0.3 and dispersion 0.4 in PGA.
fn hazard_and_fragility(folder: &Path) {
    let rate = |s: f64| 1e-3 * (s / 0.1_f64).powi(-2);
    let rows: String =
        (0..40).map(|i| 0.003 * 1.25f64.powi(i)).map(|s| format!("{s},{}\n", rate(s))).collect();
    std::fs::write(folder.join("hazard.csv"), format!("pga_g,annual_rate\n{rows}")).expect("written");
    let (median, beta) = (0.3_f64, 0.4_f64);
    let mean = median * (0.5 * beta * beta).exp();
    let stddev = mean * (beta * beta).exp_m1().sqrt();
    let xml = format!(
        "<?xml version=\"1.0\"?>\n<nrml xmlns=\"http://openquake.org/xmlns/nrml/0.5\"><fragilityModel>\
         <limitStates>collapse</limitStates><fragilityFunction id=\"wall\" format=\"continuous\" shape=\"logncdf\">\
         <imls imt=\"PGA\" noDamageLimit=\"0\" minIML=\"0\" maxIML=\"5\"/>\
         <params ls=\"collapse\" mean=\"{mean}\" stddev=\"{stddev}\"/></fragilityFunction></fragilityModel></nrml>\n"
    );
    std::fs::write(folder.join("fragility.xml"), xml).expect("written");
}

#[test]
fn analytic_the_risk_of_a_power_law_has_its_closed_form() {
    let folder = folder();
    hazard_and_fragility(folder.path());
    let found = json(folder.path(), &["risk", "fragility.xml", "--hazard", "hazard.csv", "--json"]);
    let state = &found["limit_states"][0];
    // k_0 θ^-k exp(k²β²/2), k = 2; the curve ends at 18 g, nothing of the fragility lies beyond.
    let closed = 1e-3 * 9.0_f64.recip() * (0.5 * 4.0 * 0.16_f64).exp();
    assert!((number(state, "annual_rate") / closed - 1.0).abs() < 1e-9, "{found}");
    assert!((number(state, "return_period_years") * closed - 1.0).abs() < 1e-9);
    assert!(state["annual_rate_interval"].is_null());
}

#[test]
fn analytic_a_hazard_in_nrml_and_in_probabilities_is_the_same() {
    let folder = folder();
    hazard_and_fragility(folder.path());
    let csv = std::fs::read_to_string(folder.path().join("hazard.csv")).expect("a curve");
    let pairs: Vec<(f64, f64)> = csv
        .lines()
        .skip(1)
        .map(|line| line.split_once(',').expect("two"))
        .map(|(s, rate)| {
            (s.parse().expect("a number"), -(-50.0 * rate.parse::<f64>().expect("a number")).exp_m1())
        })
        .collect();
    let list = |of: fn(&(f64, f64)) -> f64| {
        pairs.iter().map(|p| format!("{:e}", of(p))).collect::<Vec<_>>().join(" ")
    };
    let xml = format!(
        "<nrml xmlns:gml=\"http://www.opengis.net/gml\" xmlns=\"http://openquake.org/xmlns/nrml/0.5\">\
         <hazardCurves investigationTime=\"50.0\" IMT=\"PGA\" statistics=\"mean\"><IMLs>{}</IMLs><hazardCurve>\
         <gml:Point><gml:pos>11.0 44.9</gml:pos></gml:Point><poEs>{}</poEs></hazardCurve></hazardCurves></nrml>",
        list(|p| p.0),
        list(|p| p.1)
    );
    std::fs::write(folder.path().join("hazard.xml"), xml).expect("written");
    let rows: String = pairs.iter().map(|(s, poe)| format!("{s},{poe:e}\n")).collect();
    std::fs::write(folder.path().join("poe.csv"), format!("pga_g,poe\n{rows}")).expect("written");
    let rate = |hazard: &[&str]| {
        let found = json(folder.path(), &[&["risk", "fragility.xml", "--json", "--hazard"], hazard].concat());
        number(&found["limit_states"][0], "annual_rate")
    };
    let [rates, nrml, poe] =
        [rate(&["hazard.csv"]), rate(&["hazard.xml"]), rate(&["poe.csv", "--years", "50"])];
    // Probabilities near 1 keep few digits of a rate; those intensities lie far below the fragility.
    assert!((nrml / rates - 1.0).abs() < 1e-9 && (poe / rates - 1.0).abs() < 1e-9, "{rates} {nrml} {poe}");
}

#[test]
fn rejects_hazards_and_fragilities_that_are_none() {
    let folder = folder();
    hazard_and_fragility(folder.path());
    for (name, text) in [
        ("rising.csv", "pga_g,annual_rate\n0.1,0.01\n0.2,0.02\n"),
        ("other.csv", "pgv_m_s,annual_rate\n0.1,0.01\n0.2,0.005\n"),
        ("columns.csv", "pga_g,rate\n0.1,0.01\n"),
        ("word.csv", "pga_g,annual_rate\n0.1,often\n"),
        ("broken.xml", "<nrml><hazardCurves>"),
        ("broken.json", "{\"groups\": "),
    ] {
        std::fs::write(folder.path().join(name), text).expect("written");
    }
    for (fragility, hazard, told) in [
        ("fragility.xml", "rising.csv", &["rising.csv", "point 2", "falling rates"][..]),
        ("fragility.xml", "other.csv", &["fragility.xml", "fragilities in pga_g", "pgv_m_s"]),
        ("fragility.xml", "columns.csv", &["columns.csv", "the columns pga_g, rate", "annual_rate"]),
        ("fragility.xml", "word.csv", &["word.csv:2", "\"often\"", "0 or more"]),
        ("fragility.xml", "broken.xml", &["broken.xml:1", "NRML"]),
        ("broken.json", "hazard.csv", &["broken.json:1", "margin.json"]),
    ] {
        let output = mrbd(folder.path(), &["risk", fragility, "--hazard", hazard]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(told.iter().all(|part| message.contains(part)), "{told:?} in: {message}");
    }
}
