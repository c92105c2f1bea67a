//! Coefficients of impacts that depend on the speed, as formulas.

use mrbd_formula::{Formula, Place};
use mrbd_kernel::model::{Contact, Effect, Pivot, RockingWall, State, Touching, Wall, WallParameters};
use mrbd_kernel::simulate::{Simulator, simulate, simulate_side_by_side};

use super::{ACCURACY, formula, run, shaking, table_wall, with_formulas};

fn fades() -> Formula {
    formula(Place::Impacts, "exp(-b*u)", &[("b", 0.8, "s/m")])
}

#[test]
fn analytic_a_constant_factor_is_the_effect_of_the_catalogue_to_the_bit() {
    let factors = Effect::with_parameters("impact_dissipation", &[0.93; 8]).expect("an effect");
    let named = Wall::new(WallParameters { effects: vec![factors], ..table_wall() }).expect("a wall");
    let written = with_formulas(&[formula(Place::Impacts, "f", &[("f", 0.93, "1")])], table_wall());
    assert_eq!(format!("{:?}", run(&written)), format!("{:?}", run(&named)));
}

#[test]
fn analytic_the_catalogues_fading_is_its_formula_to_the_bit() {
    let fading = Effect::with_parameters("impact_fading", &[0.8]).expect("an effect");
    let named = Wall::new(WallParameters { effects: vec![fading], ..table_wall() }).expect("a wall");
    let written = with_formulas(&[fades()], table_wall());
    assert_eq!(format!("{:?}", run(&written)), format!("{:?}", run(&named)));
}

/// C_6: a wall that rocks as one block passes from one corner to the other, 3a to 3b.
#[test]
fn analytic_the_coefficient_is_that_of_the_edge_that_comes_down() {
    let uncracked = WallParameters { crack_height_m: None, ..table_wall() };
    let weight_n = (uncracked.mass_kg + uncracked.diaphragm_mass_kg) * 9.81;
    let own = [("b", 0.8, "s/m"), ("s", 0.2, "s"), ("n", 9e3, "N")];
    let law = formula(Place::Impacts, "exp(-b*u - s*w - N/n)", &own);
    let constant = RockingWall::new(&Wall::new(uncracked.clone()).expect("a wall"));
    let written = RockingWall::new(&with_formulas(&[law], uncracked.clone()));
    let from = Contact { ground: Pivot::Right, crack: Pivot::Closed };
    let touching = Touching { ground: true, crack: false };
    for rate_rad_s in [0.01, 0.1, 1.0] {
        let state = State { theta: [0.0; 2], omega: [-rate_rad_s; 2] };
        let [kept, found] = [&constant, &written]
            .map(|wall| wall.impact(from, touching, &state).expect("one outcome").omega[0] / rate_rad_s);
        let u_m_s = uncracked.lower_width_m * rate_rad_s;
        let expected = kept * (-0.8 * u_m_s - 0.2 * rate_rad_s - weight_n / 9e3).exp();
        // A few roundings of numbers below one.
        assert!(kept != 0.0 && (found - expected).abs() <= 1e-14, "{found} and {expected} at {u_m_s} m/s");
    }
}

#[test]
fn analytic_faster_impacts_lose_more_and_the_ledger_closes() {
    let [constant, fading] =
        [vec![], vec![fades()]].map(|formulas| run(&with_formulas(&formulas, table_wall())));
    assert!(fading.theta_max_rad[1].value < constant.theta_max_rad[1].value);
    assert!(fading.energy.residual() < 1e-7, "{}", fading.energy.residual());
}

#[test]
fn analytic_a_mirrored_record_mirrors_the_motion_and_rows_move_as_alone() {
    let wall = with_formulas(&[fades()], table_wall());
    let [there, mirrored] = [1.0, -1.0].map(|sign| simulate(&wall, &shaking(sign), ACCURACY));
    for i in 0..2 {
        let [a, b] = [&there, &mirrored].map(|response| response.theta_max_rad[i].value);
        assert_eq!(a, -b);
    }
    let walls = [wall, Wall::new(table_wall()).expect("a wall")];
    let mut waiting = walls.iter().enumerate();
    let mut next = || {
        let (index, wall) = waiting.next()?;
        Some((index, Simulator::new(wall, &shaking(1.0), ACCURACY).prepared()))
    };
    let mut beside = vec![None; 2];
    simulate_side_by_side(&mut next, &mut |index, response| beside[index] = Some(response));
    for (wall, beside) in walls.iter().zip(beside) {
        assert_eq!(format!("{beside:?}"), format!("{:?}", Some(simulate(wall, &shaking(1.0), ACCURACY))));
    }
}

#[test]
fn rejects_factors_that_are_none() {
    for (law, parts) in [
        (formula(Place::Impacts, "1 + b*u", &[("b", 1.0, "s/m")]), &["formulas.0.factor", "from 0 to 1"][..]),
        (formula(Place::Impacts, "1 - b*u", &[("b", 10.0, "s/m")]), &["from 0 to 1", "u from 0 to"]),
        (formula(Place::Impacts, "(u/s)**(-p)", &[("s", 1.0, "m/s"), ("p", 0.25, "1")]), &["from 0 to 1"]),
    ] {
        let refused = Wall::new(WallParameters { formulas: vec![law], ..table_wall() }).expect_err("refused");
        for part in parts {
            assert!(refused.to_string().contains(part), "{refused} without {part}");
        }
    }
    let wrong = Formula::parse("exp(-u)", Place::Impacts, &[]).expect_err("a speed is no pure number");
    assert!(wrong.to_string().contains("exp"), "{wrong}");
    // What never gets below nothing is a factor.
    with_formulas(&[formula(Place::Impacts, "max(0, 1 - b*u)", &[("b", 10.0, "s/m")])], table_wall());
}
