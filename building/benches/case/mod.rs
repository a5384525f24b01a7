//! A day to be planned ahead, on which the time of a design is measured.

use interplay_building::comfort::{Setpoints, Targets};
use interplay_building::control::{Control, Controller, DayAhead, Disturbance};
use interplay_building::day::run_day;
use interplay_building::discretise::Model;
use interplay_building::network::Network;

const STEP_S: f64 = 1800.0;
const STEPS: usize = 48;

/// A controller after its first day, and its second day.
pub struct Case {
    pub controller: Box<dyn Control>,
    targets: Targets,
    initial_c: Vec<f64>,
    day: Disturbance,
}

impl Case {
    /// Returns a controller after its first day, for a grid of `rows` by `columns` rooms.
    pub fn new(controller: Controller, rows: usize, columns: usize) -> Self {
        let model = Model::euler(&Network::grid(rows, columns), STEP_S).expect("stable");
        let n = rows * columns;
        let wanted_c = (0..n).map(|i| 22.0 + 0.5 * (i % 4) as f64).collect();
        let setpoints = Setpoints { occupied_c: wanted_c, occupied_weight: 2.0, band_k: 1.0, ..Setpoints::default() };
        let targets = setpoints.targets(n, STEP_S, STEPS).expect("valid");
        let ambient_c: Vec<f64> = (0..STEPS).map(|t| 28.0 + 3.0 * ((t as f64 - 16.0) / 8.0).sin()).collect();
        let gains_kw =
            (0..n * STEPS).map(|k| if (16..38).contains(&(k / n)) { 0.3 + 0.03 * (k % n % 5) as f64 } else { 0.0 });
        let day = Disturbance { ambient_c, gains_kw: gains_kw.collect() };
        let mut controller = controller.controller(&model, STEPS).expect("valid");
        let mut initial_c = vec![27.5; n];
        run_day(&model, &mut initial_c, &mut *controller, &targets, &day, &day).expect("runs");
        Self { controller, targets, initial_c: vec![27.0; n], day }
    }

    /// Plans the second day; what it is expected to cost.
    pub fn plan_day_ahead(&self, controller: &mut dyn Control) -> f64 {
        let day_ahead = DayAhead {
            initial_c: &self.initial_c,
            targets: &self.targets,
            forecast: &self.day,
            outlook: None,
            actual: None,
        };
        controller.start_of_day(&day_ahead).expect("shapes fit");
        let design = controller.design();
        assert!(design.fallback.is_none(), "{:?}", design.fallback);
        design.objective.expect("planned")
    }
}
