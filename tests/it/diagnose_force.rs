//! The missing force of a diagnosis on twins whose missing law is known.

use mrbd_kernel::model::{Effect, ImpactLaw, Wall};
use mrbd_kernel::simulate::{Accuracy, History, Shaking, simulate_observed};
use mrbd_lab::diagnose::force::{
    Against, ForcePoint, acts_at_top, explained_by, force_points, jumps, median_share_off_top,
};
use mrbd_lab::diagnose::hypothesis::Physics;
use mrbd_lab::experiment::file::Purpose;
use mrbd_lab::experiment::{Manner, TestData};
use rand_distr::{Distribution, Normal};

use crate::diagnose_twin::record;
use crate::walls::{rng, table_wall};

const STEP_S: f64 = 0.005;
/// Between the quiet and the noisy cases of a laboratory, rad.
const NOISE_RAD: f64 = 3e-5;

/// A wall measured in three tests.
fn measured(wall: &Wall) -> Vec<TestData> {
    let one = |number: usize| {
        let shaking =
            Shaking { horizontal: Some(record(number, 4.0, 12.0).scaled(2.2)), vertical: None, tail_s: 2.0 };
        let mut history = History::new(STEP_S);
        simulate_observed(wall, &shaking, Accuracy { tolerance: 1e-8 }, &mut history);
        let normal = Normal::new(0.0, NOISE_RAD).expect("a deviation");
        let mut random = rng(701, number as u64);
        let mut noisy = |theta: f64| theta + normal.sample(&mut random);
        TestData {
            name: format!("test {number}"),
            purpose: Purpose::Fit,
            shaking,
            time_s: history.rows.iter().map(|row| row.time_s).collect(),
            theta_rad: history.rows.iter().map(|row| row.theta_rad.map(&mut noisy)).collect(),
            noise_rad: [NOISE_RAD; 2],
            rest_offset_rad: [0.0; 2],
            read_gain: [1.0; 2],
            step_s: STEP_S,
            gap_s: 2.5 * STEP_S,
            manner: Manner::default(),
        }
    };
    (0..3).map(one).collect()
}

fn with(effect: Option<(&str, &[f64])>) -> Wall {
    let mut wall = table_wall(ImpactLaw::Contact);
    wall.effects
        .extend(effect.map(|(name, values)| Effect::with_parameters(name, values).expect("an effect")));
    Wall::new(wall).expect("a wall")
}

fn given() -> Physics {
    Physics { wall: with(None), reversed_ratio: 0.0 }
}

/// Slope of force over a regressor in least squares through zero, and its standard deviation by the noise of the force.
fn slope(points: &[ForcePoint], regressor: impl Fn(&ForcePoint) -> f64) -> [f64; 2] {
    let weight = |p: &ForcePoint| p.force_sd_n.powi(-2);
    let xx = points.iter().map(|p| weight(p) * regressor(p).powi(2)).sum::<f64>();
    let xf = points.iter().map(|p| weight(p) * regressor(p) * p.force_n).sum::<f64>();
    [xf / xx, xx.powf(-0.5)]
}

#[test]
fn analytic_the_missing_force_follows_its_law() {
    type Law = (&'static str, f64, fn(&ForcePoint) -> f64);
    let laws: [Law; 3] = [
        ("viscous_damping", 1500.0, |p| -p.velocity_m_s),
        ("cubic_stiffness", 12e6, |p| -p.displacement_m.powi(3)),
        ("carriage_mass", 300.0, |p| -p.acceleration_m_s2),
    ];
    for (kind, truth, regressor) in laws {
        let points = force_points(&measured(&with(Some((kind, &[truth])))), &given());
        let [displacement, velocity, _] = Against::ALL.map(|of| explained_by(&points, of).expect("a force"));
        let told = format!("{kind}: {displacement} by displacement, {velocity} by velocity");
        match kind {
            "viscous_damping" => assert!(velocity > 0.9 && displacement < 0.5, "{told}"),
            "cubic_stiffness" => assert!(displacement > 0.8 && velocity < 0.5, "{told}"),
            _ => {}
        }
        let [found, sd] = slope(&points, regressor);
        println!("{kind}: {found:.4e} ± {sd:.1e} for {truth:.4e}, {} points; {told}", points.len());
        // Half overlapping stretches share noise, which the standard deviation does not know: three of them, twice. And
        // 2 % for what lies within the reach of a test function.
        assert!((found - truth).abs() < 6.0 * sd + 0.02 * truth, "{kind}: {found} ± {sd} for {truth}");
    }
}

#[test]
fn analytic_where_nothing_is_missing_the_force_is_noise() {
    let wall = with(None);
    let points = force_points(&measured(&wall), &given());
    assert!(points.len() > 60, "{} points", points.len());
    let reduced =
        points.iter().map(|p| (p.force_n / p.force_sd_n).powi(2)).sum::<f64>() / points.len() as f64;
    // The mean of n squares, half overlapping, scatters by some 2/√n: 0.2 for a hundred, three times.
    assert!((reduced - 1.0).abs() < 0.6, "{reduced} of {} points", points.len());
}

#[test]
fn analytic_a_force_at_the_top_has_its_direction_and_a_late_record_has_not() {
    let share = |effect: (&str, &[f64])| {
        let points = force_points(&measured(&with(Some(effect))), &given());
        median_share_off_top(&points).expect("points in patterns 1 and 2")
    };
    let decided =
        |effect: (&str, &[f64])| acts_at_top(&force_points(&measured(&with(Some(effect))), &given()));
    assert!(decided(("cubic_stiffness", &[12e6])));
    for elsewhere in [
        ("record_lag", &[0.01][..]),
        ("record_gain", &[1.2]),
        ("corner_indentation.ground", &[0.02]),
        ("corner_indentation.crack", &[0.02]),
        ("joint_damping.crack", &[4000.0]),
        ("vertical_ground_motion", &[0.3]),
    ] {
        assert!(!decided(elsewhere), "{}", elsewhere.0);
    }
    let ((top, some), (late, many)) = (share(("viscous_damping", &[3000.0])), share(("record_lag", &[0.01])));
    assert!(top < 0.06 && late > 2.0 * top, "top {top} of {some} points, late {late} of {many}");
}

#[test]
fn analytic_an_impact_that_keeps_less_shows_in_its_ratio() {
    let mut factors = [1.0; 8];
    factors[5] = 0.9;
    let found = jumps(&measured(&with(Some(("impact_dissipation", &factors)))), &given());
    let of = |l: usize| {
        let mut ratios =
            found.iter().filter(|j| j.coefficient() == Some(l)).filter_map(|j| j.ratio).collect::<Vec<_>>();
        ratios.sort_by(f64::total_cmp);
        (ratios[ratios.len() / 2], ratios.len())
    };
    let (monolithic, count) = of(5);
    // 3a to 3b: the velocity after it is C_6 times that of a plastic impact (Eq. 7). Single ratios scatter by some 3 %.
    assert!(count >= 5 && (monolithic - 0.9).abs() < 0.02, "{monolithic} of {count}");
}
