//! A law as a formula of the wall file, with its parameters and their units.

use super::Site;
use super::law::{Atom, Law, LawSlot};
use super::text::{Names, Number, force, rate};

/// A parameter of a written law.
#[derive(Debug, Clone, PartialEq)]
pub struct WrittenParameter {
    /// Its name in the formula.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its unit, as formulas have it; empty for a pure number. Exponents in it may be parameters.
    pub unit: String,
    /// The fitted numbers on which it depends, in the order of [`Law::slots`].
    pub of: Vec<usize>,
}

/// A carried state of a written law, which starts at zero.
#[derive(Debug, Clone, PartialEq)]
pub struct WrittenState {
    /// Its name in the formula.
    pub name: String,
    /// How fast it changes.
    pub rate: String,
    /// Its unit; empty for a pure number.
    pub unit: String,
}

/// The atoms of a law at one place as one formula.
#[derive(Debug, Clone, PartialEq)]
pub struct Written {
    /// The place.
    pub site: Site,
    /// The force or moment on the wall.
    pub text: String,
    /// Carried states.
    pub states: Vec<WrittenState>,
    /// Parameters.
    pub parameters: Vec<WrittenParameter>,
}

impl Law {
    /// Its formulas, one a place.
    pub fn written(&self) -> Vec<Written> {
        let is_alone = self.second.is_none_or(|two| two.site != self.first.site);
        let mut all: Vec<Written> = Vec::new();
        for (index, atom) in self.atoms().enumerate() {
            let suffix = if is_alone { String::new() } else { format!("_{}", index + 1) };
            let own = self.written_atom(index, &atom, &suffix);
            match all.iter_mut().find(|written| written.site == atom.site) {
                Some(written) => {
                    let sign = if own.text.starts_with('-') { '-' } else { '+' };
                    written.text = format!("{} {sign} {}", written.text, own.text.trim_start_matches('-'));
                    written.parameters.extend(own.parameters);
                    written.states.extend(own.states);
                }
                None => all.push(own),
            }
        }
        all
    }

    fn written_atom(&self, index: usize, atom: &Atom, suffix: &str) -> Written {
        let slots = self.slots();
        let at = |slot: LawSlot| slots.iter().position(|own| *own == slot);
        let letters =
            atom.shape.numbers().iter().map(|n| format!("{}{suffix}", n.letter)).collect::<Vec<_>>();
        let number = |i: usize| match letters.get(i) {
            Some(letter) if atom.free().any(|free| free == i) => Number::Named(letter),
            _ => Number::Exact(atom.numbers[i]),
        };
        let names = [number(0), number(1)];
        let coefficient = Coefficient::of(atom, names);
        let letter = format!("{}{suffix}", coefficient.letter);
        let fitted = |i: usize| at(LawSlot::Number(index, i));
        let mut parameters = vec![WrittenParameter {
            name: letter.clone(),
            value: atom.size * coefficient.factor,
            unit: coefficient.unit,
            of: at(LawSlot::Size(index))
                .into_iter()
                .chain(coefficient.exponents.into_iter().filter_map(fitted))
                .collect(),
        }];
        parameters.extend(atom.free().map(|i| WrittenParameter {
            name: letters[i].clone(),
            value: atom.numbers[i] * atom.unit_of(i),
            unit: atom.site.unit_of(atom.meaning(i)).to_owned(),
            of: fitted(i).into_iter().collect(),
        }));
        let [x, v] = atom.site.variables();
        let state = format!("z{suffix}");
        let names = Names { x, v, z: &state, numbers: &names };
        let text = force(atom.shape, &letter, &names);
        let carried = rate(atom.shape, &names).map(|rate| WrittenState {
            rate,
            // What its coefficient has not.
            unit: if coefficient.letter == "f" { String::new() } else { "m".to_owned() },
            name: state.clone(),
        });
        Written { site: atom.site, text, states: carried.into_iter().collect(), parameters }
    }

    /// Intervals of the parameters of a formula where those of the fitted numbers are known.
    pub fn intervals(&self, written: &Written, values: &[f64], intervals: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let index = self.written().iter().position(|own| own.site == written.site).unwrap_or(0);
        let interval = |k: usize| {
            let mut corners = vec![values.to_vec()];
            for &slot in &written.parameters[k].of {
                let ends = |corner: Vec<f64>| {
                    intervals[slot].map(|end| {
                        let mut moved = corner.clone();
                        moved[slot] = end;
                        moved
                    })
                };
                corners = corners.into_iter().flat_map(ends).collect();
            }
            let at = |corner: &Vec<f64>| self.with_values(corner).written()[index].parameters[k].value;
            let all = corners.iter().map(at).collect::<Vec<_>>();
            [
                all.iter().copied().fold(f64::INFINITY, f64::min),
                all.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            ]
        };
        (0..written.parameters.len()).map(interval).collect()
    }
}

/// What stands before the value of an atom once displacement and velocity are no longer shares.
struct Coefficient {
    letter: &'static str,
    unit: String,
    /// Its value for a size of 1.
    factor: f64,
    /// Numbers of the shape on which it depends.
    exponents: Vec<usize>,
}

