//! The plan of a study of variance: two matrices of points, and others that take some inputs from the second.
//!
//! Every façade of a study of drawn façades is a point of seven numbers; here a point has all that could be otherwise. What a
//! run takes from its point by matrix decides the Sobol' indices ([`mrbd_statistics::PickFreeze`]). The record is no number
//! of a point: each point is run under all of them.

use std::ops::Range;

use super::kinds::{Assumed, Setting};
use super::run::{Origin, Scaling};
use crate::study::pipeline::Variance;
use crate::survey::sampling::{FacadeSampler, Points, Refused, Sampling, Variable};
use crate::survey::{Assumptions, Configuration};
use mrbd_files::coefficients::CoefficientSets;
use mrbd_kernel::model::{Effect, EffectError};

/// Numbers of a point: seven of the façade, eight coefficients, law, length, density, bed and member.
const NUMBERS: usize = 20;

/// Where the numbers of a point stand.
mod place {
    use std::ops::Range;

    pub const FACADE: Range<usize> = 0..7;
    pub const COEFFICIENTS: Range<usize> = 7..15;
    pub const LAW: usize = 15;
    pub const LENGTH: usize = 16;
    pub const DENSITY: usize = 17;
    pub const BED: usize = 18;
    pub const MEMBER: usize = 19;
}

/// An input of a run, or a group of them, whose share of the variance is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Factor {
    /// Name in result files.
    pub name: &'static str,
    /// Whether it is a group of others.
    pub is_group: bool,
    /// Its numbers of a point: from, up to and without.
    numbers: (usize, usize),
}

const fn one(name: &'static str, number: usize) -> Factor {
    Factor { name, is_group: false, numbers: (number, number + 1) }
}

const fn group(name: &'static str, from: usize, to: usize) -> Factor {
    Factor { name, is_group: true, numbers: (from, to) }
}

/// What a matrix is made for, groups first; the record, which is no number of a point, comes beside them.
pub const FACTORS: [Factor; 17] = [
    group("facade", 0, 7),
    group("wall", 0, 4),
    group("floor", 4, 7),
    group("assumptions", place::LAW, place::MEMBER),
    // Its eight are one input: nobody has measured one without the others.
    Factor { name: "coefficients", is_group: false, numbers: (7, 15) },
    one("chaos", place::MEMBER),
    one("thickness_m", 0),
    one("slenderness", 1),
    one("crack_height_ratio", 2),
    one("compressive_strength_pa", 3),
    one("stiffness_n_per_m", 4),
    one("diaphragm_mass_ratio", 5),
    one("carriage_mass_ratio", 6),
    one("law", place::LAW),
    one("length_m", place::LENGTH),
    one("density_kg_m3", place::DENSITY),
    one("bed", place::BED),
];

/// A matrix of points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Matrix {
    /// The first.
    A,
    /// The second, independent of it.
    B,
    /// The first, with one of [`FACTORS`] from the second.
    Swapped(Factor),
}

impl Matrix {
    /// All that there can be, A and B first.
    pub fn all() -> impl Iterator<Item = Self> {
        [Matrix::A, Matrix::B].into_iter().chain(FACTORS.map(Matrix::Swapped))
    }

    /// Those of a study: of what is assumed, of levels and ranges alone that are several.
    pub fn of(variance: &Variance) -> Vec<Self> {
        let varies = |number: usize| match number {
            place::LAW => variance.laws.len() > 1,
            place::LENGTH => variance.length_m[0] < variance.length_m[1],
            place::DENSITY => variance.density_kg_m3[0] < variance.density_kg_m3[1],
            place::BED => variance.beds.len() > 1,
            _ => true,
        };
        Self::all().filter(|matrix| matrix.numbers().any(varies)).collect()
    }

    /// Name in result files.
    pub fn name(self) -> &'static str {
        match self {
            Matrix::A => "a",
            Matrix::B => "b",
            Matrix::Swapped(factor) => factor.name,
        }
    }

    /// The numbers that it is made for.
    fn numbers(self) -> Range<usize> {
        match self {
            Matrix::A | Matrix::B => 0..NUMBERS,
            Matrix::Swapped(Factor { numbers: (from, to), .. }) => from..to,
        }
    }

    fn takes_from_b(self, number: usize) -> bool {
        self != Matrix::A && self.numbers().contains(&number)
    }
}

/// The points, and what their numbers mean.
#[derive(Debug, Clone)]
pub(super) struct PickFreeze {
    points: Points,
    variance: Variance,
    bounds: [[f64; 2]; 8],
    beds: Vec<Option<Effect>>,
    matrices: Vec<Matrix>,
    /// Members of the ensemble beside the run itself.
    members: usize,
}

