//! An axis of a graph: linear, logarithmic, or a list of names.

/// How values are spread along an axis.
#[derive(Debug, Clone, PartialEq)]
enum Scale {
    Linear,
    Log,
    Names(Vec<String>),
    Unmarked,
}

/// An axis: its label with the unit, and the values it shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Label with the unit.
    pub label: String,
    from: f64,
    to: f64,
    scale: Scale,
    zone: Option<&'static str>,
}

impl Axis {
    /// A linear axis from one value to another.
    pub fn linear(label: &str, from: f64, to: f64) -> Self {
        // A single value has no length; it stands in the middle.
        let (from, to) = if to > from { (from, to) } else { (from - 0.5, from + 0.5) };
        Self { label: label.to_owned(), from, to, scale: Scale::Linear, zone: None }
    }

    /// A linear axis from 0 to a round number not below the values, or between round numbers if some are negative.
    pub fn holding(label: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let (low, high) = range(values);
        let size = rounded_up(1.02 * high.max(-low).max(f64::MIN_POSITIVE));
        let below = if low < 0.0 { -rounded_up(-1.02 * low).max(0.25 * size) } else { 0.0 };
        Self::linear(label, below, if high > 0.0 { rounded_up(1.02 * high).max(-0.25 * below) } else { 0.0 })
    }

    /// A logarithmic axis with a little room around the positive ones of the values.
    pub fn log_holding(label: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let positive = values.into_iter().filter(|v| v.is_finite() && *v > 0.0);
        let (low, high) = positive.fold((f64::MAX, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
        let (low, high) = if high > 0.0 { (low, high) } else { (0.1, 1.0) };
        let room = (high / low).powf(0.04).max(1.1);
        Self { label: label.to_owned(), from: low / room, to: high * room, scale: Scale::Log, zone: None }
    }

    /// Names, the first at the end where values would be largest; the n-th stands at n.
    pub fn names(label: &str, names: Vec<String>) -> Self {
        let to = names.len() as f64 - 0.5;
        Self { label: label.to_owned(), from: to, to: -0.5, scale: Scale::Names(names), zone: None }
    }

    /// From 0 to 1 without ticks.
    pub fn unmarked(label: &str) -> Self {
        Self { label: label.to_owned(), from: 0.0, to: 1.0, scale: Scale::Unmarked, zone: None }
    }

    /// With a zone above its end, for what lies beyond all numbers.
    pub fn with_zone(self, name: &'static str) -> Self {
        Self { zone: Some(name), ..self }
    }

    /// Name of the zone above its end; `None` where there is none.
    pub fn zone(&self) -> Option<&'static str> {
        self.zone
    }

    /// Whether it has no ticks.
    pub fn is_unmarked(&self) -> bool {
        self.scale == Scale::Unmarked
    }

    /// Where a value stands along the axis, 0 at its start to 1 at its end; values beyond stand at the ends.
    pub fn share(&self, value: f64) -> f64 {
        let along = |v: f64| if self.scale == Scale::Log { v.max(f64::MIN_POSITIVE).ln() } else { v };
        let (from, to) = (along(self.from), along(self.to));
        ((along(value) - from) / (to - from)).clamp(0.0, 1.0)
    }

    /// The values at its start and its end.
    pub fn ends(&self) -> [f64; 2] {
        [self.from, self.to]
    }

    /// Whether a value lies on the axis.
    pub fn holds(&self, value: f64) -> bool {
        let (low, high) = (self.from.min(self.to), self.from.max(self.to));
        (low..=high).contains(&value)
    }

    /// Places with their texts, `most` of them at most; names have all theirs.
    pub fn ticks(&self, most: usize) -> Vec<(f64, String)> {
        match &self.scale {
            Scale::Names(names) => (0..).map(f64::from).zip(names.iter().cloned()).collect(),
            Scale::Linear => self.linear_ticks(most),
            Scale::Log => self.log_ticks(most),
            Scale::Unmarked => Vec::new(),
        }
    }

    fn linear_ticks(&self, most: usize) -> Vec<(f64, String)> {
        let least = (self.to - self.from) / most.max(1) as f64;
        let power = 10f64.powf(least.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|step| *step >= least * 0.999);
        let step = step.unwrap_or(10.0 * power);
        let first = (self.from / step - 1e-9).ceil() as i64;
        let last = (self.to / step + 1e-9).floor() as i64;
        (first..=last).map(|k| k as f64 * step).map(|v| (v, number(v))).collect()
    }

    fn log_ticks(&self, most: usize) -> Vec<(f64, String)> {
        let decades = self.from.log10().floor() as i32..=self.to.log10().ceil() as i32;
        let of = |digits: &[f64]| -> Vec<f64> {
            let all = decades.clone().flat_map(|k| digits.iter().map(move |d| d * 10f64.powi(k)));
            all.filter(|v| self.holds(*v)).collect()
        };
        let choices =
            [&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0][..], &[1.0, 2.0, 5.0], &[1.0, 3.0], &[1.0]];
        let fits = choices.iter().map(|digits| of(digits)).find(|ticks| ticks.len() <= most);
        fits.unwrap_or_else(|| of(&[1.0])).into_iter().map(|v| (v, number(v))).collect()
    }
}

