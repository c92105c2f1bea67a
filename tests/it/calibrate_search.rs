//! The searches on functions with known minima.

use mrbd_files::Result;
use mrbd_lab::calibrate::{Bounds, CmaEs, Draws, Evaluate, F, PaperDe, first_generation};

const N: usize = 8;

/// A function in place of a simulation.
struct Function(fn(&[f64]) -> f64);

impl Evaluate for Function {
    fn costs_below(&mut self, _: u32, candidates: &[Vec<f64>], most: &[f64]) -> Result<Vec<f64>> {
        let cost = |x: &[f64], most: f64| Some((self.0)(x)).filter(|cost| *cost <= most);
        Ok(candidates.iter().zip(most).map(|(x, most)| cost(x, *most).unwrap_or(f64::INFINITY)).collect())
    }
}

/// Σ (x - 0.3)²: smooth, the same in every direction.
fn sphere(x: &[f64]) -> f64 {
    x.iter().map(|x| (x - 0.3).powi(2)).sum()
}

/// |sum of differences| along a narrow slanting valley, like C_1 and C_2 in a burst of impacts.
fn valley(x: &[f64]) -> f64 {
    let across = x.windows(2).map(|w| (w[0] + w[1] - 0.6).abs()).sum::<f64>();
    100.0 * across + x.iter().map(|x| (x - 0.3).abs()).sum::<f64>()
}

fn unit() -> Vec<Bounds> {
    vec![Bounds { lower: 0.0, upper: 1.0 }; N]
}

fn paper() -> PaperDe {
    PaperDe { population: 21, settle_share: 0.0, settle_generations: 400, most_generations: 400 }
}

#[test]
fn published_first_generation_has_every_spaced_value_once_in_each_row() {
    assert_eq!(F, 0.9);
    let bounds = [Bounds { lower: 0.9, upper: 1.05 }, Bounds { lower: 0.7, upper: 0.8 }];
    let generation = first_generation(21, &bounds, &Draws::new(1, ""));
    for (r, bound) in bounds.iter().enumerate() {
        let mut row = generation.iter().map(|vector| vector[r]).collect::<Vec<_>>();
        assert!(!row.is_sorted(), "the order of row {r} is random");
        row.sort_by(f64::total_cmp);
        for (j, value) in row.iter().enumerate() {
            // A rounding of a number near one.
            assert!((value - bound.at(j as f64 / 20.0)).abs() < 1e-15);
        }
    }
}

#[test]
fn analytic_every_search_finds_the_minimum_of_a_sphere() {
    let draws = Draws::new(3, "sphere");
    let found = paper().minimise(&unit(), &draws, &mut Function(sphere)).expect("no simulation");
    // 8400 evaluations of differential evolution with F = 0.9, which contracts slowly: distances below 0.01.
    assert!(found.best().cost < 1e-4, "{}", found.best().cost);
    let mut cloud = CmaEs::new(&[0.9; N], &unit(), 0.3, 12);
    let found = cloud.minimise(&unit(), 3000, 0.0, &draws, &mut Function(sphere)).expect("no simulation");
    // Linear convergence by about a tenth every 10 n evaluations.
    assert!(found.best().cost < 1e-16, "{}", found.best().cost);
}

#[test]
fn analytic_the_cloud_goes_down_a_slanting_valley_further_than_differential_evolution() {
    let draws = Draws::new(5, "valley");
    let mut cloud = CmaEs::new(&[0.5; N], &unit(), 0.3, 24);
    let cma = cloud.minimise(&unit(), 6000, 0.0, &draws, &mut Function(valley)).expect("no simulation");
    let de = paper().minimise(&unit(), &draws, &mut Function(valley)).expect("no simulation");
    // The valley's floor falls by 1 for each unit of a variable: 0.01 is a hundredth of the bounds in all.
    assert!(cma.best().cost < 0.01, "{}", cma.best().cost);
    assert!(cma.best().cost < de.best().cost, "{} and {}", cma.best().cost, de.best().cost);
}

#[test]
fn analytic_values_past_a_bound_are_set_to_it() {
    let slope = |x: &[f64]| x.iter().sum::<f64>();
    let found = paper().minimise(&unit(), &Draws::new(1, ""), &mut Function(slope)).expect("no simulation");
    assert_eq!(found.best().values, vec![0.0; N], "the minimum lies in the corner, exactly");
}

#[test]
fn analytic_the_best_never_gets_worse_and_the_sum_settles() {
    let settling = PaperDe { settle_share: 1e-2, settle_generations: 5, ..paper() };
    let found = settling.minimise(&unit(), &Draws::new(2, ""), &mut Function(sphere)).expect("no simulation");
    assert!(found.cost_sums.is_sorted_by(|a, b| a >= b) && found.best_costs.is_sorted_by(|a, b| a >= b));
    let flat = settling.minimise(&unit(), &Draws::new(2, ""), &mut Function(|_| 1.0)).expect("no simulation");
    // A cost that cannot fall has settled as soon as five generations have shown it.
    assert_eq!(flat.cost_sums.len(), 6);
    assert_eq!(flat.evaluations, 6 * 21);
}
