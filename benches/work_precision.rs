//! Error of one step against the evaluations it takes, for integrators on walls of the survey: `make bench`.
//!
//! Façades drawn from Table 3 are run; from states along the way every method takes one sample in one step, in two and in
//! four. Its error is that against the finest method in thirty-two steps, as the solver scales it: rotations over α_i,
//! velocities times the time of response. Every method is written as a Nyström method, by its weights of accelerations.

use mrbd_kernel::model::{Contact, Pair, RockingWall, State, Vector};
use mrbd_kernel::simulate::{Accuracy, Observer, simulate_observed};
use mrbd_kernel::solver::Quintic;

mod walls;

/// Weights of accelerations: of the stages' velocities, of their positions, and of the step's.
struct Method {
    name: &'static str,
    /// Evaluations a step takes, that at its end included.
    evaluations: f64,
    nodes: Vec<f64>,
    velocity: Vec<Vec<f64>>,
    position: Vec<Vec<f64>>,
    end_velocity: Vec<f64>,
    end_position: Vec<f64>,
}

impl Method {
    /// A method of first order as one of second: positions are integrals of the stages' velocities.
    fn of_first_order(
        name: &'static str,
        evaluations: f64,
        velocity: Vec<Vec<f64>>,
        weights: Vec<f64>,
    ) -> Self {
        let twice = |row: &[f64]| -> Vec<f64> {
            let of = |j: usize| row.iter().zip(&velocity).map(|(a, r)| a * r.get(j).unwrap_or(&0.0)).sum();
            (0..row.len()).map(of).collect()
        };
        let position = velocity.iter().map(|row| twice(row)).collect();
        let end_position = twice(&weights);
        let nodes = velocity.iter().map(|row| row.iter().sum()).collect();
        Self { name, evaluations, nodes, position, end_position, end_velocity: weights, velocity }
    }

    fn step(&self, start: State, from_s: f64, h: f64, case: &Case) -> State {
        let mut rates: Vec<Pair> = Vec::with_capacity(7);
        let moved = |rates: &[Pair], c: f64, x: &[f64], v: &[f64]| {
            let sum = |w: &[f64], i: usize| w.iter().zip(rates).map(|(w, r)| w * r[i]).sum::<f64>();
            State {
                theta: [0, 1].map(|i| start.theta[i] + c * h * start.omega[i] + h * h * sum(x, i)),
                omega: [0, 1].map(|i| start.omega[i] + h * sum(v, i)),
            }
        };
        for (stage, c) in self.nodes.iter().enumerate() {
            let state = moved(&rates, *c, &self.position[stage], &self.velocity[stage]);
            rates.push(case.theta_dd(&state, from_s + c * h));
        }
        moved(&rates, 1.0, &self.end_position, &self.end_velocity)
    }

    /// A sample in so many steps.
    fn sample(&self, case: &Case, steps: usize) -> State {
        let h = case.step_s / steps as f64;
        (0..steps).fold(case.start, |state, k| self.step(state, k as f64 * h, h, case))
    }
}