/// A number beside an axis; very small and very large ones to two digits.
fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        return tick(value);
    }
    let text = format!("{value:.1e}");
    text.replacen(".0e", "e", 1).replace('-', "−")
}

/// A number in as few digits as tell it.
fn tick(value: f64) -> String {
    let text = format!("{value:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text.strip_prefix('-') {
        Some("0") => "0".to_owned(),
        Some(digits) => format!("−{digits}"),
        None => text.to_owned(),
    }
}

/// The least of 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that is not below a positive value.
fn rounded_up(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    let steps = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0];
    let fits = |step: &&f64| **step * power >= value * (1.0 - 1e-9);
    steps.iter().find(fits).unwrap_or(&10.0) * power
}

fn range(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let finite = values.into_iter().filter(|v| v.is_finite());
    finite.fold((0.0_f64, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(axis: &Axis, most: usize) -> Vec<String> {
        axis.ticks(most).into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn analytic_ticks_are_round_and_few() {
        assert_eq!(texts(&Axis::linear("", 0.0, 1.0), 5), ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
        assert_eq!(texts(&Axis::linear("", -3.0, 7.0), 6), ["−2", "0", "2", "4", "6"]);
        assert_eq!(texts(&Axis::linear("", 1e7, 2e7), 2), ["1e7", "1.5e7", "2e7"]);
        assert_eq!(
            texts(&Axis::log_holding("", [0.01, 1.0]), 8),
            ["0.01", "0.02", "0.05", "0.1", "0.2", "0.5", "1"]
        );
        assert_eq!(
            texts(&Axis::log_holding("", [1e-6, 1.0]), 8),
            ["1e−6", "1e−5", "1e−4", "0.001", "0.01", "0.1", "1"]
        );
    }

    #[test]
    fn analytic_shares_run_from_0_to_1() {
        let log = Axis::log_holding("", [0.1, 10.0]);
        assert!((log.share(1.0) - 0.5).abs() < 1e-12 && log.share(0.0) == 0.0 && log.share(1e9) == 1.0);
        let names = Axis::names("", ["a", "b"].map(str::to_owned).to_vec());
        assert!((names.share(0.0) - 0.75).abs() < 1e-12 && (names.share(1.0) - 0.25).abs() < 1e-12);
    }

    #[test]
    fn regress_an_axis_holds_its_values_and_zero() {
        for values in [vec![0.3, 7.0], vec![-0.2, 0.1], vec![-5.0], vec![], vec![f64::NAN, 2.0]] {
            let axis = Axis::holding("", values.iter().copied());
            assert!(
                axis.holds(0.0) && values.iter().filter(|v| v.is_finite()).all(|v| axis.holds(*v)),
                "{axis:?}"
            );
        }
    }

    #[test]
    fn regress_ticks_have_no_idle_digits() {
        assert_eq!([0.0, 0.05, 8.0, -0.00001, -1.25].map(tick), ["0", "0.05", "8", "0", "−1.25"]);
    }

    #[test]
    fn analytic_rounding_up_is_least_and_not_below() {
        for (value, round) in
            [(0.222, 0.25), (0.25, 0.25), (0.81, 1.0), (1.0, 1.0), (37.0, 40.0), (0.003, 0.003)]
        {
            assert!((rounded_up(value) / round - 1.0).abs() < 1e-12, "{value}");
        }
    }
}
