//! A controller: proportional feedback that starts before people come.

// shown from here
use interplay_building::control::{Control, ControlError, DayAhead, DayRecord, Observation};

/// Heat in proportion to what is missing, for what will be wanted some steps ahead.
#[derive(Debug)]
struct Early {
    gain_kw_per_k: f64,
    steps_ahead: usize,
}

impl Control for Early {
    fn start_of_day(&mut self, _: &DayAhead<'_>) -> Result<(), ControlError> {
        Ok(())
    }

    fn act(&mut self, observation: &Observation<'_>) -> Vec<f64> {
        let Observation { step, temperatures_c, targets } = *observation;
        let then = (step + self.steps_ahead).min(targets.steps() - 1);
        let wanted = targets.reference_at(then).iter().zip(targets.weight_at(then));
        let heat_kw = |((reference_c, weight), temperature_c): ((&f64, &f64), &f64)| {
            if *weight > 0.0 { self.gain_kw_per_k * (reference_c - temperature_c) } else { 0.0 }
        };
        wanted.zip(temperatures_c).map(heat_kw).collect()
    }

    fn end_of_day(&mut self, _: &DayRecord) -> Result<(), ControlError> {
        Ok(())
    }
}
// shown until here

use interplay_building::comfort::Setpoints;
use interplay_building::control::Disturbance;
use interplay_building::day::{KeyFigures, run_day};
use interplay_building::discretise::Model;
use interplay_building::network::Network;

/// Cost of the third day in the testbed, every day the same.
fn cost(mut controller: impl Control) -> f64 {
    let (step_s, steps) = (1800.0, 48);
    let model = Model::exact(&Network::testbed(), step_s).expect("a sound network");
    let targets = Setpoints::default().targets(4, step_s, steps).expect("sound setpoints");
    let day = Disturbance { ambient_c: vec![30.0; steps], gains_kw: vec![0.2; 4 * steps] };
    let mut temperatures_c = vec![28.0; 4];
    let mut run = || run_day(&model, &mut temperatures_c, &mut controller, &targets, &day, &day).expect("a day");
    let [_, _, third] = [run(), run(), run()];
    KeyFigures::compute(&third, &targets, model.network().limits(), step_s).cost
}

#[test]
fn a_user_defined_controller_that_heats_earlier_costs_less() {
    let [late, early] = [0, 3].map(|steps_ahead| cost(Early { gain_kw_per_k: 0.5, steps_ahead }));
    assert!(early < 0.8 * late, "{early} {late}");
}
