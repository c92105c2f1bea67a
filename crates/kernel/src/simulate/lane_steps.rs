//! The steps of a row of runs on sharp edges, in vector lanes.

use fearless_simd::{Level, Simd};

use super::lane_beds::OnBeds;
use super::lane_values::{OneRotation, TwoRotations};
use super::row::{GroundRow, MovingRow, Row};
use crate::instructions::dispatch_lanes;
use crate::lanes::{Numbers, Wide};
use crate::model::{
    BeddedMotions, Freedom, LaneKind, MotionRow, Motions, RateLanes, ReactionLanes, sin_cos_lanes,
};
use crate::solver::{Field, Nystrom, Rate, Stride};

/// Calls what every stage of a step does as a function of its own, compiled for the same instructions. Rare laws
/// are longer than ones that are everywhere: six times over they would fill the cache of instructions, and the
/// compiler's time.
#[inline(always)]
pub(super) fn apart<F: Wide, R>(simd: F::Token, stage: impl FnOnce() -> R) -> R {
    simd.vectorize(stage)
}

/// What a step gave every lane.
pub(super) struct Landed<F: Wide> {
    pub position: [F; 2],
    pub velocity: [F; 2],
    pub acceleration: [F; 2],
    /// What the quadratures gained, and their rates at the end, W.
    pub quadrature: [F; 2],
    pub powers_w: [F; 2],
    pub position_error: [F; 2],
    pub velocity_error: [F; 2],
    pub reactions: ReactionLanes<F>,
}

/// The ground acceleration under every run.
pub(super) struct GroundLanes<F: Wide> {
    pub from: [F; 2],
    pub slope: [F; 2],
    pub from_s: F,
}

impl<F: Wide> GroundLanes<F> {
    #[inline(always)]
    pub fn of_row(simd: F::Token, row: &GroundRow) -> Self {
        Self {
            from: [F::of_row(simd, &row.from[0]), F::of_row(simd, &row.from[1])],
            slope: [F::of_row(simd, &row.slope[0]), F::of_row(simd, &row.slope[1])],
            from_s: F::of_row(simd, &row.offset_s),
        }
    }

    #[inline(always)]
    pub fn at(&self, after_s: F) -> [F; 2] {
        let offset_s = self.from_s + after_s;
        [self.from[0] + self.slope[0] * offset_s, self.from[1] + self.slope[1] * offset_s]
    }
}

/// Walls on sharp edges under the ground's motion, and the reactions once they have landed.
///
/// What a stage leaves for the landing is no `Option`: those are copied through memory, and a copy of what was just written,
/// wider than it was written, waits for the writing.
struct ShakenMotion<'a, F: Wide, const AS_ONE: bool, const FURTHER: bool> {
    motions: &'a Motions<F, AS_ONE, FURTHER>,
    ground: GroundLanes<F>,
    /// Sines and cosines of both rotations at the last stage, whose positions are those of the end.
    turns: [(F, F); 2],
    reactions: ReactionLanes<F>,
}

impl<'a, F: Wide, const AS_ONE: bool, const FURTHER: bool> ShakenMotion<'a, F, AS_ONE, FURTHER> {
    #[inline(always)]
    fn new(motions: &'a Motions<F, AS_ONE, FURTHER>, ground: GroundLanes<F>) -> Self {
        let none = F::splat(ground.from_s.token(), 0.0);
        let reactions = ReactionLanes { ground: [none; 3], crack: [none; 3], top: [none; 3] };
        Self { motions, ground, turns: [(none, none); 2], reactions }
    }

    #[inline(always)]
    fn land_at(&mut self, after_s: F, omega: [F; 2]) -> RateLanes<F> {
        let turned = self.motions.turned(self.turns);
        let (rate, reactions) = self.motions.rate_and_reactions(&turned, omega, self.ground.at(after_s));
        self.reactions = reactions;
        rate
    }
}

