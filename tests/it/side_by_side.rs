//! Walls side by side in the lanes of vector registers move as each does alone.

use fearless_simd::{Level, Simd};
use mrbd::model::Wall;
use mrbd::simulate::{Accuracy, Response, Shaking, Simulator, simulate, simulate_side_by_side_at};
use rand::RngExt;

use crate::walls::{any_effects, any_restitution, any_shaking, any_wall, made, rng};

/// Walls of all kinds, cracked and not, most without effects, each under a shaking of its own.
fn anything(count: u64) -> Vec<(Wall, Shaking, Accuracy)> {
    let one = |index| {
        let mut rng = rng(83, index);
        let mut wall = any_wall(&mut rng);
        if rng.random_bool(0.2) {
            wall.effects = any_effects(&mut rng, &wall);
        }
        wall.restitution = any_restitution(&mut rng, 1.0);
        let vertical = rng.random_bool(0.5);
        let shaking = any_shaking(&mut rng, &wall, vertical);
        (made(&wall), shaking, Accuracy { tolerance: 10_f64.powf(-rng.random_range(3.0..10.0)) })
    };
    (0..count).map(one).collect()
}

fn side_by_side<'a>(runs: impl Iterator<Item = &'a (Wall, Shaking, Accuracy)>) -> Vec<Response> {
    side_by_side_at(Level::new(), runs)
}

fn side_by_side_at<'a>(
    level: Level,
    runs: impl Iterator<Item = &'a (Wall, Shaking, Accuracy)>,
) -> Vec<Response> {
    let mut runs = runs.enumerate();
    let next = || {
        let (index, (wall, shaking, accuracy)) = runs.next()?;
        Some((index, Simulator::new(wall, shaking, *accuracy).prepared()))
    };
    let mut told = Vec::new();
    simulate_side_by_side_at(level, next, |index, response| told.push((index, response)));
    told.sort_by_key(|(index, _)| *index);
    told.into_iter().map(|(_, response)| response).collect()
}

#[test]
fn analytic_walls_side_by_side_move_as_alone_to_the_bit() {
    let runs = anything(400);
    let alone: Vec<Response> = runs.iter().map(|(wall, shaking, of)| simulate(wall, shaking, *of)).collect();
    let collapsed = alone.iter().filter(|response| response.collapsed()).count();
    let impacts: u64 = alone.iter().map(|response| response.impacts.total()).sum();
    assert!(collapsed > 20 && impacts > 5000, "{collapsed} collapses, {impacts} impacts");
    // All numbers are finite, so that equal ones have the same bits but for the sign of a zero.
    assert!(side_by_side(runs.iter()) == alone);
    // By every set of vector instructions of this processor.
    for level in levels() {
        assert!(side_by_side_at(level, runs.iter()) == alone, "{level:?}");
    }
    // In other company: from the last to the first, two, and one alone.
    let mut backwards = side_by_side(runs.iter().rev());
    backwards.reverse();
    assert!(backwards == alone);
    for few in [1, 2, 5] {
        assert!(side_by_side(runs.iter().take(few)) == alone[..few]);
    }
    assert!(side_by_side(runs.iter().take(0)).is_empty());
}

/// The sets of vector instructions that this processor has.
fn levels() -> Vec<Level> {
    let best = Level::new();
    #[cfg(target_arch = "x86_64")]
    let older =
        [best.as_sse2().map(Simd::level), best.as_sse4_2().map(Simd::level), best.as_avx2().map(Simd::level)];
    #[cfg(not(target_arch = "x86_64"))]
    let older = [Some(Level::baseline())];
    older.into_iter().flatten().chain([best]).collect()
}
