//! The rivals of beds in a joint: three lines, a bed that crushes, edges worn round.

use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{
    Contact, CrushingJoint, Effect, G_M_S2, JointLaw, Pivot, RockingWall, RoundedEdges, State,
    TrilinearJoint, Wall,
};
use mrbd_kernel::simulate::{History, Shaking, Simulator, Start, simulate, simulate_sequence};

use super::{TIGHT, block, late_at_upright_s, released, table_wall, wall};

/// The strip of the paper's Table 1 without anything on its top: its width, m, and weight, N.
const WIDTH_M: f64 = 0.291;
const WEIGHT_N: f64 = 3614.0 * G_M_S2;

fn effect(name: &str, values: &[f64]) -> Effect {
    Effect::with_parameters(name, values).expect("an effect within its bounds")
}

fn lines_at(joint: &str, damping_s: f64) -> Effect {
    effect(&format!("trilinear_joint.{joint}"), &[0.7, 0.002, 0.012, damping_s])
}

fn crushing_at(joint: &str, damping_s: f64) -> Effect {
    effect(&format!("crushing_joint.{joint}"), &[1e9, 5e5, damping_s])
}

fn rounded_at(joint: &str) -> Effect {
    effect(&format!("rounded_edges.{joint}"), &[0.04, 3.0])
}

fn rivals(joint: &str) -> [Effect; 3] {
    [lines_at(joint, 0.0), crushing_at(joint, 0.0), rounded_at(joint)]
}

fn lines() -> TrilinearJoint {
    match wall(block(vec![lines_at("ground", 0.0)], 0.0)).joint_laws()[0] {
        Some(JointLaw::Trilinear(lines)) => lines,
        other => panic!("{other:?}"),
    }
}

fn crushing() -> CrushingJoint {
    match wall(block(vec![crushing_at("ground", 0.0)], 0.0)).joint_laws()[0] {
        Some(JointLaw::Crushing(bed)) => bed,
        other => panic!("{other:?}"),
    }
}

fn rounded() -> RoundedEdges {
    match wall(block(vec![rounded_at("ground")], 0.0)).joint_laws()[0] {
        Some(JointLaw::Rounded(edges)) => edges,
        other => panic!("{other:?}"),
    }
}

/// Within so many roundings of a number.
fn same(found: f64, expected: f64, roundings: f64) -> bool {
    (found - expected).abs() <= roundings * f64::EPSILON * expected.abs()
}

#[test]
fn analytic_three_lines_are_the_closed_form() {
    let joint = lines();
    let (n, b) = (joint.load_n, joint.width_m);
    let half = n * b / 2.0;
    let cases = [
        (0.0005, half * 0.7 * 0.25, 0.7 * b / 2.0 * 0.0005 * 0.0005 / 0.004),
        (0.002, half * 0.7, 0.7 * b / 2.0 * 0.001),
        (0.007, half * 0.85, b / 2.0 * (0.7 * 0.001 + 0.775 * 0.005)),
        (0.012, half, b / 2.0 * (0.7 * 0.001 + 0.85 * 0.01)),
        (0.05, half, b / 2.0 * (0.7 * 0.001 + 0.85 * 0.01 + 0.038)),
    ];
    for (phi, moment, rise) in cases {
        assert!(same(joint.moment_n_m(phi), moment, 8.0), "moment at {phi}: {}", joint.moment_n_m(phi));
        assert!(same(joint.moment_n_m(-phi), -moment, 8.0), "moment at -{phi}");
        assert!(same(joint.rise_m(phi), rise, 8.0), "rise at {phi}: {} {rise}", joint.rise_m(phi));
    }
}

#[test]
fn analytic_worn_edges_are_the_closed_form() {
    let joint = rounded();
    let (n, b, a, r) = (joint.load_n, joint.width_m, 0.04, 3.0);
    let end = f64::asin(a / r);
    assert_eq!(joint.end_rad(), Some(end));
    for phi in [1e-4, 0.005, 0.0133] {
        assert!(same(joint.moment_n_m(phi), n * (b / 2.0 - a + r * f64::sin(phi)), 4.0), "moment at {phi}");
        let rise = (b / 2.0 - a) * phi.sin() + 2.0 * r * (phi / 2.0).sin().powi(2);
        assert!(same(joint.rise_m(phi), rise, 8.0), "rise at {phi}");
    }
    for phi in [0.0134, 0.03, 0.2] {
        assert!(same(joint.moment_n_m(phi), n * b / 2.0, 1.0), "moment at {phi}");
        // About an edge that lies a depth of R (1 - cos φ_e) above the face.
        let rise = b / 2.0 * f64::sin(phi) - r * (1.0 - end.cos()) * f64::cos(phi);
        let at_end = (b / 2.0 - a) * end.sin() + r * (1.0 - end.cos());
        assert!(joint.rise_m(phi) > at_end && (joint.rise_m(phi) - rise).abs() < 2e-16, "rise at {phi}");
    }
}

