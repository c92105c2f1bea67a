//! Watching a run for its pictures: history, impacts and their speeds, and what the animation needs as numbers.

use serde_json::{Value, json};

use super::super::chart::{PALETTE, PATTERNS};
use super::RunPicture;
use mrbd_kernel::model::{Contact, Joint, PATTERN_NAMES, Pair};
use mrbd_kernel::simulate::{History, HistoryRow, Observer, Outcome};
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

/// Rotations are told in millionths of a radian: micrometres at the top of a wall.
const PER_RAD: f64 = 1e6;
/// Accelerations are told in mm/s².
const PER_M_S2: f64 = 1e3;

/// Most samples that the script is given: a thousand seconds at sixty a second, as a screen shows them.
const MOST_SAMPLES: usize = 60_000;

/// The data of the script, one number a sample and body; of a long history every so many samples one.
pub fn motion(picture: &RunPicture) -> Value {
    let every = picture.watch.history.rows.len().div_ceil(MOST_SAMPLES).max(1);
    let rows: Vec<&HistoryRow> = picture.watch.history.rows.iter().step_by(every).collect();
    let p = picture.wall.parameters();
    let h1 = p.crack_height_m.unwrap_or(p.height_m);
    let theta =
        |body: usize| -> Vec<i64> { rows.iter().map(|row| whole(row.theta_rad[body] * PER_RAD)).collect() };
    let ground = picture.shaking.horizontal.as_ref().map_or(&[][..], |motion| motion.acceleration_m_s2());
    json!({
        "thickness": p.thickness_m,
        "heights": [h1, p.height_m - h1],
        "widths": picture.wall.width_m(),
        "cracked": picture.wall.is_cracked(),
        "stiffness": p.stiffness_n_per_m,
        "alpha": picture.wall.alpha_i_rad(),
        "step": picture.watch.history.step_s() * every as f64,
        "theta1": theta(0),
        "theta2": theta(1),
        "ground": ground.iter().step_by(every).take(rows.len()).map(|a| whole(a * PER_M_S2)).collect::<Vec<_>>(),
        "perRad": PER_RAD,
        "perMS2": PER_M_S2,
        "patterns": pattern_changes(&rows),
        "patternNames": PATTERN_NAMES,
        "patternColours": PATTERNS.map(|colour| colour.hex()),
        "bodyColours": [PALETTE[0].hex(), PALETTE[1].hex()],
        "signs": Contact::ALL.map(|contact| [contact.ground.sign(), contact.crack.sign()]),
        "impacts": picture.watch.impacts.iter().map(|impact| json!([
            rounded(impact.time_s),
            u8::from(impact.at(Joint::Ground)) + 2 * u8::from(impact.at(Joint::Crack)),
            rounded(impact.closing_rad_s),
        ])).collect::<Vec<_>>(),
        "collapse": match picture.response.outcome { Outcome::Collapsed { time_s } => Some(time_s), _ => None },
        "peaks": picture.response.theta_max_rad.map(|peak| peak.time_s),
    })
}

fn whole(value: f64) -> i64 {
    // Saturates where a value is beyond all bounds, which a history's are not.
    value.round() as i64
}

fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// Rows at which the pattern changes, with the pattern from there on.
fn pattern_changes(rows: &[&HistoryRow]) -> Vec<[usize; 2]> {
    let mut changes: Vec<[usize; 2]> = Vec::new();
    for (row, index) in rows.iter().map(|row| row.contact.index()).enumerate() {
        if changes.last().is_none_or(|[_, last]| *last != index) {
            changes.push([row, index]);
        }
    }
    changes
}
