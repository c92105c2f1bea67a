//! CMA-ES: a normal cloud that learns the shape of the valley it goes down.
//!
//! Source: N. Hansen (2016), "The CMA evolution strategy: a tutorial", arXiv:1604.00772, figure 6 and table 1
//! (without negative weights); names are the tutorial's. Variables run from 0 to 1 between their bounds. A point
//! outside is simulated at the nearest point inside, and its cost raised by the square of its distance.
//!
//! Coefficients that act in turns are C_1 and C_2 in a burst of impacts at the crack. Their product is known long
//! before either is: a narrow, slanting valley, which differential evolution crosses slowly.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rand_distr::{Distribution, StandardNormal};

use super::search::{Bounds, Draws, Evaluate, Found, Member};
use mrbd_files::error::Result;

/// Step sizes are kept between these, as shares of the bounds.
const SIGMA_RANGE: (f64, f64) = (1e-12, 4.0);

/// The cloud.
#[derive(Debug, Clone)]
pub struct CmaEs {
    lambda: usize,
    constants: Constants,
    mean: DVector<f64>,
    sigma: f64,
    covariance: DMatrix<f64>,
    p_sigma: DVector<f64>,
    p_c: DVector<f64>,
    generation: u32,
}

impl CmaEs {
    /// A round cloud of a size, as a share of the bounds, about a point; `lambda` vectors a generation, 4 or more.
    pub fn new(about: &[f64], bounds: &[Bounds], sigma: f64, lambda: usize) -> Self {
        let n = bounds.len();
        let lambda = lambda.max(4);
        let share = |(x, b): (&f64, &Bounds)| ((x - b.lower) / b.width()).clamp(0.0, 1.0);
        Self {
            lambda,
            constants: Constants::new(n, lambda),
            mean: DVector::from_iterator(n, about.iter().zip(bounds).map(share)),
            sigma,
            covariance: DMatrix::identity(n, n),
            p_sigma: DVector::zeros(n),
            p_c: DVector::zeros(n),
            generation: 0,
        }
    }

    /// A cloud of another shape: square root of its covariance, in shares of the bounds.
    #[must_use]
    pub fn shaped(self, root: &DMatrix<f64>) -> Self {
        Self { sigma: 1.0, covariance: root * root.transpose(), ..self }
    }

    /// Size of the cloud in its widest direction, as a share of the bounds.
    pub fn width(&self) -> f64 {
        self.sigma * self.covariance.clone().symmetric_eigenvalues().max().sqrt()
    }

    /// Minimises the cost until the budget is spent, the cloud is narrower than `least_width`, or the cost is zero.
    ///
    /// The vectors found are the best of all generations, as many as a generation has.
    ///
    /// # Errors
    /// What the evaluation meets.
    pub fn minimise(
        &mut self,
        bounds: &[Bounds],
        budget: usize,
        least_width: f64,
        draws: &Draws,
        evaluate: &mut dyn Evaluate,
    ) -> Result<Found> {
        let centre = vec![to_values(&self.mean, bounds)];
        let costs = evaluate.costs(0, &centre)?;
        let mut found = Found::start(super::search::members(centre, costs));
        let mut round = 0;
        let mut hopeless = f64::INFINITY;
        while found.evaluations + self.lambda <= budget
            && found.best().cost > 0.0
            && self.width() > least_width
        {
            round += 1;
            let points = self.sampled(draws);
            let values = points.iter().map(|x| to_values(x, bounds)).collect::<Vec<_>>();
            let penalties = points.iter().map(|x| 1.0 + outside(x)).collect::<Vec<_>>();
            let costs = self.ranking_costs(round, &values, &penalties, hopeless, evaluate)?;
            found.evaluations += self.lambda;
            let penalised = penalties.iter().zip(&costs).map(|(p, cost)| cost * p).collect::<Vec<_>>();
            hopeless = hopeless_cost(&penalised);
            self.learn(&points, penalised);
            keep_best(&mut found, values, costs, self.lambda);
            found.note();
        }
        Ok(found)
    }

    /// Costs that rank the better half as full costs would: the cloud learns of no others.
    ///
    /// Candidates that cost more than the limit are abandoned; if the better half is not below it, all are simulated to
    /// their end after all.
    fn ranking_costs(
        &self,
        round: u32,
        values: &[Vec<f64>],
        penalties: &[f64],
        hopeless: f64,
        evaluate: &mut dyn Evaluate,
    ) -> Result<Vec<f64>> {
        let most = penalties.iter().map(|p| hopeless / p).collect::<Vec<_>>();
        let costs = evaluate.costs_below(round, values, &most)?;
        let below = costs.iter().zip(&most).filter(|(cost, most)| cost <= most).count();
        if below >= self.constants.weights.len() || hopeless.is_infinite() {
            return Ok(costs);
        }
        evaluate.costs(round, values)
    }

    fn sampled(&mut self, draws: &Draws) -> Vec<DVector<f64>> {
        self.generation += 1;
        let root = self.root();
        let normal = |k: usize, v: usize| -> f64 {
            StandardNormal.sample(&mut draws.of(self.generation, k as u32, v as u32))
        };
        let point = |k: usize| {
            let z = DVector::from_fn(self.mean.len(), |v, _| normal(k, v));
            &self.mean + self.sigma * &root * z
        };
        (0..self.lambda).map(point).collect()
    }

    /// Square root of the covariance: B D Bᵀ.
    fn root(&self) -> DMatrix<f64> {
        self.power(|eigenvalue| eigenvalue.sqrt())
    }

