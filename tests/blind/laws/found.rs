//! The formulas of an answer, held against what is hidden: by how they are written, and by the force that they are.

use mrbd_formula::{Branches, CarriedState, Formula, Parameter, Place, VARIABLES};
use mrbd_lab::diagnose::answer::{ForceCurve, FoundEffect, FoundState, Summary};
use serde_json::Value;

use super::super::cases::tests::STEP_S;
use super::super::score::reading::{list, text, texts};

/// Displacement, velocity, the true force or moment, and the largest displacement so far at a place.
pub type Excited = [f64; 4];

/// The formula of an effect, ready to be worked out.
fn formula(effect: &FoundEffect) -> Option<Formula> {
    let unit = |name: &String| effect.units.get(name).cloned().unwrap_or_default();
    let parameter = |(name, value): (&String, &f64)| Parameter::new(name, *value, &unit(name));
    let parameters = effect.parameters.iter().map(parameter).collect::<Vec<_>>();
    let state = |state: &FoundState| CarriedState {
        name: state.name.clone(),
        rate: state.rate.clone(),
        start: state.start,
        unit: state.unit.clone(),
        range: None,
    };
    let states = effect.states.iter().map(state).collect::<Vec<_>>();
    let place = Place::named(&effect.place)?;
    Formula::parse_with_states(effect.formula.as_ref()?, place, &parameters, &states).ok()
}

/// The root mean square by which the force of an answer is off, over that of the true force.
///
/// What the floor's spring was found off is part of the answer: a linear spring and k_d are one. `None` where the answer acts
/// elsewhere.
pub fn function_error(answer: &Value, diagnosis: &Summary, points: &[Excited]) -> Option<f64> {
    force_error(answer, &diagnosis.effects, stiffness_n_per_m(diagnosis), points)
}

/// The same of formulas beside a floor's spring that was found.
pub fn force_error(
    answer: &Value,
    effects: &[FoundEffect],
    stiffness_n_per_m: Option<f64>,
    points: &[Excited],
) -> Option<f64> {
    let place = text(answer, "/effects/0/place");
    let all = effects.iter().map(|effect| Some((&effect.place, formula(effect)?)));
    let formulas = all.collect::<Option<Vec<_>>>()?;
    if formulas.is_empty() || formulas.iter().any(|(own, _)| **own != place) {
        return None;
    }
    let softer = if place == "top" { softer(answer, stiffness_n_per_m)? } else { 0.0 };
    let carries = |formula: &Formula| !formula.states().is_empty();
    let told_of_all = list(answer, "/effects").iter().any(|effect| effect.get("states").is_some());
    if !told_of_all && formulas.iter().any(|(_, formula)| carries(formula)) {
        // A state follows from all samples before, of which some are told alone.
        return None;
    }
    let mut found = points.iter().map(|[q, ..]| softer * q).collect::<Vec<_>>();
    for (_, formula) in &formulas {
        let along = match carries(formula) {
            true => along(formula, points),
            false => points.iter().map(|[q, u, _, largest]| formula.value([*q, *u, *largest])).collect(),
        };
        found.iter_mut().zip(along).for_each(|(sum, force)| *sum += force);
    }
    let off = found.iter().zip(points).map(|(found, point)| (found - point[2]).powi(2)).sum::<f64>();
    let all = points.iter().map(|[_, _, force, _]| force.powi(2)).sum::<f64>();
    (all > 0.0).then(|| (off / all).sqrt())
}

