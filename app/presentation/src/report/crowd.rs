//! Vehicles of a flow in one line: how many came, left and wait outside, their speed and their delay.

use interplay_simulation::measure::Travel;
use interplay_simulation::report::VehicleReport;

/// Fewer vehicles than this are listed by name.
const MIN_VEHICLES: usize = 4;

/// Vehicles that are called alike, with a number: `west-1`, `west-2`.
pub(super) struct Crowd<'a> {
    /// The common name.
    pub name: &'a str,
    pub vehicles: Vec<&'a VehicleReport>,
}

impl<'a> Crowd<'a> {
    /// The crowds among the vehicles, and the vehicles outside of them, both in the scenario's order.
    pub fn split(vehicles: &'a [VehicleReport]) -> (Vec<Crowd<'a>>, Vec<&'a VehicleReport>) {
        let mut crowds: Vec<Crowd<'a>> = Vec::new();
        for vehicle in vehicles.iter().filter(|vehicle| !vehicle.is_obstacle) {
            let Some(name) = flow_of(&vehicle.name) else { continue };
            match crowds.iter_mut().find(|crowd| crowd.name == name) {
                Some(crowd) => crowd.vehicles.push(vehicle),
                None => crowds.push(Crowd { name, vehicles: vec![vehicle] }),
            }
        }
        crowds.retain(|crowd| crowd.vehicles.len() >= MIN_VEHICLES);
        let is_alone = |vehicle: &&VehicleReport| {
            flow_of(&vehicle.name).is_none_or(|name| crowds.iter().all(|crowd| crowd.name != name))
        };
        let alone = vehicles.iter().filter(is_alone).collect();
        (crowds, alone)
    }

    /// In words: `west: 97 came, 60 left, 12 wait outside, mean speed 14.2 m/s, mean delay 3.1 s`.
    pub fn sentence(&self) -> String {
        let travels: Vec<&Travel> = self.vehicles.iter().map(|vehicle| &vehicle.travel).collect();
        let came: Vec<&Travel> = travels.iter().copied().filter(|travel| travel.has_come()).collect();
        let left = came.iter().filter(|travel| travel.is_absent).count();
        let sum = |of: fn(&Travel) -> f64| came.iter().map(|travel| of(travel)).sum::<f64>();
        let (distance_m, present_s) = (sum(|travel| travel.distance_m), sum(|travel| travel.present_s));
        let mut text = format!("{}: {} came, {left} left", self.name, came.len());
        if travels.len() > came.len() {
            text += &format!(", {} wait outside", travels.len() - came.len());
        }
        if present_s > 0.0 {
            let delay_s = sum(|travel| travel.delay_s().unwrap_or(0.0)) / came.len() as f64;
            text += &format!(", mean speed {:.1} m/s, mean delay {delay_s:.1} s", distance_m / present_s);
        }
        let stood = self.vehicles.iter().filter(|vehicle| !vehicle.standing.is_empty());
        let longest_s = |vehicle: &VehicleReport| vehicle.standing.iter().map(|wait| wait.waited_s).sum::<f64>();
        match stood.clone().count() {
            0 => text,
            count => {
                let most_s = stood.map(|vehicle| longest_s(vehicle)).fold(0.0, f64::max);
                text + &format!(", {count} stood, at most {most_s:.1} s")
            }
        }
    }
}

/// The name before the number of a vehicle of a flow.
pub(super) fn flow_of(name: &str) -> Option<&str> {
    let (flow, number) = name.rsplit_once('-')?;
    (!number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())).then_some(flow)
}
