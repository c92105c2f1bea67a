//! Each law with kinks against an independent integration, closed forms, and balances of forces.

use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{
    Contact, Effect, G_M_S2, ImpactLaw, Joint, Pair, Pivot, RockingWall, State, Vector, WallParameters,
};
use mrbd_kernel::simulate::{Accuracy, Observer, Response, Shaking, Simulator, Start, simulate_observed};
use mrbd_kernel::solver::Quintic;
use rand::RngExt;

use crate::effects_reference::{Law, Reference};
use crate::matrix_model::MatrixWall;
use crate::walls::{any_wall, around_zero, bare_wall, effect, log_uniform, made, rng, table_wall};

const TIGHT: Accuracy = Accuracy { tolerance: 1e-11 };

/// Where a run ended.
#[derive(Default)]
struct End(Pair);

impl Observer for End {
    fn moved(&mut self, _: f64, _: Contact, _: &Quintic) {}
    fn stood(&mut self, _: f64, _: f64) {}
    fn ended(&mut self, _: f64, _: Contact, theta: Pair) {
        self.0 = theta;
    }
}

/// A law and the effect that is to be it, of a size that matters while the top is displaced by some 0.2 m.
fn law(kind: usize, index: u64, x_c_m: f64, wall: &mut WallParameters) -> (Law, Effect) {
    let mut rng = rng(330 + kind as u64, index);
    let k = log_uniform(&mut rng, 3e3, 5e4);
    match kind {
        0 => {
            let force_n = log_uniform(&mut rng, 200.0, 8000.0);
            (Law::Friction { force_n }, effect("coulomb_friction", &[force_n]))
        }
        1 => {
            let half_width_m = x_c_m.abs() + around_zero(&mut rng, 5e-3);
            wall.stiffness_n_per_m = k;
            (Law::Gap { stiffness_n_per_m: k, half_width_m }, effect("gap", &[half_width_m]))
        }
        2 => {
            let positive = rng.random_bool(0.5);
            let (name, side) = if positive {
                ("one_sided_spring.positive", 1.0)
            } else {
                ("one_sided_spring.negative", -1.0)
            };
            (Law::OneSided { stiffness_n_per_m: k, side }, effect(name, &[k]))
        }
        _ => {
            let force_n = log_uniform(&mut rng, 200.0, 4000.0);
            (Law::Yielding { stiffness_n_per_m: k, force_n }, effect("yielding_spring", &[k, force_n]))
        }
    }
}

/// Both joints open and far from closing, so that only the law can end a step.
fn open_state(index: u64, crosses_zero: bool) -> (Contact, State) {
    let mut rng = rng(340, index);
    let lean: f64 = rng.random_range(0.04..0.06);
    let crack = if crosses_zero { Pivot::Left } else { Pivot::Right };
    // Of heights of 2.2 m and 1.8 m, leaning to both sides so that the top is near the middle.
    let apart = if crosses_zero { 2.22 * lean } else { rng.random_range(0.06..0.08) };
    let theta = [lean, lean + crack.sign() * apart];
    let omega_1 = around_zero(&mut rng, 0.2);
    // The top moves slowly, so that it stops now and then.
    let omega_2 = -1.2 * omega_1 + around_zero(&mut rng, 0.1);
    (Contact { ground: Pivot::Right, crack }, State { theta, omega: [omega_1, omega_2] })
}

#[test]
fn analytic_every_law_moves_the_wall_as_the_matrix_equations_do() {
    for (kind, name) in ["friction", "gap", "one-sided", "yielding"].into_iter().enumerate() {
        let (mut worst, mut kinks, mut compared) = (0.0_f64, 0, 0);
        for index in 0..20 {
            let mut wall = table_wall(ImpactLaw::Contact);
            wall.stiffness_n_per_m = 4e3;
            let (contact, state) = open_state(index, kind == 2);
            let x_c_m = MatrixWall::new(&wall).top_displacement(contact, state.theta);
            let (law, effect) = law(kind, index, x_c_m, &mut wall);
            let mut rng = rng(350, index);
            let samples: Vec<f64> = (0..21).map(|_| around_zero(&mut rng, 8.0)).collect();
            let end_s = 0.15;
            // The effect has the gap's spring to itself.
            let mut plain = wall.clone();
            plain.stiffness_n_per_m = if kind == 1 { 0.0 } else { wall.stiffness_n_per_m };
            let mut reference = Reference::new(&plain, contact, law, (samples.clone(), 0.01));
            let expected = reference.run(state, end_s);
            wall.effects = vec![effect];
            let record = Accelerogram::new(0.01, samples).expect("a record");
            let shaking = Shaking { horizontal: Some(record), vertical: None, tail_s: 0.0 };
            let mut end = End::default();
            let start = Start { state, contact: Some(contact), ..Start::default() };
            let response = Simulator::new(&made(&wall), &shaking, TIGHT).run_from(&start, end_s, &mut end);
            if response.impacts.total() > 0 || response.collapsed() {
                continue;
            }
            compared += 1;
            kinks += reference.kinks;
            for i in 0..2 {
                worst = worst.max((end.0[i] - expected.theta[i]).abs());
            }
        }
        eprintln!("{name}: {worst:e} rad apart over {compared} runs and {kinks} kinks");
        assert!(compared >= 14 && kinks >= 8, "{name}: {compared} runs, {kinks} kinks");
        // The reference passes displacements within a step of 5e-5 s, in which a stiffness that it has wrong by 5e4 N/m
        // over 1 t and 1 m/s makes h³ k/m v / 4 m = 2e-12 rad; bisection and roundings make less.
        assert!(worst < 1e-10, "{name}: {worst:e}");
    }
}