/// A formula that carries states along samples of tests, one after another: where the largest displacement falls, a test begins.
fn along(formula: &Formula, points: &[Excited]) -> Vec<f64> {
    const PARTS: u32 = 8;
    let start = formula.at_start([0.0; 3]);
    let (mut at, mut before) = (start, None::<Excited>);
    let value = |point: &Excited| {
        let [q, u, _, largest] = *point;
        match before.filter(|before| before[3] <= largest) {
            None => at = start,
            Some([from, ..]) => {
                let h = STEP_S / f64::from(PARTS);
                let v = (q - from) / STEP_S;
                let rates = |x: f64, z: &[f64]| {
                    formula.program().state_rates([x, v, largest, z[0], z[1]], &Branches::FREE)
                };
                for part in 0..PARTS {
                    let x = |share: f64| from + v * h * (f64::from(part) + share);
                    let z = [at[VARIABLES - 2], at[VARIABLES - 1]];
                    let plus = |rate: [f64; 2], h: f64| [z[0] + h * rate[0], z[1] + h * rate[1]];
                    let r1 = rates(x(0.0), &z);
                    let r2 = rates(x(0.5), &plus(r1, 0.5 * h));
                    let r3 = rates(x(0.5), &plus(r2, 0.5 * h));
                    let r4 = rates(x(1.0), &plus(r3, h));
                    for i in 0..2 {
                        at[VARIABLES - 2 + i] += h / 6.0 * (r1[i] + 2.0 * r2[i] + 2.0 * r3[i] + r4[i]);
                    }
                }
            }
        }
        before = Some(*point);
        formula.value_with_states([q, u, largest, at[VARIABLES - 2], at[VARIABLES - 1]])
    };
    points.iter().map(value).collect()
}

/// Of a force without a formula, over what the tests held out excited inside its range: the root mean square by which it is
/// off over that of the true force, and the share of points whose force the 90 % band holds. `None` for another answer.
pub fn curve_error(answer: &Value, diagnosis: &Summary, points: &[Excited]) -> Option<(f64, f64)> {
    let [by_x, by_v] = &diagnosis.curves[..] else { return None };
    if text(answer, "/effects/0/place") != "top" {
        return None;
    }
    let within = |[low, high]: [f64; 2], x: f64| low <= x && x <= high;
    let inside = points.iter().filter(|[x, v, ..]| within(by_x.range, *x) && within(by_v.range, *v));
    let softer = softer(answer, stiffness_n_per_m(diagnosis))?;
    let apart = |[x, v, force, _]: &Excited| {
        let [a, b] = [told(by_x, *x), told(by_v, *v)];
        // Bands of both curves as if they erred apart.
        (a[0] + b[0] + softer * x - force, a[1].hypot(b[1]), *force)
    };
    let all = inside.map(apart).collect::<Vec<_>>();
    let off = all.iter().map(|(off, ..)| off * off).sum::<f64>();
    let size = all.iter().map(|(.., force)| force * force).sum::<f64>();
    let held = all.iter().filter(|(off, half, _)| off.abs() <= *half).count();
    (size > 0.0).then(|| ((off / size).sqrt(), held as f64 / all.len() as f64))
}

/// Force of a curve and half the width of its band, straight between knots and nothing at rest.
fn told(curve: &ForceCurve, x: f64) -> [f64; 2] {
    let half = curve.interval_n.iter().map(|[low, high]| 0.5 * (high - low));
    let knots = curve.at.iter().zip(&curve.force_n).zip(half).map(|((at, force), half)| (*at, *force, half));
    let mut knots = knots.chain([(0.0, 0.0, 0.0)]).collect::<Vec<_>>();
    knots.sort_by(|a, b| a.0.total_cmp(&b.0));
    let next = knots.iter().position(|knot| x <= knot.0).unwrap_or(knots.len() - 1).max(1);
    let (a, b) = (knots[next - 1], knots[next]);
    let share = (x - a.0) / (b.0 - a.0);
    [a.1 + share * (b.1 - a.1), a.2 + share * (b.2 - a.2)]
}

/// By how much the floor's spring of the answer is softer than the true one, N/m.
fn softer(answer: &Value, found_n_per_m: Option<f64>) -> Option<f64> {
    Some(answer.pointer("/case/stiffness_n_per_m")?.as_f64()? - found_n_per_m?)
}

/// Stiffness of the floor's spring of an answer.
fn stiffness_n_per_m(diagnosis: &Summary) -> Option<f64> {
    let own = diagnosis.wall.iter().find(|number| number.key.ends_with("stiffness_n_per_m"))?;
    Some(own.after)
}

