//! Every finding on made-up medians: each of the three answers must be reachable.

use mrbd::aggregate::{Case, Measure, Median, Medians};
use mrbd::findings::{Conclusion, FINDINGS, Finding, Held, Verdict, View};
use mrbd::study::pipeline::Parameter;
use mrbd::study::plan::Level;
use mrbd::survey::Configuration;

use Configuration::{Parallel, Perpendicular};
use Level::{High, Low, Mean};
use Measure::UpperOwn;

/// A rotation and the distance between its 16 and 84 % quantiles, or a collapse.
type Made = Option<(f64, f64)>;

/// The medians of a whole sweep, made by a function of the case.
fn medians(make: impl Fn(&Case, Measure) -> Made) -> Medians {
    let mut rows = Vec::new();
    for configuration in Configuration::ALL {
        for parameter in Parameter::ALL {
            let other = match configuration {
                Perpendicular => Parameter::CarriageMass,
                Parallel => Parameter::DiaphragmMass,
            };
            for level in Level::ALL.into_iter().filter(|_| parameter != other) {
                for slenderness in (4..=12).map(|i| f64::from(2 * i)) {
                    let case =
                        Case { variant: "made".to_owned(), configuration, parameter, level, slenderness };
                    rows.extend(
                        Measure::ALL.map(|measure| median(case.clone(), measure, make(&case, measure))),
                    );
                }
            }
        }
    }
    Medians::new(Vec::new(), rows)
}

fn median(case: Case, measure: Measure, made: Made) -> Median {
    let quantiles = made.map_or([None; 7], |(rotation, spread)| {
        [-0.6, -0.5, -0.4, 0.0, 0.4, 0.5, 0.6].map(|part| Some(rotation + part * spread))
    });
    // Crack heights are listed downwards.
    let value = match case.parameter {
        Parameter::CrackHeight => [0.73, 0.62, 0.52][case.level.index()],
        _ => 1.0 + case.level.index() as f64,
    };
    let collapsed = if made.is_some() { 0 } else { 7 };
    let parameter_value = (case.parameter != Parameter::Restitution).then_some(value);
    Median { case, parameter_value, measure, runs: 7, collapsed, failed: 0, quantiles, interval: None }
}

/// The answer to a finding on medians whose rotations are made by a function of the case.
fn answer(name: &str, make: impl Fn(&Case, Measure) -> f64) -> Verdict {
    answer_made(name, |case, measure| Some((make(case, measure), 0.0)))
}

fn answer_made(name: &str, make: impl Fn(&Case, Measure) -> Made) -> Verdict {
    let finding = FINDINGS.iter().find(|finding| finding.name == name).expect("a finding of that name");
    let answer = finding.answer(&View::new(&medians(make), "made"));
    assert!(!answer.numbers.is_empty() && !answer.short.is_empty(), "numbers decide");
    answer.verdict
}

fn slender(case: &Case) -> bool {
    case.slenderness > 14.0
}

/// A rotation that a parameter raises, by floor and slenderness: -1, 0 or +1 from low to high level.
fn raised(case: &Case, parameter: Parameter, by: f64) -> f64 {
    let step = if case.parameter == parameter { case.level.index() as f64 - 1.0 } else { 0.0 };
    0.2 + by * step
}

#[test]
fn regress_only_slender_walls_rotate() {
    let name = "only slender walls rotate";
    assert_eq!(answer(name, |c, _| if slender(c) { 0.1 } else { 0.01 }), Verdict::Holds);
    assert_eq!(answer(name, |_, _| 0.1), Verdict::DoesNot);
    assert_eq!(answer(name, |_, _| 0.01), Verdict::Undecided);
    let falls = |c: &Case, _| if slender(c) { None } else { Some((0.01, 0.0)) };
    assert_eq!(answer_made(name, falls), Verdict::Holds, "a collapse is a large rotation");
}

#[test]
fn regress_parallel_floors_rotate_more() {
    let times =
        |factor: f64| move |c: &Case, _| if c.configuration == Parallel { factor * 0.02 } else { 0.02 };
    let name = "parallel floor rotates more";
    assert_eq!(answer(name, times(2.0)), Verdict::Holds);
    assert_eq!(answer(name, times(0.5)), Verdict::DoesNot);
    assert_eq!(answer(name, times(1.0)), Verdict::Undecided);
    let name = "about five times more";
    assert_eq!(answer(name, times(5.0)), Verdict::Holds);
    assert_eq!(answer(name, times(9.0)), Verdict::Undecided);
    assert_eq!(answer(name, times(1.5)), Verdict::DoesNot);
    assert_eq!(answer_made(name, |_, _| None), Verdict::Undecided, "no ratio of collapses");
}

