//! Energy: nothing is lost unaccounted for, and impacts that should not add any do not.

use mrbd_kernel::model::{ImpactLaw, RockingWall, State};
use mrbd_kernel::simulate::{Accuracy, Outcome, simulate};
use rand::RngExt;

use crate::matrix_model::MatrixWall;
use crate::walls::{any_effects, any_impact, any_restitution, any_shaking, any_wall, log_uniform, made, rng};

#[test]
fn analytic_the_ledger_balances() {
    let mut worst = 0.0_f64;
    let mut impacts = 0;
    for index in 0..1000 {
        let mut rng = rng(40, index);
        let mut wall = any_wall(&mut rng);
        wall.effects = any_effects(&mut rng, &wall);
        wall.restitution = any_restitution(&mut rng, 1.1);
        let vertical = rng.random_bool(0.5);
        let shaking = any_shaking(&mut rng, &wall, vertical);
        let response = simulate(&made(&wall), &shaking, Accuracy { tolerance: 1e-10 });
        assert!(!matches!(response.outcome, Outcome::Failed { .. }), "wall {index}: {:?}", response.outcome);
        let residual = response.energy.residual();
        assert!(residual.is_finite(), "wall {index}");
        worst = worst.max(residual);
        impacts += response.impacts.total();
    }
    eprintln!("energy residual: worst {worst:e} over 1000 runs and {impacts} impacts");
    // A hundred times the tolerance: that bounds rotations, and a spring a hundred times as stiff as the weight turns
    // an error of rotation into a hundred times its share of energy.
    assert!(worst <= 1e-8, "{worst:e}");
}

/// Gain of kinetic energy in an impact, relative to that before, by the matrix form.
fn gain(index: u64, most: f64, law: Option<ImpactLaw>) -> f64 {
    let mut rng = rng(41, index);
    let mut wall = any_wall(&mut rng);
    wall.restitution.capture_velocity_rad_s = log_uniform(&mut rng, 1e-9, 1.0);
    if let Some(law) = law {
        wall.restitution.law = law;
        wall.restitution.coefficients = [(); 8].map(|()| rng.random_range(0.0..most));
    }
    let rocking = RockingWall::new(&made(&wall));
    let matrices = MatrixWall::new(&wall);
    let (from, touching, state) = any_impact(&mut rng, rocking.wall(), 1e-3);
    let impact = rocking.impact(from, touching, &state).expect("one outcome");
    let before_j = matrices.kinetic_energy(from, &state);
    let after_j = matrices.kinetic_energy(impact.contact, &State { omega: impact.omega, ..state });
    (after_j - before_j) / before_j
}

/// The largest; NaN if there is one.
fn largest(gains: impl Iterator<Item = f64>) -> f64 {
    gains.fold(f64::MIN, |most, gain| if gain <= most || most.is_nan() { most } else { gain })
}

/// Roundings of two energies of a few dozen terms each.
const ROUNDINGS: f64 = 1e-13;

#[test]
fn analytic_plastic_impacts_add_no_energy() {
    let worst = largest((0..100_000).map(|index| gain(index, 1.0, None)));
    eprintln!("plastic: largest gain {worst:e}");
    assert!(worst <= ROUNDINGS, "{worst:e}");
}

#[test]
fn analytic_coefficients_up_to_one_add_no_energy() {
    for law in [ImpactLaw::Whole, ImpactLaw::Contact] {
        let worst = largest((0..100_000).map(|index| gain(index, 1.0, Some(law))));
        eprintln!("{}: largest gain {worst:e}", law.name());
        assert!(worst <= ROUNDINGS, "{}: {worst:e}", law.name());
    }
}

#[test]
fn analytic_coefficients_above_one_do_add_energy() {
    // The test above can fail: with coefficients up to 1.5 some impacts gain.
    for law in [ImpactLaw::Whole, ImpactLaw::Contact] {
        let gains = (0..10_000).filter(|&index| gain(index, 1.5, Some(law)) > 1e-3).count();
        eprintln!("{}: {gains} of 10000 gain", law.name());
        assert!(gains > 100, "{}: {gains}", law.name());
    }
}