/// The one rotation and the power of the ground, where nothing is lost.
impl<F: Wide, const AS_ONE: bool, const FURTHER: bool> Field<OneRotation<F>>
    for ShakenMotion<'_, F, AS_ONE, FURTHER>
{
    #[inline(always)]
    fn rate(&mut self, after_s: F, theta: OneRotation<F>, omega: OneRotation<F>) -> Rate<OneRotation<F>> {
        let turn = sin_cos_lanes(theta.0);
        self.turns = [turn; 2];
        let ground = self.ground.at(after_s);
        let (theta_dd, [power, _]) = self.motions.monolithic_rate(theta.0, turn, omega.0, ground);
        Rate { acceleration: OneRotation(theta_dd), quadrature: OneRotation(power) }
    }

    #[inline(always)]
    fn land(&mut self, after_s: F, _: OneRotation<F>, omega: OneRotation<F>) -> Rate<OneRotation<F>> {
        let rate = self.land_at(after_s, [omega.0; 2]);
        Rate { acceleration: OneRotation(rate.theta_dd[0]), quadrature: OneRotation(rate.powers_w[0]) }
    }
}

impl<F: Wide, const AS_ONE: bool, const FURTHER: bool> ShakenMotion<'_, F, AS_ONE, FURTHER> {
    #[inline(always)]
    fn rate_at(&mut self, after_s: F, theta: [F; 2], omega: [F; 2]) -> RateLanes<F> {
        let ground = self.ground.at(after_s);
        if AS_ONE {
            let turn = sin_cos_lanes(theta[0]);
            self.turns = [turn; 2];
            let (theta_dd, powers_w) = self.motions.monolithic_rate(theta[0], turn, omega[0], ground);
            return RateLanes { theta_dd: [theta_dd; 2], powers_w };
        }
        self.turns = [sin_cos_lanes(theta[0]), sin_cos_lanes(theta[1])];
        self.motions.rate(&self.motions.turned(self.turns), omega, ground)
    }
}

/// Both rotations, equal where walls turn as one, and both powers.
impl<F: Wide, const AS_ONE: bool, const FURTHER: bool> Field<TwoRotations<F>>
    for ShakenMotion<'_, F, AS_ONE, FURTHER>
{
    #[inline(always)]
    fn rate(&mut self, after_s: F, theta: TwoRotations<F>, omega: TwoRotations<F>) -> Rate<TwoRotations<F>> {
        if FURTHER {
            return as_rate(apart::<F, _>(
                after_s.token(),
                #[inline(always)]
                || self.rate_at(after_s, theta.0, omega.0),
            ));
        }
        as_rate(self.rate_at(after_s, theta.0, omega.0))
    }

    #[inline(always)]
    fn land(&mut self, after_s: F, _: TwoRotations<F>, omega: TwoRotations<F>) -> Rate<TwoRotations<F>> {
        as_rate(self.land_at(after_s, omega.0))
    }
}

#[inline(always)]
pub(super) fn as_rate<F: Wide>(rate: RateLanes<F>) -> Rate<TwoRotations<F>> {
    Rate { acceleration: TwoRotations(rate.theta_dd), quadrature: TwoRotations(rate.powers_w) }
}

/// A step of walls that turn as one and lose nothing between impacts.
#[inline(always)]
fn monolithic_step<F: Wide, const AS_ONE: bool, const FURTHER: bool>(
    simd: F::Token,
    motions: &Motions<F, AS_ONE, FURTHER>,
    row: &Row,
) -> Landed<F> {
    let mut shaken = ShakenMotion::new(motions, GroundLanes::of_row(simd, &row.ground));
    let of = |numbers: &[Numbers; 2]| OneRotation(F::of_row(simd, &numbers[0]));
    let moving = &row.moving;
    let start = Rate { acceleration: of(&moving.acceleration), quadrature: of(&moving.powers_w) };
    let h = F::of_row(simd, &moving.h);
    let stride = Nystrom::stride(of(&moving.position), of(&moving.velocity), start, h, &mut shaken);
    let none = F::splat(simd, 0.0);
    Landed {
        position: [stride.position.0; 2],
        velocity: [stride.velocity.0; 2],
        acceleration: [stride.end.acceleration.0; 2],
        quadrature: [stride.quadrature.0, none],
        powers_w: [stride.end.quadrature.0, none],
        position_error: [stride.position_error.0; 2],
        velocity_error: [stride.velocity_error.0; 2],
        reactions: shaken.reactions,
    }
}

