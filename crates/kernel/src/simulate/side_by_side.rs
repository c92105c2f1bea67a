//! Runs side by side: those that request a step of the same kind take it together, in vector lanes.
//!
//! The response of a run does not depend on those beside it. Every lane does the sums that the run would do
//! alone.

use std::ops::Mul;

use fearless_simd::{Level, Simd, SimdBase, dispatch, f64x4};

use super::history::Observer;
use super::response::Response;
use super::run::{Run, StepRequest};
use crate::fused::fused_lanes;
use crate::model::{
    ConfigurationLanes, LANES, LaneKind, Motions, RateLanes, ReactionLanes, Reactions, lanes,
};
use crate::solver::{Field, Nystrom, Point, Rate, Step, Values};

type F<S> = f64x4<S>;

/// One coordinate of every run, or both of them.
#[derive(Clone, Copy)]
struct OneRotation<S: Simd>(F<S>);

#[derive(Clone, Copy)]
struct TwoRotations<S: Simd>([F<S>; 2]);

impl<S: Simd> Mul<f64> for OneRotation<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
}

impl<S: Simd> Values for OneRotation<S> {
    type Length = F<S>;
    #[inline(always)]
    fn over(self, length: F<S>) -> Self {
        Self(self.0 * length)
    }

    #[inline(always)]
    fn over_plus(self, length: F<S>, other: Self) -> Self {
        Self(fused_lanes(self.0, length, other.0))
    }

    #[inline(always)]
    fn times_plus(self, factor: f64, other: Self) -> Self {
        Self(fused_lanes(self.0, F::splat(self.0.simd, factor), other.0))
    }
}

impl<S: Simd> Mul<f64> for TwoRotations<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self([self.0[0] * factor, self.0[1] * factor])
    }
}

impl<S: Simd> Values for TwoRotations<S> {
    type Length = F<S>;
    #[inline(always)]
    fn over(self, length: F<S>) -> Self {
        Self([self.0[0] * length, self.0[1] * length])
    }

    #[inline(always)]
    fn over_plus(self, length: F<S>, other: Self) -> Self {
        Self([fused_lanes(self.0[0], length, other.0[0]), fused_lanes(self.0[1], length, other.0[1])])
    }

    #[inline(always)]
    fn times_plus(self, factor: f64, other: Self) -> Self {
        self.over_plus(F::splat(self.0[0].simd, factor), other)
    }
}

struct ShakenMotion<S: Simd, const AS_ONE: bool, const FURTHER: bool> {
    motions: Motions<S, AS_ONE, FURTHER>,
    from: [F<S>; 2],
    slope: [F<S>; 2],
    from_s: F<S>,
    configuration: Option<ConfigurationLanes<S>>,
    reactions: Option<ReactionLanes<S>>,
}

impl<S: Simd, const AS_ONE: bool, const FURTHER: bool> ShakenMotion<S, AS_ONE, FURTHER> {
    #[inline(always)]
    fn new(simd: S, requests: &[StepRequest; LANES]) -> Self {
        let lanes = |of: fn(&StepRequest) -> f64| lanes(simd, |i| of(&requests[i]));
        Self {
            motions: Motions::new(simd, std::array::from_fn(|i| requests[i].motion)),
            from: [lanes(|a| a.piece.from.x), lanes(|a| a.piece.from.y)],
            slope: [lanes(|a| a.piece.slope.x), lanes(|a| a.piece.slope.y)],
            from_s: lanes(|a| a.from_s),
            configuration: None,
            reactions: None,
        }
    }

    #[inline(always)]
    fn ground(&self, after_s: F<S>) -> [F<S>; 2] {
        let offset_s = self.from_s + after_s;
        [self.from[0] + self.slope[0] * offset_s, self.from[1] + self.slope[1] * offset_s]
    }

    /// The reactions of every lane at the end of the step.
    #[inline(always)]
    fn reactions(&self) -> [Reactions; LANES] {
        self.reactions.as_ref().map_or([Reactions::default(); LANES], ReactionLanes::unpacked)
    }
}

