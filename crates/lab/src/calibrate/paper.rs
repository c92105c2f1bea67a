//! The paper's own search: differential evolution in each test (section 3.1, steps (a) to (g), Fig. 5), and one vector for all
//! tests by cosine similarity (Eq. 10).
//!
//! Vectors of positive numbers near one all point nearly the same way, so similarities differ by thousandths only. The
//! vector chosen is the one nearest to the middle of the last generations: it says nothing about misfits. That is why the
//! report shows the misfit of this vector beside that of a direct joint search.

use rand::RngExt;
use rand::seq::SliceRandom;

use super::search::{Bounds, Draws, Evaluate, Found, Member, different, members};
use mrbd_files::error::Result;

/// F of step (d), after Carboni et al. (2015).
pub const F: f64 = 0.9;

/// Places of the draws of a candidate: its variables first, then these.
const PICK_ABC: u32 = 1 << 16;

/// What the paper fixes, and what it leaves open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperDe {
    /// c of step (a): columns of the generation matrix. The paper's: 21.
    pub population: usize,
    /// The sum of costs has settled when it falls by less than this share of itself ... The paper gives no number.
    pub settle_share: f64,
    /// ... over this many generations.
    pub settle_generations: usize,
    /// Generations after which the search ends anyway.
    pub most_generations: u32,
}

impl PaperDe {
    /// Minimises the cost from the first generation until the sum of costs settles.
    ///
    /// # Errors
    /// What the evaluation meets.
    pub fn minimise(&self, bounds: &[Bounds], draws: &Draws, evaluate: &mut dyn Evaluate) -> Result<Found> {
        let first = first_generation(self.population, bounds, draws);
        let costs = evaluate.costs(0, &first)?;
        let mut found = Found::start(members(first, costs));
        for generation in 1..=self.most_generations {
            let trials = (0..self.population)
                .map(|j| trial_vector(&found.population, j, generation, bounds, draws))
                .collect::<Vec<_>>();
            // A trial that costs more than its target is not kept, however much more.
            let most = found.population.iter().map(|t_av| t_av.cost).collect::<Vec<_>>();
            let costs = evaluate.costs_below(generation, &trials, &most)?;
            found.evaluations += trials.len();
            // (g) The cheaper of trial and target becomes the j-th column of the last generation.
            for (t_av, t_rv) in found.population.iter_mut().zip(members(trials, costs)) {
                if t_rv.cost < t_av.cost {
                    *t_av = t_rv;
                }
            }
            found.note();
            if self.has_settled(&found.cost_sums) {
                break;
            }
        }
        Ok(found)
    }

    fn has_settled(&self, sums: &[f64]) -> bool {
        let Some(earlier) = sums.len().checked_sub(1 + self.settle_generations) else { return false };
        let (before, now) = (sums[earlier], sums[sums.len() - 1]);
        before.is_finite() && before - now <= self.settle_share * before
    }
}

/// (a) For each row, values linearly spaced between its bounds in a random order.
pub fn first_generation(columns: usize, bounds: &[Bounds], draws: &Draws) -> Vec<Vec<f64>> {
    let row = |(r, bound): (usize, &Bounds)| {
        let spaced = |j: usize| bound.at(j as f64 / (columns - 1) as f64);
        let mut values = (0..columns).map(spaced).collect::<Vec<_>>();
        values.shuffle(&mut draws.of(0, 0, r as u32));
        values
    };
    let matrix = bounds.iter().enumerate().map(row).collect::<Vec<_>>();
    (0..columns).map(|j| matrix.iter().map(|row| row[j]).collect()).collect()
}

/// (b) to (f): the trial vector T_RV against the target vector in column j.
fn trial_vector(
    population: &[Member],
    j: usize,
    generation: u32,
    bounds: &[Bounds],
    draws: &Draws,
) -> Vec<f64> {
    let t_av = &population[j].values;
    // (c) Three vectors, different from each other and from the target.
    let [a, b, c] = different::<3>(&mut draws.of(generation, j as u32, PICK_ABC), population.len(), j)
        .map(|k| &population[k].values);
    let component = |r: usize| {
        // (d) Mutation; past a bound it is set to the bound.
        let m_v = bounds[r].clamp(c[r] + F * (a[r] - b[r]));
        // (e), (f) A random rate R_CR for every component, and the mutation is taken at this rate.
        let mut rng = draws.of(generation, j as u32, r as u32);
        let r_cr: f64 = rng.random();
        if rng.random::<f64>() < r_cr { m_v } else { t_av[r] }
    };
    (0..bounds.len()).map(component).collect()
}

/// Eq. 10: cosine of the angle between two vectors.
pub fn sim(h: &[f64], k: &[f64]) -> f64 {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    dot(h, k) / (dot(h, h) * dot(k, k)).sqrt()
}

/// The vector of all last generations with the highest similarity to the others.
#[derive(Debug, Clone, PartialEq)]
pub struct MostSimilar {
    /// Which test's generation it comes from, and its place there.
    pub from: (usize, usize),
    /// Mean over tests of the mean similarity with the vectors of the test.
    pub similarity: f64,
}

/// Compares every vector with all the others of the last generations, one a test.
///
/// `None` if there is no vector. Every test weighs the same; the first of equals is chosen.
pub fn most_similar(generations: &[Vec<Vec<f64>>]) -> Option<MostSimilar> {
    let mut best: Option<MostSimilar> = None;
    for (test, vectors) in generations.iter().enumerate() {
        for (index, h) in vectors.iter().enumerate() {
            let similarity = mean(generations.iter().map(|others| mean(others.iter().map(|k| sim(h, k)))));
            if best.as_ref().is_none_or(|b| similarity > b.similarity) {
                best = Some(MostSimilar { from: (test, index), similarity });
            }
        }
    }
    best
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_cosines_of_known_angles() {
        // Roundings of numbers near one.
        let near = |a: f64, b: f64| (a - b).abs() < 1e-15;
        assert!(near(sim(&[1.0, 0.0], &[1.0, 1.0]), 0.5_f64.sqrt()));
        assert!(near(sim(&[2.0, 2.0], &[5.0, 5.0]), 1.0));
        assert!(near(sim(&[1.0, 0.0], &[0.0, 3.0]), 0.0));
    }

    #[test]
    fn analytic_the_middle_of_three_directions_is_most_similar() {
        let at = |degrees: f64| vec![degrees.to_radians().cos(), degrees.to_radians().sin()];
        let chosen = most_similar(&[vec![at(0.0), at(30.0)], vec![at(40.0)], vec![at(80.0)]]);
        // Means over tests of mean cosines: 0°: 0.624, 30°: 0.854, 40°: 0.880 (the largest), 80°: 0.725.
        assert_eq!(chosen.expect("there are vectors").from, (1, 0));
        assert_eq!(most_similar(&[]), None);
    }
}
