//! Coefficients of impacts that depend on how fast a joint closes.
//!
//! The coefficients of Table 2 are constants: of two impacts with the same change of pattern, both keep the same share.
//! Measured ones need not: what a faster impact crushes is lost. Such a law is a factor on C_l, the catalogue's exp(-b u)
//! or a formula.

use std::sync::Arc;

use mrbd_formula::{Branches, Formula, Place, Program, state};

use super::super::contact::{Joint, Touching};
use super::super::geometry::Pair;
use super::super::rocking::{RockingWall, opening};
use super::super::wall::{ImpossibleWall, Wall};
use super::check::{reach, refused};

/// The factors of a wall that are formulas.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct ImpactFactors(Vec<Arc<Program>>);

impl ImpactFactors {
    /// Of the formulas of a wall at impacts, checked at every speed that it can reach.
    ///
    /// # Errors
    /// [`ImpossibleWall`] with the key of the formula.
    pub fn of(wall: &Wall) -> Result<Self, ImpossibleWall> {
        let formulas = wall.parameters().formulas.iter().enumerate();
        let at_impacts = formulas.filter(|(_, formula)| formula.place() == Place::Impacts);
        let factor = |(i, formula): (usize, &Formula)| match formula.check(&reach(wall, Place::Impacts)) {
            Ok(_) => Ok(Arc::clone(formula.program())),
            Err(error) => Err(refused(i, formula, error)),
        };
        at_impacts.map(factor).collect::<Result<_, _>>().map(Self)
    }
}

impl RockingWall {
    /// Whether the coefficients of impacts are the same however fast these are.
    #[inline]
    pub(in crate::model) fn strikes_alike(&self) -> bool {
        let ImpactFactors(factors) = &self.wall().impact_factors;
        factors.is_empty() && self.wall().effects.impact_fading_s_per_m == 0.0
    }

    /// By what the velocities before scale the coefficient of an impact; 1 where they do not matter. Where both joints touch at once, the
    /// one whose edge comes down faster counts.
    #[inline]
    pub(in crate::model) fn factor_at_impact(&self, touching: Touching, omega: Pair) -> f64 {
        if self.strikes_alike() {
            return 1.0;
        }
        let ImpactFactors(factors) = &self.wall().impact_factors;
        let fading_s_per_m = self.wall().effects.impact_fading_s_per_m;
        let closing = |joint: Joint| {
            let rate_rad_s = opening(joint, omega).abs();
            state([self.width_m(joint) * rate_rad_s, rate_rad_s, self.wall().weights_n()[joint as usize]])
        };
        let touching = self.joints().filter(|joint| touching.at(*joint)).map(closing);
        let fastest = touching.max_by(|a, b| a[0].total_cmp(&b[0])).unwrap_or(state([0.0; 3]));
        let written: f64 = factors.iter().map(|factor| factor.value(fastest, &Branches::FREE)).product();
        libm::exp(-fading_s_per_m * fastest[0]) * written
    }
}
