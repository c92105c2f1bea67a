//! A run at rest: through as much of the record as leaves the wall there.

use super::super::ground_path::Piece;
use super::super::history::Observer;
use super::event::AFTER_OPENING;
use super::{Run, Stop};
use crate::model::Contact;

impl<O: Observer> Run<O> {
    /// Rests through all pieces from the `k`-th on at whose ends no corner has lifted; gives the first other.
    pub(super) fn rest_through_pieces(&mut self, k: usize) -> usize {
        let ends = self.ground.samples().get(k + 1..).unwrap_or(&[]);
        let (held, mut friction) = self.rest.holds_over(self.wall.motion(Contact::REST).level, ends);
        let next = self.ground.first_end_against(k + held, |ground| {
            let holds = self.rest.holds(ground);
            if holds {
                friction = friction.max(self.rest.friction(ground));
            }
            holds
        });
        // The piece that ends the run may be cut short: it is left to be run by itself.
        let next = next.min(self.ground.whole_pieces());
        if next <= k {
            return k;
        }
        self.record_rest(self.ground.start_s(k), self.ground.start_s(next), friction);
        next
    }

    /// Rests in the piece until a corner lifts or it ends.
    #[inline(never)]
    pub(super) fn rest_in_piece(&mut self) -> Result<(), Stop> {
        let Some(piece) = self.piece else { return Ok(()) };
        self.offset_s = self.rest_until_lift_off(&piece, self.offset_s)?;
        Ok(())
    }

    /// Rests until a corner lifts or the piece ends; gives the offset reached.
    fn rest_until_lift_off(&mut self, piece: &Piece, from_s: f64) -> Result<f64, Stop> {
        let lift_off = self.rest.lift_off_s(piece, from_s);
        let to_s = lift_off.map_or(piece.length_s, |s| self.after_opening(s, piece));
        let friction = self.rest.friction(piece.at(from_s)).max(self.rest.friction(piece.at(to_s)));
        self.record_rest(piece.start_s + from_s, piece.start_s + to_s, friction);
        if lift_off.is_some() {
            self.enter(Contact::REST, piece.at(to_s), piece.start_s + to_s)?;
        }
        Ok(to_s)
    }

    pub(super) fn record_rest(&mut self, from_s: f64, to_s: f64, friction: f64) {
        self.totals.pattern_time_s[Contact::REST.index()] += to_s - from_s;
        for (demand, factor) in self.totals.demand.iter_mut().zip(self.rest.friction_factors()) {
            demand.friction = demand.friction.max(friction * factor);
        }
        self.observer.stood(from_s, to_s);
    }

    pub(super) fn after_opening(&self, offset_s: f64, piece: &Piece) -> f64 {
        (offset_s + AFTER_OPENING * self.ground.step_s()).min(piece.length_s)
    }
}
