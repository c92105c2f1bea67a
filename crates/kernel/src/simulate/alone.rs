//! A run by itself. Where nothing has happened for a while it steps in one of the lanes of a row, which look at a step by
//! fewer instructions; the others are empty. Its steps have the same bits either way.
//!
//! It waits for its own sums. To take the next step before one is looked at was tried, which goes on from there where nothing happened:
//! 0.95 of the time of the table wall, 1.04 of that of façades, whose flights are short. Arms by their Taylor series around the start of
//! a step, and the whole equation by such series, took as long as sines: more sums where fewer wait. So did sines of all of a rotation but
//! what the acceleration before adds to it, turned further by that: 0.97 of the time of the table wall, 1.05 of that of façades in lanes.

use fearless_simd::Level;

use super::history::Observer;
use super::lane_steps::advance_alone;
use super::response::Response;
use super::row::Row;
use super::run::Run;
use crate::instructions::lanes_pay;
use crate::model::{LaneKind, Reactions};

/// Steps one after another without an event, after which it pays to board a lane.
const QUIET_STEPS: u32 = 3;

/// The lane of a run.
const LANE: usize = 0;

/// The run that was begun, to its end.
pub(super) fn to_its_end<O: Observer>(mut run: Run<O>) -> Response {
    let level = Level::new();
    let may_board = lanes_pay(level) && !run.is_watched();
    let (mut row, mut reactions, mut quiet) = (None::<Box<Row>>, Reactions::default(), 0);
    while run.needs_step() {
        if may_board && quiet >= QUIET_STEPS {
            quiet = 0;
            if let Some(as_one) = turns_as_one(&run) {
                step_in_lane(level, as_one, &mut run, row.get_or_insert_default());
                continue;
            }
        }
        run.step_alone(&mut reactions);
        quiet = if run.advances() { quiet + 1 } else { 0 };
    }
    run.end()
}

/// Whether both bodies turn as one, of a wall whose steps a lane takes faster: not with further laws, of which lanes do
/// more sums.
fn turns_as_one<O: Observer>(run: &Run<O>) -> Option<bool> {
    match run.step_request().motion.side_by_side()? {
        LaneKind::AsOne { further: false } => Some(true),
        LaneKind::Apart { further: false } => Some(false),
        _ => None,
    }
}

/// Steps in a lane up to the end of the first event, or to where the run must look by itself.
fn step_in_lane<O: Observer>(level: Level, as_one: bool, run: &mut Run<O>, row: &mut Row) {
    run.board(row, LANE);
    row.taken = 1 << LANE;
    loop {
        advance_alone(level, as_one, row);
        if run.goes_through(row, LANE).is_some() {
            return;
        }
    }
}
