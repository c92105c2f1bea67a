//! A formula as it stands in wall files and JSON: kind, place, the formula under the key of the place, parameters.

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use crate::carried::CarriedState;
use crate::formula::{Formula, Parameter};

/// Parameters by name, in their order.
struct Parameters<'a>(&'a [Parameter]);

#[derive(Serialize)]
struct Number<'a> {
    value: f64,
    unit: &'a str,
}

/// Carried states by name, in their order.
struct States<'a>(&'a [CarriedState]);

#[derive(Serialize)]
struct State<'a> {
    rate: &'a str,
    start: f64,
    unit: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    range: Option<[f64; 2]>,
}

impl Serialize for States<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let states = self
            .0
            .iter()
            .map(|s| (&s.name, State { rate: &s.rate, start: s.start, unit: &s.unit, range: s.range }));
        serializer.collect_map(states)
    }
}

impl Formula {
    /// The `kind` of a formula in wall files.
    pub const KIND: &'static str = "formula";
}

impl Serialize for Formula {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("kind", Self::KIND)?;
        map.serialize_entry("place", self.place().name())?;
        map.serialize_entry(self.place().key(), &self.to_string())?;
        // A formula without states is written as before there were any: its hash stays.
        if !self.states().is_empty() {
            map.serialize_entry("states", &States(self.states()))?;
        }
        map.serialize_entry("parameters", &Parameters(self.parameters()))?;
        map.end()
    }
}

impl Serialize for Parameters<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let numbers = self.0.iter().map(|p| (&p.name, Number { value: p.value, unit: &p.unit }));
        serializer.collect_map(numbers)
    }
}
