//! Watching a run for its pictures: the history, and every impact with the speed at which it closes.

use mrbd_kernel::model::{Contact, Joint, Pair};
use mrbd_kernel::simulate::{History, Observer};
use mrbd_kernel::solver::Quintic;

/// An impact as it is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpactMark {
    /// When, s.
    pub time_s: f64,
    /// Pattern before.
    pub from: Contact,
    /// Pattern after.
    pub to: Contact,
    /// Rate at which the joint closed, rad/s; the faster one where both did.
    pub closing_rad_s: f64,
}

impl ImpactMark {
    /// Whether a joint closed.
    pub fn at(&self, joint: Joint) -> bool {
        closes(self.from, self.to, joint)
    }
}

/// An open joint that afterwards is closed, or open about its other corner, has struck.
fn closes(from: Contact, to: Contact, joint: Joint) -> bool {
    from.at(joint).is_open() && to.at(joint) != from.at(joint)
}

/// The history of a run and its impacts.
#[derive(Debug, Clone)]
pub struct Watch {
    /// Rotations and patterns at every sample.
    pub history: History,
    /// Impacts in order.
    pub impacts: Vec<ImpactMark>,
    /// Pattern and rates of rotation at the end of the last stretch.
    last: Option<(Contact, Pair)>,
}

impl Watch {
    /// Watches with a row of history at every step, s.
    pub fn new(step_s: f64) -> Self {
        Self { history: History::new(step_s), impacts: Vec::new(), last: None }
    }

    fn goes_on(&mut self, time_s: f64, to: Contact) {
        let Some((from, [omega1, omega2])) = self.last else { return };
        let rates = [(Joint::Ground, omega1), (Joint::Crack, omega2 - omega1)];
        let struck = rates.iter().filter(|(joint, _)| closes(from, to, *joint)).map(|(_, rate)| rate.abs());
        if let Some(closing_rad_s) = struck.reduce(f64::max) {
            self.impacts.push(ImpactMark { time_s, from, to, closing_rad_s });
        }
    }
}

impl Observer for Watch {
    fn moved(&mut self, start_s: f64, contact: Contact, motion: &Quintic) {
        self.goes_on(start_s, contact);
        self.last = Some((contact, motion.velocity(1.0)));
        self.history.moved(start_s, contact, motion);
    }

    fn stood(&mut self, from_s: f64, to_s: f64) {
        self.goes_on(from_s, Contact::REST);
        self.last = Some((Contact::REST, [0.0; 2]));
        self.history.stood(from_s, to_s);
    }

    fn ended(&mut self, time_s: f64, contact: Contact, theta: Pair) {
        self.history.ended(time_s, contact, theta);
    }
}