impl PickFreeze {
    /// The points of a sampling.
    ///
    /// # Errors
    /// [`Refused`] for more points than the design has.
    pub fn new(
        variance: &Variance,
        sampling: &Sampling,
        sets: &CoefficientSets,
        members: usize,
    ) -> Result<Self, Refused> {
        let points = Points::new(sampling.design, sampling.count, sampling.seed, 2 * NUMBERS);
        let points =
            points.map_err(|refused| Refused { key: format!("sampling.{}", refused.key), ..refused })?;
        let beyond = |e: EffectError| Refused {
            key: "variance.beds".to_owned(),
            found: e.to_string(),
            allowed: "values of the effect `compliant_joint`".to_owned(),
        };
        let beds = variance.beds.iter().map(|bed| bed.effect().map_err(beyond));
        Ok(Self {
            points,
            beds: beds.collect::<Result<_, _>>()?,
            variance: variance.clone(),
            bounds: std::array::from_fn(|l| [sets.lower[l], sets.upper[l]]),
            matrices: Matrix::of(variance),
            members,
        })
    }

    /// The setting of a draw in the matrix at a place.
    pub fn at(
        &self,
        (draw, stratum): (u64, usize),
        (configuration, sampler): (Configuration, &FacadeSampler),
        assumptions: &Assumptions,
    ) -> Setting {
        let matrix = self.matrices[stratum];
        let number = |i: usize| self.points.at(draw, if matrix.takes_from_b(i) { NUMBERS + i } else { i });
        let between = |[from, to]: [f64; 2], u: f64| from + (to - from) * u;
        let assumptions = Assumptions {
            length_m: between(self.variance.length_m, number(place::LENGTH)),
            density_kg_m3: between(self.variance.density_kg_m3, number(place::DENSITY)),
            ..assumptions.clone()
        };
        let facade = std::array::from_fn(|i| number(place::FACADE.start + i));
        Setting {
            configuration,
            origin: Origin::Matrix(draw, matrix),
            facade: sampler.facade_at(facade, &assumptions),
            coefficients: std::array::from_fn(|l| {
                between(self.bounds[l], number(place::COEFFICIENTS.start + l))
            }),
            scaling: Scaling::Factor(self.variance.factor),
            assumed: Assumed {
                law: *chosen(&self.variance.laws, number(place::LAW)),
                bed: *chosen(&self.beds, number(place::BED)),
                member: (number(place::MEMBER) * (self.members + 1) as f64) as usize,
            },
        }
    }

    /// What decides the points, beside the sampling.
    pub fn hashed(&self) -> String {
        let variables = Variable::ALL.map(Variable::name);
        format!("{variables:?} {:?} {:?} {}", self.variance, self.bounds, self.members)
    }
}

/// One of some, each as likely as another.
fn chosen<T>(of: &[T], u: f64) -> &T {
    &of[((u * of.len() as f64) as usize).min(of.len() - 1)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::survey::Bed;
    use mrbd_kernel::model::ImpactLaw;

    #[test]
    fn regress_factors_have_names_of_their_own_and_groups_are_made_of_them() {
        let numbers = |name: &str| {
            let factor = FACTORS.iter().find(|factor| factor.name == name).expect("a factor");
            (0..NUMBERS).filter(|&i| Matrix::Swapped(*factor).takes_from_b(i)).collect::<Vec<_>>()
        };
        assert_eq!([numbers("wall"), numbers("floor")].concat(), numbers("facade"));
        // The five together are all numbers, each once.
        let all = ["facade", "coefficients", "assumptions", "chaos"].map(numbers).concat();
        assert_eq!(all, (0..NUMBERS).collect::<Vec<_>>());
        let singles = FACTORS.iter().filter(|factor| !factor.is_group).map(|factor| numbers(factor.name));
        let mut singles = singles.collect::<Vec<_>>().concat();
        singles.sort_unstable();
        assert_eq!(singles, all);
        for variable in Variable::ALL {
            assert_eq!(numbers(variable.name()), [variable as usize]);
        }
        let takes = |matrix: Matrix| (0..NUMBERS).filter(|&i| matrix.takes_from_b(i)).count();
        assert_eq!((takes(Matrix::A), takes(Matrix::B)), (0, NUMBERS));
    }

    #[test]
    fn regress_nothing_is_run_for_what_does_not_vary() {
        let bed = |stiffness_pa_per_m| Bed { stiffness_pa_per_m, damping_s: 0.0 };
        let all = Variance {
            laws: vec![ImpactLaw::Whole, ImpactLaw::Contact],
            length_m: [1.0, 4.0],
            density_kg_m3: [1600.0, 2000.0],
            beds: vec![bed(1e13), bed(1e9)],
            factor: 1.0,
        };
        let names = |variance: &Variance| {
            Matrix::of(variance).into_iter().map(Matrix::name).collect::<std::collections::BTreeSet<_>>()
        };
        assert_eq!(names(&all).len(), FACTORS.len() + 2, "names are unique");
        let sharp = Variance { beds: vec![bed(1e13)], ..all.clone() };
        assert_eq!(names(&all).difference(&names(&sharp)).collect::<Vec<_>>(), [&"bed"]);
        let known = Variance {
            laws: vec![ImpactLaw::Whole],
            length_m: [1.0; 2],
            density_kg_m3: [1800.0; 2],
            ..sharp
        };
        assert!(!names(&known).contains("assumptions") && names(&known).contains("chaos"));
    }
}
