//! Control of a vehicle that is driven from outside: inputs of the caller, a record of them, or temporarily a planner.

use interplay_planners::{Drive, Driver, Input};

use super::Simulation;
use crate::simulation::run_error::RunError;
use crate::state::components::{Clock, Driving, HandedIn};

impl Simulation {
    /// Lets a planner control a vehicle that is driven from outside, from the next plan on; without a planner, the caller's inputs
    /// control it again. The call does not change which plans the vehicle and the others know of each other.
    ///
    /// # Errors
    /// [`RunError::NoVehicle`]; [`RunError::NotExternal`] if the scenario gives the vehicle another driver.
    pub fn hand_over(&mut self, vehicle: &str, to: Option<&Driver>) -> Result<(), RunError> {
        let index = self.index_of(vehicle)?;
        let stated = &self.course.scenario.vehicles[index].driver;
        if !stated.is_driven_from_outside() {
            return Err(RunError::NotExternal { vehicle: vehicle.to_owned() });
        }
        // A snapshot as text repeats hand-overs only if the scenario contains them.
        if stated.inputs().is_none() && !self.course.replaced.iter().any(|replaced| replaced == vehicle) {
            self.course.replaced.push(vehicle.to_owned());
        }
        self.give_wheel(index, to.map(|driver| driver.driver()));
        Ok(())
    }

    /// Gives control of a vehicle to a driver or, without one, to the caller's inputs.
    pub(super) fn give_wheel(&mut self, index: usize, to: Option<Box<dyn Drive>>) {
        let entity = self.entity(index);
        let mut vehicles = self.world.query::<(&mut Driving, &mut HandedIn)>();
        let Ok((mut driving, mut handed_in)) = vehicles.get_mut(&mut self.world, entity) else { return };
        *handed_in = HandedIn::awaited_if(to.is_none());
        if let Some(driver) = to {
            driving.planner.replace_driver(driver);
            driving.detail = None;
        }
    }

    /// Applies the recorded inputs for the next plan.
    pub(super) fn repeat_inputs(&mut self) -> Result<(), RunError> {
        let plan = self.world.resource::<Clock>().plans();
        let scenario = std::sync::Arc::clone(&self.course.scenario);
        for (row, vehicle) in scenario.vehicles.iter().enumerate() {
            let Some(record) = vehicle.driver.inputs() else { continue };
            if let Some(to) = record.handed_over_at(plan) {
                self.hand_over(&vehicle.name, to.and_then(Driver::at_wheel).as_ref())?;
            }
            self.repeat(row, record.at(plan));
        }
        Ok(())
    }

    /// Applies a recorded input, unless a planner is in control. It is part of the scenario and not an input from outside of this run.
    fn repeat(&mut self, row: usize, input: Input) {
        let entity = self.entity(row);
        let handed_in = self.world.get_mut::<HandedIn>(entity);
        if let Some(mut handed_in) = handed_in.filter(|handed_in| **handed_in != HandedIn::NotExternal) {
            *handed_in = HandedIn::Input(input);
        }
    }
}

#[cfg(test)]
mod tests {
    use interplay_planners::Driver;
    use interplay_planners::Input;
    use interplay_planners::drivers::inputs::{Settings, WheelHandOver};
    use interplay_scenarios::{Override, load};

    use crate::Simulation;

    /// The caller changes inputs at every plan and lets a planner drive in between; the record of these inputs gives the same run.
    #[test]
    fn a_run_repeats_from_its_recorded_inputs() {
        let outside = Override::Set("vehicle.ego.driver={ kind = 'external' }".to_owned());
        let scenario = load("lane-change/front-nice", &[outside]).expect("authored");
        let mut played = Simulation::new(&scenario).expect("a world");
        let mut record = Settings::default();
        let (from, until) = (20, 60);
        let mut plan = 0_u32;
        loop {
            if plan == from || plan == until {
                let to = (plan == from).then(|| "negotiation".to_owned());
                played.hand_over("ego", to.as_deref().and_then(Driver::at_wheel).as_ref()).expect("external");
                record.hand_overs.push(WheelHandOver { plan, to });
            }
            let input = Input { acceleration_mps2: 0.3 * libm::sin(0.7 * f64::from(plan)), steering_rad: 0.01 };
            if !(from..until).contains(&plan) {
                played.apply("ego", input).expect("external");
                record.inputs.push([f64::from(plan), input.acceleration_mps2, input.steering_rad]);
            }
            if played.step().expect("a step").is_none() {
                break;
            }
            plan += 1;
        }
        let mut repeated = scenario.clone();
        repeated.vehicles[0].driver = Driver::Inputs(record);
        let text = repeated.to_file().to_toml();
        let again = interplay_scenarios::from_text("played.toml", &text, &[]).expect("a scenario");
        let again = crate::run::run("again", &again, Vec::new()).expect("a run");
        assert_eq!(again.digest, played.finish().expect("a run").digest);
    }
}
