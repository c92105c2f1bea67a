//! What laws at the top carry along a measured motion.

use mrbd_kernel::model::{CarriedStates, Contact, Pair, RockingWall, TopMove};

/// Times (s) and displacements of the top (m) of a motion by times and rotations (rad). Over samples that were not measured the top
/// stays, and then moves at once.
pub fn top_path(motion: impl Iterator<Item = (f64, Pair)>, wall: &RockingWall) -> Vec<[f64; 2]> {
    let mut x_c = 0.0;
    let at = |(time_s, theta): (f64, Pair)| {
        if theta.iter().all(|t| t.is_finite()) {
            x_c = wall.top_displacement_m(Contact::of_rotations(theta), theta);
        }
        [time_s, x_c]
    };
    motion.map(at).collect()
}

/// The carried states of the formulas of a wall at every point of such a path, from their start at the first on.
pub fn carried_along(path: &[[f64; 2]], wall: &RockingWall) -> Vec<CarriedStates> {
    let (mut carried, mut largest_m) = (wall.carried_at_start(), 0.0_f64);
    let steps = path.windows(2).map(|ends| {
        let [[from_s, from_m], [to_s, to_m]] = [ends[0], ends[1]];
        largest_m = largest_m.max(from_m.abs());
        carried = wall.carried_after(&carried, &TopMove { from_m, to_m, largest_m, time_s: to_s - from_s });
        carried
    });
    std::iter::once(wall.carried_at_start()).chain(steps).take(path.len()).collect()
}
