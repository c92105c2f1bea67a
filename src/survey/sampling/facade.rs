//! Façades drawn from the survey (the source's section 4.1 and Table 3).

use super::Refused;
use super::Sampling;
use super::design::Points;
use super::marginal::Marginal;
use super::variable::Variable;
use super::variable::{Mixture, Pair};
use crate::survey::Assumptions;
use crate::survey::Facade;
use crate::survey::{Configuration, Survey};

/// Draws façades of one configuration; a draw depends on the seed, the index and the variable alone.
#[derive(Debug, Clone, PartialEq)]
pub struct FacadeSampler {
    points: Points,
    marginals: [Marginal; 7],
    mixture: Option<Mixture>,
}

impl FacadeSampler {
    /// A sampler of a survey's configuration.
    ///
    /// # Errors
    /// [`Refused`] under a key of the survey (`wall.…`) or of the sampling (`sampling.…`): impossible distributions,
    /// values or truncations, counts the design has not, correlations of constants or that cannot be together.
    pub fn new(survey: &Survey, configuration: Configuration, sampling: &Sampling) -> Result<Self, Refused> {
        let mut marginals = [Marginal::Constant(0.0); 7];
        for (marginal, variable) in marginals.iter_mut().zip(Variable::ALL) {
            *marginal = marginal_of(survey, configuration, sampling, variable)?;
        }
        let pairs = pairs(&marginals, &sampling.rank_correlation)?;
        let under_sampling =
            |refused: Refused| Refused { key: format!("sampling.{}", refused.key), ..refused };
        let points = Points::new(sampling.design, sampling.count, sampling.seed, Variable::ALL.len());
        Ok(Self {
            points: points.map_err(under_sampling)?,
            marginals,
            mixture: Mixture::new("sampling.rank_correlation", Variable::ALL.len(), &pairs)?,
        })
    }

    /// Number of façades.
    pub fn count(&self) -> u64 {
        self.points.count()
    }

    /// The distribution of a variable.
    pub fn marginal(&self, variable: Variable) -> &Marginal {
        &self.marginals[variable as usize]
    }

    /// Values of the variables, in SI units and in the order of [`Variable::ALL`].
    ///
    /// # Panics
    /// At or beyond [`FacadeSampler::count`].
    pub fn draw(&self, index: u64) -> [f64; 7] {
        self.at(std::array::from_fn(|variable| self.points.at(index, variable)))
    }

    /// The same at a point of the unit cube.
    fn at(&self, point: [f64; 7]) -> [f64; 7] {
        let point = self.mixture.as_ref().map_or(point, |mixture| mixture.apply(point));
        std::array::from_fn(|variable| self.marginals[variable].quantile(point[variable]))
    }

    /// One more uniform number of a draw, in (0, 1), by its `number` among such: independent whatever the design.
    pub fn further(&self, index: u64, number: usize) -> f64 {
        self.points.further(index, Variable::ALL.len() + number)
    }

    /// The façade of a draw. It can be one that no wall is: [`Facade::wall`] tells.
    ///
    /// # Panics
    /// As [`FacadeSampler::draw`].
    pub fn facade(&self, index: u64, assumptions: &Assumptions) -> Facade {
        facade(self.draw(index), assumptions)
    }

    /// The façade at a point of the unit cube, in the order of [`Variable::ALL`].
    pub fn facade_at(&self, point: [f64; 7], assumptions: &Assumptions) -> Facade {
        facade(self.at(point), assumptions)
    }
}

fn facade(values: [f64; 7], assumptions: &Assumptions) -> Facade {
    let [
        thickness_m,
        slenderness,
        crack_height_ratio,
        compressive_strength_pa,
        stiffness_n_per_m,
        diaphragm_mass_ratio,
        carriage_mass_ratio,
    ] = values;
    Facade {
        thickness_m,
        slenderness,
        crack_height_ratio,
        compressive_strength_pa,
        stiffness_n_per_m,
        diaphragm_mass_ratio,
        carriage_mass_ratio,
        length_m: assumptions.length_m,
        density_kg_m3: assumptions.density_kg_m3,
    }
}

