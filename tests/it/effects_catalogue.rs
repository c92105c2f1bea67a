//! The catalogue of effects: what it says holds, what it does not allow is refused.

use std::collections::HashSet;
use std::path::Path;

use mrbd_kernel::model::{Effect, EffectKind, Wall};

use crate::walls::{any_of_all_effects, any_wall, bare_wall, effect, rng, table_wall};
use mrbd_kernel::model::ImpactLaw;

#[derive(Debug, PartialEq, serde::Serialize, serde::Deserialize)]
struct File {
    effects: Vec<Effect>,
}

fn refused(text: &str) -> String {
    toml::from_str::<File>(&format!("[[effects]]\n{text}")).expect_err(text).to_string()
}

#[test]
fn published_every_kind_that_scripts_rely_on_is_there() {
    let kinds: Vec<&str> = EffectKind::ALL.iter().map(|kind| kind.name()).collect();
    for name in [
        "carriage_mass",
        "viscous_damping",
        "coulomb_friction",
        "cubic_stiffness",
        "gap",
        "one_sided_spring",
        "yielding_spring",
        "corner_indentation",
        "compliant_joint",
        "trilinear_joint",
        "crushing_joint",
        "rounded_edges",
        "impact_dissipation",
        "impact_fading",
        "joint_damping",
        "vertical_ground_motion",
        "record_gain",
        "record_lag",
        "sensor_gain",
        "sensor_offset",
    ] {
        assert!(kinds.contains(&name), "{name}");
    }
    assert_eq!(kinds.iter().collect::<HashSet<_>>().len(), kinds.len(), "a name twice");
}

#[test]
fn analytic_every_variant_survives_a_file_and_its_parameters() {
    for kind in EffectKind::ALL {
        for variant in kind.variants() {
            let example = variant.example();
            assert_eq!(Effect::with_parameters(&variant.name(), &example.parameters()), Ok(example));
            let file = File { effects: vec![example, example] };
            let text = toml::to_string(&file).expect("a table");
            assert_eq!(toml::from_str::<File>(&text).expect(&text), file);
            let json = serde_json::to_string(&example).expect("JSON");
            assert!(json.starts_with(&format!("{{\"kind\":\"{}\"", kind.name())), "{json}");
            assert_eq!(serde_json::from_str::<Effect>(&json).expect(&json), example);
        }
    }
}

#[test]
fn analytic_a_wall_file_keeps_every_effect_of_the_catalogue() {
    let wall = include_str!("../../src/cli/starter/wall.toml");
    for variant in EffectKind::ALL.iter().flat_map(|kind| kind.variants()) {
        let file = File { effects: vec![variant.example()] };
        let text = format!("{wall}\n{}", toml::to_string(&file).expect("a table"));
        let read = mrbd_files::parse_wall(Path::new("wall.toml"), &text).expect(&text);
        assert_eq!(read.parameters().effects.last(), file.effects.last(), "{text}");
    }
}

#[test]
fn analytic_walls_drawn_with_all_effects_have_every_kind() {
    let drawn = |index| {
        let mut rng = rng(324, index);
        let wall = any_wall(&mut rng);
        any_of_all_effects(&mut rng, &wall)
    };
    // One wall in two has each effect: a kind that the list of `walls` has is missed once in 2^50.
    let seen: HashSet<EffectKind> = (0..50).flat_map(drawn).map(|effect| effect.kind()).collect();
    for kind in EffectKind::ALL {
        assert!(seen.contains(kind), "no drawn wall has {}", kind.name());
    }
}

#[test]
fn analytic_bounds_are_allowed_and_what_lies_beyond_is_refused() {
    for variant in EffectKind::ALL.iter().flat_map(|kind| kind.variants()) {
        let example = variant.example().parameters();
        for (i, parameter) in variant.entry().parameters.iter().enumerate() {
            let with = |value: f64| {
                let mut values = example.clone();
                values[i] = value;
                variant.with_parameters(&values)
            };
            assert!(with(parameter.least).is_ok() && with(parameter.most).is_ok(), "{}", parameter.key);
            let above = parameter.most + parameter.most.abs() * 1e-9;
            let below = parameter.least - 1e-9 * parameter.most.abs();
            for value in [above, below, f64::NAN, f64::INFINITY] {
                let message = with(value).expect_err("outside").to_string();
                assert!(
                    message.contains(parameter.key) && message.contains(variant.kind.name()),
                    "{message}"
                );
                assert!(message.contains(&parameter.most.to_string()), "{message}");
            }
            assert!((parameter.least..=parameter.most).contains(&parameter.example), "{}", parameter.key);
        }
    }
}

