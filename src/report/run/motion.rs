//! What the animation needs, as numbers: shape of the wall, rotations, patterns, impacts, ground acceleration.

use serde_json::{Value, json};

use super::super::chart::{PALETTE, PATTERNS};
use super::RunPicture;
use mrbd_kernel::model::{Contact, Joint, PATTERN_NAMES};
use mrbd_kernel::simulate::{HistoryRow, Outcome};

/// Rotations are told in millionths of a radian: micrometres at the top of a wall.
const PER_RAD: f64 = 1e6;
/// Accelerations are told in mm/s².
const PER_M_S2: f64 = 1e3;

/// Most samples that the script is given: a thousand seconds at sixty a second, as a screen shows them.
const MOST_SAMPLES: usize = 60_000;

/// The data of the script, one number a sample and body; of a long history every so many samples one.
pub fn data(picture: &RunPicture) -> Value {
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
