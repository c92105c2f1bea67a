//! How sure it is what a record does after others: records and walls drawn anew many times.
//!
//! Pairs of one record move together, and so do those of one wall. A draw takes as many records and as many walls as
//! there are, with replacement; a pair's weight is the product of how often each of its records and its wall were drawn:
//! the pigeonhole bootstrap (Owen 2007, Annals of Applied Statistics 1(2)). Of fewer than five of a kind that kind is not
//! drawn. A draw depends on its number alone.

use std::collections::BTreeMap;

use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::draws::{DRAWS, FEWEST_RECORDS, interval, rng_of};
use super::sequences::{Compared, Pair};
use super::two_way::counts;

/// The ends of an interval; `None` of an end that lies above all numbers, as collapses do.
pub type Interval = [Option<f64>; 2];

/// Intervals of the median ratio, and of the share that falls only after the parts before.
pub(super) struct Resampled {
    pub ratio: Option<Interval>,
    pub share: Option<Interval>,
}

/// A pair as draws see it.
struct Weighted {
    records: Vec<usize>,
    wall: usize,
    /// Rotation after over alone; infinite of a wall that falls after the others and stands alone.
    ratio: Option<f64>,
    /// Whether the wall falls only after the others; none of one that falls alone.
    falls: Option<bool>,
}

/// Draws the pairs of a group anew.
pub(super) fn intervals(pairs: &[&Pair]) -> Resampled {
    let (mut records, mut walls) = (BTreeMap::new(), BTreeMap::new());
    let mut weighted: Vec<Weighted> = Vec::with_capacity(pairs.len());
    for pair in pairs {
        let Compared::Both { fell_after, fell_alone, ratio } = pair.compared else { continue };
        weighted.push(Weighted {
            records: pair.records.iter().map(|record| number(&mut records, record)).collect(),
            wall: number(&mut walls, &pair.wall),
            ratio: ratio.map(|ratio| if fell_after { f64::INFINITY } else { ratio }),
            falls: (!fell_alone).then_some(fell_after),
        });
    }
    let order = |pair: &Weighted| pair.ratio.unwrap_or(f64::INFINITY);
    weighted.sort_by(|a, b| order(a).total_cmp(&order(b)));
    let counts = [records.len(), walls.len()];
    if counts.iter().all(|&count| count < FEWEST_RECORDS) {
        return Resampled { ratio: None, share: None };
    }
    let drawn: Vec<[Option<f64>; 2]> =
        (0..DRAWS).into_par_iter().map(|draw| one_draw(&weighted, counts, draw)).collect();
    let finite = |end: f64| Some(end).filter(|value| value.is_finite());
    let [ratio, share] = [0, 1].map(|i| {
        let ends = interval(drawn.iter().filter_map(|values| values[i]), f64::total_cmp);
        ends.map(|ends| ends.map(finite))
    });
    Resampled { ratio, share }
}

/// The number of a key, the next one if it is new.
fn number<K: Ord>(of: &mut BTreeMap<K, usize>, key: K) -> usize {
    let next = of.len();
    *of.entry(key).or_insert(next)
}

/// Median ratio and share of a draw.
fn one_draw(pairs: &[Weighted], counts: [usize; 2], draw: u64) -> [Option<f64>; 2] {
    let mut rng = rng_of(draw);
    let [records, walls] = counts.map(|count| draw_counts(&mut rng, count));
    let weight = |pair: &Weighted| {
        pair.records.iter().map(|&record| records[record]).product::<f64>() * walls[pair.wall]
    };
    let ratios = || pairs.iter().filter_map(|pair| Some((pair.ratio?, weight(pair))));
    let half = 0.5 * ratios().map(|(_, weight)| weight).sum::<f64>();
    let mut below = 0.0;
    let median = ratios().find(|(_, weight)| {
        below += weight;
        below >= half && half > 0.0
    });
    let falls = pairs.iter().filter_map(|pair| Some((pair.falls?, weight(pair))));
    let (fell, all) = falls.fold((0.0, 0.0), |(fell, all), (falls, weight)| {
        (fell + if falls { weight } else { 0.0 }, all + weight)
    });
    [median.map(|(ratio, _)| ratio), (all > 0.0).then(|| fell / all)]
}

/// How often each of `count` is drawn in `count` draws; once each where they are too few to be drawn.
fn draw_counts(rng: &mut ChaCha8Rng, count: usize) -> Vec<f64> {
    if count < FEWEST_RECORDS {
        return vec![1.0; count];
    }
    counts(count, rng).into_iter().map(|drawn| drawn as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair(record: &str, draw: u64, compared: Compared) -> Pair {
        let records = [record.to_owned()].into();
        Pair { wall: (Some(draw), None, None, 12.0_f64.to_bits()), records, compared }
    }

    fn both(ratio: f64) -> Compared {
        Compared::Both { fell_after: false, fell_alone: false, ratio: Some(ratio) }
    }

    fn of(pairs: &[Pair]) -> Resampled {
        intervals(&pairs.iter().collect::<Vec<_>>())
    }

    #[test]
    fn analytic_walls_that_agree_leave_no_doubt() {
        let pairs: Vec<Pair> = (0..10).map(|draw| pair("a", draw, both(1.25))).collect();
        let Resampled { ratio, share } = of(&pairs);
        assert_eq!((ratio, share), (Some([Some(1.25); 2]), Some([Some(0.0); 2])));
    }

    #[test]
    fn analytic_the_median_of_seven_walls_lies_between_the_second_and_the_sixth() {
        // As of seven records in `draws.rs`: a binomial of 7 trials of k/7 reaches four with 0.010 for k = 1, 0.098 for 2.
        let pairs: Vec<Pair> = (0..7).map(|draw| pair("a", draw, both(1.0 + draw as f64))).collect();
        assert_eq!(of(&pairs).ratio, Some([Some(2.0), Some(6.0)]));
    }

    #[test]
    fn analytic_falls_rank_above_all_numbers() {
        let fell = Compared::Both { fell_after: true, fell_alone: false, ratio: Some(3.0) };
        let pairs: Vec<Pair> =
            (0..10).map(|draw| pair("a", draw, if draw < 9 { fell } else { both(1.0) })).collect();
        let Resampled { ratio, share } = of(&pairs);
        assert_eq!(ratio, Some([None; 2]));
        assert!(share.is_some_and(|[low, high]| low < Some(0.9) && high == Some(1.0)), "{share:?}");
    }

    #[test]
    fn regress_too_few_of_both_kinds_tell_no_interval() {
        let pairs: Vec<Pair> = (0..4).map(|draw| pair("a", draw, both(1.0))).collect();
        assert_eq!(of(&pairs).ratio, None);
        assert_eq!(of(&[pair("a", 0, Compared::Failed), pair("b", 1, Compared::FellBefore)]).share, None);
    }
}
