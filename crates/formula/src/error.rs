//! Why a text is no formula: where, what was found, what is allowed.

/// Why a text is no formula, or one that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}{found}; allowed: {allowed}", place(*.at))]
pub struct FormulaError {
    /// Character of the formula, from 1; `None` for what has no single place.
    pub at: Option<usize>,
    /// The parameter at fault, where it is not the formula.
    pub parameter: Option<String>,
    /// The carried state at fault, and its key.
    pub state: Option<Box<(String, &'static str)>>,
    /// What was found.
    pub found: String,
    /// What is allowed.
    pub allowed: String,
}

fn place(at: Option<usize>) -> String {
    at.map_or_else(String::new, |at| format!("at character {at}: "))
}

impl FormulaError {
    pub(crate) fn new(at: Option<usize>, found: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self { at, parameter: None, state: None, found: found.into(), allowed: allowed.into() }
    }

    /// Something of the whole formula.
    pub fn found(found: &str, allowed: &str) -> Self {
        Self::new(None, found, allowed)
    }

    pub(crate) fn of_parameter(name: &str, found: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self { parameter: Some(name.to_owned()), ..Self::new(None, found, allowed) }
    }

    /// Of a key of a carried state.
    pub(crate) fn of_state(self, name: &str, key: &'static str) -> Self {
        // A parameter that is at fault is named before the state that uses it.
        let state = self.parameter.is_none().then(|| Box::new((name.to_owned(), key)));
        Self { state, ..self }
    }

    /// The key at fault within the formula of a wall file, whose own key is given.
    pub fn key(&self, own: &str) -> String {
        match (&self.parameter, self.state.as_deref()) {
            (Some(name), _) => format!("parameters.{name}"),
            (None, Some((name, ""))) => format!("states.{name}"),
            (None, Some((name, key))) => format!("states.{name}.{key}"),
            (None, None) => own.to_owned(),
        }
    }

    /// What was found, with its place in the formula.
    pub fn found_at(&self) -> String {
        format!("{}{}", place(self.at), self.found)
    }
}
