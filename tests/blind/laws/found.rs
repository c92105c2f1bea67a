//! The formulas of an answer, held against what is hidden: by how they are written, and by the force that they are.

use mrbd_formula::{Formula, Parameter, Place};
use mrbd_lab::diagnose::answer::{FoundEffect, Summary};
use serde_json::Value;

use super::super::score::reading::{list, text, texts};

/// Displacement, velocity and the true force or moment at a place.
pub type Excited = [f64; 3];

/// The formula of an effect, ready to be worked out.
fn formula(effect: &FoundEffect) -> Option<Formula> {
    let unit = |name: &String| effect.units.get(name).cloned().unwrap_or_default();
    let parameter = |(name, value): (&String, &f64)| Parameter::new(name, *value, &unit(name));
    let parameters = effect.parameters.iter().map(parameter).collect::<Vec<_>>();
    Formula::parse(effect.formula.as_ref()?, Place::named(&effect.place)?, &parameters).ok()
}

/// The root mean square by which the force of an answer is off, over that of the true force.
///
/// What the floor's spring was found off is part of the answer: a linear spring and k_d are one. `None` where the answer acts
/// elsewhere.
pub fn function_error(answer: &Value, diagnosis: &Summary, points: &[Excited]) -> Option<f64> {
    let place = text(answer, "/effects/0/place");
    let all = diagnosis.effects.iter().map(|effect| Some((&effect.place, formula(effect)?)));
    let formulas = all.collect::<Option<Vec<_>>>()?;
    if formulas.is_empty() || formulas.iter().any(|(own, _)| **own != place) {
        return None;
    }
    let softer = if place == "top" { softer(answer, diagnosis)? } else { 0.0 };
    let found = |[q, u, _]: &Excited| {
        formulas.iter().map(|(_, formula)| formula.value([*q, *u, 0.0])).sum::<f64>() + softer * q
    };
    let off = points.iter().map(|point| (found(point) - point[2]).powi(2)).sum::<f64>();
    let all = points.iter().map(|[.., force]| force.powi(2)).sum::<f64>();
    (all > 0.0).then(|| (off / all).sqrt())
}

/// By how much the floor's spring of the answer is softer than the true one, N/m.
fn softer(answer: &Value, diagnosis: &Summary) -> Option<f64> {
    let own = diagnosis.wall.iter().find(|number| number.key.ends_with("stiffness_n_per_m"))?;
    Some(answer.pointer("/case/stiffness_n_per_m")?.as_f64()? - own.after)
}

/// The atoms of formulas as they are written, without the numbers of their letters.
fn atoms(effects: &[FoundEffect]) -> Vec<String> {
    let of = |effect: &FoundEffect| {
        let text = effect.formula.clone().unwrap_or_default().replace("_1", "").replace("_2", "");
        let atoms = text.replace(" + ", " ").replace(" - ", " -");
        atoms.split(' ').map(|atom| format!("{atom} at {}", effect.place)).collect::<Vec<_>>()
    };
    effects.iter().flat_map(of).collect()
}

/// Whether effects are written as what is hidden is, each atom once.
pub fn is_spelled_as(answer: &Value, effects: &[FoundEffect]) -> bool {
    let mut found = atoms(effects);
    let hidden = list(answer, "/effects");
    if hidden.is_empty() || hidden.len() != found.len() {
        return false;
    }
    hidden.iter().all(|one| {
        let place = text(one, "/place");
        let spelled =
            texts(one, "/spellings", "").iter().map(|s| format!("{s} at {place}")).collect::<Vec<_>>();
        let at = found.iter().position(|atom| spelled.contains(atom));
        at.map(|at| found.swap_remove(at)).is_some()
    })
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
