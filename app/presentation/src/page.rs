//! A page: one HTML file that shows pictures and tables, with everything in it and no address outside.
//!
//! Pictures are SVG inside the text, and there are no scripts. A page opens from a folder, offline, in any browser.

use std::path::Path;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::plot::TextTable;

/// The content of a page, from which HTML is made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    pub title: String,
    pub opening: Vec<String>,
    pub sections: Vec<Section>,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Anchor for links, unique on the page.
    pub id: String,
    pub heading: String,
    /// Whether the expectations of the section held.
    pub verdict: SectionStatus,
    pub words: Vec<(String, String)>,
    /// Pictures as SVG, each with its alternative text.
    pub pictures: Vec<(String, String)>,
    pub tables: Vec<TextTable>,
    pub commands: Vec<String>,
    /// Files in the folder of the page, each with its description.
    pub files: Vec<(String, String)>,
}

/// Whether the expectations of a section held.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum SectionStatus {
    #[default]
    Shown,
    Held,
    Missed,
    /// The section could not be made, with the reason.
    Broken(String),
}

impl SectionStatus {
    pub fn word(&self) -> &'static str {
        match self {
            SectionStatus::Shown => "shown",
            SectionStatus::Held => "expectations held",
            SectionStatus::Missed => "an expectation failed",
            SectionStatus::Broken(_) => "could not be made",
        }
    }

    fn sign(&self) -> &'static str {
        match self {
            SectionStatus::Shown => "–",
            SectionStatus::Held => "✓",
            SectionStatus::Missed | SectionStatus::Broken(_) => "✗",
        }
    }
}

