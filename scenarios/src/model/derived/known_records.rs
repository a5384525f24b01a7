//! An ego that knows the records of the recorded vehicles, as every planner of CommonRoad does.

use interplay_planners::Driver;

use crate::model::remark::ScenarioRemark;
use crate::model::scenario::Scenario;
use crate::text::error::Fault;
use crate::text::name::EGO;

impl Scenario {
    /// The same scenario with an ego that knows where the recorded vehicles will be: it knows plans, they tell theirs, and these are their
    /// records. A remark of the report says so.
    #[must_use]
    pub fn with_known_records(mut self) -> Scenario {
        let mut told = 0;
        for vehicle in &mut self.vehicles {
            if let Driver::Recorded(record) = &mut vehicle.driver {
                (record.plans_record, vehicle.tells_plan) = (true, Some(true));
                told += 1;
            }
        }
        let egos = self.vehicles.iter_mut().filter(|vehicle| vehicle.name == EGO);
        egos.for_each(|ego| ego.knows_plans = Some(true));
        let fault = Fault::new(format!("the ego knows the records of {told} vehicles, which no driver could know"));
        self.remarks.0.push(ScenarioRemark(fault));
        self
    }
}

#[cfg(test)]
mod tests {
    use crate::{ImportOptions, Registry, import_commonroad};

    #[test]
    fn only_records_are_told_and_only_to_the_ego() {
        let obstacle = |id: u32, x_m: f64| {
            let state = |at: u32, x_m: f64| {
                format!(
                    "<position><point><x>{x_m}</x><y>1.75</y></point></position><orientation><exact>0</exact></orientation>\
                     <time><exact>{at}</exact></time><velocity><exact>10</exact></velocity>"
                )
            };
            format!(
                "<dynamicObstacle id=\"{id}\"><type>car</type><shape><rectangle><length>4.5</length><width>1.8</width>\
                 </rectangle></shape><initialState>{}</initialState><trajectory><state>{}</state></trajectory></dynamicObstacle>",
                state(0, x_m),
                state(1, x_m + 5.0)
            )
        };
        let bound = |y_m: f64| format!("<point><x>0</x><y>{y_m}</y></point><point><x>200</x><y>{y_m}</y></point>");
        let text = format!(
            "<commonRoad timeStepSize=\"0.5\" commonRoadVersion=\"2020a\" benchmarkID=\"ZAM_Short-1_1_T-1\"><lanelet id=\"1\">\
             <leftBound>{}</leftBound><rightBound>{}</rightBound></lanelet>{}{}</commonRoad>",
            bound(3.5),
            bound(0.0),
            obstacle(3, 40.0),
            obstacle(4, 80.0)
        );
        let imported = import_commonroad("made", &text, &ImportOptions::default()).expect("a scenario");
        let scenario = imported.resolve(Registry::standard()).expect("it resolves");
        assert!(scenario.vehicles.iter().all(|vehicle| !vehicle.tells_plan()));
        let known = scenario.with_known_records();
        assert!(known.vehicles.iter().all(|vehicle| vehicle.tells_plan() && !vehicle.knows_plans()));
        assert!(known.remarks.iter().any(|remark| remark.to_string().contains("records of 2 vehicles")));
    }
}
