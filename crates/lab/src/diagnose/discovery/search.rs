//! Laws of one atom and of two that make up for what is missing, by exhaustive search over points.
//!
//! Every shape at every value of its grid is a column. Singles, and all pairs, are solved in least squares with the
//! wall's uncertain numbers under their priors. The best of each kind is then refined off the grid. The order is the same on
//! every run.

use super::points::Points;
use crate::diagnose::formula::{Atom, Law, LawSlot, Shape, Site};
use crate::limits::{EQUIVALENT, LAW_LENGTH, LAWS_REFINED, RARE_LAW_LENGTH};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Standard deviations beyond which a point counts less (Huber).
const USUAL: f64 = 3.0;
/// Two columns this much alike, as the square of the sine between them, are one.
const ALIKE: f64 = 1e-4;
/// Rounds of the search off the grid, each number in turn.
const ROUNDS: usize = 3;
/// Steps of a golden section in each.
const SECTIONS: usize = 12;

/// A law with what speaks for it over points.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// The law, fitted.
    pub law: Law,
    /// What it gains over the wall's own numbers, its price taken off, in natural logarithms of likelihood.
    pub evidence: f64,
}

/// Points with each row's weight, and everything projected off what the wall's uncertain numbers can do.
#[derive(Debug)]
pub struct Equations<'p> {
    points: &'p Points,
    /// Square roots of the weights.
    weight: DVector<f64>,
    /// Orthonormal columns of the wall's numbers, a row for each prior below.
    wall: DMatrix<f64>,
    missing: DVector<f64>,
    /// Mean square that the best pair leaves: 1 if points err by their noise alone.
    variance: f64,
}

impl<'p> Equations<'p> {
    fn new(points: &'p Points, weight: DVector<f64>, variance: f64) -> Self {
        let (rows, count) = points.wall.shape();
        let prior = |i: usize, k: usize| if i - rows == k { 1.0 } else { 0.0 };
        let stacked = DMatrix::from_fn(rows + count, count, |i, k| {
            if i < rows { weight[i] * points.wall[(i, k)] } else { prior(i, k) }
        });
        let wall = if count == 0 { stacked } else { stacked.qr().q() };
        let mut all = Self { points, weight, wall, missing: DVector::zeros(0), variance };
        all.missing = all.off_wall(&points.missing);
        all
    }

    /// Every row by its noise alone.
    pub fn even(points: &'p Points) -> Self {
        Self::new(points, DVector::repeat(points.missing.len(), 1.0), 1.0)
    }

    /// The points they are made of.
    pub fn points(&self) -> &Points {
        self.points
    }

    /// Square root of a row's weight.
    pub fn weight(&self, row: usize) -> f64 {
        self.weight[row]
    }

    /// Mean square of what is left, over the noise.
    pub fn variance(&self) -> f64 {
        self.variance
    }

    /// What is missing, weighed, without what the wall's numbers can do.
    pub fn missing(&self) -> &DVector<f64> {
        &self.missing
    }

    /// Steps of the wall's uncertain numbers beside a law, in standard deviations of what was known.
    pub fn wall_steps(&self, law: &Law) -> Option<DVector<f64>> {
        self.wall_steps_beside(&self.points.of_law(law))
    }

    /// The same beside rows that a law makes.
    pub fn wall_steps_beside(&self, rows: &DVector<f64>) -> Option<DVector<f64>> {
        let left = (&self.points.missing - rows).component_mul(&self.weight);
        let count = self.points.wall.ncols();
        let wall = DMatrix::from_fn(left.len(), count, |i, k| self.weight[i] * self.points.wall[(i, k)]);
        let normal = wall.tr_mul(&wall) + DMatrix::identity(count, count) * self.variance;
        Some(normal.cholesky()?.solve(&wall.tr_mul(&left)))
    }

    /// Rows weighed, without what the wall's numbers can do.
    pub fn off_wall(&self, rows: &DVector<f64>) -> DVector<f64> {
        let mut all = rows.component_mul(&self.weight).resize_vertically(self.wall.nrows(), 0.0);
        let shares = self.wall.tr_mul(&all);
        all -= &self.wall * shares;
        all
    }

