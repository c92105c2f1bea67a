//! The plan of the sweep: its size, its ids, and the walls its façades become.

use std::collections::BTreeSet;
use std::path::Path;

use mrbd::study::pipeline::{Parameter, Pipeline};
use mrbd::study::plan::{Level, Plan};
use mrbd::survey::Configuration;
use mrbd::survey::Facade;
use mrbd_files::load_wall;
use mrbd_kernel::model::Restitution;
use mrbd_kernel::simulate::{simulate, simulate_members};

use crate::pipeline_support::{SMALL, SWEEP, plan, suite, try_plan};
use crate::shared;

fn ids(plan: &Plan) -> Vec<String> {
    (0..plan.len()).map(|i| plan.run(i).id).collect()
}

#[test]
fn published_sweep_has_189_runs_per_reference_case() {
    let plan = plan(SWEEP, 7);
    let runs: Vec<_> = (0..plan.len()).map(|i| plan.run(i)).collect();
    let of_case = |configuration: Configuration, parameter: Parameter| {
        let base = runs.iter().filter(|run| run.variant.name == "base");
        base.filter(|run| (run.configuration, run.parameter()) == (configuration, Some(parameter))).count()
    };
    for configuration in Configuration::ALL {
        let cases = Parameter::ALL.map(|parameter| of_case(configuration, parameter));
        // Section 4.2: 3 levels × 9 slendernesses × 7 records; the floor mass is m_d or m_dp.
        assert_eq!(cases.iter().filter(|&&count| count == 189).count(), 6, "{cases:?}");
        assert_eq!(cases.iter().sum::<usize>(), 6 * 189);
    }
    assert_eq!(plan.len(), 16 * 2268, "six variants and ten members of the first one's ensemble");
}

#[test]
fn regress_a_member_is_that_of_the_ensemble_of_a_run() {
    let text = SMALL.replacen("name = \"base\"", "name = \"base\"\nmembers = 4", 1);
    let plan = plan(&text, 1);
    let of_variant = |variant: &str| {
        let mut runs = (0..plan.len()).map(|i| plan.run(i)).filter(|run| run.variant.name == variant);
        runs.next().expect("a run")
    };
    let base = of_variant("base");
    let (wall, shaking) = (base.wall.clone().expect("a wall"), base.shaking());
    let ensemble = simulate_members(&wall, &shaking, base.accuracy(), 0..5);
    for (number, expected) in ensemble.iter().enumerate().skip(1) {
        let member = of_variant(&format!("base ~{number}"));
        assert_eq!(member.wall.as_ref().ok(), Some(&wall));
        assert_eq!(simulate(&wall, &member.shaking(), member.accuracy()), *expected, "member {number}");
        assert_ne!(member.id, base.id);
    }
    assert_eq!(plan.len(), 36 + 4 * 18);
}

#[test]
fn rejects_ensembles_of_drawn_facades() {
    let text = include_str!("../../pipelines/monte_carlo.toml");
    let text = text.replacen("name = \"base\"", "name = \"base\"\nmembers = 2", 1);
    let refused = Pipeline::parse(Path::new("study.toml"), text).expect_err("members of draws").to_string();
    assert!(
        refused.contains("variants.members: found those of \"base\" in a study of kind \"monte_carlo\""),
        "{refused}"
    );
}

#[test]
fn published_levels_are_those_of_table_3() {
    let plan = plan(SWEEP, 1);
    let mut crack = BTreeSet::new();
    for i in 0..plan.len() {
        let run = plan.run(i);
        let is_crack = run.parameter() == Some(Parameter::CrackHeight);
        let level = run.level().expect("a sweep has levels");
        let at_mean = !is_crack || level == Level::Mean;
        assert!(!at_mean || run.facade.crack_height_ratio == 0.62, "one parameter at a time");
        if is_crack {
            crack.insert((level, run.facade.crack_height_ratio.to_bits()));
        }
    }
    let levels = [(Level::Low, 0.73), (Level::Mean, 0.62), (Level::High, 0.52)];
    assert_eq!(crack, levels.map(|(level, value): (Level, f64)| (level, value.to_bits())).into());
}

