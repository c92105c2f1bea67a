//! A force without a formula: a curve of displacement and one of velocity, straight between knots, nothing at rest.

use mrbd_formula::{Formula, Parameter, Place};
use mrbd_statistics::normal::NINETY_PERCENT;

/// Knots on either side of rest, as shares of the largest displacement or velocity: closer where laws bend most.
const KNOTS: [f64; 6] = [0.08, 0.2, 0.36, 0.54, 0.76, 1.0];
/// Knots on a side.
pub const SIDE: usize = KNOTS.len();
/// Knots on both.
pub const BOTH: usize = 2 * SIDE;

/// A force against displacement and velocity of the top: two curves that add up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve {
    /// Of displacement, m, and of velocity, m/s.
    pub parts: [Part; 2],
}

/// A curve of one quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    /// Where it is told, increasing; rest lies between both sides, and the force is 0 there.
    pub at: [f64; BOTH],
    /// Force on the wall, N.
    pub force_n: [f64; BOTH],
    /// Its standard deviation, N.
    pub sd_n: [f64; BOTH],
}

impl Part {
    /// Both sides alike, as far as the tests went on either.
    pub fn at([least, most]: [f64; 2]) -> [f64; BOTH] {
        let reach = most.max(-least);
        std::array::from_fn(|k| reach * if k < SIDE { -KNOTS[SIDE - 1 - k] } else { KNOTS[k - SIDE] })
    }

    /// Whether it has a force at all.
    pub fn acts(&self) -> bool {
        self.force_n.iter().any(|force| *force != 0.0)
    }

    /// Largest force at a knot, N.
    pub fn largest_n(&self) -> f64 {
        self.force_n.iter().fold(0.0, |most, force| most.max(force.abs()))
    }

    /// Shares of the values at the knots that make the force at a place. Beyond the last knot the line goes on.
    pub fn shares(at: &[f64; BOTH], x: f64) -> [f64; BOTH] {
        let mut shares = [0.0; BOTH];
        let outwards = |k: usize| if x < 0.0 { SIDE - 1 - k } else { SIDE + k };
        let knot = |k: usize| at[outwards(k)];
        let next = (0..SIDE).find(|k| x.abs() <= knot(*k).abs()).unwrap_or(SIDE - 1);
        let before = if next == 0 { 0.0 } else { knot(next - 1) };
        let share = (x - before) / (knot(next) - before);
        shares[outwards(next)] = share;
        if next > 0 {
            shares[outwards(next - 1)] = 1.0 - share;
        }
        shares
    }

    /// Force and its standard deviation, N; the latter as between neighbours that err together.
    pub fn force_n(&self, x: f64) -> [f64; 2] {
        let shares = Self::shares(&self.at, x);
        [&self.force_n, &self.sd_n].map(|of| shares.iter().zip(of).map(|(s, f)| s * f).sum::<f64>())
    }

    /// Force with its 90 % interval, N: what points and windows leave open, and how far a smooth force may lie from straight pieces.
    pub fn told_n(&self, x: f64) -> (f64, [f64; 2]) {
        let [force_n, sd_n] = self.force_n(x);
        let sag_n =
            Self::shares(&self.at, x).iter().zip(self.sags_n()).map(|(share, sag)| share * sag).sum::<f64>();
        let half_n = (NINETY_PERCENT * sd_n).hypot(sag_n);
        (force_n, [-1.0, 1.0].map(|side| force_n + side * half_n))
    }

    /// How far a smooth force lies from straight pieces that are fitted to it, by its curvature at each knot: f'' h²/12 there and half of that
    /// between, for the longer piece beside it. At a last knot as at its neighbour.
    fn sags_n(&self) -> [f64; BOTH] {
        let at = |k: usize| match k.cmp(&SIDE) {
            std::cmp::Ordering::Less => (self.at[k], self.force_n[k]),
            std::cmp::Ordering::Equal => (0.0, 0.0),
            std::cmp::Ordering::Greater => (self.at[k - 1], self.force_n[k - 1]),
        };
        let sag = |k: usize| {
            let [(a, f_a), (b, f_b), (c, f_c)] = [k - 1, k, k + 1].map(at);
            let bend = (f_c - f_b) / (c - b) - (f_b - f_a) / (b - a);
            let curvature = 2.0 * bend / (c - a);
            curvature.abs() * (b - a).max(c - b).powi(2) / 12.0
        };
        // Rest is a knot, too, where nothing is told.
        std::array::from_fn(|k| sag((if k < SIDE { k } else { k + 1 }).clamp(1, BOTH - 1)))
    }

