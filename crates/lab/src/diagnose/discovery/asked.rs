//! What is asked of laws outside the catalogue: the gap that they are to close, how far they are looked for, what they must do.

use super::by_windows::Discovered;
use super::refused::Guard;
use crate::diagnose::formula::Law;
use crate::diagnose::trials::FittedHypothesis;

/// How far laws are looked for: each with what comes before it.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub enum Scope {
    /// Laws of one atom.
    OneAtom,
    /// Where none of these leaves nothing, laws of two.
    TwoAtoms,
    /// Where no law holds, a force without a formula.
    Curves,
}

/// A gap that the catalogue does not close.
#[derive(Debug, Clone, Copy)]
pub struct OpenGap<'t> {
    /// The wall with its uncertain numbers fitted.
    pub recalibrated: &'t FittedHypothesis,
    /// The hypothesis of the catalogue that follows best: the states of windows start from its own.
    pub nearest: &'t FittedHypothesis,
    /// Windowed error of the wall as given.
    pub error: f64,
    /// What is looked for.
    pub scope: Scope,
    /// Laws that windows speak of already: they are tried whatever points say.
    pub kin: &'t [Law],
    /// What was found before: laws that were fitted are not fitted again.
    pub before: Option<&'t Discovered>,
}

/// What a law is asked beside its fit.
pub trait AskedOfLaws {
    /// Whether a law of two atoms is worth it beside the best of one, in all windows or between impacts.
    fn is_worth_two(&self, one: &FittedHypothesis, two: &FittedHypothesis) -> bool;
    /// Whether it follows the tests held out as it does those fitted, but for what another formulation of a contact leaves, and misses
    /// nothing there that no impact excuses.
    fn follows_held_out(&self, law: &FittedHypothesis) -> bool;
    /// Whether what it leaves is noise, or what another formulation of a contact leaves: nothing that a second atom could take away.
    fn leaves_nothing(&self, law: &FittedHypothesis) -> bool;
    /// Which of [`Guard::Bend`] and [`Guard::Trend`] speak against a law.
    fn other_law(&self, law: &FittedHypothesis) -> Vec<Guard>;
}
