//! Runs a second on one and two threads: `make bench`.
//!
//! The Monte Carlo of Table 3 (both configurations, seven records, free motion after each) and a reference case of the
//! sweep, in turns, so that a machine whose speed drifts tells the same ratios; medians and what lies around them. Beside
//! them the bare evaluations of the equations of motion that such a run makes, timed in the same turns.

use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use mrbd::batch::{self, Finished};
use mrbd::input::pipeline::Pipeline;
use mrbd::model::{Contact, Pivot, RockingWall, State, Vector, Wall};
use mrbd::plan::Plan;
use mrbd::simulate::{Accuracy, Shaking, simulate};
use rayon::prelude::*;

mod walls;

const TURNS: usize = 9;
/// Draws of each configuration; seven records make 2 100 runs of them.
const DRAWS: u64 = 150;

struct Study {
    runs: Vec<(Wall, usize)>,
    shakings: Vec<Shaking>,
}

impl Study {
    fn new() -> Self {
        let shakings: Vec<Shaking> = walls::records().iter().map(walls::shaking).collect();
        let walls = walls::facades(DRAWS);
        let runs =
            (0..shakings.len()).flat_map(|record| walls.iter().map(move |w| (w.clone(), record))).collect();
        Self { runs, shakings }
    }

    /// Evaluations of all runs.
    fn run(&self) -> u64 {
        let one = |(wall, record): &(Wall, usize)| {
            simulate(wall, &self.shakings[*record], Accuracy::default()).work.evaluations
        };
        self.runs.par_iter().map(one).sum()
    }
}

/// One parameter of one configuration at its levels: nine slendernesses, three levels, seven records.
fn reference_case() -> (Plan, Vec<u64>) {
    let pipeline = Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines/sweep.toml");
    let plan = Plan::load(&Pipeline::load(&pipeline).expect("the sweep"), None).expect("the sweep's plan");
    let first = plan.run(0).expect("a run");
    let of_case = |position: &u64| {
        let run = plan.run(*position).expect("a run");
        run.variant.name == first.variant.name
            && run.configuration == first.configuration
            && run.parameter == first.parameter
    };
    let positions = (0..plan.len()).filter(of_case).collect();
    (plan, positions)
}

/// Bare evaluations, each waiting for the one before, as those of a run do.
fn arithmetic(wall: &RockingWall, evaluations: u32) -> State {
    let contact = Contact { ground: Pivot::Right, crack: Pivot::Left };
    let mut state = State { theta: [0.01, -0.01], omega: [0.1, 0.1] };
    for _ in 0..evaluations {
        let rate = wall.rate(contact, black_box(&state), Vector { x: 1.0, y: 0.0 });
        state.theta[0] = 0.01 + 1e-12 * rate.theta_dd[0];
    }
    state
}

fn seconds<T>(work: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    black_box(work());
    start.elapsed().as_secs_f64()
}

/// Median, least and most.
fn spread(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [values[values.len() / 2], values[0], values[values.len() - 1]]
}

fn main() {
    let pools = [1, 2].map(|threads| batch::threads(threads).expect("threads"));
    let study = Study::new();
    let (plan, positions) = reference_case();
    let bar = indicatif::ProgressBar::hidden();
    let case = || -> Vec<Finished> {
        batch::run_all(&plan, positions.clone(), &simulate, &bar).expect("the reference case")
    };
    let evaluations = study.run();
    let wall = RockingWall::new(&study.runs[0].0);
    let bare = 100_000;
    let mut times: [Vec<f64>; 5] = Default::default();
    for _ in 0..TURNS {
        times[0].push(seconds(|| arithmetic(&wall, bare)) / f64::from(bare));
        for (i, pool) in pools.iter().enumerate() {
            times[1 + i].push(pool.install(|| seconds(|| study.run())));
            times[3 + i].push(pool.install(|| seconds(case)));
        }
    }
    let scaling = spread(times[1].iter().zip(&times[2]).map(|(one, two)| one / two).collect());
    let runs = study.runs.len() as f64;
    let [evaluation, ..] = spread(times[0].clone());
    let print = |what: &str, [median, least, most]: [f64; 3], unit: &str| {
        println!("{what:<58} {median:>9.4} ({least:.4} … {most:.4}) {unit}");
    };
    print("bare evaluation", spread(times[0].iter().map(|t| t * 1e9).collect()), "ns");
    for (i, threads) in ["one thread", "two threads"].iter().enumerate() {
        let rates = times[1 + i].iter().map(|t| runs / t).collect();
        print(&format!("Monte Carlo of Table 3, {runs} runs, {threads}"), spread(rates), "runs/s");
        print(
            &format!("reference case, {} runs, {threads}", positions.len()),
            spread(times[3 + i].clone()),
            "s",
        );
    }
    print("two threads over one, Monte Carlo", scaling, "");
    let [one, ..] = spread(times[1].clone());
    let share = evaluations as f64 * evaluation / one;
    println!("evaluations a run: {:.0}; bare, they are {share:.2} of its time", evaluations as f64 / runs);
}
