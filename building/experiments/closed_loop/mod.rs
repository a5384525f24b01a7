//! Runs of a building over days, as the application runs them, and what they cost.

#![allow(dead_code, reason = "every experiment uses a part")]

use std::error::Error;
use std::time::Instant;

use interplay_building::comfort::Agenda;
use interplay_building::control::Controller;
use interplay_building::day::{Day, KeyFigures, RunHistory, RunOptimum, Surroundings};
use interplay_building::discretise::Model;

pub struct World {
    pub model: Model,
    /// The building as controllers believe it to be.
    pub believed: Model,
    pub agenda: Agenda,
    pub surroundings: Surroundings,
    pub steps: usize,
    /// Temperature of all nodes at first \[°C\].
    pub initial_c: f64,
    pub days: usize,
}

pub struct Totals {
    /// Cost J (3.2).
    pub cost: f64,
    pub money: f64,
    /// Electricity \[kWh\].
    pub electricity_kwh: f64,
    /// Discomfort \[K·h per zone\].
    pub discomfort_k_h: f64,
    pub fallbacks: usize,
    /// Time of the controller in a day \[s\].
    pub design_s: f64,
    /// Heat of each zone and step \[kW\].
    pub heat_kw: Vec<f64>,
    /// What the optimum of the run needs.
    pub history: RunHistory,
    /// Temperatures of all nodes at the end \[°C\].
    pub end_c: Vec<f64>,
}

impl World {
    /// Runs all days.
    ///
    /// # Errors
    /// If the controller refuses the building or a day.
    pub fn run(&self, controller: &Controller) -> Result<Totals, Box<dyn Error>> {
        let mut control = controller.controller(&self.believed, self.steps)?;
        let mut nodes_c = vec![self.initial_c; self.model.network().node_count()];
        let zones = self.model.network().zone_count();
        let mut totals = Totals {
            cost: 0.0,
            money: 0.0,
            electricity_kwh: 0.0,
            discomfort_k_h: 0.0,
            fallbacks: 0,
            design_s: 0.0,
            heat_kw: Vec::new(),
            history: RunHistory::default(),
            end_c: Vec::new(),
        };
        for number in 0..self.days {
            let (start_c, targets) = (nodes_c.clone(), self.agenda.of_day(number));
            let of_day = |f: fn(&Surroundings, &Model, usize, usize) -> _| {
                f(&self.surroundings, &self.model, self.steps, number)
            };
            let (forecast, actual) = (of_day(Surroundings::forecast), of_day(Surroundings::actual));
            let outlook = self.surroundings.outlook(&self.model, self.steps, number);
            let mut day = Day::new(start_c.clone(), forecast, actual).before(outlook);
            let began = Instant::now();
            day.plan(&mut *control, &targets)?;
            for step in 0..self.steps {
                let heat = day.control(&self.model, &mut *control, &targets, step, &nodes_c[..zones]);
                day.balance(&self.model, step, &mut nodes_c, &heat);
            }
            day.learn(&mut *control)?;
            totals.design_s += began.elapsed().as_secs_f64() / self.days as f64;
            let real = targets.under(&day.actual.ambient_c);
            let figures = KeyFigures::compute(&day.record, &real, self.model.network().limits(), self.model.step_s());
            totals.cost += figures.cost;
            totals.money += figures.energy_cost.unwrap_or(0.0);
            totals.electricity_kwh += figures.electricity_kwh;
            totals.discomfort_k_h += figures.discomfort_k_h;
            totals.fallbacks += usize::from(day.record.design.fallback.is_some());
            totals.heat_kw.extend_from_slice(&day.record.heat_kw);
            totals.history.add(&real, &day.actual, [&start_c, &nodes_c]);
        }
        totals.end_c = nodes_c;
        Ok(totals)
    }

    /// The least money that a run with the end of `totals` costs without discomfort.
    ///
    /// # Errors
    /// If it is not found.
    pub fn least_money(&self, totals: &Totals) -> Result<RunOptimum, Box<dyn Error>> {
        Ok(totals.history.least_money(&self.model)?)
    }
}
