//! From a set and a number to a case.

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sha2::{Digest, Sha256};

use super::super::compliant::corner::Corners;
use super::hidden::{Hidden, Scale, hidden};
use super::kind::{Freedom, Kind};
use super::walls::WallNumbers;

/// Which simulator makes the measurements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Simulator {
    /// The library's own.
    Own,
    /// The one with compliant corners.
    Compliant,
}

/// What joints of free bodies are made of; all so stiff that nothing is hidden by them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Contacts {
    /// Corners as near to sharp edges as may be.
    SharpEdges,
    /// Corners that are alike at the ground and at the crack.
    Corners(Corners),
    /// Rows of springs.
    Springs {
        /// Stiffness of a joint, Pa/m.
        stiffness_pa_per_m: f64,
        /// Damping time, s.
        damping_s: f64,
    },
}

/// What is said to be known of the wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Prior {
    /// k_d to 2 %, masses to 1 %.
    Known,
    /// k_d to 30 %.
    StiffnessFree,
    /// k_d to 30 %, C_l to 10 %.
    StiffnessAndImpactsFree,
}

/// A case, before its ground motions are scaled and anything is simulated.
#[derive(Debug, Clone)]
pub struct Case {
    pub set: String,
    pub number: u64,
    pub kind: Kind,
    pub simulator: Simulator,
    pub prior: Prior,
    /// White noise on the measured rotations, rad.
    pub noise_rad: f64,
    /// Size of the effect over its nominal one.
    pub size: f64,
    /// The wall as the experiment describes it.
    pub described: WallNumbers,
    /// The wall as it is, without the hidden effects.
    pub actual: WallNumbers,
    /// What the description lacks.
    pub hidden: Vec<Hidden>,
    pub fit_tests: usize,
    pub hold_out_tests: usize,
    /// Largest rotation the tests are scaled for, rad.
    pub target_rad: f64,
    /// That of the tests held out over it.
    pub held_out_amplitude: f64,
    /// What joints are made of in the second simulator.
    pub contacts: Contacts,
}

/// Standard deviations of white noise, rad.
pub const NOISES_RAD: [f64; 4] = [1e-5, 3e-5, 1e-4, 3e-4];
/// Sizes of an effect over its nominal one.
pub const SIZES: [f64; 3] = [0.5, 1.0, 2.0];

/// A generator of random numbers for one purpose of one case.
pub fn generator(set: &str, number: u64, purpose: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed(set));
    rng.set_stream(64 * number + purpose);
    rng
}

/// The seed of a set, from its name.
pub fn seed(set: &str) -> u64 {
    let hash = Sha256::digest(format!("blind cases: {set}"));
    u64::from_le_bytes(std::array::from_fn(|k| hash[k]))
}

/// The case of this number.
pub fn draw(set: &str, number: u64) -> Case {
    let kind = kind_of(set, number);
    let before = (0..number).filter(|earlier| kind_of(set, *earlier).group() == kind.group()).count();
    of_kind(set, number, kind, before)
}

/// What the case of this number hides.
///
/// The golden ratio's multiples fill (0, 1) evenly at every length: the first cases of a set are a fair share of it.
fn kind_of(set: &str, number: u64) -> Kind {
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let start = (seed(set) >> 11) as f64 / (1u64 << 53) as f64;
    Kind::at((start + number as f64 * golden).fract())
}

/// Noise, size and simulator of a case: the cases of a group go through all combinations, in an order of the set's own.
pub fn combination(set: &str, group: &str, before: usize) -> (f64, f64, Simulator) {
    let simulators = [Simulator::Own, Simulator::Compliant];
    let mut all: Vec<_> = NOISES_RAD
        .iter()
        .flat_map(|noise| SIZES.iter().map(move |size| (*noise, *size)))
        .flat_map(|(noise, size)| simulators.map(|simulator| (noise, size, simulator)))
        .collect();
    all.shuffle(&mut ChaCha8Rng::seed_from_u64(seed(&format!("{set}, {group}"))));
    all[before % all.len()]
}