#[test]
fn regress_reverse_scale_effect() {
    let name = "reverse scale effect";
    let thickness = |by: f64| move |c: &Case, _| raised(c, Parameter::Thickness, by);
    assert_eq!(answer(name, thickness(0.05)), Verdict::Holds);
    assert_eq!(answer(name, thickness(-0.05)), Verdict::DoesNot);
    assert_eq!(answer(name, thickness(0.0)), Verdict::Undecided);
    let moderate_only = |c: &Case, _| raised(c, Parameter::Thickness, if slender(c) { -0.05 } else { 0.05 });
    assert_eq!(answer(name, moderate_only), Verdict::DoesNot, "asked of slender walls");
    let falls = |c: &Case, _| {
        if (c.parameter, c.level) == (Parameter::Thickness, High) { None } else { Some((0.1, 0.0)) }
    };
    assert_eq!(answer_made(name, falls), Verdict::Holds, "collapse outranks every rotation");

    let name = "reverse scale more if parallel";
    let by_floor = |perpendicular: f64, parallel: f64| {
        move |c: &Case, _| {
            raised(
                c,
                Parameter::Thickness,
                if c.configuration == Parallel { parallel } else { perpendicular },
            )
        }
    };
    assert_eq!(answer(name, by_floor(0.02, 0.05)), Verdict::Holds);
    assert_eq!(answer(name, by_floor(0.05, 0.02)), Verdict::DoesNot);
    assert_eq!(answer(name, by_floor(0.05, 0.05)), Verdict::Undecided);
    assert_eq!(answer_made(name, |_, _| None), Verdict::Undecided, "no increase between collapses");
}

#[test]
fn regress_crack_heights_are_compared_by_value() {
    let name = "higher crack, larger rotation";
    // The high level is the low crack.
    let crack = |by: f64| move |c: &Case, _| raised(c, Parameter::CrackHeight, by);
    assert_eq!(answer(name, crack(-0.05)), Verdict::Holds);
    assert_eq!(answer(name, crack(0.05)), Verdict::DoesNot);
    assert_eq!(answer(name, crack(0.0)), Verdict::Undecided);
}

#[test]
fn regress_upper_body_below_lower() {
    let name = "upper body below lower";
    let upper = |moderate: f64, large: f64| {
        move |c: &Case, m: Measure| match m == UpperOwn {
            true => 0.1 * if slender(c) { large } else { moderate },
            false => 0.1,
        }
    };
    assert_eq!(answer(name, upper(0.5, 2.0)), Verdict::Holds);
    assert_eq!(answer(name, upper(0.5, 0.5)), Verdict::DoesNot, "it must reverse");
    assert_eq!(answer(name, upper(2.0, 2.0)), Verdict::DoesNot);
    assert_eq!(answer(name, upper(0.5, 1.0)), Verdict::Undecided);
}

#[test]
fn regress_little_influence_of_strength_and_coefficients() {
    for (name, parameter) in [
        ("strength hardly matters", Parameter::Strength),
        ("coefficients matter little", Parameter::Restitution),
    ] {
        // From low to high twice the step, against a tenth of 0.2.
        assert_eq!(answer(name, |c, _| raised(c, parameter, 0.009)), Verdict::Holds, "{name}");
        assert_eq!(answer(name, |c, _| raised(c, parameter, 0.011)), Verdict::DoesNot, "{name}");
        let third =
            |c: &Case, _: Measure| raised(c, parameter, if c.slenderness >= 20.0 { 0.05 } else { 0.0 });
        assert_eq!(answer(name, third), Verdict::Undecided, "{name}");
    }
    let slender_parallel = |c: &Case, _: Measure| {
        raised(c, Parameter::Restitution, if slender(c) && c.configuration == Parallel { 0.1 } else { 0.0 })
    };
    assert_eq!(answer("coefficients matter little", slender_parallel), Verdict::Holds, "these are apart");
}

