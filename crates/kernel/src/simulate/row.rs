//! Runs in a row: all that the steps of the runs in it need and change, number by number as vector registers take it.
//!
//! A run boards a lane of the row and alights where something happens that is not the same for every run: an event,
//! a step that is too long, a new maximum. Until then it takes no work of its own.

use std::sync::Arc;

use super::ground_path::Piece;
use super::lane_impacts::ImpactRow;
use super::lane_steps::Landed;
use super::response::Peak;
use super::totals::raise_rotations;
use crate::lanes::{LANES, Numbers, Wide};
use crate::model::{JointForce, JointForces, MotionRow, Reactions, Vector};
use crate::solver::{ErrorRow, Point, Quintic, Step};

/// The samples of the record in every lane.
pub(super) type Samples = [Arc<[Vector]>; LANES];

/// The runs of a row.
#[derive(Debug, Default)]
pub(super) struct Row {
    /// Bits of the lanes that are taken.
    pub taken: u64,
    /// The samples of the records.
    pub samples: Samples,
    pub motions: MotionRow,
    pub moving: MovingRow,
    pub ground: GroundRow,
    pub errors: ErrorRow,
    pub limits: LimitRow,
    pub kinks: KinkRow,
    pub beds: BedLimitRow,
    pub impacts: ImpactRow,
    pub sums: SumRow,
    pub landed: LandedRow,
    /// Whether the runs are watched, the times in s up to which their motion need not be shown, the bits of the lanes whose last step
    /// is to be shown, and where and when these were before it.
    pub watched: bool,
    pub wants_from_s: Numbers,
    pub shown: u64,
    pub before: MovingRow,
    pub before_s: Numbers,
}

/// Where the runs are, and the length of their next step, s.
#[derive(Debug, Clone, Default)]
pub(super) struct MovingRow {
    pub position: [Numbers; 2],
    pub velocity: [Numbers; 2],
    pub acceleration: [Numbers; 2],
    pub powers_w: [Numbers; 2],
    pub h: Numbers,
}

/// The pieces of the record that the runs are in, and those that follow.
#[derive(Debug, Default)]
pub(super) struct GroundRow {
    pub from: [Numbers; 2],
    pub slope: [Numbers; 2],
    pub start_s: Numbers,
    pub length_s: Numbers,
    /// How far the runs are in their piece, s.
    pub offset_s: Numbers,
    /// The number of the piece, twice: to find samples and to reckon times.
    pub k: [usize; LANES],
    pub piece: Numbers,
    pub samples: Numbers,
    pub step_s: Numbers,
    pub samples_per_s: Numbers,
    pub origin_s: Numbers,
    pub end_s: Numbers,
}

/// What must hold for a step to be kept without a look at it.
#[derive(Debug, Default)]
pub(super) struct LimitRow {
    /// 1 where the step is to advance, 0 where it is for an event or every step is looked at.
    pub advances: Numbers,
    /// Sides on which the joints are open.
    pub sides: [Numbers; 2],
    pub collapse_rad: [Numbers; 2],
    /// Magnitudes of the largest rotations so far, rad.
    pub theta_max_rad: [Numbers; 2],
    /// 1 where a joint is closed, one over its width in 1/m, and over the weight of the wall, 1/N.
    pub closed: Numbers,
    pub per_width: Numbers,
    pub per_weight: Numbers,
    /// Smallest corner force of the closed joint now, over the weight.
    pub corner_force: Numbers,
    /// Velocity of the top now, m/s.
    pub top_velocity_m_s: Numbers,
    /// 1 where the pivot of a joint is under tension.
    pub tension: [Numbers; 2],
    /// 1 of a wall with a crack.
    pub cracked: Numbers,
}

/// Where the laws at the top have kinks.
#[derive(Debug, Default)]
pub(super) struct KinkRow {
    /// Whether those of any run have.
    pub any: bool,
    /// Displacements between which the top is far from them, m; finite.
    pub least_m: Numbers,
    pub most_m: Numbers,
    /// Which way the top moves as a spring yields, and as it slides: ±1, or 0 where it does neither.
    pub stops: [Numbers; 2],
    /// Thickness and height of the walls, beside which roundings are small.
    pub thickness_m: Numbers,
    pub height_m: Numbers,
    /// Displacement (m) and acceleration (m/s²) of the top now.
    pub top_m: Numbers,
    pub top_m_s2: Numbers,
}

/// Between which rotations across joints on beds keep their contact, rad; finite.
#[derive(Debug, Default)]
pub(super) struct BedLimitRow {
    pub low_rad: [Numbers; 2],
    pub high_rad: [Numbers; 2],
}

/// What every step adds to.
#[derive(Debug, Default)]
pub(super) struct SumRow {
    /// Largest rotations of both bodies.
    pub theta_max: [[Peak; 2]; LANES],
    pub top_m: Numbers,
    pub top_time_s: Numbers,
    pub pattern_time_s: Numbers,
    pub friction: [Numbers; 2],
    pub compression_n: [Numbers; 2],
    pub ground_work_j: Numbers,
    pub effect_loss_j: Numbers,
    pub passed_through_j: Numbers,
    /// Steps since the run boarded, and those of them that the tolerance made end before a sample.
    pub steps: Numbers,
    pub tolerance_steps: Numbers,
    /// Steps since then that were not kept.
    pub rejected_steps: Numbers,
    /// Steps that the run may try since then.
    pub most_steps: Numbers,
}

/// What the last step gave.
#[derive(Debug, Default)]
pub(super) struct LandedRow {
    position: [Numbers; 2],
    velocity: [Numbers; 2],
    acceleration: [Numbers; 2],
    quadrature: [Numbers; 2],
    powers_w: [Numbers; 2],
    position_error: [Numbers; 2],
    velocity_error: [Numbers; 2],
    ground: [Numbers; 3],
    crack: [Numbers; 3],
    top: [Numbers; 3],
}

