//! Stretches of a test in one contact state, their states smoothed sample by sample, clear of impacts.

use crate::diagnose::measured::{Freedom, TestData, measured_state};
use mrbd_kernel::model::{Contact, State};

/// Samples in a row whose contact state is beyond doubt and the same.
#[derive(Debug, Clone)]
pub struct Stretch {
    /// The contact state.
    pub contact: Contact,
    /// What is free in it.
    pub freedom: Freedom,
    /// Its first sample.
    pub from: usize,
    /// Smoothed rotations and velocities of every sample.
    pub states: Vec<State>,
}

/// All stretches of a test in order, rest included.
pub fn stretches(test: &TestData) -> Vec<Stretch> {
    let mut all: Vec<Stretch> = Vec::new();
    let mut joined = false;
    for k in 0..test.time_s.len() {
        let Some(measured) = measured_state(test, k) else {
            joined = false;
            continue;
        };
        let (state, contact) = measured.freedom.state(&measured.numbers);
        match all.last_mut().filter(|last| joined && last.contact == contact) {
            Some(last) => last.states.push(state),
            None => {
                all.push(Stretch { contact, freedom: measured.freedom, from: k, states: vec![state] });
            }
        }
        joined = true;
    }
    all
}
