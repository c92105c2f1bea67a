//! The impacts of a run that has boarded a lane: what the lane needs to go through them, and what came of those that it went through.

use super::super::events::Event;
use super::super::history::Observer;
use super::super::lane_impacts::{AT_GROUND, REACHES};
use super::super::row::Row;
use super::{Run, Task};
use crate::model::{Contact, Pivot, Table2Change, Touching};
use crate::solver::STAGES;

impl<O: Observer> Run<O> {
    /// What impacts need that may be gone through in the lane.
    pub(super) fn board_impacts(&self, row: &mut Row, i: usize) {
        let (impacts, wall, contact) = (&mut row.impacts, &self.wall, self.contact);
        // An impact may turn a switch.
        let turns = wall.formulas().have_switches();
        let known_laws = wall.piecewise_laws().is_none() && self.carried.is_none() && !turns;
        let onto = if self.is_plain() && known_laws { wall.strikes_on(contact) } else { None };
        let known = onto
            .is_some_and(|(onto, _)| impacts.here.put(i, wall, contact) && impacts.there.put(i, wall, onto));
        impacts.known[i] = f64::from(u8::from(known));
        if let Some((onto, _)) = onto {
            impacts.pivots_there.put(i, &wall.motion(onto).sharp);
            impacts.contact_rad[i] = self.contact_rad;
            impacts.capture_rad_s[i] = wall.capture_rad_s();
        }
    }

    /// The event of the impact that the lane goes through, and that at the ground which it finds.
    fn impacts_in_lane(&self) -> [(f64, Event); 2] {
        let gone_through = Touching { ground: self.contact.crack.is_closed(), crack: true };
        let at_ground = Touching { ground: true, crack: false };
        [(REACHES, Event::Impact(gone_through)), (AT_GROUND, Event::Impact(at_ground))]
    }

    /// Which of them the step is to reach; 0 for none.
    fn reaches_in(&self, row: &Row, i: usize) -> f64 {
        let Task::ReachEvent { event: reached, .. } = self.task else { return 0.0 };
        let of_lane = self.impacts_in_lane().into_iter().find(|(_, event)| *event == reached);
        of_lane.filter(|_| row.impacts.known[i] == 1.0).map_or(0.0, |(reaches, _)| reaches)
    }

    /// Puts what the next step is for in a lane.
    pub(super) fn board_task(&self, row: &mut Row, i: usize) {
        row.impacts.reaches[i] = self.reaches_in(row, i);
        let advances = self.advances() && self.is_plain();
        row.limits.advances[i] = f64::from(u8::from(advances));
        row.moving.h[i] = self.requested_s();
        if let Task::ReachEvent { most_s, .. } = self.task {
            row.impacts.most_s[i] = most_s;
        }
    }

    /// Takes over about which corners the lane has it turn by now, and what its next step is for.
    pub(super) fn follow_lane(&mut self, row: &Row, i: usize) {
        let impacts = &row.impacts;
        if impacts.known[i] != 1.0 {
            return;
        }
        let [ground, crack] = [0, 1].map(|joint| Pivot::of_angle(row.limits.sides[joint][i]));
        self.contact = Contact { ground, crack };
        let h = row.moving.h[i];
        let reached = self.impacts_in_lane().into_iter().find(|(reaches, _)| *reaches == impacts.reaches[i]);
        if let Some((_, event)) = reached {
            self.task = Task::ReachEvent { event, h, most_s: impacts.most_s[i] };
        } else if row.limits.advances[i] == 1.0 {
            self.task = Task::Advance { h };
        }
    }

    /// Takes over the impacts that were gone through in a lane, and that were found there.
    pub(super) fn take_over_impacts(&mut self, row: &Row, i: usize) {
        let impacts = &row.impacts;
        self.totals.work.evaluations += STAGES * impacts.found[i] as u64;
        let onto = if impacts.known[i] == 1.0 { self.wall.strikes_on(self.contact) } else { None };
        let Some((onto, change)) = onto else { return };
        let [here, there] = [&impacts.here, &impacts.there].map(|strikes| strikes.count[i] as u64);
        self.totals.work.evaluations += here + there;
        self.totals.impacts.add(change, here);
        self.totals.impacts.add(Table2Change::of(onto, self.contact), there);
        self.totals.pattern_time_s[onto.index()] = impacts.time_there_s[i];
        self.totals.energy.impact_loss_j = impacts.loss_j[i];
    }

    /// Puts what adds up over the impacts in a lane.
    pub(super) fn board_strikes(&self, row: &mut Row, i: usize) {
        let impacts = &mut row.impacts;
        impacts.found[i] = 0.0;
        let onto = if impacts.known[i] == 1.0 { self.wall.strikes_on(self.contact) } else { None };
        let Some((onto, _)) = onto else { return };
        (impacts.here.count[i], impacts.there.count[i]) = (0.0, 0.0);
        impacts.time_there_s[i] = self.totals.pattern_time_s[onto.index()];
        impacts.loss_j[i] = self.totals.energy.impact_loss_j;
    }
}