impl MovingRow {
    /// The step of both rotations of every run.
    #[inline(always)]
    pub fn stride<F: Wide>(
        &self,
        simd: F::Token,
        shaken: &mut impl Field<TwoRotations<F>>,
    ) -> Stride<TwoRotations<F>> {
        let of = |numbers: &[Numbers; 2]| {
            TwoRotations([F::of_row(simd, &numbers[0]), F::of_row(simd, &numbers[1])])
        };
        let start = Rate { acceleration: of(&self.acceleration), quadrature: of(&self.powers_w) };
        Nystrom::stride(of(&self.position), of(&self.velocity), start, F::of_row(simd, &self.h), shaken)
    }
}

/// What a step of both rotations gave.
#[inline(always)]
pub(super) fn landed_by<F: Wide>(stride: Stride<TwoRotations<F>>, reactions: ReactionLanes<F>) -> Landed<F> {
    Landed {
        position: stride.position.0,
        velocity: stride.velocity.0,
        acceleration: stride.end.acceleration.0,
        quadrature: stride.quadrature.0,
        powers_w: stride.end.quadrature.0,
        position_error: stride.position_error.0,
        velocity_error: stride.velocity_error.0,
        reactions,
    }
}

/// A step of walls on sharp edges by both rotations.
#[inline(always)]
fn two_body_step<F: Wide, const AS_ONE: bool, const FURTHER: bool>(
    simd: F::Token,
    motions: &Motions<F, AS_ONE, FURTHER>,
    row: &Row,
) -> Landed<F> {
    let mut shaken = ShakenMotion::new(motions, GroundLanes::of_row(simd, &row.ground));
    let stride = row.moving.stride(simd, &mut shaken);
    landed_by(stride, shaken.reactions)
}

/// The motions of a row, as they take their step.
pub(super) trait Stepping<F: Wide> {
    /// Whether both bodies turn by one rotation, and whether joints are on beds.
    const AS_ONE: bool;
    const ON_BEDS: bool;

    fn step(&self, simd: F::Token, row: &Row) -> Landed<F>;

    /// Displacement of the top at rotations, m.
    fn top_displacement_m(&self, theta: [F; 2]) -> F;

    /// Goes through what happened in the steps of lanes that are left, where the row can: the bits of these lanes.
    fn meet(&mut self, _: F::Token, _: &mut Row, _: &Landed<F>, _: u64) -> u64 {
        0
    }

    /// Puts back what was taken out of the row.
    fn put_back(self, row: &mut MotionRow);
}

/// A wall on sharp edges, which steps by one rotation where it can.
impl<F: Wide, const AS_ONE: bool, const FURTHER: bool> Stepping<F> for Motions<F, AS_ONE, FURTHER> {
    const AS_ONE: bool = AS_ONE;
    const ON_BEDS: bool = false;

    #[inline(always)]
    fn step(&self, simd: F::Token, row: &Row) -> Landed<F> {
        if AS_ONE && !FURTHER {
            return monolithic_step(simd, self, row);
        }
        two_body_step(simd, self, row)
    }

    #[inline(always)]
    fn top_displacement_m(&self, theta: [F; 2]) -> F {
        Motions::top_displacement_m(self, &self.configuration(theta))
    }

