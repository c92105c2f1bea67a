//! The missing force at the top under the wall as given and as updated, and the laws and jumps beside it.

use super::findings::Findings;
use super::rows::{ForceRow, JumpRow, LawPoint};
use super::summary::{ExplainedBy, ForceSize, MissingForce};
use crate::diagnose::force::{
    Against, ForcePoint, LawCurve, explained_by, force_points, jumps, law_curves, median_share_off_top,
};
use crate::diagnose::hypothesis::Physics;
use crate::diagnose::measured::TestData;
use mrbd_kernel::model::{Contact, Pivot, RockingWall};

/// Both joints open: the arms of a force at the top are the heights of the crack and of the upper body.
const UPRIGHT: Contact = Contact { ground: Pivot::Right, crack: Pivot::Right };

/// The missing force in every stretch.
#[derive(Debug)]
pub(super) struct ForceBeforeAfter {
    before: Vec<ForcePoint>,
    after: Vec<ForcePoint>,
}

impl ForceBeforeAfter {
    /// Measures it under the wall as given and as updated.
    pub fn new(tests: &[TestData], [before, after]: &[Physics; 2]) -> Self {
        Self { before: force_points(tests, before), after: force_points(tests, after) }
    }

    /// What it comes to.
    pub fn summary(&self, [before, _]: &[Physics; 2]) -> MissingForce {
        let direction = median_share_off_top(&self.before);
        let [displacement_m, velocity_m_s, acceleration_m_s2] =
            Against::ALL.map(|against| explained_by(&self.before, against));
        MissingForce {
            points: self.before.len(),
            before: size(&self.before),
            after: size(&self.after),
            median_share_off_top: direction.map(|(share, _)| share),
            explained_by: ExplainedBy { displacement_m, velocity_m_s, acceleration_m_s2 },
            points_with_direction: direction.map_or(0, |(_, points)| points),
            arms_of_top_m: RockingWall::new(&before.wall).top_arms_m(UPRIGHT, [0.0; 2]),
        }
    }

    /// Its rows, with what the updated wall leaves of it.
    pub fn rows(&self, tests: &[TestData]) -> Vec<ForceRow> {
        let row = |point: &ForcePoint| {
            // Sensors of the updated wall may move the stretches.
            let same = |p: &&ForcePoint| p.test == point.test && p.time_s == point.time_s;
            ForceRow {
                test: tests[point.test].name.clone(),
                purpose: tests[point.test].purpose,
                point: point.clone(),
                after_n: self.after.iter().find(same).map(|p| p.force_n),
            }
        };
        self.before.iter().map(row).collect()
    }
}

impl Findings<'_> {
    /// The laws of the best hypotheses, to be drawn through the force.
    pub(super) fn law_points(&self, force: &ForceBeforeAfter) -> Vec<LawPoint> {
        let point = |curve: &LawCurve, &(x, force_n): &(f64, f64)| LawPoint {
            name: curve.name.clone(),
            against: curve.against,
            x,
            force_n,
        };
        let curves = law_curves(&self.experiment.wall, &self.found.tried, &force.before);
        curves.iter().flat_map(|curve| curve.points.iter().map(|p| point(curve, p))).collect()
    }

    /// Velocities after impacts over those of the wall as given, then over those of the updated one.
    pub(super) fn jump_rows(&self, physics: &[Physics; 2]) -> Vec<JumpRow> {
        let rows = |(wall, physics): (&'static str, &Physics)| {
            let jumps = jumps(&self.tests, physics).into_iter();
            jumps
                .map(|jump| JumpRow { test: self.tests[jump.test].name.clone(), wall, jump })
                .collect::<Vec<_>>()
        };
        ["given", "updated"].into_iter().zip(physics).flat_map(rows).collect()
    }
}

/// Size of a force over stretches; nothing where there are none.
fn size(points: &[ForcePoint]) -> ForceSize {
    let squares = points.iter().map(|p| p.force_n * p.force_n).sum::<f64>();
    let noise = points.iter().map(|p| p.force_sd_n * p.force_sd_n).sum::<f64>();
    let count = (points.len() as f64).max(1.0);
    ForceSize { rms_n: (squares / count).sqrt(), noise_rms_n: (noise / count).sqrt() }
}
