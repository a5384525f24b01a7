//! The files that a run writes, and why one of them must not be written.

use std::path::Path;

use interplay_presentation::page::Page;
use interplay_scenarios::{Override, Registry};

use crate::flag_values::files::{destroyed, is_page_file, is_same_file};

/// The files that a run writes.
pub(crate) struct WrittenFiles<'a> {
    /// Each with what it is.
    pub files: Vec<(&'static str, &'a Path)>,
    pub page: Option<&'a Path>,
}

impl WrittenFiles<'_> {
    /// Why an output must not be written: it would replace an input, another output, or a page that Interplay did not write.
    pub(crate) fn refused(&self, registry: &Registry, scenario: &str, overrides: &[Override]) -> Option<String> {
        self.takes_an_input(registry, scenario, overrides)
            .or_else(|| self.is_of_page())
            .or_else(|| self.are_one_file())
            .or_else(|| self.takes_a_page())
    }

    fn takes_an_input(&self, registry: &Registry, scenario: &str, overrides: &[Override]) -> Option<String> {
        self.files.iter().find_map(|(what, path)| {
            let path = destroyed(registry, path, [scenario].into_iter(), overrides)?;
            let path = path.display();
            Some(format!(
                "the {what} would overwrite `{path}`, of which the scenario is made; choose another name for it"
            ))
        })
    }

    fn is_of_page(&self) -> Option<String> {
        let folder = self.page?;
        let (what, path) = self.files.iter().find(|(_, path)| is_page_file(folder, path))?;
        let path = path.display();
        Some(format!("the {what} and a file of the page cannot both be `{path}`; choose another name for the {what}"))
    }

    fn are_one_file(&self) -> Option<String> {
        self.files.iter().enumerate().find_map(|(index, (what, path))| {
            let (first, _) = self.files[..index].iter().find(|(_, other)| is_same_file(other, path))?;
            let path = path.display();
            Some(format!("the {first} and the {what} cannot both be `{path}`; choose another name for one"))
        })
    }

    fn takes_a_page(&self) -> Option<String> {
        let page = self.page.map(|folder| folder.join("index.html")).filter(|page| Page::is_taken(page))?;
        Some(format!("`{}` is not a page that Interplay wrote; choose another folder for --report", page.display()))
    }
}
