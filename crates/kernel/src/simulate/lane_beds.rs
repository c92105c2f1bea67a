//! The steps of a row of walls on beds, and whether their joints surely keep their contact.

use super::events::ROUNDINGS;
use super::lane_paths::{bound, scale};
use super::lane_steps::{GroundLanes, Landed, Stepping, apart, as_rate, landed_by};
use super::lane_values::TwoRotations;
use super::row::{BedLimitRow, MovingRow, Row};
use crate::lanes::{Numbers, Wide};
use crate::model::{BeddedMotions, MotionRow, Pose, ReactionLanes};
use crate::solver::{Field, Rate};

/// Walls on beds that turn as one, or apart.
pub(super) struct OnBeds<F: Wide, const AS_ONE: bool>(pub BeddedMotions<F>);

/// Walls on beds under the ground's motion, and the reactions once they have landed.
struct BeddedShaken<'a, F: Wide> {
    motions: &'a BeddedMotions<F>,
    ground: GroundLanes<F>,
    /// That of the last stage, whose positions are those of the end.
    pose: Option<Pose<F>>,
    reactions: Option<ReactionLanes<F>>,
}

impl<F: Wide> Field<TwoRotations<F>> for BeddedShaken<'_, F> {
    #[inline(always)]
    fn rate(&mut self, after_s: F, theta: TwoRotations<F>, omega: TwoRotations<F>) -> Rate<TwoRotations<F>> {
        as_rate(apart::<F, _>(
            after_s.token(),
            #[inline(always)]
            || {
                let pose = self.pose.insert(self.motions.pose(theta.0));
                self.motions.rate(pose, [theta.0, omega.0], self.ground.at(after_s))
            },
        ))
    }

    #[inline(always)]
    fn land(&mut self, after_s: F, theta: TwoRotations<F>, omega: TwoRotations<F>) -> Rate<TwoRotations<F>> {
        let pose = self.pose.get_or_insert_with(|| self.motions.pose(theta.0));
        let (rate, reactions) =
            self.motions.rate_and_reactions(pose, [theta.0, omega.0], self.ground.at(after_s));
        self.reactions = Some(reactions);
        as_rate(rate)
    }
}

impl<F: Wide, const AS_ONE: bool> Stepping<F> for OnBeds<F, AS_ONE> {
    const AS_ONE: bool = AS_ONE;
    const ON_BEDS: bool = true;

    #[inline(always)]
    fn step(&self, simd: F::Token, row: &Row) -> Landed<F> {
        let ground = GroundLanes::of_row(simd, &row.ground);
        let mut shaken = BeddedShaken { motions: &self.0, ground, pose: None, reactions: None };
        let stride = row.moving.stride(simd, &mut shaken);
        let Some(reactions) = shaken.reactions else { unreachable!("a step that was taken has landed") };
        landed_by(stride, reactions)
    }

    #[inline(always)]
    fn top_displacement_m(&self, theta: [F; 2]) -> F {
        self.0.top_displacement_m(&self.0.pose(theta))
    }

    #[inline(always)]
    fn put_back(self, row: &mut MotionRow) {
        self.0.put_back(row);
    }
}

impl BedLimitRow {
    /// Whether the rotations across joints on beds surely stay between the limits of their contact, as
    /// [`super::bed_events::first_bed_change`] finds it.
    #[inline(always)]
    pub fn keep_contact<F: Wide>(&self, moving: &MovingRow, landed: &Landed<F>, h: F) -> F::Mask {
        let [lower, upper] = [moving.path(0, landed, scale(h)), moving.path(1, landed, scale(h))];
        let size = bound(&lower) + bound(&upper);
        let opening = moving.opening_of_crack(landed, scale(h));
        self.stays_between(0, &lower, size) & self.stays_between(1, &opening, size)
    }

    /// Where a path starts does not matter: it starts at a limit after a change, on either side of it by how well that was located.
    #[inline(always)]
    fn stays_between<F: Wide>(&self, joint: usize, c: &[F; 6], size: F) -> F::Mask {
        let of = |numbers: &Numbers| F::of_row(size.token(), numbers);
        let least = c[1].min(c[2]).min(c[3].min(c[4])).min(c[5]);
        let most = c[1].max(c[2]).max(c[3].max(c[4])).max(c[5]);
        let (low, high) = (of(&self.low_rad[joint]), of(&self.high_rad[joint]));
        let rounding = |limit: F| size.max(limit.abs()) * (ROUNDINGS * f64::EPSILON);
        (least - low).simd_gt(rounding(low)) & (high - most).simd_gt(rounding(high))
    }
}
