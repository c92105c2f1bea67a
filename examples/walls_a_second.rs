//! Walls a second by what acts on them, beside each other and alone: `walls_a_second` (`make bench-against`).
//!
//! Façades drawn from Table 3 run under two shipped records, on one thread. One line a kind and a way to run: kind,
//! way, runs, processor time in s, evaluations, and a fingerprint of all responses. Kernels that do the same have
//! the same fingerprints.

use std::error::Error;
use std::hash::{DefaultHasher, Hash, Hasher};

use mrbd_kernel::model::{Effect, Wall, WallParameters};
use mrbd_kernel::simulate::{Accuracy, Response, Shaking, Simulator, simulate, simulate_side_by_side};

#[path = "../benches/walls/mod.rs"]
mod walls;

/// Façades of each configuration, fewer on beds, whose runs take ten times as many evaluations.
const DRAWS: [u64; 2] = [32, 12];

/// An effect of the catalogue and its parameters; `None`: the model of the paper alone.
type Law = Option<(&'static str, &'static [f64])>;

/// What acts on the walls, and how many are drawn of them.
const KINDS: [(&str, Law, u64); 7] = [
    ("sharp edges", None, DRAWS[0]),
    ("damper at the top", Some(("viscous_damping", &[3000.0])), DRAWS[0]),
    ("damper in the crack", Some(("joint_damping.crack", &[200.0])), DRAWS[0]),
    ("cubic spring", Some(("cubic_stiffness", &[1e7])), DRAWS[0]),
    ("friction at the top", Some(("coulomb_friction", &[800.0])), DRAWS[0]),
    ("bed under the wall", Some(("compliant_joint.ground", &[2e9, 4e-4])), DRAWS[1]),
    ("beds in both joints", Some(("compliant_joint.both", &[2e9, 4e-4])), DRAWS[1]),
];

fn main() -> Result<(), Box<dyn Error>> {
    let shakings: Vec<Shaking> = walls::records().iter().take(2).map(walls::shaking).collect();
    for (kind, effect, draws) in KINDS {
        let effect = effect.map(|(name, values)| Effect::with_parameters(name, values)).transpose()?;
        let with = |wall: Wall| {
            let effects = effect.into_iter().collect();
            Wall::new(WallParameters { effects, ..wall.parameters().clone() })
        };
        let walls = walls::facades(draws).into_iter().map(with).collect::<Result<Vec<_>, _>>()?;
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
    // Nanoseconds, since Linux 2.6.23.
    let schedule = std::fs::read_to_string("/proc/thread-self/schedstat")?;
    let nanoseconds: f64 = schedule.split_whitespace().next().ok_or("an empty schedstat")?.parse()?;
    Ok(nanoseconds * 1e-9)
}
