//! Who causes the first contact of the ego.

use interplay_scenarios::MetricDeclaration;
use interplay_scenarios::MetricKind::Flag;
use interplay_scenarios::Scenario;

use crate::measure::metric::{Measurement, Metric, ObservedMoment, ObservedTick};
use crate::measure::values::{Measured, MetricValue};

pub(super) const METRICS: &[&dyn Metric] = &[&ContactByEgo];

/// Whether in its first contact the ego moves towards the other at least as fast as the other towards it.
#[derive(Clone, Copy, Debug)]
struct ContactByEgo;

#[derive(Clone, Copy, Debug)]
struct FirstContact {
    /// The index of the ego.
    ego: usize,
    /// Whether the ego caused it; none before there is one.
    by_ego: Option<bool>,
}

impl Metric for ContactByEgo {
    fn declaration(&self) -> MetricDeclaration {
        let doc =
            "Whether in its first contact the ego moved towards the other at least as fast as the other towards it";
        MetricDeclaration::of_run("contact_by_ego", Flag, doc)
    }

    fn begin(&self, _: &Scenario, _: &ObservedMoment<'_>, vehicle: usize) -> Box<dyn Measurement> {
        Box::new(FirstContact { ego: vehicle, by_ego: None })
    }
}

impl Measurement for FirstContact {
    fn observe(&mut self, tick: &ObservedTick<'_>) {
        let vehicles = &tick.frame.vehicles;
        let Some(ego) = vehicles.get(self.ego).filter(|_| self.by_ego.is_none()) else { return };
        let contact = tick.frame.collisions.iter().find(|contact| contact.between.contains(&ego.name));
        let is_other =
            |name: &String| *name != ego.name && contact.is_some_and(|contact| contact.between.contains(name));
        if let Some(other) = vehicles.iter().find(|vehicle| is_other(&vehicle.name)) {
            self.by_ego = Some(ego.state.drives_into(&other.state));
        }
    }

    fn measured(&self) -> Measured {
        Measured { value: Some(MetricValue::Flag(self.by_ego.unwrap_or(false))), ..Measured::default() }
    }

    fn fork(&self) -> Box<dyn Measurement> {
        Box::new(*self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Collision, Frame, VehicleFrame};

    /// A vehicle that drives along the road.
    fn at(name: &str, x_m: f64, speed_mps: f64) -> VehicleFrame {
        let mut vehicle = VehicleFrame { name: name.to_owned(), ..VehicleFrame::default() };
        vehicle.state.x_m = x_m;
        vehicle.state.speed_mps = speed_mps;
        vehicle
    }

    #[test]
    fn the_first_contact_of_the_ego_says_who_drives_into_whom() {
        // The ego between one behind and one ahead of it, with its speed; one of the others touches it.
        let frame = |ego_mps: f64, between: [&str; 2]| Frame {
            vehicles: vec![at("behind", -1.0, 1.0), at("ego", 0.0, ego_mps), at("ahead", 1.0, 0.5)],
            collisions: vec![Collision { time_s: 0.0, between: between.map(str::to_owned), impulse_ns: 1.0 }],
            ..Frame::default()
        };
        let by = |ego: usize, frames: &[Frame]| {
            let mut contact = FirstContact { ego, by_ego: None };
            let end = ObservedMoment { time_s: 0.0, vehicles: &[], states: &[], along_m: &[] };
            for frame in frames {
                contact.observe(&ObservedTick { frame, step_s: 0.1, previous_inputs: &[], end });
            }
            contact.measured().value == Some(MetricValue::Flag(true))
        };
        let [into, into_it] = [frame(1.0, ["ego", "ahead"]), frame(0.5, ["behind", "ego"])];
        assert!(by(1, std::slice::from_ref(&into)), "into the one ahead");
        assert!(!by(1, std::slice::from_ref(&into_it)), "the one behind into it");
        assert!(!by(1, &[frame(1.0, ["behind", "ahead"])]), "others");
        let quiet = Frame { collisions: Vec::new(), ..into.clone() };
        assert!(by(1, &[quiet, into.clone(), into_it.clone()]), "the first one counts");
        assert!(!by(1, &[into_it, into.clone()]), "the first one counts");
        assert!(!by(7, &[into]), "there is no such vehicle");
    }
}
