//! A model that might be true: the wall, what is uncertain of it, and what is added to it.

mod addition;
#[cfg(test)]
pub mod example;
mod unknown;

pub use addition::{ACTING, Addition};
pub use addition::{beds, candidates};
pub use unknown::Scales;
pub use unknown::{FADES, Nuisance};
pub use unknown::{Measure, Unknown};
pub use unknown::{WALL_NUMBERS, WallNumber, wall_number};

use std::fmt::Debug;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::diagnose::formula::{Curve, Law, LawSlot};
use mrbd_formula::Formula;
use mrbd_kernel::model::{
    Effect, EffectKind, EffectParameter, EffectVariant, Quantity, Role, Wall, WallParameters,
};
use unknown::Slot;

/// The wall under a hypothesis, and the share of the reversed record that a placebo shakes it with upwards.
#[derive(Debug, Clone)]
pub struct Physics {
    /// The wall with its effects.
    pub wall: Wall,
    /// Placebo.
    pub reversed_ratio: f64,
}

/// Walls of numbers that are sought elsewhere, such as by a calibration.
pub trait Walls: Debug + Send + Sync {
    /// The wall with these values; `None` if there is no such wall.
    fn wall_of(&self, values: &[f64]) -> Option<Wall>;
}

/// A wall, what is uncertain of it, and what is added to it.
#[derive(Debug, Clone)]
pub struct Hypothesis {
    base: WallParameters,
    /// What makes the wall where its numbers are not this module's.
    walls: Option<Arc<dyn Walls>>,
    /// What is added.
    pub additions: Vec<Addition>,
    /// Every number to be found: the uncertain ones of the wall first.
    pub unknowns: Vec<Unknown>,
    /// How many of them are the wall's.
    pub nuisances: usize,
    /// A force without a formula, as it was found over points.
    pub curve: Option<Curve>,
    /// What the user calls a law of their own.
    own_name: Option<String>,
}

impl Hypothesis {
    /// What is added to the wall, or what the user calls a law of their own; empty where nothing is.
    pub fn name(&self) -> String {
        if let Some(name) = &self.own_name {
            return name.clone();
        }
        self.additions.iter().map(Addition::name).collect::<Vec<_>>().join(" + ")
    }

    /// The wall with these uncertainties and additions.
    pub fn new(
        base: &WallParameters,
        scales: &Scales,
        nuisances: &[Nuisance],
        additions: &[Addition],
    ) -> Self {
        // A number that an addition sets free has no prior.
        let freed = |n: &&Nuisance| match n {
            Nuisance::Number(number, _) => !additions.contains(&Addition::Number(number)),
            Nuisance::Coefficient(..) => !additions.iter().any(|a| a.role() == Some(Role::Impact)),
        };
        let mut unknowns = nuisances.iter().filter(freed).map(|n| n.unknown(base)).collect::<Vec<_>>();
        let count = unknowns.len();
        for (index, addition) in additions.iter().enumerate() {
            unknowns.extend(addition.unknowns(base, scales, index));
        }
        Self {
            base: base.clone(),
            walls: None,
            additions: additions.to_vec(),
            unknowns,
            nuisances: count,
            curve: None,
            own_name: None,
        }
    }

    /// The wall with these uncertainties and a force without a formula, whose forces at the knots are to be found.
    pub fn of_curve(base: &WallParameters, scales: &Scales, nuisances: &[Nuisance], curve: Curve) -> Self {
        let mut hypothesis = Self::new(base, scales, nuisances, &[Addition::Curve]);
        hypothesis
            .unknowns
            .extend(curve.knots().enumerate().map(|(i, knot)| Unknown::of_knot(i, &curve, knot)));
        hypothesis.curve = Some(curve);
        hypothesis
    }

    /// The force without a formula with these values.
    pub fn curve_with(&self, values: &[f64]) -> Option<Curve> {
        let own = values.get(self.nuisances..)?;
        self.curve.map(|curve| curve.with_forces(own, None))
    }

