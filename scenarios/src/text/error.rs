//! Errors with a place in a text.
//!
//! A [`Fault`] is one fault at one [`Place`] of one [`Document`]; a [`LoadError`] holds all faults that were found.
//! Both are `miette` diagnostics, so the caller decides how to show them.

use std::{fmt, ops::Range, sync::Arc};

use miette::{Diagnostic, LabeledSpan, MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};
use thiserror::Error;

use crate::text::plain_text::is_plain;

/// Excerpts longer than this are cut around the error \[bytes\].
const MAX_EXCERPT_BYTES: usize = 2000;
/// How much of a long line is shown before the error \[bytes\].
const CONTEXT_BYTES: usize = 60;
/// How much of a long text is underlined \[bytes\].
const MAX_UNDERLINED_BYTES: usize = 100;

/// A text in which an error may lie: a file, the argument of a flag, or a key of a scenario that code made.
#[derive(Debug)]
pub(crate) struct Document {
    /// The name that errors give it.
    pub name: String,
    /// Whether it is a key, whose path is its name, and not a text with lines.
    is_key: bool,
    /// The text with control characters masked, byte for byte as long as the original.
    text: String,
    /// Errors are listed by rank of their document: flags first, then the file, then what it extends.
    pub rank: usize,
}

impl Document {
    pub fn new(name: impl Into<String>, text: &str, rank: usize) -> Arc<Document> {
        Arc::new(Document { name: name.into(), is_key: false, text: text.chars().map(masked).collect(), rank })
    }

    /// A document for errors in a scenario that code made: the path of one key, with its value as the text.
    pub fn of_key(path: &str, text: &str, rank: usize) -> Arc<Document> {
        Arc::new(Document { name: path.to_owned(), is_key: true, text: text.chars().map(masked).collect(), rank })
    }

    /// The same document with another rank.
    pub fn ranked(&self, rank: usize) -> Arc<Document> {
        Arc::new(Document { name: self.name.clone(), is_key: self.is_key, text: self.text.clone(), rank })
    }

    /// The key at a span: the span itself if a value follows, else the last key before it on its line, or the header of a table.
    fn key_at(&self, span: &Range<usize>) -> Option<&str> {
        let (before, after) = (self.text.get(..span.start)?, self.text.get(span.end..)?);
        let is_of_key = |letter: char| letter.is_alphanumeric() || "_-.*\"'".contains(letter);
        if after.trim_start().starts_with('=') {
            return self.text.get(span.clone());
        }
        let line = before.rsplit('\n').next().unwrap_or_default();
        let of_value = line.rfind('=').map(|at| line[..at].trim_end());
        let header = || line.trim_start().trim_start_matches('[').trim();
        let text = of_value.unwrap_or_else(header);
        let key = text.rsplit(|letter: char| !is_of_key(letter)).next().unwrap_or_default();
        let key = if of_value.is_none() && key.is_empty() { self.text.get(span.clone())? } else { key };
        Some(key).filter(|key| !key.is_empty() && key.chars().all(is_of_key))
    }

    fn has_same_text(&self, other: &Document) -> bool {
        std::ptr::eq(self, other) || (self.name == other.name && self.text == other.text)
    }

    /// Line and column of a byte offset, both from 1, the column in characters.
    fn line_and_column(&self, offset: usize) -> (usize, usize) {
        let before = &self.text[..self.text.floor_char_boundary(offset)];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
    }

    /// The part of a line around `span`, where whole lines would be too long to read.
    fn window(&self, span: &SourceSpan) -> Range<usize> {
        let (offset, text) = (self.text.floor_char_boundary(span.offset()), &self.text);
        let line_start = text[..offset].rfind('\n').map_or(0, |newline| newline + 1);
        let line_end = text[offset..].find('\n').map_or(text.len(), |newline| offset + newline);
        let start = text.floor_char_boundary(offset.saturating_sub(CONTEXT_BYTES)).max(line_start);
        let end = text.ceil_char_boundary(offset + span.len() + CONTEXT_BYTES).min(line_end);
        start..end.max(start)
    }
}

