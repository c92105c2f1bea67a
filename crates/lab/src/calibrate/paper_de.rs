//! The paper's differential evolution: section 3.1, steps (a) to (g), Fig. 5.

use rand::RngExt;
use rand::seq::SliceRandom;

use super::draws::{Draws, different};
use super::search::{Bounds, Evaluate, Found, Member, members};
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
