//! Vehicles on roads of parallel lanes.

use std::sync::Arc;

use interplay_planners::{Route, State};

use super::written::{Start, VehicleAsWritten, next_to};
use crate::model::traffic::lane_reference::LaneReference;
use crate::resolve::check::consistency::no_such_lane;
use crate::roads::Road;
use crate::text::error::Fault;

/// The state of a vehicle at its start.
///
/// # Errors
/// For a start that is not a position, and for lanes with names; all errors are returned.
pub(super) fn place(written: &VehicleAsWritten<'_>, road: &Road, route: &Arc<Route>) -> Result<Start, Vec<Fault>> {
    let state =
        if written.stated.start.is_in_lane() { in_lane(written, road, route) } else { in_world(written, road, route) };
    let goal = match &written.stated.goal.lane {
        Some(LaneReference::Name(name)) => Some(no_names(written, "goal.lane", name, road)),
        // For a vehicle with a position, the goal is checked later.
        Some(LaneReference::Number(lane)) if state.is_err() => {
            let refused = no_such_lane(&format!("{}.goal.lane", written.shown()), *lane, road);
            refused.map(|(message, help)| written.fault("goal.lane", "no such lane", message).help(help))
        }
        _ => None,
    };
    let along = written.stated.route.first().map(|name| no_names(written, "route", name, road));
    let faults: Vec<Fault> = goal.into_iter().chain(along).collect();
    match state {
        Ok(state) if faults.is_empty() => Ok((state, Arc::clone(route))),
        Ok(_) => Err(faults),
        Err(fault) => Err([vec![fault], faults].concat()),
    }
}

fn no_names(written: &VehicleAsWritten<'_>, key: &str, name: &str, road: &Road) -> Fault {
    let lanes = road.parallel_lanes().map_or(0, |lanes| lanes.count);
    let message = format!("`{}.{key}` names lane `{name}`, but the lanes of this road have no names", written.shown());
    let help = if key == "route" {
        "leave it out: on parallel lanes the `lane` of `goal` says where a vehicle goes".to_owned()
    } else {
        format!("they are counted from the right: 0 to {}", lanes.saturating_sub(1))
    };
    written.fault(key, "no such lane", message).help(help)
}

fn in_world(written: &VehicleAsWritten<'_>, road: &Road, route: &Route) -> Result<State, Fault> {
    let [x_m, y_m] = written.position()?;
    let stated_rad = written.stated.start.heading_rad();
    let state = State { x_m, y_m, heading_rad: stated_rad, speed_mps: written.stated.start.speed_mps };
    if road.corridor(written.stated.road).is_some() {
        return Ok(state);
    }
    Ok(State { heading_rad: next_to(stated_rad, route.heading_at(state.position())), ..state })
}

fn in_lane(written: &VehicleAsWritten<'_>, road: &Road, route: &Route) -> Result<State, Fault> {
    let lane = match written.stated.start.lane.as_ref().ok_or_else(|| written.missing("lane"))? {
        LaneReference::Number(lane) => *lane,
        LaneReference::Name(name) => return Err(no_names(written, "start.lane", name, road)),
    };
    let along_m = written.stated.start.along_m.ok_or_else(|| written.missing("along_m"))?;
    if let Some((message, help)) = no_such_lane(&format!("{}.start.lane", written.shown()), lane, road) {
        return Err(written.fault("start.lane", "no such lane", message).help(help));
    }
    let offset_m = written.offset_within(0.5 * road.lane_width_m())?;
    let centre = &route.centre;
    let lane_m = road.lane_centre_m(written.stated.road, lane).unwrap_or_default();
    let [x_m, y_m] = centre.position(along_m, lane_m + offset_m);
    let heading_rad = centre.at(along_m).heading_rad + written.stated.start.heading_error_rad();
    Ok(State { x_m, y_m, heading_rad, speed_mps: written.stated.start.speed_mps })
}
