//! A formula as it stands in wall files and JSON: kind, place, the formula under the key of the place, parameters.

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use crate::formula::{Formula, Parameter};

/// Parameters by name, in their order.
struct Parameters<'a>(&'a [Parameter]);

#[derive(Serialize)]
struct Number<'a> {
    value: f64,
    unit: &'a str,
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
