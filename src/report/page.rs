//! A page: sections of text, figures and tables, made into one HTML file that needs nothing else.

use minijinja::{AutoEscape, Environment, context};
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use serde::Serialize;

use super::chart::{Colour, Mark};
use crate::error::{Error, Result};

/// A page.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Page {
    /// Code of its language; empty for English.
    pub lang: &'static str,
    /// Title.
    pub title: String,
    /// What it shows, in a sentence or two.
    pub lead: String,
    /// That the results are not all there, and how many are; `None` where they are.
    pub unfinished: Option<String>,
    /// Numbers to read first.
    pub numbers: Vec<Number>,
    /// What is generated, assumed, or missing, each a sentence.
    pub notes: Vec<String>,
    /// The sections.
    pub sections: Vec<Section>,
    /// Where it comes from: names and values.
    pub provenance: Vec<(String, String)>,
    /// Whose equation, table and figure numbers it has; empty for the paper's.
    pub footer: String,
    /// Files behind it.
    pub files: Vec<Link>,
}

/// A number to read first.
#[derive(Debug, Clone, Serialize)]
pub struct Number {
    /// The number.
    pub value: String,
    /// What it counts.
    pub meaning: String,
}

impl Number {
    /// A number and what it counts.
    pub fn new(value: impl ToString, meaning: impl Into<String>) -> Self {
        Self { value: value.to_string(), meaning: meaning.into() }
    }
}

/// A section.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Section {
    /// Anchor.
    pub id: String,
    /// Title.
    pub title: String,
    /// Paragraphs above the figures.
    pub text: Vec<String>,
    /// The wall in motion.
    pub motion: Option<Motion>,
    /// Figures.
    pub figures: Vec<Figure>,
    /// Tables.
    pub tables: Vec<Table>,
}

/// A figure: panels under one legend.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Figure {
    /// Anchor.
    pub id: String,
    /// Title.
    pub title: String,
    /// The figure of the paper it answers to.
    pub paper: Option<String>,
    /// Curves.
    pub legend: Vec<Key>,
    /// Panels as SVG.
    pub panels: Vec<String>,
    /// Whether each panel takes the whole width.
    pub wide: bool,
    /// What it shows.
    pub caption: String,
    /// Files behind it.
    pub links: Vec<Link>,
}

/// A curve in a legend.
#[derive(Debug, Clone, Serialize)]
pub struct Key {
    /// Name.
    pub label: String,
    /// Colour.
    pub colour: String,
    /// Shape of its points.
    pub mark: Mark,
}

impl Key {
    /// A name, the colour and the mark of its curve.
    pub fn new(label: impl Into<String>, colour: Colour, mark: Mark) -> Self {
        Self { label: label.into(), colour: colour.hex(), mark }
    }
}

/// A link to a file beside the page.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Link {
    /// Text.
    pub text: String,
    /// Relative address.
    pub href: String,
}

impl Link {
    /// A file beside the page, under its own name.
    pub fn to(name: &str) -> Self {
        Self { text: name.to_owned(), href: address(name) }
    }
}

/// A table; the first cell of each row heads it.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Table {
    /// What it shows.
    pub caption: String,
    /// Whether its cells are sentences, which stand below each other on a narrow page.
    pub prose: bool,
    /// Heads of the columns.
    pub head: Vec<String>,
    /// Rows.
    pub rows: Vec<Vec<Cell>>,
}

impl Table {
    /// A table of plain cells.
    pub fn of(caption: &str, head: &[&str], rows: impl Iterator<Item = Vec<String>>) -> Self {
        Self {
            caption: caption.to_owned(),
            prose: false,
            head: head.iter().map(|&head| head.to_owned()).collect(),
            rows: rows.map(|row| row.into_iter().map(Cell::from).collect()).collect(),
        }
    }
}

/// A cell of a table.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Cell {
    /// Text.
    pub text: String,
    /// Class that colours it; empty for none.
    pub class: &'static str,
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self { text, class: "" }
    }
}

/// The wall in motion: data for the script.
#[derive(Debug, Clone, Serialize)]
pub struct Motion {
    /// Data, JSON that is safe inside a script element.
    pub data: String,
}

/// The script of the moving wall, its parts in one scope of their own.
const MOTION: &str = concat!(
    "\"use strict\";\n(() => {\n",
    include_str!("templates/motion/geometry.js"),
    include_str!("templates/motion/stage.js"),
    include_str!("templates/motion/strip.js"),
    include_str!("templates/motion/controls.js"),
    include_str!("templates/motion/play.js"),
    "})();\n"
);

impl Page {
    /// The page as HTML.
    ///
    /// # Errors
    /// [`crate::Error::Picture`] if the template refuses, which is a defect.
    pub fn html(&self) -> Result<String> {
        let mut environment = Environment::new();
        environment.set_auto_escape_callback(|_| AutoEscape::Html);
        environment.add_template("page", include_str!("templates/page.html")).map_err(failed)?;
        let moves = self.sections.iter().any(|section| section.motion.is_some());
        let page = context! {
            page => self,
            style => include_str!("templates/style.css"),
            script => include_str!("templates/figures.js"),
            motion => moves.then_some(MOTION),
            version => env!("CARGO_PKG_VERSION"),
        };
        environment.get_template("page").and_then(|template| template.render(page)).map_err(failed)
    }
}

/// Bytes that are odd in an address: all but letters, digits and these (RFC 3986, section 2.1).
const ODD: &AsciiSet = &NON_ALPHANUMERIC.remove(b'/').remove(b'.').remove(b'_').remove(b'-').remove(b'=');

/// A relative address of a file.
pub fn address(path: &str) -> String {
    utf8_percent_encode(path, ODD).to_string()
}

fn failed(error: minijinja::Error) -> Error {
    Error::Picture { message: error.to_string() }
}

/// JSON that cannot end the script element it stands in.
pub fn script_safe(json: &serde_json::Value) -> String {
    json.to_string().replace('<', "\\u003c").replace("\u{2028}", "\\u2028").replace("\u{2029}", "\\u2029")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_odd_bytes_are_escaped_and_plain_ones_stay() {
        assert_eq!(address("a b/c=ü"), "a%20b/c=%C3%BC");
    }

    #[test]
    fn regress_texts_cannot_become_markup() {
        let page = Page {
            title: "<script>alert(1)</script>".into(),
            notes: vec!["a & b".into()],
            files: vec![Link { text: "x".into(), href: address("runs/record=a%20b/\"") }],
            ..Page::default()
        };
        let html = page.html().expect("a page");
        assert!(!html.contains("<script>alert"));
        assert!(html.contains("&lt;script&gt;alert(1)") && html.contains("a &amp; b"));
        assert!(
            html.contains("runs/record=a%2520b/%22") || html.contains("runs&#x2f;record=a%2520b&#x2f;%22")
        );
    }

    #[test]
    fn regress_data_cannot_end_its_script() {
        let text = script_safe(&serde_json::json!({ "name": "</script><b>" }));
        assert!(!text.contains('<') && text.contains("\\u003c/script>"));
    }

    #[test]
    fn regress_a_page_asks_the_network_for_nothing() {
        let html = Page::default().html().expect("a page");
        let allowed = html.replace("http://www.w3.org/2000/svg", "");
        assert_eq!(html.matches("<link").count(), 1, "the empty icon alone");
        for reach in ["http:", "https:", "src=", "@import", "fetch("] {
            assert!(!allowed.contains(reach), "{reach}");
        }
    }
}
