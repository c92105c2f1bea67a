//! Effects as they stand in wall files and JSON: `kind`, the word it takes, its numbers.

use std::fmt;

use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use mrbd_formula::{CarriedState, Formula, Parameter, Place};

use super::{Effect, EffectEntry, EffectError, EffectKind};

/// A further law as it stands in the `[[effects]]` of a wall file: one of the catalogue, or a formula.
#[derive(Debug, Clone, PartialEq)]
pub enum FurtherLaw {
    /// Of the catalogue.
    Effect(Effect),
    /// A formula.
    Formula(Formula),
}

impl FurtherLaw {
    /// Name among the kinds and their variants; of a formula, its kind and place.
    pub fn name(&self) -> String {
        match self {
            FurtherLaw::Effect(effect) => effect.variant().name(),
            FurtherLaw::Formula(formula) => format!("{}.{}", Formula::KIND, formula.place().name()),
        }
    }

    /// With the numbers by their keys, or the formula.
    pub fn in_words(&self) -> String {
        match self {
            FurtherLaw::Effect(effect) => {
                let keys = effect.entry().parameters.iter().map(|parameter| parameter.key);
                let values = keys.zip(effect.parameters()).map(|(key, value)| format!("{key} = {value}"));
                format!("{} ({})", self.name(), values.collect::<Vec<_>>().join(", "))
            }
            FurtherLaw::Formula(formula) => {
                let with =
                    |p: &Parameter| format!("; {} = {} {}", p.name, p.value, p.unit).trim_end().to_owned();
                let rates = formula.states().iter().map(|s| {
                    let unit = if s.unit.is_empty() { "1" } else { &s.unit };
                    format!("; d{}/dt = {} from {} {unit}", s.name, s.rate, s.start)
                });
                let rates: String = rates.collect();
                let numbers: String = formula.parameters().iter().map(with).collect();
                format!("{} ({} = {formula}{rates}{numbers})", self.name(), formula.place().key())
            }
        }
    }
}

/// In short: an effect by its values alone.
impl fmt::Display for FurtherLaw {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            FurtherLaw::Effect(effect) => write!(f, "{effect:?}"),
            FurtherLaw::Formula(_) => f.write_str(&self.in_words()),
        }
    }
}

impl Serialize for FurtherLaw {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            FurtherLaw::Effect(effect) => effect.serialize(serializer),
            FurtherLaw::Formula(formula) => formula.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for FurtherLaw {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(LawVisitor)
    }
}

struct LawVisitor;

impl<'de> Visitor<'de> for LawVisitor {
    type Value = FurtherLaw;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a table with the kind of an effect and its parameters")
    }

    fn visit_map<M: MapAccess<'de>>(self, map: M) -> Result<FurtherLaw, M::Error> {
        let (kind, items) = kind_and_items(map)?;
        match kind == Formula::KIND {
            true => formula_from_items(items).map(FurtherLaw::Formula).map_err(M::Error::custom),
            false => from_items(&kind, items).map(FurtherLaw::Effect).map_err(M::Error::custom),
        }
    }
}

/// Keys of a formula in wall files.
const FORMULA_KEYS: &str = "`place`, `force_n` at the top, `moment_n_m` at a joint or `factor` at impacts, \
                            `parameters`, `states` at the top";

/// What of a formula is wrong.
fn refused(found: impl Into<String>, allowed: impl Into<String>) -> EffectError {
    EffectError::Keys { kind: Formula::KIND, found: found.into(), allowed: allowed.into() }
}

fn formula_from_items(mut items: Items) -> Result<Formula, EffectError> {
    let mut take = |key: &str| items.iter().position(|(k, _)| k == key).map(|at| items.remove(at).1);
    let place = match take("place") {
        Some(Item::Word(word)) => {
            let known = Place::ALL.map(|place| format!("`{}`", place.name())).join(", ");
            Place::named(&word)
                .ok_or_else(|| refused(format!("`{word}` for `place`"), format!("one of {known}")))?
        }
        Some(other) => return Err(refused(format!("{other} for `place`"), "a word")),
        None => return Err(refused("no `place`", "`top`, `ground`, `crack` or `impacts`")),
    };
    let text = match take(place.key()) {
        Some(Item::Word(text)) => text,
        Some(other) => return Err(refused(format!("{other} for `{}`", place.key()), "a formula in quotes")),
        None => {
            let the = if place == Place::Impacts { "" } else { "the " };
            let allowed = format!("this key with a formula at {the}{}", place.name());
            return Err(refused(format!("no `{}`", place.key()), allowed));
        }
    };
    let parameters = match take("parameters") {
        Some(Item::Table(items)) => items.into_iter().map(parameter).collect::<Result<Vec<_>, _>>()?,
        Some(other) => return Err(refused(format!("{other} for `parameters`"), PARAMETERS)),
        None => Vec::new(),
    };
    let states = match take("states") {
        Some(Item::Table(items)) => items.into_iter().map(state).collect::<Result<Vec<_>, _>>()?,
        Some(other) => return Err(refused(format!("{other} for `states`"), STATES)),
        None => Vec::new(),
    };
    if let Some((key, _)) = items.first() {
        return Err(refused(format!("unknown key `{key}`"), format!("one of {FORMULA_KEYS}")));
    }
    Formula::parse_with_states(&text, place, &parameters, &states).map_err(|e| {
        let key = e.key(place.key());
        refused(format!("{} in `{key}`", e.found_at()), e.allowed)
    })
}

