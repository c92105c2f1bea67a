//! Walls, records and states drawn at random from a seed, and the single block that most closed forms are about.

use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{
    Contact, Effect, G_M_S2, ImpactLaw, Pivot, Restitution, Role, State, Touching, Vector, Wall,
    WallParameters,
};
use mrbd_kernel::simulate::{History, Shaking};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The draw `index` of a test; depends on nothing but its two numbers.
pub fn rng(test: u64, index: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(test);
    rng.set_stream(index);
    rng
}

/// Uniform in the logarithm.
pub fn log_uniform(rng: &mut ChaCha8Rng, from: f64, to: f64) -> f64 {
    rng.random_range(from.ln()..to.ln()).exp()
}

/// A number of either sign.
pub fn around_zero(rng: &mut ChaCha8Rng, bound: f64) -> f64 {
    rng.random_range(-bound..bound)
}

/// A wall without top masses, spring or effects, whose impacts are plastic and all count.
pub fn bare_wall(thickness_m: f64, height_m: f64, crack_height_m: Option<f64>) -> WallParameters {
    WallParameters {
        thickness_m,
        height_m,
        crack_height_m,
        length_m: 1.0,
        mass_kg: 1800.0 * thickness_m * height_m,
        lower_width_m: thickness_m,
        upper_width_m: thickness_m,
        diaphragm_mass_kg: 0.0,
        carriage_mass_kg: 0.0,
        stiffness_n_per_m: 0.0,
        eccentricity_m: 0.0,
        restitution: Restitution { capture_velocity_rad_s: 1e-6, ..Restitution::default() },
        collapse_rotation_ratio: WallParameters::DEFAULT_COLLAPSE_RATIO,
        initial_rotation_rad: [0.0, 0.0],
        effects: Vec::new(),
        formulas: Vec::new(),
    }
}

/// A single block with frequency parameter p (p² = 3g/4R), slenderness α and θ'⁺ = `velocity_ratio` θ'⁻ at impacts.
pub fn block(p_rad_s: f64, alpha_rad: f64, velocity_ratio: f64) -> WallParameters {
    let r_m = 3.0 * G_M_S2 / (4.0 * p_rad_s * p_rad_s);
    let mut wall = bare_wall(2.0 * r_m * alpha_rad.sin(), 2.0 * r_m * alpha_rad.cos(), None);
    let plastic = 1.0 - 1.5 * alpha_rad.sin().powi(2);
    wall.restitution.coefficients[5] = velocity_ratio / plastic;
    wall.restitution.capture_velocity_rad_s = 0.0;
    wall
}

/// The table wall of the paper's Table 1 with the coefficients of its Table 2, under an impact law.
pub fn table_wall(law: ImpactLaw) -> WallParameters {
    let mut wall = WallParameters::table_wall();
    wall.restitution.law = law;
    wall
}

/// A cracked wall of any shape a builder or a test might think of, with plastic impacts.
pub fn any_wall(rng: &mut ChaCha8Rng) -> WallParameters {
    let thickness_m = rng.random_range(0.1..1.0);
    let height_m = thickness_m * log_uniform(rng, 1.0, 60.0);
    let mut wall = bare_wall(thickness_m, height_m, Some(height_m * rng.random_range(0.02..0.98)));
    wall.lower_width_m *= rng.random_range(0.5..1.0);
    wall.upper_width_m *= rng.random_range(0.5..1.0);
    wall.mass_kg *= log_uniform(rng, 0.3, 3.0);
    wall.diaphragm_mass_kg = some(rng, |rng| wall.mass_kg * rng.random_range(0.0..0.5));
    wall.carriage_mass_kg = some(rng, |rng| wall.mass_kg * rng.random_range(0.0..0.5));
    // From a spring that carries nothing to one a hundred times stiffer than the wall's weight over its height.
    let weight_n_per_m = wall.mass_kg * G_M_S2 / height_m;
    wall.stiffness_n_per_m = some(rng, |rng| weight_n_per_m * log_uniform(rng, 0.1, 100.0));
    wall.eccentricity_m = some(rng, |rng| around_zero(rng, 0.5 * thickness_m));
    wall
}

/// A value two times out of three, else zero.
fn some(rng: &mut ChaCha8Rng, mut draw: impl FnMut(&mut ChaCha8Rng) -> f64) -> f64 {
    if rng.random_bool(2.0 / 3.0) { draw(rng) } else { 0.0 }
}

/// An effect of the catalogue.
pub fn effect(name: &str, values: &[f64]) -> Effect {
    Effect::with_parameters(name, values).expect("values within their bounds")
}