/// The one rotation and the power of the ground, where nothing is lost.
impl<S: Simd> Field<OneRotation<S>> for ShakenMotion<S, true, false> {
    #[inline(always)]
    fn rate(&mut self, after_s: F<S>, theta: OneRotation<S>, omega: OneRotation<S>) -> Rate<OneRotation<S>> {
        let (theta_dd, [power, _]) = self.motions.monolithic_rate(theta.0, omega.0, self.ground(after_s));
        Rate { acceleration: OneRotation(theta_dd), quadrature: OneRotation(power) }
    }

    #[inline(always)]
    fn land(&mut self, after_s: F<S>, theta: OneRotation<S>, omega: OneRotation<S>) -> Rate<OneRotation<S>> {
        let turned = self.motions.configuration([theta.0; 2]);
        let (rate, reactions) = self.motions.rate_and_reactions(&turned, [omega.0; 2], self.ground(after_s));
        self.reactions = Some(reactions);
        Rate { acceleration: OneRotation(rate.theta_dd[0]), quadrature: OneRotation(rate.powers_w[0]) }
    }
}

/// Both rotations, equal where walls turn as one, and both powers.
impl<S: Simd, const AS_ONE: bool, const FURTHER: bool> Field<TwoRotations<S>>
    for ShakenMotion<S, AS_ONE, FURTHER>
{
    #[inline(always)]
    fn rate(
        &mut self,
        after_s: F<S>,
        theta: TwoRotations<S>,
        omega: TwoRotations<S>,
    ) -> Rate<TwoRotations<S>> {
        let ground = self.ground(after_s);
        if AS_ONE {
            let (theta_dd, powers_w) = self.motions.monolithic_rate(theta.0[0], omega.0[0], ground);
            return as_rate(RateLanes { theta_dd: [theta_dd; 2], powers_w });
        }
        let turned = self.motions.configuration(theta.0);
        let rate = self.motions.rate(&turned, omega.0, ground);
        self.configuration = Some(turned);
        as_rate(rate)
    }

    #[inline(always)]
    fn land(
        &mut self,
        after_s: F<S>,
        theta: TwoRotations<S>,
        omega: TwoRotations<S>,
    ) -> Rate<TwoRotations<S>> {
        let turned = self.configuration.unwrap_or_else(|| self.motions.configuration(theta.0));
        let (rate, reactions) = self.motions.rate_and_reactions(&turned, omega.0, self.ground(after_s));
        self.reactions = Some(reactions);
        as_rate(rate)
    }
}

#[inline(always)]
fn as_rate<S: Simd>(rate: RateLanes<S>) -> Rate<TwoRotations<S>> {
    Rate { acceleration: TwoRotations(rate.theta_dd), quadrature: TwoRotations(rate.powers_w) }
}

/// The steps of walls that turn as one and lose nothing between impacts.
#[inline(always)]
fn monolithic_steps<S: Simd>(simd: S, requests: &[StepRequest; LANES]) -> [(Step, Reactions); LANES] {
    let mut shaken = ShakenMotion::<S, true, false>::new(simd, requests);
    let lanes = |of: fn(&StepRequest) -> f64| OneRotation(lanes(simd, |i| of(&requests[i])));
    let start =
        Rate { acceleration: lanes(|a| a.now.acceleration[0]), quadrature: lanes(|a| a.quadrature_rate[0]) };
    let h = lanes(|a| a.h).0;
    let stride =
        Nystrom::stride(lanes(|a| a.now.position[0]), lanes(|a| a.now.velocity[0]), start, h, &mut shaken);
    let reactions = shaken.reactions();
    let [x, v, a, rate, gained, e_x, e_v] = [
        stride.position,
        stride.velocity,
        stride.end.acceleration,
        stride.end.quadrature,
        stride.quadrature,
        stride.position_error,
        stride.velocity_error,
    ]
    .map(|of| <[f64; LANES]>::from(of.0));
    std::array::from_fn(|i| {
        let step = Step {
            h: requests[i].h,
            start: *requests[i].now,
            end: Point { position: [x[i]; 2], velocity: [v[i]; 2], acceleration: [a[i]; 2] },
            quadrature: [gained[i], 0.0],
            end_quadrature_rate: [rate[i], 0.0],
            position_error: [e_x[i]; 2],
            velocity_error: [e_v[i]; 2],
        };
        (step, reactions[i])
    })
}

