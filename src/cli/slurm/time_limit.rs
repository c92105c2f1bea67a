//! Time limits as Slurm writes them.

use crate::error::{InputError, Result};

/// A time limit, s; none where there is none. Slurm's forms (manual of sbatch): `minutes`, `minutes:seconds`,
/// `hours:minutes:seconds`, `days-hours`, `days-hours:minutes`, `days-hours:minutes:seconds`; 0 is no limit.
///
/// # Errors
/// An input error for anything else.
pub(super) fn seconds(text: &str) -> Result<Option<u64>> {
    let refused = || {
        let allowed = "minutes, minutes:seconds, hours:minutes:seconds, days-hours, days-hours:minutes or \
                       days-hours:minutes:seconds";
        InputError::option("--time", format!("{text:?}"), allowed)
    };
    let (days, clock) = text.split_once('-').map_or((None, text), |(days, clock)| (Some(days), clock));
    let number = |text: &str| match text.bytes().all(|byte| byte.is_ascii_digit()) {
        true => text.parse::<u32>().map(u64::from).map_err(|_| refused()),
        false => Err(refused()),
    };
    let fields = clock.split(':').map(number).collect::<Result<Vec<u64>, _>>()?;
    let time_s = match (days.map(number).transpose()?, fields.as_slice()) {
        (None, [minutes]) => 60 * minutes,
        (None, [minutes, seconds]) => 60 * minutes + seconds,
        (None, [hours, minutes, seconds]) => 3600 * hours + 60 * minutes + seconds,
        (Some(days), [hours]) => 86_400 * days + 3600 * hours,
        (Some(days), [hours, minutes]) => 86_400 * days + 3600 * hours + 60 * minutes,
        (Some(days), [hours, minutes, seconds]) => 86_400 * days + 3600 * hours + 60 * minutes + seconds,
        _ => return Err(refused().into()),
    };
    Ok((time_s > 0).then_some(time_s))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_forms_of_the_manual_of_sbatch() {
        for (text, time_s) in [
            ("90", 5400),
            ("90:30", 5430),
            ("04:00:00", 14_400),
            ("2-12", 216_000),
            ("1-00:30", 88_200),
            ("1-00:00:01", 86_401),
        ] {
            assert_eq!(seconds(text).expect("a time limit"), Some(time_s), "{text}");
        }
        assert_eq!(seconds("0").expect("no limit"), None);
    }

    #[test]
    fn rejects_what_is_no_time() {
        for text in ["", "4h", "1:2:3:4", "-1", "1-", "+5", "1 -2", "99999999999"] {
            let error = seconds(text).expect_err("no time limit");
            assert!(error.exit_code() == 2 && error.to_string().contains("--time"), "{text}: {error}");
        }
    }
}
