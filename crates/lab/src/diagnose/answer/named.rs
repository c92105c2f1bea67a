//! The effects of an answer by name, as they are told.

use std::collections::BTreeMap;

use super::Findings;
use super::summary::FoundEffect;
use crate::diagnose::certainty::{intervals, intervals_beside_own_error};
use crate::diagnose::trials::{FRICTION, FittedHypothesis, friction_in_two_parts, giving_friction};

impl Findings<'_> {
    /// The effects of an answer with their numbers and 90 % intervals.
    pub(super) fn named_effects(&self) -> Vec<FoundEffect> {
        let after = &self.found.after;
        let intervals = match self.found.remainder {
            Some(_) => intervals_beside_own_error(&self.data(), after),
            None => intervals(&self.data(), after),
        };
        let effect = |index: usize| FoundEffect {
            round_exponents: self.exponent_of_name(index),
            ..found_effect(after, &intervals, index)
        };
        let mut effects: Vec<FoundEffect> = (0..after.hypothesis.additions.len()).map(effect).collect();
        if let Some(friction) = friction_in_one(after, &intervals) {
            effects.retain(|effect| effect.kind.as_deref() != Some(FRICTION.name()));
            effects.insert(0, friction);
        }
        effects
    }
}

/// One effect of an answer.
fn found_effect(after: &FittedHypothesis, intervals: &[[f64; 2]], index: usize) -> FoundEffect {
    let (h, values) = (&after.hypothesis, &after.fit.values);
    let addition = &h.additions[index];
    let numbers = |keys: &[(String, usize)]| {
        let parameters =
            keys.iter().map(|(key, i)| (key.clone(), h.unknowns[*i].measure.number(values[*i]))).collect();
        (
            parameters,
            keys.iter()
                .map(|(key, i)| (key.clone(), h.unknowns[*i].measure.interval(intervals[*i])))
                .collect(),
        )
    };
    if let Some(friction) = giving_friction(h, values, index) {
        let (parameters, interval) = numbers(&[("force_n".to_owned(), friction.force)]);
        return FoundEffect {
            kind: Some(FRICTION.name().to_owned()),
            name: Some(FRICTION.name().to_owned()),
            place: addition.place().to_owned(),
            parameters,
            interval,
            written_as: Some(addition.name()),
            sets_in_over_m: Some(friction.onset_m),
            ..FoundEffect::default()
        };
    }
    let own = (0..h.unknowns.len()).filter(|i| h.unknowns[*i].belongs_to(index));
    let (parameters, interval) = numbers(&own.map(|i| (h.unknowns[i].key.clone(), i)).collect::<Vec<_>>());
    FoundEffect {
        kind: addition.kind().map(|kind| kind.name().to_owned()),
        name: Some(addition.name()),
        place: addition.place().to_owned(),
        parameters,
        interval,
        ..FoundEffect::default()
    }
}

/// Friction that is fitted in two parts as the one that it is, with the sum of their forces and its interval.
fn friction_in_one(after: &FittedHypothesis, intervals: &[[f64; 2]]) -> Option<FoundEffect> {
    let (h, values) = (&after.hypothesis, &after.fit.values);
    let (index, parts) = friction_in_two_parts(h, values)?;
    let covariance = after.fit.covariance.as_ref()?;
    let variance = |i: usize, k: usize| covariance[(parts[i], parts[k])];
    let sd_n = (variance(0, 0) + variance(1, 1) + 2.0 * variance(0, 1)).max(0.0).sqrt();
    // Of as many standard deviations as that of the part that gives.
    let [low, high] = intervals[parts[0]];
    let own_n = Some(variance(0, 0).sqrt()).filter(|sd_n| *sd_n > 0.0)?;
    let half_n = 0.5 * (high - low) * sd_n / own_n;
    let force_n = values[parts[0]] + values[parts[1]];
    let with_force = |value: f64| BTreeMap::from([("force_n".to_owned(), value)]);
    Some(FoundEffect {
        parameters: with_force(force_n),
        interval: BTreeMap::from([("force_n".to_owned(), [force_n - half_n, force_n + half_n])]),
        written_as: Some(h.name()),
        ..found_effect(after, intervals, index)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::Fit;
    use crate::diagnose::hypothesis::example::starter_with;
    use nalgebra::DMatrix;

    #[test]
    fn analytic_two_parts_of_a_friction_are_told_as_their_sum() {
        let told = |sd_n: f64, together_n2: f64| {
            let mut covariance = DMatrix::zeros(3, 3);
            (covariance[(0, 0)], covariance[(2, 2)]) = (9.0, sd_n * sd_n);
            (covariance[(0, 2)], covariance[(2, 0)]) = (together_n2, together_n2);
            let fit = Fit {
                values: vec![4.0, 396.0 / 1e-4, 396.0],
                windows: Vec::new(),
                cost: 0.0,
                covariance: Some(covariance),
            };
            let hypothesis = starter_with(&["coulomb_friction", "yielding_spring"]);
            let after = FittedHypothesis { hypothesis, held_out: fit.clone(), fit };
            friction_in_one(&after, &[[0.0, 10.0], [1e6, 1e7], [391.0, 401.0]])
        };
        // What one has more the other has less: √(9 + 9 - 17) N in all, a third of that of each.
        let friction = told(3.0, -8.5).expect("friction");
        assert_eq!(friction.parameters["force_n"], 400.0);
        let [low, high] = friction.interval["force_n"];
        assert!((low - (400.0 - 5.0 / 3.0)).abs() < 1e-9 && (high - (400.0 + 5.0 / 3.0)).abs() < 1e-9);
        assert_eq!(friction.kind.as_deref(), Some("coulomb_friction"));
        assert_eq!(friction.written_as.as_deref(), Some("coulomb_friction + yielding_spring"));
        assert!(told(0.0, 0.0).is_none(), "nothing is known of a part");
    }
}
