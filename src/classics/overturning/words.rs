//! What a study assumes, in words.

use super::study::{Range, Study};
use mrbd_kernel::model::{Effect, WallParameters};

/// Names and sentences, for the files of a spectrum and its page.
pub fn assumptions(study: &Study) -> Vec<(String, String)> {
    let p = study.wall.parameters();
    let pair = |name: &str, text: String| (name.to_owned(), text);
    let mut told = vec![
        pair("wall", wall(p)),
        pair("top", top(p)),
        pair("impacts", impacts(p)),
        pair("pulse", format!("{}, by frequency ω over p and amplitude over αg", study.pulse.name())),
        pair("frequencies over p", range(&study.frequency_over_p)),
        pair("amplitudes over αg", range(&study.amplitude_over_alpha_g)),
        pair("boundaries", format!("narrowed to {} αg", study.boundary_tolerance)),
        pair("samples of a pulse", format!("{} in a period", study.samples_per_period)),
        pair(
            "free motion after it",
            format!(
                "{} periods of the pulse, and at least {}/p",
                study.tail_over_period, study.least_tail_times_p
            ),
        ),
        pair("tolerance", format!("{:e} of α", study.tolerance)),
    ];
    if !p.effects.is_empty() {
        let effect = |e: &Effect| {
            let values = e.entry().parameters.iter().zip(e.parameters());
            let values = values.map(|(p, value)| format!("{} = {value}", p.key)).collect::<Vec<_>>();
            format!("{} ({})", e.variant().name(), values.join(", "))
        };
        told.push(pair("further effects", p.effects.iter().map(effect).collect::<Vec<_>>().join("; ")));
    }
    told
}

fn wall(p: &WallParameters) -> String {
    let crack = p.crack_height_m.map_or("no crack".to_owned(), |h1| format!("crack at {} m", short(h1)));
    format!(
        "{} m thick, {} m high, {crack}, strip of {} m, {} kg; corners {} m apart at the ground, {} m at the crack; collapsed at {} α",
        short(p.thickness_m),
        short(p.height_m),
        short(p.length_m),
        short(p.mass_kg),
        short(p.lower_width_m),
        short(p.upper_width_m),
        short(p.collapse_rotation_ratio)
    )
}

fn top(p: &WallParameters) -> String {
    format!("m_d {} kg, m_dp {} kg, k_d {} N/m", p.diaphragm_mass_kg, p.carriage_mass_kg, p.stiffness_n_per_m)
}

fn impacts(p: &WallParameters) -> String {
    let r = &p.restitution;
    let coefficients = match r.coefficients.iter().all(|c| *c == 1.0) {
        true => "plastic, C_l = 1".to_owned(),
        false => format!("C_1 … C_8 = {}", r.coefficients.map(short).join(", ")),
    };
    format!(
        "{coefficients}, law “{}”, capture velocity {} rad/s",
        r.law.name(),
        short(r.capture_velocity_rad_s)
    )
}

/// A number to six digits.
fn short(value: f64) -> String {
    format!("{value:.5e}").parse::<f64>().map_or_else(|_| value.to_string(), |rounded| rounded.to_string())
}

fn range(range: &Range) -> String {
    let values = range.values();
    let [first, last] = [values[0], values[values.len() - 1]];
    format!("{} from {first} to {last}", values.len())
}
