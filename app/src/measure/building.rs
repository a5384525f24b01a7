//! How a building does, day by day.

use bevy::ecs::prelude::*;
use interplay_building::comfort::KeyFigures;
use interplay_building::control::{Controller, optimum};
use interplay_building::lifted::Lifted;
use serde::Serialize;
use xxhash_rust::xxh3::Xxh3;

use crate::climate::Building;
use crate::components::Present;
use crate::frame::BuildingFrame;

/// Up to so many inputs a day (zones times steps) the day's optimum and the convergence of learning are worked out: they
/// take time in the cube of it.
const MOST_INPUTS: usize = 500;

/// The key figures of a day; their serialisation is part of the output contract.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DayFigures {
    /// The figures in BOPTEST's meaning.
    #[serde(flatten)]
    pub figures: KeyFigures,
    /// How much dearer the day was than the cheapest one that knows everything beforehand; not for large buildings.
    pub regret: Option<f64>,
    /// Spectral radius of the learning from day to day, where it is known.
    pub spectral_radius: Option<f64>,
    /// Wall time of planning and learning \[s\]; not reproducible.
    pub design_s: f64,
}

/// Digests of what each part of the phase Climate produced.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BuildingDigests {
    /// Of the weather, its forecasts, and the heat of people and sun.
    pub disturbance: String,
    /// Of what the controller asked for.
    pub control: String,
    /// Of the heat that was given and all temperatures of zones.
    pub balance: String,
}

/// Everything that is measured of a building.
#[derive(Resource, Clone)]
pub struct BuildingMeasures {
    /// Every day.
    pub days: Vec<DayFigures>,
    /// How many zones there are.
    pub zones: usize,
    /// What is allowed and may not have been meant, in words.
    pub remarks: Vec<String>,
    /// The model of a day, if it is small enough for what takes long.
    lifted: Option<Lifted>,
    spectral_radius: Option<f64>,
    disturbance: Xxh3,
    control: Xxh3,
    balance: Xxh3,
}

impl BuildingMeasures {
    /// Nothing measured yet.
    pub fn new(building: &Building, controller: &Controller) -> Self {
        let small = building.targets.reference_c.len() <= MOST_INPUTS;
        let lifted = small.then(|| Lifted::new(&building.model, building.steps_per_day()));
        let spectral_radius = match (controller, &lifted) {
            (Controller::IterativeLearning(learning), Some(lifted)) => {
                Some(learning.convergence(lifted).spectral_radius)
            }
            _ => None,
        };
        BuildingMeasures {
            days: Vec::new(),
            zones: building.targets.zones,
            remarks: building.model.network().remarks().iter().map(ToString::to_string).collect(),
            lifted,
            spectral_radius,
            disturbance: Xxh3::new(),
            control: Xxh3::new(),
            balance: Xxh3::new(),
        }
    }

    /// The digests so far.
    pub fn digests(&self) -> BuildingDigests {
        let hex = |hasher: &Xxh3| format!("{:032x}", hasher.digest128());
        BuildingDigests {
            disturbance: hex(&self.disturbance),
            control: hex(&self.control),
            balance: hex(&self.balance),
        }
    }

    fn digest(&mut self, frame: &BuildingFrame) {
        let number = |hasher: &mut Xxh3, value: f64| hasher.update(&value.to_bits().to_le_bytes());
        number(&mut self.disturbance, frame.ambient_c);
        number(&mut self.disturbance, frame.forecast_c);
        for zone in &frame.zones {
            number(&mut self.disturbance, zone.gains_kw);
            number(&mut self.control, zone.requested_kw);
            number(&mut self.balance, zone.heat_kw);
            number(&mut self.balance, zone.temperature_c);
            number(&mut self.balance, zone.next_c);
        }
    }

    /// The figures of the day that has ended.
    fn day(&self, building: &Building) -> DayFigures {
        let Building { model, targets, today, .. } = building;
        let figures = KeyFigures::of(&today.record, targets, model.network().limits_kw(), model.step_s());
        // An optimum that is not found is no reason to give up the run: the regret is then unknown.
        let cheapest = |lifted| optimum(lifted, &today.initial_c, targets, &today.actual, None).ok();
        let regret = self.lifted.as_ref().and_then(cheapest).map(|cheapest| figures.cost - cheapest.cost);
        DayFigures { figures, regret, spectral_radius: self.spectral_radius, design_s: today.design_s }
    }
}

/// Feeds the step into the digests, and measures the day when it is over.
pub fn measure_building(building: Res<Building>, mut present: ResMut<Present>, mut measures: ResMut<BuildingMeasures>) {
    let Some(frame) = &mut present.0.building else { return };
    measures.digest(frame);
    if frame.step + 1 == building.steps_per_day() {
        let day = measures.day(&building);
        measures.days.push(day);
        frame.figures = Some(day);
    }
}