#[test]
fn analytic_a_bed_that_crushes_integrated_spring_by_spring_gives_the_closed_form() {
    // Springs without tension that bear 0.85 f under a rigid face; the depth by bisection so that they carry N.
    let joint = crushing();
    let (n, b, l, k) = (joint.load_n, joint.width_m, joint.length_m, 1e9);
    let (steps, bears) = (400_000, 0.85 * 5e5);
    for phi in [1e-4, 3e-3, 4e-3, 0.01, 0.04] {
        let dx = b / f64::from(steps);
        let sums = |sunk: f64| {
            (0..steps).map(|i| -b / 2.0 + (f64::from(i) + 0.5) * dx).fold((0.0, 0.0), |(force, moment), x| {
                let pressure = (k * (sunk + phi * x)).clamp(0.0, bears) * l * dx;
                (force + pressure, moment + pressure * x)
            })
        };
        let [mut low, mut high] = [-0.02, 0.02];
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if sums(middle).0 > n { high = middle } else { low = middle }
        }
        // The rule of midpoints leaves a share of (dx/c)² and of dx beside the kink: c is 50 mm and more.
        let (found, expected) = (joint.moment_n_m(phi), sums(low).1);
        assert!((found / expected - 1.0).abs() < 1e-6, "{phi}: {found} {expected}");
    }
}

/// A number of a joint by its rotation, rad.
type Law<'a> = &'a dyn Fn(f64) -> f64;

#[test]
fn analytic_moments_are_the_slopes_of_weight_and_springs_and_of_what_is_lost() {
    let (lines, bed, edges) = (lines(), crushing(), rounded());
    let laws: [(&str, Law, Law); 3] = [
        ("lines", &|phi| lines.load_n * lines.rise_m(phi), &|phi| lines.moment_n_m(phi)),
        ("crushing", &|phi| bed.load_n * bed.rise_m(phi) + bed.stored_j(phi), &|phi| {
            bed.moment_n_m(phi) - bed.lost_n_m(phi)
        }),
        // The lever lies along the joint; the arc is so steep there beside it: N a sin φ.
        ("rounded", &|phi| edges.load_n * edges.rise_m(phi), &|phi| {
            let moment = edges.moment_n_m(phi);
            let along = edges.load_n * edges.flat_m() / 2.0 * (1.0 - phi.cos());
            match phi.abs() > 0.0133 {
                true => {
                    let above = 3.0 * (1.0 - edges.end_rad().expect("an end").cos());
                    moment * phi.cos() + edges.load_n * above * phi.sin()
                }
                false => moment - along,
            }
        }),
    ];
    for (name, potential_j, moment_n_m) in laws {
        for phi in [1e-5, 5e-4, 0.0015, 0.0035, 0.008, 0.02, 0.05] {
            let h = 1e-5 * phi;
            let slope = (potential_j(phi + h) - potential_j(phi - h)) / (2.0 * h);
            // The difference's own error, h², and roundings of a millimetre over h: 3e-9 at 1e-5 rad.
            let moment = moment_n_m(phi);
            assert!((slope / moment - 1.0).abs() < 3e-8, "{name} {phi}: {slope} {moment}");
        }
    }
}

#[test]
fn analytic_what_crushing_loses_is_what_the_toe_does_not_give_back() {
    // Out to m by the first way, back by the elastic one: the moments between the two ways are the energy lost.
    let bed = crushing();
    let crushed = CrushingJoint { crushed_rad: [0.02, 0.0], ..bed };
    assert!(same(crushed.moment_n_m(0.02_f64.sin()), bed.moment_n_m(0.02_f64.sin()), 16.0));
    let pieces = 20_000;
    let over = |law: &dyn Fn(f64) -> f64| {
        let at = |i: i32| 0.02_f64.sin() * (f64::from(i) + 0.5) / f64::from(pieces);
        (0..pieces).map(|i| law(at(i))).sum::<f64>() * 0.02_f64.sin() / f64::from(pieces)
    };
    let (out_j, back_j) = (over(&|phi| bed.moment_n_m(phi)), over(&|phi| crushed.moment_n_m(phi)));
    let lost_j = over(&|phi| bed.lost_n_m(phi));
    assert!((bed.lost_j(0.02_f64.sin()) / lost_j - 1.0).abs() < 1e-7);
    assert_eq!(crushed.lost_j(0.019), 0.0);
    // Back at 0 it leans towards what is left, and has sunk: that is kept beside what is lost.
    let kept_j = crushed.load_n * crushed.rise_m(0.0) + crushed.stored_j(0.0);
    assert!(
        lost_j > 1.0 && (out_j - back_j - lost_j - kept_j).abs() < 1e-4 * lost_j,
        "{out_j} {back_j} {lost_j}"
    );
}

