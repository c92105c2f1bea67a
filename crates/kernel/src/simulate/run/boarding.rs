//! A run boards a lane of a row, and alights from it.

use super::super::bed_events::keeps_contact_between;
use super::super::history::Observer;
use super::super::row::{Row, put};
use super::{Run, Stop};
use crate::model::{Contact, Joint, Kink, Regime, TopSides};
use crate::solver::{Point, STAGES};

impl<O: Observer> Run<O> {
    /// The contact state.
    pub fn contact(&self) -> Contact {
        self.contact
    }

    /// The branch of the laws at the top, where these have branches.
    pub fn regime(&self) -> Option<Regime> {
        self.wall.piecewise_laws().map(|_| self.wall.regime())
    }

    /// Whether anybody watches it.
    pub fn is_watched(&self) -> bool {
        self.observer.watches()
    }

    /// Whether steps without an event are the same for it as for any other run.
    pub(super) fn is_plain(&self) -> bool {
        let formulas = self.wall.formulas();
        let known = !formulas.have_switches() || self.top_sides().is_some();
        known && !formulas.remember_largest() && !self.wall.is_held()
    }

    /// Where the top stays while no switch of a formula turns, where the row can tell.
    fn top_sides(&self) -> Option<TopSides> {
        let formulas = self.wall.formulas();
        let alone = self.wall.piecewise_laws().is_none() && self.carried.is_none();
        if alone && formulas.have_switches() { formulas.top_sides() } else { None }
    }

    /// Puts all that the next step needs in a lane.
    pub fn board(&self, row: &mut Row, i: usize) {
        row.errors.put(i, &self.controller);
        self.board_ground(row, i);
        self.board_kinks(row, i);
        row.impacts.cracks.put(i, &self.wall);
        self.board_contact(row, i);
    }

    /// The same of a run that comes back in another contact state.
    pub fn board_contact(&self, row: &mut Row, i: usize) {
        row.motions.put(i, self.wall.motion(self.contact));
        self.board_limits(row, i);
        self.board_impacts(row, i);
        self.board_again(row, i);
    }

    fn board_kinks(&self, row: &mut Row, i: usize) {
        let kinks = &mut row.kinks;
        let [mut least_m, mut most_m] = [-f64::MAX, f64::MAX];
        let mut stops = [0.0; 2];
        if let Some(laws) = self.wall.piecewise_laws() {
            kinks.any = true;
            let regime = self.wall.regime();
            for kink in laws.kinks(&regime) {
                match kink {
                    Kink::Passes { limit_m, sign, .. } if sign > 0.0 => most_m = most_m.min(limit_m),
                    Kink::Passes { limit_m, .. } => least_m = least_m.max(limit_m),
                    Kink::Stops { .. } | Kink::Turns { .. } => {}
                }
            }
            stops = [regime.yields.sign(), regime.slides.sign()];
        }
        if let Some(TopSides { between_m, along }) = self.top_sides() {
            kinks.any = true;
            [least_m, most_m] = between_m;
            stops = [0.0, along];
        }
        (kinks.least_m[i], kinks.most_m[i]) = (least_m, most_m);
        put(&mut kinks.stops, i, stops);
        let parameters = self.wall.wall().parameters();
        (kinks.thickness_m[i], kinks.height_m[i]) = (parameters.thickness_m, parameters.height_m);
    }

    fn board_ground(&self, row: &mut Row, i: usize) {
        self.ground.share_samples(&mut row.samples[i]);
        row.ground.samples[i] = self.ground.samples().len() as f64;
        row.ground.step_s[i] = self.ground.step_s();
        row.ground.samples_per_s[i] = 1.0 / self.ground.step_s();
        row.ground.origin_s[i] = self.ground.origin_s();
        row.ground.end_s[i] = self.ground.end_s();
    }

    fn board_limits(&self, row: &mut Row, i: usize) {
        let limits = &mut row.limits;
        let Contact { ground, crack } = self.wall.edges_of(self.contact);
        put(&mut limits.sides, i, [ground.sign(), crack.sign()]);
        put(&mut limits.collapse_rad, i, self.collapse_rad);
        let closed_edges = self.wall.closed_edges(self.contact);
        let closed = self.wall.joints().find(|joint| closed_edges.at(*joint));
        limits.closed[i] = f64::from(u8::from(closed.is_some()));
        limits.per_width[i] = self.wall.per_width(closed.unwrap_or(Joint::Ground));
        limits.per_weight[i] = self.wall.per_weight();
        limits.cracked[i] = f64::from(u8::from(self.wall.wall().is_cracked()));
    }