    /// Sizes of atoms with these columns, and what they gain in squared error; `None` where two are one.
    fn sizes(&self, columns: &[DVector<f64>]) -> Option<(Vec<f64>, f64)> {
        let gram = |i: usize, k: usize| columns[i].dot(&columns[k]);
        let pull = columns.iter().map(|column| column.dot(&self.missing)).collect::<Vec<_>>();
        match columns.len() {
            1 => single(gram(0, 0), pull[0]),
            _ => pair([gram(0, 0), gram(0, 1), gram(1, 1)], [pull[0], pull[1]]),
        }
    }

    /// A law with the sizes that fit best, and its evidence; `None` where a size may not be.
    pub fn fitted(&self, law: &Law) -> Option<Candidate> {
        let columns = law.atoms().map(|atom| self.points.column(&atom)).collect::<Vec<_>>();
        self.fitted_to(law, &columns)
    }

    /// The same of a law whose columns are known.
    pub fn fitted_to(&self, law: &Law, columns: &[DVector<f64>]) -> Option<Candidate> {
        let columns = columns.iter().map(|column| self.off_wall(column)).collect::<Vec<_>>();
        let (sizes, gain) = self.sizes(&columns)?;
        self.candidate(law.map(|a, atom| Atom { size: sizes[a], ..atom }), gain)
    }

    /// The same equations, each row so many times.
    pub fn repeated(&self, times: &DVector<f64>) -> Self {
        Self::new(self.points, self.weight.component_mul(&times.map(f64::sqrt)), self.variance)
    }

    /// A law that was fitted, with its evidence; `None` where a size may not be.
    fn candidate(&self, law: Law, gain: f64) -> Option<Candidate> {
        let allowed = law.atoms().all(|atom| atom.may_be(atom.size));
        allowed.then(|| Candidate { evidence: self.evidence(&law, gain), law })
    }

    /// Half of the gain in squared error over its variance, less half the logarithm of the rows for each number
    /// (Schwarz) and the length of the formula.
    fn evidence(&self, law: &Law, gain: f64) -> f64 {
        let rows = self.points.missing.len() as f64;
        let length = |atom: Atom| if atom.shape.is_common() { LAW_LENGTH } else { RARE_LAW_LENGTH };
        let price = 0.5 * law.slots().len() as f64 * rows.ln() + law.atoms().map(length).sum::<f64>();
        0.5 * gain / self.variance - price
    }

    /// Numbers of the shapes off the grid, one after the other.
    fn refined(&self, candidate: Candidate) -> Candidate {
        let mut best = candidate.clone();
        for _ in 0..ROUNDS {
            for slot in candidate.law.slots() {
                if let LawSlot::Number(a, i) = slot {
                    best = self.refined_by(best, a, i);
                }
            }
        }
        best
    }

    /// One number of one atom, by golden section between its neighbours on the grid.
    fn refined_by(&self, best: Candidate, a: usize, i: usize) -> Candidate {
        let with = |value: f64| {
            let moved = |own: usize, mut atom: Atom| {
                if own == a {
                    atom.numbers[i] = value;
                }
                atom
            };
            self.fitted(&best.law.map(moved))
        };
        let evidence = |value: f64| with(value).map_or(f64::NEG_INFINITY, |c| c.evidence);
        let Some(atom) = best.law.atoms().nth(a) else { return best };
        let value = golden(neighbours(atom.shape.numbers()[i].grid, atom.numbers[i]), evidence);
        with(value).filter(|new| new.evidence > best.evidence).unwrap_or(best)
    }
}

fn single(gram: f64, pull: f64) -> Option<(Vec<f64>, f64)> {
    (gram > 0.0).then(|| (vec![pull / gram], pull * pull / gram))
}

fn pair([a, b, c]: [f64; 3], [p, q]: [f64; 2]) -> Option<(Vec<f64>, f64)> {
    let determinant = a * c - b * b;
    if determinant.is_nan() || determinant <= ALIKE * a * c {
        return None;
    }
    let sizes = [(c * p - b * q) / determinant, (a * q - b * p) / determinant];
    Some((sizes.to_vec(), sizes[0] * p + sizes[1] * q))
}

