//! The search for figures by name.

use interplay_common::spelling::nearest;
use thiserror::Error;

use super::{Entry, registry};

/// The name of an unknown figure or table.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("`{words}` is not a figure or table: {help}")]
pub struct UnknownFigure {
    /// The unknown name.
    pub words: String,
    /// A suggestion.
    pub help: String,
}

/// The entries with these names, in the order of the registry; without names, all entries. `6.1`, `fig-6.1` and `Fig. 6.1` name
/// a figure, `table-6.1` a table, and `6` all of chapter 6.
///
/// # Errors
/// [`UnknownFigure`] for the first unknown name.
pub fn find(words: &[String]) -> Result<Vec<&'static Entry>, UnknownFigure> {
    if words.is_empty() {
        return Ok(registry().collect());
    }
    let mut asked = Vec::new();
    for words in words {
        let id = id_of(words);
        let chapter = format!("{words}.");
        let matching = registry().filter(|entry| entry.id() == id || entry.number.starts_with(&chapter));
        let before = asked.len();
        asked.extend(matching.map(Entry::id));
        if asked.len() == before {
            return Err(unknown(words, &id));
        }
    }
    Ok(registry().filter(|entry| asked.contains(&entry.id())).collect())
}

/// `fig-6.1` for `6.1`, `Figure 6.1` and the like; `table-6.1` for `Table 6.1`.
fn id_of(words: &str) -> String {
    let words = words.trim().to_lowercase();
    let number = words.trim_start_matches(|c: char| !c.is_ascii_digit());
    let kind = if words.starts_with("tab") { "table" } else { "fig" };
    format!("{kind}-{number}")
}

fn unknown(words: &str, id: &str) -> UnknownFigure {
    let ids: Vec<String> = registry().map(Entry::id).collect();
    // Only a name with a number can resemble another one.
    let near = nearest(id, ids.iter().map(String::as_str)).filter(|_| !id.ends_with('-'));
    let help = match near {
        Some(near) => format!("did you mean `{near}`?"),
        None => "`interplay reproduce --list` lists all".to_owned(),
    };
    UnknownFigure { words: words.to_owned(), help }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ids(words: &[&str]) -> Vec<String> {
        let words: Vec<String> = words.iter().map(|words| (*words).to_owned()).collect();
        find(&words).expect("they exist").into_iter().map(Entry::id).collect()
    }

    #[test]
    fn figures_are_found_by_several_spellings() {
        for words in ["6.1", "fig-6.1", "Fig. 6.1", "figure 6.1"] {
            assert_eq!(ids(&[words]), ["fig-6.1"], "{words}");
        }
        assert_eq!(ids(&["Table 6.1", "table-8.2", "6.1"]), ["fig-6.1", "table-6.1", "table-8.2"]);
        assert_eq!(ids(&["5"]), ["fig-5.1", "fig-5.2", "fig-5.3"]);
        assert_eq!(ids(&[]).len(), registry().count());
    }

    #[test]
    fn an_unknown_name_gets_a_suggestion() {
        let help = |words: &str| find(&[words.to_owned()]).expect_err("no such figure").help;
        assert_eq!(help("6.11"), "did you mean `fig-6.1`?");
        assert!(help("tabel-2.1x").contains("table-2.1"), "{}", help("tabel-2.1x"));
        assert!(help("elephants everywhere").contains("--list"));
    }
}
