//! Static laws of the joints, held against what releases ask for.
//!
//! Each is fitted to the rows of one release, with a loss near closing that is the same for all: a moment against the
//! rate, which two numbers let fall to nothing at a tenth of the thickness. What it leaves is told of that release and
//! of the others, which it was not fitted to.

use super::moment::{Measurement, Row};
use super::strip::HeldStrip;
use crate::least_squares::newton_step;
use nalgebra::{DMatrix, DVector};

/// A static law of the joints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LawKind {
    /// The full moment at once.
    Sharp,
    /// A bed of springs without tension in each joint.
    Bed,
    /// Three lines of force against displacement: first stiffness, plateau, a fall beside the rigid line (Doherty et al.
    /// 2002).
    Trilinear,
    /// Edges worn to an arc: each joint turns about a place that moves outwards as it opens.
    Rounded,
}

/// A law with its numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Law {
    /// Which.
    pub kind: LawKind,
    /// Its numbers, in the order of [`LawKind::numbers`].
    pub values: Vec<f64>,
}

/// A law fitted to a release.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedLaw {
    /// The law.
    pub law: Law,
    /// Name of the test it was fitted to.
    pub fitted_to: String,
    /// Root mean square of what it leaves, by release, in shares of the moment of sharp edges.
    pub left: Vec<f64>,
}

/// A number of a law: name with unit, and the range in which it is sought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LawNumber {
    /// Name.
    pub name: &'static str,
    /// From and to.
    pub range: [f64; 2],
    /// Whether it is sought by its logarithm.
    by_size: bool,
}

const fn sized(name: &'static str, from: f64, to: f64) -> LawNumber {
    LawNumber { name, range: [from, to], by_size: true }
}

const fn even(name: &'static str, from: f64, to: f64) -> LawNumber {
    LawNumber { name, range: [from, to], by_size: false }
}

impl LawKind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Sharp, Self::Bed, Self::Trilinear, Self::Rounded];

    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sharp => "sharp",
            Self::Bed => "bed",
            Self::Trilinear => "trilinear",
            Self::Rounded => "rounded",
        }
    }

    /// Its numbers.
    pub fn numbers(self) -> &'static [LawNumber] {
        // Lengths are shares of the thickness; forces shares of the largest of the rigid line.
        const BED: [LawNumber; 1] = [sized("stiffness_pa_per_m", 1e6, 1e10)];
        const TRILINEAR: [LawNumber; 3] =
            [sized("first_stiffness", 1.0, 1e3), even("plateau", 0.1, 1.0), even("end", 0.3, 1.0)];
        const ROUNDED: [LawNumber; 2] = [even("worn_width", 0.0, 0.5), sized("radius", 0.01, 1e3)];
        match self {
            Self::Sharp => &[],
            Self::Bed => &BED,
            Self::Trilinear => &TRILINEAR,
            Self::Rounded => &ROUNDED,
        }
    }
}

impl Law {
    /// Share of the moment of sharp edges at a displacement of the crack over the thickness, 0 or more.
    pub fn share(&self, strip: &HeldStrip, displacement: f64) -> f64 {
        match (self.kind, &self.values[..]) {
            (LawKind::Bed, &[stiffness]) => {
                let beds = strip.beds(stiffness);
                strip.share(displacement, |joint, phi| beds[joint].moment_n_m(phi))
            }
            // The share is the force over that of the rigid line, and what leaning has taken of it.
            (LawKind::Trilinear, &[stiffness, plateau, end]) => {
                let force = (stiffness * displacement).min(plateau).min(end - displacement);
                force + strip.leaning(displacement)
            }
            (LawKind::Rounded, &[worn, radius]) => strip.share(displacement, |joint, phi| {
                // The arc meets the flat of the joint at b/2 - a, and has turned about b/2 - a + R sin φ.
                strip.at_share(joint, (1.0 - 2.0 * worn + 2.0 * radius * phi.sin()).min(1.0))
            }),
            _ => 1.0,
        }
    }
}

/// Every law fitted to every release.
pub(super) fn fitted(strip: &HeldStrip, releases: &[Measurement]) -> Vec<FittedLaw> {
    let each = LawKind::ALL.into_iter().flat_map(|kind| releases.iter().map(move |release| (kind, release)));
    each.map(|(kind, release)| {
        let law = Law { kind, values: sought(strip, kind, &release.rows) };
        let loss = Losses::of(strip, &law, &release.rows).map(|found| found.values);
        let left = releases.iter().map(|other| left(strip, &law, &other.rows, loss.as_ref())).collect();
        FittedLaw { law, fitted_to: release.moment.test.clone(), left }
    })
    .collect()
}

