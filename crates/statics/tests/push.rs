//! Pushes against closed forms.

use mrbd_kernel::model::{Effect, G_M_S2, Wall, WallParameters};
use mrbd_statics::{Chain, Curve, Edges, Joint, Load, Mechanism, Point, Push, Restraint, Side};

fn wall(change: impl Fn(&mut WallParameters)) -> Wall {
    let mut parameters =
        WallParameters { crack_height_m: Some(1.5), ..WallParameters::strip(0.1, 3.0, 1800.0) };
    change(&mut parameters);
    Wall::new(parameters).expect("a wall")
}

fn push(wall: &Wall, restraint: Restraint, load: Load) -> Curve {
    let chain = Chain::of(wall, Edges::AsTheyAre, Side::Right);
    Push { chain, restraint, load, fallen_rad: wall.collapse_rotation_rad() }.curve()
}

/// Force at a displacement of the crack, linear between points.
fn force_n(curve: &Curve, crack_m: f64) -> f64 {
    let after = curve.points.iter().position(|point| point.crack_m >= crack_m).expect("a point so far");
    let [a, b] = [after - 1, after].map(|i| curve.points[i]);
    a.force_n + (b.force_n - a.force_n) * (crack_m - a.crack_m) / (b.crack_m - a.crack_m)
}

#[test]
fn analytic_a_held_wall_pushed_at_its_middle_follows_the_rigid_line() {
    // F/W = 2 (b/h)(1 - d/b) for small rotations; the largest is 2b/h = 0.067 rad, whose square is 0.4 %.
    let wall = wall(|_| {});
    let weight_n = wall.parameters().mass_kg * G_M_S2;
    let curve = push(&wall, Restraint::Held, Load::Crack);
    for share in [0.001, 0.1, 0.5, 0.9] {
        let line = 2.0 * (0.1 / 3.0) * (1.0 - share) * weight_n;
        let found = force_n(&curve, share * 0.1);
        assert!((found - line).abs() < 0.004 * 2.0 * (0.1 / 3.0) * weight_n, "{share}: {found} {line}");
    }
    let end = curve.end.expect("it falls");
    assert!((end.crack_m / 0.1 - 1.0).abs() < 0.004, "{}", end.crack_m);
    // From rest the largest force is that of virtual work: 1e-7 of the thickness is what the support gives.
    assert!((curve.peak.force_n / (2.0 * 0.1 / 3.0 * weight_n) - 1.0).abs() < 2e-6, "{}", curve.peak.force_n);
}

#[test]
fn analytic_a_held_wall_on_beds_follows_the_closed_form() {
    // Virtual work of small rotations: F h/2 = M_1(θ) + 2 M_2(2θ) - W h θ/2, N_1 = W, N_2 = W/2, d = θ h/2.
    let wall = wall(|_| {});
    let weight_n = wall.parameters().mass_kg * G_M_S2;
    for stiffness in [4e7, 1e9, 1e11] {
        let mut chain = Chain::of(&wall, Edges::Full, Side::Right);
        let [ground, crack] = [weight_n, weight_n / 2.0].map(|n| Joint::on_bed(0.1, n, stiffness, 1.0));
        chain.joints = [ground, crack];
        let fallen_rad = wall.collapse_rotation_rad();
        let curve = Push { chain, restraint: Restraint::Held, load: Load::Crack, fallen_rad }.curve();
        for share in [0.003, 0.02, 0.1, 0.3, 0.6] {
            let theta = share * 0.1 / 1.5;
            let moments = ground.moment_n_m(theta) + 2.0 * crack.moment_n_m(2.0 * theta);
            let line = (moments - weight_n * 3.0 * theta / 2.0) / 1.5;
            if line < 0.0 {
                // The softest bed has let it fall by then.
                assert!(
                    stiffness == 4e7 && share > 0.3 && curve.end.expect("it falls").crack_m < share * 0.1
                );
                continue;
            }
            let found = force_n(&curve, share * 0.1);
            // Squares of rotations as above; lines between points 1 % of b apart.
            assert!(
                (found - line).abs() < 0.005 * 2.0 * (0.1 / 3.0) * weight_n,
                "{stiffness} {share}: {found} {line}"
            );
        }
    }
}

