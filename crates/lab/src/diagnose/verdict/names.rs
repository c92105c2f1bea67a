//! Names by which what was found goes in answers.

use crate::diagnose::hypothesis::{Addition, WallNumber};
use crate::diagnose::trials::{Tried, kind_of};

/// Names by which equivalent hypotheses go in answers: kinds, and last words of keys of the wall.
pub fn names(tried: &Tried) -> Vec<String> {
    let h = &tried.hypothesis;
    let name = |(index, addition): (usize, &Addition)| match addition {
        Addition::Number(number) => name_of_number(number),
        addition => kind_of(h, &tried.fit.values, index)
            .map_or_else(|| addition.name(), |kind| kind.name().to_owned()),
    };
    h.additions.iter().enumerate().map(name).collect()
}

/// Last word of the key of a number of the wall, without its unit.
pub fn name_of_number(number: &WallNumber) -> String {
    let last = number.key.rsplit('.').next().unwrap_or(number.key);
    last.trim_end_matches("_n_per_m").trim_end_matches("_kg").trim_end_matches("_m").to_owned()
}
