//! Verdicts, numbers and names as people read them.

use mrbd_lab::diagnose::Verdict;
use mrbd_lab::diagnose::answer::{FittedNumber, FittedToAll, FoundEffect, SharedHeldOut, Summary};
use mrbd_lab::diagnose::discovery::{Stability, UnseenGain};
use mrbd_lab::diagnose::verdict::{OtherLaw, Remainder};
use mrbd_lab::limits::SMALL_SWING;

/// Standard deviations over the value itself beyond which the tests do not tell it.
const NOT_TOLD: f64 = 100.0;

/// A number to four digits, without powers of ten where it is of common size.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&size) {
        return format!("{value:.3e}");
    }
    let digits = if size >= 1000.0 { 0 } else { (3 - size.max(1e-3).log10().floor() as i32).clamp(0, 6) };
    format!("{value:.*}", digits as usize)
}

/// A number with its standard deviation.
pub fn with_sd(value: f64, sd: Option<f64>) -> String {
    match sd {
        Some(sd) if value != 0.0 && sd > NOT_TOLD * value.abs() => format!("{}, not told", number(value)),
        Some(sd) => format!("{} ± {}", number(value), number(sd)),
        None => number(value),
    }
}

/// The numbers of a hypothesis.
pub fn parameters(all: &[FittedNumber]) -> String {
    let one = |p: &FittedNumber| {
        let unit = if p.unit.is_empty() { String::new() } else { format!(" {}", p.unit) };
        format!("{} = {}{unit}", p.key, with_sd(p.value, p.sd))
    };
    all.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// The numbers of an effect, each with its unit and its 90 % interval.
pub fn numbers_of(e: &FoundEffect) -> Vec<String> {
    let value = |(key, value): (&String, &f64)| {
        let range = e
            .interval
            .get(key)
            .map_or(String::new(), |[low, high]| format!(" (90 %: {} to {})", number(*low), number(*high)));
        format!("{key} = {}{}{range}", number(*value), unit_of(e, key))
    };
    e.parameters.iter().map(value).collect()
}

/// How far from round the exponents of a formula may be.
pub fn round_exponents(e: &FoundEffect) -> Option<String> {
    let found = e.round_exponents.as_ref()?;
    let one = |(name, [low, high]): (&String, &[f64; 2])| {
        // Round as it is: four digits would make it look measured.
        let told = found.told.get(name)?;
        Some(format!("{name} = {told} may be {} to {}", number(*low), number(*high)))
    };
    let all = found.interval.iter().filter_map(one).collect::<Vec<_>>().join(", ");
    let beside = |(name, [low, high]): (&String, &[f64; 2])| {
        format!("; {name} then is {} to {}{}", number(*low), number(*high), unit_of(e, name))
    };
    let beside = found.beside.iter().map(beside).collect::<String>();
    Some(format!("round exponents: in {}, {all} (90 %){beside}", found.formula))
}

/// The unit of a number, after a space; empty where the key says it.
pub fn unit_of(e: &FoundEffect, key: &str) -> String {
    let unit = e.units.get(key).filter(|unit| !unit.is_empty());
    unit.map_or(String::new(), |unit| format!(" {unit}"))
}

fn effect(e: &FoundEffect) -> String {
    let at = at(&e.place);
    let values = numbers_of(e).join(", ");
    let onset = e.sets_in_over_m.map_or(String::new(), |m| {
        format!(
            ", which sets in over {} mm: the wall file has it as a spring that yields so soon",
            number(1e3 * m)
        )
    });
    let law = e.formula.as_deref().or(e.name.as_deref());
    let round = round_exponents(e).map_or_else(String::new, |told| format!(" ({told})"));
    format!("{}, {at}: {values}{onset}{round}", law.unwrap_or("a law outside the catalogue"))
}

/// A place in a sentence.
pub fn at(place: &str) -> String {
    match place {
        "impacts" => "at impacts".to_owned(),
        "ground motion" => "in the ground motion".to_owned(),
        "sensor" => "in the sensors".to_owned(),
        "masses" => "in the wall’s masses and lengths".to_owned(),
        "none" => "nowhere".to_owned(),
        place => format!("at the {place}"),
    }
}

/// The verdict as a sentence or two.
pub fn lead(summary: &Summary) -> String {
    let effects = summary.effects.iter().map(effect).collect::<Vec<_>>().join("; ");
    match summary.verdict {
        Verdict::None => "None: the simulation follows the tests within their noise.".to_owned(),
        Verdict::Recalibrated => {
            "Recalibrated: the gap closes within what was known of the wall’s own numbers.".to_owned()
        }
        Verdict::Named => match &summary.remainder {
            Some(found) => format!("Named, with a remainder: {effects}. {}", remainder(found)),
            None => format!("Named: {effects}. Nothing else in the catalogue explains these tests."),
        },
        Verdict::Class => format!(
            "A class: {} explain these tests alike. The first of them: {effects}.{}",
            summary.equivalent.join(", "),
            summary.remainder.as_ref().map_or(String::new(), |found| format!(" {}", remainder(found)))
        ),
        Verdict::Formula => format!(
            "A formula: {effects}. No effect of the catalogue explains these tests; this law does, as far as they went ({}).",
            ranges(&summary.effects)
        ),
        Verdict::FormulaClass => format!(
            "A class of formulas: {} explain these tests alike, and no effect of the catalogue does. The simplest: {effects}. All hold as far as the tests went ({}).",
            summary.equivalent.join(", "),
            ranges(&summary.effects)
        ),
        Verdict::Curve => format!(
            "A curve: a force is missing at the top that neither the catalogue nor a formula holds for. It is told by displacement and by velocity, as far as the tests went ({}), and can be simulated there.",
            ranges(&summary.effects)
        ),
        Verdict::PlaceOnly => {
            let place = summary.place.as_deref().map_or("somewhere".to_owned(), at);
            let like = imitation(summary);
            format!("A place only: a force is missing {place}, by a law that is not in the catalogue.{like}")
        }
        Verdict::Unknown => {
            let like = imitation(summary);
            let alone = summary.missed_held_out.as_ref().map_or_else(String::new, |found| {
                format!(
                    " Without an effect the wall follows the tests fitted ({} times the noise) and misses those held out ({}): something shows in these alone. A test like them, fitted too, would tell more.",
                    number(found.fit),
                    number(found.held_out)
                )
            });
            format!("Unknown: model and tests part, and nothing in the catalogue explains it.{alone}{like}")
        }
        Verdict::NoPower => {
            "No power: the wall moves too little beside the noise, or is sampled too coarsely, for most effects of a size that matters to show."
                .to_owned()
        }
    }
}

/// What a name takes away and leaves, where it leaves more than noise.
fn remainder(found: &Remainder) -> String {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let next = found.next_rival.as_ref().map_or(String::new(), |next| {
        format!(" The next effect, {}, takes away {}.", next.name, percent(next.taken_held_out.max(0.0)))
    });
    format!(
        "Of the squared error above noise that takes away {} in the tests held out ({} in those fitted; {} in small swings, {} in large ones), and leaves {} times the noise there: the model’s own error, with which the intervals are told.{next}",
        percent(found.taken_held_out),
        percent(found.taken_fit),
        percent(found.taken_small_swings),
        percent(found.taken_large_swings),
        number(found.left_held_out)
    )
}

/// With which other numbers a formula follows the tests held out.
pub fn fitted_to_all(found: &FittedToAll) -> String {
    let numbers = found.effects.iter().flat_map(numbers_of).collect::<Vec<_>>().join(", ");
    let left = found.windowed_error.held_out.map_or_else(String::new, |error| {
        format!(", which it then leaves at {} times the noise", number(error))
    });
    format!(
        "With its numbers as they were fitted the law misses the tests held out, which magnify what the tests fitted leave open of them. Fitted to all tests together it follows those too{left}: {numbers}. The tests fitted mind by {:.1} natural logarithms of likelihood; a law that only imitates another loses more, or goes on missing the tests held out.",
        found.lost,
    )
}

/// Which windows of the tests held out a formula was fitted to.
pub fn shared_held_out(found: SharedHeldOut) -> String {
    format!(
        "The tests fitted do not show all of the law: the best that follows these misses the larger motion of the tests held out. So every other window of the latter was fitted too, {} in all; the {} between them, other swings of the same tests, judge. A test of its own at that amplitude would tell more.",
        found.fitted, found.judging,
    )
}

/// How sure the form of a formula is.
pub fn stability(found: &Stability) -> String {
    let gain = |(judged, gain): (&str, Option<UnseenGain>)| {
        let UnseenGain { unseen, seen } = gain?;
        Some(format!(
            "in {judged} it gains {unseen:.0} natural logarithms of likelihood over the wall alone, {seen:.0} where it was fitted to them too"
        ))
    };
    let large =
        format!("swings beyond {:.0} % of the largest, fitted to the smaller ones,", 100.0 * SMALL_SWING);
    let judged = [
        (large.as_str(), found.large_by_small),
        ("the smaller ones, fitted to those,", found.small_by_large),
    ];
    let held_out = judged.into_iter().filter_map(gain).collect::<Vec<_>>();
    let amplitudes = match held_out.is_empty() {
        true => "The swings are too much alike to hold an amplitude out.".to_owned(),
        false => format!("Held against amplitudes that it has not seen: {}.", held_out.join("; ")),
    };
    format!(
        "The form of the law: of {} sets of swings drawn again, it or another of its class is as good as the best in {:.0} %. {amplitudes}",
        found.draws,
        100.0 * found.stable,
    )
}

/// What was excited of the variables of formulas.
fn ranges(effects: &[FoundEffect]) -> String {
    let one = |(key, [low, high]): (&String, &[f64; 2])| {
        let (variable, unit) = key.split_once('_').unwrap_or((key, ""));
        // Units of a key as people write them: `v_m_s` is v in m/s.
        format!("{variable} from {} to {} {}", number(*low), number(*high), unit.replace('_', "/"))
    };
    effects.iter().flat_map(|e| e.range.iter().map(one)).collect::<Vec<_>>().join(", ")
}

/// What an unnamed law looks like, where something in the catalogue nearly explains the tests.
fn imitation(summary: &Summary) -> String {
    let told = |law: &OtherLaw| {
        format!(
            " It looks like {}, but what that leaves still depends on how far or how fast the wall moves.",
            law.looks_like.join(" with ")
        )
    };
    summary.other_law.as_ref().map_or(String::new(), told)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_numbers_have_four_digits() {
        let told = [1487.38977, 12018135.0, 0.0054263, 37.1049, -0.5, 0.0].map(number);
        assert_eq!(told, ["1487", "1.202e7", "0.005426", "37.10", "-0.5000", "0"]);
    }

    #[test]
    fn regress_a_formula_has_units_and_says_how_far_it_was_seen() {
        let effect: FoundEffect = serde_json::from_value(serde_json::json!({
            "kind": "formula", "name": "formula", "formula": "-c*abs(x)*v", "place": "top",
            "parameters": { "c": 50096.2 }, "interval": { "c": [49668.1, 50524.4] }, "units": { "c": "N/m*(s/m)" },
            "range": { "v_m_s": [-0.31409, 0.33729] },
        }))
        .expect("an effect");
        assert_eq!(numbers_of(&effect), ["c = 50096 N/m*(s/m) (90 %: 49668 to 50524)"]);
        assert_eq!(ranges(&[effect]), "v from -0.3141 to 0.3373 m/s");
    }

    #[test]
    fn regress_a_round_exponent_says_how_far_from_round_it_may_be() {
        let effect: FoundEffect = serde_json::from_value(serde_json::json!({
            "kind": "formula", "name": "formula", "formula": "-k*max(x-g,0)**2", "place": "top",
            "parameters": { "k": 5e4, "g": 0.01182 }, "interval": {}, "units": { "k": "N/m**2", "g": "m" },
            "round_exponents": {
                "formula": "-k*max(x-g,0)**n", "told": { "n": 2.0 }, "interval": { "n": [1.6241, 2.0] },
                "beside": { "g": [0.01081, 0.01583] },
            },
        }))
        .expect("an effect");
        let told = "round exponents: in -k*max(x-g,0)**n, n = 2 may be 1.624 to 2.000 (90 %); g then is 0.01081 to 0.01583 m";
        assert_eq!(round_exponents(&effect).as_deref(), Some(told));
        assert_eq!(round_exponents(&FoundEffect { round_exponents: None, ..effect }), None);
    }
}
