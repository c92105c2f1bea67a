//! Time of one run, beside the work it did: `make bench`.
//!
//! The baseline in the same run is the arithmetic itself: as many evaluations of the equations of motion as the run
//! makes, without events, error control or accounts.

use std::fmt;
use std::hint::black_box;

use divan::{Bencher, counter::ItemsCount};
use mrbd_kernel::accelerogram::Accelerogram;
use mrbd_kernel::model::{Contact, ImpactLaw, Pivot, RockingWall, State, Vector};
use mrbd_kernel::simulate::{Accuracy, Shaking, simulate};

use table_wall::{earthquake, table_wall};

mod table_wall;

struct Case {
    motion: Motion,
    law: ImpactLaw,
    capture_velocity_rad_s: f64,
}

const CASES: [Case; 6] = {
    use ImpactLaw::{Contact, Whole};
    use Motion::{Earthquake, Relentless};
    [
        Case { motion: Earthquake, law: Whole, capture_velocity_rad_s: 1e-3 },
        Case { motion: Earthquake, law: Whole, capture_velocity_rad_s: 1e-6 },
        Case { motion: Earthquake, law: Contact, capture_velocity_rad_s: 1e-3 },
        Case { motion: Relentless, law: Whole, capture_velocity_rad_s: 1e-3 },
        Case { motion: Relentless, law: Whole, capture_velocity_rad_s: 1e-6 },
        Case { motion: Relentless, law: Contact, capture_velocity_rad_s: 1e-3 },
    ]
};

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}, {}, capture {:e}", self.motion, self.law.name(), self.capture_velocity_rad_s)
    }
}

fn main() {
    for case in &CASES {
        let wall = table_wall(case.law, case.capture_velocity_rad_s);
        let response = simulate(&wall, &shaking(case.motion), Accuracy::default());
        let tight = simulate(&wall, &shaking(case.motion), Accuracy { tolerance: 1e-11 });
        let [lower, upper] = response.theta_max_over_alpha_i();
        let error = (lower / tight.theta_max_over_alpha_i()[0] - 1.0).abs();
        eprintln!(
            "{case}: {}, θ/α {lower:.4} {upper:.4} (error {error:.0e}), {} impacts, {} openings, {} steps, \
             {} tried again, {} evaluations",
            response.outcome.name(),
            response.impacts.total(),
            response.openings.total(),
            response.work.steps,
            response.work.rejected_steps,
            response.work.evaluations
        );
    }
    divan::main();
}

/// Thirty seconds at 0.005 s that rock the wall from start to end.
#[derive(Debug, Clone, Copy)]
enum Motion {
    /// The sixth record of the shipped suite, the one with the largest velocity, and free motion up to thirty seconds.
    Earthquake,
    /// Ten sines under an envelope: no pause, and three times as many impacts.
    Relentless,
}

fn shaking(motion: Motion) -> Shaking {
    let horizontal = match motion {
        Motion::Earthquake => earthquake(),
        Motion::Relentless => relentless(),
    };
    let tail_s = 30.0 - horizontal.duration_s();
    Shaking { horizontal: Some(horizontal), vertical: None, tail_s }
}

fn relentless() -> Accelerogram {
    let step_s = 0.005;
    let samples = (0..6000).map(|k| {
        let t = f64::from(k) * step_s;
        let envelope = (t / 2.0).min(1.0) * ((30.0 - t) / 5.0).min(1.0);
        let waves: f64 = (1..=10).map(|n| (6.1 * f64::from(n) * t / 1.7 + f64::from(n * n)).sin()).sum();
        0.42 * envelope * waves
    });
    Accelerogram::new(step_s, samples.collect()).expect("a valid record")
}

#[divan::bench(args = CASES)]
fn table_wall_thirty_seconds(bencher: Bencher, case: &Case) {
    let wall = table_wall(case.law, case.capture_velocity_rad_s);
    let shaking = shaking(case.motion);
    bencher.bench_local(|| simulate(black_box(&wall), black_box(&shaking), Accuracy::default()));
}

/// Thirty-six thousand evaluations of the two-body motion: six a sample over thirty seconds.
#[divan::bench]
fn baseline_arithmetic(bencher: Bencher) {
    let wall = RockingWall::new(&table_wall(ImpactLaw::Whole, 1e-3));
    let contact = Contact { ground: Pivot::Right, crack: Pivot::Left };
    let evaluations = 36_000_u32;
    bencher.counter(ItemsCount::new(evaluations)).bench_local(|| {
        let mut state = State { theta: [0.01, -0.01], omega: [0.1, 0.1] };
        for _ in 0..evaluations {
            let rate = wall.rate(contact, black_box(&state), Vector { x: 1.0, y: 0.0 });
            state.theta[0] = 0.01 + 1e-12 * rate.theta_dd[0];
        }
        state
    });
}
