//! Joints that give: their static law, their energy, their limits, and walls that rock on them.

use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{
    Bed, Contact, Effect, G_M_S2, Pivot, RockingWall, State, Vector, Wall, WallParameters,
};
use mrbd_kernel::simulate::{History, Shaking, simulate};

use super::{TIGHT, block, late_at_upright_s, released, table_wall, wall};

fn bed_at(joint: &str, stiffness_pa_per_m: f64, damping_s: f64) -> Effect {
    Effect::with_parameters(&format!("compliant_joint.{joint}"), &[stiffness_pa_per_m, damping_s])
        .expect("a bed within its bounds")
}

fn the_bed(stiffness_pa_per_m: f64) -> Bed {
    let bedded = wall(block(vec![bed_at("ground", stiffness_pa_per_m, 0.0)], 0.0));
    bedded.beds()[0].expect("a bed at the ground")
}

#[test]
fn analytic_the_static_law_and_its_energy_are_the_closed_forms() {
    for k in [4e7, 1e9, 1e11] {
        let bed = the_bed(k);
        let (n, l, b) = (bed.load_n, bed.length_m, bed.width_m);
        let phi_c = 2.0 * n / (k * l * b * b);
        for times in [0.0, 0.3, 0.999, 1.001, 2.0, 30.0, 1e3] {
            let phi = times * phi_c;
            let c = (2.0 * n / (k * l * phi)).sqrt();
            let (contact, moment, energy) = match times < 1.0 {
                true => {
                    let pressed = n * n / (2.0 * k * b * l);
                    (b, k * l * b.powi(3) * phi / 12.0, pressed + k * l * b.powi(3) * phi * phi / 24.0)
                }
                false => (c, n * (b / 2.0 - c / 3.0), n * c * phi / 3.0),
            };
            // A few roundings of each.
            let same = |found: f64, expected: f64| (found - expected).abs() <= 1e-14 * expected.abs();
            assert!(same(bed.contact_m(phi), contact), "contact at {times} φ_c");
            assert!(same(bed.moment_n_m(phi), moment), "moment at {times} φ_c");
            assert!(same(-bed.moment_n_m(-phi), moment), "moment at -{times} φ_c");
            assert!(same(bed.energy_j(phi), energy), "energy at {times} φ_c");
        }
    }
}

#[test]
fn analytic_the_moment_is_the_slope_of_weight_and_bed() {
    // With N constant: d/dφ of N (b/2 - c) φ and of the bed's energy is the moment.
    let bed = the_bed(3e8);
    for times in [0.5, 1.5, 4.0, 50.0] {
        let phi = times * bed.full_contact_rad();
        let risen = |phi: f64| match phi <= bed.full_contact_rad() {
            true => 0.0,
            false => bed.load_n * (bed.width_m / 2.0 - bed.contact_m(phi)) * phi,
        };
        let h = 1e-5 * phi;
        let stored = |phi: f64| risen(phi) + bed.energy_j(phi);
        let slope = (stored(phi + h) - stored(phi - h)) / (2.0 * h);
        // The difference's own error, h², and roundings over h.
        assert!((slope / bed.moment_n_m(phi) - 1.0).abs() < 1e-9, "{times}: {slope}");
    }
}

#[test]
fn analytic_a_slow_push_follows_the_static_law() {
    // Under a ground acceleration a that does not change, M(φ) = W (h/2) φ - m a h/2. Cosines differ by
    // φ²/2, and the lever of the push from h/2 by z φ with z at most b/2.
    for k in [4e7, 1e9] {
        let bedded = wall(block(vec![bed_at("ground", k, 0.0)], 0.0));
        let bed = bedded.beds()[0].expect("a bed");
        let rocking = RockingWall::new(&bedded);
        for times in [0.5, 2.0, 5.0] {
            let phi = times * bed.full_contact_rad();
            let arm_kg_m = 3614.0 * 3.984 / 2.0;
            let a_m_s2 = G_M_S2 * phi - bed.moment_n_m(phi) / arm_kg_m;
            let contact = Contact { ground: bed.pivot(phi), crack: Pivot::Closed };
            let state = State { theta: [phi; 2], omega: [0.0; 2] };
            let theta_dd = rocking.rate(contact, &state, Vector { x: a_m_s2, y: 0.0 }).theta_dd[0];
            // Of the acceleration that the push would give alone, 3 a/(2 h).
            let alone = 1.5 * a_m_s2.abs() / 3.984;
            assert!(
                theta_dd.abs() < alone * (2.0 * phi * phi + phi * 0.291 / 3.984),
                "{k:e} {times}: {theta_dd} of {alone}"
            );
        }
    }
}

#[test]
fn analytic_the_quarter_period_is_the_quadrature_of_the_energy() {
    for (k, theta_0) in [(5e7, 0.03), (5e7, 0.008), (1e9, 0.01)] {
        let parameters = block(vec![bed_at("ground", k, 0.0)], theta_0);
        let bedded = wall(parameters.clone());
        let rocking = RockingWall::new(&bedded);
        let bed = bedded.beds()[0].expect("a bed");
        let energy = |theta: f64, omega: f64| {
            let contact = Contact { ground: bed.pivot(theta), crack: Pivot::Closed };
            rocking.energy_j(contact, &State { theta: [theta; 2], omega: [omega; 2] })
        };
        let [late_s, quarter_s] = late_at_upright_s(&bedded, theta_0, energy, 1.0);
        assert!(late_s.abs() < 1e-5 * quarter_s, "{k:e}: {late_s} s of {quarter_s}");
    }
}

