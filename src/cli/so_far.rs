//! What a diagnosis knows while it is at work, left behind should it be stopped.

use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use super::progress::Bar;
use crate::report::number;
use crate::results::diagnosis::{UNFINISHED, write_unfinished};
use mrbd_lab::{Progress, Tried};

/// As many are told in words; the file has all.
const TOLD: usize = 3;

/// Hypotheses as far as they are fitted, the best first.
#[derive(Debug, Clone, Default)]
pub struct SoFar(Arc<Mutex<Vec<Tried>>>);

impl SoFar {
    /// Keeps the best fit of each hypothesis.
    fn add(&self, tried: &[Tried]) {
        // A thread that failed elsewhere has not touched the list.
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        for new in tried {
            match known.iter_mut().find(|old| old.name == new.name) {
                Some(old) if new.against < old.against => *old = new.clone(),
                Some(_) => {}
                None => known.push(new.clone()),
            }
        }
        known.sort_by(|a, b| a.against.total_cmp(&b.against));
    }

    /// Writes what is known into a folder, and says so.
    pub fn leave_in(&self, folder: &Path) -> String {
        let known = self.0.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if known.is_empty() {
            return "no hypothesis was fitted yet, nothing is stored".to_owned();
        }
        let file = folder.join(UNFINISHED);
        let stored = match write_unfinished(folder, &known) {
            Ok(()) => format!("{} has all {} fitted so far", file.display(), known.len()),
            Err(error) => format!("they could not be stored: {error}"),
        };
        let best = known.iter().take(TOLD).map(in_words).collect::<Vec<_>>();
        format!(
            "no verdict. Of the hypotheses fitted so far these follow the tests best:\n{}\n{stored}.",
            best.join("\n")
        )
    }
}

/// A hypothesis in a line.
fn in_words(tried: &Tried) -> String {
    let name = if tried.name.is_empty() { "the wall's own numbers" } else { &tried.name };
    let numbers =
        tried.numbers.iter().map(|(key, value, unit)| format!(", {key} = {} {unit}", number(*value)));
    let numbers = numbers.map(|number| number.trim_end().to_owned()).collect::<String>();
    let error = |error: Option<f64>| error.map_or("none".to_owned(), |error| format!("{error:.2}"));
    let [fit, held_out] = tried.windowed_error.map(error);
    format!("  {name}{numbers}: windowed error, in noise: {fit} fitted, {held_out} held out")
}

/// A bar that keeps what is known.
#[derive(Debug)]
pub struct Watched {
    /// Shows how far it is.
    pub bar: Bar,
    /// What is known.
    pub so_far: SoFar,
}

impl Progress for Watched {
    fn begin(&self, what: &str, parts: usize) {
        self.bar.begin(what, parts);
    }

    fn advance(&self, parts: usize) {
        self.bar.advance(parts);
    }

    fn note(&self, text: &str) {
        self.bar.note(text);
    }

    fn tried(&self, best: &[Tried]) {
        self.so_far.add(best);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tried(name: &str, against: f64) -> Tried {
        let numbers = vec![("force_n".to_owned(), 250.0, "N".to_owned())];
        Tried { name: name.to_owned(), numbers, windowed_error: [Some(1.5), None], against }
    }

    #[test]
    fn regress_the_best_fit_of_each_hypothesis_is_kept_and_left() {
        let so_far = SoFar::default();
        let folder = tempfile::tempdir().expect("a folder");
        assert!(so_far.leave_in(folder.path()).contains("nothing is stored"));
        so_far.add(&[tried("gap", 30.0), tried("coulomb_friction", 40.0)]);
        so_far.add(&[tried("coulomb_friction", 20.0), tried("gap", 35.0)]);
        let words = so_far.leave_in(folder.path());
        let place = |name: &str| words.find(name).unwrap_or_else(|| panic!("{name} is missing: {words}"));
        assert!(place("coulomb_friction, force_n = 250.0 N: windowed error") < place("  gap"), "{words}");
        let text = std::fs::read_to_string(folder.path().join(UNFINISHED)).expect("written");
        let lines = text.lines().collect::<Vec<_>>();
        assert_eq!(lines.len(), 3, "{text}");
        assert!(lines[1].starts_with("coulomb_friction,force_n = 250 N,1.5,,20"), "{text}");
    }
}
