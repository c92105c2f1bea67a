//! A law: one atom or two, each a shape with a size and numbers, at a place.

use super::shape::Shape;
use crate::diagnose::force::Site;

/// A shape at a place with its numbers, in shares of the largest displacement and velocity there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Atom {
    /// Where it acts.
    pub site: Site,
    /// How.
    pub shape: Shape,
    /// Numbers of the shape, in its order.
    pub numbers: [f64; 2],
    /// Force at the top, N, or moment at a joint, N m, where the shape is 1. It resists where this is positive.
    pub size: f64,
}

impl Atom {
    /// Whether it may have this size: a damper never feeds the wall, and a stop pushes back.
    pub fn may_be(&self, size: f64) -> bool {
        size > 0.0 || !(self.shape.is_damper() || matches!(self.shape, Shape::Stop(_) | Shape::DeadZone))
    }
}

/// A sum of atoms.
#[derive(Debug, Clone, PartialEq)]
pub struct Law {
    /// Its atoms.
    pub atoms: Vec<Atom>,
}

impl Law {
    /// Numbers that were fitted: sizes, and those of shapes.
    pub fn numbers(&self) -> usize {
        self.atoms.iter().map(|atom| 1 + atom.shape.numbers().len()).sum()
    }
}