    /// The wall with these uncertainties and a law of the user's own, whose numbers are to be found.
    ///
    /// A number is looked for from next to nothing to ten times what is written, and keeps its sign.
    pub fn of_formula(
        base: &WallParameters,
        scales: &Scales,
        nuisances: &[Nuisance],
        name: &str,
        formula: &Formula,
    ) -> Self {
        let mut hypothesis = Self::new(base, scales, nuisances, &[]);
        hypothesis.own_name = Some(name.to_owned());
        hypothesis.base.formulas.push(formula.clone());
        let written = formula.parameters().iter().enumerate();
        hypothesis.unknowns.extend(written.map(|(i, parameter)| Unknown::of_formula(i, parameter)));
        hypothesis
    }

    /// Walls whose numbers are sought elsewhere.
    pub fn of_walls(base: &WallParameters, walls: Arc<dyn Walls>, unknowns: Vec<Unknown>) -> Self {
        let nuisances = unknowns.len();
        let (base, walls) = (base.clone(), Some(walls));
        Self { base, walls, additions: Vec::new(), unknowns, nuisances, curve: None, own_name: None }
    }

    /// Where the search starts.
    pub fn start(&self) -> Vec<f64> {
        self.unknowns.iter().map(|u| u.start).collect()
    }

    /// Stiffness of every bed that values mean, Pa/m.
    pub fn stiffness_pa_per_m(&self, values: &[f64]) -> impl Iterator<Item = f64> {
        let of_beds = self.unknowns.iter().zip(values).filter(|(unknown, _)| unknown.is_softness());
        of_beds.map(|(unknown, value)| unknown.number(*value))
    }

    /// The values of another hypothesis for the numbers that both have, and the start for the rest.
    pub fn values_from(&self, other: &Self, values: &[f64]) -> Vec<f64> {
        let of = |unknown: &Unknown| {
            let same = |(theirs, _): &(&Unknown, &f64)| match (unknown.slot, theirs.slot) {
                (Slot::Added(own, i), Slot::Added(index, j)) => {
                    i == j && self.additions[own] == other.additions[index]
                }
                (own, theirs) => own == theirs,
            };
            other.unknowns.iter().zip(values).find(same).map_or(unknown.start, |(_, value)| *value)
        };
        self.unknowns.iter().map(of).collect()
    }

    /// Sum of the squared distances from what was known, in its standard deviations.
    pub fn prior_penalty(&self, values: &[f64]) -> f64 {
        let distance = |(u, v): (&Unknown, &f64)| u.prior_sd.map_or(0.0, |sd| ((v - u.start) / sd).powi(2));
        self.unknowns.iter().zip(values).map(distance).sum()
    }

    /// Adds what was known before to normal equations in these values, as one more measurement. Further rows of `a`
    /// and `g` stay as they are.
    pub fn add_prior(&self, values: &[f64], a: &mut DMatrix<f64>, g: &mut DVector<f64>) {
        for (i, unknown) in self.unknowns.iter().enumerate() {
            if let Some(sd) = unknown.prior_sd {
                a[(i, i)] += 1.0 / (sd * sd);
                g[i] += (values[i] - unknown.start) / (sd * sd);
            }
        }
    }

    /// The effects that the additions with these values are, for the wall file; `None` if one is outside its bounds.
    pub fn effects(&self, values: &[f64]) -> Option<Vec<Effect>> {
        let mut effects = Vec::new();
        for (index, addition) in self.additions.iter().enumerate() {
            match addition {
                Addition::Effect(variant) => {
                    effects.push(variant.with_parameters(&self.parameters(*variant, index, values)).ok()?);
                }
                Addition::LumpedCarriage => {
                    let mass_kg = self.added(index, 0, values)?;
                    let carriage = EffectKind::CarriageMass.variant(None).ok()?;
                    effects.push(carriage.with_parameters(&[mass_kg]).ok()?);
                }
                Addition::Number(_) | Addition::Formula(_) | Addition::Curve | Addition::Placebo => {}
            }
        }
        Some(effects)
    }

    /// The coefficient C_l that a number scales, by its index, where it does nothing else.
    pub fn coefficient_of(&self, number: usize) -> Option<usize> {
        match self.unknowns[number].slot {
            Slot::Coefficient(l) => Some(l),
            Slot::Added(index, i) => match &self.additions[index] {
                Addition::Effect(variant) => {
                    let factor = variant.entry().parameters.get(i)?.quantity == Quantity::ImpactFactor;
                    factor.then_some(i)
                }
                _ => None,
            },
            Slot::Number(_) | Slot::Written(_) | Slot::Sought(_) => None,
        }
    }

