//! L-SHADE: differential evolution that learns its F and CR and shrinks its population.
//!
//! Source: R. Tanabe, A. S. Fukunaga (2014), "Improving the search performance of SHADE using linear population size
//! reduction", IEEE Congress on Evolutionary Computation; algorithm 1, equations 1 to 9. Names are theirs.

use rand::{Rng, RngExt};
use rand_distr::{Cauchy, Distribution, Normal};

use super::draws::{Draws, different};
use super::search::{Bounds, Evaluate, Found, Member, members};
use crate::error::Result;

/// H: entries of the memory of successes.
const H: usize = 6;
/// p of current-to-pbest: the share of the population that counts as best.
const P_BEST: f64 = 0.11;
/// Archive of replaced parents, in units of the population.
const R_ARC: f64 = 2.6;
/// Smallest population: current-to-pbest needs four.
const N_MIN: usize = 4;

/// Places of the draws of a candidate: its variables first, then these.
const PICK_PARENTS: u32 = 1 << 16;
const PICK_F_CR: u32 = (1 << 16) + 1;
const PICK_DROPPED: u32 = (1 << 16) + 2;

/// The search's own numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AdaptiveDe {
    /// N_init: first population; it shrinks linearly to four over the budget.
    pub population: usize,
    /// Candidates to evaluate in all.
    pub budget: usize,
    /// The search ends early at this cost.
    pub good_enough: f64,
}

/// F and CR of a candidate.
#[derive(Debug, Clone, Copy)]
struct Rates {
    f: f64,
    cr: f64,
}

/// M_F and M_CR: what has succeeded.
struct Memory {
    m_f: [f64; H],
    /// None: the terminal value, CR = 0 from then on.
    m_cr: [Option<f64>; H],
    next: usize,
}

struct State {
    found: Found,
    archive: Vec<Vec<f64>>,
    memory: Memory,
}

impl AdaptiveDe {
    /// Minimises the cost from a first generation like the paper's, in which `known` vectors take the first places,
    /// until the budget is spent.
    ///
    /// # Errors
    /// What the evaluation meets.
    pub fn minimise(
        &self,
        bounds: &[Bounds],
        known: &[Vec<f64>],
        draws: &Draws,
        evaluate: &mut dyn Evaluate,
    ) -> Result<Found> {
        let n_init = self.population.clamp(N_MIN, self.budget.max(N_MIN));
        let mut first = super::paper_de::first_generation(n_init, bounds, draws);
        first.iter_mut().zip(known).for_each(|(place, known)| place.clone_from(known));
        let costs = evaluate.costs(0, &first)?;
        let memory = Memory { m_f: [0.5; H], m_cr: [Some(0.5); H], next: 0 };
        let mut state = State { found: Found::start(members(first, costs)), archive: Vec::new(), memory };
        let mut generation = 0;
        while state.found.evaluations < self.budget && state.found.best().cost > self.good_enough {
            generation += 1;
            self.generation(generation, &mut state, bounds, draws, evaluate)?;
        }
        Ok(state.found)
    }

    fn generation(
        &self,
        generation: u32,
        state: &mut State,
        bounds: &[Bounds],
        draws: &Draws,
        evaluate: &mut dyn Evaluate,
    ) -> Result<()> {
        let count = state.found.population.len().min(self.budget - state.found.evaluations);
        let ranked = ranked(&state.found.population);
        let rates = (0..count)
            .map(|i| state.memory.draw(&mut draws.of(generation, i as u32, PICK_F_CR)))
            .collect::<Vec<_>>();
        let trials = (0..count)
            .map(|i| trial(state, &ranked, i, rates[i], bounds, generation, draws))
            .collect::<Vec<_>>();
        // A trial that costs more than its parent is not kept, and nothing is learnt from it.
        let most = state.found.population.iter().take(count).map(|parent| parent.cost).collect::<Vec<_>>();
        let costs = evaluate.costs_below(generation, &trials, &most)?;
        state.found.evaluations += count;
        select(state, members(trials, costs), &rates);
        self.shrink(state, generation, draws);
        state.found.note();
        Ok(())
    }

    /// Linear population size reduction: the worst leave.
    fn shrink(&self, state: &mut State, generation: u32, draws: &Draws) {
        let spent = state.found.evaluations as f64 / self.budget as f64;
        let n_init = self.population.max(N_MIN) as f64;
        let n = (n_init + (N_MIN as f64 - n_init) * spent).round() as usize;
        let population = &mut state.found.population;
        while population.len() > n.max(N_MIN) {
            let worst = *ranked(population).last().unwrap_or(&0);
            population.remove(worst);
        }
        let room = (R_ARC * population.len() as f64).round() as usize;
        let mut rng = draws.of(generation, 0, PICK_DROPPED);
        while state.archive.len() > room {
            state.archive.swap_remove(rng.random_range(0..state.archive.len()));
        }
    }
}