#[test]
fn regress_ids_are_unique_and_do_not_depend_on_the_order_of_the_plan() {
    let forward = ids(&plan(SMALL, 3));
    let set: BTreeSet<_> = forward.iter().cloned().collect();
    assert_eq!(set.len(), forward.len());
    let swapped = SMALL.replace("10.0, 14.0, 18.0", "10.0, 14.0, 18.0, 20.0");
    let longer = ids(&plan(&swapped, 3));
    assert_ne!(forward, longer[..forward.len()], "positions move");
    assert!(set.is_subset(&longer.into_iter().collect()), "ids stay");
}

#[test]
fn regress_ids_are_those_of_earlier_versions() {
    // An id that changes cuts users' results off from their plans: change it only with the schema version.
    assert_eq!(ids(&plan(SMALL, 1))[..2], ["6a5179caaf0f4f2b", "bf8279d92e8f7d6c"]);
}

#[test]
fn regress_ids_and_plan_change_with_every_input() {
    let base = plan(SMALL, 1);
    let plan_hash = Plan::sha256;
    for (from, to) in [
        ("name = \"base\"", "name = \"base\"\nset = { length_m = 2.0 }"),
        ("name = \"base\"", "name = \"base\"\nset = { tail_s = 6.0 }"),
        ("name = \"base\"", "name = \"base\"\nset = { tolerance = 1e-7 }"),
        ("name = \"base\"", "name = \"base\"\nset = { capture_velocity_rad_s = 1e-4 }"),
        ("name = \"base\"", "name = \"base\"\nset = { collapse_rotation_ratio = 3.0 }"),
        ("name = \"base\"", "name = \"base\"\nset = { bed = { stiffness_pa_per_m = 1e9 } }"),
    ] {
        let changed = plan(&SMALL.replacen(from, to, 1), 1);
        assert_ne!(ids(&changed)[0], ids(&base)[0], "{to}");
        assert_ne!(plan_hash(&changed), plan_hash(&base), "{to}");
    }
    let mut other = suite(1);
    other.records[0].horizontal = other.records[0].horizontal.scaled(1.5);
    let changed = try_plan(SMALL, other).expect("a valid plan");
    assert_ne!(ids(&changed)[0], ids(&base)[0], "samples");
    assert_ne!(plan_hash(&plan(SMALL, 2)), plan_hash(&base), "another record");
}

#[test]
fn regress_a_bed_lies_in_both_joints_of_every_wall_of_its_variant() {
    let soft = "name = \"base\"\nset = { bed = { stiffness_pa_per_m = 1e9, damping_s = 1e-2 } }";
    let plan = plan(&SMALL.replacen("name = \"base\"", soft, 1), 1);
    for position in 0..plan.len() {
        let run = plan.run(position);
        let effects = &run.wall.as_ref().expect("a wall").parameters().effects;
        let told =
            effects.iter().map(|effect| (effect.variant().name(), effect.parameters())).collect::<Vec<_>>();
        let bed = ("compliant_joint.both".to_owned(), vec![1e9, 1e-2]);
        assert_eq!(told, if run.variant.name == "base" { vec![bed] } else { Vec::new() });
    }
}

#[test]
fn rejects_beds_that_are_none() {
    let refused = |bed: &str| {
        let set = format!("name = \"base\"\nset = {{ bed = {bed} }}");
        let text = SMALL.replacen("name = \"base\"", &set, 1);
        Pipeline::parse(Path::new("study.toml"), text).expect_err(bed).to_string()
    };
    assert!(refused("{ stiffness_pa_per_m = 0.0 }").contains("variants[0].set.bed"));
    assert!(refused("{ stiffness_pa_per_m = 1e9, damping_s = -1.0 }").contains("variants[0].set.bed"));
    assert!(refused("{ stiffness = 1e9 }").contains("stiffness"));
}

#[test]
fn rejects_plans_that_cannot_be_run_with_the_place() {
    let refused = |text: &str, suite| try_plan(text, suite).expect_err("must be refused");
    let heavy = SMALL
        .replace("name = \"contact\"", "name = \"heavy\"")
        .replace("law = \"contact\"", "density_kg_m3 = 9e4");
    let error = refused(&heavy, suite(1));
    assert_eq!(error.exit_code(), 2);
    let message = error.to_string();
    assert!(
        message.contains("study.toml: sweep: found variant \"heavy\", perpendicular floor, thickness"),
        "{message}"
    );
    assert!(message.contains("crushes"), "{message}");
    assert!(refused(SMALL, suite(0)).to_string().contains("no records"));
    let mut twins = suite(2);
    twins.records[1].name = twins.records[0].name.clone();
    assert!(refused(SMALL, twins).to_string().contains("two records named"));
    let vertical = SMALL.replace("law = \"contact\"", "vertical = true");
    assert!(refused(&vertical, suite(1)).to_string().contains("without a vertical component"));
}

