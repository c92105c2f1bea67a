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

impl LawNumber {
    fn scaled(&self, value: f64) -> f64 {
        if self.by_size { value.ln() } else { value }
    }

    fn value(&self, scaled: f64) -> f64 {
        if self.by_size { scaled.exp() } else { scaled }
    }
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
    let asked = releases.iter().map(|release| Asked::of(&release.rows)).collect::<Vec<_>>();
    let each = LawKind::ALL.into_iter().flat_map(|kind| (0..releases.len()).map(move |own| (kind, own)));
    each.map(|(kind, own)| {
        let law = asked[own].best(strip, kind);
        let loss = asked[own].loss(strip, &law);
        let left = |other: &Asked| other.left(&other.beyond(strip, &law), loss.as_ref());
        let left = asked.iter().map(left).collect();
        FittedLaw { law, fitted_to: releases[own].moment.test.clone(), left }
    })
    .collect()
}

/// Places of a number on each grid, and grids one inside the other: 3⁵ and more between the first places.
const PLACES: usize = 7;
const GRIDS: usize = 6;

/// Displacements over the thickness at which laws are read, straight between: a plateau's ends move by less.
const TABLE_STEP: f64 = 0.0025;
const TABLE: usize = 401;

/// Displacements over the thickness between which the loss near closing falls.
const LOSS_ENDS: [f64; 3] = [0.0, 0.05, 0.1];

/// What the rows of a release ask for, as sums over a table of displacements.
struct Asked {
    asked: DVector<f64>,
    by_share: DMatrix<f64>,
    by_loss: DMatrix<f64>,
}

impl Asked {
    fn of(rows: &[Row]) -> Self {
        let mut by_share = DMatrix::zeros(rows.len(), TABLE);
        let mut by_loss = DMatrix::zeros(rows.len(), 2);
        for (k, row) in rows.iter().enumerate() {
            for node in &row.nodes {
                let place = (node.displacement / TABLE_STEP).min((TABLE - 1) as f64 - 1e-9);
                let (before, share) = (place.floor() as usize, place.fract());
                by_share[(k, before)] += (1.0 - share) * node.of_share;
                by_share[(k, before + 1)] += share * node.of_share;
                let falls = loss_hats(node.displacement);
                (0..2).for_each(|column| by_loss[(k, column)] += falls[column] * node.of_rate);
            }
        }
        let asked = DVector::from_iterator(rows.len(), rows.iter().map(|row| row.asked));
        Self { asked, by_share, by_loss }
    }

    /// What is asked for beyond a static law.
    fn beyond(&self, strip: &HeldStrip, law: &Law) -> DVector<f64> {
        let shares = DVector::from_fn(TABLE, |k, _| law.share(strip, TABLE_STEP * k as f64));
        &self.asked - &self.by_share * shares
    }

    /// The loss that goes best with a law.
    fn loss(&self, strip: &HeldStrip, law: &Law) -> Option<DVector<f64>> {
        newton_step(&self.by_loss, &-self.beyond(strip, law))
    }

    /// Root mean square of what is left with a loss.
    fn left(&self, beyond: &DVector<f64>, loss: Option<&DVector<f64>>) -> f64 {
        let left = loss.map_or(beyond.clone(), |loss| beyond - &self.by_loss * loss);
        left.norm() / (beyond.len() as f64).sqrt()
    }

    /// The law of least error: the best of a grid, then of a grid about it, and so on.
    fn best(&self, strip: &HeldStrip, kind: LawKind) -> Law {
        let numbers = kind.numbers();
        let mut ranges = numbers.iter().map(|n| n.range.map(|x| n.scaled(x))).collect::<Vec<_>>();
        let at = |place: &[f64]| place.iter().zip(numbers).map(|(x, n)| n.value(*x)).collect::<Vec<_>>();
        let mut best = (f64::INFINITY, vec![0.0; numbers.len()]);
        for _ in 0..GRIDS {
            for place in grid(&ranges) {
                let beyond = self.beyond(strip, &Law { kind, values: at(&place) });
                let loss = newton_step(&self.by_loss, &-&beyond);
                let error = self.left(&beyond, loss.as_ref());
                if error < best.0 {
                    best = (error, place);
                }
            }
            for ((range, middle), n) in ranges.iter_mut().zip(&best.1).zip(numbers) {
                let step = (range[1] - range[0]) / (PLACES - 1) as f64;
                let [low, high] = n.range.map(|x| n.scaled(x));
                *range = [(middle - step).max(low), (middle + step).min(high)];
            }
        }
        Law { kind, values: at(&best.1) }
    }
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

/// Shares of losses of one at the first two of [`LOSS_ENDS`].
fn loss_hats(displacement: f64) -> [f64; 2] {
    let [start, middle, end] = LOSS_ENDS;
    let falls = ((middle - displacement) / (middle - start)).clamp(0.0, 1.0);
    let beyond = ((end - displacement) / (end - middle)).clamp(0.0, 1.0);
    [falls, (1.0 - falls).min(beyond)]
}