#[test]
fn analytic_limits_are_the_laws_they_narrow_to() {
    let (bed, joint) = (effect("compliant_joint.ground", &[1e9, 0.0]), crushing());
    // A strength that is never reached: the elastic bed, to the bit.
    let strong = effect("crushing_joint.ground", &[1e9, 1e9, 0.0]);
    let runs = [bed, strong].map(|effect| released(table_wall(vec![effect], [0.02, -0.015]), 1.0).0);
    assert_eq!(runs[0], runs[1]);
    // Far beyond where it begins, the crushed corner of the stress block: N (b - A)/2.
    let end = joint.load_n * (joint.width_m - joint.block_m()) / 2.0;
    assert!((joint.moment_n_m(0.9) / end - 1.0).abs() < 1e-5);
    // Lines that end at once, edges that are hardly worn: sharp edges.
    let farthest = |effects: Vec<Effect>, sharp: &History| {
        let (_, history) = released(table_wall(effects, [0.02, 0.03]), 1.0);
        let rows = history.rows.iter().zip(&sharp.rows);
        rows.flat_map(|(a, b)| [0, 1].map(|i| (a.theta_rad[i] - b.theta_rad[i]).abs())).fold(0.0, f64::max)
    };
    let (_, sharp) = released(table_wall(Vec::new(), [0.02, 0.03]), 1.0);
    for size in [&[1e-4, 1e-5, 1e-6, 1e-7][..], &[1e-3, 1e-4, 1e-5]] {
        let of = |x: f64| match size.len() {
            4 => effect("trilinear_joint.both", &[1.0, x, 0.0, 0.0]),
            _ => effect("rounded_edges.both", &[x, 100.0 * x]),
        };
        let apart: Vec<f64> = size.iter().map(|x| farthest(vec![of(*x)], &sharp)).collect();
        // A tenth of what is worn takes at least half of the distance away; of lines less, for passages keep r/(r + 0.02) of what an
        // impact takes.
        let most = if size.len() == 4 { 0.9 } else { 0.5 };
        assert!(apart.windows(2).all(|pair| pair[1] < most * pair[0]), "{apart:?}");
    }
}

#[test]
fn analytic_quarter_periods_are_the_quadrature_of_the_energy() {
    for (effect, theta_0) in [
        (lines_at("ground", 0.0), 0.03),
        (lines_at("ground", 0.0), 0.008),
        (rounded_at("ground"), 0.01),
        (crushing_at("ground", 0.0), 0.003),
    ] {
        let bedded = wall(block(vec![effect], theta_0));
        let law = bedded.joint_laws()[0].expect("a law");
        let rocking = RockingWall::new(&bedded);
        let energy = |theta: f64, omega: f64| {
            let side = if law.gives() { law.pivot(theta) } else { Pivot::Right };
            let contact = Contact { ground: side, crack: Pivot::Closed };
            rocking.energy_j(contact, &State { theta: [theta; 2], omega: [omega; 2] })
        };
        let [late_s, quarter_s] = late_at_upright_s(&bedded, theta_0, energy, 0.9999);
        assert!(late_s.abs() < 1e-5 * quarter_s, "{effect:?}: {late_s} s of {quarter_s}");
    }
}

#[test]
fn analytic_the_ledger_closes_on_every_rival_alone_and_beside_others() {
    let mut cases: Vec<Vec<Effect>> = Vec::new();
    for joint in ["ground", "crack", "both"] {
        cases.extend(rivals(joint).map(|effect| vec![effect]));
        cases.extend([vec![lines_at(joint, 2e-3)], vec![crushing_at(joint, 4e-4)]]);
    }
    for below in rivals("ground") {
        cases.extend(rivals("crack").map(|above| vec![below, above]));
        cases.push(vec![below, effect("compliant_joint.crack", &[1e9, 0.0])]);
    }
    for effects in cases {
        let (response, _) = released(table_wall(effects.clone(), [0.02, -0.015]), 2.0);
        // As on beds.
        assert!(response.energy.residual() < 1e-8, "{effects:?}: {:e}", response.energy.residual());
        assert_eq!(response.outcome.name(), "stood", "{effects:?}");
        let losing =
            effects.iter().any(|e| e.kind().name() == "crushing_joint" || e.parameters().get(3) > Some(&0.0));
        assert_eq!(response.energy.effect_loss_j > 0.0, losing, "{effects:?}");
    }
}

