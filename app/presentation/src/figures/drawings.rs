//! Drawing functions for the entries of the registry.

use interplay_building::comfort::Setpoints;
use serde::Deserialize;

use super::entry::{Entry, FigureContent};
use super::error::FigureError;
use super::recorded_run::RecordedRun;
use super::{climate, driving, theory};

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
    /// Draws the entry from its runs.
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
