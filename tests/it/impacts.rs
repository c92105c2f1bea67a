//! Every impact has exactly one outcome: over random walls, postures and velocities, and over the impacts of runs.

use std::collections::BTreeMap;

use mrbd::model::{Contact, Joint, RockingWall, State, Touching};
use crate::matrix_model::MatrixWall;
use crate::walls::{any_impact, any_wall, made, rng};

const IMPACTS: u64 = 200_000;

#[test]
fn analytic_every_random_impact_has_one_outcome() {
  for slow in [1e-3, 1e-6, 1e-9, 1e-12, 1e-15] {
    let mut seen: BTreeMap<(String, usize), u64> = BTreeMap::new();
    for index in 0..IMPACTS {
        let mut rng = rng(10, index);
        let parameters = any_wall(&mut rng);
        let wall = RockingWall::new(&made(&parameters));
        let (from, touching, state) = any_impact(&mut rng, wall.wall(), slow);
        let outcomes = wall.admissible_outcomes(from, touching, &state);
        let names: Vec<_> = outcomes.iter().flatten().map(|c| if from.ground.sign() < 0.0 {c.mirrored().name()} else {c.name()}).collect();
        let key = (format!("{} {:?} -> {:?}", from.pattern_number().unwrap(), touching, names), names.len());
        *seen.entry(key).or_default() += 1;
    }
    eprintln!("slow {slow:e}");
    for (key, count) in &seen { if key.1!=1 {eprintln!("{} : {count}  {}", key.1, key.0);} }
  }
}