#[test]
fn analytic_the_ledger_closes_on_beds_alone_and_beside_sharp_edges() {
    for joint in ["ground", "crack", "both"] {
        for (k, damping_s) in [(1e8, 0.0), (1e9, 4e-4), (1e10, 4e-4), (1e11, 0.0)] {
            let effects = vec![bed_at(joint, k, damping_s)];
            let (response, _) = released(table_wall(effects, [0.02, -0.015]), 2.0);
            // As sharp edges at this tolerance, times the stiffness of beds beside that of weights.
            assert!(response.energy.residual() < 1e-8, "{joint} {k:e}: {:e}", response.energy.residual());
            assert_eq!(response.energy.effect_loss_j > 0.0, damping_s > 0.0, "{joint} {k:e}");
            assert_eq!(response.outcome.name(), "stood");
        }
    }
}

#[test]
fn analytic_a_wall_on_ever_stiffer_beds_moves_as_on_sharp_edges() {
    let farthest = |parameters: WallParameters, sharp: &History| {
        let (_, history) = released(parameters, 1.0);
        let rows = history.rows.iter().zip(&sharp.rows);
        let apart = rows.flat_map(|(a, b)| [0, 1].map(|i| (a.theta_rad[i] - b.theta_rad[i]).abs()));
        apart.fold(0.0, f64::max)
    };
    let of_block = |k: f64| block(vec![bed_at("ground", k, 0.0)], 0.03);
    let of_wall = |k: f64| table_wall(vec![bed_at("both", k, 0.0)], [0.02, 0.03]);
    let cases: [(WallParameters, &dyn Fn(f64) -> WallParameters); 2] =
        [(block(Vec::new(), 0.03), &of_block), (table_wall(Vec::new(), [0.02, 0.03]), &of_wall)];
    for (sharp, on_beds) in cases {
        let (_, sharp) = released(sharp, 1.0);
        let apart = [1e10, 1e11, 1e12].map(|k| farthest(on_beds(k), &sharp));
        // The edge is b sqrt(φ_c/φ) wide, and a passage keeps r/(r + 0.02) of what an impact takes: both fall with the square root of
        // the compliance at last. Of slow passages r is still about 0.02 at 1e12 Pa/m, as on rows of springs (docs/model.md).
        assert!(apart.windows(2).all(|pair| pair[1] < 0.9 * pair[0]), "{apart:?}");
    }
    // The largest stiffness is the sharp edge itself, to the bit.
    let (sharp, _) = released(table_wall(Vec::new(), [0.02, 0.03]), 1.0);
    let (stiffest, _) = released(of_wall(1e13), 1.0);
    assert_eq!(stiffest, sharp);
}

#[test]
fn analytic_a_mirrored_wall_on_beds_moves_as_its_mirror() {
    let effects = vec![bed_at("ground", 1e9, 1e-4), bed_at("crack", 3e8, 0.0)];
    let (one, _) = released(table_wall(effects.clone(), [0.02, -0.01]), 2.0);
    let (other, _) = released(table_wall(effects, [-0.02, 0.01]), 2.0);
    assert_eq!(one.theta_max_rad.map(|peak| peak.value), other.theta_max_rad.map(|peak| -peak.value));
    assert_eq!(one.energy, other.energy);
}

#[test]
fn analytic_a_still_ground_leaves_a_wall_on_beds_at_rest() {
    let quiet = Some(Accelerogram::new(0.01, vec![0.0; 100]).expect("samples"));
    let shaking = Shaking { horizontal: quiet, vertical: None, tail_s: 1.0 };
    let response = simulate(&wall(table_wall(vec![bed_at("both", 1e9, 0.0)], [0.0; 2])), &shaking, TIGHT);
    assert_eq!(response.theta_max_rad.map(|peak| peak.value), [0.0; 2]);
}

#[test]
fn rejects_beds_that_cannot_be() {
    let refused = |parameters: WallParameters| Wall::new(parameters).expect_err("no such wall").to_string();
    for k in [0.0, -1.0, f64::NAN] {
        assert!(Effect::with_parameters("compliant_joint.ground", &[k, 0.0]).is_err(), "{k}");
    }
    let twice = vec![bed_at("ground", 1e9, 0.0), bed_at("both", 1e9, 0.0)];
    assert!(refused(table_wall(twice, [0.0; 2])).contains("one bed in a joint"));
    assert!(refused(block(vec![bed_at("both", 1e9, 0.0)], 0.0)).contains("a wall without one"));
    let soft = refused(block(vec![bed_at("ground", 1e6, 0.0)], 0.0));
    assert!(soft.contains("falls by its own weight"), "{soft}");
    let unheld =
        WallParameters { stiffness_n_per_m: 0.0, ..table_wall(vec![bed_at("crack", 1e6, 0.0)], [0.0; 2]) };
    assert!(refused(unheld).contains("falls by its own weight"));
}
