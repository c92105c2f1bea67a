//! The moment of the joints of a release as a curve, opening and closing, in least squares.

use super::strip::HeldStrip;
use super::weak::{HALF_S, Support, supports};
use crate::experiment::Test;
use crate::least_squares::newton_step;
use mrbd_statistics::normal::NINETY_PERCENT;
use nalgebra::{DMatrix, DVector};

/// Displacements of the crack over the thickness through which the curve goes; beyond the ends it stays as it is there.
const KNOTS: [f64; 7] = [0.015, 0.04, 0.08, 0.16, 0.3, 0.45, 0.6];
/// A knot that weighs less than so many test functions is not told.
const LEAST_TOLD: f64 = 4.0;
/// Rounds in which the inertia, which the arms decide by a few hundredths, follows the curve: each leaves a tenth.
const ROUNDS: usize = 4;
/// Step of the displacement over which the slope of the inertia is taken.
const SLOPE_STEP: f64 = 1e-3;

/// What one release says.
#[derive(Debug, Clone, PartialEq)]
pub struct ReleaseMoment {
    /// Name of the test.
    pub test: String,
    /// The curve, from the smallest displacement on.
    pub points: Vec<MomentPoint>,
    /// Test functions behind it; neighbours share samples.
    pub test_functions: usize,
    /// Root mean square of what the curve leaves, in shares of the moment of sharp edges.
    pub left: f64,
}

/// The moment at a displacement, as a share of that of sharp edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MomentPoint {
    /// Displacement of the crack over the thickness.
    pub displacement: f64,
    /// Rotation across the crack, rad.
    pub crack_rotation_rad: f64,
    /// While the joints open; `None` where the release does not tell.
    pub opening: Option<Told>,
    /// While they close.
    pub closing: Option<Told>,
}

/// A value and its 90 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Told {
    /// The value.
    pub share: f64,
    /// From and to.
    pub interval_90: [f64; 2],
}

/// One test function: what the joints must have done under it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row {
    time_s: f64,
    /// Share of the moment of sharp edges that the motion asks for.
    pub asked: f64,
    pub nodes: Vec<RowNode>,
}

/// An instant under it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RowNode {
    /// Displacement of the crack over the thickness, without its sign.
    pub displacement: f64,
    /// What a share of 1 there adds to the row.
    pub of_share: f64,
    /// What a share per rad/s of θ_1 adds.
    pub of_rate: f64,
    opens: bool,
}

/// A release, measured.
#[derive(Debug, Clone)]
pub(super) struct Measurement {
    pub rows: Vec<Row>,
    pub moment: ReleaseMoment,
}

impl Measurement {
    /// `None` of a test that is none of a held top, or whose samples are too few.
    pub fn new(strip: &HeldStrip, test: &Test) -> Option<Self> {
        let supports = supports(&samples(test)?);
        let mut curve = Curve([[Some(1.0); KNOTS.len()]; 2]);
        let mut rows = Vec::new();
        let mut fit = None;
        for _ in 0..ROUNDS {
            rows = supports.iter().map(|support| row(strip, support, &curve)).collect::<Vec<_>>();
            let found = Fit::of(&rows)?;
            curve = found.curve();
            fit = Some(found);
        }
        let fit = fit?;
        let moment = ReleaseMoment {
            test: test.name.clone(),
            points: (0..KNOTS.len()).map(|knot| fit.point(strip, knot)).collect(),
            test_functions: rows.len(),
            left: fit.left.norm() / (rows.len() as f64).sqrt(),
        };
        Some(Self { rows, moment })
    }
}

/// θ_1 of a release of a held top against time, from where the wall moves by itself.
fn samples(test: &Test) -> Option<Vec<(f64, f64)>> {
    let (from_s, _) = test.release().filter(|_| test.top_held)?;
    let theta = test.measured.theta_rad[0].as_ref()?;
    let all = test.measured.time_s.iter().copied().zip(theta.iter().copied());
    Some(all.filter(|(t, theta)| *t >= from_s && theta.is_finite()).collect())
}

/// The equation of [`super::strip`] under a test function, for τ.
fn row(strip: &HeldStrip, support: &Support, curve: &Curve) -> Row {
    let (g, p) = (strip.sharp_moment_n_m(), strip.lean_n_m());
    let per_rad = strip.displacement_over_thickness(1.0);
    let at = |x: f64| strip.inertia_kg_m2(curve.middle(x));
    let (mut known, mut weight) = (support.acceleration, 0.0);
    let mut nodes = Vec::with_capacity(support.nodes.len());
    for node in &support.nodes {
        let x = strip.displacement_over_thickness(node.theta.abs());
        let (inertia, before) = (at(x), (x - SLOPE_STEP).max(0.0));
        let after = x + SLOPE_STEP;
        let slope = (at(after) - at(before)) / (after - before) * per_rad * node.theta.signum();
        known += node.weight * (0.5 * slope * node.omega * node.omega - p * node.theta) / inertia;
        let force = node.weight * g / inertia;
        weight += force;
        nodes.push(RowNode {
            displacement: x,
            of_share: force * node.theta.signum(),
            of_rate: force * node.omega,
            opens: node.theta * node.omega > 0.0,
        });
    }
    for node in &mut nodes {
        node.of_share /= weight;
        node.of_rate /= weight;
    }
    Row { time_s: support.time_s, asked: -known / weight, nodes }
}

