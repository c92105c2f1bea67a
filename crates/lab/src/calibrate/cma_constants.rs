//! Constants of CMA-ES.

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
