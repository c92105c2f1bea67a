//! Units of parameters: products, quotients and powers of SI units, such as `N*(s/m)**1.7`.

use std::collections::BTreeMap;

use crate::dimension::Dimension;
use crate::error::FormulaError;
use crate::expression::{Expression, Operator};
use crate::parse::parse;

/// Units by name, as powers of kg, m and s. None has a prefix: numbers are in SI.
const UNITS: [(&str, [f64; 3]); 10] = [
    ("kg", [1.0, 0.0, 0.0]),
    ("m", [0.0, 1.0, 0.0]),
    ("s", [0.0, 0.0, 1.0]),
    ("N", [1.0, 1.0, -2.0]),
    ("Pa", [1.0, -1.0, -2.0]),
    ("J", [1.0, 2.0, -2.0]),
    ("W", [1.0, 2.0, -3.0]),
    ("Hz", [0.0, 0.0, -1.0]),
    ("rad", [0.0, 0.0, 0.0]),
    ("1", [0.0, 0.0, 0.0]),
];

const ALLOWED: &str = "kg, m, s, N, Pa, J, W, Hz, rad without prefixes, their products, quotients and powers, \
                       such as N/m or N*(s/m)**1.7; 1 or nothing for a pure number";

/// The dimension of a unit. Exponents are numbers, or parameters of the formula without a unit.
///
/// # Errors
/// No unit, or one with a prefix.
pub fn dimension_of(unit: &str, values: &BTreeMap<&str, f64>) -> Result<Dimension, FormulaError> {
    // As people write products: N s/m.
    let text = unit.trim().replace("·", "*").replace('²', "**2").replace('³', "**3");
    if text.is_empty() {
        return Ok(Dimension::NONE);
    }
    let refused = |found: String| FormulaError::new(None, found, ALLOWED);
    let parsed = parse(&text).map_err(|e| refused(format!("`{unit}` ({})", e.found_at())))?;
    of(&parsed.expression, values).map_err(|part| refused(format!("`{part}` in `{unit}`")))
}

fn of(unit: &Expression, values: &BTreeMap<&str, f64>) -> Result<Dimension, Expression> {
    match unit {
        Expression::Number(1.0) => Ok(Dimension::NONE),
        Expression::Name(name) => {
            let known = UNITS.iter().find(|(own, _)| own == name);
            known.map(|(_, powers)| Dimension(*powers)).ok_or_else(|| unit.clone())
        }
        Expression::Binary(Operator::Multiply, a, b) => Ok(of(a, values)?.times(of(b, values)?)),
        Expression::Binary(Operator::Divide, a, b) => Ok(of(a, values)?.times(of(b, values)?.to(-1.0))),
        Expression::Binary(Operator::Power, a, b) => {
            let exponent = b.constant(values).filter(|exponent| exponent.is_finite());
            Ok(of(a, values)?.to(exponent.ok_or_else(|| unit.clone())?))
        }
        other => Err(other.clone()),
    }
}
