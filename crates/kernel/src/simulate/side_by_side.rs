//! Runs side by side: those that ask for a step of the same kind take it together, in the lanes of vector registers.
//!
//! What a run gives does not depend on those beside it: every lane does the sums that the run would do alone.

use std::ops::Mul;

use fearless_simd::{Level, Simd, SimdBase, dispatch, f64x4};

use super::history::Observer;
use super::response::Response;
use super::run::{Asked, Run};
use crate::fused::fused_lanes;
use crate::model::{Aftermath, AftermathLanes, LANES, Motions, TurnedLanes, lanes};
use crate::solver::{Field, Nystrom, Point, Rate, Step, Values};

type F<S> = f64x4<S>;

/// One coordinate of every run, or both of them.
#[derive(Clone, Copy)]
struct One<S: Simd>(F<S>);

#[derive(Clone, Copy)]
struct Two<S: Simd>([F<S>; 2]);

impl<S: Simd> Mul<f64> for One<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
}

impl<S: Simd> Values for One<S> {
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

impl<S: Simd> Mul<f64> for Two<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self([self.0[0] * factor, self.0[1] * factor])
    }
}

impl<S: Simd> Values for Two<S> {
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

struct Shaken<S: Simd, const AS_ONE: bool> {
    motions: Motions<S, AS_ONE>,
    from: [F<S>; 2],
    slope: [F<S>; 2],
    from_s: F<S>,
    posture: Option<TurnedLanes<S>>,
    after: Option<AftermathLanes<S>>,
}

impl<S: Simd, const AS_ONE: bool> Shaken<S, AS_ONE> {
    #[inline(always)]
    fn new(simd: S, asked: &[Asked; LANES]) -> Self {
        let lanes = |of: fn(&Asked) -> f64| lanes(simd, |i| of(&asked[i]));
        Self {
            motions: Motions::new(simd, std::array::from_fn(|i| asked[i].law)),
            from: [lanes(|a| a.piece.from.x), lanes(|a| a.piece.from.y)],
            slope: [lanes(|a| a.piece.slope.x), lanes(|a| a.piece.slope.y)],
            from_s: lanes(|a| a.from_s),
            posture: None,
            after: None,
        }
    }

    #[inline(always)]
    fn ground(&self, after_s: F<S>) -> [F<S>; 2] {
        let offset_s = self.from_s + after_s;
        [self.from[0] + self.slope[0] * offset_s, self.from[1] + self.slope[1] * offset_s]
    }

    /// What the landing told of every lane.
    #[inline(always)]
    fn aftermaths(&self) -> [Aftermath; LANES] {
        self.after.as_ref().map_or([Aftermath::default(); LANES], AftermathLanes::unpacked)
    }
}

impl<S: Simd> Field<One<S>> for Shaken<S, true> {
    #[inline(always)]
    fn rate(&mut self, after_s: F<S>, theta: One<S>, omega: One<S>) -> Rate<One<S>> {
        let (theta_dd, power) = self.motions.monolithic_rate(theta.0, omega.0, self.ground(after_s));
        Rate { acceleration: One(theta_dd), quadrature: One(power) }
    }

    #[inline(always)]
    fn land(&mut self, after_s: F<S>, theta: One<S>, omega: One<S>) -> Rate<One<S>> {
        let turned = self.motions.turned([theta.0; 2]);
        let (rate, after) = self.motions.arrival(&turned, [omega.0; 2], self.ground(after_s));
        self.after = Some(after);
        Rate { acceleration: One(rate.theta_dd[0]), quadrature: One(rate.ground_power_w) }
    }
}

/// Both coordinates, and the one quadrature in the place of the first.
impl<S: Simd> Field<Two<S>> for Shaken<S, false> {
    #[inline(always)]
    fn rate(&mut self, after_s: F<S>, theta: Two<S>, omega: Two<S>) -> Rate<Two<S>> {
        let turned = self.motions.turned(theta.0);
        let rate = self.motions.rate(&turned, omega.0, self.ground(after_s));
        self.posture = Some(turned);
        let none = F::splat(after_s.simd, 0.0);
        Rate { acceleration: Two(rate.theta_dd), quadrature: Two([rate.ground_power_w, none]) }
    }