fn methods() -> [Method; 4] {
    let dormand_prince = vec![
        vec![],
        vec![1.0 / 5.0],
        vec![3.0 / 40.0, 9.0 / 40.0],
        vec![44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
        vec![19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
        vec![9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    ];
    let weights = vec![35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0];
    let classical = vec![vec![], vec![0.5], vec![0.0, 0.5], vec![0.0, 0.0, 1.0]];
    let nystrom_5 = Method {
        name: "Nyström 1925, order 5, velocities of order 3",
        evaluations: 4.0,
        nodes: vec![0.0, 0.2, 2.0 / 3.0, 1.0],
        velocity: vec![vec![], vec![0.2], vec![-4.0 / 9.0, 10.0 / 9.0], vec![2.0, -20.0 / 7.0, 13.0 / 7.0]],
        position: vec![
            vec![],
            vec![1.0 / 50.0],
            vec![-1.0 / 27.0, 7.0 / 27.0],
            vec![3.0 / 10.0, -2.0 / 35.0, 9.0 / 35.0],
        ],
        end_velocity: vec![14.0 / 336.0, 125.0 / 336.0, 162.0 / 336.0, 35.0 / 336.0],
        end_position: vec![14.0 / 336.0, 100.0 / 336.0, 54.0 / 336.0],
    };
    let kept = Method {
        name: "Dormand, El-Mikkawy and Prince 1987, order 6, velocities of order 5 (kept)",
        evaluations: 6.0,
        nodes: vec![0.0, 0.1, 0.3, 0.7, 0.68, 1.0],
        velocity: vec![
            vec![],
            vec![0.1],
            vec![-9.0 / 55.0, 51.0 / 110.0],
            vec![28.0 / 165.0, -49.0 / 110.0, 161.0 / 165.0],
            vec![6392.0 / 140625.0, -233189.0 / 562500.0, 1283279.0 / 1125000.0, -103037.0 / 1125000.0],
            vec![-284.0 / 1071.0, 685.0 / 1044.0, 155.0 / 1368.0, 1595.0 / 504.0, -25000.0 / 9367.0],
        ],
        position: vec![
            vec![],
            vec![1.0 / 200.0],
            vec![-1.0 / 2200.0, 1.0 / 22.0],
            vec![637.0 / 6600.0, -7.0 / 110.0, 7.0 / 33.0],
            vec![225437.0 / 1968750.0, -30073.0 / 281250.0, 65569.0 / 281250.0, -9367.0 / 984375.0],
            vec![151.0 / 2142.0, 5.0 / 116.0, 385.0 / 1368.0, 55.0 / 168.0, -6250.0 / 28101.0],
        ],
        end_velocity: vec![
            151.0 / 2142.0,
            25.0 / 522.0,
            275.0 / 684.0,
            275.0 / 252.0,
            -78125.0 / 112404.0,
            1.0 / 12.0,
        ],
        end_position: vec![151.0 / 2142.0, 5.0 / 116.0, 385.0 / 1368.0, 55.0 / 168.0, -6250.0 / 28101.0],
    };
    let sixths = vec![1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];
    [
        Method::of_first_order("classical Runge–Kutta, order 4", 4.0, classical, sixths),
        Method::of_first_order("Dormand and Prince 1980, order 5", 6.0, dormand_prince, weights),
        nystrom_5,
        kept,
    ]
}

/// A state on the way of a run, and the ground from there.
struct Case {
    wall: RockingWall,
    contact: Contact,
    start: State,
    ground_m_s2: f64,
    slope_m_s3: f64,
    step_s: f64,
}

impl Case {
    fn theta_dd(&self, state: &State, after_s: f64) -> Pair {
        let ground = Vector { x: self.ground_m_s2 + self.slope_m_s3 * after_s, y: 0.0 };
        self.wall.rate(self.contact, state, ground).theta_dd
    }

    fn error(&self, found: &State, exact: &State) -> f64 {
        let (alpha, time_s) = (self.wall.wall().alpha_i_rad(), self.wall.response_time_s());
        let of = |i: usize| {
            let position = (found.theta[i] - exact.theta[i]).abs();
            position.max((found.omega[i] - exact.omega[i]).abs() * time_s) / alpha[i]
        };
        f64::max(of(0), of(1))
    }
}

/// Keeps every so many-th start of a step.
#[derive(Default)]
struct Starts {
    seen: usize,
    kept: Vec<(f64, Contact, State)>,
}

const EVERY: usize = 61;

impl Observer for Starts {
    fn moved(&mut self, start_s: f64, contact: Contact, motion: &Quintic) {
        self.seen += 1;
        if self.seen.is_multiple_of(EVERY) {
            let state = State { theta: motion.position(0.0), omega: motion.velocity(0.0) };
            self.kept.push((start_s, contact, state));
        }
    }

    fn stood(&mut self, _: f64, _: f64) {}

    fn ended(&mut self, _: f64, _: Contact, _: Pair) {}
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    let records = walls::records();
    for (index, wall) in walls::facades(60).into_iter().enumerate() {
        let record = &records[index % records.len()];
        let mut starts = Starts::default();
        simulate_observed(&wall, &walls::shaking(record), Accuracy::default(), &mut starts);
        let (a, step_s) = (record.acceleration_m_s2(), record.step_s());
        let sample = |k: usize| a.get(k).copied().unwrap_or(0.0);
        cases.extend(starts.kept.into_iter().map(|(start_s, contact, start)| {
            let k = (start_s / step_s) as usize;
            let slope_m_s3 = (sample(k + 1) - sample(k)) / step_s;
            let ground_m_s2 = sample(k) + slope_m_s3 * (start_s - k as f64 * step_s);
            Case { wall: RockingWall::new(&wall), contact, start, ground_m_s2, slope_m_s3, step_s }
        }));
    }
    cases
}

fn main() {
    let (cases, methods) = (cases(), methods());
    let exact: Vec<State> = cases.iter().map(|case| methods[3].sample(case, 32)).collect();
    println!("error of a sample over {} states of façades of Table 3:", cases.len());
    println!("{:>12} {:>9} {:>9} {:>9}  method", "evaluations", "median", "90 %", "99 %");
    for method in &methods {
        for steps in [1, 2, 4] {
            let of = |(case, exact): (&Case, &State)| case.error(&method.sample(case, steps), exact);
            let mut errors: Vec<f64> = cases.iter().zip(&exact).map(of).collect();
            errors.sort_by(f64::total_cmp);
            let [half, nine, most] = [0.5, 0.9, 0.99].map(|q| errors[(q * errors.len() as f64) as usize]);
            let evaluations = method.evaluations * steps as f64;
            println!("{evaluations:>12} {half:>9.1e} {nine:>9.1e} {most:>9.1e}  {}", method.name);
        }
    }
}