#[test]
fn analytic_crushing_is_remembered_and_lost_once() {
    // A block pulled to 0.03 rad by an impulse: what is lost is the closed sum of N φ dℓ up to its largest rotation.
    let parameters = block(vec![crushing_at("ground", 0.0)], 0.0);
    let bedded = wall(parameters);
    let free = Shaking { tail_s: 1.5, ..Shaking::default() };
    let simulator = Simulator::new(&bedded, &free, TIGHT);
    let kicked = |speed: f64, crushed_rad| Start {
        state: State { theta: [0.0; 2], omega: [speed; 2] },
        contact: Some(Contact::REST),
        crushed_rad,
        ..Start::default()
    };
    let quarter = simulator.run_from(&kicked(0.12, [[0.0; 2]; 2]), 0.6, &mut ());
    let largest = quarter.theta_max_rad[0].value;
    let bed = crushing();
    let lost_j = bed.lost_j(largest.sin());
    assert!(largest > 0.01 && lost_j > 0.1, "{largest} {lost_j}");
    // The run's tolerance over the whole of it.
    assert!(
        (quarter.energy.effect_loss_j / lost_j - 1.0).abs() < 1e-8,
        "{} {lost_j}",
        quarter.energy.effect_loss_j
    );
    assert!(same(quarter.left.crushed_rad[0][0], largest, 1e5), "{:?} {largest}", quarter.left.crushed_rad);
    // Not as far again: nothing more is lost.
    let again = simulator.run_from(&kicked(0.08, quarter.left.crushed_rad), 0.6, &mut ());
    assert_eq!(again.energy.effect_loss_j, 0.0);
    assert_eq!(again.left.crushed_rad, quarter.left.crushed_rad);
    assert!(again.energy.residual() < 1e-8);
    // Further than ever: it goes on to crush, and no energy is lost in beginning to.
    let further = simulator.run_from(&kicked(0.14, quarter.left.crushed_rad), 0.6, &mut ());
    assert!(further.energy.effect_loss_j > 0.0 && further.theta_max_rad[0].value > largest);
    assert!(further.energy.residual() < 1e-8, "{:e}", further.energy.residual());
    let whole = Simulator::new(&bedded, &free, TIGHT).run_from(&kicked(0.14, [[0.0; 2]; 2]), 0.6, &mut ());
    assert!(
        further.left.crushed_rad[0][0] > largest && whole.energy.effect_loss_j > further.energy.effect_loss_j
    );
}

#[test]
fn analytic_a_record_finds_what_the_one_before_has_crushed() {
    let parts = [1.6, 1.6].map(|amplitude: f64| {
        let samples = (0..150).map(|k| amplitude * (0.09 * f64::from(k)).sin()).collect();
        let horizontal = Some(Accelerogram::new(0.01, samples).expect("a record"));
        Shaking { horizontal, vertical: None, tail_s: 3.0 }
    });
    let bedded = wall(table_wall(vec![crushing_at("both", 1e-3)], [0.0; 2]));
    let runs = simulate_sequence(&bedded, &parts, TIGHT);
    let [first, second] = [0, 1].map(|i: usize| runs[i].clone().expect("it stands"));
    assert!(first.energy.effect_loss_j > 0.0 && first.left.crushed_rad[0][0] > 0.0);
    // Nothing is uncrushed, and the second moves otherwise than the first.
    for (before, after) in
        first.left.crushed_rad.iter().flatten().zip(second.left.crushed_rad.iter().flatten())
    {
        assert!(after >= before, "{first:?} {second:?}");
    }
    assert_ne!(first.theta_max_rad, second.theta_max_rad);
    let begun = Start { time_s: 0.0, ..first.left };
    let simulator = Simulator::new(&bedded, &parts[1], TIGHT);
    assert_eq!(simulator.run_from(&begun, simulator.end_s(), &mut ()), second);
}

