//! Every number that decides a diagnosis: limits, shares, gains and counts, in the order of the flow.
//!
//! Numbers of methods stay beside them: step lengths, damping, test functions, seeds. `docs/diagnosis.md` gets its tables
//! from here; the first paragraph of each is what it shows.

/// A limit as the guide shows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limit {
    /// Name of the constant.
    pub name: &'static str,
    /// Its value.
    pub value: &'static str,
    /// Its unit; empty for a count.
    pub unit: &'static str,
    doc: &'static str,
}

impl Limit {
    /// What it decides: the first paragraph of its documentation.
    pub fn meaning(&self) -> String {
        let first = self.doc.split("\n\n").next().unwrap_or_default();
        first.split_whitespace().collect::<Vec<_>>().join(" ")
    }
}

/// Constants, and the same as rows of a table.
macro_rules! limits {
    ($(#[doc = $about:literal])+ $group:ident:
     $($(#[doc = $doc:literal])+ $name:ident: $type:ty = $value:expr, $unit:literal;)+) => {
        $($(#[doc = $doc])+ pub const $name: $type = $value;)+
        $(#[doc = $about])+
        pub const $group: &[Limit] = &[$(Limit {
            name: stringify!($name),
            value: stringify!($value),
            unit: $unit,
            doc: concat!($($doc, "\n"),+),
        }),+];
    };
}

mod naming;
mod outside;
mod reading;
mod trying;

pub use naming::*;
pub use outside::*;
pub use reading::*;
pub use trying::*;

/// Every group by its name in the guide.
pub const GROUPS: [(&str, &[Limit]); 14] = [
    ("files", FILES),
    ("patterns", PATTERNS),
    ("windows", WINDOWS),
    ("known", KNOWN),
    ("tried", TRIED),
    ("beds", BEDS),
    ("named", NAMED),
    ("impacts", IMPACTS),
    ("remainder", REMAINDER),
    ("second", SECOND),
    ("other law", OTHER_LAW),
    ("place", PLACE),
    ("formula", FORMULA),
    ("beyond", BEYOND),
];