    fn power(&self, of: impl Fn(f64) -> f64) -> DMatrix<f64> {
        let eigen = SymmetricEigen::new(self.covariance.clone());
        // Roundings may leave an eigenvalue of nearly zero negative.
        let diagonal = eigen.eigenvalues.map(|eigenvalue| of(eigenvalue.max(1e-20)));
        &eigen.eigenvectors * DMatrix::from_diagonal(&diagonal) * eigen.eigenvectors.transpose()
    }

    fn learn(&mut self, points: &[DVector<f64>], costs: Vec<f64>) {
        let k = self.constants.clone();
        let mut order = (0..points.len()).collect::<Vec<_>>();
        order.sort_by(|&a, &b| costs[a].total_cmp(&costs[b]));
        let steps = order.iter().take(k.weights.len());
        let steps = steps.map(|&i| (&points[i] - &self.mean) / self.sigma).collect::<Vec<_>>();
        let weighted = k.weights.iter().zip(&steps);
        let y_w = weighted.clone().fold(DVector::zeros(self.mean.len()), |sum, (w, y)| sum + *w * y);
        self.mean += self.sigma * &y_w;
        let whitened = self.power(|eigenvalue| 1.0 / eigenvalue.sqrt()) * &y_w;
        let keep = (k.c_sigma * (2.0 - k.c_sigma) * k.mu_eff).sqrt();
        self.p_sigma = (1.0 - k.c_sigma) * &self.p_sigma + keep * whitened;
        let length = self.p_sigma.norm() / k.chi_n;
        let h_sigma = if length < 1.4 + 2.0 / (self.mean.len() as f64 + 1.0) { 1.0 } else { 0.0 };
        let keep = (k.c_c * (2.0 - k.c_c) * k.mu_eff).sqrt();
        self.p_c = (1.0 - k.c_c) * &self.p_c + h_sigma * keep * y_w;
        let old = 1.0 - k.c_1 - k.c_mu + (1.0 - h_sigma) * k.c_1 * k.c_c * (2.0 - k.c_c);
        self.covariance = old * &self.covariance + k.c_1 * &self.p_c * self.p_c.transpose();
        weighted.for_each(|(w, y)| self.covariance += k.c_mu * *w * y * y.transpose());
        let sigma = self.sigma * (k.c_sigma / k.d_sigma * (length - 1.0)).exp();
        self.sigma = sigma.clamp(SIGMA_RANGE.0, SIGMA_RANGE.1);
    }
}

/// Cost of a generation that hardly any of the better half of the next will pass: its upper quartile.
fn hopeless_cost(penalised: &[f64]) -> f64 {
    let mut sorted = penalised.to_vec();
    sorted.sort_by(f64::total_cmp);
    let quartile = sorted[3 * (sorted.len() - 1) / 4];
    // Where the quartile was abandoned, the dearest that was not.
    let finite = sorted.iter().rev().find(|cost| cost.is_finite());
    if quartile.is_finite() { quartile } else { finite.copied().unwrap_or(f64::INFINITY) }
}

fn to_values(x: &DVector<f64>, bounds: &[Bounds]) -> Vec<f64> {
    x.iter().zip(bounds).map(|(share, b)| b.clamp(b.at(share.clamp(0.0, 1.0)))).collect()
}

fn outside(x: &DVector<f64>) -> f64 {
    x.iter().map(|share| (share - share.clamp(0.0, 1.0)).powi(2)).sum()
}

fn keep_best(found: &mut Found, values: Vec<Vec<f64>>, costs: Vec<f64>, room: usize) {
    let new = values.into_iter().zip(costs).map(|(values, cost)| Member { values, cost });
    found.population.extend(new);
    found.population.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    found.population.truncate(room);
}

/// Constants of the strategy: table 1 of the tutorial.
#[derive(Debug, Clone)]
pub(super) struct Constants {
    pub weights: Vec<f64>,
    pub mu_eff: f64,
    pub c_sigma: f64,
    pub d_sigma: f64,
    pub c_c: f64,
    pub c_1: f64,
    pub c_mu: f64,
    pub chi_n: f64,
}

impl Constants {
    /// For so many variables and vectors a generation.
    pub fn new(n: usize, lambda: usize) -> Self {
        let n = n as f64;
        let mu = lambda / 2;
        let raw = (1..=mu).map(|i| (0.5 * (lambda as f64 + 1.0)).ln() - (i as f64).ln()).collect::<Vec<_>>();
        let sum = raw.iter().sum::<f64>();
        let weights = raw.iter().map(|w| w / sum).collect::<Vec<_>>();
        let mu_eff = 1.0 / weights.iter().map(|w| w * w).sum::<f64>();
        let c_sigma = (mu_eff + 2.0) / (n + mu_eff + 5.0);
        let c_1 = 2.0 / ((n + 1.3).powi(2) + mu_eff);
        let c_mu = (1.0 - c_1).min(2.0 * (mu_eff - 2.0 + 1.0 / mu_eff) / ((n + 2.0).powi(2) + mu_eff));
        Self {
            d_sigma: 1.0 + 2.0 * (((mu_eff - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + c_sigma,
            c_c: (4.0 + mu_eff / n) / (n + 4.0 + 2.0 * mu_eff / n),
            chi_n: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
            weights,
            mu_eff,
            c_sigma,
            c_1,
            c_mu,
        }
    }
}