#[test]
fn analytic_mirrored_walls_move_as_mirrors() {
    for (below, above) in rivals("ground").into_iter().zip([2, 0, 1]) {
        let effects = vec![below, rivals("crack")[above]];
        let (one, _) = released(table_wall(effects.clone(), [0.02, -0.01]), 2.0);
        let (other, _) = released(table_wall(effects.clone(), [-0.02, 0.01]), 2.0);
        assert_eq!(one.theta_max_rad.map(|p| p.value), other.theta_max_rad.map(|p| -p.value), "{effects:?}");
        assert_eq!(one.energy, other.energy, "{effects:?}");
    }
}

#[test]
fn analytic_a_still_ground_leaves_the_wall_at_rest() {
    for effect in rivals("both") {
        let quiet = Some(Accelerogram::new(0.01, vec![0.0; 100]).expect("samples"));
        let shaking = Shaking { horizontal: quiet, vertical: None, tail_s: 1.0 };
        let response = simulate(&wall(table_wall(vec![effect], [0.0; 2])), &shaking, TIGHT);
        assert_eq!(response.theta_max_rad.map(|peak| peak.value), [0.0; 2], "{effect:?}");
    }
}

#[test]
fn analytic_a_wall_on_worn_edges_opens_where_its_flat_ends() {
    // A block stands up to a = g (b - 2 a)/h.
    let a_m_s2 = G_M_S2 * (WIDTH_M - 0.08) / 3.984;
    for (share, moves) in [(0.999, false), (1.001, true)] {
        let constant = Accelerogram::new(0.01, vec![share * a_m_s2; 50]).expect("samples");
        let shaking = Shaking { horizontal: Some(constant), vertical: None, tail_s: 0.0 };
        let response = simulate(&wall(block(vec![rounded_at("ground")], 0.0)), &shaking, TIGHT);
        assert_eq!(response.theta_max_rad[0].value != 0.0, moves, "{share}");
    }
}

#[test]
fn rejects_rivals_that_cannot_be() {
    let refused = |effect: Effect| Wall::new(block(vec![effect], 0.0)).expect_err("no such wall").to_string();
    let said = refused(effect("trilinear_joint.ground", &[0.7, 0.0, 0.01, 0.0]));
    assert!(said.starts_with("effects.0.first_rotation_rad: found 0"), "{said}");
    let said = refused(effect("trilinear_joint.ground", &[0.7, 0.01, 0.01, 0.0]));
    assert!(said.starts_with("effects.0.last_rotation_rad: found 0.01; allowed: above first"), "{said}");
    let said = refused(effect("trilinear_joint.ground", &[0.1, 0.05, 0.2, 0.0]));
    assert!(said.starts_with("effects.0.first_rotation_rad") && said.contains("own weight"), "{said}");
    let said = refused(effect("rounded_edges.ground", &[WIDTH_M / 2.0, 1.0]));
    assert!(said.starts_with("effects.0.worn_width_m") && said.contains("below half the width"), "{said}");
    // N/(0.85 f L) a third of the width.
    let least = WEIGHT_N / (0.85 * WIDTH_M / 3.0 * 1.5);
    let said = refused(effect("crushing_joint.ground", &[1e9, 0.999 * least, 0.0]));
    assert!(said.starts_with("effects.0.compressive_strength_pa"), "{said}");
    assert!(Wall::new(block(vec![effect("crushing_joint.ground", &[1e9, 1.001 * least, 0.0])], 0.0)).is_ok());
    let said = refused(effect("crushing_joint.ground", &[1e13, 1e6, 0.0]));
    assert!(
        said.starts_with("effects.0.stiffness_pa_per_m") && said.contains("corner_indentation"),
        "{said}"
    );
    let said = refused(effect("crushing_joint.ground", &[1e6, 1e6, 0.0]));
    assert!(said.contains("falls by its own weight"), "{said}");
    let twice = vec![rounded_at("ground"), effect("compliant_joint.both", &[1e9, 0.0])];
    let said = Wall::new(table_wall(twice, [0.0; 2])).expect_err("two laws").to_string();
    assert!(said.starts_with("effects.1") && said.contains("one bed in a joint"), "{said}");
    for (name, values) in [
        ("trilinear_joint.ground", &[0.0, 0.01, 0.02, 0.0][..]),
        ("crushing_joint.ground", &[-1.0, 1e6, 0.0]),
        ("rounded_edges.ground", &[f64::NAN, 1.0]),
        ("rounded_edges.top", &[0.01, 1.0]),
    ] {
        assert!(Effect::with_parameters(name, values).is_err(), "{name} {values:?}");
    }
}
