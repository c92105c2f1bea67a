//! What is told of a run once it has ended.

use super::super::history::Observer;
use super::super::response::{Outcome, Peak, Response};
use super::super::simulator::Start;
use super::{Run, Stop};
use crate::model::{Side, State};

impl<O: Observer> Run<O> {
    /// The response of the run, which is over.
    pub fn end(mut self) -> Response {
        let outcome = match self.stopped.take() {
            None | Some(Stop::SeenEnough) => Outcome::Stood,
            Some(Stop::Collapsed { time_s }) => Outcome::Collapsed { time_s },
            Some(Stop::Failed { time_s, reason }) => Outcome::Failed { time_s, reason },
        };
        self.response(outcome)
    }

    /// Plastic displacement of a yielding spring now, m; one that yields has moved on since it began to.
    fn plastic_displacement_m(&self) -> f64 {
        let x_c = self.wall.top_displacement_m(self.contact, self.now.position);
        self.wall.wall().plastic_displacement_m(self.wall.regime().plastic_m, x_c)
    }

    /// The largest displacement of the top until now, m, where it is kept.
    fn largest_displacement_m(&self) -> f64 {
        let regime = self.wall.regime();
        match regime.grows {
            Side::Between => regime.largest_m,
            _ => self.wall.top_displacement_m(self.contact, self.now.position).abs().max(regime.largest_m),
        }
    }

    fn settle_energy(&mut self) {
        let final_j = self.wall.energy_j(self.contact, &self.state());
        // A wall that falls from rest by its own weight turns one energy into another, with no work from outside.
        let halted = State { omega: [0.0; 2], ..self.state() };
        let kinetic_j = final_j - self.wall.energy_j(self.contact, &halted);
        let energy = &mut self.totals.energy;
        energy.final_j = final_j;
        energy.passed_through_j = energy.passed_through_j.max(kinetic_j);
    }

    fn response(mut self, outcome: Outcome) -> Response {
        let end_time_s = match outcome {
            Outcome::Stood => self.ground.end_s(),
            Outcome::Collapsed { time_s } | Outcome::Failed { time_s, .. } => time_s,
        };
        match self.totals.accounts {
            true => self.settle_energy(),
            false => self.totals = std::mem::take(&mut self.totals).untold(),
        }
        self.observer.ended(end_time_s, self.contact, self.now.position);
        let wall = self.wall.wall();
        let lower = self.totals.theta_max[0];
        Response {
            outcome,
            end_time_s,
            theta_max_rad: self.totals.theta_max,
            alpha_i_rad: wall.alpha_i_rad(),
            alpha_rad: wall.alpha_rad(),
            top_displacement_m: self.totals.top_max,
            // The middle of the crack moves monotonically with θ_1, so both are largest together.
            crack_displacement_m: Peak { value: self.wall.crack_displacement_m(lower.value), ..lower },
            pattern_time_s: self.totals.pattern_time_s,
            impacts: self.totals.impacts,
            openings: self.totals.openings,
            energy: self.totals.energy,
            demand: self.totals.demand,
            work: self.totals.work,
            left: Start {
                time_s: end_time_s,
                state: State { theta: self.now.position, omega: self.now.velocity },
                contact: Some(self.contact),
                plastic_displacement_m: self.plastic_displacement_m(),
                crushed_rad: self.wall.crushed_rad(self.now.position),
                largest_displacement_m: self.largest_displacement_m(),
                carried: self.carried.as_ref().map(|carried| carried.now),
            },
        }
    }
}