#[test]
fn analytic_a_held_wall_on_the_rivals_of_beds_follows_their_closed_forms() {
    // As on beds. Three lines: F h/2 = N_1 τ b/2 + 2 N_2 τ b/2 - W h θ/2 where both joints carry the share τ.
    let weight_n = wall(|_| {}).parameters().mass_kg * G_M_S2;
    for (name, values) in [
        ("trilinear_joint.both", &[0.6, 0.002, 0.03, 0.0][..]),
        ("crushing_joint.both", &[1e9, 5e5, 0.0]),
        ("rounded_edges.both", &[0.02, 0.8]),
    ] {
        let effect = Effect::with_parameters(name, values).expect("an effect");
        let wall = wall(|p| p.effects = vec![effect]);
        let [ground, crack] = wall.joint_laws().map(|law| law.expect("a law in both"));
        let curve = push(&wall, Restraint::Held, Load::Crack);
        for share in [0.003, 0.02, 0.1, 0.3, 0.6] {
            let theta = share * 0.1 / 1.5;
            let moments = ground.moment_n_m(theta) + 2.0 * crack.moment_n_m(2.0 * theta);
            let line = (moments - weight_n * 3.0 * theta / 2.0) / 1.5;
            let found = force_n(&curve, share * 0.1);
            // Squares of rotations; lines between points 1 % of b apart.
            let apart = (found - line).abs() / (2.0 * (0.1 / 3.0) * weight_n);
            assert!(apart < 0.005, "{name} {share}: {found} {line}");
        }
    }
}

#[test]
fn analytic_beds_take_from_the_force_and_stiff_ones_nothing() {
    let wall = wall(|_| {});
    let peak = |stiffness: Option<f64>| {
        let mut chain = Chain::of(&wall, Edges::Full, Side::Right);
        if let Some(k) = stiffness {
            chain.joints = chain.joints.map(|joint| Joint::on_bed(joint.width_m, joint.load_n, k, 1.0));
        }
        let fallen_rad = wall.collapse_rotation_rad();
        Push { chain, restraint: Restraint::Held, load: Load::Crack, fallen_rad }.curve().peak.force_n
    };
    let [sharp, stiffest, stiff, soft] = [None, Some(1e15), Some(1e10), Some(4e7)].map(peak);
    assert!(soft < stiff && stiff < stiffest && stiffest < sharp, "{soft} {stiff} {stiffest} {sharp}");
    // The peak lacks c(φ)/b where it has fallen by d/b itself: what lacks goes with the cube root of 1/k.
    assert!(stiffest > 0.99 * sharp && soft < 0.8 * sharp, "{}", stiffest / sharp);
}

#[test]
fn analytic_a_free_wall_bears_the_least_of_its_mechanisms() {
    for crack_height_m in [0.5, 1.5, 2.5] {
        let wall = wall(|p| {
            p.crack_height_m = Some(crack_height_m);
            p.carriage_mass_kg = 200.0;
            p.upper_width_m = 0.06;
        });
        let chain = Chain::of(&wall, Edges::AsTheyAre, Side::Right);
        let alpha = |mechanism: Mechanism| mechanism.work(&chain).expect("a crack").alpha_0();
        let least = alpha(Mechanism::OneBlock).min(alpha(Mechanism::UpperBody));
        let curve = push(&wall, Restraint::Free, Load::Uniform);
        // The first displacement is 1e-9 of b, along a line that falls to zero over about b.
        assert!((curve.peak.force_n / chain.pushing_n() / least - 1.0).abs() < 1e-8, "{crack_height_m}");
        let [theta_1, theta_2] = curve.points[60].theta_rad;
        let upper_alone = alpha(Mechanism::UpperBody) < alpha(Mechanism::OneBlock);
        assert!(if upper_alone { theta_1.abs() < 1e-12 } else { (theta_2 - theta_1).abs() < 1e-12 });
    }
}

