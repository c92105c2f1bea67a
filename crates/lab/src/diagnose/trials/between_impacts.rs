//! What hypotheses leave of windows up to the first change of contact.
//!
//! Formulations of a stiff contact part where it changes: an impact on corners that give takes its time, one on sharp edges
//! none. Between changes they are alike. So a law is asked there whether it follows the tests, where impacts of another
//! formulation are missed.

use super::{Data, FittedHypothesis};
use crate::diagnose::fit::{Problem, Replay, WindowFit};
use crate::experiment::{Freedom, Window};
use crate::limits::{LEAST_MOVING, LEAST_WINDOW_SAMPLES, LEFT_UNCUT};

/// Samples before a change that are left out: by less than one the times of two formulations part.
const GUARD: usize = 1;

/// Windows of the tests to fit and of those held out, each up to the first change of contact under a hypothesis.
#[derive(Debug)]
pub struct BetweenImpacts {
    windows: [Vec<Window>; 2],
    /// Which of all windows each is a part of.
    places: [Vec<usize>; 2],
}

impl BetweenImpacts {
    /// Cuts all windows that start in motion where the contact of a fitted hypothesis changes first. Too short ones are left out;
    /// `None` if too few are left, or its values make no wall.
    pub fn cut(data: &Data, by: &FittedHypothesis) -> Option<Self> {
        let physics = by.hypothesis.physics(&by.fit.values)?;
        let replay = Replay::new(data.fit.tests, &physics);
        let sides = [(data.fit, &by.fit), (data.held_out, &by.held_out)];
        let [fit, held_out] = sides.map(|(problem, fit)| {
            let all = problem.windows.iter().zip(&fit.windows).enumerate();
            let moving = all.filter(|(_, (window, _))| window.freedom != Freedom::Rest);
            let cut = |(place, (window, fit)): (usize, (&Window, &WindowFit))| {
                let samples = replay.before_change(window, &fit.x).saturating_sub(GUARD);
                Some((place, part(&problem, window, samples)?))
            };
            moving.filter_map(cut).unzip::<usize, Window, Vec<_>, Vec<_>>()
        });
        let cut = Self { windows: [fit.1, held_out.1], places: [fit.0, held_out.0] };
        cut.are_enough(data).then_some(cut)
    }

    /// Which of the windows held out the parts of these are, in their order.
    pub fn places_held_out(&self) -> &[usize] {
        &self.places[1]
    }

    fn are_enough(&self, data: &Data) -> bool {
        let sides = [data.fit.windows, data.held_out.windows];
        let few = self.windows.iter().zip(sides).any(|(cut, all)| cut.len() < LEAST_MOVING.min(all.len()));
        let [cut, all] = [self.windows.iter().map(Vec::len).sum::<usize>(), sides.concat().len()];
        !few && cut as f64 >= LEFT_UNCUT * all as f64
    }

    /// How a hypothesis follows them, states fitted anew: those of tests to fit, and those held out.
    pub fn left(&self, data: &Data, tried: &FittedHypothesis) -> Option<[Vec<WindowFit>; 2]> {
        let [fit, held_out] = &self.windows;
        let of = |problem: Problem, windows: &[Window], places: &[usize], states: &[WindowFit]| {
            let states = places.iter().map(|k| states[*k].x.clone()).collect::<Vec<_>>();
            let cut = Problem { windows, ..problem };
            Some(cut.states(&tried.hypothesis, &tried.fit.values, &states, STEPS, false)?.windows)
        };
        Some([
            of(data.fit, fit, &self.places[0], &tried.fit.windows)?,
            of(data.held_out, held_out, &self.places[1], &tried.held_out.windows)?,
        ])
    }
}

/// Steps by which states are fitted anew.
const STEPS: usize = 3;

/// The beginning of a window; `None` where it holds too few samples.
fn part(problem: &Problem, window: &Window, samples: usize) -> Option<Window> {
    let samples = window.samples.start..window.samples.end.min(window.samples.start + samples);
    let test = &problem.tests[window.test];
    let readings = test.theta_rad[samples.clone()].iter().flatten().filter(|t| t.is_finite()).count();
    let enough = readings >= test.manner.channels() * LEAST_WINDOW_SAMPLES;
    enough.then(|| Window { samples, readings, ..window.clone() })
}