#[test]
fn analytic_what_is_confused_is_a_kind_or_a_key() {
    for kind in EffectKind::ALL {
        for other in kind.entry().confused_with {
            let is_kind = EffectKind::named(other).is_ok();
            let is_key = other
                .split_once('.')
                .is_some_and(|(table, _)| ["wall", "corners", "diaphragm", "restitution"].contains(&table));
            assert!(is_kind || is_key, "{}: {other}", kind.name());
        }
    }
}

#[test]
fn rejects_what_is_no_effect() {
    assert!(refused("kind = \"magic\"").contains("`yielding_spring`"));
    assert!(refused("force_n = 3.0").contains("kind"));
    assert!(refused("kind = 3").contains("word"));
    assert!(refused("kind = \"gap\"").contains("half_width_m"));
    assert!(refused("kind = \"gap\"\nhalf_width_m = \"wide\"").contains("half_width_m"));
    assert!(refused("kind = \"gap\"\nhalf_width_m = true").contains("a number, a word or a list"));
    assert!(refused("kind = \"gap\"\nhalf_width_m = 0.1\nwidth_m = 0.1").contains("width_m"));
    assert!(refused("kind = \"gap\"\nhalf_width_m = -0.1").contains("0 to 10 m"));
    assert!(refused("kind = \"gap\"\nhalf_width_m = nan").contains("0 to 10 m"));
    assert!(refused("kind = \"joint_damping\"\ncoefficient_n_m_s_per_rad = 1.0").contains("`crack`"));
    let left = "kind = \"one_sided_spring\"\nstiffness_n_per_m = 1.0\nside = \"left\"";
    assert!(refused(left).contains("`negative`, `positive`"));
    assert!(refused("kind = \"impact_dissipation\"\nfactors = [1.0, 0.9]").contains("8 numbers"));
    let negative = "kind = \"impact_dissipation\"\nfactors = [1.0, 1, 1, 1, 1, 1, 1, -1]";
    assert!(refused(negative).contains("factors.7"));
    for (name, values) in
        [("gap", &[][..]), ("gap.left", &[0.1]), ("joint_damping", &[0.1]), ("gap", &[0.1; 2])]
    {
        assert!(Effect::with_parameters(name, values).is_err(), "{name} {values:?}");
    }
}

#[test]
fn rejects_effects_a_wall_cannot_have() {
    let refused = |effects: &[Effect], cracked: bool| {
        let mut wall = if cracked { table_wall(ImpactLaw::Whole) } else { bare_wall(0.3, 4.0, None) };
        wall.effects = effects.to_vec();
        Wall::new(wall).expect_err("an impossible wall")
    };
    for name in ["gap", "yielding_spring"] {
        let twice = [EffectKind::named(name).expect("a kind").variants().next().expect("one").example(); 2];
        let error = refused(&twice, true);
        assert_eq!(error.key, "effects.1");
        assert!(error.found.contains(name), "{error}");
    }
    let deep = [effect("corner_indentation.ground", &[0.2]), effect("corner_indentation.ground", &[0.08])];
    let error = refused(&deep, true);
    assert!(error.key == "effects.1" && error.allowed.contains("lower_width_m"), "{error}");
    let error = refused(&[effect("corner_indentation.crack", &[0.01])], false);
    assert!(error.allowed.contains("ground"), "{error}");
    let error = refused(&[effect("joint_damping.crack", &[0.01])], false);
    assert!(error.found.contains("crack"), "{error}");
    let error = refused(&[effect("impact_dissipation", &[2.0; 8]); 2], true);
    assert!(error.found.contains("C_l"), "{error}");
}
