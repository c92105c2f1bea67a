//! NRML 0.5, the XML of OpenQuake: one root, and texts of numbers.

use std::path::Path;

use crate::error::{InputError, Result};
use roxmltree::{Document, Node};

/// Parses the text of an XML file.
///
/// # Errors
/// An input error with the line.
pub fn parse<'a>(path: &Path, text: &'a str) -> Result<Document<'a>> {
    Ok(Document::parse(text).map_err(|e| {
        InputError::line(path, e.pos().row as usize, e.to_string(), "NRML 0.5 as OpenQuake writes it")
    })?)
}

/// All elements of a name, whatever their namespace.
pub fn elements<'a, 'b>(node: Node<'a, 'b>, name: &'static str) -> impl Iterator<Item = Node<'a, 'b>> {
    node.descendants().filter(move |child| child.is_element() && child.tag_name().name() == name)
}

/// An attribute by any of its names.
pub fn attribute<'a>(node: Node<'a, '_>, names: &[&str]) -> Option<&'a str> {
    names.iter().find_map(|name| node.attribute(*name))
}

/// The numbers of an element's text.
///
/// # Errors
/// An input error with the line of the element.
pub fn numbers(path: &Path, node: Node) -> Result<Vec<f64>> {
    let parse = |word: &str| number(path, node, word);
    node.text().unwrap_or_default().split_whitespace().map(parse).collect()
}

/// A number of an element.
///
/// # Errors
/// As [`numbers`].
pub fn number(path: &Path, node: Node, word: &str) -> Result<f64> {
    let value = word.parse::<f64>().ok().filter(|value| value.is_finite());
    let line = node.document().text_pos_at(node.range().start).row as usize;
    let refuse =
        || InputError::line(path, line, format!("{word:?} in {}", node.tag_name().name()), "a finite number");
    Ok(value.ok_or_else(refuse)?)
}

/// A measure of OpenQuake by the name that mrbd's columns have, in OpenQuake's unit.
pub fn measure(imt: &str) -> String {
    match imt {
        "PGA" => "pga_g".into(),
        "PGV" => "pgv_cm_s".into(),
        "PGD" => "pgd_cm".into(),
        other => format!("{}_g", other.to_lowercase()),
    }
}
