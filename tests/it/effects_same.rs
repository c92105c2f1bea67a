//! Effects that another wall or another record has already: the runs must be the same.

use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{Effect, ImpactLaw, WallParameters};
use mrbd_kernel::simulate::{Accuracy, History, Response, Shaking, Simulator, simulate, simulate_observed};

use crate::walls::{effect, made, table_wall};

const TIGHT: Accuracy = Accuracy { tolerance: 1e-10 };

/// Two sines that rock the table wall.
fn shaking(seed: u32, vertical: bool) -> Shaking {
    let a = |t: f64| 0.9 * ((9.0 * t + f64::from(seed)).sin() + (23.0 * t).sin());
    let samples = (0..400).map(|k| a(0.01 * f64::from(k))).collect();
    let horizontal = Accelerogram::new(0.01, samples).expect("a record");
    let vertical = vertical.then(|| horizontal.scaled(-0.4));
    Shaking { horizontal: Some(horizontal), vertical, tail_s: 1.0 }
}

fn with(effects: &[Effect]) -> WallParameters {
    WallParameters { effects: effects.to_vec(), ..table_wall(ImpactLaw::Contact) }
}

fn run(wall: &WallParameters, shaking: &Shaking) -> Response {
    let response = simulate(&made(wall), shaking, TIGHT);
    assert!(response.impacts.total() > 5, "the wall rocks: {:?}", response.impacts);
    response
}

/// Largest difference of rotations, rad.
fn apart(a: &WallParameters, b: &WallParameters, shaking: &Shaking) -> f64 {
    let rows = |wall: &WallParameters| {
        let mut history = History::new(0.01);
        simulate_observed(&made(wall), shaking, TIGHT, &mut history);
        history.rows
    };
    let (a, b) = (rows(a), rows(b));
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().zip(&b).flat_map(|(a, b)| [0, 1].map(|i| (a.theta_rad[i] - b.theta_rad[i]).abs()));
    pairs.fold(0.0, f64::max)
}

/// The tolerance of 1e-10 of α, some 0.1 rad, which impacts magnify by a hundred in a well-conditioned run.
const SAME_RAD: f64 = 1e-9;

#[test]
fn analytic_indented_corners_are_narrower_corners() {
    let indented = with(&[
        effect("corner_indentation.ground", &[0.02]),
        effect("corner_indentation.crack", &[0.03]),
        effect("corner_indentation.crack", &[0.01]),
    ]);
    let mut narrow = with(&[]);
    narrow.lower_width_m -= 0.02;
    narrow.upper_width_m -= 0.03 + 0.01;
    assert_eq!(run(&indented, &shaking(0, false)), run(&narrow, &shaking(0, false)));
}

#[test]
fn analytic_factors_on_impacts_are_other_coefficients() {
    let factors = [0.9, 0.8, 1.1, 0.95, 0.7, 1.0, 0.5, 0.6];
    let mut other = with(&[]);
    for (c_l, factor) in other.restitution.coefficients.iter_mut().zip(factors) {
        *c_l *= factor;
    }
    let dissipating = with(&[effect("impact_dissipation", &factors)]);
    assert_eq!(run(&dissipating, &shaking(0, false)), run(&other, &shaking(0, false)));
}

#[test]
fn analytic_gain_and_vertical_share_are_another_record() {
    let recorded = shaking(1, true);
    let gained = with(&[effect("record_gain", &[1.25])]);
    let louder = Shaking {
        horizontal: recorded.horizontal.as_ref().map(|record| record.scaled(1.25)),
        vertical: recorded.vertical.as_ref().map(|record| record.scaled(1.25)),
        ..recorded
    };
    assert_eq!(run(&gained, &recorded), run(&with(&[]), &louder));
    let level = shaking(1, false);
    let pitched = with(&[effect("vertical_ground_motion", &[0.1]), effect("vertical_ground_motion", &[0.2])]);
    let raised = Shaking {
        vertical: level.horizontal.as_ref().map(|record| record.scaled(0.1 + 0.2)),
        ..level.clone()
    };
    assert_eq!(run(&pitched, &level), run(&with(&[]), &raised));
}

/// A record without a jump at its start, later by some samples, of which the first may be lost.
fn shifted(record: &Accelerogram, samples: i32) -> Accelerogram {
    let a = record.acceleration_m_s2();
    let moved = match usize::try_from(samples) {
        Ok(later) => [vec![0.0; later], a.to_vec()].concat(),
        Err(_) => a[samples.unsigned_abs() as usize..].to_vec(),
    };
    Accelerogram::new(record.step_s(), moved).expect("a record")
}

