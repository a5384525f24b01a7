//! Designs of a day by a controller that has one day of experience.

use interplay_building::comfort::Targets;
use interplay_building::control::distributed::{Distributed, DistributedSettings};
use interplay_building::control::{Control, DayAhead, DayRecord, Design, Disturbance, Exchange};
use interplay_building::discretise::Model;
use interplay_building::lifted::Lifted;

use super::reference::STEPS;

/// Gives a controller a day of experience that teaches nothing: as forecast, from rest, without equipment.
pub fn experienced(controller: &mut dyn Control, model: &Model, targets: &Targets, day: &Disturbance) {
    let initial_c = vec![27.5; model.network().node_count()];
    let lifted = Lifted::new(model, STEPS);
    let day_ahead = DayAhead { initial_c: &initial_c, targets, forecast: day, outlook: None, actual: None };
    controller.start_of_day(&day_ahead).expect("a morning");
    let temperatures_c = lifted.free_response(&initial_c, &day.ambient_c, &day.gains_kw);
    let still = vec![0.0; lifted.size()];
    let record = DayRecord { temperatures_c, heat_kw: still.clone(), requested_kw: still, design: Design::default() };
    controller.end_of_day(&record).expect("an evening");
}

/// The design of a day that starts at 27 °C, after one that taught nothing.
pub fn designed(controller: &mut dyn Control, model: &Model, targets: &Targets, day: &Disturbance) -> Design {
    experienced(controller, model, targets, day);
    let initial_c = vec![27.0; model.network().node_count()];
    controller
        .start_of_day(&DayAhead { initial_c: &initial_c, targets, forecast: day, outlook: None, actual: None })
        .expect("planned");
    controller.design()
}

pub fn exchange(
    settings: DistributedSettings,
    model: &Model,
    targets: &Targets,
    day: &Disturbance,
) -> (Design, Exchange) {
    let mut distributed = Distributed::new(settings, model, STEPS).expect("valid");
    let design = designed(&mut distributed, model, targets, day);
    assert_eq!(design.fallback, None);
    let exchange = design.exchange.clone().expect("zones have spoken");
    (design, exchange)
}

pub fn falls(costs: &[f64]) -> bool {
    costs.windows(2).all(|pair| pair[1] <= pair[0] * (1.0 + 1e-9))
}