/// What tells the reference's façades apart.
struct Ratios {
    slenderness: f64,
    diaphragm: f64,
    carriage: f64,
    stiffness: f64,
}

#[test]
fn verified_facades_become_the_walls_of_the_reference() {
    let Some(folder) = shared::folder("verification") else { return };
    let cases = [
        (
            "facade_perpendicular",
            Ratios { slenderness: 18.0, diaphragm: 0.09, carriage: 0.0, stiffness: 1.4e6 },
        ),
        ("facade_parallel", Ratios { slenderness: 16.0, diaphragm: 0.03, carriage: 0.14, stiffness: 1.2e6 }),
        ("facade_contact_law", Ratios { slenderness: 12.0, diaphragm: 0.02, carriage: 0.06, stiffness: 5e5 }),
    ];
    for (name, ratios) in cases {
        let reference = load_wall(&folder.join(name).join("wall.toml")).expect("the reference's wall");
        let facade = Facade {
            thickness_m: 0.5,
            slenderness: ratios.slenderness,
            crack_height_ratio: 0.62,
            compressive_strength_pa: 3.45e6,
            stiffness_n_per_m: ratios.stiffness,
            diaphragm_mass_ratio: ratios.diaphragm,
            carriage_mass_ratio: ratios.carriage,
            length_m: 1.0,
            density_kg_m3: 1800.0,
        };
        let wall = facade.wall(Restitution::default(), 2.0).expect("a façade that stands");
        let numbers = |wall: &mrbd_kernel::model::Wall| {
            let p = wall.parameters();
            [
                p.height_m,
                p.crack_height_m.expect("cracked"),
                p.mass_kg,
                p.lower_width_m,
                p.upper_width_m,
                p.diaphragm_mass_kg,
                p.carriage_mass_kg,
                p.stiffness_n_per_m,
            ]
        };
        for (ours, theirs) in numbers(&wall).into_iter().zip(numbers(&reference)) {
            // The reference's files carry 16 digits; a few roundings apart.
            assert!((ours - theirs).abs() <= 1e-14 * theirs.abs(), "{name}: {ours} against {theirs}");
        }
    }
}

#[test]
fn analytic_a_study_on_a_floor_has_the_records_of_that_floor() {
    use mrbd_records::{Building, Mode, floor_motion};
    let suite = mrbd_records::Suite::load(
        &std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("inputs/records/emilia7/suite.toml"),
    )
    .expect("the suite");
    let building =
        Building { height_ratio: 0.5, period_s: 0.3, storeys: 2, damping: 0.05, modes: Vec::new() };
    let modes = [Mode { period_s: 0.3, participation: 0.5 * 6.0 / 5.0 }];
    let expected = floor_motion(&suite.records[0].horizontal, &modes, 0.05).expect("a motion");
    let first = &suite.clone().on_floor(&building).expect("motions").records[0];
    assert_eq!(first.horizontal, expected);
    // Measures are those of the floor's motion.
    assert!((first.intensity.pga_m_s2 - expected.peak_m_s2()).abs() < 1e-12);
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/pipelines/check.toml");
    let text = std::fs::read_to_string(path).expect("shipped");
    let load = |text: &str| {
        let pipeline =
            mrbd::study::pipeline::Pipeline::parse(path.as_ref(), text.to_owned()).expect("a pipeline");
        mrbd::study::plan::Plan::load(&pipeline, None).expect("a plan")
    };
    let floor = "floor = { height_ratio = 0.5, period_s = 0.3, storeys = 2 }\n";
    let [ground, above] = [load(&text), load(&format!("{floor}{text}"))];
    assert_eq!(above.motions().suite.records[0].horizontal, expected);
    // Another study: its runs are not taken for those at the ground.
    assert!(ground.motions().hashes != above.motions().hashes && ground.len() == above.len());
}
