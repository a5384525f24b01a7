//! Vehicles of a flow, and many that follow records, in one line: how many came, left and wait outside, their speed and their delay.

use interplay_simulation::measure::Travel;
use interplay_simulation::report::VehicleReport;

/// Fewer vehicles than this are listed by name.
const MIN_VEHICLES: usize = 4;

/// Fewer vehicles than this that follow records are listed by name.
const MIN_RECORDED: usize = 12;
/// The common name of vehicles that follow records.
const RECORDS: &str = "records";

/// Vehicles of one flow, or those that follow records.
pub(super) struct Crowd<'a> {
    /// The common name.
    pub name: &'a str,
    pub vehicles: Vec<&'a VehicleReport>,
}

impl<'a> Crowd<'a> {
    /// The crowds among the vehicles, and the vehicles outside of them, both in the scenario's order.
    pub fn split(vehicles: &'a [VehicleReport]) -> (Vec<Crowd<'a>>, Vec<&'a VehicleReport>) {
        let mut crowds: Vec<Crowd<'a>> = Vec::new();
        for vehicle in vehicles {
            let Some(name) = crowd_of(vehicle) else { continue };
            match crowds.iter_mut().find(|crowd| crowd.name == name) {
                Some(crowd) => crowd.vehicles.push(vehicle),
                None => crowds.push(Crowd { name, vehicles: vec![vehicle] }),
            }
        }
        crowds.retain(|crowd| crowd.vehicles.len() >= least_of(crowd.vehicles[0]));
        let alone = vehicles.iter().filter(|vehicle| !is_in(&crowds, vehicle)).collect();
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

/// Whether a vehicle is in one of these crowds.
pub(super) fn is_in(crowds: &[Crowd<'_>], vehicle: &VehicleReport) -> bool {
    crowd_of(vehicle).is_some_and(|name| crowds.iter().any(|crowd| crowd.name == name))
}

/// The name of the crowd to which a vehicle may belong: a flow, or the recorded traffic around an ego.
fn crowd_of(vehicle: &VehicleReport) -> Option<&str> {
    let follows_record = vehicle.follows_record && !vehicle.is_ego && !vehicle.is_obstacle;
    vehicle.flow.as_deref().or(follows_record.then_some(RECORDS))
}

/// The size from which vehicles like this one are a crowd.
fn least_of(vehicle: &VehicleReport) -> usize {
    if vehicle.flow.is_some() { MIN_VEHICLES } else { MIN_RECORDED }
}
