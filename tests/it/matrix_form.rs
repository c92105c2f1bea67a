//! The scalar kernel against the matrix form of the model's law, over walls, patterns and states of every kind.

use mrbd_kernel::model::{Contact, Joint, Pivot, RockingWall, State, WallParameters};
use rand_chacha::ChaCha8Rng;

use crate::matrix_model::MatrixWall;
use crate::walls::{any_effects, any_ground, any_impact, any_state, any_wall, made, rng};

const DRAWS: u64 = 20_000;

/// Some hundred operations a side, each rounding once: 1e-13 of the terms that are added up. The mass matrix
/// magnifies a rounding by its condition, which the checks take out by comparing forces, not accelerations.
const ROUNDINGS: f64 = 1e-13;

fn moving(contact: &Contact) -> bool {
    *contact != Contact::REST
}

fn drawn(rng: &mut ChaCha8Rng) -> (WallParameters, RockingWall, MatrixWall) {
    let mut parameters = any_wall(rng);
    parameters.effects = any_effects(rng, &parameters);
    let wall = RockingWall::new(&made(&parameters));
    let matrices = MatrixWall::new(&parameters);
    (parameters, wall, matrices)
}

#[test]
fn analytic_kernel_solves_the_matrix_equation() {
    let mut worst = 0.0_f64;
    for index in 0..DRAWS {
        let mut rng = rng(1, index);
        let (_, wall, matrices) = drawn(&mut rng);
        for contact in Contact::ALL.into_iter().filter(moving) {
            let state = any_state(&mut rng, wall.wall(), contact);
            let ground = any_ground(&mut rng);
            let theta_dd = wall.rate(contact, &state, ground).theta_dd;
            let (forcing, size) = matrices.forcing(contact, &state, ground);
            let mass = matrices.mass_matrix(contact, state.theta);
            let inertial = mass * nalgebra::Vector2::from(theta_dd);
            let size = size + mass.abs() * nalgebra::Vector2::from(theta_dd).abs();
            let s = MatrixWall::freedom(contact);
            for column in s.column_iter() {
                let project = |v: &nalgebra::Vector2<f64>| column[0] * v[0] + column[1] * v[1];
                worst = worst.max((project(&inertial) - project(&forcing)).abs() / project(&size));
            }
            // What a contact state does not leave free does not move by itself.
            match contact.pattern_number() {
                Some(3) => assert_eq!(theta_dd[0], theta_dd[1]),
                Some(4) => assert_eq!(theta_dd[0], 0.0),
                _ => {}
            }
        }
    }
    eprintln!("equation of motion: {worst:e}");
    assert!(worst <= ROUNDINGS, "{worst:e}");
}

#[test]
fn analytic_accelerations_agree_with_the_matrix_solution() {
    let mut worst = 0.0_f64;
    for index in 0..DRAWS {
        let mut rng = rng(2, index);
        let (_, wall, matrices) = drawn(&mut rng);
        for contact in Contact::ALL.into_iter().filter(moving) {
            let state = any_state(&mut rng, wall.wall(), contact);
            let ground = any_ground(&mut rng);
            let found = wall.rate(contact, &state, ground).theta_dd;
            let expected = matrices.theta_dd(contact, &state, ground);
            let mass = matrices.mass_matrix(contact, state.theta);
            let (_, size) = matrices.forcing(contact, &state, ground);
            // A rounding of the terms, through the inverse of the mass matrix.
            let inverse = mass.try_inverse().expect("a positive mass matrix").abs();
            let reach = inverse * size;
            for i in 0..2 {
                worst = worst.max((found[i] - expected[i]).abs() / reach[i]);
            }
        }
    }
    eprintln!("accelerations: {worst:e}");
    // As for the equation, with the solution's own roundings on top.
    assert!(worst <= 10.0 * ROUNDINGS, "{worst:e}");
}

#[test]
fn analytic_powers_and_kinetic_energy_agree_with_the_matrix_form() {
    let mut worst = [0.0_f64; 3];
    for index in 0..DRAWS {
        let mut rng = rng(3, index);
        let (_, wall, matrices) = drawn(&mut rng);
        for contact in Contact::ALL.into_iter().filter(moving) {
            let state = any_state(&mut rng, wall.wall(), contact);
            let ground = any_ground(&mut rng);
            let rate = wall.rate(contact, &state, ground);
            let [work_w, loss_w] = matrices.powers(contact, &state, ground);
            let kinetic_j = matrices.kinetic_energy(contact, &state);
            let still = State { omega: [0.0; 2], ..state };
            let found_j = wall.energy_j(contact, &state) - wall.energy_j(contact, &still);
            // By Cauchy and Schwarz the power is at most the root of 2 × mass × 2 × kinetic energy times the
            // acceleration; roundings are relative to that, not to a power that may cancel.
            let mass = matrices.weights().sum();
            let size_w = ground.x.hypot(ground.y) * (4.0 * mass * kinetic_j).sqrt();
            let stored_j = wall.energy_j(contact, &still).abs();
            worst[0] = worst[0].max((rate.ground_power_w - work_w).abs() / size_w);
            let most_w = matrices.most_damping(contact, &state) + f64::MIN_POSITIVE;
            worst[1] = worst[1].max((rate.loss_power_w - loss_w).abs() / most_w);
            worst[2] = worst[2].max((found_j - kinetic_j).abs() / (kinetic_j + stored_j));
        }
    }
    eprintln!("work, losses, kinetic energy: {worst:?}");
    assert!(worst.iter().all(|w| *w <= 10.0 * ROUNDINGS), "{worst:?}");
}