    #[inline(always)]
    fn meet(&mut self, simd: F::Token, row: &mut Row, landed: &Landed<F>, left: u64) -> u64 {
        let motions: &Self = self;
        let met = apart::<F, _>(
            simd,
            #[inline(always)]
            || row.meet_impacts(simd, motions, landed, left),
        );
        self.follow(simd, &row.motions);
        met
    }

    #[inline(always)]
    fn put_back(self, row: &mut MotionRow) {
        Motions::put_back(self, row);
    }
}

/// Steps of a row until something happens to one of the runs in it: gives its lane, and those of others to which
/// something does at once.
#[inline(always)]
fn steps_until<F: Wide>(simd: F::Token, mut motions: impl Stepping<F>, alone: bool, row: &mut Row) -> u64 {
    loop {
        let landed = motions.step(simd, row);
        let mut left = row.settle(&motions, alone, &landed);
        if left != 0 {
            left &= !row.reject(simd, &landed, left);
        }
        if left != 0 {
            left &= !motions.meet(simd, row, &landed, left);
        }
        if left != 0 || row.shown != 0 {
            row.landed.store(&landed);
            motions.put_back(&mut row.motions);
            return left;
        }
    }
}

#[inline(always)]
fn edges_until<F: Wide, const AS_ONE: bool, const FURTHER: bool>(
    simd: F::Token,
    alone: bool,
    row: &mut Row,
) -> u64 {
    let motions = Motions::<F, AS_ONE, FURTHER>::new(simd, &mut row.motions);
    steps_until(simd, motions, alone, row)
}

#[inline(always)]
fn beds_until<F: Wide, const AS_ONE: bool>(simd: F::Token, freedom: Freedom, row: &mut Row) -> u64 {
    let motions = OnBeds::<F, AS_ONE>(BeddedMotions::new(simd, &mut row.motions, freedom));
    steps_until(simd, motions, false, row)
}

fn width<F: Wide>(_: F::Token) -> usize {
    F::LEN
}

/// How many walls [`advance`] steps side by side.
pub(super) fn widest(level: Level) -> usize {
    dispatch_lanes!(level, Lanes of f64x8, simd => width::<Lanes<_>>(simd))
}

/// The steps of walls of one kind until something happens to some of them: the bits of their lanes.
pub(super) fn advance(level: Level, kind: LaneKind, row: &mut Row) -> u64 {
    match kind {
        LaneKind::AsOne { further: false } => {
            dispatch_lanes!(level, Lanes of f64x8, simd => edges_until::<Lanes<_>, true, false>(simd, false, row))
        }
        LaneKind::Apart { further: false } => {
            dispatch_lanes!(level, Lanes of f64x8, simd => edges_until::<Lanes<_>, false, false>(simd, false, row))
        }
        LaneKind::AsOne { further: true } => {
            dispatch_lanes!(level, Lanes of f64x8, simd => edges_until::<Lanes<_>, true, true>(simd, false, row))
        }
        LaneKind::Apart { further: true } => {
            dispatch_lanes!(level, Lanes of f64x8, simd => edges_until::<Lanes<_>, false, true>(simd, false, row))
        }
        LaneKind::Bedded(Freedom::Monolithic) => {
            dispatch_lanes!(level, Lanes of f64x8, simd => beds_until::<Lanes<_>, true>(simd, Freedom::Monolithic, row))
        }
        LaneKind::Bedded(freedom) => {
            dispatch_lanes!(level, Lanes of f64x8, simd => beds_until::<Lanes<_>, false>(simd, freedom, row))
        }
    }
}

/// The same of one run in a row of its own, on sharp edges and without further laws.
pub(super) fn advance_alone(level: Level, as_one: bool, row: &mut Row) {
    if as_one {
        dispatch_lanes!(level, Lanes of f64x4, simd => edges_until::<Lanes<_>, true, false>(simd, true, row));
    } else {
        dispatch_lanes!(level, Lanes of f64x4, simd => edges_until::<Lanes<_>, false, false>(simd, true, row));
    }
}