/// Each smooth further effect in one wall out of two, of a size that matters to the wall.
pub fn any_effects(rng: &mut ChaCha8Rng, wall: &WallParameters) -> Vec<Effect> {
    let weight_n = wall.mass_kg * G_M_S2;
    let (b, h) = (wall.thickness_m, wall.height_m);
    let time_s = (h / G_M_S2).sqrt();
    let all = [
        effect("carriage_mass", &[wall.mass_kg * rng.random_range(0.0..0.3)]),
        effect("viscous_damping", &[weight_n / h * time_s * rng.random_range(0.0..0.5)]),
        // Softening stays below half of what the wall's weight holds within its thickness.
        effect("cubic_stiffness", &[weight_n / h / (b * b) * rng.random_range(-0.5..5.0)]),
        effect("joint_damping.ground", &[weight_n * h * time_s * rng.random_range(0.0..0.05)]),
        effect("joint_damping.crack", &[weight_n * h * time_s * rng.random_range(0.0..0.05)]),
    ];
    all.into_iter().filter(|_| rng.random_bool(0.5)).collect()
}

/// Every further effect in one wall out of two, of a size that matters to the wall, those at the top with kinks too.
pub fn any_of_all_effects(rng: &mut ChaCha8Rng, wall: &WallParameters) -> Vec<Effect> {
    let weight_n = wall.mass_kg * G_M_S2;
    let (b, h) = (wall.thickness_m, wall.height_m);
    // The force at the top that lifts a block of this shape.
    let lifting_n = 0.5 * weight_n * b / h;
    let factors: Vec<f64> = (0..8).map(|_| rng.random_range(0.7..1.0)).collect();
    let all = [
        effect("coulomb_friction", &[lifting_n * rng.random_range(0.0..1.5)]),
        effect("gap", &[b * rng.random_range(0.0..0.2)]),
        effect("one_sided_spring.positive", &[weight_n / h * rng.random_range(0.0..10.0)]),
        effect("one_sided_spring.negative", &[weight_n / h * rng.random_range(0.0..10.0)]),
        effect(
            "yielding_spring",
            &[weight_n / h * rng.random_range(0.1..50.0), lifting_n * rng.random_range(0.0..1.5)],
        ),
        effect("corner_indentation.ground", &[wall.lower_width_m * rng.random_range(0.0..0.5)]),
        effect("corner_indentation.crack", &[wall.upper_width_m * rng.random_range(0.0..0.5)]),
        effect("impact_dissipation", &factors),
        effect("vertical_ground_motion", &[around_zero(rng, 0.5)]),
        effect("record_gain", &[rng.random_range(0.5..1.5)]),
        effect("record_lag", &[around_zero(rng, 0.1)]),
        effect("sensor_gain.both", &[rng.random_range(0.5..1.5)]),
        effect("sensor_offset.upper", &[around_zero(rng, 0.01)]),
    ];
    let mut effects = any_effects(rng, wall);
    effects.extend(all.into_iter().filter(|_| rng.random_bool(0.5)));
    // From a stream of its own: walls without a bed stay those that they were.
    let mut of_beds = rng.clone();
    of_beds.set_stream(rng.get_stream() + (1 << 32));
    if of_beds.random_bool(0.5) {
        effects.extend(any_bed(&mut of_beds, wall, &effects));
    }
    // And from another: rivals of beds where there is none.
    let mut of_rivals = rng.clone();
    of_rivals.set_stream(rng.get_stream() + (1 << 33));
    let has_bed = effects.iter().any(|effect| effect.entry().role == Role::Bed);
    if !has_bed && of_rivals.random_bool(0.5) {
        effects.extend(any_rival(&mut of_rivals, wall, &effects));
    }
    let mut of_impacts = rng.clone();
    of_impacts.set_stream(rng.get_stream() + (1 << 34));
    if of_impacts.random_bool(0.5) {
        effects.push(effect("impact_fading", &[of_impacts.random_range(0.0..3.0)]));
    }
    effects
}