/// A block that leans on a stiff spring under a ground acceleration that stays: it swings about a lean.
fn leaning_block(effects: &[Effect], tail_s: f64) -> (WallParameters, Shaking) {
    let mut wall = bare_wall(0.3, 3.0, None);
    wall.stiffness_n_per_m = 2e5;
    wall.effects = effects.to_vec();
    wall.initial_rotation_rad = [0.03, 0.03];
    let samples = vec![-14.0; (tail_s / 0.005) as usize];
    let record = Accelerogram::new(0.005, samples).expect("a record");
    (wall, Shaking { horizontal: Some(record), vertical: None, tail_s: 0.0 })
}

/// Displacements of the top, finely, in the one pattern of a leaning block.
struct Path {
    wall: RockingWall,
    x_m: Vec<f64>,
}

impl Path {
    fn of(parameters: &WallParameters, shaking: &Shaking) -> (Response, Vec<f64>) {
        let wall = made(parameters);
        let mut path = Self { wall: RockingWall::new(&wall), x_m: Vec::new() };
        let response = simulate_observed(&wall, shaking, TIGHT, &mut path);
        assert_eq!(response.impacts.total(), 0, "the block stays on its corner");
        (response, path.x_m)
    }

    /// Where the top turns back, its start and its end.
    fn turns(x_m: &[f64]) -> Vec<f64> {
        let inside = x_m.windows(3).filter(|w| (w[1] - w[0]) * (w[2] - w[1]) < 0.0).map(|w| w[1]);
        [x_m[0]].into_iter().chain(inside).chain(x_m.last().copied()).collect()
    }
}

impl Observer for Path {
    fn moved(&mut self, _: f64, contact: Contact, motion: &Quintic) {
        // Kinks lie at the ends of stretches, so that turns are met exactly.
        let at = |k: u32| self.wall.top_displacement_m(contact, motion.position(f64::from(k) / 8.0));
        let from = u32::from(!self.x_m.is_empty());
        self.x_m.extend((from..=8).map(at));
    }
    fn stood(&mut self, _: f64, _: f64) {}
    fn ended(&mut self, _: f64, _: Contact, _: Pair) {}
}

#[test]
fn analytic_coulomb_swings_decay_by_four_times_the_friction_over_the_stiffness() {
    let force_n = 300.0;
    let (wall, shaking) = leaning_block(&[effect("coulomb_friction", &[force_n])], 4.0);
    let (response, x_m) = Path::of(&wall, &shaking);
    let turns = Path::turns(&x_m);
    let swings: Vec<f64> = turns.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    eprintln!("swings {swings:?}");
    assert!(swings.len() > 8, "{swings:?}");
    // Two half-swings differ by 4 F_c/k; the weight, which pushes a block of this lean over, takes
    // m g / 2h = 0.5 m · 1620 kg · g / (3 m)² ≈ 2.6e3 N/m and its curvature less from the spring's 2e5 N/m.
    let k = wall.stiffness_n_per_m - 0.5 * wall.mass_kg * G_M_S2 / wall.height_m;
    let full = &swings[..swings.len() - 1];
    for pair in full.windows(2) {
        let drop = (pair[0] - pair[1]) / (4.0 * force_n / k);
        assert!((drop - 1.0).abs() < 5e-3, "{drop}: {swings:?}");
    }
    // All that is lost is friction times path, to roundings and the tolerance.
    let path_m: f64 = swings.iter().sum();
    let lost = response.energy.effect_loss_j / (force_n * path_m);
    assert!((lost - 1.0).abs() < 1e-8, "{lost}");
    // In the end it stands, held away from where the forces without friction balance.
    let tail = &x_m[x_m.len() - 100..];
    assert!(tail.iter().all(|x| *x == tail[0]), "it creeps");
}

#[test]
fn analytic_a_yielding_spring_loses_its_force_over_its_plastic_path() {
    let (k, force_n) = (1e5, 250.0);
    let (wall, shaking) = leaning_block(&[effect("yielding_spring", &[k, force_n])], 3.0);
    let (response, x_m) = Path::of(&wall, &shaking);
    // Elastic-perfectly plastic by its definition, sample by sample; the plastic displacement starts where the spring
    // holds its force at the lean of the release.
    let x_y = force_n / k;
    let mut plastic_m = x_m[0] - x_y;
    let mut path_m = 0.0;
    for x in &x_m {
        let next = plastic_m.clamp(x - x_y, x + x_y);
        path_m += (next - plastic_m).abs();
        plastic_m = next;
    }
    let lost = response.energy.effect_loss_j / (force_n * path_m);
    eprintln!("lost {} J over a plastic path of {path_m} m: {lost}", response.energy.effect_loss_j);
    assert!(path_m > 4.0 * x_y, "{path_m}");
    // Stretches end at turns and at yielding, so that samples miss nothing but roundings and the tolerance.
    assert!((lost - 1.0).abs() < 1e-7, "{lost}");
    assert!(response.energy.residual() < 1e-9, "{}", response.energy.residual());
}

