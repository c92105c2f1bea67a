//! Effects as they stand in wall files and JSON: `kind`, the word it takes, its numbers.

use std::fmt;

use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Effect, EffectEntry, EffectError, EffectKind};

impl Serialize for Effect {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("kind", self.entry().name)?;
        if let (Some(choice), Some(word)) = (self.entry().choice, self.variant().choice) {
            map.serialize_entry(choice.key, word)?;
        }
        let mut values = self.values();
        for (key, count) in self.entry().keys() {
            let (of_key, others) = values.split_at(count.unwrap_or(1));
            values = others;
            match count {
                Some(_) => map.serialize_entry(key, of_key)?,
                None => map.serialize_entry(key, &of_key[0])?,
            }
        }
        map.end()
    }
}

impl EffectEntry {
    /// The keys of the numbers in wall files: one number each, or a list of so many.
    fn keys(&self) -> Vec<(&'static str, Option<usize>)> {
        let mut keys: Vec<(&'static str, Option<usize>)> = Vec::new();
        for parameter in self.parameters {
            match (parameter.key.split_once('.'), keys.last_mut()) {
                (Some((list, _)), Some((key, Some(count)))) if *key == list => *count += 1,
                (Some((list, _)), _) => keys.push((list, Some(1))),
                (None, _) => keys.push((parameter.key, None)),
            }
        }
        keys
    }

    /// The neutral value of a number that may be left out; `None` for one that may not.
    fn left_out(&self, key: &str) -> Option<f64> {
        self.parameters.iter().find(|p| p.key == key && p.optional).map(|p| p.neutral)
    }

    fn listed_keys(&self) -> String {
        let numbers = self.keys().into_iter().map(|(key, _)| key);
        let keys = self.choice.iter().map(|choice| choice.key).chain(numbers);
        keys.map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ")
    }
}

impl<'de> Deserialize<'de> for Effect {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(EffectVisitor)
    }
}

/// What may stand behind a key.
#[derive(Debug, Clone, PartialEq)]
enum Item {
    Number(f64),
    Word(String),
    List(Vec<f64>),
}

impl fmt::Display for Item {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Item::Number(number) => write!(f, "{number}"),
            Item::Word(word) => write!(f, "`{word}`"),
            Item::List(list) => write!(f, "a list of {}", list.len()),
        }
    }
}

struct EffectVisitor;

impl<'de> Visitor<'de> for EffectVisitor {
    type Value = Effect;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a table with the kind of an effect and its parameters")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<Effect, M::Error> {
        let mut items: Vec<(String, Item)> = Vec::new();
        while let Some(entry) = map.next_entry()? {
            items.push(entry);
        }
        let Some(kind) = items.iter().position(|(key, _)| key == "kind") else {
            return Err(M::Error::missing_field("kind"));
        };
        match items.remove(kind).1 {
            Item::Word(name) => from_items(&name, items).map_err(M::Error::custom),
            other => Err(M::Error::custom(format!("{other} for `kind`, expected a word"))),
        }
    }
}

fn from_items(name: &str, mut items: Vec<(String, Item)>) -> Result<Effect, EffectError> {
    let kind = EffectKind::named(name)?;
    let entry = kind.entry();
    let refused = |found: String, allowed: String| EffectError::Keys { kind: entry.name, found, allowed };
    let mut take = |key: &str| items.iter().position(|(k, _)| k == key).map(|at| items.remove(at).1);
    let word = match entry.choice.and_then(|choice| take(choice.key)) {
        None => None,
        Some(Item::Word(word)) => Some(word),
        Some(other) => Some(other.to_string()),
    };
    let mut values = Vec::new();
    for (key, count) in entry.keys() {
        match (take(key), count) {
            (Some(Item::Number(value)), None) => values.push(value),
            (Some(Item::List(list)), Some(count)) if list.len() == count => values.extend(list),
            (None, _) => match entry.left_out(key) {
                Some(neutral) => values.push(neutral),
                None => return Err(refused(format!("no `{key}`"), "this key with a number".to_owned())),
            },
            (Some(other), None) => {
                return Err(refused(format!("{other} for `{key}`"), "a number".to_owned()));
            }
            (Some(other), Some(count)) => {
                return Err(refused(format!("{other} for `{key}`"), format!("a list of {count} numbers")));
            }
        }
    }
    if let Some((key, _)) = items.first() {
        return Err(refused(format!("unknown key `{key}`"), format!("one of {}", entry.listed_keys())));
    }
    kind.variant(word.as_deref())?.with_parameters(&values)
}

impl<'de> Deserialize<'de> for Item {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ItemVisitor)
    }
}

struct ItemVisitor;

impl<'de> Visitor<'de> for ItemVisitor {
    type Value = Item;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number, a word or a list of numbers")
    }

    fn visit_f64<E>(self, number: f64) -> Result<Item, E> {
        Ok(Item::Number(number))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Item, E> {
        // Whole numbers in a wall file are far below 2^53.
        Ok(Item::Number(number as f64))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Item, E> {
        Ok(Item::Number(number as f64))
    }

    fn visit_str<E>(self, word: &str) -> Result<Item, E> {
        Ok(Item::Word(word.to_owned()))
    }

    fn visit_seq<S: SeqAccess<'de>>(self, mut list: S) -> Result<Item, S::Error> {
        let mut numbers = Vec::new();
        while let Some(number) = list.next_element()? {
            numbers.push(number);
        }
        Ok(Item::List(numbers))
    }
}