/// Control characters could play tricks on a terminal; a dot of the same length takes their place.
fn masked(character: char) -> char {
    match character {
        '\r' => character,
        _ if is_plain(character) => character,
        _ if character.len_utf8() == 1 => '.',
        _ if character.len_utf8() == 2 => '·',
        _ => char::REPLACEMENT_CHARACTER,
    }
}

impl SourceCode for Document {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        lines_before: usize,
        lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let lines = self.text.as_str().read_span(span, lines_before, lines_after)?;
        let (range, line, column) = if lines.data().len() <= MAX_EXCERPT_BYTES {
            let start = lines.span().offset();
            (start..start + lines.span().len(), lines.line(), lines.column())
        } else {
            let window = self.window(span);
            let (line, column) = self.line_and_column(window.start);
            (window, line - 1, column - 1)
        };
        let data = &self.text.as_bytes()[range.clone()];
        let span = SourceSpan::from((range.start, range.len()));
        Ok(Box::new(MietteSpanContents::new_named(self.name.clone(), data, span, line, column, lines.line_count())))
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Place {
    pub document: Arc<Document>,
    pub span: Range<usize>,
}

impl Place {
    pub fn new(document: &Arc<Document>, span: Range<usize>) -> Place {
        Place { document: Arc::clone(document), span }
    }

    /// Whether this place contains the other one.
    pub fn holds(&self, other: &Place) -> bool {
        let (own, other_span) = (&self.span, &other.span);
        let is_within = own.start <= other_span.start && other_span.end <= own.end;
        is_within && self.document.has_same_text(&other.document)
    }

    /// The span to underline: within the text, on one line, not too long.
    fn underlined(&self) -> SourceSpan {
        let text = &self.document.text;
        let start = text.floor_char_boundary(self.span.start);
        let line_end = text[start..].find(['\n', '\r']).map_or(text.len(), |newline| start + newline);
        let end = self.span.end.min(line_end).min(start + MAX_UNDERLINED_BYTES);
        SourceSpan::from((start, text.floor_char_boundary(end).saturating_sub(start)))
    }
}

/// A fault of a scenario, and what would work instead.
#[derive(Clone, Debug, Error)]
#[error("{message}")]
pub struct Fault {
    message: String,
    help: Option<String>,
    place: Option<Place>,
    labels: Vec<LabeledSpan>,
}

impl Fault {
    /// A fault that no text can be blamed for, such as a missing file.
    pub(crate) fn new(message: impl Into<String>) -> Fault {
        Fault { message: message.into(), help: None, place: None, labels: Vec::new() }
    }

    /// A fault at a place; `label` stands beside the underlined text.
    pub(crate) fn at(place: &Place, label: &str, message: impl Into<String>) -> Fault {
        let span = LabeledSpan::new_primary_with_span(Some(label.to_owned()), place.underlined());
        Fault { message: message.into(), help: None, place: Some(place.clone()), labels: vec![span] }
    }

    /// With a hint at what would work.
    pub(crate) fn help(mut self, help: impl Into<String>) -> Fault {
        self.help = Some(help.into());
        self
    }

    /// With a second place, shown if it is in the same document.
    pub(crate) fn also(mut self, other: &Place, label: &str) -> Fault {
        if self.place.as_ref().is_some_and(|place| place.document.has_same_text(&other.document)) {
            self.labels.push(LabeledSpan::new_with_span(Some(label.to_owned()), other.underlined()));
        }
        self
    }

    /// The same fault, blamed on the text that led there.
    pub(crate) fn moved_to(self, place: &Place) -> Fault {
        Fault { help: self.help, ..Fault::at(place, "from here", self.message) }
    }

    /// The same fault, of a run that differs from the scenario's own.
    pub(crate) fn in_counterfactual(self, name: &str) -> Fault {
        Fault { message: format!("in the counterfactual {}: {}", quoted(name), self.message), ..self }
    }

    /// The same fault, with where it shows in front.
    pub(crate) fn within(self, whole: &str) -> Fault {
        Fault { message: format!("{whole}: {}", self.message), ..self }
    }