/// Whether a wall at rest moves under a ground acceleration that stays for half a second.
fn moves(wall: &WallParameters, a_m_s2: f64) -> bool {
    let record = Accelerogram::new(0.01, vec![a_m_s2; 50]).expect("a record");
    let shaking = Shaking { horizontal: Some(record), vertical: None, tail_s: 0.0 };
    simulate_observed(&made(wall), &shaking, TIGHT, &mut ()).openings.total() > 0
}

#[test]
fn analytic_friction_keeps_a_block_at_rest_up_to_its_balance() {
    let mut block = bare_wall(0.3, 3.0, None);
    let force_n = 400.0;
    block.effects =
        vec![effect("coulomb_friction", &[force_n / 4.0]), effect("coulomb_friction", &[0.75 * force_n])];
    // Moments about the corner: m a h/2 = m g b/2 + F_c h.
    let limit = G_M_S2 * block.thickness_m / block.height_m + 2.0 * force_n / block.mass_kg;
    for side in [1.0, -1.0] {
        assert!(!moves(&block, side * limit * (1.0 - 1e-9)));
        assert!(moves(&block, side * limit * (1.0 + 1e-9)));
    }
}

#[test]
fn analytic_friction_keeps_a_cracked_wall_at_rest_as_long_as_some_force_presses_all_corners() {
    let (mut still, mut moving) = (0, 0);
    for index in 0..300 {
        let mut rng = rng(360, index);
        let mut wall = any_wall(&mut rng);
        let matrices = MatrixWall::new(&wall);
        let lifting_n = 0.5 * wall.mass_kg * G_M_S2 * wall.thickness_m / wall.height_m;
        let force_n = lifting_n * log_uniform(&mut rng, 0.01, 3.0);
        let a = G_M_S2 * wall.thickness_m / wall.height_m * around_zero(&mut rng, 2.0);
        // The smallest corner force over forces at the top, by the matrix form: concave, so a ternary search finds it.
        let least = |top_n: f64| {
            let forces = matrices.through_joints_pushed(
                Contact::REST,
                &State::default(),
                Vector { x: a, y: 0.0 },
                top_n,
            );
            let corners = [Joint::Ground, Joint::Crack].map(|joint| {
                let through = &forces[joint as usize];
                matrices.corners(joint, [0.0; 2], through)
            });
            corners.iter().flatten().fold(f64::INFINITY, |least, corner| least.min(*corner))
        };
        let (mut low, mut high) = (-force_n, force_n);
        for _ in 0..200 {
            let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            if least(a) < least(b) { low = a } else { high = b }
        }
        let margin = least(0.5 * (low + high)) / (wall.mass_kg * G_M_S2);
        if margin.abs() < 1e-9 {
            continue;
        }
        wall.effects = vec![effect("coulomb_friction", &[force_n])];
        assert_eq!(moves(&wall, a), margin < 0.0, "wall {index}: margin {margin:e}");
        still += u32::from(margin > 0.0);
        moving += u32::from(margin < 0.0);
    }
    assert!(still > 50 && moving > 50, "{still} still, {moving} moving");
}

#[test]
fn analytic_a_held_top_lets_the_middle_of_the_wall_rock() {
    // Friction beyond what the wall can push: the top stays, and the wall rocks in pattern 2 under it.
    let mut wall = bare_wall(0.25, 4.0, Some(2.2));
    wall.effects = vec![effect("coulomb_friction", &[1e6])];
    let samples = (0..300).map(|k| 8.0 * (0.06 * f64::from(k)).sin()).collect();
    let shaking = Shaking {
        horizontal: Some(Accelerogram::new(0.01, samples).expect("a record")),
        vertical: None,
        tail_s: 1.0,
    };
    let response = simulate_observed(&made(&wall), &shaking, TIGHT, &mut ());
    eprintln!("{:?}, top {:?}", response.pattern_time_s, response.top_displacement_m);
    let rocked_s: f64 = response.pattern_time_s[1..].iter().sum();
    assert!(rocked_s > 0.1 && response.theta_max_rad[0].value.abs() > 1e-3, "{response:?}");
    // An impact of the bodies can move the top, for it has an impulse and friction has none; between impacts it stays.
    let pattern_2_s = response.pattern_time_s[2] + response.pattern_time_s[6];
    assert!(pattern_2_s > 0.5 * rocked_s, "{:?}", response.pattern_time_s);
    assert!(response.top_displacement_m.value.abs() < 0.01, "{:?}", response.top_displacement_m);
}