/// What a table of carried states is.
const STATES: &str = "a table [effects.states.NAME] for each state, with rate = \"k*v - z/tau\", start = 0.0, unit = \"N\" and, \
                      where its rate does not bound it, range = [least, largest]";

fn state((name, item): (String, Item)) -> Result<CarriedState, EffectError> {
    let wrong = |found: String| refused(format!("{found} for `states.{name}`"), STATES);
    let Item::Table(items) = item else { return Err(wrong(item.to_string())) };
    let (mut rate, mut start, mut unit, mut range) = (None, None, None, None);
    for (key, item) in items {
        match (key.as_str(), item) {
            ("rate", Item::Word(word)) => rate = Some(word),
            ("start", Item::Number(number)) => start = Some(number),
            ("unit", Item::Word(word)) => unit = Some(word),
            ("range", Item::List(ends)) if ends.len() == 2 => range = Some([ends[0], ends[1]]),
            (key, other) => return Err(wrong(format!("`{key}` = {other}"))),
        }
    }
    match (rate, start, unit) {
        (Some(rate), Some(start), Some(unit)) => Ok(CarriedState { name, rate, start, unit, range }),
        (None, ..) => Err(wrong("no `rate`".to_owned())),
        (_, None, _) => Err(wrong("no `start`".to_owned())),
        (.., None) => Err(wrong("no `unit`".to_owned())),
    }
}

/// What a table of parameters is.
const PARAMETERS: &str =
    "a table [effects.parameters] with lines such as k = { value = 37e3, unit = \"N/m\" }";

fn parameter((name, item): (String, Item)) -> Result<Parameter, EffectError> {
    let wrong = |found: String| refused(format!("{found} for `parameters.{name}`"), PARAMETERS);
    let Item::Table(items) = item else { return Err(wrong(item.to_string())) };
    let (mut value, mut unit) = (None, None);
    for (key, item) in items {
        match (key.as_str(), item) {
            ("value", Item::Number(number)) => value = Some(number),
            ("unit", Item::Word(word)) => unit = Some(word),
            (key, other) => return Err(wrong(format!("`{key}` = {other}"))),
        }
    }
    match (value, unit) {
        (Some(value), Some(unit)) => Ok(Parameter { name, value, unit }),
        (None, _) => Err(wrong("no `value`".to_owned())),
        (_, None) => Err(wrong("no `unit`".to_owned())),
    }
}

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

/// Keys, and what stands behind them.
type Items = Vec<(String, Item)>;

/// What may stand behind a key.
#[derive(Debug, Clone, PartialEq)]
enum Item {
    Number(f64),
    Word(String),
    List(Vec<f64>),
    Table(Items),
}

impl fmt::Display for Item {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Item::Number(number) => write!(f, "{number}"),
            Item::Word(word) => write!(f, "`{word}`"),
            Item::List(list) => write!(f, "a list of {}", list.len()),
            Item::Table(items) => write!(f, "a table of {}", items.len()),
        }
    }
}

struct EffectVisitor;

impl<'de> Visitor<'de> for EffectVisitor {
    type Value = Effect;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a table with the kind of an effect and its parameters")
    }

    fn visit_map<M: MapAccess<'de>>(self, map: M) -> Result<Effect, M::Error> {
        let (kind, items) = kind_and_items(map)?;
        from_items(&kind, items).map_err(M::Error::custom)
    }
}

/// The word behind `kind`, and all else.
fn kind_and_items<'de, M: MapAccess<'de>>(mut map: M) -> Result<(String, Items), M::Error> {
    let mut items = Items::new();
    while let Some(entry) = map.next_entry()? {
        items.push(entry);
    }
    let Some(kind) = items.iter().position(|(key, _)| key == "kind") else {
        return Err(M::Error::missing_field("kind"));
    };
    match items.remove(kind).1 {
        Item::Word(name) => Ok((name, items)),
        other => Err(M::Error::custom(format!("{other} for `kind`, expected a word"))),
    }
}

fn from_items(name: &str, mut items: Items) -> Result<Effect, EffectError> {
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
        f.write_str("a number, a word or a list of numbers, or a table of parameters")
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

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<Item, M::Error> {
        let mut items = Vec::new();
        while let Some(entry) = map.next_entry()? {
            items.push(entry);
        }
        Ok(Item::Table(items))
    }

    fn visit_seq<S: SeqAccess<'de>>(self, mut list: S) -> Result<Item, S::Error> {
        let mut numbers = Vec::new();
        while let Some(number) = list.next_element()? {
            numbers.push(number);
        }
        Ok(Item::List(numbers))
    }
}