#[test]
fn analytic_joint_forces_balance_each_body() {
    let mut worst = 0.0_f64;
    for index in 0..DRAWS {
        let mut rng = rng(4, index);
        let (parameters, wall, matrices) = drawn(&mut rng);
        for contact in Contact::ALL {
            let state = any_state(&mut rng, wall.wall(), contact);
            let ground = any_ground(&mut rng);
            let theta_dd = wall.rate(contact, &state, ground).theta_dd;
            let found = wall.joint_forces(contact, &state, theta_dd, ground);
            let expected = matrices.through_joints(contact, &state, theta_dd, ground);
            let (_, size) = matrices.forcing(contact, &state, ground);
            let moments = size.sum()
                + (matrices.mass_matrix(contact, state.theta) * nalgebra::Vector2::from(theta_dd))
                    .abs()
                    .sum();
            // Moments over the narrowest joint are the largest forces that are added up.
            let forces = moments / parameters.lower_width_m.min(parameters.upper_width_m);
            for (joint, found, expected) in
                [(Joint::Ground, found.ground, expected[0]), (Joint::Crack, found.crack, expected[1])]
            {
                let corners = found.corners(matrices.width(joint));
                let expected_corners = matrices.corners(joint, state.theta, &expected);
                for side in 0..2 {
                    worst = worst.max((corners[side] - expected_corners[side]).abs() / forces);
                }
                worst = worst.max((found.moment - expected.moment).abs() / moments);
            }
        }
    }
    eprintln!("joint forces: {worst:e}");
    assert!(worst <= ROUNDINGS, "{worst:e}");
}

#[test]
fn analytic_a_lifted_corner_carries_nothing() {
    let mut worst = 0.0_f64;
    for index in 0..DRAWS {
        let mut rng = rng(5, index);
        let parameters = any_wall(&mut rng);
        let wall = RockingWall::new(&made(&parameters));
        let matrices = MatrixWall::new(&parameters);
        for contact in Contact::ALL.into_iter().filter(moving) {
            let state = any_state(&mut rng, wall.wall(), contact);
            let ground = any_ground(&mut rng);
            let theta_dd = wall.rate(contact, &state, ground).theta_dd;
            let found = wall.joint_forces(contact, &state, theta_dd, ground);
            let (_, size) = matrices.forcing(contact, &state, ground);
            for (joint, force) in [(Joint::Ground, found.ground), (Joint::Crack, found.crack)] {
                let [left, right] = force.corners(matrices.width(joint));
                let lifted = match contact.at(joint) {
                    Pivot::Closed => continue,
                    Pivot::Right => left,
                    Pivot::Left => right,
                };
                worst = worst.max(lifted.abs() * matrices.width(joint) / size.sum());
            }
        }
    }
    eprintln!("lifted corners: {worst:e}");
    // Solving for the accelerations and adding up the forces again rounds some hundred times each.
    assert!(worst <= 10.0 * ROUNDINGS, "{worst:e}");
}

#[test]
fn analytic_impacts_are_the_matrix_projection() {
    let mut worst = 0.0_f64;
    for index in 0..10 * DRAWS {
        let mut rng = rng(6, index);
        let mut parameters = any_wall(&mut rng);
        parameters.restitution.capture_velocity_rad_s = 0.0;
        let wall = RockingWall::new(&made(&parameters));
        let matrices = MatrixWall::new(&parameters);
        let (from, touching, state) = any_impact(&mut rng, wall.wall(), 1e-3);
        let impact = wall.impact(from, touching, &state).expect("one outcome");
        let expected = matrices.after_impact(from, impact.contact, &state);
        let mass = matrices.mass_matrix(impact.contact, state.theta);
        let inverse = mass.try_inverse().expect("a positive mass matrix").abs();
        // Roundings of the momenta before, through the inverse of the mass matrix.
        let before = matrices.jacobian(from, state.theta) * nalgebra::Vector2::from(state.omega);
        let momenta = matrices.jacobian(impact.contact, state.theta).abs().transpose()
            * before.abs().component_mul(&matrices.weights());
        let reach = inverse * momenta;
        for i in 0..2 {
            worst = worst.max((impact.omega[i] - expected[i]).abs() / reach[i]);
        }
        let after = State { omega: expected, ..state };
        let [before_j, after_j] =
            [matrices.kinetic_energy(from, &state), matrices.kinetic_energy(impact.contact, &after)];
        worst = worst.max((impact.loss_j - (before_j - after_j)).abs() / before_j);
    }
    eprintln!("impacts: {worst:e}");
    assert!(worst <= 10.0 * ROUNDINGS, "{worst:e}");
}
