//! A law as formulas of the kernel.

use super::Site;
use super::law::Law;
use super::written::{Written, WrittenParameter, WrittenState};
use mrbd_formula::{CarriedState, Formula, Parameter, Place};

impl Law {
    /// The formulas that it is, one a place; `None` where one is refused.
    pub fn formulas(&self) -> Option<Vec<Formula>> {
        self.written().iter().map(Written::formula).collect()
    }
}

impl Written {
    /// As the kernel takes it; `None` where it is refused.
    fn formula(&self) -> Option<Formula> {
        let parameter = |p: &WrittenParameter| Parameter::new(&p.name, p.value, &p.unit);
        let parameters = self.parameters.iter().map(parameter).collect::<Vec<_>>();
        let states = self.states.iter().map(WrittenState::carried).collect::<Vec<_>>();
        Formula::parse_with_states(&self.text, place(self.site), &parameters, &states).ok()
    }
}

impl WrittenState {
    /// As the kernel takes it: bounded by its rate.
    pub fn carried(&self) -> CarriedState {
        let Self { name, rate, unit } = self.clone();
        CarriedState { name, rate, start: 0.0, unit, range: None }
    }
}

fn place(site: Site) -> Place {
    match site {
        Site::Top => Place::Top,
        Site::Ground => Place::Ground,
        Site::Crack => Place::Crack,
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Atom, Shape};
    use super::*;

    #[test]
    fn analytic_every_shape_is_a_formula_of_the_same_force() {
        for site in Site::ALL {
            for shape in Shape::ALL.into_iter().filter(|shape| site == Site::Top || !shape.remembers()) {
                for is_exact in [true, false] {
                    let numbers =
                        [0, 1].map(|i| shape.numbers().get(i).map_or(0.0, |n| n.grid[n.grid.len() / 2]));
                    let atom = Atom { site, shape, numbers, size: 300.0, reach: [0.05, 0.3], is_exact };
                    let law = Law::of(atom);
                    let formula = law.formulas().unwrap_or_else(|| panic!("{:?}", law.written())).remove(0);
                    for (q, u) in [(0.03, -0.2), (-0.045, 0.1), (0.01, 0.25), (-0.004, -0.3)] {
                        let motion = [q, u, 0.046];
                        let mut at = formula.at_start(motion);
                        if shape.carries() {
                            // A state in metres, or in shares of its largest.
                            at[3] = motion[2] / if shape == Shape::Yielding { atom.reach[0] } else { 1.0 };
                        }
                        let [own, written] = [atom.force(motion), formula.value_with_states(at)];
                        // Two ways to the same number, of a few roundings each.
                        assert!(
                            (own - written).abs() <= 1e-12 * 300.0,
                            "{formula} at {q}, {u}: {written} for {own}"
                        );
                    }
                }
            }
        }
    }
}