/// Between which values of a grid a value lies, or the neighbours of the nearest.
fn neighbours(grid: &[f64], value: f64) -> [f64; 2] {
    let distance = |i: &usize| (grid[*i] - value).abs();
    let nearest = (0..grid.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
    [grid[nearest.saturating_sub(1)], grid[(nearest + 1).min(grid.len() - 1)]]
}

/// Where a function of one peak is largest.
fn golden([mut low, mut high]: [f64; 2], of: impl Fn(f64) -> f64) -> f64 {
    const SHARE: f64 = 0.618_033_988_749_894_8;
    let inner = |low: f64, high: f64| [high - SHARE * (high - low), low + SHARE * (high - low)];
    let [mut a, mut b] = inner(low, high);
    let (mut at_a, mut at_b) = (of(a), of(b));
    for _ in 0..SECTIONS {
        if at_a > at_b {
            (high, b, at_b) = (b, a, at_a);
            a = inner(low, high)[0];
            at_a = of(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = inner(low, high)[1];
            at_b = of(b);
        }
    }
    if at_a > at_b { a } else { b }
}

/// What was found over points: laws of one atom and of two, the best of each kind first.
#[derive(Debug)]
pub struct Searched<'p> {
    /// One atom.
    pub singles: Vec<Candidate>,
    /// Two.
    pub pairs: Vec<Candidate>,
    /// Of one atom those that would gain, but feed the wall or jump: the best of each kind.
    pub feeding: Vec<Candidate>,
    /// The equations in which they were weighed.
    pub equations: Equations<'p>,
}

impl Searched<'_> {
    /// Evidence of the best law.
    pub fn most_evidence(&self) -> f64 {
        self.singles.iter().chain(&self.pairs).map(|c| c.evidence).fold(0.0, f64::max)
    }

    /// What the best law of two atoms says more than one that was found in windows, its sizes fitted to points; `None` where these
    /// may not be.
    pub fn second_says_more(&self, told: &Law) -> Option<f64> {
        let of_two = self.pairs.first().map_or(0.0, |pair| pair.evidence);
        Some(of_two - self.equations.fitted(told)?.evidence)
    }
}

/// Searches all laws of one atom and of two over points.
pub fn search(points: &Points) -> Option<Searched<'_>> {
    let atoms = atoms(points);
    let columns = atoms.par_iter().map(|atom| points.column(atom)).collect::<Vec<_>>();
    let even = Equations::even(points);
    let best = Scan::new(&even, &atoms, &columns).best()?;
    let equations = even.reweighted(&best);
    let scan = Scan::new(&equations, &atoms, &columns);
    let refine = |laws: Vec<Candidate>| {
        let refined = laws.into_par_iter().take(LAWS_REFINED).map(|c| equations.refined(c));
        ordered(refined.collect())
    };
    let (singles, pairs) = (refine(scan.singles()), refine(at_one_place(scan.pairs())));
    let feeding = scan.feeding();
    Some(Searched { singles, pairs, feeding, equations })
}

impl<'p> Equations<'p> {
    /// The same equations, where rows far off what a law leaves count by their distance and not its square.
    fn reweighted(&self, best: &Candidate) -> Self {
        let left = self.off_wall(&(&self.points.missing - self.points.of_law(&best.law)));
        let rows = self.points.missing.len();
        let mut sizes = left.iter().take(rows).map(|z| z.abs()).collect::<Vec<_>>();
        sizes.sort_by(f64::total_cmp);
        // The median of a normal variable's size is 0.6745 standard deviations.
        let usual = (sizes[rows / 2] / 0.6745).max(1.0);
        let weight = |z: &f64| (USUAL * usual / z.abs().max(USUAL * usual)).sqrt();
        let weight = DVector::from_iterator(rows, left.iter().take(rows).map(weight));
        Self::new(self.points, weight, usual * usual)
    }
}