fn marginal_of(
    survey: &Survey,
    configuration: Configuration,
    sampling: &Sampling,
    variable: Variable,
) -> Result<Marginal, Refused> {
    if let Some(&value) = sampling.fixed.get(&variable) {
        let key = format!("sampling.fixed.{}", variable.name());
        if sampling.truncation.contains_key(&variable) {
            return Err(Refused::new(&key, "a truncation of it too", "one of the two"));
        }
        if !(value.is_finite() && variable.possible(value)) {
            return Err(Refused::new(&key, value.to_string(), "a value that a façade can have"));
        }
        return Ok(Marginal::Constant(value));
    }
    let truncation = sampling.truncation_of(variable);
    let key = match sampling.truncation.contains_key(&variable) {
        true => format!("sampling.truncation.{}", variable.name()),
        false => variable.key(configuration),
    };
    Marginal::from_levels(&key, variable.levels(survey, configuration), truncation)
}

fn pairs(
    marginals: &[Marginal; 7],
    correlations: &[(Variable, Variable, f64)],
) -> Result<Vec<Pair>, Refused> {
    let position = |variable: Variable| {
        if marginals[variable as usize].varies() {
            return Ok(variable as usize);
        }
        let found = format!("{}, which does not vary", variable.name());
        Err(Refused::new("sampling.rank_correlation", found, "variables that vary"))
    };
    correlations.iter().map(|&(a, b, rank)| Ok((position(a)?, position(b)?, rank))).collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use rayon::prelude::*;

    use super::super::design::Design;
    use super::*;
    use crate::survey::sampling::HIGHEST_CRACK;
    use mrbd_kernel::model::Restitution;

    fn survey() -> Survey {
        let text = include_str!("../../../inputs/survey.toml");
        Survey::parse(Path::new("survey.toml"), text).expect("the repository's own survey")
    }

    fn sampler(configuration: Configuration, sampling: &Sampling) -> FacadeSampler {
        FacadeSampler::new(&survey(), configuration, sampling).expect("valid")
    }

    fn parse(text: &str) -> Sampling {
        toml::from_str(text).expect("a sampling")
    }

    #[test]
    fn published_moments_of_table_3() {
        // (variable, median, β = ½ ln(upper/lower)) of the parallel floor; the crack's truncation apart.
        let table: [(Variable, f64, f64, f64); 6] = [
            (Variable::Thickness, 0.50, 0.35, 0.70),
            (Variable::Slenderness, 12.0, 9.0, 15.0),
            (Variable::Strength, 3.45e6, 2.60e6, 4.30e6),
            (Variable::Stiffness, 1200e3, 500e3, 4000e3),
            (Variable::DiaphragmMass, 0.03, 0.02, 0.07),
            (Variable::CarriageMass, 0.14, 0.06, 0.27),
        ];
        let n = 20_000;
        let sampler = sampler(Configuration::Parallel, &Sampling::plain(n, 3));
        let draws: Vec<[f64; 7]> = (0..n).map(|i| sampler.draw(i)).collect();
        for (variable, median, low, high) in table {
            let beta = 0.5 * (high / low).ln();
            let z = draws.iter().map(|draw| (draw[variable as usize] / median).ln() / beta);
            let (sum, squares) = z.fold((0.0, 0.0), |(sum, squares), z| (sum + z, squares + z * z));
            let (mean, square) = (sum / n as f64, squares / n as f64);
            // A mean of n scatters by 1/√n = 0.007 and a mean square by √2/√n = 0.01; four of each.
            assert!(mean.abs() < 0.028 && (square - 1.0).abs() < 0.04, "{variable:?}: {mean} {square}");
        }
        assert!(draws.iter().all(|draw| draw[2] <= HIGHEST_CRACK));
        let sampler = FacadeSampler::new(&survey(), Configuration::Perpendicular, &Sampling::plain(1, 1));
        assert_eq!(sampler.expect("valid").draw(0)[6], 0.0, "the table's three zeros");
    }

    #[test]
    fn analytic_a_hypercube_meets_its_quantiles_far_better_than_chance() {
        let mut sampling = Sampling::plain(1000, 5);
        sampling.design = Design::LatinHypercube;
        let sampler = sampler(Configuration::Parallel, &sampling);
        let mut thickness: Vec<f64> = (0..1000).map(|i| sampler.draw(i)[0]).collect();
        thickness.sort_unstable_by(f64::total_cmp);
        for (rank, x) in thickness.iter().enumerate() {
            let stratum =
                [rank, rank + 1].map(|r| sampler.marginal(Variable::Thickness).quantile(r as f64 / 1000.0));
            assert!(stratum[0] <= *x && *x <= stratum[1], "{x} outside {stratum:?}");
        }
    }

    #[test]
    fn analytic_draws_depend_on_the_index_alone() {
        for design in [Design::Plain, Design::LatinHypercube, Design::Sobol] {
            let sampling = Sampling {
                design,
                rank_correlation: vec![(Variable::Thickness, Variable::Stiffness, 0.5)],
                ..Sampling::plain(512, 8)
            };
            let sampler = sampler(Configuration::Parallel, &sampling);
            let forward: Vec<[f64; 7]> = (0..512).map(|i| sampler.draw(i)).collect();
            let mut backward: Vec<[f64; 7]> = (0..512).rev().map(|i| sampler.draw(i)).collect();
            backward.reverse();
            let threads: Vec<[f64; 7]> = (0..512u64).into_par_iter().map(|i| sampler.draw(i)).collect();
            assert_eq!(forward, backward);
            assert_eq!(forward, threads);
            let other =
                FacadeSampler::new(&survey(), Configuration::Parallel, &Sampling { seed: 9, ..sampling });
            assert_ne!(forward[0], other.expect("valid").draw(0), "{design:?}");
        }
    }

    #[test]
    fn analytic_a_variable_keeps_its_numbers_whatever_the_others_do() {
        let free = sampler(Configuration::Parallel, &Sampling::plain(10, 8));
        let fixed = parse(
            "count = 10\nseed = 8\nfixed = { thickness_m = 0.4 }\n[truncation]\nslenderness = { upper = 16.0 }",
        );
        let fixed = sampler(Configuration::Parallel, &fixed);
        for i in 0..10 {
            assert_eq!(free.draw(i)[2..], fixed.draw(i)[2..]);
            assert_eq!(fixed.draw(i)[0], 0.4);
            assert!(fixed.draw(i)[1] <= 16.0);
        }
    }

    /// Spearman's rank correlation of two columns without ties.
    fn spearman(columns: [Vec<f64>; 2]) -> f64 {
        let ranks = columns.map(|column| {
            let mut order: Vec<usize> = (0..column.len()).collect();
            order.sort_unstable_by(|&a, &b| column[a].total_cmp(&column[b]));
            let mut ranks = vec![0.0; column.len()];
            order.iter().enumerate().for_each(|(rank, &i)| ranks[i] = rank as f64);
            ranks
        });
        let n = ranks[0].len() as f64;
        let d2: f64 = ranks[0].iter().zip(&ranks[1]).map(|(a, b)| (a - b).powi(2)).sum();
        1.0 - 6.0 * d2 / (n * (n * n - 1.0))
    }

    #[test]
    fn analytic_rank_correlations_are_reached() {
        let text = "count = 10000\ndesign = \"DESIGN\"\nrank_correlation = [[\"thickness_m\", \"stiffness_n_per_m\", 0.6], \
                    [\"thickness_m\", \"carriage_mass_ratio\", -0.3]]";
        for design in ["plain", "latin_hypercube", "sobol"] {
            let sampler = sampler(Configuration::Parallel, &parse(&text.replace("DESIGN", design)));
            let draws: Vec<[f64; 7]> = (0..10_000).map(|i| sampler.draw(i)).collect();
            let column = |variable: Variable| draws.iter().map(|draw| draw[variable as usize]).collect();
            for (a, b, asked) in [
                (Variable::Thickness, Variable::Stiffness, 0.6),
                (Variable::Thickness, Variable::CarriageMass, -0.3),
                (Variable::Slenderness, Variable::Strength, 0.0),
            ] {
                let found = spearman([column(a), column(b)]);
                // A rank correlation of 10 000 independent draws scatters by 1/√10 000 = 0.01, correlated ones less.
                assert!((found - asked).abs() < 0.03, "{design}: {found} for {asked}");
            }
        }
    }

    #[test]
    fn regress_few_draws_of_table_3_are_no_wall() {
        let walls = |configuration: Configuration, text: &str| {
            let (sampler, assumptions) = (sampler(configuration, &parse(text)), Assumptions::default());
            let stands = |i: &u64| sampler.facade(*i, &assumptions).wall(Restitution::default(), 2.0).is_ok();
            (0..10_000).filter(stands).count() as f64 / 10_000.0
        };
        // Floors of more than the total mass: m_dp/m_tot ≥ 1 - m_d/m_tot has about Φ(-ln(0.96/0.14)/0.75) = 0.5 %, to
        // 0.1 % of chance; a floor ratio near 1 is a heavy floor under which corners crush, which adds as much again.
        let parallel = walls(Configuration::Parallel, "count = 10000");
        assert!((0.985..0.996).contains(&parallel), "{parallel}");
        // m_d/m_tot ≥ 1 has Φ(-ln(1/0.09)/0.58) = 2e-5, corners that crush about as much: a few in 10⁴ at most.
        assert!(walls(Configuration::Perpendicular, "count = 10000") > 0.9994);
        let truncated = "count = 10000\n[truncation]\ncarriage_mass_ratio = { upper = 0.6 }\ndiaphragm_mass_ratio = { upper = 0.3 }";
        assert!(
            walls(Configuration::Parallel, truncated) > 0.9994,
            "limits on the ratios leave corners that crush"
        );
    }

    #[test]
    fn rejects_samplings_that_cannot_be_under_their_keys() {
        let refused = |text: &str| {
            let sampling = parse(text);
            FacadeSampler::new(&survey(), Configuration::Perpendicular, &sampling)
                .expect_err(text)
                .to_string()
        };
        assert!(refused("count = 0").starts_with("sampling.count: found 0"));
        assert!(
            refused("count = 1\nfixed = { crack_height_ratio = 1.0 }")
                .starts_with("sampling.fixed.crack_height_ratio")
        );
        let message = refused("count = 1\n[truncation]\nthickness_m = { lower = 2.0, upper = 1.0 }");
        assert!(message.starts_with("sampling.truncation.thickness_m: found"), "{message}");
        let constant = "count = 1\nrank_correlation = [[\"thickness_m\", \"carriage_mass_ratio\", 0.5]]";
        assert!(refused(constant).contains("carriage_mass_ratio, which does not vary"));
        let unknown =
            toml::from_str::<Sampling>("count = 1\nfixed = { thicknes_m = 1.0 }").expect_err("refused");
        assert!(unknown.to_string().contains("thickness_m"), "{unknown}");
        let mut broken = survey();
        broken.wall.thickness_m = [0.5, 0.4, 0.7];
        let refused = FacadeSampler::new(&broken, Configuration::Parallel, &Sampling::plain(1, 1));
        let at = refused.expect_err("refused").at(Path::new("s.toml")).to_string();
        assert!(at.starts_with("s.toml: wall.thickness_m: found [0.5, 0.4, 0.7]"), "{at}");
    }
}
