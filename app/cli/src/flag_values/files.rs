//! The scenarios that an argument selects, and the names of their runs.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::{Component, Path, PathBuf};

use interplay_scenarios::{
    FolderScenario, LoadError, Override, Registry, Scenario, Street, embedded, files_below, names_matching,
};
use thiserror::Error;

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ScenarioArgument {
    /// Name of its run ([`short_name`]); in a folder, its path below that folder, without the extension.
    pub name: String,
    /// Name of the embedded scenario, or path of the file.
    pub scenario: String,
    /// Whether it was found in a folder in which another file extends it: it is left out if it is not complete.
    pub may_be_incomplete: bool,
}

/// The scenarios of several arguments.
#[derive(Debug, Default)]
pub(crate) struct Found {
    pub scenarios: Vec<ScenarioArgument>,
    /// The files of folders that are not scenarios of their own.
    pub left_out: Vec<PathBuf>,
    /// Why an argument gives no scenarios.
    pub errors: Vec<FolderError>,
}

impl Found {
    /// The scenarios that some arguments select, each with a name of its own.
    pub fn of(arguments: &[String]) -> Found {
        let mut all = Found::default();
        for argument in arguments {
            match find(argument) {
                Ok((scenarios, plans)) => {
                    all.scenarios.extend(scenarios);
                    all.left_out.extend(plans);
                }
                Err(error) => all.errors.push(error),
            }
        }
        all.scenarios = with_names_of_their_own(all.scenarios);
        all
    }

    /// Loads the scenarios, changed by `overrides`, in their order. Incomplete files that others extend join [`Found::left_out`].
    pub fn load(
        &mut self,
        registry: &Registry,
        overrides: &[Override],
    ) -> Vec<(ScenarioArgument, Result<Scenario, LoadError>)> {
        let mut loaded = Vec::new();
        for argument in &self.scenarios {
            match registry.load(&argument.scenario, overrides) {
                Err(_) if argument.may_be_incomplete => self.left_out.push(PathBuf::from(&argument.scenario)),
                outcome => loaded.push((argument.clone(), outcome)),
            }
        }
        loaded
    }

    /// A note about the files that were left out; none without any.
    pub fn note(&self) -> Option<String> {
        const SHOWN: usize = 4;
        let names = self.left_out.iter().take(SHOWN).map(|path| path.display().to_string()).collect::<Vec<_>>();
        let more = self.left_out.len().saturating_sub(SHOWN);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        (!names.is_empty()).then(|| {
            format!(
                "note: left out, since they are plans or complete only where others extend them: {}{more}",
                names.join(", ")
            )
        })
    }
}

/// Why a folder gives no scenarios.
#[derive(Debug, Error)]
pub(crate) enum FolderError {
    #[error("cannot read folder `{folder}`: {reason}")]
    Unreadable { folder: String, reason: io::Error },
    #[error("the name of `{file}` is not UTF-8 text; rename the file")]
    NotUtf8 { file: String },
    #[error("folder `{folder}` contains no scenario")]
    Empty { folder: String },
}

/// The scenarios that an argument selects: a file, all scenarios below a folder, sorted, or an embedded scenario, a family or a pattern
/// of them; and the plans of a folder.
///
/// # Errors
/// [`FolderError`], if a folder cannot be read or has no scenario in it. Whether the others exist shows when they are loaded.
fn find(argument: &str) -> Result<(Vec<ScenarioArgument>, Vec<PathBuf>), FolderError> {
    let folder = Path::new(argument);
    if !folder.is_dir() {
        let matching = if folder.exists() { Vec::new() } else { names_matching(argument) };
        let named = |name: String, scenario: String| ScenarioArgument { name, scenario, may_be_incomplete: false };
        let found = match matching.is_empty() {
            true => vec![named(short_name(argument), argument.to_owned())],
            false => matching.into_iter().map(|name| named(name.clone(), name)).collect(),
        };
        return Ok((found, Vec::new()));
    }
    let found =
        files_below(folder).map_err(|reason| FolderError::Unreadable { folder: argument.to_owned(), reason })?;
    if found.scenarios.is_empty() {
        return Err(FolderError::Empty { folder: argument.to_owned() });
    }
    let named = |FolderScenario { path, is_extended }: FolderScenario| {
        let name = path.strip_prefix(folder).unwrap_or(&path).with_extension("");
        let Some(scenario) = path.to_str() else {
            return Err(FolderError::NotUtf8 { file: path.display().to_string() });
        };
        let name = name.to_string_lossy().into_owned();
        Ok(ScenarioArgument { name, scenario: scenario.to_owned(), may_be_incomplete: is_extended })
    };
    Ok((found.scenarios.into_iter().map(named).collect::<Result<_, _>>()?, found.plans))
}

