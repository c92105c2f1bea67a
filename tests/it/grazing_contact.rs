//! Runs in which a joint opens so slowly that its first gap is smaller than the roundings of the rotations.
//!
//! Each once ended as failed: the gap's roundings were taken for a closing, and the impact, between bodies that turned
//! at the same speed, had no outcome that was admissible by more than roundings.

use std::path::Path;

use mrbd_kernel::model::{ImpactLaw, Restitution, Wall, WallParameters};
use mrbd_kernel::simulate::{Accuracy, Outcome, Shaking, simulate};
use mrbd_records::Suite;

use crate::walls::{made, table_wall};

struct Case {
    thickness_m: f64,
    height_m: f64,
    crack_height_m: f64,
    length_m: f64,
    mass_kg: f64,
    widths_m: [f64; 2],
    top_masses_kg: [f64; 2],
    stiffness_n_per_m: f64,
    capture_velocity_rad_s: f64,
    record: usize,
}

fn wall(case: &Case) -> Wall {
    // The coefficients of Table 2 under `whole`, as on the table wall.
    let table_wall = table_wall(ImpactLaw::Whole);
    let capture_velocity_rad_s = case.capture_velocity_rad_s;
    made(&WallParameters {
        thickness_m: case.thickness_m,
        height_m: case.height_m,
        crack_height_m: Some(case.crack_height_m),
        length_m: case.length_m,
        mass_kg: case.mass_kg,
        lower_width_m: case.widths_m[0],
        upper_width_m: case.widths_m[1],
        diaphragm_mass_kg: case.top_masses_kg[0],
        carriage_mass_kg: case.top_masses_kg[1],
        stiffness_n_per_m: case.stiffness_n_per_m,
        restitution: Restitution { capture_velocity_rad_s, ..table_wall.restitution },
        ..table_wall
    })
}

fn stands(case: &Case) {
    let suite = Path::new(env!("CARGO_MANIFEST_DIR")).join("inputs/records/emilia7/suite.toml");
    let suite = Suite::load(&suite).expect("the generated suite");
    let horizontal = Some(suite.records[case.record].horizontal.clone());
    let shaking = Shaking { horizontal, vertical: None, tail_s: 5.0 };
    let response = simulate(&wall(case), &shaking, Accuracy::default());
    assert_eq!(response.outcome, Outcome::Stood);
    assert!(response.impacts.total() > 100, "the run must rock through its impacts");
}

#[test]
fn regress_crack_opening_at_the_end_of_a_sample() {
    stands(&Case {
        thickness_m: 0.5,
        height_m: 8.0,
        crack_height_m: 4.96,
        length_m: 1.0,
        mass_kg: 7200.0,
        widths_m: [0.47504349058638645, 0.489976769358765],
        top_masses_kg: [260.24096385542174, 1214.4578313253014],
        stiffness_n_per_m: 4_000_000.0,
        capture_velocity_rad_s: 1e-3,
        record: 6,
    });
}

#[test]
fn regress_crack_opening_in_a_thick_wall() {
    stands(&Case {
        thickness_m: 0.7,
        height_m: 7.0,
        crack_height_m: 4.34,
        length_m: 2.0,
        mass_kg: 17640.0,
        widths_m: [0.6694282759683233, 0.687721542464487],
        top_masses_kg: [637.5903614457832, 2975.4216867469886],
        stiffness_n_per_m: 1_200_000.0,
        capture_velocity_rad_s: 1e-3,
        record: 5,
    });
}

#[test]
fn regress_crack_opening_in_a_slender_wall() {
    stands(&Case {
        thickness_m: 0.7,
        height_m: 15.399999999999999,
        crack_height_m: 9.547999999999998,
        length_m: 1.0,
        mass_kg: 19404.0,
        widths_m: [0.6327422071303115, 0.6729873934218715],
        top_masses_kg: [701.3493975903615, 3272.963855421687],
        stiffness_n_per_m: 1_200_000.0,
        capture_velocity_rad_s: 1e-4,
        record: 6,
    });
}
