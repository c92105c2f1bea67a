//! Suites: loading, and what is refused.

use std::path::PathBuf;

use mrbd_records::Suite;

use crate::shared;

/// Held until the test ends: dropping it deletes the folder.
struct Folder {
    _dir: tempfile::TempDir,
}

impl Folder {
    /// A suite `suite.toml` of `text` beside `a.csv` (peak 2 m/s²) and `b.acc` (one column, the same).
    fn with(text: &str) -> (Self, PathBuf) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let write =
            |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("writable");
        write("a.csv", "time_s,acceleration_m_s2\n0.00,0\n0.01,1\n0.02,-2\n0.03,0\n");
        write("b.acc", "0\n1\n-2\n0\n");
        write("nan.acc", "0\n1\nNaN\n0\n");
        write("suite.toml", text);
        let path = folder.path().join("suite.toml");
        (Self { _dir: folder }, path)
    }
}

fn refusal(text: &str) -> String {
    let (_folder, path) = Folder::with(text);
    let error = Suite::load(&path).expect_err("must be refused");
    assert_eq!(error.exit_code(), 2, "{error}");
    error.to_string()
}

#[test]
fn analytic_a_suite_scales_horizontal_and_vertical_together_or_apart() {
    let text = "name = \"pair\"\nstep_s = 0.01\n\
        [[records]]\nid = 3\nfile = \"a.csv\"\nvertical = \"b.acc\"\nscale = 0.5\n\
        [[records]]\nid = 1\nname = \"second\"\nfile = \"b.acc\"\nvertical = \"a.csv\"\nscale = 2.0\nvertical_scale = 1.5\n\
        generated = true\nevent = \"none\"\nmagnitude = 6.0\n";
    let (_folder, path) = Folder::with(text);
    let suite = Suite::load(&path).expect("valid");
    assert_eq!((suite.name.as_str(), suite.generated, suite.records.len()), ("pair", false, 2));
    let [first, second] = &suite.records[..] else { panic!("two records") };
    assert_eq!((first.id, first.name.as_str(), first.scale, first.generated), (3, "a", 0.5, false));
    assert_eq!(first.horizontal.acceleration_m_s2(), [0.0, 0.5, -1.0, 0.0]);
    assert_eq!(first.vertical.as_ref().expect("vertical").acceleration_m_s2(), [0.0, 0.5, -1.0, 0.0]);
    assert_eq!(first.intensity.pga_m_s2, 1.0);
    assert_eq!((second.name.as_str(), second.generated, second.about.magnitude), ("second", true, Some(6.0)));
    assert_eq!(second.horizontal.acceleration_m_s2(), [0.0, 2.0, -4.0, 0.0]);
    assert_eq!(second.vertical.as_ref().expect("vertical").acceleration_m_s2(), [0.0, 1.5, -3.0, 0.0]);
}

#[test]
fn analytic_a_pulse_stands_in_a_suite_by_its_name() {
    let text = "name = \"pulses\"\nstep_s = 0.01\n\
        [[records]]\nid = 1\nscale = 2.0\npulse = { kind = \"one_sine\", amplitude_m_s2 = 1.5, period_s = 1.0 }\n\
        [[records]]\nid = 2\nname = \"near\"\npulse = { kind = \"mavroeidis_papageorgiou\", velocity_m_s = 0.5, \
        period_s = 1.4, oscillations = 2.0 }\n";
    let (_folder, path) = Folder::with(text);
    let suite = Suite::load(&path).expect("valid");
    assert!(suite.generated);
    assert_eq!((suite.records[0].horizontal.step_s(), suite.records[0].name.as_str()), (0.01, "pulse 1"));
    assert_eq!(suite.records[0].horizontal.peak_m_s2(), 3.0);
    // Trapezia of 140 a period err by (2π/140)²/12 = 1.7e-4.
    assert!((suite.records[1].intensity.pgv_m_s - 0.5).abs() < 2e-4 && suite.records[1].name == "near");
}

#[test]
fn rejects_suites_that_do_not_hold_together() {
    let suite = |top: &str, record: &str| format!("name = \"x\"\n{top}\n[[records]]\nid = 1\n{record}\n");
    for (text, parts) in [
        (suite("", "file = \"c.csv\""), &["records[0].file", "c.csv", "relative"][..]),
        (suite("", "file = \"b.acc\""), &["b.acc", "no step", "step_s"]),
        (suite("step_s = 0.02", "file = \"a.csv\""), &["a.csv", "0.01 s", "0.02 s"]),
        (suite("step_s = 0.01", "file = \"nan.acc\""), &["nan.acc:3", "`NaN`"]),
        (suite("", "file = \"a.csv\"\npga_g = 0.21"), &["records[0].pga_g", "0.21", "0.2039"]),
        (suite("", "file = \"a.csv\"\npgv_m_s = 1.0"), &["records[0].pgv_m_s", "within 5 %"]),
        (suite("", "file = \"a.csv\"\nscale = nan"), &["records[0].scale", "NaN"]),
        (suite("", "file = \"a.csv\"\nscale = 0"), &["records[0].scale"]),
        (suite("", "file = \"a.csv\"\ncolour = 1"), &["colour", "suite.toml:6"]),
        (suite("unit = \"furlong\"", "file = \"a.csv\""), &["suite.toml:2", "furlong", "\"cm/s2\""]),
        (suite("unit = \"g\"", "file = \"a.csv\""), &["unit m/s2", "unit g"]),
        (suite("", ""), &["records[0].file"]),
        (suite("", "pulse = { kind = \"bump\" }"), &["suite.toml:5", "bump", "one_sine"]),
        (
            suite("", "pulse = { kind = \"ricker\", amplitude_m_s2 = 1.0, period_s = -1.0 }"),
            &["records[0].pulse.period_s", "-1"],
        ),
        (
            suite(
                "",
                "file = \"a.csv\"\npulse = { kind = \"ricker\", amplitude_m_s2 = 1.0, period_s = 1.0 }",
            ),
            &["records[0].pulse", "one of them"],
        ),
        (suite("", "file = \"a.csv\"\n[[records]]\nid = 1\nfile = \"a.csv\""), &["records[1].id", "1 again"]),
        (suite("step_s = 0.01", "file = \"a.csv\"\nvertical = \"d.csv\""), &["records[0].vertical", "d.csv"]),
        ("name = \"x\"\nrecords = []\n".into(), &["records", "at least one"]),
        ("records = []\n".into(), &["missing field `name`"]),
    ] {
        let message = refusal(&text);
        assert!(parts.iter().all(|part| message.contains(part)), "{parts:?} in: {message}");
    }
}

#[test]
fn verified_the_natural_suite_loads_with_its_peaks() {
    let Some(folder) = shared::folder("records/natural7") else { return };
    let suite = Suite::load(&folder.join("suite.toml")).expect("valid");
    assert_eq!((suite.name.as_str(), suite.generated, suite.records.len()), ("natural7", false, 7));
    // The suite file states four digits of each unscaled peak, for a g that it does not state: 9.81 or 9.80665 m/s².
    for (record, pga_g) in suite.records.iter().zip([0.3456, 0.1752, 0.3457, 0.3459, 0.3348, 0.2929, 0.4150])
    {
        let unscaled = record.intensity.pga_g / record.scale;
        assert!((unscaled / pga_g - 1.0).abs() < 1e-3, "{}: {unscaled}", record.name);
    }
}
