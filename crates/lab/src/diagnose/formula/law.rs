//! A law: one atom or two at a place, each a shape with a size and numbers.

use super::Site;
use super::shape::{Meaning, Shape};
use crate::limits::{LEAST_AT_JOINTS, LEAST_AT_TOP};

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
    /// Largest displacement and velocity there: m and m/s, or rad and rad/s.
    pub reach: [f64; 2],
    /// Whether the exponents among its numbers are as they are, and not fitted.
    pub is_exact: bool,
}

impl Atom {
    /// Whether it may have this size: a damper never feeds the wall, a stop pushes back, and so does a root of displacement.
    /// None nearly jumps with velocity, of whatever size, and none does so at a joint.
    pub fn may_be(&self, size: f64) -> bool {
        let velocity = self.shape.powers(self.numbers)[1].map(|power| power.value);
        let is_friction = self.site == Site::Top && velocity == Some(0.0);
        let jumps = !is_friction && velocity.is_some_and(|exponent| exponent < self.least_of_velocity());
        !jumps && (size > 0.0 || !(self.only_resists() || self.is_root()))
    }

    /// Least exponent of velocity that is fitted.
    fn least_of_velocity(&self) -> f64 {
        if self.site == Site::Top { LEAST_AT_TOP } else { LEAST_AT_JOINTS }
    }

    /// Which of its numbers is an exponent of velocity.
    fn exponent_of_velocity(&self) -> Option<usize> {
        self.shape.powers(self.numbers)[1].and_then(|power| power.number)
    }

    /// Least and largest of a number of its shape.
    pub fn bounds(&self, number: usize) -> [f64; 2] {
        let grid = self.shape.numbers()[number].grid;
        let is_of_velocity = self.exponent_of_velocity() == Some(number);
        let least = if is_of_velocity { self.least_of_velocity() } else { 0.0 };
        [grid[0].max(least), grid[grid.len() - 1]]
    }

    /// Whether it is a spring whose stiffness at rest has no bound. Were it to push away, no spring would hold the wall
    /// at rest.
    fn is_root(&self) -> bool {
        matches!(self.shape, Shape::Spring | Shape::OneSidedSpring(_)) && self.numbers[0] < 1.0
    }

    /// Whether it only resists, or only takes energy.
    pub fn only_resists(&self) -> bool {
        let takes = self.shape.is_damper() || self.shape.remembers();
        takes || matches!(self.shape, Shape::Stop(_) | Shape::DeadZone)
    }

    /// What a number of it stands for.
    pub fn meaning(&self, number: usize) -> Meaning {
        self.shape.numbers()[number].meaning
    }

    /// What one in shares of the largest is in the units of the site, for a number of it.
    pub fn unit_of(&self, number: usize) -> f64 {
        match self.meaning(number) {
            Meaning::Exponent | Meaning::Share => 1.0,
            Meaning::Displacement => self.reach[0],
            Meaning::Velocity => self.reach[1],
            Meaning::Time => self.reach[0] / self.reach[1],
        }
    }

    /// Numbers that are fitted, by their place in [`Atom::numbers`]. A power 0 of velocity is friction and stays so.
    pub fn free(&self) -> impl Iterator<Item = usize> + use<> {
        let atom = *self;
        let is_friction = |i: usize| atom.exponent_of_velocity() == Some(i) && atom.numbers[i] == 0.0;
        let is_exact = |i: usize| atom.is_exact && atom.meaning(i) == Meaning::Exponent;
        let free = (0..self.shape.numbers().len()).filter(|&i| !is_exact(i) && !is_friction(i));
        free.collect::<Vec<_>>().into_iter()
    }

    /// Forces along a path of times and displacements, N, of a shape that carries a state along; the state starts at zero.
    pub fn forces_along(&self, path: &[[f64; 2]]) -> Vec<f64> {
        let unit_s = self.reach[0] / self.reach[1];
        let mut z = 0.0;
        let steps = path.windows(2).map(|ends| {
            let [[from_s, from], [to_s, to]] = [ends[0], ends[1]];
            z = self.shape.carried(self.numbers, z, (to - from) / self.reach[0], (to_s - from_s) / unit_s);
            -self.size * z
        });
        std::iter::once(0.0).chain(steps).take(path.len()).collect()
    }

    /// Force or moment on the wall at a displacement, a velocity and the largest displacement so far. Nothing tells it of a shape that
    /// carries a state: [`Atom::forces_along`] does.
    pub fn force(&self, [q, u, m]: [f64; 3]) -> f64 {
        let [of_q, of_u] = self.reach;
        -self.size * self.shape.value(self.numbers, [q / of_q, u / of_u, m / of_q])
    }
}

/// Which number of which atom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LawSlot {
    /// Its size.
    Size(usize),
    /// A number of its shape.
    Number(usize, usize),
}

/// A sum of one atom or two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    /// The first atom.
    pub first: Atom,
    /// The second, if there is one.
    pub second: Option<Atom>,
}

impl Law {
    /// Of one atom.
    pub fn of(atom: Atom) -> Self {
        Self { first: atom, second: None }
    }

    /// Its atoms.
    pub fn atoms(&self) -> impl Iterator<Item = Atom> + use<> {
        [Some(self.first), self.second].into_iter().flatten()
    }

    /// The same with atoms changed, each with its index.
    #[must_use]
    pub fn map(self, change: impl Fn(usize, Atom) -> Atom) -> Self {
        Self { first: change(0, self.first), second: self.second.map(|atom| change(1, atom)) }
    }

    /// Numbers that are fitted, in order.
    pub fn slots(&self) -> Vec<LawSlot> {
        let of = |(a, atom): (usize, Atom)| {
            std::iter::once(LawSlot::Size(a)).chain(atom.free().map(move |i| LawSlot::Number(a, i)))
        };
        self.atoms().enumerate().flat_map(of).collect()
    }

    /// Their values, in the units of the site.
    pub fn values(&self) -> Vec<f64> {
        let atoms = self.atoms().collect::<Vec<_>>();
        let value = |slot: &LawSlot| match *slot {
            LawSlot::Size(a) => atoms[a].size,
            LawSlot::Number(a, i) => atoms[a].numbers[i] * atoms[a].unit_of(i),
        };
        self.slots().iter().map(value).collect()
    }

    /// The law with such values.
    #[must_use]
    pub fn with_values(&self, values: &[f64]) -> Self {
        let mut law = *self;
        for (slot, &value) in self.slots().iter().zip(values) {
            law = law.map(|a, mut atom| {
                match *slot {
                    LawSlot::Size(own) if own == a => atom.size = value,
                    LawSlot::Number(own, i) if own == a => atom.numbers[i] = value / atom.unit_of(i),
                    _ => {}
                }
                atom
            });
        }
        law
    }

    /// Its formulas with their places, for tables: `-c*v*abs(v) at top`.
    pub fn name(&self) -> String {
        let one = |written: &super::Written| {
            let rates =
                written.states.iter().map(|state| format!(" with d{}/dt = {}", state.name, state.rate));
            format!("{}{} at {}", written.text, rates.collect::<String>(), written.site.name())
        };
        self.written().iter().map(one).collect::<Vec<_>>().join(" and ")
    }

    /// Whether two are of the same shapes at the same places, whatever their numbers.
    pub fn is_like(&self, other: &Self) -> bool {
        let kinds = |law: &Self| law.atoms().map(|atom| (atom.site, atom.shape)).collect::<Vec<_>>();
        kinds(self) == kinds(other)
    }
}