/// The case of this number that hides this, with so many cases of its group before it.
pub fn of_kind(set: &str, number: u64, kind: Kind, before: usize) -> Case {
    let (noise_rad, size, simulator) = combination(set, &kind.group(), before);
    let mut rng = generator(set, number, 0);
    let described = if matches!(kind, Kind::Lumped(_)) || rng.random_range(0.0..1.0) < 0.5 {
        WallNumbers::table()
    } else {
        WallNumbers::facade(&mut rng)
    };
    let size = if matches!(kind, Kind::Nothing | Kind::Lumped(_)) { 1.0 } else { size };
    // The library has no other laws than its catalogue's.
    let simulator = if matches!(kind, Kind::Outside(_)) { Simulator::Compliant } else { simulator };
    let described = if simulator == Simulator::Compliant { plastic(described) } else { described };
    let prior = prior(kind, &mut rng);
    let [fit_tests, hold_out_tests] = [[3, 2], [3, 2], [2, 1], [4, 2]][rng.random_range(0..4)];
    let target_rad = rng.random_range(0.10..0.25) * described.widths_m[0] / described.height_m * 2.0;
    let scattered = rng.random_range(0.0..1.0) < 0.5;
    let mut actual = if scattered { scatter(&described, prior, &mut rng) } else { described.clone() };
    let scale = Scale { wall: &actual, rotation_rad: target_rad, size };
    let names = kind.effects().into_iter().chain(outside(kind));
    let mut hidden = names.map(|name| hidden(name, &scale, &mut rng)).collect::<Vec<_>>();
    let mut described = described;
    if let Kind::Lumped(_) = kind {
        // As in the paper: the description counts the carriage into the mass that acts both ways.
        hidden = vec![Hidden::CarriageMass { mass_kg: actual.carriage_mass_kg }];
        described.diaphragm_mass_kg += described.carriage_mass_kg;
        described.carriage_mass_kg = 0.0;
        actual.carriage_mass_kg = 0.0;
    }
    Case {
        set: set.to_owned(),
        number,
        kind,
        simulator,
        prior,
        noise_rad,
        size,
        described,
        actual,
        hidden,
        fit_tests,
        hold_out_tests,
        target_rad,
        held_out_amplitude: 1.0,
        contacts: Contacts::SharpEdges,
    }
}

/// The wall with plastic impacts, C_l = 1, which compliant corners have by themselves.
///
/// With Table 2 a ground impact has another coefficient as soon as the crack is open, be it by 1e-8 rad. Instantaneous and
/// compliant contact then part by as much as an effect would part them, and a case would hide that too.
pub fn plastic(wall: WallNumbers) -> WallNumbers {
    WallNumbers { coefficients: [1.0; 8], ..wall }
}

fn outside(kind: Kind) -> Option<&'static str> {
    if let Kind::Outside(law) = kind { Some(law) } else { None }
}

fn prior(kind: Kind, rng: &mut ChaCha8Rng) -> Prior {
    match kind {
        Kind::Lumped(Freedom::Nothing) => Prior::Known,
        Kind::Lumped(Freedom::Stiffness) => Prior::StiffnessFree,
        Kind::Lumped(Freedom::StiffnessAndImpacts) => Prior::StiffnessAndImpactsFree,
        _ if rng.random_range(0.0..1.0) < 0.75 => Prior::Known,
        _ => Prior::StiffnessFree,
    }
}

/// The wall within what is known of it: k_d off by its prior, at most twice; masses by theirs.
pub fn scatter(described: &WallNumbers, prior: Prior, rng: &mut ChaCha8Rng) -> WallNumbers {
    let mut factor = |sd: f64| 1.0 + sd * rng.random_range(-1.0..1.0) * 3f64.sqrt();
    let k_d = factor(prior.stiffness());
    let m = factor(Prior::MASS);
    WallNumbers {
        stiffness_n_per_m: described.stiffness_n_per_m * k_d,
        mass_kg: described.mass_kg * m,
        ..described.clone()
    }
}

impl Prior {
    /// Relative standard deviation of the wall's mass.
    pub const MASS: f64 = 0.01;

    /// Relative standard deviation of k_d.
    pub fn stiffness(self) -> f64 {
        match self {
            Prior::Known => 0.02,
            Prior::StiffnessFree | Prior::StiffnessAndImpactsFree => 0.3,
        }
    }

    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Prior::Known => "k_d to 2 %",
            Prior::StiffnessFree => "k_d to 30 %",
            Prior::StiffnessAndImpactsFree => "k_d to 30 %, C_l to 10 %",
        }
    }
}

impl Case {
    /// Which formulation made it, in tables.
    pub fn formulation(&self) -> &'static str {
        match (self.simulator, self.contacts) {
            (Simulator::Own, _) => "own",
            (Simulator::Compliant, Contacts::SharpEdges) => "compliant",
            (Simulator::Compliant, Contacts::Corners(_)) => "corners",
            (Simulator::Compliant, Contacts::Springs { .. }) => "springs",
        }
    }
}