#[test]
fn analytic_a_spring_leads_from_the_free_wall_to_the_held_one() {
    let peak = |stiffness_n_per_m: f64| {
        let wall = wall(|p| p.stiffness_n_per_m = stiffness_n_per_m);
        let curve = push(&wall, Restraint::of(&wall, Side::Right), Load::Uniform);
        curve.peak.force_n / (wall.parameters().mass_kg * G_M_S2)
    };
    let [free, soft, medium, stiff, stiffest] = [0.0, 1e3, 1e4, 1e5, 1e9].map(peak);
    assert!((free / (0.1 / 3.0) - 1.0).abs() < 1e-8 && (stiffest / (4.0 * 0.1 / 3.0) - 1.0).abs() < 1e-4);
    assert!(free < soft && soft < medium && medium < stiff && stiff < stiffest, "{soft} {medium} {stiff}");
    let wall = wall(|_| {});
    let held =
        push(&wall, Restraint::Held, Load::Uniform).peak.force_n / (wall.parameters().mass_kg * G_M_S2);
    assert!((held / (4.0 * 0.1 / 3.0) - 1.0).abs() < 2e-6, "{held}");
}

#[test]
fn analytic_the_work_of_the_push_is_stored_in_weights_springs_and_beds() {
    let wall = wall(|p| {
        p.stiffness_n_per_m = 30e3;
        p.diaphragm_mass_kg = 150.0;
        p.carriage_mass_kg = 80.0;
        p.eccentricity_m = 0.02;
    });
    let mut chain = Chain::of(&wall, Edges::AsTheyAre, Side::Right);
    chain.joints = chain.joints.map(|joint| Joint::on_bed(joint.width_m, joint.load_n, 1e9, 1.0));
    let restraint = Restraint::of(&wall, Side::Right);
    let fallen_rad = wall.collapse_rotation_rad();
    for load in [Load::Crack, Load::Uniform, Load::Top] {
        let curve = Push { chain, restraint: restraint.clone(), load, fallen_rad }.curve();
        let stored_j = |point: &Point| {
            let [theta_1, theta_2] = point.theta_rad;
            let phi = [theta_1, theta_2 - theta_1];
            let moves = chain.moves(point.theta_rad, phi.map(|phi| if phi < 0.0 { -1.0 } else { 1.0 }));
            // The bed's own share: its work less that of sharp edges, which lifts the weights.
            let beds: f64 = (0..2)
                .map(|i| {
                    chain.joints[i].work_j(phi[i]) - Joint::sharp(0.1, chain.joints[i].load_n).work_j(phi[i])
                })
                .sum();
            chain.lifted(&moves).by_m + 0.5 * 30e3 * point.top_m.powi(2) + beds
        };
        let work_j: f64 = curve
            .points
            .windows(2)
            .map(|pair| {
                0.5 * (pair[0].force_n + pair[1].force_n) * (pair[1].displacement_m - pair[0].displacement_m)
            })
            .sum();
        let stored = stored_j(curve.points.last().expect("points"));
        // Trapezia over steps of 1 % of b leave a share of about 1e-4.
        assert!((work_j / stored - 1.0).abs() < 1e-3, "{}: {work_j} {stored}", load.name());
    }
}

#[test]
fn analytic_the_side_of_the_push_matters_only_off_the_middle() {
    let peak = |eccentricity_m: f64, side: Side| {
        let wall = wall(|p| {
            p.diaphragm_mass_kg = 200.0;
            p.eccentricity_m = eccentricity_m;
        });
        let chain = Chain::of(&wall, Edges::AsTheyAre, side);
        let restraint = Restraint::of(&wall, side);
        Push { chain, restraint, load: Load::Top, fallen_rad: wall.collapse_rotation_rad() }
            .curve()
            .peak
            .force_n
    };
    assert_eq!(peak(0.0, Side::Right), peak(0.0, Side::Left));
    assert_eq!(peak(0.03, Side::Right), peak(-0.03, Side::Left));
    // A load towards the side of the fall holds less.
    assert!(peak(0.03, Side::Right) < peak(0.03, Side::Left));
}