#[test]
fn regress_stiffer_floors_rotate_less() {
    let name = "stiffer floor, smaller rotation";
    let stiffness = |by: f64| move |c: &Case, _| raised(c, Parameter::Stiffness, by);
    assert_eq!(answer(name, stiffness(-0.05)), Verdict::Holds);
    assert_eq!(answer(name, stiffness(0.05)), Verdict::DoesNot);
    assert_eq!(answer(name, stiffness(0.0)), Verdict::Undecided);
    // 18 of 18 under one floor do not make up for 13 of 18 under the other.
    let few = |c: &Case, m: Measure| {
        let reversed =
            c.configuration == Parallel && (c.slenderness > 20.0 || (c.slenderness > 18.0 && m == UpperOwn));
        raised(c, Parameter::Stiffness, if reversed { 0.05 } else { -0.05 })
    };
    assert_eq!(answer(name, few), Verdict::Undecided, "each floor is asked");
}

#[test]
fn regress_perpendicular_mass_reverses() {
    let name = "perpendicular floor mass";
    let mass = |moderate: f64, large: f64| {
        move |c: &Case, _| raised(c, Parameter::DiaphragmMass, if slender(c) { large } else { moderate })
    };
    assert_eq!(answer(name, mass(0.05, -0.05)), Verdict::Holds);
    assert_eq!(answer(name, mass(0.05, 0.05)), Verdict::DoesNot);
    assert_eq!(answer(name, mass(0.05, 0.0)), Verdict::Undecided);
}

#[test]
fn regress_perpendicular_mass_is_not_relevant() {
    let name = "perpendicular floor mass not relevant";
    let mass = |by: f64| move |c: &Case, _| raised(c, Parameter::DiaphragmMass, by);
    assert_eq!(answer(name, mass(0.009)), Verdict::Holds, "from low to high 0.018, less than a tenth of 0.2");
    assert_eq!(answer(name, mass(0.05)), Verdict::DoesNot);
    let some =
        |c: &Case, _| raised(c, Parameter::DiaphragmMass, if c.slenderness > 18.0 { 0.05 } else { 0.0 });
    assert_eq!(answer(name, some), Verdict::Undecided);
}

#[test]
fn regress_parallel_mass_is_amplified() {
    let name = "parallel floor mass";
    let mass = |moderate: f64, large: f64| {
        move |c: &Case, _| raised(c, Parameter::CarriageMass, if slender(c) { large } else { moderate })
    };
    assert_eq!(answer(name, mass(0.02, 0.05)), Verdict::Holds);
    assert_eq!(answer(name, mass(0.05, 0.02)), Verdict::DoesNot, "more, but not amplified");
    assert_eq!(answer(name, mass(-0.05, -0.05)), Verdict::DoesNot);
    assert_eq!(answer(name, mass(0.0, 0.0)), Verdict::Undecided);
    let light_stands = |c: &Case, _| match (c.parameter, c.level) {
        (Parameter::CarriageMass, Mean | High) if slender(c) => None,
        (Parameter::CarriageMass, Low) => Some((0.1, 0.0)),
        _ => Some((0.2, 0.0)),
    };
    assert_eq!(answer_made(name, light_stands), Verdict::Holds, "a rise to collapse is endless");
    // Rises of 0.03 and 0.07 at an even number of slendernesses h/b ≤ 14; above, 0.06. Their true median is 0.05.
    let between = |c: &Case, _| {
        raised(
            c,
            Parameter::CarriageMass,
            if slender(c) {
                0.03
            } else if c.slenderness > 10.0 {
                0.035
            } else {
                0.015
            },
        )
    };
    assert_eq!(answer(name, between), Verdict::Holds, "the median is the mean of the two in the middle");
}

#[test]
fn regress_spread_between_records() {
    let name = "record-to-record spread";
    let spread = |parallel: f64, large: f64| {
        move |c: &Case, _| {
            let floor = if c.configuration == Parallel { parallel } else { 1.0 };
            Some((0.2, 0.02 * floor * if slender(c) { large } else { 1.0 }))
        }
    };
    assert_eq!(answer_made(name, spread(2.0, 3.0)), Verdict::Holds);
    assert_eq!(answer_made(name, spread(0.5, 3.0)), Verdict::DoesNot);
    assert_eq!(answer_made(name, spread(2.0, 0.5)), Verdict::DoesNot);
    assert_eq!(answer_made(name, spread(1.0, 3.0)), Verdict::Undecided);
}