    #[inline(always)]
    fn land(&mut self, after_s: F<S>, theta: Two<S>, omega: Two<S>) -> Rate<Two<S>> {
        let turned = self.posture.unwrap_or_else(|| self.motions.turned(theta.0));
        let (rate, after) = self.motions.arrival(&turned, omega.0, self.ground(after_s));
        self.after = Some(after);
        let none = F::splat(after_s.simd, 0.0);
        Rate { acceleration: Two(rate.theta_dd), quadrature: Two([rate.ground_power_w, none]) }
    }
}

/// The steps of walls that turn as one.
#[inline(always)]
fn steps_as_one<S: Simd>(simd: S, asked: &[Asked; LANES]) -> [(Step, Aftermath); LANES] {
    let mut shaken = Shaken::<S, true>::new(simd, asked);
    let lanes = |of: fn(&Asked) -> f64| One(lanes(simd, |i| of(&asked[i])));
    let start =
        Rate { acceleration: lanes(|a| a.now.acceleration[0]), quadrature: lanes(|a| a.quadrature_rate[0]) };
    let h = lanes(|a| a.h).0;
    let stride =
        Nystrom::stride(lanes(|a| a.now.position[0]), lanes(|a| a.now.velocity[0]), start, h, &mut shaken);
    let after = shaken.aftermaths();
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
            h: asked[i].h,
            start: *asked[i].now,
            end: Point { position: [x[i]; 2], velocity: [v[i]; 2], acceleration: [a[i]; 2] },
            quadrature: [gained[i], 0.0],
            end_quadrature_rate: [rate[i], 0.0],
            position_error: [e_x[i]; 2],
            velocity_error: [e_v[i]; 2],
        };
        (step, after[i])
    })
}

/// The steps of walls whose bodies turn apart.
#[inline(always)]
fn steps_apart<S: Simd>(simd: S, asked: &[Asked; LANES]) -> [(Step, Aftermath); LANES] {
    let mut shaken = Shaken::<S, false>::new(simd, asked);
    let lanes = |of: fn(&Asked) -> f64| lanes(simd, |i| of(&asked[i]));
    let start = Rate {
        acceleration: Two([lanes(|a| a.now.acceleration[0]), lanes(|a| a.now.acceleration[1])]),
        quadrature: Two([lanes(|a| a.quadrature_rate[0]), lanes(|_| 0.0)]),
    };
    let x = Two([lanes(|a| a.now.position[0]), lanes(|a| a.now.position[1])]);
    let v = Two([lanes(|a| a.now.velocity[0]), lanes(|a| a.now.velocity[1])]);
    let stride = Nystrom::stride(x, v, start, lanes(|a| a.h), &mut shaken);
    let after = shaken.aftermaths();
    let [x, v, a, e_x, e_v] = [
        stride.position,
        stride.velocity,
        stride.end.acceleration,
        stride.position_error,
        stride.velocity_error,
    ]
    .map(|of| of.0.map(<[f64; LANES]>::from));
    let [rate, gained] = [stride.end.quadrature, stride.quadrature].map(|of| <[f64; LANES]>::from(of.0[0]));
    std::array::from_fn(|i| {
        let both = |of: &[[f64; LANES]; 2]| [of[0][i], of[1][i]];
        let step = Step {
            h: asked[i].h,
            start: *asked[i].now,
            end: Point { position: both(&x), velocity: both(&v), acceleration: both(&a) },
            quadrature: [gained[i], 0.0],
            end_quadrature_rate: [rate[i], 0.0],
            position_error: both(&e_x),
            velocity_error: both(&e_v),
        };
        (step, after[i])
    })
}