/// Three lines, a bed that crushes or worn edges, of sizes that matter; none where the wall would fall on it.
fn any_rival(rng: &mut ChaCha8Rng, wall: &WallParameters, others: &[Effect]) -> Option<Effect> {
    let joint = ["ground", "crack", "both"][rng.random_range(0..3)];
    let (b, alpha) = (wall.lower_width_m, wall.lower_width_m / wall.height_m);
    let damping_s = if rng.random_bool(0.5) { 0.0 } else { log_uniform(rng, 1e-5, 1e-2) };
    let rival = match rng.random_range(0..3) {
        0 => {
            let first_rad = log_uniform(rng, 1e-3, 0.1) * alpha;
            let last_rad = first_rad * rng.random_range(1.5..30.0);
            let values = [rng.random_range(0.3..1.0), first_rad, last_rad, damping_s];
            effect(&format!("trilinear_joint.{joint}"), &values)
        }
        1 => {
            // The toe crushes from some share of the slenderness on: (0.85 f)² L/(2 k N).
            let load_n = wall.mass_kg * G_M_S2;
            let block_m = log_uniform(rng, 0.003, 0.2) * b;
            let strength_pa = load_n / (0.85 * block_m * wall.length_m);
            let yields_rad = log_uniform(rng, 0.01, 1.0) * alpha;
            let stiffness = (0.85 * strength_pa).powi(2) * wall.length_m / (2.0 * yields_rad * load_n);
            let values = [stiffness.clamp(1e6, 1e11), strength_pa, damping_s];
            effect(&format!("crushing_joint.{joint}"), &values)
        }
        _ => {
            let worn_m = rng.random_range(0.01..0.45) * b;
            effect(&format!("rounded_edges.{joint}"), &[worn_m, worn_m / log_uniform(rng, 0.01, 2.0)])
        }
    };
    let effects = others.iter().copied().chain([rival]).collect();
    Wall::new(WallParameters { effects, ..wall.clone() }).is_ok().then_some(rival)
}

/// A bed in a joint or in both, in whole contact up to 1e-4 to 1e-2 of the slenderness; none where the wall would fall
/// on it. Not above 1e11 Pa/m: stiffer beds move as sharp edges, in ever shorter steps.
pub fn any_bed(rng: &mut ChaCha8Rng, wall: &WallParameters, others: &[Effect]) -> Option<Effect> {
    let joint = ["ground", "crack", "both"][rng.random_range(0..3)];
    let full_contact_rad = log_uniform(rng, 1e-4, 1e-2) * wall.lower_width_m / wall.height_m;
    let stiffness =
        2.0 * wall.mass_kg * G_M_S2 / (full_contact_rad * wall.length_m * wall.lower_width_m.powi(2));
    let damping_s = if rng.random_bool(0.5) { 0.0 } else { log_uniform(rng, 1e-5, 1e-2) };
    let bed = effect(&format!("compliant_joint.{joint}"), &[stiffness.clamp(1e6, 1e11), damping_s]);
    let effects = others.iter().copied().chain([bed]).collect();
    Wall::new(WallParameters { effects, ..wall.clone() }).is_ok().then_some(bed)
}

/// Coefficients and law of impacts, with no coefficient above `most`.
pub fn any_restitution(rng: &mut ChaCha8Rng, most: f64) -> Restitution {
    Restitution {
        coefficients: [(); 8].map(|()| rng.random_range(0.6..most)),
        law: if rng.random_bool(0.5) { ImpactLaw::Whole } else { ImpactLaw::Contact },
        capture_velocity_rad_s: log_uniform(rng, 1e-6, 1e-2),
    }
}

/// A ground motion of a few seconds: a handful of pulses of random frequency, phase and arrival.
pub fn any_record(rng: &mut ChaCha8Rng, peak_m_s2: f64) -> Accelerogram {
    let step_s = [0.005, 0.01, 0.02][rng.random_range(0..3)];
    let duration_s: f64 = rng.random_range(2.0..6.0);
    let wavelets: Vec<[f64; 5]> = (0..rng.random_range(1..6))
        .map(|_| {
            let arrival_s = rng.random_range(0.0..duration_s);
            let length_s = rng.random_range(0.1..1.5);
            let omega = std::f64::consts::TAU * log_uniform(rng, 0.3, 8.0);
            [arrival_s, length_s, omega, rng.random_range(0.0..6.3), rng.random_range(0.2..1.0)]
        })
        .collect();
    let at = |t: f64| -> f64 {
        let of = |[arrival, length, omega, phase, size]: &[f64; 5]| {
            size * (-((t - arrival) / length).powi(2)).exp() * (omega * (t - arrival) + phase).cos()
        };
        wavelets.iter().map(of).sum()
    };
    let samples: Vec<f64> = (0..(duration_s / step_s) as usize).map(|k| at(k as f64 * step_s)).collect();
    let largest = samples.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
    Accelerogram::new(step_s, samples).expect("a record").scaled(peak_m_s2 / largest)
}

/// Shaking that moves the wall: from just above the acceleration that uplifts a block of its shape to many times it.
pub fn any_shaking(rng: &mut ChaCha8Rng, wall: &WallParameters, vertical: bool) -> Shaking {
    let uplift = G_M_S2 * wall.lower_width_m / wall.height_m;
    let peak = uplift * log_uniform(rng, 1.2, 6.0);
    let horizontal = any_record(rng, peak);
    let vertical = vertical.then(|| {
        let samples = any_record(rng, 0.5 * peak.min(G_M_S2)).acceleration_m_s2().to_vec();
        Accelerogram::new(horizontal.step_s(), samples).expect("a record")
    });
    Shaking { horizontal: Some(horizontal), vertical, tail_s: 2.0 }
}