#[test]
fn regress_coefficients_matter_more_for_slender_parallel_walls() {
    let name = "coefficients, slender parallel";
    let moves = |c: &Case, slender_parallel: f64, elsewhere: f64| {
        let by = if slender(c) && c.configuration == Parallel { slender_parallel } else { elsewhere };
        raised(c, Parameter::Restitution, by)
    };
    assert_eq!(answer(name, |c, _| moves(c, 0.08, 0.01)), Verdict::Holds);
    assert_eq!(answer(name, |c, _| moves(c, 0.01, 0.08)), Verdict::DoesNot);
    assert_eq!(answer(name, |c, _| moves(c, 0.01, 0.01)), Verdict::Undecided);
}

/// The answers to every finding on the rows of a sweep that are kept.
fn verdicts_of(keep: impl Fn(&Median) -> bool) -> Vec<(&'static str, Verdict)> {
    let whole = medians(|_, _| Some((0.2, 0.1)));
    let kept = Medians::new(Vec::new(), whole.rows().iter().filter(|row| keep(row)).cloned().collect());
    let view = View::new(&kept, "made");
    FINDINGS.iter().map(|finding| (finding.name, finding.answer(&view).verdict)).collect()
}

#[test]
fn regress_a_study_is_not_asked_of_what_it_does_not_vary() {
    let not_asked = |keep: &dyn Fn(&Median) -> bool| -> Vec<&'static str> {
        let verdicts = verdicts_of(keep).into_iter();
        verdicts.filter(|(_, verdict)| *verdict == Verdict::NotAsked).map(|(name, _)| name).collect()
    };
    assert_eq!(not_asked(&|_| true), [""; 0]);
    assert_eq!(not_asked(&|_| false).len(), FINDINGS.len());
    let two_parameters =
        |row: &Median| [Parameter::Thickness, Parameter::Stiffness].contains(&row.case.parameter);
    let about_others = [
        "about five times more",
        "higher crack, larger rotation",
        "upper body below lower",
        "strength hardly matters",
        "perpendicular floor mass",
        "perpendicular floor mass not relevant",
        "parallel floor mass",
        "coefficients matter little",
        "coefficients, slender parallel",
    ];
    assert_eq!(not_asked(&two_parameters), about_others);
    let one_floor = not_asked(&|row| row.case.configuration == Perpendicular);
    assert_eq!(one_floor.len(), FINDINGS.len() - 2, "but for the perpendicular floor's mass");
    let squat = not_asked(&|row| !slender(&row.case));
    assert!(squat.contains(&"reverse scale effect") && squat.contains(&"record-to-record spread"));
    assert!(!squat.contains(&"higher crack, larger rotation"), "it is about all slendernesses");
    let means = not_asked(&|row| row.case.level == Mean);
    assert!(
        means.contains(&"stiffer floor, smaller rotation") && !means.contains(&"only slender walls rotate")
    );
}

#[test]
fn regress_one_record_tells_no_spread_between_records() {
    let mut rows = medians(|_, _| Some((0.2, 0.1))).rows().to_vec();
    rows.iter_mut().for_each(|row| row.runs = 1);
    let study = Medians::new(Vec::new(), rows);
    let view = View::new(&study, "made");
    let not_asked = FINDINGS.iter().filter(|finding| finding.answer(&view).verdict == Verdict::NotAsked);
    assert_eq!(not_asked.map(|finding| finding.name).collect::<Vec<_>>(), ["record-to-record spread"]);
    let at_hand = |finding: &Finding| Conclusion { answer: finding.answer(&view), sureness: None };
    let conclusions: Vec<Conclusion> = FINDINGS.iter().map(at_hand).collect();
    assert_eq!(Held::among(&conclusions).asked, FINDINGS.len() - 1);
}

#[test]
fn regress_findings_have_names_labels_sources_and_criteria() {
    for finding in &FINDINGS {
        let twins =
            FINDINGS.iter().filter(|other| other.name == finding.name || other.label == finding.label);
        assert_eq!(twins.count(), 1, "{}", finding.name);
        assert!(finding.source.contains("section") && !finding.criterion.is_empty());
        assert!(!finding.criterion.contains("both floors"), "each floor is checked: {}", finding.criterion);
    }
}
