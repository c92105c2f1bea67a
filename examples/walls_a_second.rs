//! Walls a second by what acts on them, beside each other and alone: `walls_a_second` (`make bench-against`).
//!
//! Façades drawn from Table 3 run under two shipped records, on one thread. One line a kind and a way to run: kind,
//! way, runs, processor time in s, evaluations, and a fingerprint of all responses. Kernels that do the same have
//! the same fingerprints.

use std::error::Error;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::time::Duration;

use mrbd_formula::{Formula, Parameter, Place};
use mrbd_kernel::model::{Effect, Wall, WallParameters};
use mrbd_kernel::simulate::{Accuracy, Response, Shaking, Simulator, simulate, simulate_side_by_side};

#[path = "../benches/walls/mod.rs"]
mod walls;

/// Façades of each configuration, fewer on beds, whose runs take ten times as many evaluations.
const DRAWS: [u64; 2] = [32, 12];

/// What acts on a wall beyond the model of the paper.
enum Law {
    Nothing,
    /// An effect of the catalogue and its parameters.
    Effect(&'static str, &'static [f64]),
    /// A formula and its parameter: name, value and unit.
    Formula(Place, &'static str, (&'static str, f64, &'static str)),
}

/// What acts on the walls, and how many are drawn of them.
const KINDS: [(&str, Law, u64); 10] = [
    ("sharp edges", Law::Nothing, DRAWS[0]),
    ("damper at the top", Law::Effect("viscous_damping", &[3000.0]), DRAWS[0]),
    ("damper in the crack", Law::Effect("joint_damping.crack", &[200.0]), DRAWS[0]),
    ("cubic spring", Law::Effect("cubic_stiffness", &[1e7]), DRAWS[0]),
    ("friction at the top", Law::Effect("coulomb_friction", &[800.0]), DRAWS[0]),
    ("formula at the top", Law::Formula(Place::Top, "-c*v", ("c", 3000.0, "N*s/m")), DRAWS[0]),
    (
        "power at the top",
        Law::Formula(Place::Top, "-c*sign(v)*abs(v)**1.3", ("c", 3000.0, "N*(s/m)**1.3")),
        DRAWS[0],
    ),
    ("formula in the crack", Law::Formula(Place::Crack, "-c*w", ("c", 200.0, "N*m*s")), DRAWS[0]),
    ("bed under the wall", Law::Effect("compliant_joint.ground", &[2e9, 4e-4]), DRAWS[1]),
    ("beds in both joints", Law::Effect("compliant_joint.both", &[2e9, 4e-4]), DRAWS[1]),
];

impl Law {
    /// Every wall with it: a formula is read once, as of a wall file.
    fn on(&self, walls: &[Wall]) -> Result<Vec<Wall>, Box<dyn Error>> {
        let (effect, formula) = match self {
            Law::Nothing => (None, None),
            Law::Effect(name, values) => (Some(Effect::with_parameters(name, values)?), None),
            Law::Formula(place, text, (name, value, unit)) => {
                let own = [Parameter::new(name, *value, unit)];
                (None, Some(Formula::parse(text, *place, &own)?))
            }
        };
        let with = |wall: &Wall| {
            let mut parameters: WallParameters = wall.parameters().clone();
            parameters.effects.extend(effect);
            parameters.formulas.extend(formula.clone());
            Ok(Wall::new(parameters)?)
        };
        walls.iter().map(with).collect()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let shakings: Vec<Shaking> = walls::records().iter().take(2).map(walls::shaking).collect();
    for (kind, law, draws) in KINDS {
        let walls = law.on(&walls::facades(draws))?;
        tell(kind, "beside", || beside(&walls, &shakings))?;
        tell(kind, "alone", || alone(&walls, &shakings))?;
    }
    Ok(())
}

fn tell(kind: &str, way: &str, run: impl Fn() -> Vec<Response>) -> Result<(), Box<dyn Error>> {
    let before_s = processor_s()?;
    let responses = run();
    let spent_s = processor_s()? - before_s;
    let evaluations: u64 = responses.iter().map(|response| response.work.evaluations).sum();
    let mut fingerprint = DefaultHasher::new();
    // Numbers are written so that they read back as the same bits.
    responses.iter().for_each(|response| format!("{response:?}").hash(&mut fingerprint));
    let (runs, fingerprint) = (responses.len(), fingerprint.finish());
    println!("{kind},{way},{runs},{spent_s:.4},{evaluations},{fingerprint:016x}");
    Ok(())
}

fn alone(walls: &[Wall], shakings: &[Shaking]) -> Vec<Response> {
    let under = |shaking| walls.iter().map(move |wall| simulate(wall, shaking, Accuracy::default()));
    shakings.iter().flat_map(under).collect()
}

fn beside(walls: &[Wall], shakings: &[Shaking]) -> Vec<Response> {
    let under = |shaking| {
        let simulator = Simulator::new(&walls[0], shaking, Accuracy::default());
        walls.iter().map(move |wall| simulator.with_wall(wall, Accuracy::default()).prepared())
    };
    let mut waiting = shakings.iter().flat_map(under).enumerate();
    let mut responses = vec![None; walls.len() * shakings.len()];
    simulate_side_by_side(&mut || waiting.next(), &mut |number, response| {
        responses[number] = Some(response);
    });
    responses.into_iter().flatten().collect()
}

/// Time that this thread has had of a processor, s: other programs' is not in it.
fn processor_s() -> Result<f64, Box<dyn Error>> {
    // The system brings its account up to date when a thread gives its processor away, else every 10 ms.
    std::thread::sleep(Duration::from_nanos(1));
    // Nanoseconds, since Linux 2.6.23.
    let schedule = std::fs::read_to_string("/proc/thread-self/schedstat")?;
    let nanoseconds: f64 = schedule.split_whitespace().next().ok_or("an empty schedstat")?.parse()?;
    Ok(nanoseconds * 1e-9)
}