/// The steps of walls by both rotations.
#[inline(always)]
fn two_body_steps<S: Simd, const AS_ONE: bool, const FURTHER: bool>(
    simd: S,
    requests: &[StepRequest; LANES],
) -> [(Step, Reactions); LANES] {
    let mut shaken = ShakenMotion::<S, AS_ONE, FURTHER>::new(simd, requests);
    let lanes = |of: fn(&StepRequest) -> f64| lanes(simd, |i| of(&requests[i]));
    let start = Rate {
        acceleration: TwoRotations([lanes(|a| a.now.acceleration[0]), lanes(|a| a.now.acceleration[1])]),
        quadrature: TwoRotations([lanes(|a| a.quadrature_rate[0]), lanes(|a| a.quadrature_rate[1])]),
    };
    let x = TwoRotations([lanes(|a| a.now.position[0]), lanes(|a| a.now.position[1])]);
    let v = TwoRotations([lanes(|a| a.now.velocity[0]), lanes(|a| a.now.velocity[1])]);
    let stride = Nystrom::stride(x, v, start, lanes(|a| a.h), &mut shaken);
    let reactions = shaken.reactions();
    let [x, v, a, rate, gained, e_x, e_v] = [
        stride.position,
        stride.velocity,
        stride.end.acceleration,
        stride.end.quadrature,
        stride.quadrature,
        stride.position_error,
        stride.velocity_error,
    ]
    .map(|of| of.0.map(<[f64; LANES]>::from));
    std::array::from_fn(|i| {
        let both = |of: &[[f64; LANES]; 2]| [of[0][i], of[1][i]];
        let step = Step {
            h: requests[i].h,
            start: *requests[i].now,
            end: Point { position: both(&x), velocity: both(&v), acceleration: both(&a) },
            quadrature: both(&gained),
            end_quadrature_rate: both(&rate),
            position_error: both(&e_x),
            velocity_error: both(&e_v),
        };
        (step, reactions[i])
    })
}

/// The steps of walls of one kind.
fn steps(level: Level, kind: LaneKind, requests: &[StepRequest; LANES]) -> [(Step, Reactions); LANES] {
    match kind {
        LaneKind { as_one: true, further: false } => {
            dispatch!(level, simd => monolithic_steps(simd, requests))
        }
        LaneKind { as_one: false, further: false } => {
            dispatch!(level, simd => two_body_steps::<_, false, false>(simd, requests))
        }
        LaneKind { as_one: true, further: true } => {
            dispatch!(level, simd => two_body_steps::<_, true, true>(simd, requests))
        }
        LaneKind { as_one: false, further: true } => {
            dispatch!(level, simd => two_body_steps::<_, false, true>(simd, requests))
        }
    }
}

/// Runs in the pool at once: enough that mostly there are as many of a kind as lanes.
const AT_ONCE: usize = 6 * LANES;

/// A wall under a shaking, ready to run beside others from a time in seconds on.
pub struct Prepared<O = ()> {
    run: Run<O>,
    start_s: f64,
    /// Why it cannot start.
    refused: Option<String>,
}

impl<O: Observer> Prepared<O> {
    pub(super) fn new(run: Run<O>, start_s: f64, refused: Option<String>) -> Self {
        Self { run, start_s, refused }
    }

    fn begun(mut self) -> Run<O> {
        match self.refused {
            None => self.run.begin(self.start_s),
            Some(reason) => self.run.refuse(self.start_s, reason),
        }
        self.run
    }

    /// Runs it alone.
    pub(super) fn run_alone(self) -> Response {
        self.begun().into_response()
    }
}

/// Runs what `next` gives side by side until it gives no more. `done` gets each response with its number, as runs end.
///
/// A response is that of [`super::simulate`] to the bit, whatever runs beside it.
pub fn simulate_side_by_side(
    next: &mut dyn FnMut() -> Option<(usize, Prepared)>,
    done: &mut dyn FnMut(usize, Response),
) {
    simulate_side_by_side_at(Level::new(), next, done);
}

