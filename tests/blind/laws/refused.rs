//! What each guard of the search for formulas keeps out, of wrong forces and of right ones.

use mrbd_lab::diagnose::answer::RefusedLaw;
use mrbd_lab::diagnose::discovery::Guard;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::found::{Excited, force_error};
use super::row::{LawRow, RIGHT_FUNCTION};

/// A formula that was refused.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RefusedRow {
    /// The formula with its place.
    pub name: String,
    /// What refused it.
    pub guards: Vec<Guard>,
    /// Whether it was fitted to windows, or points alone have seen it.
    pub in_windows: bool,
    /// By how much its force is off over what the tests to fit excited; none where another place, or nothing, is hidden.
    pub function_error: Option<f64>,
}

impl RefusedRow {
    /// `None` for a name.
    pub fn new(answer: &Value, law: &RefusedLaw, points: &[Excited]) -> Option<Self> {
        let stiffness = law.wall.iter().find(|(key, _)| key.ends_with("stiffness_n_per_m"));
        let stiffness_n_per_m = stiffness.map(|(_, value)| *value);
        (!law.effects.is_empty()).then(|| Self {
            name: law.name.clone(),
            guards: law.guards.clone(),
            in_windows: law.windowed_error.is_some(),
            function_error: force_error(answer, &law.effects, stiffness_n_per_m, points),
        })
    }

    /// Whether its force is the true one.
    fn is_right(&self) -> bool {
        self.function_error.is_some_and(|error| error < RIGHT_FUNCTION)
    }
}

/// A table in Markdown: of each guard the formulas that it refused, and those that nothing else refused, right ones and wrong ones.
///
/// Empty where no case tells what was refused.
pub fn table(rows: &[LawRow]) -> String {
    let all = rows.iter().flat_map(|row| row.refused.iter().flatten()).collect::<Vec<_>>();
    if all.is_empty() {
        return String::new();
    }
    let told = rows.iter().filter(|row| row.refused.is_some()).count();
    let counted = |guard: Guard| {
        let own = all.iter().filter(|one| one.guards.contains(&guard)).collect::<Vec<_>>();
        let alone = own.iter().filter(|one| one.guards.len() == 1).collect::<Vec<_>>();
        let right = alone.iter().filter(|one| one.is_right()).count();
        let numbers = [own.len(), alone.len(), right, alone.len() - right];
        (!own.is_empty())
            .then(|| format!("| {} | {} |\n", guard.name(), numbers.map(|n| n.to_string()).join(" | ")))
    };
    let lines = Guard::ALL.into_iter().filter_map(counted).collect::<String>();
    format!(
        "Formulas refused in {told} cases:\n\n| guard | refused | by it alone | of these right within 10 % | wrong |\n| --- | --- | --- | --- | --- |\n{lines}"
    )
}
