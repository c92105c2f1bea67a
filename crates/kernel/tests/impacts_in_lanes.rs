//! Impacts in the lanes: a row goes through most of them by itself, with the bits of walls that go one after another.

use fearless_simd::{Level, Simd};
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{Effect, ImpactLaw, Restitution, Wall, WallParameters};
use mrbd_kernel::simulate::{Accuracy, Response, Shaking, Simulator, simulate_side_by_side_at};

/// Ten seconds of sines that rock the table wall in all patterns, to both sides as far.
fn shaking(strength_m_s2: f64) -> Shaking {
    let a = |t: f64| strength_m_s2 * ((9.0 * t).sin() + (17.3 * t).sin() + 0.3 * (61.0 * t).sin());
    let samples = (0..1000).map(|k| a(0.01 * f64::from(k))).collect();
    let horizontal = Some(Accelerogram::new(0.01, samples).expect("a record"));
    Shaking { horizontal, vertical: None, tail_s: 3.0 }
}

/// Walls that strike alike at every speed and that do not, with a crack and without, that are captured early and late.
fn walls() -> Vec<Wall> {
    let table = WallParameters::table_wall;
    let struck = |law: ImpactLaw, capture_velocity_rad_s: f64| {
        let restitution = Restitution { law, capture_velocity_rad_s, ..table().restitution };
        WallParameters { restitution, ..table() }
    };
    let fading = Effect::with_parameters("impact_fading", &[0.3]).expect("an effect");
    let parameters = [
        table(),
        struck(ImpactLaw::Whole, 1e-6),
        struck(ImpactLaw::Whole, 0.05),
        struck(ImpactLaw::Contact, 1e-3),
        WallParameters { eccentricity_m: 0.02, ..table() },
        WallParameters { crack_height_m: None, ..table() },
        WallParameters { crack_height_m: Some(1.2), stiffness_n_per_m: 5e3, ..table() },
        WallParameters { effects: vec![fading], ..table() },
    ];
    parameters.into_iter().map(|parameters| Wall::new(parameters).expect("a wall that can exist")).collect()
}

fn responses(level: Level, tolerance: f64) -> Vec<Response> {
    let walls = walls();
    let strengths = [0.9, 1.3];
    let runs = strengths.iter().flat_map(|&strength| walls.iter().map(move |wall| (wall, shaking(strength))));
    let prepared = |(wall, shaking)| Simulator::new(wall, &shaking, Accuracy { tolerance }).prepared();
    let mut waiting = runs.map(prepared).enumerate();
    let mut responses = vec![None; strengths.len() * walls.len()];
    simulate_side_by_side_at(level, &mut || waiting.next(), &mut |number, response| {
        responses[number] = Some(response);
    });
    responses.into_iter().map(|response| response.expect("every run ends")).collect()
}

/// Instructions by which walls go one after another.
fn one_after_another() -> Option<Level> {
    #[cfg(target_arch = "x86_64")]
    return Level::new().as_sse2().map(Simd::level);
    #[cfg(not(target_arch = "x86_64"))]
    Some(Level::baseline())
}

#[test]
fn analytic_impacts_in_lanes_have_the_bits_of_impacts_one_after_another() {
    let Some(alone) = one_after_another() else { return };
    for tolerance in [1e-4, 1e-6, 1e-9] {
        let (expected, found) = (responses(alone, tolerance), responses(Level::new(), tolerance));
        for (expected, found) in expected.iter().zip(&found) {
            assert_eq!(format!("{found:?}"), format!("{expected:?}"), "at {tolerance:e}");
        }
        let table2 =
            |change: usize| found.iter().map(|response| response.impacts.table2[change]).sum::<u64>();
        // Walls strike the ground as one, and their cracks close in both directions.
        assert!(table2(5) > 100 && table2(0) > 100 && table2(1) > 100, "{:?}", found[0].impacts);
    }
}
