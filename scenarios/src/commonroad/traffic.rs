//! The recorded traffic of a scenario of CommonRoad: its lanelets and dynamic obstacles, without conversion to a scenario of Interplay.

use std::collections::BTreeMap;
use std::path::Path;

use super::model::{CommonRoad, Lanelet, Obstacle, Region, Role, SignMeaning};
use super::xml::{Unread, Xml};
use crate::commonroad::recorded_traffic::{RecordedLane, RecordedMoment, RecordedTraffic, RecordedVehicle};
use crate::format::read::source::imported_text;
use crate::resolve::local_origin;
use crate::text::error::{Fault, LoadError};

/// Reads the recorded traffic of a scenario of CommonRoad: every lanelet for vehicles, and every dynamic obstacle with a trajectory.
///
/// # Errors
/// If the file cannot be read or is not such a scenario; each error is located.
pub fn recorded_traffic_in_commonroad(path: &Path) -> Result<RecordedTraffic, LoadError> {
    let name = path.display().to_string();
    let read = imported_text(path).and_then(|text| traffic(&name, &text));
    read.map_err(|fault| LoadError::new(name, vec![fault]))
}

fn traffic(name: &str, text: &str) -> Result<RecordedTraffic, Fault> {
    let xml = Xml::parse(name, text)?;
    let scenario = CommonRoad::read(xml.root(), &mut Unread::default())?;
    let lanelets: Vec<&Lanelet<'_>> = scenario.lanelets.iter().filter(|lanelet| !lanelet.is_for_walkers()).collect();
    let indices: BTreeMap<&str, usize> =
        lanelets.iter().enumerate().map(|(index, lanelet)| (lanelet.id.as_str(), index)).collect();
    let lane = |lanelet: &&Lanelet<'_>| {
        let named = |ids: &[String]| ids.iter().filter_map(|id| indices.get(id.as_str()).copied()).collect();
        let signs = scenario.signs.iter().filter(|sign| lanelet.signs.contains(&sign.id));
        let limits_mps = signs.flat_map(|sign| &sign.meanings).filter_map(|meaning| match meaning {
            SignMeaning::SpeedLimit(limit_mps) => Some(*limit_mps),
            _ => None,
        });
        RecordedLane {
            id: lanelet.id.clone(),
            left: lanelet.left.clone(),
            right: lanelet.right.clone(),
            successors: named(&lanelet.successors),
            predecessors: named(&lanelet.predecessors),
            speed_limit_mps: limits_mps.chain(lanelet.speed_limit_mps).reduce(f64::min),
        }
    };
    let moving = scenario.obstacles.iter().filter(|obstacle| obstacle.role == Role::Dynamic);
    Ok(RecordedTraffic {
        name: scenario.benchmark.clone(),
        step_s: scenario.step_s,
        lanes: lanelets.iter().map(lane).collect(),
        vehicles: moving.filter_map(vehicle).collect(),
    })
}

/// An obstacle as a vehicle; none for one without a trajectory or without a shape.
fn vehicle(obstacle: &Obstacle<'_>) -> Option<RecordedVehicle> {
    let (rectangle, _) = obstacle.shape.iter().find_map(|shape| shape.rectangle())?;
    let mut moments: Vec<RecordedMoment> = Vec::with_capacity(obstacle.states.len());
    for state in &obstacle.states {
        let (sin, cos) = libm::sincos(state.orientation_rad);
        let ([x, y], [ahead, left]) = (state.position, rectangle.centre);
        let moment = RecordedMoment {
            step: state.time.round() as i64,
            position: [x + cos * ahead - sin * left, y + sin * ahead + cos * left],
            heading_rad: state.orientation_rad,
            speed_mps: state.velocity_mps,
        };
        if moments.last().is_none_or(|last| moment.step > last.step) {
            moments.push(moment);
        }
    }
    (moments.len() > 1).then(|| RecordedVehicle {
        id: obstacle.id.clone(),
        kind: obstacle.kind.clone(),
        length_m: rectangle.length_m,
        width_m: rectangle.width_m,
        moments,
    })
}

impl CommonRoad<'_> {
    /// Moves everything near the origin, if it is far away. Returns the place that is the origin now.
    pub(super) fn move_near_origin(&mut self) -> Option<[f64; 2]> {
        let origin = local_origin::of(*self.lanelets.first()?.left.first()?)?;
        let moved = |point: &mut [f64; 2]| *point = [point[0] - origin[0], point[1] - origin[1]];
        for lanelet in &mut self.lanelets {
            lanelet.left.iter_mut().chain(&mut lanelet.right).for_each(moved);
        }
        for state in self.obstacles.iter_mut().flat_map(|obstacle| &mut obstacle.states) {
            moved(&mut state.position);
        }
        for problem in &mut self.problems {
            moved(&mut problem.initial.position);
            for region in problem.goals.iter_mut().flat_map(|goal| &mut goal.position) {
                match region {
                    Region::Rectangle(rectangle) => moved(&mut rectangle.centre),
                    Region::Circle { centre, .. } => moved(centre),
                    Region::Polygon(corners) => corners.iter_mut().for_each(moved),
                    Region::Point(point) => moved(point),
                    Region::Lanelets(_) => {}
                }
            }
        }
        Some(origin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanelets_and_obstacles_are_read_unchanged() {
        let text = r#"<commonRoad timeStepSize="0.5" commonRoadVersion="2020a" benchmarkID="A_B-1_1_T-1">
          <lanelet id="1"><leftBound><point><x>0</x><y>3</y></point><point><x>9</x><y>3</y></point></leftBound>
            <rightBound><point><x>0</x><y>0</y></point><point><x>9</x><y>0</y></point></rightBound>
            <successor ref="2"/><speedLimit>7</speedLimit></lanelet>
          <lanelet id="2"><leftBound><point><x>9</x><y>3</y></point><point><x>19</x><y>3</y></point></leftBound>
            <rightBound><point><x>9</x><y>0</y></point><point><x>19</x><y>0</y></point></rightBound></lanelet>
          <dynamicObstacle id="3"><type>car</type>
            <shape><rectangle><length>4.5</length><width>1.8</width></rectangle></shape>
            <initialState><position><point><x>1</x><y>1</y></point></position><orientation><exact>0</exact></orientation>
              <time><exact>0</exact></time><velocity><exact>2</exact></velocity></initialState>
            <trajectory><state><position><point><x>2</x><y>1</y></point></position><orientation><exact>0</exact></orientation>
              <time><exact>1</exact></time><velocity><exact>2</exact></velocity></state></trajectory></dynamicObstacle>
        </commonRoad>"#;
        let traffic = traffic("a.xml", text).expect("a scenario");
        assert_eq!((traffic.lanes[0].successors.as_slice(), traffic.lanes[0].speed_limit_mps), (&[1][..], Some(7.0)));
        assert_eq!((traffic.vehicles.len(), traffic.vehicles[0].moments[1].position), (1, [2.0, 1.0]));
    }
}