impl Coefficient {
    fn of(atom: &Atom, names: [Number; 2]) -> Self {
        let powers = atom.shape.powers(atom.numbers);
        let mut factor = 1.0;
        let mut unit = atom.site.unit().to_owned();
        let mut exponents = Vec::new();
        for (i, power) in powers.into_iter().enumerate() {
            let Some(power) = power else { continue };
            factor *= atom.reach[i].powf(-power.value);
            let name = power.number.map_or(Number::Exact(power.value), |k| names[k]);
            exponents.extend(power.number);
            unit.push_str(&per(atom.site, i, name));
        }
        let letter = match (powers.iter().any(Option::is_some), atom.shape.is_damper()) {
            (false, _) => "f",
            (true, true) => "c",
            (true, false) => "k",
        };
        Self { letter, unit, factor, exponents }
    }
}

/// Divided by the unit of displacement or velocity to a power.
fn per(site: Site, variable: usize, power: Number) -> String {
    let base = match (site, variable) {
        (Site::Top, 0) => "/m",
        (Site::Top, _) => "*(s/m)",
        (_, 0) => return String::new(),
        (..) => "*s",
    };
    match power {
        Number::Exact(0.0) => String::new(),
        Number::Exact(1.0) => base.to_owned(),
        power => format!("{base}**{}", power.text()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::shape::{Shape, Side};
    use super::*;

    fn atom(shape: Shape, numbers: [f64; 2], is_exact: bool) -> Atom {
        Atom { site: Site::Top, shape, numbers, size: 360.0, reach: [0.05, 0.2], is_exact }
    }

    fn written(law: Law) -> (String, Vec<(String, f64, String)>) {
        let found = law.written().remove(0);
        (found.text, found.parameters.into_iter().map(|p| (p.name, p.value, p.unit)).collect())
    }

    fn own(name: &str, value: f64, unit: &str) -> (String, f64, String) {
        (name.to_owned(), value, unit.to_owned())
    }

    #[test]
    fn analytic_exact_exponents_are_written_as_people_do() {
        // 360 N at 0.2 m/s.
        let (text, parameters) = written(Law::of(atom(Shape::Drag, [2.0, 0.0], true)));
        assert_eq!(text, "-c*v*abs(v)");
        assert_eq!(parameters.len(), 1);
        assert!((parameters[0].1 - 9000.0).abs() < 1e-9 && parameters[0].2 == "N*(s/m)**2", "{parameters:?}");
        let (text, _) = written(Law::of(atom(Shape::Drag, [0.5, 0.0], true)));
        assert_eq!(text, "-c*sign(v)*sqrt(abs(v))");
        let (text, parameters) = written(Law::of(atom(Shape::Saturation, [0.2, 0.0], true)));
        assert_eq!(
            (text.as_str(), &parameters[..]),
            ("-f*tanh(x/d)", &[own("f", 360.0, "N"), own("d", 0.2 * 0.05, "m")][..])
        );
    }

    #[test]
    fn analytic_a_fitted_exponent_stands_in_the_unit_of_its_coefficient() {
        let (text, parameters) = written(Law::of(atom(Shape::Drag, [1.7, 0.0], false)));
        assert_eq!(text, "-c*sign(v)*abs(v)**n");
        assert_eq!(parameters[0].2, "N*(s/m)**n");
        assert!((parameters[0].1 / (360.0 / 0.2_f64.powf(1.7)) - 1.0).abs() < 1e-12);
        assert_eq!(parameters[1], own("n", 1.7, ""));
    }

    #[test]
    fn analytic_two_atoms_at_a_place_are_one_sum_and_at_two_places_two_formulas() {
        let drag = atom(Shape::Drag, [2.0, 0.0], true);
        let stop = atom(Shape::Stop(Side::Negative), [0.4, 1.0], true);
        let both = Law { first: drag, second: Some(stop) };
        let (text, parameters) = written(both);
        assert_eq!(text, "-c_1*v*abs(v) + k_2*max(-x-g_2,0)");
        assert_eq!(parameters[2], own("g_2", 0.4 * 0.05, "m"));
        let apart = Law { second: Some(Atom { site: Site::Crack, ..stop }), ..both };
        let texts = apart.written().into_iter().map(|w| w.text).collect::<Vec<_>>();
        assert_eq!(texts, ["-c*v*abs(v)", "k*max(-phi-g,0)"]);
    }

    #[test]
    fn analytic_a_coefficient_is_as_sure_as_its_force_and_its_exponent() {
        let law = Law::of(atom(Shape::Drag, [1.7, 0.0], false));
        let found = law.written().remove(0);
        let [c, n] = law.intervals(&found, &law.values(), &[[300.0, 400.0], [1.6, 1.8]])[..] else {
            panic!()
        };
        assert_eq!(n, [1.6, 1.8]);
        assert!((c[0] / (300.0 / 0.2_f64.powf(1.6)) - 1.0).abs() < 1e-12, "{c:?}");
        assert!((c[1] / (400.0 / 0.2_f64.powf(1.8)) - 1.0).abs() < 1e-12, "{c:?}");
    }

    #[test]
    fn analytic_values_of_a_law_go_there_and_back() {
        let law = Law {
            first: atom(Shape::Drag, [1.7, 0.0], false),
            second: Some(atom(Shape::Saturation, [0.2, 0.0], true)),
        };
        assert_eq!(law.values(), [360.0, 1.7, 360.0, 0.2 * 0.05]);
        let again = law.with_values(&law.values()).values();
        assert!(again.iter().zip(law.values()).all(|(a, b)| (a / b - 1.0).abs() < 1e-15), "{again:?}");
    }
}