    /// The wall these values make; `None` if there is no such wall.
    pub fn physics(&self, values: &[f64]) -> Option<Physics> {
        if let Some(walls) = &self.walls {
            return Some(Physics { wall: walls.wall_of(values)?, reversed_ratio: 0.0 });
        }
        let parameters = self.parameters_of_wall(values)?;
        let placebo = self.additions.iter().position(|a| *a == Addition::Placebo);
        let reversed_ratio = placebo.and_then(|index| self.added(index, 0, values)).unwrap_or(0.0);
        Some(Physics { wall: Wall::new(parameters).ok()?, reversed_ratio })
    }

    /// The parameters of the wall these values make; `None` if an effect is outside its bounds.
    pub fn parameters_of_wall(&self, values: &[f64]) -> Option<WallParameters> {
        let mut p = self.base.clone();
        let mut written = Vec::new();
        for (unknown, &value) in self.unknowns.iter().zip(values) {
            match unknown.slot {
                Slot::Written(_) => written.push(value),
                Slot::Sought(_) => {}
                Slot::Number(number) => (number.set)(&mut p, value),
                Slot::Coefficient(l) => p.restitution.coefficients[l] = value,
                Slot::Added(index, _) => match self.additions[index] {
                    Addition::Number(number) => (number.set)(&mut p, value),
                    Addition::LumpedCarriage => p.diaphragm_mass_kg -= value,
                    _ => {}
                },
            }
        }
        p.effects.extend(self.effects(values)?);
        if let Some(formula) = p.formulas.last_mut().filter(|_| !written.is_empty()) {
            *formula = formula.with_values(&written).ok()?;
        }
        p.formulas.extend(self.formulas(values)?);
        Some(p)
    }

    fn added(&self, index: usize, parameter: usize, values: &[f64]) -> Option<f64> {
        let slot = Slot::Added(index, parameter);
        self.unknowns.iter().zip(values).find(|(u, _)| u.slot == slot).map(|(_, v)| *v)
    }

    /// The law that an addition is with these values.
    fn law(&self, law: &Law, index: usize, values: &[f64]) -> Law {
        let own = self.unknowns.iter().zip(values).filter(|(unknown, _)| unknown.belongs_to(index));
        law.with_values(&own.map(|(_, value)| *value).collect::<Vec<_>>())
    }

    /// The laws outside the catalogue among its additions, with these values.
    pub fn laws(&self, values: &[f64]) -> Vec<Law> {
        let law = |(index, addition): (usize, &Addition)| match addition {
            Addition::Formula(law) => Some(self.law(law, index, values)),
            _ => None,
        };
        self.additions.iter().enumerate().filter_map(law).collect()
    }

    /// Laws and forces without a formula as formulas for the wall file; `None` where one is refused.
    pub fn formulas(&self, values: &[f64]) -> Option<Vec<Formula>> {
        let laws = self.laws(values).iter().map(Law::formulas).collect::<Option<Vec<_>>>()?;
        let curves = self.curve_with(values).iter().map(Curve::formula).collect::<Option<Vec<_>>>()?;
        Some([laws.concat(), curves].concat())
    }

    /// Whether a number is a size, which does nothing where it starts, and no number of a law's shape.
    pub fn is_size(&self, number: usize) -> bool {
        match self.unknowns[number].slot {
            Slot::Added(index, i) => match &self.additions[index] {
                Addition::Formula(law) => matches!(law.slots().get(i), Some(LawSlot::Size(_))),
                _ => true,
            },
            Slot::Number(_) | Slot::Coefficient(_) | Slot::Written(_) | Slot::Sought(_) => true,
        }
    }

    fn parameters(&self, variant: EffectVariant, index: usize, values: &[f64]) -> Vec<f64> {
        let parameters = variant.entry().parameters.iter().enumerate();
        let number = |(i, p): (usize, &EffectParameter)| {
            let slot = Slot::Added(index, i);
            let found = self.unknowns.iter().zip(values).find(|(u, _)| u.slot == slot);
            // A number at its bound is within roundings of it.
            found.map_or(p.neutral, |(u, value)| u.measure.number(*value).clamp(p.least, p.most))
        };
        parameters.map(number).collect()
    }
}
