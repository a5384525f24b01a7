//! XML as elements with their places in the text. Only this file names the parser.

use std::collections::BTreeMap;
use std::sync::Arc;

use roxmltree::{Node, ParsingOptions};

use crate::text::error::{Document, Fault, Place, quoted};

/// The most elements, attributes and texts of a file; the largest published scenarios have fewer than a million.
const MAX_NODES: u32 = 8_000_000;
/// The largest number that is read, of any unit.
const MAX_NUMBER: f64 = 1e9;

pub(super) struct Xml<'a> {
    tree: roxmltree::Document<'a>,
    document: Arc<Document>,
}

impl<'a> Xml<'a> {
    /// Parses a text; `name` is what errors call it.
    ///
    /// # Errors
    /// If it is not well-formed XML.
    pub(super) fn parse(name: &str, text: &'a str) -> Result<Xml<'a>, Fault> {
        let document = Document::new(name, text, 1);
        let options = ParsingOptions { allow_dtd: false, nodes_limit: MAX_NODES, ..ParsingOptions::default() };
        match roxmltree::Document::parse_with_options(text, options) {
            Ok(tree) => Ok(Xml { tree, document }),
            Err(error) => {
                let at = error.pos();
                let offset = offset(text, at.row as usize, at.col as usize);
                let place = Place::new(&document, offset..offset + 1);
                Err(Fault::at(&place, "here", format!("not valid XML: {error}")))
            }
        }
    }

    pub(super) fn root(&self) -> Element<'_> {
        Element { node: self.tree.root_element(), document: &self.document }
    }
}

/// The byte at a row and a column in characters, both from 1.
fn offset(text: &str, row: usize, column: usize) -> usize {
    let line_start: usize = text.split_inclusive('\n').take(row.saturating_sub(1)).map(str::len).sum();
    let line = &text[line_start.min(text.len())..];
    let within = line.char_indices().nth(column.saturating_sub(1)).map_or(0, |(byte, _)| byte);
    line_start + within
}

/// An element of the text.
#[derive(Clone, Copy)]
pub(super) struct Element<'a> {
    node: Node<'a, 'a>,
    document: &'a Arc<Document>,
}

impl<'a> Element<'a> {
    pub(super) fn name(&self) -> &'a str {
        self.node.tag_name().name()
    }

    /// The elements in it, in order.
    pub(super) fn elements(&self) -> impl Iterator<Item = Element<'a>> + use<'a> {
        let document = self.document;
        self.node.children().filter(Node::is_element).map(move |node| Element { node, document })
    }

    /// The elements of a name in it, in order.
    pub(super) fn children(&self, name: &'static str) -> impl Iterator<Item = Element<'a>> + use<'a> {
        self.elements().filter(move |element| element.name() == name)
    }

    /// The first element of a name in it.
    pub(super) fn child(&self, name: &'static str) -> Option<Element<'a>> {
        self.children(name).next()
    }

    /// The first element of a name in it.
    ///
    /// # Errors
    /// Where there is none.
    pub(super) fn required(&self, name: &'static str) -> Result<Element<'a>, Fault> {
        let missing = || format!("{} has no `{name}`", self.shown());
        self.child(name).ok_or_else(|| self.fault(&format!("has no `{name}`"), missing()))
    }

    pub(super) fn attribute(&self, name: &str) -> Option<&'a str> {
        self.node.attribute(name).map(str::trim)
    }

    /// The value of an attribute.
    ///
    /// # Errors
    /// Where it is not stated.
    pub(super) fn required_attribute(&self, name: &str) -> Result<&'a str, Fault> {
        let missing = || format!("{} has no attribute `{name}`", self.shown());
        self.attribute(name).ok_or_else(|| self.fault(&format!("has no `{name}`"), missing()))
    }

    pub(super) fn text(&self) -> &'a str {
        self.node.text().unwrap_or_default().trim()
    }

    /// The number in it.
    ///
    /// # Errors
    /// For a text that is not a number, and for a number that is not finite or has more than nine digits.
    pub(super) fn number(&self) -> Result<f64, Fault> {
        self.as_number(self.text())
    }

    /// A text of the element as a number.
    ///
    /// # Errors
    /// As [`Element::number`].
    pub(super) fn as_number(&self, text: &str) -> Result<f64, Fault> {
        let value: Option<f64> = text.parse().ok();
        value.filter(|value| value.abs() <= MAX_NUMBER).ok_or_else(|| {
            let message = format!("{} is {}, which is not a number up to {MAX_NUMBER:.0}", self.shown(), quoted(text));
            self.fault("no number", message)
        })
    }

    /// The numbers between which a value lies: `exact`, or `intervalStart` and `intervalEnd`.
    ///
    /// # Errors
    /// For a value that is neither, and an interval that ends before it begins.
    pub(super) fn interval(&self) -> Result<[f64; 2], Fault> {
        if let Some(exact) = self.child("exact") {
            return exact.number().map(|value| [value; 2]);
        }
        let from = self.required("intervalStart")?.number()?;
        let to = self.required("intervalEnd")?.number()?;
        if from <= to {
            return Ok([from, to]);
        }
        Err(self.fault("no interval", format!("{} ends at {to} and begins at {from}", self.shown())))
    }

    /// Which element it is, in words: its name, and its id if it has one.
    pub(super) fn shown(&self) -> String {
        let id = self.attribute("id").map(|id| format!(" {}", quoted(id)));
        format!("`{}`{}", self.name(), id.unwrap_or_default())
    }

    /// Its text as it is written, tags included.
    pub(super) fn source(&self) -> &'a str {
        self.node.document().input_text().get(self.node.range()).unwrap_or_default()
    }

    pub(super) fn place(&self) -> Place {
        Place::new(self.document, self.node.range())
    }

    /// Something wrong with it; `label` stands beside the underlined text.
    pub(super) fn fault(&self, label: &str, message: String) -> Fault {
        Fault::at(&self.place(), label, message)
    }
}

/// Elements that were not read, by their path in the file, such as `lanelet/userBidirectional`, and how many there are.
#[derive(Debug, Default)]
pub(super) struct Unread(BTreeMap<String, usize>);

impl Unread {
    /// Counts what is in an element besides what is read of it.
    pub(super) fn count_beyond(&mut self, element: Element<'_>, read: &[&str]) {
        for other in element.elements().filter(|other| !read.contains(&other.name())) {
            *self.0.entry(format!("{}/{}", element.name(), other.name())).or_default() += 1;
        }
    }

    /// What was counted, by its place.
    pub(super) fn into_counts(self) -> impl Iterator<Item = (String, usize)> {
        self.0.into_iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_located_where_the_xml_is_malformed() {
        let fault = Xml::parse("a.xml", "<a>\n  <b></c>\n</a>").err().expect("not closed");
        assert_eq!(fault.line_and_column().map(|(line, _)| line), Some(2), "{fault}");
        assert!(Xml::parse("a.xml", "<!DOCTYPE a [<!ENTITY b \"c\">]><a>&b;</a>").is_err(), "no entities");
        assert!(Xml::parse("a.xml", "").is_err() && Xml::parse("a.xml", "ä").is_err());
    }

    #[test]
    fn xml_numbers_must_be_finite() {
        for (text, is_number) in
            [("1.5", true), (" -2e3\n", true), ("", false), ("NaN", false), ("inf", false), ("1e10", false)]
        {
            let text = format!("<x>{text}</x>");
            let xml = Xml::parse("a.xml", &text).expect("well-formed");
            assert_eq!(xml.root().number().is_ok(), is_number, "{text}");
        }
    }
}
