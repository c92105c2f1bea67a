//! Rotations from displacement readings: exact kinematics of the two bodies, inverted.
//!
//! With s the sign of the open joint, a point of the lower body at height y moves by
//! u = y sin θ_1 + s b_1/2 (1 - cos θ_1), a point of the upper body by the displacement of its pivot and
//! (y - h_1) sin θ_2 + s_2 b_2/2 (1 - cos θ_2), all relative to the ground (model section 3).

use mrbd_kernel::model::WallParameters;

/// Steps of Newton's method: rotations are below a quarter turn, so the error is squared five times or more.
const STEPS: usize = 12;

/// θ_1, rad, from the displacement of the lower body at a height, m; NaN stays NaN.
pub fn lower_rotation_rad(wall: &WallParameters, height_m: f64, displacement_m: f64) -> f64 {
    // b_1/2 and u have the same sign as θ_1, so the reading itself tells the corner.
    solve(height_m, displacement_m.signum() * 0.5 * wall.lower_width_m, displacement_m)
}

/// θ_2, rad, from θ_1 and the displacement of the upper body at a height, m; NaN stays NaN.
pub fn upper_rotation_rad(wall: &WallParameters, height_m: f64, displacement_m: f64, theta1: f64) -> f64 {
    let Some(h1) = wall.crack_height_m else { return theta1 };
    let half_1 = theta1.signum() * 0.5 * wall.lower_width_m;
    // The crack opens to the side where turning with the lower body falls short of the reading.
    let together = h1 * theta1.sin() + half_1 * (1.0 - theta1.cos()) + (height_m - h1) * theta1.sin();
    let half_2 = (displacement_m - together).signum() * 0.5 * wall.upper_width_m;
    let pivot = half_1 + (half_2 - half_1) * theta1.cos() + h1 * theta1.sin() - half_2;
    solve(height_m - h1, half_2, displacement_m - pivot)
}

/// The rotation at which arm sin θ + half (1 - cos θ) equals u.
fn solve(arm: f64, half: f64, u: f64) -> f64 {
    let mut theta = u / arm;
    for _ in 0..STEPS {
        let residual = arm * theta.sin() + half * (1.0 - theta.cos()) - u;
        theta -= residual / (arm * theta.cos() + half * theta.sin());
    }
    theta
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrbd_kernel::model::{Restitution, RockingWall, Wall};

    fn table_wall() -> WallParameters {
        WallParameters {
            thickness_m: 0.291,
            height_m: 3.984,
            crack_height_m: Some(2.191),
            length_m: 1.5,
            mass_kg: 3614.0,
            lower_width_m: 0.271,
            upper_width_m: 0.281,
            diaphragm_mass_kg: 179.0,
            carriage_mass_kg: 663.0,
            stiffness_n_per_m: 37000.0,
            eccentricity_m: 0.0,
            restitution: Restitution::default(),
            collapse_rotation_ratio: 2.0,
            initial_rotation_rad: [0.0, 0.0],
            effects: Vec::new(),
        }
    }

    #[test]
    fn analytic_rotations_come_back_from_the_models_own_displacements() {
        let p = table_wall();
        let wall = RockingWall::new(&Wall::new(p.clone()).expect("a possible wall"));
        for theta in [[0.05, 0.08], [0.05, 0.01], [-0.03, 0.02], [-0.03, -0.05], [0.1, 0.1], [0.0, 0.02]] {
            let contact = mrbd_kernel::model::Contact::of_rotations(theta);
            let top = wall.top_displacement_m(contact, theta);
            let crack = 2.191 * theta[0].sin()
                + 0.5
                    * 0.271
                    * theta[0].abs()
                    * theta[0].tan().signum()
                    * ((1.0 - theta[0].cos()) / theta[0].abs().max(1e-300));
            let theta1 = lower_rotation_rad(&p, 2.191, crack);
            // Roundings of a displacement of up to half a metre, over an arm of some metres.
            assert!((theta1 - theta[0]).abs() < 1e-14, "{theta:?}: {theta1}");
            let theta2 = upper_rotation_rad(&p, 3.984, top, theta1);
            assert!((theta2 - theta[1]).abs() < 1e-13, "{theta:?}: {theta2}");
        }
    }
}
