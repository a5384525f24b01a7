//! The page as text.

use std::fmt::Write;

use super::contents::{Page, Section, Verdict};
use crate::plot::Sheet;

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
pre { background: #f4f4f4; padding: .6rem .8rem; overflow-x: auto; font-size: .88rem; }
dl { margin: .4rem 0; } dt { font-weight: 600; margin-top: .5rem; } dd { margin: 0; }
.mark { font-size: .85rem; font-weight: 600; padding: .05rem .5rem; border-radius: 1rem; white-space: nowrap; border: 1px solid; }
.held { color: #00593f; } .shown { color: #555; } .missed, .broken { color: #9a3d00; }
@media (max-width: 700px) { nav { columns: 1; } }
@media print { section { break-inside: avoid; } nav { display: none; } }
";

/// The whole page.
pub(super) fn page(page: &Page) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = write_page(&mut text, page);
    text
}

fn write_page(text: &mut String, page: &Page) -> std::fmt::Result {
    let title = escaped(&page.title);
    writeln!(text, "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">")?;
    writeln!(text, "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">")?;
    // Without this, browsers ask for a picture of their own.
    writeln!(text, "<link rel=\"icon\" href=\"data:,\">")?;
    writeln!(text, "<title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>")?;
    for paragraph in &page.opening {
        writeln!(text, "<p>{}</p>", escaped(paragraph))?;
    }
    if page.sections.len() > 1 {
        writeln!(text, "<nav aria-label=\"Contents\"><ul>")?;
        for section in &page.sections {
            let (id, heading) = (escaped(&section.id), escaped(&section.heading));
            let (verdict, sign) = (&section.verdict, section.verdict.sign());
            let mark = format!("<span class=\"mark {}\" title=\"{}\">{sign}</span>", class(verdict), verdict.word());
            writeln!(text, "<li>{mark} <a href=\"#{id}\">{heading}</a></li>")?;
        }
        writeln!(text, "</ul></nav>")?;
    }
    for section in &page.sections {
        write_section(text, section)?;
    }
    writeln!(text, "</body>\n</html>")
}

fn class(verdict: &Verdict) -> &'static str {
    match verdict {
        Verdict::Shown => "shown",
        Verdict::Held => "held",
        Verdict::Missed => "missed",
        Verdict::Broken(_) => "broken",
    }
}

fn mark(verdict: &Verdict) -> String {
    format!("<span class=\"mark {}\">{}</span>", class(verdict), verdict.word())
}

fn write_section(text: &mut String, section: &Section) -> std::fmt::Result {
    let (id, heading) = (escaped(&section.id), escaped(&section.heading));
    writeln!(text, "<section id=\"{id}\">\n<h2>{heading} {}</h2>", mark(&section.verdict))?;
    if let Verdict::Broken(reason) = &section.verdict {
        writeln!(text, "<p>{}</p>", escaped(reason))?;
    }
    for (index, (alt, svg)) in section.pictures.iter().enumerate() {
        writeln!(text, "<figure>{}</figure>", inline(svg, alt, &format!("{id}-picture-{}", index + 1)))?;
    }
    if !section.words.is_empty() {
        writeln!(text, "<dl>")?;
        for (name, words) in &section.words {
            writeln!(text, "<dt>{}</dt><dd>{}</dd>", escaped(name), escaped(words))?;
        }
        writeln!(text, "</dl>")?;
    }
    section.tables.iter().try_for_each(|table| write_table(text, table))?;
    if !section.commands.is_empty() {
        let commands: Vec<String> = section.commands.iter().map(|command| escaped(command)).collect();
        writeln!(text, "<pre>{}</pre>", commands.join("\n"))?;
    }
    for (file, what) in &section.files {
        let file = escaped(file);
        writeln!(text, "<p><a href=\"{file}\">{file}</a>: {}</p>", escaped(what))?;
    }
    writeln!(text, "</section>")
}

/// A picture as part of the page. The name space is the parser's business there, and an address; it goes.
fn inline(svg: &str, alt: &str, id: &str) -> String {
    let svg = svg.trim_start_matches(|c| c != '<').replace(" xmlns=\"http://www.w3.org/2000/svg\"", "");
    let small = if width(&svg).is_some_and(|width| width < 1000) { " class=\"small\"" } else { "" };
    let opening = format!("<svg id=\"{id}\"{small} role=\"img\" aria-label=\"{}\"", escaped(alt));
    svg.replacen("<svg", &opening, 1)
}

fn width(svg: &str) -> Option<u32> {
    svg.split("width=\"").nth(1)?.split('"').next()?.parse().ok()
}

fn write_table(text: &mut String, table: &Sheet) -> std::fmt::Result {
    let row = |tag: &str, words: &[String]| {
        let cells: Vec<String> = words.iter().map(|word| format!("<{tag}>{}</{tag}>", escaped(word))).collect();
        format!("<tr>{}</tr>", cells.concat())
    };
    writeln!(text, "<table><caption>{}</caption>", escaped(&table.title))?;
    writeln!(text, "<thead>{}</thead><tbody>", row("th", &table.header))?;
    for words in &table.rows {
        writeln!(text, "{}", row("td", words))?;
    }
    writeln!(text, "</tbody></table>")
}

/// Words that HTML takes for words.
fn escaped(words: &str) -> String {
    words.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whatever_the_words_are_they_stay_words() {
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
    fn a_picture_within_the_page_names_no_address() {
        let svg = "<svg width=\"700\" height=\"2\" xmlns=\"http://www.w3.org/2000/svg\"><rect/></svg>";
        let inside = inline(svg, "a \"thing\"", "p");
        assert!(!inside.contains("http"), "{inside}");
        assert!(inside.starts_with("<svg id=\"p\" class=\"small\" role=\"img\" aria-label=\"a &quot;thing&quot;\""));
    }
}