    /// Slope of the first piece on a side, then the changes of slope at its knots but the last.
    fn bends(&self, side: f64) -> [f64; SIDE] {
        let outwards = |k: usize| if side < 0.0 { SIDE - 1 - k } else { SIDE + k };
        let (mut before, mut slope) = ((0.0, 0.0), 0.0);
        std::array::from_fn(|k| {
            let here = (self.at[outwards(k)].abs(), self.force_n[outwards(k)]);
            let own = (here.1 - before.1) / (here.0 - before.0);
            let bend = own - slope;
            (before, slope) = (here, own);
            bend
        })
    }
}

impl Curve {
    /// Its knots with a number to be found: which part and which knot.
    pub fn knots(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let acts = self.parts.map(|part| part.acts());
        (0..2).filter(move |p| acts[*p]).flat_map(|p| (0..BOTH).map(move |k| (p, k)))
    }

    /// The same with forces at these knots, in their order, and with their standard deviations where these are known; N.
    #[must_use]
    pub fn with_forces(&self, force_n: &[f64], sd_n: Option<&[f64]>) -> Self {
        let mut curve = *self;
        for (i, (p, k)) in self.knots().enumerate() {
            curve.parts[p].force_n[k] = force_n[i];
            if let Some(sd_n) = sd_n {
                curve.parts[p].sd_n[k] = sd_n[i];
            }
        }
        curve
    }

    /// As it is written into wall files; `None` where it is refused.
    pub fn formula(&self) -> Option<Formula> {
        let (mut text, mut parameters) = (Vec::new(), Vec::new());
        let names = [("x", ["N/m", "m"]), ("v", ["N*s/m", "m/s"])];
        for (part, (x, unit)) in self.parts.iter().zip(names).filter(|(part, _)| part.acts()) {
            // Knots are shares of the farthest: parameters of a formula are few.
            parameters.push(Parameter::new(&format!("{x}_r"), part.at[BOTH - 1], unit[1]));
            for (side, sign, letter) in [(-1.0, "-", 'n'), (1.0, "", 'p')] {
                for (k, bend) in part.bends(side).into_iter().enumerate() {
                    let name = format!("{x}{letter}_{k}");
                    parameters.push(Parameter::new(&name, bend, unit[0]));
                    text.push(match k {
                        0 => format!("{name}*max({sign}{x},0)"),
                        _ => format!("{name}*max({sign}{x}-{}*{x}_r,0)", KNOTS[k - 1]),
                    });
                }
            }
        }
        Formula::parse(&text.join(" + "), Place::Top, &parameters).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_the_formula_of_a_curve_is_the_curve() {
        let at = |reach: f64| Part::at([-0.8 * reach, reach]);
        let part = |reach: f64, of: fn(f64) -> f64| Part {
            at: at(reach),
            force_n: at(reach).map(of),
            sd_n: [1.0; BOTH],
        };
        let curve =
            Curve { parts: [part(0.05, |x| 1e4 * x * x - 2e3 * x), part(0.3, |v| -90.0 * v * v.abs())] };
        let formula = curve.formula().expect("a formula");
        for (x, v) in [(0.03, -0.2), (-0.01, 0.001), (0.05, 0.3), (-0.06, -0.35), (0.0, 0.0)] {
            let own = curve.parts[0].force_n(x)[0] + curve.parts[1].force_n(v)[0];
            // Two ways to the same sum of some tens of newtons.
            assert!((formula.value([x, v, 0.0]) - own).abs() < 1e-9, "{x}, {v}: {own} in {formula}");
        }
    }

    #[test]
    fn analytic_the_band_of_a_curve_has_what_straight_pieces_cannot_follow() {
        let half_n = |of: fn(f64) -> f64, x: f64| {
            let at = Part::at([-1.0, 1.0]);
            let (_, [low, high]) = Part { at, force_n: at.map(of), sd_n: [0.0; BOTH] }.told_n(x);
            0.5 * (high - low)
        };
        assert!(half_n(|x| 30.0 * x, 0.5) < 1e-12, "a line has no curvature");
        // Curvature of 60 N/m², and pieces of 0.18 m before and 0.22 m after the knot.
        let own = half_n(|x| 30.0 * x * x.abs(), 0.54);
        assert!((own - 60.0 * 0.22 * 0.22 / 12.0).abs() < 1e-9, "{own} N");
        // As at rest, where it bends the other way, and as at the knot before the last.
        assert!(half_n(|x| 30.0 * x * x.abs(), -0.54) == own);
        let [last, before] = [1.0, 0.76].map(|x| half_n(|x| 30.0 * x * x.abs(), x));
        assert!((last - before).abs() < 1e-9, "{last} and {before} N");
    }
}