    /// The same of a run that comes back with the laws with which it alighted.
    pub fn board_again(&self, row: &mut Row, i: usize) {
        let Some(piece) = &self.piece else { unreachable!("a step is asked for within a piece") };
        row.moving.put(i, &self.now, self.quadrature_rate, self.requested_s());
        row.ground.put(i, piece, self.k, self.offset_s);
        row.wants_from_s[i] = self.observer.wants_from_s();
        row.errors.put(i, &self.controller);
        row.motions.put_formulas(i, self.wall.motion(self.contact));
        self.board_task(row, i);
        let (limits, totals) = (&mut row.limits, &self.totals);
        limits.put_rotations(i, &totals.theta_max);
        put(&mut limits.tension, i, totals.in_tension.map(|tension| f64::from(u8::from(tension))));
        limits.corner_force[i] = self.corner_force.unwrap_or_default();
        limits.top_velocity_m_s[i] = self.top_velocity_m_s;
        let switches = self.wall.formulas().have_switches();
        if switches {
            // Those of formulas may have turned.
            self.board_kinks(row, i);
        }
        if switches || self.wall.piecewise_laws().is_some() {
            let Point { position, velocity, acceleration } = self.now;
            let [top_m, _, top_m_s2] = self.wall.top(self.contact, position, velocity, acceleration);
            (row.kinks.top_m[i], row.kinks.top_m_s2[i]) = (top_m, top_m_s2);
        }
        if self.wall.wall().gives() {
            for joint in [Joint::Ground, Joint::Crack] {
                let [low, high] = keeps_contact_between(&self.wall, self.contact, self.opened, joint);
                (row.beds.low_rad[joint as usize][i], row.beds.high_rad[joint as usize][i]) = (low, high);
            }
        }
        let sums = &mut row.sums;
        sums.theta_max[i] = totals.theta_max;
        sums.top_m[i] = totals.top_max.value;
        sums.top_time_s[i] = totals.top_max.time_s;
        sums.pattern_time_s[i] = totals.pattern_time_s[self.contact.index()];
        put(&mut sums.friction, i, totals.demand.map(|demand| demand.friction));
        put(&mut sums.compression_n, i, totals.demand.map(|demand| demand.compression_n));
        sums.ground_work_j[i] = totals.energy.ground_work_j;
        sums.effect_loss_j[i] = totals.energy.effect_loss_j;
        sums.passed_through_j[i] = totals.energy.passed_through_j;
        (sums.steps[i], sums.tolerance_steps[i], sums.rejected_steps[i]) = (0.0, 0.0, 0.0);
        sums.most_steps[i] = self.steps_left() as f64;
        self.board_strikes(row, i);
    }

    /// Shows whoever watches the step that was kept in a lane. False where they have seen enough; the run has alighted
    /// then.
    pub fn is_watched_on(&mut self, row: &mut Row, i: usize) -> bool {
        self.follow_lane(row, i);
        let (start_s, motion) = row.moved(i);
        self.observer.moved(start_s, self.contact, &motion);
        row.wants_from_s[i] = self.observer.wants_from_s();
        let new_piece = row.ground.offset_s[i] == 0.0;
        if !new_piece || !self.observer.seen_enough() {
            return true;
        }
        self.alight(row, i);
        // The step that would have followed is not taken.
        let would_be_short = row.moving.h[i] < row.ground.length_s[i];
        self.totals.work.tolerance_steps -= u64::from(would_be_short);
        self.stopped = Some(Stop::SeenEnough);
        false
    }

    /// Takes over what became of it in a lane.
    pub fn alight(&mut self, row: &Row, i: usize) {
        row.errors.tell(i, &mut self.controller);
        self.follow_lane(row, i);
        self.take_over_impacts(row, i);
        let [steps, rejected, tolerance] =
            [row.sums.steps[i], row.sums.rejected_steps[i], row.sums.tolerance_steps[i]].map(|n| n as u64);
        let work = &mut self.totals.work;
        work.steps += steps;
        work.rejected_steps += rejected;
        work.evaluations += STAGES * (steps + rejected);
        work.tolerance_steps += tolerance;
        if steps == 0 {
            return;
        }
        (self.now, self.quadrature_rate) = row.moving.at(i);
        (self.piece, self.k, self.offset_s) =
            (Some(row.ground.at(i)), row.ground.k[i], row.ground.offset_s[i]);
        self.corner_force = self.corner_force.map(|_| row.limits.corner_force[i]);
        self.top_velocity_m_s = row.limits.top_velocity_m_s[i];
        self.stalled = 0;
        let (sums, totals) = (&row.sums, &mut self.totals);
        totals.theta_max = sums.theta_max[i];
        totals.top_max.value = sums.top_m[i];
        totals.top_max.time_s = sums.top_time_s[i];
        totals.pattern_time_s[self.contact.index()] = sums.pattern_time_s[i];
        for (j, demand) in totals.demand.iter_mut().enumerate() {
            demand.friction = sums.friction[j][i];
            demand.compression_n = sums.compression_n[j][i];
        }
        totals.energy.ground_work_j = sums.ground_work_j[i];
        totals.energy.effect_loss_j = sums.effect_loss_j[i];
        totals.energy.passed_through_j = sums.passed_through_j[i];
    }
}
