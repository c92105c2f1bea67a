//! What `mrbd effects` says of formulas: laws that the catalogue does not have.

use serde::Serialize;

use super::{Example, indented, lines_of};
use mrbd_formula::{CarriedState, Formula, FormulaError, Function, Parameter, Place};

/// A formula as an entry beside those of the catalogue.
#[derive(Debug, Serialize)]
pub struct FormulaEntry {
    name: &'static str,
    places: Vec<PlaceEntry>,
    operators: &'static str,
    functions: Vec<&'static str>,
    states: &'static str,
    law: &'static str,
    description: &'static str,
    told_by: &'static str,
}

/// Where a formula acts, what it sees there, and what it gives.
#[derive(Debug, Serialize)]
struct PlaceEntry {
    place: &'static str,
    key: &'static str,
    gives: &'static str,
    variables: &'static [&'static str],
}

const LAW: &str = "what acts on the wall: a spring is -k*x";
const DESCRIPTION: &str = "A force at the top, a moment at a joint or a factor at impacts as arithmetic of what moves there. Units are checked, kinks are \
                           met exactly, and a jump against the motion at v = 0 is friction. What Python reads, it reads \
                           the same way; a comparison is 0 or 1. The acceleration a stands for a mass: `carriage_mass` has it.";
const OPERATORS: &str = "+ - * / ** < <= > >=";
const STATES: &str = "A force at the top may carry up to two states along, numbers with a rate of their own: each with `rate`, `start`, `unit` and, where \
                      its rate does not bound it, `range`.";
const TOLD_BY: &str = "a test at another amplitude: formulas that agree in one range part beyond it";

impl FormulaEntry {
    /// Of the formulas that a wall file may have.
    pub fn new() -> Self {
        let places = Place::ALL.map(|place| PlaceEntry {
            place: place.name(),
            key: place.key(),
            gives: match place {
                Place::Top => "a force, N",
                Place::Ground | Place::Crack => "a moment, N m",
                Place::Impacts => "a factor from 0 to 1 on the coefficient C_l",
            },
            variables: match place {
                Place::Top => &["x m", "v m/s", "x_max the largest abs(x) so far, m"],
                Place::Ground | Place::Crack => &["phi rad", "w rad/s", "N the weight on the joint, N"],
                Place::Impacts => &[
                    "u the speed of the edge that comes down, m/s",
                    "w rad/s",
                    "N the weight on the joint, N",
                ],
            },
        });
        Self {
            name: Formula::KIND,
            places: Vec::from(places),
            operators: OPERATORS,
            functions: Function::ALL.map(Function::name).to_vec(),
            states: STATES,
            law: LAW,
            description: DESCRIPTION,
            told_by: TOLD_BY,
        }
    }

    /// As text.
    pub fn for_people(&self) -> String {
        let mut lines =
            vec![format!("{} — at the top, at a joint or at impacts", self.name), indented(self.description)];
        lines.push(format!("  {}", self.law));
        let of_place = |p: &PlaceEntry| {
            format!("  place = \"{}\": {} gives {} of {}", p.place, p.key, p.gives, p.variables.join(", "))
        };
        lines.extend(self.places.iter().map(of_place));
        lines.push(format!("  operators {}; functions {}", self.operators, self.functions.join(" ")));
        lines.push(indented(&format!("Told by itself by {}.", self.told_by)));
        lines.push("  In a wall file (several add up, factors multiply):\n".to_owned());
        // The example is a formula, as the test below shows.
        let text = example().ok().and_then(|law| toml::to_string(&Example { effects: [law] }).ok());
        lines.push(lines_of(&text.unwrap_or_default()));
        lines.push(indented(self.states));
        // The law is a formula, as the test below shows.
        lines.extend(with_a_state().ok().map(|law| in_a_line(&law)));
        lines.join("\n")
    }
}

fn example() -> Result<Formula, FormulaError> {
    let parameters = [
        Parameter::new("k", 2500.0, "N/m"),
        Parameter::new("c", 900.0, "N*(s/m)**p"),
        Parameter::new("p", 1.7, "1"),
    ];
    Formula::parse("-k*x - c*abs(v)**p*sign(v)", Place::Top, &parameters)
}

fn with_a_state() -> Result<Formula, FormulaError> {
    let parameters = [Parameter::new("k", 20e3, "N/m"), Parameter::new("tau", 0.3, "s")];
    let state = CarriedState {
        name: "z".to_owned(),
        rate: "k*v - z/tau".to_owned(),
        start: 0.0,
        unit: "N".to_owned(),
        range: None,
    };
    Formula::parse_with_states("-z", Place::Top, &parameters, &[state])
}

/// A law with a state in one line.
fn in_a_line(law: &Formula) -> String {
    let state = |s: &CarriedState| {
        format!(
            "[effects.states.{}] rate = \"{}\", start = {}, unit = \"{}\"",
            s.name, s.rate, s.start, s.unit
        )
    };
    let states = law.states().iter().map(state).collect::<String>();
    indented(&format!("A spring behind a damper (Maxwell): {} = \"{law}\", {states}.", law.place().key()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_the_example_is_a_formula() {
        let text = FormulaEntry::new().for_people();
        assert!(example().is_ok() && text.contains("force_n = \"-k*x - c*abs(v)**p*sign(v)\""), "{text}");
        assert!(with_a_state().is_ok() && text.contains("rate = \"k*v - z/tau\""), "{text}");
    }
}