/// Laws of two atoms, best first, without those at two places that say no more than the same shapes at one.
///
/// While a joint stays shut a moment there and a force at the top are one, and each pair is there four times.
fn at_one_place(laws: Vec<Candidate>) -> Vec<Candidate> {
    let shapes = |law: &Law| {
        let mut shapes = law.atoms().map(|atom| atom.shape).collect::<Vec<_>>();
        shapes.sort_unstable();
        shapes
    };
    let is_at_one = |law: &Law| law.second.is_none_or(|two| two.site == law.first.site);
    let mut best = BTreeMap::<Vec<Shape>, f64>::new();
    for one in laws.iter().filter(|one| is_at_one(&one.law)) {
        best.entry(shapes(&one.law)).or_insert(one.evidence);
    }
    let says_more = |one: &Candidate| {
        let as_good = best.get(&shapes(&one.law)).copied();
        is_at_one(&one.law) || as_good.is_none_or(|as_good| one.evidence > as_good + EQUIVALENT)
    };
    laws.into_iter().filter(says_more).collect()
}

fn ordered(mut laws: Vec<Candidate>) -> Vec<Candidate> {
    laws.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    laws
}

/// Every atom of every shape on its grid.
fn atoms(points: &Points) -> Vec<Atom> {
    let of_site = |site: Site| {
        let shapes = if site == Site::Top { &Shape::ALL[..] } else { &Shape::AT_JOINTS[..] };
        shapes.iter().flat_map(move |shape| on_grid(*shape).map(move |numbers| (site, *shape, numbers)))
    };
    let all = Site::ALL.into_iter().flat_map(of_site);
    let atom = |(site, shape, numbers): (Site, Shape, [f64; 2])| Atom {
        site,
        shape,
        numbers,
        size: 1.0,
        reach: points.reach[site as usize],
        is_exact: false,
    };
    all.map(atom).collect()
}

/// All numbers of a shape on its grid.
fn on_grid(shape: Shape) -> impl Iterator<Item = [f64; 2]> {
    let grid = move |i: usize| shape.numbers().get(i).map_or(&[0.0][..], |number| number.grid);
    grid(0).iter().flat_map(move |a| grid(1).iter().map(move |b| [*a, *b]))
}

/// All columns in the same equations.
struct Scan<'e, 'p> {
    equations: &'e Equations<'p>,
    atoms: &'e [Atom],
    /// Kind of each atom by number, an atom of one site and shape after the other.
    kinds: Vec<usize>,
    gram: DMatrix<f64>,
    pull: DVector<f64>,
}

impl<'e, 'p> Scan<'e, 'p> {
    fn new(equations: &'e Equations<'p>, atoms: &'e [Atom], columns: &[DVector<f64>]) -> Self {
        let off = columns.par_iter().map(|column| equations.off_wall(column)).collect::<Vec<_>>();
        let all = DMatrix::from_columns(&off);
        let mut kinds = vec![0];
        for two in atoms.windows(2) {
            let same = (two[0].site, two[0].shape) == (two[1].site, two[1].shape);
            kinds.push(kinds[kinds.len() - 1] + usize::from(!same));
        }
        Self { equations, atoms, kinds, gram: all.tr_mul(&all), pull: all.tr_mul(&equations.missing) }
    }

    fn atom(&self, i: usize, size: f64) -> Atom {
        Atom { size, ..self.atoms[i] }
    }

    fn single(&self, i: usize) -> Option<Candidate> {
        let (sizes, gain) = single(self.gram[(i, i)], self.pull[i])?;
        self.equations.candidate(Law::of(self.atom(i, sizes[0])), gain)
    }

    /// Those of one atom whose size may not be.
    fn feeding(&self) -> Vec<Candidate> {
        let one = |i: usize| {
            let (sizes, gain) = single(self.gram[(i, i)], self.pull[i])?;
            let law = Law::of(self.atom(i, sizes[0]));
            let allowed = law.first.may_be(law.first.size);
            (!allowed)
                .then(|| (self.kinds[i], Candidate { evidence: self.equations.evidence(&law, gain), law }))
        };
        best_of_each((0..self.atoms.len()).filter_map(one))
    }

    fn pair(&self, i: usize, k: usize) -> Option<Candidate> {
        let gram = [self.gram[(i, i)], self.gram[(i, k)], self.gram[(k, k)]];
        let (sizes, gain) = pair(gram, [self.pull[i], self.pull[k]])?;
        let law = Law { first: self.atom(i, sizes[0]), second: Some(self.atom(k, sizes[1])) };
        self.equations.candidate(law, gain)
    }