/// An atom of a formula as it is written, with its place, without the numbers of its letters, and these.
struct WrittenAtom<'a> {
    effect: &'a FoundEffect,
    text: String,
    suffix: String,
}

fn atoms(effect: &FoundEffect) -> Vec<WrittenAtom<'_>> {
    let FoundEffect { formula, place, .. } = effect;
    let text = formula.clone().unwrap_or_default().replace(" + ", " ").replace(" - ", " -");
    let is_alone = !text.contains(' ');
    let atom = |(index, part): (usize, &str)| WrittenAtom {
        effect,
        text: format!("{} at {place}", part.replace("_1", "").replace("_2", "")),
        suffix: if is_alone { String::new() } else { format!("_{}", index + 1) },
    };
    text.split(' ').enumerate().map(atom).collect()
}

/// For each hidden atom the one of effects that is written as it is, each once; `None` where they are not written so.
fn atoms_as_hidden<'a>(answer: &Value, effects: &'a [FoundEffect]) -> Option<Vec<WrittenAtom<'a>>> {
    let mut found = effects.iter().flat_map(atoms).collect::<Vec<_>>();
    let hidden = list(answer, "/effects");
    if hidden.is_empty() || hidden.len() != found.len() {
        return None;
    }
    let of_hidden = |one: &Value| {
        let place = text(one, "/place");
        let spelled =
            texts(one, "/spellings", "").iter().map(|s| format!("{s} at {place}")).collect::<Vec<_>>();
        let at = found.iter().position(|atom| spelled.contains(&atom.text));
        at.map(|at| found.swap_remove(at))
    };
    hidden.iter().map(of_hidden).collect()
}

/// Whether effects are written as what is hidden is, each atom once.
pub fn is_spelled_as(answer: &Value, effects: &[FoundEffect]) -> bool {
    atoms_as_hidden(answer, effects).is_some()
}

/// Where effects are written as what is hidden is, but for exponents told as round ones: whether the intervals of these hold the true ones.
pub fn round_exponents_hold(answer: &Value, effects: &[FoundEffect]) -> Option<bool> {
    let with_letters = |effect: &FoundEffect| {
        let free = effect.round_exponents.as_ref().map(|round| round.formula.clone());
        FoundEffect { formula: free.or_else(|| effect.formula.clone()), ..effect.clone() }
    };
    let free = effects.iter().map(with_letters).collect::<Vec<_>>();
    let written = atoms_as_hidden(answer, &free)?;
    let of_atom = |(atom, hidden): (&WrittenAtom, &Value)| {
        let told = atom.effect.round_exponents.iter().flat_map(|round| &round.interval);
        let own = told.filter_map(|(name, interval)| Some((name.strip_suffix(&atom.suffix)?, interval)));
        let holds = |(name, [low, high]): (&str, &[f64; 2])| {
            let truth = hidden.pointer(&format!("/parameters/{name}")).and_then(Value::as_f64);
            truth.is_some_and(|truth| *low <= truth && truth <= *high)
        };
        own.map(holds).collect::<Vec<_>>()
    };
    let all = written.iter().zip(list(answer, "/effects")).flat_map(of_atom).collect::<Vec<_>>();
    (!all.is_empty()).then(|| all.into_iter().all(|holds| holds))
}

/// How far the numbers of an answer of one atom are off: the share of the true one, and whether the interval holds it.
///
/// A coefficient beside an exponent that was taken as exact is asked where the true one is as exact.
pub fn number_errors(answer: &Value, effects: &[FoundEffect]) -> Vec<(f64, bool)> {
    let [effect] = effects else { return Vec::new() };
    if list(answer, "/effects").len() != 1 || !is_spelled_as(answer, effects) {
        return Vec::new();
    }
    let one = |(name, found): (&String, &f64)| {
        let truth = answer.pointer(&format!("/effects/0/parameters/{name}"))?.as_f64()?;
        let [low, high] = *effect.interval.get(name)?;
        Some(((found / truth - 1.0).abs(), low <= truth && truth <= high))
    };
    effect.parameters.iter().filter_map(one).collect()
}