/// Runs that are at work at once: enough that there mostly are as many of a kind as there are lanes.
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
    pub(super) fn alone(self) -> Response {
        self.begun().go()
    }
}

/// Runs what `next` gives side by side until it gives no more, and tells `done` each response, as they end.
///
/// A response is that of [`super::simulate`] to the bit, whatever runs beside it.
pub fn simulate_side_by_side<T, O: Observer>(
    next: impl FnMut() -> Option<(T, Prepared<O>)>,
    done: impl FnMut(T, Response),
) {
    simulate_side_by_side_at(Level::new(), next, done);
}

/// The same by given vector instructions, which change nothing but the time it takes.
pub fn simulate_side_by_side_at<T, O: Observer>(
    level: Level,
    next: impl FnMut() -> Option<(T, Prepared<O>)>,
    done: impl FnMut(T, Response),
) {
    let mut work = Work {
        next,
        done,
        slots: Vec::with_capacity(AT_ONCE),
        as_one: Vec::with_capacity(AT_ONCE),
        apart: Vec::with_capacity(AT_ONCE),
        level,
    };
    while work.slots.len() < AT_ONCE {
        let Some(run) = work.begin_next() else { break };
        work.slots.push(Some(run));
        work.go_on(work.slots.len() - 1);
    }
    while work.step() {}
}

struct Work<T, O, N, D> {
    next: N,
    done: D,
    slots: Vec<Option<(T, Run<O>)>>,
    /// Slots that ask for a step of a wall that turns as one, and of one whose bodies turn apart.
    as_one: Vec<usize>,
    apart: Vec<usize>,
    /// Vector instructions that this processor has.
    level: Level,
}

impl<T, O: Observer, N: FnMut() -> Option<(T, Prepared<O>)>, D: FnMut(T, Response)> Work<T, O, N, D> {
    #[inline(never)]
    fn begin_next(&mut self) -> Option<(T, Run<O>)> {
        let (tag, prepared) = (self.next)()?;
        Some((tag, prepared.begun()))
    }

    /// Brings the run in a slot, or the next one in its place, to where it asks for a step that others may share.
    fn go_on(&mut self, slot: usize) {
        while let Some((_, run)) = &mut self.slots[slot] {
            if !run.wants_step() {
                self.replace(slot);
                continue;
            }
            match run.asked().law.side_by_side() {
                Some(true) => return self.as_one.push(slot),
                Some(false) => return self.apart.push(slot),
                None => {
                    let mut after = Aftermath::default();
                    let step = run.asked().take(&mut after);
                    run.answer(&step, &after);
                }
            }
        }
    }

    /// Ends the run in a slot and begins the next one there.
    #[inline(never)]
    fn replace(&mut self, slot: usize) {
        if let Some((tag, run)) = self.slots[slot].take() {
            (self.done)(tag, run.end());
        }
        self.slots[slot] = self.begin_next();
    }

    /// Takes the steps of the kind that most slots ask for; false when none asks.
    fn step(&mut self) -> bool {
        let one = self.as_one.len() >= self.apart.len();
        let queue = if one { &mut self.as_one } else { &mut self.apart };
        let from = queue.len().saturating_sub(LANES);
        let Some(&last) = queue.last() else { return false };
        // A lane without a run does the work of another once more.
        let mut of = [last; LANES];
        let count = queue.len() - from;
        of[..count].copy_from_slice(&queue[from..]);
        queue.truncate(from);
        let taken = {
            let asked = of.map(|slot| {
                let Some((_, run)) = &self.slots[slot] else { unreachable!("a slot that asks has a run") };
                run.asked()
            });
            if one {
                dispatch!(self.level, simd => steps_as_one(simd, &asked))
            } else {
                dispatch!(self.level, simd => steps_apart(simd, &asked))
            }
        };
        for (slot, (step, after)) in of.into_iter().zip(&taken).take(count) {
            if let Some((_, run)) = &mut self.slots[slot] {
                run.answer(step, after);
            }
            self.go_on(slot);
        }
        true
    }
}
