//! Intensity expressions: products and quotients of columns and constants, such as `pga_g*9.80665*pgv_over_pga_s`.
//!
//! ```text
//! expression = factor { ("*" | "/") factor }
//! factor     = number | name | '"' any column name '"'
//! ```

/// A product of columns and a constant.
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    constant: f64,
    /// Columns, and whether they multiply (or divide).
    columns: Vec<(String, bool)>,
}

/// Why a text is no expression.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{found} at character {position} of {text:?}")]
pub struct NotAnExpression {
    /// The whole text.
    pub text: String,
    /// What stands there.
    pub found: String,
    /// Where, from 1.
    pub position: usize,
}

/// What may stand in an expression, for messages.
pub const ALLOWED: &str = "columns and constants above 0 joined by * and /, such as pga_g*9.80665*pgv_over_pga_s; other names in \"…\"";

impl Expression {
    /// Parses an expression.
    ///
    /// # Errors
    /// [`NotAnExpression`] with the place of the fault: an operator or factor missing, a constant not above 0, no column.
    pub fn parse(text: &str) -> Result<Self, NotAnExpression> {
        let mut rest = Rest { text, at: 0 };
        let mut expression = Self { constant: 1.0, columns: Vec::new() };
        let mut multiplies = true;
        loop {
            rest.factor(&mut expression, multiplies)?;
            multiplies = match rest.operator()? {
                None => break,
                Some(multiplies) => multiplies,
            };
        }
        if expression.columns.is_empty() {
            return Err(rest.fault("no column before the end"));
        }
        Ok(expression)
    }

    /// The columns it needs, in order.
    pub fn columns(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|(name, _)| name.as_str())
    }

    /// The column, where the expression is one column and nothing else.
    pub fn as_column(&self) -> Option<&str> {
        match &self.columns[..] {
            [(name, true)] if self.constant == 1.0 => Some(name),
            _ => None,
        }
    }

    /// The value, from those of the columns in order.
    pub fn value(&self, columns: impl IntoIterator<Item = f64>) -> f64 {
        let factors = self.columns.iter().zip(columns);
        factors.fold(
            self.constant,
            |product, ((_, multiplies), value)| {
                if *multiplies { product * value } else { product / value }
            },
        )
    }
}

/// What is left to parse.
struct Rest<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Rest<'a> {
    fn left(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn skip_spaces(&mut self) {
        self.at = self.text.len() - self.left().trim_start().len();
    }

    fn take(&mut self, length: usize) -> &'a str {
        let taken = &self.left()[..length];
        self.at += length;
        taken
    }

    fn fault(&self, found: impl Into<String>) -> NotAnExpression {
        let position = self.text[..self.at].chars().count() + 1;
        NotAnExpression { text: self.text.to_owned(), found: found.into(), position }
    }

    /// Whether the next factor multiplies or divides; none at the end.
    fn operator(&mut self) -> Result<Option<bool>, NotAnExpression> {
        self.skip_spaces();
        match self.left().chars().next() {
            None => Ok(None),
            Some(sign @ ('*' | '/')) => {
                self.at += 1;
                Ok(Some(sign == '*'))
            }
            Some(other) => Err(self.fault(format!("{other:?}"))),
        }
    }

    fn factor(&mut self, into: &mut Expression, multiplies: bool) -> Result<(), NotAnExpression> {
        self.skip_spaces();
        match self.left().chars().next() {
            Some('"') => self.quoted().map(|name| into.columns.push((name, multiplies))),
            Some(c) if c.is_ascii_digit() || c == '.' => {
                let value = self.number()?;
                into.constant = if multiplies { into.constant * value } else { into.constant / value };
                Ok(())
            }
            Some(c) if c.is_alphabetic() || c == '_' => {
                let name = self.take_while(|c| c.is_alphanumeric() || c == '_').to_owned();
                into.columns.push((name, multiplies));
                Ok(())
            }
            Some(other) => Err(self.fault(format!("{other:?}"))),
            None => Err(self.fault("the end")),
        }
    }

    fn take_while(&mut self, belongs: impl Fn(char) -> bool) -> &'a str {
        let left = self.left();
        self.take(left.find(|c| !belongs(c)).unwrap_or(left.len()))
    }

    fn quoted(&mut self) -> Result<String, NotAnExpression> {
        let name = self.left()[1..].split_once('"').map(|(name, _)| name);
        match name {
            Some(name) if !name.is_empty() => {
                self.at += name.len() + 2;
                Ok(name.to_owned())
            }
            Some(_) => Err(self.fault("an empty name")),
            None => Err(self.fault("a name without its closing \"")),
        }
    }

    fn number(&mut self) -> Result<f64, NotAnExpression> {
        let start = self.at;
        self.take_while(|c| c.is_ascii_digit() || c == '.');
        if self.left().starts_with(['e', 'E']) {
            self.at += 1;
            self.at += usize::from(self.left().starts_with(['+', '-']));
            self.take_while(|c| c.is_ascii_digit());
        }
        let digits = &self.text[start..self.at];
        match digits.parse::<f64>() {
            Ok(value) if value.is_normal() && value > 0.0 => Ok(value),
            _ => {
                self.at = start;
                Err(self.fault(format!("constant {digits:?}")))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_products_and_quotients() {
        let expression = Expression::parse(" pga_g * 9.5*\"PGV / PGA (s)\" /2e+1").expect("valid");
        assert_eq!(expression.columns().collect::<Vec<_>>(), ["pga_g", "PGV / PGA (s)"]);
        assert_eq!(expression.value([2.0, 4.0]), 9.5 / 20.0 * 2.0 * 4.0);
        assert_eq!(Expression::parse("a/b").expect("valid").value([1.0, 4.0]), 0.25);
        assert_eq!(Expression::parse("pgv_m_s").expect("valid").as_column(), Some("pgv_m_s"));
        assert_eq!(Expression::parse("2*pgv_m_s").expect("valid").as_column(), None);
    }

    #[test]
    fn rejects_everything_else_with_its_place() {
        let faults = [
            ("", "the end", 1),
            ("a*", "the end", 3),
            ("a b", "'b'", 3),
            ("a+b", "'+'", 2),
            ("(a)", "'('", 1),
            ("a*-2", "'-'", 3),
            ("a*0", "constant \"0\"", 3),
            ("a*1.2.3", "constant \"1.2.3\"", 3),
            ("a*1e999", "constant \"1e999\"", 3),
            ("9.81", "no column before the end", 5),
            ("\"a", "a name without its closing \"", 1),
            ("a**b", "'*'", 3),
        ];
        for (text, found, position) in faults {
            let fault = Expression::parse(text).expect_err(text);
            assert_eq!((fault.found.as_str(), fault.position), (found, position), "{text}");
        }
    }
}