    /// The best of each kind, best first.
    fn singles(&self) -> Vec<Candidate> {
        let all = (0..self.atoms.len()).filter_map(|i| Some((self.kinds[i], self.single(i)?)));
        best_of_each(all)
    }

    /// The best of each two kinds, best first.
    fn pairs(&self) -> Vec<Candidate> {
        let of = |i: usize| {
            let others = (0..i).filter(|k| self.kinds[*k] != self.kinds[i]);
            best_of_keyed(others.filter_map(|k| Some(((self.kinds[i], self.kinds[k]), self.pair(i, k)?))))
        };
        let found = (0..self.atoms.len()).into_par_iter().map(of).collect::<Vec<_>>();
        best_of_each(found.into_iter().flatten())
    }

    /// The best of all.
    fn best(&self) -> Option<Candidate> {
        self.singles().into_iter().chain(self.pairs()).max_by(|a, b| a.evidence.total_cmp(&b.evidence))
    }
}

/// The best candidate of each key.
fn best_of_keyed<K: Ord>(all: impl Iterator<Item = (K, Candidate)>) -> BTreeMap<K, Candidate> {
    let mut best = BTreeMap::<K, Candidate>::new();
    for (key, candidate) in all {
        if best.get(&key).is_none_or(|old| candidate.evidence > old.evidence) {
            best.insert(key, candidate);
        }
    }
    best
}

/// The best candidates of all keys, best first.
fn best_of_each<K: Ord>(all: impl Iterator<Item = (K, Candidate)>) -> Vec<Candidate> {
    ordered(best_of_keyed(all).into_values().collect())
}

#[cfg(test)]
mod tests {
    use super::super::twin::{points_of, tests_of, wall_with};
    use super::*;
    use crate::diagnose::formula::Side;
    use crate::limits::WORTH_A_NAME;

    const NOISE_RAD: f64 = 3e-5;

    /// The best law of one atom for tests of a wall with an effect.
    fn best(effect: &str) -> (Atom, f64, [f64; 2]) {
        let points = points_of(&tests_of(&wall_with(effect), NOISE_RAD));
        let found = search(&points).expect("laws");
        let best = &found.singles[0];
        (best.law.first, best.evidence, points.reach[best.law.first.site as usize])
    }

    #[test]
    fn analytic_a_cubic_spring_is_found_by_its_exponent_and_size() {
        let (atom, _, [q0, _]) =
            best("[[effects]]\nkind = \"cubic_stiffness\"\ncoefficient_n_per_m3 = 2e6\n");
        assert_eq!((atom.site, atom.shape), (Site::Top, Shape::Spring), "{atom:?}");
        assert!((atom.numbers[0] - 3.0).abs() < 0.1, "{atom:?}");
        assert!((atom.size / (2e6 * q0.powi(3)) - 1.0).abs() < 0.05, "{atom:?}");
    }

    #[test]
    fn analytic_a_second_atom_says_more_of_what_has_two() {
        let more = |effects: &str| {
            let points = points_of(&tests_of(&wall_with(effects), NOISE_RAD));
            let found = search(&points).expect("laws");
            found.second_says_more(&found.singles[0].law).expect("sizes that may be")
        };
        let friction = "[[effects]]\nkind = \"coulomb_friction\"\nforce_n = 150.0\n";
        let spring = "[[effects]]\nkind = \"cubic_stiffness\"\ncoefficient_n_per_m3 = 2e6\n";
        assert!(more(spring) < EQUIVALENT, "{}", more(spring));
        // Neither is any power of the other's variable.
        let both = more(&[friction, spring].concat());
        assert!(both > WORTH_A_NAME, "{both}");
    }

    #[test]
    fn analytic_friction_is_not_read_as_the_root_of_a_velocity() {
        let wall = wall_with("[[effects]]\nkind = \"coulomb_friction\"\nforce_n = 300.0\n");
        let points = points_of(&tests_of(&wall, NOISE_RAD));
        let found = search(&points).expect("laws");
        let drag =
            found.singles.iter().find(|c| c.law.first.shape == Shape::Drag).expect("a law of velocity");
        // Near each turn the smoothed velocity is noise, and its sign with it: the steepest saturation is as good.
        assert!(drag.evidence > found.singles[0].evidence - EQUIVALENT, "{:?}", found.singles[0]);
        let atom = drag.law.first;
        assert!(atom.numbers[0] == 0.0 && (atom.size / 300.0 - 1.0).abs() < 0.05, "{atom:?}");
    }

