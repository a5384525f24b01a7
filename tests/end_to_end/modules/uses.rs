//! What code names: paths, words and methods, without types or names being resolved.

use std::collections::BTreeSet;

use proc_macro2::{TokenStream, TokenTree};

#[derive(Debug, Default)]
pub struct Uses {
    /// Paths of at least two words.
    pub paths: Vec<Vec<String>>,
    /// Words that stand alone, and are neither fields nor methods.
    pub words: BTreeSet<String>,
    /// Methods that are called on `self`, with the path of the type that implements the calling function.
    pub own_calls: BTreeSet<(Vec<String>, String)>,
    /// Methods that are called on anything else.
    pub calls: BTreeSet<String>,
}

impl Uses {
    /// Takes in what some code names, also inside macros. `own` is the path of the type that `Self` stands for, if any.
    pub fn collect(&mut self, code: TokenStream, own: &[String]) {
        let tokens: Vec<TokenTree> = code.into_iter().collect();
        let is_mark = |index: Option<usize>, mark: char| {
            let token = index.and_then(|index| tokens.get(index));
            matches!(token, Some(TokenTree::Punct(punct)) if punct.as_char() == mark)
        };
        let is_word = |index: Option<usize>, text: &str| {
            let token = index.and_then(|index| tokens.get(index));
            matches!(token, Some(TokenTree::Ident(word)) if word == text)
        };
        let mut index = 0;
        while let Some(token) = tokens.get(index) {
            match token {
                // `pub(in crate::a)` says who may see something, and uses nothing.
                TokenTree::Group(_) if is_word(index.checked_sub(1), "pub") => {}
                TokenTree::Group(group) => self.collect(group.stream(), own),
                // The end of a range is not a field.
                TokenTree::Ident(word) if is_mark(index.checked_sub(1), '.') && !is_mark(index.checked_sub(2), '.') => {
                    let has_types = is_mark(Some(index + 1), ':') && is_mark(Some(index + 2), ':');
                    if has_types || matches!(tokens.get(index + 1), Some(TokenTree::Group(_))) {
                        let is_own = is_word(index.checked_sub(2), "self") && !is_mark(index.checked_sub(3), '.');
                        self.call(word.to_string(), if is_own { own } else { &[] });
                    }
                }
                TokenTree::Ident(word) => {
                    let mut path = vec![word.to_string()];
                    while let (true, true, Some(TokenTree::Ident(next))) =
                        (is_mark(Some(index + 1), ':'), is_mark(Some(index + 2), ':'), tokens.get(index + 3))
                    {
                        path.push(next.to_string());
                        index += 3;
                    }
                    self.name(path, own);
                }
                _ => {}
            }
            index += 1;
        }
    }

    fn call(&mut self, method: String, own: &[String]) {
        match own {
            [] => self.calls.insert(method),
            own => self.own_calls.insert((own.to_vec(), method)),
        };
    }

    fn name(&mut self, path: Vec<String>, own: &[String]) {
        match &path[..] {
            [word] => drop(self.words.insert(word.clone())),
            [first, rest @ ..] if first == "Self" && !own.is_empty() => self.paths.push([own, rest].concat()),
            _ => self.paths.push(path),
        }
    }
}