/// Shares at the knots, opening and closing.
#[derive(Debug, Clone, Copy)]
struct Curve([[Option<f64>; KNOTS.len()]; 2]);

impl Curve {
    /// The mean of both ways, between no moment and that of sharp edges.
    fn middle(&self, displacement: f64) -> f64 {
        let told = |ways: [Option<f64>; 2]| {
            let told = ways.into_iter().flatten().collect::<Vec<_>>();
            told.iter().sum::<f64>() / told.len().max(1) as f64
        };
        let at = |k: usize| told([self.0[0][k], self.0[1][k]]).clamp(0.0, 1.0);
        hats(displacement).map(|(knot, share)| share * at(knot)).iter().sum()
    }
}

/// The two knots about a displacement and their shares.
fn hats(displacement: f64) -> [(usize, f64); 2] {
    let after = KNOTS.partition_point(|knot| *knot <= displacement).clamp(1, KNOTS.len() - 1);
    let share = (displacement - KNOTS[after - 1]) / (KNOTS[after] - KNOTS[after - 1]);
    let share = share.clamp(0.0, 1.0);
    [(after - 1, 1.0 - share), (after, share)]
}

/// Shares at the knots that are told, in least squares.
struct Fit {
    /// Opening from 0 on, closing from `KNOTS.len()` on; each with its column.
    columns: Vec<Option<usize>>,
    values: DVector<f64>,
    covariance: DMatrix<f64>,
    left: DVector<f64>,
}

impl Fit {
    fn of(rows: &[Row]) -> Option<Self> {
        let all = DMatrix::from_rows(&rows.iter().map(|row| of_knots(row).transpose()).collect::<Vec<_>>());
        let told = |column: usize| all.column(column).iter().map(|x| x.abs()).sum::<f64>() >= LEAST_TOLD;
        let kept = (0..all.ncols()).filter(|&column| told(column)).collect::<Vec<_>>();
        let terms = all.select_columns(&kept);
        let asked = DVector::from_iterator(rows.len(), rows.iter().map(|row| row.asked));
        if rows.len() <= kept.len() {
            return None;
        }
        let values = newton_step(&terms, &-&asked)?;
        let left = &asked - &terms * &values;
        let covariance = covariance(rows, &terms, &left)?;
        let columns = (0..all.ncols()).map(|column| kept.iter().position(|k| *k == column)).collect();
        Some(Self { columns, values, covariance, left })
    }

    fn curve(&self) -> Curve {
        let value = |knot: usize| self.columns[knot].map(|column| self.values[column]);
        Curve([0, 1].map(|way| std::array::from_fn(|k| value(way * KNOTS.len() + k))))
    }

    fn point(&self, strip: &HeldStrip, knot: usize) -> MomentPoint {
        let told = |way: usize| {
            let column = self.columns[way * KNOTS.len() + knot]?;
            let (share, half) = (self.values[column], self.covariance[(column, column)].sqrt());
            let ends = [-NINETY_PERCENT, NINETY_PERCENT].map(|sd| share + sd * half);
            Some(Told { share, interval_90: ends })
        };
        let displacement = KNOTS[knot];
        let [_, crack_rotation_rad] = strip.rotations_rad(displacement);
        MomentPoint { displacement, crack_rotation_rad, opening: told(0), closing: told(1) }
    }
}

/// What a share of 1 at each knot adds to a row, opening first.
fn of_knots(row: &Row) -> DVector<f64> {
    let mut terms = DVector::zeros(2 * KNOTS.len());
    for node in &row.nodes {
        let way = if node.opens { 0 } else { KNOTS.len() };
        for (knot, share) in hats(node.displacement) {
            terms[way + knot] += share * node.of_share;
        }
    }
    terms
}

/// Covariance of the values from what is left of the rows, whatever its size and as far as rows share samples (Newey and
/// West 1987, with the weights of Bartlett).
fn covariance(rows: &[Row], terms: &DMatrix<f64>, left: &DVector<f64>) -> Option<DMatrix<f64>> {
    let inverse = (terms.transpose() * terms).cholesky()?.inverse();
    let pulls =
        DMatrix::from_fn(terms.nrows(), terms.ncols(), |row, column| terms[(row, column)] * left[row]);
    let near = |i: usize, k: usize| (1.0 - (rows[i].time_s - rows[k].time_s).abs() / (2.0 * HALF_S)).max(0.0);
    let weights = DMatrix::from_fn(rows.len(), rows.len(), near);
    let middle = pulls.transpose() * weights * pulls;
    let of_few = rows.len() as f64 / (rows.len() - terms.ncols()) as f64;
    Some(&inverse * middle * &inverse * of_few)
}