/// Indices from the cheapest to the dearest; equals in order.
fn ranked(population: &[Member]) -> Vec<usize> {
    let mut order = (0..population.len()).collect::<Vec<_>>();
    order.sort_by(|&a, &b| population[a].cost.total_cmp(&population[b].cost));
    order
}

/// current-to-pbest/1 with archive, binomial crossover, bounds by halving the way to them.
fn trial(
    state: &State,
    ranked: &[usize],
    i: usize,
    rates: Rates,
    bounds: &[Bounds],
    generation: u32,
    draws: &Draws,
) -> Vec<f64> {
    let population = &state.found.population;
    let mut rng = draws.of(generation, i as u32, PICK_PARENTS);
    let best_few = ((P_BEST * population.len() as f64).round() as usize).max(2);
    let p_best = &population[ranked[rng.random_range(0..best_few.min(ranked.len()))]].values;
    let [r1] = different::<1>(&mut rng, population.len(), i);
    let r2 = loop {
        let k = rng.random_range(0..population.len() + state.archive.len());
        if k != i && k != r1 {
            break k;
        }
    };
    let x = &population[i].values;
    let x_r1 = &population[r1].values;
    let x_r2 = population.get(r2).map_or_else(|| &state.archive[r2 - population.len()], |m| &m.values);
    let j_rand = rng.random_range(0..bounds.len());
    let component = |j: usize| {
        let crossed = draws.uniform(generation, i as u32, j as u32) < rates.cr;
        if !crossed && j != j_rand {
            return x[j];
        }
        let v = x[j] + rates.f * (p_best[j] - x[j]) + rates.f * (x_r1[j] - x_r2[j]);
        halfway_to_bound(v, x[j], bounds[j])
    };
    (0..bounds.len()).map(component).collect()
}

fn halfway_to_bound(v: f64, x: f64, bounds: Bounds) -> f64 {
    if v < bounds.lower {
        0.5 * (x + bounds.lower)
    } else if v > bounds.upper {
        0.5 * (x + bounds.upper)
    } else {
        v
    }
}

/// Keeps the better of parent and trial, archives the parents that lost, and learns from the successes.
fn select(state: &mut State, trials: Vec<Member>, rates: &[Rates]) {
    let mut successes = Vec::new();
    for (i, trial) in trials.into_iter().enumerate() {
        let parent = &mut state.found.population[i];
        if trial.cost < parent.cost {
            let gain = if parent.cost.is_finite() { parent.cost - trial.cost } else { trial.cost.abs() };
            successes.push((rates[i], gain));
            state.archive.push(std::mem::replace(parent, trial).values);
        } else if trial.cost == parent.cost {
            *parent = trial;
        }
    }
    state.memory.learn(&successes);
}

impl Memory {
    fn draw(&self, rng: &mut impl Rng) -> Rates {
        let r = rng.random_range(0..H);
        let cr = self.m_cr[r].map_or(0.0, |mean| normal(mean, rng).clamp(0.0, 1.0));
        Rates { f: cauchy(self.m_f[r], rng), cr }
    }

    /// Weighted Lehmer means of what succeeded take the next place.
    fn learn(&mut self, successes: &[(Rates, f64)]) {
        if successes.is_empty() {
            return;
        }
        let lehmer = |value: fn(&Rates) -> f64| {
            let sum = |power: i32| {
                successes.iter().map(|(rates, gain)| gain * value(rates).powi(power)).sum::<f64>()
            };
            sum(2) / sum(1)
        };
        let (f, cr) = (lehmer(|rates| rates.f), lehmer(|rates| rates.cr));
        if f.is_finite() {
            self.m_f[self.next] = f;
        }
        // All successes at CR = 0 give 0/0: the terminal value.
        let had_terminal = self.m_cr[self.next].is_none();
        self.m_cr[self.next] = if cr.is_finite() && !had_terminal { Some(cr) } else { None };
        self.next = (self.next + 1) % H;
    }
}

const SPREAD: f64 = 0.1;

fn normal(mean: f64, rng: &mut impl Rng) -> f64 {
    // A constant positive spread is a valid one.
    Normal::new(mean, SPREAD).map_or(mean, |law| law.sample(rng))
}

/// Cauchy about the mean, drawn again while not positive, cut at 1.
fn cauchy(mean: f64, rng: &mut impl Rng) -> f64 {
    let Ok(law) = Cauchy::new(mean, SPREAD) else { return mean };
    loop {
        let f: f64 = law.sample(rng);
        if f > 0.0 {
            return f.min(1.0);
        }
    }
}
