//! TOML files: read whole, unknown keys refused, faults named with key and line.

use std::path::Path;

use serde::de::DeserializeOwned;

use crate::error::{Error, InputError, Place, Result};
use crate::suggestion::with_suggestion;

/// Reads a TOML file into `T`.
///
/// # Errors
/// Input errors that name the file and the key or line: not readable, not UTF-8, not TOML, or not a `T`.
pub fn load<T: DeserializeOwned>(path: &Path) -> Result<T> {
    parse(path, &read(path)?)
}

/// Reads a text file that the user named.
///
/// # Errors
/// An input error that says why the file cannot be read.
pub fn read(path: &Path) -> Result<String> {
    std::fs::read_to_string(path)
        .map_err(|e| InputError::file(path, e.to_string(), "a readable text file in UTF-8").into())
}

/// Parses TOML `text` that came from `path`.
///
/// # Errors
/// Input errors that name the file and the key or line.
pub fn parse<T: DeserializeOwned>(path: &Path, text: &str) -> Result<T> {
    let deserializer = toml::Deserializer::parse(text).map_err(|e| fault(path, text, "", &e))?;
    serde_path_to_error::deserialize(deserializer).map_err(|e| {
        let key = e.path().to_string();
        fault(path, text, &key, e.inner())
    })
}

fn fault(path: &Path, text: &str, key: &str, error: &toml::de::Error) -> Error {
    let line = error.span().map(|span| 1 + text[..span.start.min(text.len())].matches('\n').count());
    let place = match (key, line) {
        ("" | ".", None) => Place::Whole,
        ("" | ".", Some(line)) => Place::Line(line),
        (key, None) => Place::Key(key.to_owned()),
        (key, Some(line)) => Place::KeyOnLine(key.to_owned(), line),
    };
    let comma = line.and_then(|line| decimal_comma(text.lines().nth(line - 1)?));
    if let (Some(number), true) = (comma, key.is_empty() || key == ".") {
        let found = format!("`{number}`, with a decimal comma");
        let allowed = format!("a decimal point: {}", number.replace(',', "."));
        return InputError { origin: path.display().to_string(), place, found, allowed }.into();
    }
    // serde words its messages "<found>, expected <allowed>".
    let message = error.message().trim();
    let (found, allowed) = match message.split_once(", expected ") {
        Some((found, allowed)) => (found.to_owned(), suggested(found, in_words(allowed))),
        None if message.starts_with("missing field") => {
            (message.to_owned(), "this key must be given".to_owned())
        }
        None => (message.to_owned(), "valid TOML".to_owned()),
    };
    InputError { origin: path.display().to_string(), place, found, allowed }.into()
}

/// The number of a line `key = 0,291`, which TOML ends at the comma.
fn decimal_comma(line: &str) -> Option<&str> {
    let value = line.split_once('=')?.1.split('#').next()?.trim();
    let (whole, decimals) = value.split_once(',')?;
    let digits = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
    (digits(whole.trim_start_matches(['+', '-'])) && digits(decimals)).then_some(value)
}

/// What serde names after a type of this program, as people say it.
fn in_words(allowed: &str) -> &str {
    match allowed {
        "f64" => "a number",
        "u64" | "u32" | "usize" => "a whole number, 0 or more",
        "i64" | "i32" => "a whole number",
        other => other,
    }
}

/// What serde allows, with the key or value that was likely meant: serde quotes names in backticks.
fn suggested(found: &str, allowed: &str) -> String {
    let quoted = |text: &'_ str| text.split('`').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>();
    let known = quoted(allowed);
    match (found.starts_with("unknown "), quoted(found).first()) {
        (true, Some(found)) => with_suggestion(allowed.to_owned(), found, known.iter().map(String::as_str)),
        _ => allowed.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Outer {
        inner: Inner,
    }

    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Inner {
        height_m: f64,
    }

    fn message(text: &str) -> String {
        parse::<Outer>(Path::new("a.toml"), text).expect_err("must be refused").to_string()
    }

    #[test]
    fn analytic_reads_what_is_written() {
        let outer: Outer = parse(Path::new("a.toml"), "[inner]\nheight_m = 2.5\n").expect("valid");
        assert_eq!(outer.inner.height_m, 2.5);
    }

    #[test]
    fn rejects_faults_with_key_and_line() {
        let wrong_type = message("[inner]\nheight_m = \"tall\"\n");
        assert!(
            wrong_type.starts_with("a.toml:2: inner.height_m: found invalid type: string"),
            "{wrong_type}"
        );
        assert!(wrong_type.ends_with("; allowed: a number"), "{wrong_type}");
        let comma = message("[inner]\nheight_m = 2,5 # m\n");
        assert_eq!(comma, "a.toml:2: found `2,5`, with a decimal comma; allowed: a decimal point: 2.5");
        let unknown = message("[inner]\nheight_m = 1.0\nhieght = 2\n");
        assert!(
            unknown.contains("a.toml:3") && unknown.contains("hieght") && unknown.contains("`height_m`"),
            "{unknown}"
        );
        assert!(unknown.ends_with("did you mean `height_m`?"), "{unknown}");
        let stranger = message("[inner]\ncolour = 1\n");
        assert!(!stranger.contains("did you mean"), "{stranger}");
        let missing = message("[inner]\n");
        assert!(missing.contains("inner") && missing.contains("missing field `height_m`"), "{missing}");
        let broken = message("[inner\n");
        assert!(broken.starts_with("a.toml:1: found"), "{broken}");
    }
}
