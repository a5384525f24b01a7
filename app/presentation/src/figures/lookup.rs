//! The search for figures by name.

use std::io;
use std::path::PathBuf;
use std::sync::Arc;

use interplay_building::comfort::Setpoints;
use interplay_building::discretise::ModelError;
use interplay_building::identify::IdentifyError;
use interplay_common::spelling::nearest;
use interplay_scenarios::LoadError;
use interplay_simulation::run::RunError;
use serde::Deserialize;
use thiserror::Error;

use super::entry::{Entry, FigureContent};
use super::recorded_run::RecordedRun;
use super::{climate, driving, registry, theory};
use crate::plot::PlotError;

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

/// Why a figure, or a page of figures, was not made.
#[derive(Debug, Error)]
pub enum FigureError {
    /// A scenario cannot be loaded.
    #[error("{}", with_faults(.0))]
    Load(LoadError),
    /// A run could not be finished.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A run that several figures share failed.
    #[error("{scenario}: {reason}")]
    Shared { scenario: String, reason: Arc<FigureError> },
    /// A run that the figure needs was not made.
    #[error("{0}: the run was not made")]
    NotRun(String),
    /// A picture cannot be drawn or written.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// The parameters of the classroom cannot be identified.
    #[error(transparent)]
    Identify(#[from] IdentifyError),
    /// The classroom was identified without a zone.
    #[error("the classroom has no zone")]
    NoZone,
    /// A building has no model at its step.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The page cannot be written.
    #[error("cannot write {}: {reason}; name another folder with --report", path.display())]
    Page { path: PathBuf, reason: io::Error },
}

fn with_faults(error: &LoadError) -> String {
    let faults = error.faults().iter().map(ToString::to_string).collect::<Vec<_>>();
    format!("{error}: {}", faults.join("; "))
}

impl From<LoadError> for FigureError {
    fn from(error: LoadError) -> Self {
        FigureError::Load(error)
    }
}

/// The drawing of an entry. All but those that need no run show the first run of the entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum EntryDrawing {
    IdentificationTrain,
    IdentificationTest,
    ThermalParameters,
    Weather,
    /// Temperatures of the first four zones.
    Temperatures,
    FirstTwoRooms,
    /// Heat of the first four zones.
    Inputs,
    /// Cost of each day, of all runs of the entry.
    Costs,
    Setpoints,
    Disturbance,
    /// Cost over the rounds of an exchange of messages.
    Rounds,
    Footprints,
    /// Footprints, and below them what the ego's planner computed.
    FootprintsAndPlanner,
    Speeds,
    Dimensions,
    Configuration,
    ProbabilityWeights,
    Chicken,
    Payoffs,
    Events,
}

impl Entry {
    pub(super) fn draw(&self, runs: &[&RecordedRun]) -> Result<FigureContent, FigureError> {
        let title = self.title.as_str();
        let first = || runs.first().copied().ok_or_else(|| FigureError::NotRun(self.to_string()));
        let zones = || first().map(climate::first_zones);
        Ok(match self.drawing {
            EntryDrawing::IdentificationTrain => theory::identification(title, false)?,
            EntryDrawing::IdentificationTest => theory::identification(title, true)?,
            EntryDrawing::ThermalParameters => theory::thermal_parameters(title)?,
            EntryDrawing::Weather => climate::weather(title, first()?).drawing().into(),
            EntryDrawing::Temperatures => climate::temperatures(title, first()?, &zones()?).drawing().into(),
            EntryDrawing::FirstTwoRooms => climate::temperatures(title, first()?, &[0, 1]).drawing().into(),
            EntryDrawing::Inputs => climate::inputs(title, first()?, &zones()?).drawing().into(),
            EntryDrawing::Costs => climate::costs(title, runs).drawing().into(),
            EntryDrawing::Setpoints => {
                let stated = first()?.scenario.setpoints.as_ref();
                theory::setpoints(title, stated.unwrap_or(&Setpoints::default()))
            }
            EntryDrawing::Disturbance => climate::disturbance(title, first()?, &zones()?).drawing().into(),
            EntryDrawing::Rounds => climate::rounds(title, first()?).drawing().into(),
            EntryDrawing::Footprints => driving::footprints(title, first()?).drawing().into(),
            EntryDrawing::FootprintsAndPlanner => {
                let run = first()?;
                let mut content = FigureContent::from(driving::footprints(title, run).drawing());
                let planner = "What the ego's planner believes and intends";
                let panels = driving::planner_diagnostics(planner, run, run.scenario.ego_index());
                content.pictures.extend(panels.map(|panels| panels.drawing()));
                content
            }
            EntryDrawing::Speeds => driving::speeds(title, first()?).drawing().into(),
            EntryDrawing::Dimensions => theory::dimensions(title),
            EntryDrawing::Configuration => theory::configuration(title)?,
            EntryDrawing::ProbabilityWeights => theory::weights(title),
            EntryDrawing::Chicken => theory::chicken(title),
            EntryDrawing::Payoffs => theory::payoffs(title),
            EntryDrawing::Events => theory::events(title),
        })
    }
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