const STYLE: &str = "\
body { font: 16px/1.5 system-ui, sans-serif; color: #1a1a1a; background: #fff; margin: 0 auto; max-width: 1120px; padding: 1rem 1.5rem 4rem; }
h1 { font-size: 1.7rem; margin: 1rem 0 .5rem; } h2 { font-size: 1.25rem; margin: 0 0 .5rem; }
nav { columns: 2; font-size: .92rem; margin: 1rem 0 2rem; } nav ul { margin: 0; padding: 0; list-style: none; }
section { border-top: 2px solid #ddd; padding-top: 1.2rem; margin-top: 2.2rem; }
figure { margin: 0; } nav .mark { border: 0; padding: 0; }
svg { display: block; width: 100%; height: auto; max-width: 1120px; margin: .8rem 0; font-family: 'DejaVu Sans', sans-serif; }
svg.small { width: auto; max-width: 100%; }
table { border-collapse: collapse; font-size: .9rem; margin: .8rem 0; display: block; overflow-x: auto; }
caption { text-align: left; font-weight: 600; padding: .3rem 0; } th, td { text-align: left; vertical-align: top; padding: .25rem .9rem .25rem 0; border-bottom: 1px solid #ddd; }
pre { background: #f4f4f4; padding: .6rem .8rem; overflow-x: auto; font-size: .88rem; white-space: pre-wrap; }
dl { margin: .4rem 0; } dt { font-weight: 600; margin-top: .5rem; } dd { margin: 0; }
.mark { font-size: .85rem; font-weight: 600; padding: .05rem .5rem; border-radius: 1rem; white-space: nowrap; border: 1px solid; }
.held { color: #00593f; } .shown { color: #555; } .missed, .broken { color: #9a3d00; }
@media (max-width: 700px) { body { padding: .5rem .8rem 3rem; } nav { columns: 1; } figure { overflow-x: auto; } pre { white-space: pre; } svg, svg.small { width: 720px; max-width: none; } th, td { padding-right: .5rem; } dd, td:first-child { overflow-wrap: anywhere; } td:first-child { min-width: 7.5rem; } }
@media print { section { break-inside: avoid; } nav { display: none; } }
";

/// The value of the meta tag `generator`, which marks pages of Interplay.
const GENERATOR: &str = "Interplay";

fn whole_page(page: &Page) -> String {
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="generator" content=(GENERATOR);
                // Without this, browsers request a favicon.
                link rel="icon" href="data:,";
                title { (page.title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { (page.title) }
                @for paragraph in &page.opening { p { (paragraph) } }
                @if page.sections.len() > 1 { (contents(&page.sections)) }
                @for section in &page.sections { (part(section)) }
            }
        }
    };
    markup.into_string()
}

/// Links to all parts.
fn contents(sections: &[Section]) -> Markup {
    html! {
        nav aria-label="Contents" {
            ul {
                @for Section { id, heading, verdict, .. } in sections {
                    li {
                        span class={ "mark " (class(verdict)) } title=(verdict.word()) { (verdict.sign()) }
                        " " a href={ "#" (id) } { (heading) }
                    }
                }
            }
        }
    }
}

fn class(verdict: &SectionStatus) -> &'static str {
    match verdict {
        SectionStatus::Shown => "shown",
        SectionStatus::Held => "held",
        SectionStatus::Missed => "missed",
        SectionStatus::Broken(_) => "broken",
    }
}

fn part(section: &Section) -> Markup {
    let Section { id, heading, verdict, .. } = section;
    html! {
        section id=(id) {
            h2 { (heading) " " span class={ "mark " (class(verdict)) } { (verdict.word()) } }
            @if let SectionStatus::Broken(reason) = verdict { p { (reason) } }
            @for (index, (alt, svg)) in section.pictures.iter().enumerate() {
                figure { (inline(svg, alt, &format!("{id}-picture-{}", index + 1))) }
            }
            @if !section.words.is_empty() {
                dl {
                    @for (name, words) in &section.words { dt { (name) } dd { (words) } }
                }
            }
            @for table in &section.tables { (table_markup(table)) }
            @if !section.commands.is_empty() { pre { (section.commands.join("\n")) } }
            @for (file, what) in &section.files {
                p { a href=(file) { (file) } ": " (what) }
            }
        }
    }
}

fn table_markup(table: &TextTable) -> Markup {
    html! {
        table {
            caption { (table.title) }
            thead { tr { @for word in &table.header { th { (word) } } } }
            tbody {
                @for words in &table.rows { tr { @for word in words { td { (word) } } } }
            }
        }
    }
}

/// A picture as an element of the page, without the XML name space, which HTML does not need.
fn inline(svg: &str, alt: &str, id: &str) -> Markup {
    let svg = svg.trim_start_matches(|c| c != '<').replace(" xmlns=\"http://www.w3.org/2000/svg\"", "");
    let small = width(&svg).is_some_and(|width| width < 1000);
    // An element without content consists of its opening tag, which has all attributes.
    let opening = html! { svg id=(id) class=[small.then_some("small")] role="img" aria-label=(alt); }.into_string();
    PreEscaped(svg.replacen("<svg", opening.trim_end_matches('>'), 1))
}

fn width(svg: &str) -> Option<u32> {
    svg.split("width=\"").nth(1)?.split('"').next()?.parse().ok()
}

impl Page {
    /// The page as one HTML file.
    pub fn html(&self) -> String {
        whole_page(self)
    }

    /// Whether the file at a path exists and was not written by Interplay, so that a page must not replace it.
    pub fn is_taken(path: &Path) -> bool {
        let Ok(text) = std::fs::read(path) else { return path.exists() };
        let mark = format!("<meta name=\"generator\" content=\"{}\">", GENERATOR);
        !text.windows(mark.len()).any(|part| part == mark.as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_texts_is_escaped() {
        let section = Section {
            id: "x".to_owned(),
            heading: "<script>alert(1)</script>".to_owned(),
            words: vec![("a & b".to_owned(), "\"<b>\"".to_owned())],
            ..Section::default()
        };
        let html = Page { title: "</title>".to_owned(), opening: Vec::new(), sections: vec![section] }.html();
        assert!(!html.contains("<script") && !html.contains("<b>"), "{html}");
        assert!(
            html.contains("&lt;script&gt;") && html.contains("a &amp; b") && html.contains("&quot;&lt;b&gt;&quot;")
        );
    }

    #[test]
    fn an_inlined_picture_contains_no_address() {
        let svg = "<svg width=\"700\" height=\"2\" xmlns=\"http://www.w3.org/2000/svg\"><rect/></svg>";
        let inside = inline(svg, "a \"thing\"", "p").into_string();
        assert!(!inside.contains("http"), "{inside}");
        assert!(inside.starts_with("<svg id=\"p\" class=\"small\" role=\"img\" aria-label=\"a &quot;thing&quot;\""));
    }
}
