//! The generated suites of the repository: what they must hold, and that the seed gives them again.

use std::path::{Path, PathBuf};

use mrbd_records::{
    COMPATIBLE_DEVIATION, COMPATIBLE_PERIODS_S, Motion, RecordTable, Site, Suite, SuiteCheck, generate,
    write_suite,
};

/// The default of `mrbd records generate --seed`, by which the suites were made.
const SEED: u64 = 20_120_529;

fn input(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("inputs").join(name)
}

fn site() -> Site {
    Site::load(&input("site_mirandola.toml")).expect("valid")
}

fn suites() -> [(&'static str, RecordTable, Option<Site>); 2] {
    let table = |name: &str| RecordTable::load(&input(name)).expect("valid");
    [("emilia7", table("table4.toml"), Some(site())), ("mirandola2012", table("mirandola_2012.toml"), None)]
}

#[test]
fn regress_the_seed_gives_the_suites_again_to_the_bit() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, table, site) in suites() {
        let made = folder.path().join(name);
        let records = generate(&table, site.as_ref(), SEED);
        write_suite(&made, name, &table, &records, SEED).expect("writable");
        for entry in std::fs::read_dir(&made).expect("readable") {
            let made = entry.expect("readable").path();
            let kept = input("records").join(name).join(made.file_name().expect("a name"));
            assert!(std::fs::read(&made).ok() == std::fs::read(&kept).ok(), "{} differs", kept.display());
        }
    }
}

#[test]
fn published_peaks_of_the_tables_are_those_of_the_generated_records() {
    for (name, table, _) in suites() {
        let suite = Suite::load(&input("records").join(name).join("suite.toml")).expect("valid");
        assert!(suite.generated && suite.records.iter().all(|r| r.generated));
        assert_eq!(suite.records.len(), table.records.len());
        for (record, row) in suite.records.iter().zip(&table.records) {
            let (pga_g, pgv_m_s) = (row.pga_g * row.scale, row.pgv_m_s * row.scale);
            let found = record.intensity;
            println!(
                "{name} {}: {:.4} of {pga_g:.4} g, {:.4} of {pgv_m_s:.4} m/s",
                row.id, found.pga_g, found.pgv_m_s
            );
            // What is promised of them.
            assert!((found.pga_g / pga_g - 1.0).abs() < 0.02, "{}", record.name);
            assert!((found.pgv_m_s / pgv_m_s - 1.0).abs() < 0.05, "{}", record.name);
        }
    }
}

#[test]
fn analytic_generated_records_last_a_sensible_time_and_end_where_they_began() {
    for (name, table, _) in suites() {
        let suite = Suite::load(&input("records").join(name).join("suite.toml")).expect("valid");
        for (record, row) in suite.records.iter().zip(&table.records) {
            // Trifunac and Brady 1975 scatter by some 50 % about their mean.
            let expected_s = -4.88 + 2.33 * row.magnitude + 0.149 * row.distance_km;
            let ratio = record.intensity.duration_5_95_s / expected_s;
            assert!((0.67..1.5).contains(&ratio), "{name} {}: {ratio}", row.id);
            let motion = Motion::of(&record.horizontal);
            let ends =
                [motion.velocity_m_s.last(), motion.displacement_m.last()].map(|v| *v.expect("samples"));
            // Exact in decimals; sums of some thousand doubles round.
            assert!(ends[0].abs() < 1e-13 && ends[1].abs() < 1e-12, "{name} {}: {ends:?}", row.id);
            assert!(motion.peak_displacement_m() < 0.3, "{name} {} drifts", row.id);
        }
    }
}

#[test]
fn published_mean_spectrum_of_the_generated_suite_follows_the_code() {
    let suite = Suite::load(&input("records/emilia7/suite.toml")).expect("valid");
    let check = SuiteCheck::of(&suite, &site(), COMPATIBLE_PERIODS_S);
    println!("emilia7: {:+.4} {:+.4}", check.lowest_deviation, check.highest_deviation);
    assert!(check.is_within(COMPATIBLE_DEVIATION), "{} {}", check.lowest_deviation, check.highest_deviation);
}

#[test]
fn analytic_a_record_depends_on_seed_and_number_alone() {
    let [(_, table, _), _] = suites();
    let part = RecordTable { source: table.source.clone(), records: table.records[2..4].to_vec() };
    let (all, some) = (generate(&table, None, 7), generate(&part, None, 7));
    assert!(all[2..4] == some[..], "records change with their company");
    assert!(generate(&part, None, 8)[0] != some[0], "the seed changes nothing");
}