/// The same by given vector instructions, which change nothing but the time it takes.
pub fn simulate_side_by_side_at(
    level: Level,
    next: &mut dyn FnMut() -> Option<(usize, Prepared)>,
    done: &mut dyn FnMut(usize, Response),
) {
    Pool::new(level, next, done).all();
}

/// The same of runs that are watched.
pub fn simulate_watched_side_by_side<'o>(
    next: &mut dyn FnMut() -> Option<(usize, Prepared<&'o mut dyn Observer>)>,
    done: &mut dyn FnMut(usize, Response),
) {
    Pool::new(Level::new(), next, done).all();
}

/// Runs at work. Its loop is compiled here, in one unit with the motion, for watched runs and for others.
struct Pool<'w, O> {
    next: &'w mut dyn FnMut() -> Option<(usize, Prepared<O>)>,
    done: &'w mut dyn FnMut(usize, Response),
    slots: Vec<Option<(usize, Run<O>)>>,
    /// Slots that request a step, by its kind.
    queues: [Vec<usize>; LaneKind::COUNT],
    /// Vector instructions that this processor has.
    level: Level,
}

impl<'w, O: Observer> Pool<'w, O> {
    fn new(
        level: Level,
        next: &'w mut dyn FnMut() -> Option<(usize, Prepared<O>)>,
        done: &'w mut dyn FnMut(usize, Response),
    ) -> Self {
        let queues = [(); LaneKind::COUNT].map(|()| Vec::with_capacity(AT_ONCE));
        Self { next, done, slots: Vec::with_capacity(AT_ONCE), queues, level }
    }

    fn all(&mut self) {
        while self.slots.len() < AT_ONCE {
            let Some(run) = self.begin_next() else { break };
            self.slots.push(Some(run));
            self.queue_step(self.slots.len() - 1);
        }
        while self.step() {}
    }

    #[inline(never)]
    fn begin_next(&mut self) -> Option<(usize, Run<O>)> {
        let (number, prepared) = (self.next)()?;
        Some((number, prepared.begun()))
    }

    /// Brings the run in a slot, or the next one there, to a request that others may share.
    fn queue_step(&mut self, slot: usize) {
        while let Some((_, run)) = &mut self.slots[slot] {
            if !run.needs_step() {
                self.replace(slot);
                continue;
            }
            match run.step_request().motion.side_by_side() {
                Some(kind) => return self.queues[kind.index()].push(slot),
                None => {
                    let mut reactions = Reactions::default();
                    let step = run.step_request().take(&mut reactions);
                    run.finish_step(&step, &reactions);
                }
            }
        }
    }

    /// Ends the run in a slot and begins the next one there.
    #[inline(never)]
    fn replace(&mut self, slot: usize) {
        if let Some((number, run)) = self.slots[slot].take() {
            (self.done)(number, run.end());
        }
        self.slots[slot] = self.begin_next();
    }

    /// Takes the steps of the kind that most slots request; false when there is no request.
    fn step(&mut self) -> bool {
        let lengths = self.queues.each_ref().map(Vec::len);
        let most = (1..LaneKind::COUNT).fold(0, |most, i| if lengths[i] > lengths[most] { i } else { most });
        let queue = &mut self.queues[most];
        let from = queue.len().saturating_sub(LANES);
        let Some(&last) = queue.last() else { return false };
        // A lane without a run does the work of another once more.
        let mut of = [last; LANES];
        let count = queue.len() - from;
        of[..count].copy_from_slice(&queue[from..]);
        queue.truncate(from);
        let requests = of.map(|slot| {
            let Some((_, run)) = &self.slots[slot] else { unreachable!("a slot that asks has a run") };
            run.step_request()
        });
        let taken = steps(self.level, LaneKind::at(most), &requests);
        for (slot, (step, reactions)) in of.into_iter().zip(&taken).take(count) {
            if let Some((_, run)) = &mut self.slots[slot] {
                run.finish_step(step, reactions);
            }
            self.queue_step(slot);
        }
        true
    }
}