/// A checked wall.
pub fn made(parameters: &WallParameters) -> Wall {
    Wall::new(parameters.clone()).expect("a wall that can exist")
}

/// Rotations and velocities that a contact state allows, up to its angles of collapse.
pub fn any_state(rng: &mut ChaCha8Rng, wall: &Wall, contact: Contact) -> State {
    let [a1, a2] = wall.alpha_i_rad();
    let (s1, s2) = (contact.ground.sign(), contact.crack.sign());
    let theta_1 = s1 * a1 * rng.random_range(0.0..1.5);
    let gap = s2 * a2 * rng.random_range(0.0..1.5);
    let omega_1 = s1.abs() * around_zero(rng, 2.0);
    let gap_rate = s2.abs() * around_zero(rng, 2.0);
    State { theta: [theta_1, theta_1 + gap], omega: [omega_1, omega_1 + gap_rate] }
}

/// A ground acceleration up to two g either way.
pub fn any_ground(rng: &mut ChaCha8Rng) -> Vector {
    Vector { x: around_zero(rng, 20.0), y: around_zero(rng, 20.0) }
}

/// A moment of impact: pattern before, joints that touch, and a state in which the open ones among them close.
///
/// Each joint moves at 1 rad/s or slower, down to `slowest`.
pub fn any_impact(rng: &mut ChaCha8Rng, wall: &Wall, slowest: f64) -> (Contact, Touching, State) {
    let sign = |rng: &mut ChaCha8Rng| if rng.random_bool(0.5) { Pivot::Right } else { Pivot::Left };
    let [a1, a2] = wall.alpha_i_rad();
    let (ground, crack) = (sign(rng), sign(rng));
    let (lean, gap) = (a1 * rng.random_range(0.0..1.5), a2 * rng.random_range(0.0..1.5));
    // Velocities over many decades and either sign, so that either joint may be the slow one.
    let speed = |rng: &mut ChaCha8Rng| log_uniform(rng, slowest, 1.0);
    let free = |rng: &mut ChaCha8Rng| speed(rng) * if rng.random_bool(0.5) { 1.0 } else { -1.0 };
    let (s1, s2) = (ground.sign(), crack.sign());
    let touching = |ground: bool, crack: bool| Touching { ground, crack };
    let both = Contact { ground, crack };
    match rng.random_range(0..5) {
        // Patterns 1 and 2: the ground closes, the crack stays open.
        0 => {
            let rate = -s1 * speed(rng);
            let omega = [rate, rate + free(rng)];
            (both, touching(true, false), State { theta: [0.0, s2 * gap], omega })
        }
        // Patterns 1 and 2: the crack closes above a leaning lower body.
        1 => {
            let rate = free(rng);
            let omega = [rate, rate - s2 * speed(rng)];
            (both, touching(false, true), State { theta: [s1 * lean; 2], omega })
        }
        // Pattern 3: the wall comes down as one.
        2 => {
            let contact = Contact { ground, crack: Pivot::Closed };
            (contact, touching(true, true), State { theta: [0.0; 2], omega: [-s1 * speed(rng); 2] })
        }
        // Pattern 4: the upper body comes down on a lower one that stands.
        3 => {
            let contact = Contact { ground: Pivot::Closed, crack };
            (contact, touching(true, true), State { theta: [0.0; 2], omega: [0.0, -s2 * speed(rng)] })
        }
        // Patterns 1 and 2: both joints close at one instant.
        _ => {
            let rate = -s1 * speed(rng);
            let omega = [rate, rate - s2 * speed(rng)];
            (both, touching(true, true), State { theta: [0.0; 2], omega })
        }
    }
}

/// Largest difference of rotations over the record and its tail, in units of α_i.
pub fn largest_difference(wall: &WallParameters, a: &History, b: &History) -> f64 {
    let alpha = made(wall).alpha_i_rad();
    assert_eq!(a.rows.len(), b.rows.len(), "one of the runs ended before the other");
    assert!(a.rows.iter().chain(&b.rows).flat_map(|row| row.theta_rad).all(f64::is_finite));
    let rows = a.rows.iter().zip(&b.rows);
    rows.map(|(a, b)| {
        let of = |i: usize| (a.theta_rad[i] - b.theta_rad[i]).abs() / alpha[i];
        of(0).max(of(1))
    })
    .fold(0.0, f64::max)
}
