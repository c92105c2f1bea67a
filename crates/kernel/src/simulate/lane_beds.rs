//! The steps of several walls on beds at once, in vector lanes: packed, taken together, unpacked.

use fearless_simd::{Level, Simd, f64x4};

use super::lane_steps::{GroundLanes, TwoRotations, apart, as_rate};
use super::run::StepRequest;
use crate::instructions::dispatch_lanes;
use crate::lanes::{LANES, lanes};
use crate::model::{BeddedMotion, JointLanes, LawLanes, RateLanes, ReactionLanes, Reactions, Vector};
use crate::solver::{Field, Nystrom, Point, Rate, Step};

type F<S> = f64x4<S>;

impl<S: Simd> GroundLanes<S> {
    #[inline(always)]
    fn requested(simd: S, requests: &[StepRequest; LANES]) -> Self {
        let lanes = |of: fn(&StepRequest) -> f64| lanes(simd, |i| of(&requests[i]));
        Self {
            from: [lanes(|a| a.piece.from.x), lanes(|a| a.piece.from.y)],
            slope: [lanes(|a| a.piece.slope.x), lanes(|a| a.piece.slope.y)],
            from_s: lanes(|a| a.from_s),
        }
    }
}

/// Walls on beds.
struct BeddedShaken<S: Simd> {
    equations: BeddedMotion<F<S>, JointLanes<S>>,
    laws: LawLanes<S>,
    ground: GroundLanes<S>,
    reactions: Option<ReactionLanes<S>>,
}

impl<S: Simd> BeddedShaken<S> {
    /// `None` unless every wall stands on beds.
    #[inline(always)]
    fn new(simd: S, requests: &[StepRequest; LANES]) -> Option<Self> {
        let m = requests.each_ref().map(|request| request.motion);
        let walls = [m[0].on_beds()?, m[1].on_beds()?, m[2].on_beds()?, m[3].on_beds()?];
        Some(Self {
            equations: BeddedMotion::of_lanes(simd, &walls),
            laws: LawLanes::new(simd, m),
            ground: GroundLanes::requested(simd, requests),
            reactions: None,
        })
    }

    #[inline(always)]
    fn rate_at(&self, after_s: F<S>, theta: [F<S>; 2], omega: [F<S>; 2]) -> RateLanes<S> {
        let [x, y] = self.ground.at(after_s);
        let balance = self.equations.balance(&self.laws, false, [theta, omega], Vector { x, y });
        RateLanes { theta_dd: balance.theta_dd, powers_w: balance.powers_w }
    }
}

impl<S: Simd> Field<TwoRotations<S>> for BeddedShaken<S> {
    #[inline(always)]
    fn rate(
        &mut self,
        after_s: F<S>,
        theta: TwoRotations<S>,
        omega: TwoRotations<S>,
    ) -> Rate<TwoRotations<S>> {
        as_rate(apart(
            after_s.simd,
            #[inline(always)]
            || self.rate_at(after_s, theta.0, omega.0),
        ))
    }

    #[inline(always)]
    fn land(
        &mut self,
        after_s: F<S>,
        theta: TwoRotations<S>,
        omega: TwoRotations<S>,
    ) -> Rate<TwoRotations<S>> {
        let [x, y] = self.ground.at(after_s);
        let balance = self.equations.balance(&self.laws, false, [theta.0, omega.0], Vector { x, y });
        self.reactions = Some(ReactionLanes::of(&self.equations.reactions_by(&balance, balance.theta_dd)));
        as_rate(RateLanes { theta_dd: balance.theta_dd, powers_w: balance.powers_w })
    }
}

/// The steps of walls on beds.
#[inline(always)]
fn bedded_steps<S: Simd>(simd: S, requests: &[StepRequest; LANES]) -> [(Step, Reactions); LANES] {
    let Some(mut shaken) = BeddedShaken::new(simd, requests) else { unreachable!("walls of a kind on beds") };
    let lanes = |of: fn(&StepRequest) -> f64| lanes(simd, |i| of(&requests[i]));
    let start = Rate {
        acceleration: TwoRotations([lanes(|a| a.now.acceleration[0]), lanes(|a| a.now.acceleration[1])]),
        quadrature: TwoRotations([lanes(|a| a.quadrature_rate[0]), lanes(|a| a.quadrature_rate[1])]),
    };
    let x = TwoRotations([lanes(|a| a.now.position[0]), lanes(|a| a.now.position[1])]);
    let v = TwoRotations([lanes(|a| a.now.velocity[0]), lanes(|a| a.now.velocity[1])]);
    let stride = Nystrom::stride(x, v, start, lanes(|a| a.h), &mut shaken);
    let reactions = shaken.reactions.as_ref().map_or([Reactions::default(); LANES], ReactionLanes::unpacked);
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

/// The steps that walls on beds request.
pub(super) fn steps(level: Level, requests: &[StepRequest; LANES]) -> [(Step, Reactions); LANES] {
    dispatch_lanes!(level, simd => bedded_steps(simd, requests))
}
