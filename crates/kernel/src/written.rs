//! Numbers in messages.

/// A result of arithmetic as a person would write it, at twelve significant digits.
///
/// ```
/// assert_eq!((0.1 + 0.2).to_string(), "0.30000000000000004");
/// assert_eq!(mrbd_kernel::written(0.1 + 0.2).to_string(), "0.3");
/// ```
pub fn written(value: f64) -> f64 {
    // What was just formatted as a number is one.
    format!("{value:.11e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::written;

    #[test]
    fn regress_last_bits_do_not_reach_messages() {
        assert_eq!(written(3.0000000000000004).to_string(), "3");
        assert_eq!(written(-0.1 * 3.0).to_string(), "-0.3");
        assert_eq!(written(1234.56789).to_string(), "1234.56789");
        assert_eq!(written(0.0), 0.0);
        assert!(written(f64::INFINITY).is_infinite() && written(f64::NAN).is_nan());
    }
}