/// The same scenarios, those of one name with as much of their paths before it as tells them apart: `team-a/merge`, `team-b/merge`.
fn with_names_of_their_own(mut found: Vec<ScenarioArgument>) -> Vec<ScenarioArgument> {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    found.iter().for_each(|scenario| *counts.entry(scenario.name.clone()).or_default() += 1);
    let longest = found.iter().map(|scenario| parts(&scenario.scenario).len()).max().unwrap_or(0);
    for (name, _) in counts.into_iter().filter(|(_, count)| *count > 1) {
        let alike: Vec<usize> = (0..found.len()).filter(|at| found[*at].name == name).collect();
        let last = |at: usize, kept: usize| {
            let parts = parts(&found[at].scenario);
            parts[parts.len().saturating_sub(kept)..].join("/")
        };
        let names = (1..=longest).map(|kept| alike.iter().map(|at| last(*at, kept)).collect::<Vec<String>>());
        let are_different = |names: &Vec<String>| names.iter().collect::<BTreeSet<_>>().len() == names.len();
        // One file given twice keeps its name.
        if let Some(names) = names.into_iter().find(are_different) {
            alike.into_iter().zip(names).for_each(|(at, name)| found[at].name = name);
        }
    }
    found
}

/// The folders and the name of a file, without its extension and what leads out of a folder.
fn parts(path: &str) -> Vec<String> {
    let plain = Path::new(path).with_extension("");
    let normal = plain.components().filter(|part| matches!(part, Component::Normal(_)));
    normal.map(|part| part.as_os_str().to_string_lossy().into_owned()).collect()
}

/// A file of which one of the scenarios is made, changed by `overrides`, that writing to `output` would destroy.
pub(crate) fn destroyed<'a>(
    registry: &Registry,
    output: &Path,
    mut scenarios: impl Iterator<Item = &'a str>,
    overrides: &[Override],
) -> Option<PathBuf> {
    let output = output.canonicalize().ok()?;
    let is_output = |path: &PathBuf| path.canonicalize().is_ok_and(|path| path == output);
    scenarios.find_map(|scenario| interplay_scenarios::files(registry, scenario, overrides).into_iter().find(is_output))
}

/// Whether two paths, of files that need not exist, name the same file.
pub(crate) fn is_same_file(one: &Path, other: &Path) -> bool {
    let place = |path: &Path| {
        let folder = interplay_files::folder_of(path);
        let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
        path.canonicalize().unwrap_or_else(|_| folder.join(path.file_name().unwrap_or_default()))
    };
    place(one) == place(other)
}

/// Whether a path is in the folder of a page and has the name of a file of it: the page itself or one of its pictures.
pub(crate) fn is_page_file(folder: &Path, path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default();
    let is_of_page = name == "index.html" || name.to_string_lossy().starts_with("picture");
    is_of_page && is_same_file(&folder.join(name), path)
}

/// What a run is called: an authored scenario and a generated street by its name, a file by its own name, without folders and extension.
pub(crate) fn short_name(scenario: &str) -> String {
    if Street::named(scenario).is_some() || embedded().iter().any(|file| file.name == scenario) {
        return scenario.to_owned();
    }
    let stem = Path::new(scenario).file_stem();
    stem.map_or_else(|| "scenario".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn run_names_follow_scenarios_and_stay_in_their_folder() {
        for (scenario, name) in [
            ("lane-change/front-nice", "lane-change/front-nice"),
            ("streets/narrow/1", "streets/narrow/1"),
            ("streets/no-such-kind/1", "1"),
            ("my.toml", "my"),
            ("my", "my"),
            ("../my", "my"),
            ("../../lane-change/front-nice", "front-nice"),
            ("/somewhere/my.v2.toml", "my.v2"),
            ("./.hidden", ".hidden"),
            ("..", "scenario"),
        ] {
            assert_eq!(short_name(scenario), name, "{scenario}");
        }
    }

    #[test]
    fn files_with_equal_names_in_several_folders_get_distinct_run_names() {
        let found = |paths: &[&str]| -> Vec<String> {
            let of = |path: &&str| ScenarioArgument {
                name: short_name(path),
                scenario: (*path).to_owned(),
                may_be_incomplete: false,
            };
            let named = with_names_of_their_own(paths.iter().map(of).collect());
            named.into_iter().map(|scenario| scenario.name).collect()
        };
        assert_eq!(
            found(&["../team-a/merge.toml", "team-b/merge.toml", "x.toml"]),
            ["team-a/merge", "team-b/merge", "x"]
        );
        assert_eq!(found(&["a/c/merge.toml", "b/c/merge.toml"]), ["a/c/merge", "b/c/merge"]);
        assert_eq!(found(&["merge.toml", "a/merge.toml"]), ["merge", "a/merge"]);
        assert_eq!(found(&["merge.toml", "merge.toml"]), ["merge", "merge"]);
    }

    #[test]
    fn families_and_patterns_select_embedded_scenarios() {
        let names = |argument: &str| -> Vec<String> {
            find(argument).expect("no folder").0.into_iter().map(|found| found.name).collect()
        };
        let family = names("lane-change");
        assert!(family.len() > 3 && family.iter().all(|name| name.starts_with("lane-change/")), "{family:?}");
        assert_eq!(names("lane-change/*"), family);
        assert_eq!(names("streets/ring/3-4").len(), 2);
        assert_eq!(names("nowhere"), ["nowhere"]);
    }

    #[test]
    fn files_of_a_folder_are_found_with_their_relative_paths() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/files");
        let (found, _) = find(folder).expect("the authored files are there");
        let names: Vec<&str> = found.iter().map(|found| found.name.as_str()).collect();
        assert_eq!(names, embedded().iter().map(|file| file.name).collect::<Vec<_>>());
        assert!(find(concat!(env!("CARGO_MANIFEST_DIR"), "/src")).is_err(), "no scenario lies among the sources");
    }
}