/// The same linear pieces at a tenth of the step.
fn cut_in_ten(record: &Accelerogram) -> Accelerogram {
    let a = record.acceleration_m_s2();
    let at = |k: usize| {
        let (whole, part) = (k / 10, (k % 10) as f64 / 10.0);
        a[whole] + part * (a.get(whole + 1).unwrap_or(&0.0) - a[whole])
    };
    Accelerogram::new(record.step_s() / 10.0, (0..10 * a.len()).map(at).collect()).expect("a record")
}

#[test]
fn analytic_a_lag_is_a_shifted_record() {
    let mut recorded = shaking(2, false);
    let mut samples = recorded.horizontal.as_ref().expect("a record").acceleration_m_s2().to_vec();
    samples[0] = 0.0;
    let record = Accelerogram::new(0.01, samples).expect("a record");
    recorded.horizontal = Some(record.clone());
    for lag in [37, 20, -15, -24] {
        // 0.037 s and so on at a step of 0.01 s: between samples.
        let lagging = with(&[effect("record_lag", &[f64::from(lag) * 1e-3])]);
        let fine = Shaking { horizontal: Some(shifted(&cut_in_ten(&record), lag)), ..recorded.clone() };
        let simulator = Simulator::new(&made(&lagging), &recorded, TIGHT);
        // The run ends so much later that the free motion after the record stays as long, and never earlier.
        let later_s = f64::from(lag.max(0)) * 1e-3;
        assert!((simulator.end_s() - (record.duration_s() + 1.0 + later_s)).abs() < 1e-9);
        let (found, expected) = (run(&lagging, &recorded), run(&with(&[]), &fine));
        assert_eq!(found.impacts, expected.impacts, "{lag}");
        for i in 0..2 {
            let (a, b) = (found.theta_max_rad[i], expected.theta_max_rad[i]);
            assert!((a.value - b.value).abs() < SAME_RAD, "{lag} ms: {a:?} and {b:?}");
            assert!((a.time_s - b.time_s).abs() < 1e-4, "{lag} ms: {a:?} and {b:?}");
        }
    }
}

#[test]
fn analytic_sensors_change_the_reading_and_nothing_else() {
    let effects = [
        effect("sensor_gain.lower", &[1.02]),
        effect("sensor_gain.both", &[0.5]),
        effect("sensor_offset.upper", &[3e-4]),
        effect("sensor_offset.both", &[1e-4]),
    ];
    let wall = with(&effects);
    assert_eq!(run(&wall, &shaking(0, false)), run(&with(&[]), &shaking(0, false)));
    let read = made(&wall).reading().of([0.1, 0.2]);
    assert!((read[0] - (0.1 * 1.02 * 0.5 + 1e-4)).abs() < 1e-16, "{read:?}");
    assert!((read[1] - (0.2 * 0.5 + 3e-4 + 1e-4)).abs() < 1e-16, "{read:?}");
    assert!(made(&with(&[])).reading().is_true());
}

#[test]
fn analytic_springs_with_kinks_that_are_not_reached_are_plain_springs() {
    let with_spring = |factor: f64| {
        let mut wall = with(&[]);
        wall.stiffness_n_per_m *= factor;
        wall
    };
    let k_d = with(&[]).stiffness_n_per_m;
    let cases = [
        // A gap wider than the top moves leaves no spring.
        ("wide gap", with(&[effect("gap", &[5.0])]), with_spring(0.0)),
        // A spring on both sides is one spring.
        (
            "both sides",
            with(&[
                effect("one_sided_spring.positive", &[0.3 * k_d]),
                effect("one_sided_spring.negative", &[0.3 * k_d]),
            ]),
            with_spring(1.3),
        ),
        // A spring too strong to yield is elastic.
        ("strong", with(&[effect("yielding_spring", &[0.3 * k_d, 1e9])]), with_spring(1.3)),
        // Nothing of a kind is nothing.
        (
            "nothing",
            with(&[
                effect("gap", &[0.0]),
                effect("coulomb_friction", &[0.0]),
                effect("yielding_spring", &[0.0; 2]),
            ]),
            with_spring(1.0),
        ),
    ];
    for (name, found, expected) in cases {
        let difference = apart(&found, &expected, &shaking(0, false));
        eprintln!("{name}: {difference:e} rad apart");
        assert!(difference < SAME_RAD, "{name}: {difference:e}");
    }
}