/// Places of a number on each grid, and grids one inside the other.
const PLACES: usize = 9;
const GRIDS: usize = 6;

/// The numbers of least error: the best of a grid, then of a grid about it, and so on.
fn sought(strip: &HeldStrip, kind: LawKind, rows: &[Row]) -> Vec<f64> {
    let numbers = kind.numbers();
    let scale = |n: &LawNumber, x: f64| if n.by_size { x.ln() } else { x };
    let mut ranges = numbers.iter().map(|n| n.range.map(|x| scale(n, x))).collect::<Vec<_>>();
    let at = |place: &[f64]| -> Vec<f64> {
        place.iter().zip(numbers).map(|(x, n)| if n.by_size { x.exp() } else { *x }).collect()
    };
    let mut best = (f64::INFINITY, Vec::new());
    for _ in 0..GRIDS {
        for place in grid(&ranges) {
            let law = Law { kind, values: at(&place) };
            let error = Losses::of(strip, &law, rows).map_or(f64::INFINITY, |found| found.left);
            if error < best.0 {
                best = (error, place);
            }
        }
        for ((range, middle), n) in ranges.iter_mut().zip(&best.1).zip(numbers) {
            let step = (range[1] - range[0]) / (PLACES - 1) as f64;
            let [low, high] = n.range.map(|x| scale(n, x));
            *range = [(middle - step).max(low), (middle + step).min(high)];
        }
    }
    at(&best.1)
}

/// All places of a grid over ranges.
fn grid(ranges: &[[f64; 2]]) -> Vec<Vec<f64>> {
    let mut places = vec![Vec::new()];
    for [from, to] in ranges {
        let values = (0..PLACES).map(|k| from + (to - from) * k as f64 / (PLACES - 1) as f64);
        let values = values.collect::<Vec<_>>();
        let with = |place: &Vec<f64>| {
            values.iter().map(|value| [&place[..], &[*value]].concat()).collect::<Vec<_>>()
        };
        places = places.iter().flat_map(with).collect();
    }
    places
}

/// Displacements over the thickness between which the loss near closing falls.
const LOSS_ENDS: [f64; 3] = [0.0, 0.05, 0.1];

/// The loss that goes with a law.
struct Losses {
    values: DVector<f64>,
    left: f64,
}

impl Losses {
    fn of(strip: &HeldStrip, law: &Law, rows: &[Row]) -> Option<Self> {
        let terms = loss_terms(rows);
        let asked = beyond(strip, law, rows);
        let values = newton_step(&terms, &-&asked)?;
        let left = (&asked - &terms * &values).norm() / (rows.len() as f64).sqrt();
        Some(Self { values, left })
    }
}

/// What a law leaves of a release with a loss from another.
fn left(strip: &HeldStrip, law: &Law, rows: &[Row], loss: Option<&DVector<f64>>) -> f64 {
    let asked = beyond(strip, law, rows);
    let left = loss.map_or(asked.clone(), |loss| &asked - loss_terms(rows) * loss);
    left.norm() / (rows.len() as f64).sqrt()
}

/// What rows ask for beyond a static law.
fn beyond(strip: &HeldStrip, law: &Law, rows: &[Row]) -> DVector<f64> {
    let by_law = |row: &Row| row.nodes.iter().map(|n| n.of_share * law.share(strip, n.displacement)).sum::<f64>();
    DVector::from_iterator(rows.len(), rows.iter().map(|row| row.asked - by_law(row)))
}

/// What losses of one at the first two of [`LOSS_ENDS`] add to the rows.
fn loss_terms(rows: &[Row]) -> DMatrix<f64> {
    let [start, middle, end] = LOSS_ENDS;
    let hats = |x: f64| {
        let falls = ((middle - x) / (middle - start)).clamp(0.0, 1.0);
        [falls, (1.0 - falls).min(((end - x) / (end - middle)).max(0.0))]
    };
    DMatrix::from_fn(rows.len(), 2, |row, column| {
        rows[row].nodes.iter().map(|node| node.of_rate * hats(node.displacement)[column]).sum()
    })
}
