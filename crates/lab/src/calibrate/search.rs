//! What every search shares: bounds, a population, and the cost as a parameter.

use mrbd_files::error::Result;

/// Bounds of one variable: β_0 and β_f of Eq. 9.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// β_0.
    pub lower: f64,
    /// β_f.
    pub upper: f64,
}

impl Bounds {
    /// The nearest value within.
    pub fn clamp(&self, value: f64) -> f64 {
        value.clamp(self.lower, self.upper)
    }

    /// Value at a share of the way from the lower to the upper bound.
    pub fn at(&self, share: f64) -> f64 {
        self.lower + share * (self.upper - self.lower)
    }

    /// Upper less lower.
    pub fn width(&self) -> f64 {
        self.upper - self.lower
    }
}

/// A candidate and its cost; a candidate whose runs failed costs infinity.
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    /// Values of the variables.
    pub values: Vec<f64>,
    /// What is minimised.
    pub cost: f64,
}

/// Gives the costs of a generation of candidates, in order.
pub trait Evaluate {
    /// Costs of these candidates, the `generation`-th asked for.
    ///
    /// # Errors
    /// What keeping the results meets; a candidate that cannot be simulated is no error but costs infinity.
    fn costs(&mut self, generation: u32, candidates: &[Vec<f64>]) -> Result<Vec<f64>> {
        self.costs_below(generation, candidates, &vec![f64::INFINITY; candidates.len()])
    }

    /// The same where a candidate whose cost is certain to be more than its `most` may be abandoned: it costs infinity.
    ///
    /// # Errors
    /// As [`Evaluate::costs`].
    fn costs_below(&mut self, generation: u32, candidates: &[Vec<f64>], most: &[f64]) -> Result<Vec<f64>>;
}

/// How a search went.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The last generation.
    pub population: Vec<Member>,
    /// Candidates evaluated.
    pub evaluations: usize,
    /// Candidates evaluated up to the end of each generation.
    pub vectors: Vec<usize>,
    /// Lowest cost after each generation, the first generation included.
    pub best_costs: Vec<f64>,
    /// Sum of the population's costs after each generation; the paper's Fig. 6.
    pub cost_sums: Vec<f64>,
}

impl Found {
    pub(super) fn start(population: Vec<Member>) -> Self {
        let evaluations = population.len();
        let [best_costs, cost_sums] = [Vec::new(), Vec::new()];
        let mut found = Self { population, evaluations, vectors: Vec::new(), best_costs, cost_sums };
        found.note();
        found
    }

    /// Notes the state after a generation.
    pub(super) fn note(&mut self) {
        self.vectors.push(self.evaluations);
        self.best_costs.push(self.best().cost);
        self.cost_sums.push(self.population.iter().map(|member| member.cost).sum());
    }

    /// The member of lowest cost, the first of equals.
    pub fn best(&self) -> &Member {
        let cheaper = |best, member| if member_cost(member) < member_cost(best) { member } else { best };
        self.population.iter().skip(1).fold(&self.population[0], cheaper)
    }
}

fn member_cost(member: &Member) -> f64 {
    member.cost
}

/// Candidates with their costs.
pub(super) fn members(values: Vec<Vec<f64>>, costs: Vec<f64>) -> Vec<Member> {
    values.into_iter().zip(costs).map(|(values, cost)| Member { values, cost }).collect()
}
