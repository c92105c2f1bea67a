//! Ground motions one after another: each starts where the one before left the wall.
//!
//! Carried over are rotations, velocities, the contact state, what a yielding spring has yielded, what a bed has crushed
//! and, for formulas, how far the top has been. The model has no other memory. Corners are fixed widths, a floor keeps
//! its stiffness, joints do not slide. So a wall without these that has come to rest is as new, and the next motion
//! finds it so.
//!
//! Time begins anew with every part. Rest between two parts is the free motion after the first of them. An
//! effect that lags the record lags each part by itself.

use super::response::{Outcome, Response};
use super::simulator::Start;
use super::{Accuracy, Shaking, Simulator};
use crate::model::Wall;

/// Where the next part starts; `None` after a wall that did not stand.
pub fn following(before: &Response) -> Option<Start> {
    (before.outcome == Outcome::Stood).then_some(Start { time_s: 0.0, ..before.left })
}

/// Runs parts one after another, the first from the wall's initial rotations; `None` from that on which follows
/// a part in which the wall did not stand.
pub fn simulate_sequence(wall: &Wall, parts: &[Shaking], accuracy: Accuracy) -> Vec<Option<Response>> {
    let mut before: Option<Response> = None;
    let part = |(index, shaking): (usize, &Shaking)| {
        let simulator = Simulator::new(wall, shaking, accuracy);
        let start = match (index, &before) {
            (0, _) => Some(simulator.release()),
            (_, before) => before.as_ref().and_then(following),
        };
        before = start.map(|start| simulator.run_from(&start, simulator.end_s(), &mut ()));
        before.clone()
    };
    parts.iter().enumerate().map(part).collect()
}
