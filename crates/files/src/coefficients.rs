//! The coefficients C_l of the velocities after an impact: bounds and best fit of each.

use std::path::Path;

use serde::Deserialize;

use super::toml_file;
use crate::error::{InputError, Result};

/// The change of pattern each C_l belongs to, C_1 first; the model fixes it, so a file must agree.
const CHANGES: [(&str, &str); 8] = [
    ("1a", "2a"),
    ("2a", "1a"),
    ("1a", "2b"),
    ("2a", "1b"),
    ("3a", "1b"),
    ("3a", "3b"),
    ("1a", "3a"),
    ("2a", "3a"),
];

/// Three sets of C_1 … C_8.
#[derive(Debug, Clone, PartialEq)]
pub struct CoefficientSets {
    /// Where the numbers come from.
    pub source: String,
    /// Lower bounds β_0.
    pub lower: [f64; 8],
    /// Values that fit the tests best.
    pub best_fit: [f64; 8],
    /// Upper bounds β_f.
    pub upper: [f64; 8],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CoefficientsFile {
    source: String,
    coefficients: Vec<Coefficient>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Coefficient {
    name: String,
    from: String,
    to: String,
    lower: f64,
    upper: f64,
    best_fit: f64,
}

impl CoefficientSets {
    /// Reads and checks a file of coefficients.
    ///
    /// # Errors
    /// Input errors that name the file, the key, what was found and what is allowed.
    pub fn load(path: &Path) -> Result<Self> {
        Self::parse(path, &toml_file::read(path)?)
    }

    /// Checks the text of a file of coefficients that came from `path`.
    ///
    /// # Errors
    /// As [`CoefficientSets::load`].
    pub fn parse(path: &Path, text: &str) -> Result<Self> {
        let file: CoefficientsFile = toml_file::parse(path, text)?;
        let count = file.coefficients.len();
        let rows: [Coefficient; 8] = file.coefficients.try_into().map_err(|_| {
            InputError::key(path, "coefficients", format!("{count} entries"), "8 entries, C_1 to C_8")
        })?;
        for (index, row) in rows.iter().enumerate() {
            row.check(path, index)?;
        }
        Ok(Self {
            source: file.source,
            lower: std::array::from_fn(|l| rows[l].lower),
            best_fit: std::array::from_fn(|l| rows[l].best_fit),
            upper: std::array::from_fn(|l| rows[l].upper),
        })
    }
}

impl Coefficient {
    fn check(&self, path: &Path, index: usize) -> Result<()> {
        let key = |field: &str| format!("coefficients[{index}].{field}");
        let name = format!("C_{}", index + 1);
        if self.name != name {
            return Err(InputError::key(
                path,
                key("name"),
                &self.name,
                format!("{name}: C_1 to C_8 in order"),
            )
            .into());
        }
        let (from, to) = CHANGES[index];
        if (self.from.as_str(), self.to.as_str()) != (from, to) {
            let found = format!("{} to {}", self.from, self.to);
            return Err(
                InputError::key(path, key("from"), found, format!("{from} to {to} for {name}")).into()
            );
        }
        let ordered = 0.0 <= self.lower
            && self.lower <= self.best_fit
            && self.best_fit <= self.upper
            && self.upper <= 2.0;
        if !ordered {
            let found = format!("{} ≤ {} ≤ {}", self.lower, self.best_fit, self.upper);
            return Err(
                InputError::key(path, key("best_fit"), found, "0 ≤ lower ≤ best_fit ≤ upper ≤ 2").into()
            );
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE_2: &str = include_str!("../../../inputs/coefficients.toml");

    #[test]
    fn published_table_2_is_read_in_order() {
        let sets = CoefficientSets::parse(Path::new("c.toml"), TABLE_2).expect("the repository's own file");
        assert_eq!(sets.best_fit, [0.93, 1.03, 0.825, 0.985, 0.865, 0.76, 0.98, 0.94]);
        assert_eq!(sets.lower, [0.9, 0.9, 0.8, 0.8, 0.8, 0.7, 0.9, 0.9]);
        assert_eq!(sets.upper, [1.05, 1.05, 1.0, 1.0, 1.0, 0.8, 1.0, 1.0]);
    }

    #[test]
    fn rejects_wrong_order_changes_and_bounds() {
        let refused = |from: &str, to: &str| {
            let text = TABLE_2.replacen(from, to, 1);
            assert_ne!(text, TABLE_2, "the test must change the file");
            CoefficientSets::parse(Path::new("c.toml"), &text).expect_err("must be refused").to_string()
        };
        assert!(refused("\"C_2\"", "\"C_3\"").contains("coefficients[1].name: found C_3"));
        assert!(refused("to = \"2b\"", "to = \"3b\"").contains("found 1a to 3b; allowed: 1a to 2b for C_3"));
        assert!(refused("best_fit = 0.930", "best_fit = 0.5").contains("coefficients[0].best_fit"));
        assert!(refused("best_fit = 0.930", "best_fit = nan").contains("coefficients[0].best_fit"));
    }
}
