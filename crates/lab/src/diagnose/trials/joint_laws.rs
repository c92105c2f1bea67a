//! Other laws of joints beside a bed.
//!
//! A strip whose top is held has one way to move: its releases tell one moment against one rotation, and not which joint carries
//! how much. So whatever gives at ground, crack or both, by any law of the catalogue, is fitted before anything is named. Of a
//! wall that is free at the top the joints are known apart: only laws of the joints that give are asked, in few windows first.
//! Each law begins where it carries about what the bed does.

use rayon::prelude::*;

use super::Few;
use super::beds::{in_rounds, own_error};
use super::search::judged_from_measured;
use super::{FittedHypothesis, Trials};
use crate::Progress;
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::hypothesis::{Addition, Hypothesis, Unknown};
use crate::limits::{BEDS_WINDOWS, BESIDE_BEDS_ASKED_FOR, REMAINDER_RIVAL};
use mrbd_kernel::model::{EffectKind, G_M_S2, Role};

/// Share of the moment of sharp edges at which a joint of three lines begins.
const PLATEAU: f64 = 0.6;
/// Where its lines bend, over the largest rotation measured; the crack turns by twice that.
const BENDS: [f64; 2] = [0.2, 3.0];
/// Strength of a bed at which it begins to crush, over the stress of the weight on the whole joint.
const STRENGTH: f64 = 5.0;
/// Width over which edges begin worn, and the radius of that, over the width between corners.
const WORN: [f64; 2] = [0.25, 1.0];

impl<P: Progress> Trials<'_, P> {
    /// Laws of joints that are no beds, each with dampers, beside the best bed. Where no top is held these are laws of the joints
    /// that give, with the effect that is named beside the bed, as far as few windows promise something.
    pub fn joint_laws(&self, bed: &FittedHypothesis) -> Vec<FittedHypothesis> {
        let laws = EffectKind::ALL.iter().filter(|kind| kind.entry().role == Role::JointLaw);
        let laws = laws.flat_map(|kind| kind.variants()).map(Addition::Effect);
        let sets = if self.is_held() {
            laws.map(with_dampers).collect::<Vec<_>>()
        } else {
            self.promising_laws(laws.collect(), bed)
        };
        self.progress.begin("other laws of joints", sets.len());
        let fit = |additions: &Vec<Addition>| {
            let fitted = self.joint_law(additions, bed);
            self.progress.advance(1);
            fitted
        };
        let mut fitted = sets.par_iter().filter_map(fit).collect::<Vec<_>>();
        fitted.sort_by(|a, b| a.fit_error().total_cmp(&b.fit_error()));
        fitted
    }

    /// Laws of the joints of a bed in its place, with what stands beside it, that leave no more of few windows than a rival may.
    fn promising_laws(&self, laws: Vec<Addition>, bed: &FittedHypothesis) -> Vec<Vec<Addition>> {
        let additions = &bed.hypothesis.additions;
        // Two joints with a bed each would take two laws.
        let [own, beside @ ..] = &additions[..] else { return Vec::new() };
        if beside.iter().any(|addition| addition.role() == Some(Role::Bed)) {
            return Vec::new();
        }
        let few = Few::new(self.data.fit, BEDS_WINDOWS, own_error(bed));
        let left = few.excess(&few.of(bed).fit);
        // A bed that crushes is a bed where it hardly does: it must follow better.
        let most = |law: &Addition| {
            if is_crushing(law) {
                (1.0 - BESIDE_BEDS_ASKED_FOR) * left
            } else {
                REMAINDER_RIVAL * left.max(few.noise_2())
            }
        };
        let same = laws.into_iter().filter(|law| law.joint() == own.joint());
        let with = |law| with_dampers(law).into_iter().chain(beside.iter().copied()).collect::<Vec<_>>();
        let sets = same.map(with).collect::<Vec<_>>();
        self.progress.begin("other laws of joints, in few windows", sets.len());
        let is_promising = |additions: &Vec<Addition>| {
            let fit = self.joint_law_in(&few.problem(), additions, bed);
            self.progress.advance(1);
            fit.is_some_and(|(_, fit)| few.excess(&fit) < most(&additions[0]))
        };
        sets.into_par_iter().filter(is_promising).collect()
    }

    /// Whether the top of every test was held.
    pub fn is_held(&self) -> bool {
        self.data.fit.tests.iter().all(|test| test.manner.top_held)
    }

    fn joint_law(&self, additions: &[Addition], bed: &FittedHypothesis) -> Option<FittedHypothesis> {
        let (h, fit) = self.joint_law_in(&self.data.fit, additions, bed)?;
        judged_from_measured(&self.data, h, fit)
    }

    /// A law fitted to some windows, from where it carries about what the bed does.
    fn joint_law_in(
        &self,
        problem: &Problem,
        additions: &[Addition],
        bed: &FittedHypothesis,
    ) -> Option<(Hypothesis, Fit)> {
        let h = self.hypothesis(&self.experiment.nuisances, additions);
        let mut values = h.values_from(&bed.hypothesis, &bed.fit.values);
        for (value, unknown) in values.iter_mut().zip(&h.unknowns).skip(h.nuisances) {
            *value = unknown.within(self.begin(unknown, bed));
        }
        let start = problem.states(&h, &values, &problem.measured_states(), 2, false)?;
        let fit = in_rounds(problem, &h, start)?;
        Some((h, fit))
    }

    /// Where a number of a law begins.
    fn begin(&self, unknown: &Unknown, bed: &FittedHypothesis) -> f64 {
        let wall = self.experiment.wall.parameters();
        let largest_rad = self.experiment.scales.rotation_rad;
        let of_bed = |key: &str| {
            let Hypothesis { unknowns, .. } = &bed.hypothesis;
            let place = unknowns.iter().position(|own| own.key == key);
            place.map(|i| bed.fit.values[i])
        };
        let stress_pa = wall.mass_kg * G_M_S2 / (wall.lower_width_m * wall.length_m);
        match unknown.key.as_str() {
            "plateau" => PLATEAU,
            "first_rotation_rad" => BENDS[0] * largest_rad,
            "last_rotation_rad" => BENDS[1] * largest_rad,
            "compressive_strength_pa" => STRENGTH * stress_pa,
            "worn_width_m" => WORN[0] * wall.lower_width_m,
            "radius_m" => WORN[1] * wall.lower_width_m,
            key => of_bed(key).unwrap_or(unknown.scale),
        }
    }
}

/// Whether a hypothesis has a bed that crushes.
pub fn crushes(tried: &FittedHypothesis) -> bool {
    tried.hypothesis.additions.iter().any(is_crushing)
}

fn is_crushing(law: &Addition) -> bool {
    law.kind() == Some(EffectKind::CrushingJoint)
}

/// A law with what takes energy away: its own dampers, or those of the crack where it has none.
fn with_dampers(law: Addition) -> Vec<Addition> {
    let Addition::Effect(variant) = law else { return vec![law] };
    let has_own = variant.entry().parameters.iter().any(|parameter| parameter.key == "damping_s");
    let at_crack = |addition: &Addition| addition.name() == "joint_damping.crack";
    let beside = EffectKind::JointDamping.variants().map(Addition::Effect).find(at_crack);
    std::iter::once(law).chain(beside.filter(|_| !has_own)).collect()
}