    /// The same fault, with more words behind.
    pub(crate) fn ending(self, more: &str) -> Fault {
        Fault { message: format!("{}{more}", self.message), ..self }
    }

    /// Where it is written, if some text is to blame.
    pub(crate) fn place(&self) -> Option<&Place> {
        self.place.as_ref()
    }

    /// What would work instead, if known.
    pub fn hint(&self) -> Option<&str> {
        self.help.as_deref()
    }

    /// The text that says what is wrong.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// The file or the flag that contains the error; in a scenario that code made, the path of the key, such as
    /// `vehicle.ego.start.lane`. `None` if the error has no place.
    pub fn file(&self) -> Option<&str> {
        self.place.as_ref().map(|place| place.document.name.as_str())
    }

    /// Line and column of the error, both from 1; `None` if the error has no place in a text.
    pub fn line_and_column(&self) -> Option<(usize, usize)> {
        self.place
            .as_ref()
            .filter(|place| !place.document.is_key)
            .map(|place| place.document.line_and_column(place.span.start))
    }

    /// The key that contains the error: in a text, the key on its line, such as `speed_mps`; in a scenario that code
    /// made, its whole path.
    pub fn key(&self) -> Option<&str> {
        let place = self.place.as_ref()?;
        if place.document.is_key {
            return self.file();
        }
        place.document.key_at(&place.span)
    }

    fn order(&self) -> (usize, usize) {
        self.place.as_ref().map_or((0, 0), |place| (place.document.rank, place.span.start))
    }
}

impl From<Fault> for Vec<Fault> {
    fn from(fault: Fault) -> Vec<Fault> {
        vec![fault]
    }
}

impl Diagnostic for Fault {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.help.as_ref().map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.place.as_ref().map(|place| place.document.as_ref() as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        Some(Box::new(self.labels.iter().cloned()))
    }
}

/// Why a scenario or a plan cannot be used: all faults that were found.
#[derive(Clone, Debug, Error, Diagnostic)]
#[error("cannot use {what} {}: {}", quoted(name), counted(faults.len() + left_out))]
pub struct LoadError {
    /// `scenario` or `plan`.
    what: &'static str,
    name: String,
    #[related]
    faults: Vec<Fault>,
    left_out: usize,
    #[help]
    more: Option<String>,
}

impl LoadError {
    /// How many faults are reported at most.
    const MAX_FAULTS: usize = 20;

    pub(crate) fn new(scenario: impl Into<String>, faults: Vec<Fault>) -> LoadError {
        LoadError::of("scenario", scenario, faults)
    }

    /// What is wrong with a plan.
    pub(crate) fn of_plan(plan: impl Into<String>, faults: Vec<Fault>) -> LoadError {
        LoadError::of("plan", plan, faults)
    }

    fn of(what: &'static str, name: impl Into<String>, mut faults: Vec<Fault>) -> LoadError {
        faults.sort_by_key(Fault::order);
        let left_out = faults.len().saturating_sub(LoadError::MAX_FAULTS);
        faults.truncate(LoadError::MAX_FAULTS);
        let more = (left_out > 0).then(|| format!("{left_out} more are not shown; fix these first"));
        LoadError { what, name: name.into(), faults, left_out, more }
    }

    /// The faults in the order of the text; at most 20.
    pub fn faults(&self) -> &[Fault] {
        &self.faults
    }
}

fn counted(faults: usize) -> String {
    if faults == 1 { "1 error".to_owned() } else { format!("{faults} errors") }
}

/// A text from outside in backticks, without control characters and not too long.
pub(crate) fn quoted(text: &str) -> String {
    const MAX_CHARACTERS: usize = 80;
    let shown: String =
        text.chars().take(MAX_CHARACTERS).map(masked).map(|c| if c == '\n' || c == '\r' { ' ' } else { c }).collect();
    let dots = if text.chars().nth(MAX_CHARACTERS).is_some() { "…" } else { "" };
    format!("`{shown}{dots}`")
}