/// One number of both bodies in a lane.
fn both(of: &[Numbers; 2], i: usize) -> [f64; 2] {
    [of[0][i], of[1][i]]
}

/// Puts a number of both bodies in a lane.
pub(super) fn put(to: &mut [Numbers; 2], i: usize, [first, second]: [f64; 2]) {
    to[0][i] = first;
    to[1][i] = second;
}

impl MovingRow {
    /// The motion in a lane, and the powers there.
    pub fn at(&self, i: usize) -> (Point, [f64; 2]) {
        let point = Point {
            position: both(&self.position, i),
            velocity: both(&self.velocity, i),
            acceleration: both(&self.acceleration, i),
        };
        (point, both(&self.powers_w, i))
    }

    pub fn put(&mut self, i: usize, now: &Point, powers_w: [f64; 2], h: f64) {
        put(&mut self.position, i, now.position);
        put(&mut self.velocity, i, now.velocity);
        put(&mut self.acceleration, i, now.acceleration);
        put(&mut self.powers_w, i, powers_w);
        self.h[i] = h;
    }
}

impl GroundRow {
    /// The piece in a lane.
    pub fn at(&self, i: usize) -> Piece {
        let vector = |of: &[Numbers; 2]| Vector { x: of[0][i], y: of[1][i] };
        Piece {
            start_s: self.start_s[i],
            length_s: self.length_s[i],
            from: vector(&self.from),
            slope: vector(&self.slope),
        }
    }

    pub fn put(&mut self, i: usize, piece: &Piece, k: usize, offset_s: f64) {
        put(&mut self.from, i, [piece.from.x, piece.from.y]);
        put(&mut self.slope, i, [piece.slope.x, piece.slope.y]);
        self.start_s[i] = piece.start_s;
        self.length_s[i] = piece.length_s;
        self.offset_s[i] = offset_s;
        self.k[i] = k;
        self.piece[i] = k as f64;
    }
}

impl LimitRow {
    /// Puts the largest rotations so far in a lane.
    pub fn put_rotations(&mut self, i: usize, theta_max: &[Peak; 2]) {
        put(&mut self.theta_max_rad, i, [theta_max[0].value.abs(), theta_max[1].value.abs()]);
    }
}

impl LandedRow {
    #[inline(always)]
    pub fn store_motion<F: Wide>(&mut self, landed: &Landed<F>) {
        self.position = landed.position.map(F::numbers);
        self.velocity = landed.velocity.map(F::numbers);
        self.acceleration = landed.acceleration.map(F::numbers);
    }

    #[inline(always)]
    pub fn store<F: Wide>(&mut self, landed: &Landed<F>) {
        self.store_motion(landed);
        self.quadrature = landed.quadrature.map(F::numbers);
        self.powers_w = landed.powers_w.map(F::numbers);
        self.position_error = landed.position_error.map(F::numbers);
        self.velocity_error = landed.velocity_error.map(F::numbers);
        self.ground = landed.reactions.ground.map(F::numbers);
        self.crack = landed.reactions.crack.map(F::numbers);
        self.top = landed.reactions.top.map(F::numbers);
    }

    /// The end of the step in a lane.
    pub fn end(&self, i: usize) -> Point {
        Point {
            position: both(&self.position, i),
            velocity: both(&self.velocity, i),
            acceleration: both(&self.acceleration, i),
        }
    }

    /// The reactions at the end of the step in a lane.
    pub fn reactions(&self, i: usize) -> Reactions {
        let force = |of: &[Numbers; 3]| JointForce { shear: of[0][i], normal: of[1][i], moment: of[2][i] };
        Reactions {
            forces: JointForces { ground: force(&self.ground), crack: force(&self.crack) },
            top_displacement_m: self.top[0][i],
            top_velocity_m_s: self.top[1][i],
            top_acceleration_m_s2: self.top[2][i],
            holding_n: 0.0,
        }
    }
}

impl Row {
    /// Keeps where the runs are for those who watch them.
    #[inline(never)]
    pub fn remember(&mut self) {
        self.before.clone_from(&self.moving);
        self.before_s = Numbers(std::array::from_fn(|i| self.ground.start_s[i] + self.ground.offset_s[i]));
    }

    /// The motion in a lane over the step before the one that is to follow, and when it began, s.
    pub fn moved(&self, i: usize) -> (f64, Quintic) {
        let motion = Quintic::new(&self.before.at(i).0, &self.moving.at(i).0, self.before.h[i]);
        (self.before_s[i], motion)
    }

    /// Raises the largest rotations in some lanes by what happens inside the last step.
    #[inline(never)]
    pub fn raise_rotations(&mut self, which: u64) {
        for i in (0..LANES).filter(|i| which >> i & 1 == 1) {
            let start_s = self.ground.start_s[i] + self.ground.offset_s[i];
            let motion = Quintic::new(&self.moving.at(i).0, &self.landed.end(i), self.moving.h[i]);
            raise_rotations(&mut self.sums.theta_max[i], start_s, &motion);
            self.limits.put_rotations(i, &self.sums.theta_max[i]);
        }
    }

    /// The last step in a lane.
    pub fn step(&self, i: usize) -> Step {
        Step {
            h: self.moving.h[i],
            start: self.moving.at(i).0,
            end: self.landed.end(i),
            quadrature: both(&self.landed.quadrature, i),
            end_quadrature_rate: both(&self.landed.powers_w, i),
            position_error: both(&self.landed.position_error, i),
            velocity_error: both(&self.landed.velocity_error, i),
        }
    }
}