    #[test]
    fn analytic_a_spring_on_one_side_is_found_on_its_side() {
        let spring =
            "[[effects]]\nkind = \"one_sided_spring\"\nside = \"negative\"\nstiffness_n_per_m = 2e4\n";
        let (atom, _, [q0, _]) = best(spring);
        assert_eq!((atom.site, atom.shape), (Site::Top, Shape::OneSidedSpring(Side::Negative)), "{atom:?}");
        assert!((atom.numbers[0] - 1.0).abs() < 0.1, "{atom:?}");
        assert!((atom.size / (2e4 * q0) - 1.0).abs() < 0.05, "{atom:?}");
    }

    #[test]
    fn analytic_a_saturation_that_goes_back_straight_is_found_by_how_far_it_has_been() {
        let law = "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"-f*x/(g+x_max)\"\n\
                   [effects.parameters]\nf = { value = 600.0, unit = \"N\" }\ng = { value = 0.02, unit = \"m\" }\n";
        let points = points_of(&tests_of(&wall_with(law), NOISE_RAD));
        let found = search(&points).expect("laws");
        let [best, next] = [&found.singles[0], &found.singles[1]];
        assert_eq!((best.law.first.site, best.law.first.shape), (Site::Top, Shape::Secant), "{best:?}");
        assert!(best.evidence > next.evidence + EQUIVALENT, "{best:?} and {next:?}");
        assert!((best.law.first.size / 600.0 - 1.0).abs() < 0.15, "{best:?}");
    }

    #[test]
    fn analytic_laws_that_carry_a_state_are_found_by_it() {
        let law = |text: &str, rate: &str, unit: &str, own: &str| {
            format!(
                "[[effects]]\nkind = \"formula\"\nplace = \"top\"\nforce_n = \"{text}\"\n[effects.states.z]\nrate = \"{rate}\"\n\
                 start = 0.0\nunit = \"{unit}\"\n[effects.parameters]\n{own}"
            )
        };
        let relaxing = law(
            "-k*z",
            "v - z/tau",
            "m",
            "k = { value = 2e4, unit = \"N/m\" }\ntau = { value = 0.15, unit = \"s\" }\n",
        );
        let yielding = law(
            "-f*z",
            "v/d*(1 - abs(z)**n*(1 + sign(v*z))/2)",
            "1",
            "f = { value = 600.0, unit = \"N\" }\nd = { value = 0.01, unit = \"m\" }\nn = { value = 1.5, unit = \"1\" }\n",
        );
        for (law, shape, value) in [(relaxing, Shape::Relaxing, 2e4), (yielding, Shape::Yielding, 600.0)] {
            let points = points_of(&tests_of(&wall_with(&law), NOISE_RAD));
            let found = search(&points).expect("laws");
            let [best, next] = [&found.singles[0], &found.singles[1]];
            assert_eq!(
                (best.law.first.site, best.law.first.shape),
                (Site::Top, shape),
                "{best:?} and {next:?}"
            );
            assert!(best.evidence > next.evidence + EQUIVALENT, "{best:?} and {next:?}");
            let own = best.law.written().remove(0).parameters[0].value;
            assert!((own / value - 1.0).abs() < 0.1, "{best:?}: {own}");
        }
    }

    #[test]
    fn analytic_where_nothing_is_hidden_no_law_is_worth_its_price() {
        let (atom, evidence, _) = best("");
        assert!(evidence < 0.0, "{atom:?} {evidence}");
    }

    #[test]
    fn analytic_a_golden_section_finds_a_peak() {
        // The range shrinks by 0.618 twelve times: to 0.003 of itself.
        assert!((golden([0.0, 2.0], |x| -(x - 0.7_f64).powi(2)) - 0.7).abs() < 0.007);
    }
}
