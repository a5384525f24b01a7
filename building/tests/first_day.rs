//! The first day of the designs, which has no plan yet: only a feedback, and only where temperatures have a weight.

mod common;

use common::reference::*;
use interplay_building::control::Controller;

#[test]
fn no_heat_is_used_on_the_first_day_while_temperatures_are_free() {
    let (model, days) = (testbed(), [day(0)]);
    for controller in [
        Controller::Iterative(Default::default()),
        Controller::Concurrent(Default::default()),
        Controller::Distributed(Default::default()),
        Controller::Centralised(Default::default()),
    ] {
        let mut at_work = controller.controller(&model, STEPS).expect("valid");
        let targets = chapter_5(vec![22.5, 22.0, 23.0, 23.5], 4);
        let heat_kw = &run(&model, 28.5, &mut *at_work, &targets, &days)[0].heat_kw;
        for (step, heat_kw) in heat_kw.chunks_exact(4).enumerate() {
            // Occupied from 8:00 to 19:00, both ends included.
            let free = !(16..=38).contains(&step);
            assert!(heat_kw.iter().all(|kw| (*kw == 0.0) == free), "{} step {step}: {heat_kw:?}", controller.kind());
        }
        // With a weight at night there is heat at night.
        let mut at_work = controller.controller(&model, STEPS).expect("valid");
        let heat_kw = &run(&model, 28.5, &mut *at_work, &chapter_3(1.0), &days)[0].heat_kw;
        assert!(heat_kw[4..16 * 4].iter().all(|kw| *kw != 0.0), "{}", controller.kind());
    }
}
