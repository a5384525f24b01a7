//! Marks at the edge of a view for vehicles that are mentioned but out of view: their direction and distance.

use interplay_planners::State;
use interplay_scenarios::Scenario;

use crate::camera::CameraView;

/// Distance of a mark from the edge of the view \[px\].
const INSET_PX: f64 = 12.0;

/// A mark for a vehicle out of view.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeMark {
    /// Index of the vehicle.
    pub vehicle: usize,
    /// Place of the mark \[px\].
    pub at: [f64; 2],
    /// Direction in which the vehicle is, a vector of length 1 with y downwards.
    pub toward: [f64; 2],
    /// Name of the vehicle and its distance from the ego.
    pub words: String,
}

impl EdgeMark {
    /// The arrow letter that is nearest to the direction of the vehicle.
    pub fn arrow(&self) -> char {
        let [x, y] = self.toward;
        match (x.abs() >= y.abs(), x > 0.0, y > 0.0) {
            (true, true, _) => '→',
            (true, false, _) => '←',
            (false, _, true) => '↓',
            (false, _, false) => '↑',
        }
    }
}

/// The marks of the mentioned vehicles that are entirely out of view.
pub fn edge_marks(scenario: &Scenario, view: &CameraView, states: &[State], mentioned: &[usize]) -> Vec<EdgeMark> {
    let ego = &states[scenario.ego_index()];
    let is_seen = |index: usize| {
        let corners = scenario.vehicles[index].body.corners(&states[index]).map(|corner| view.place(corner));
        corners.iter().any(|corner| (0..2).all(|axis| (0.0..view.size_px[axis]).contains(&corner[axis])))
    };
    let mark = |index: usize| {
        let (from, to) = (view.place(ego.position()), view.place(states[index].position()));
        let away = [to[0] - from[0], to[1] - from[1]];
        let length = libm::hypot(away[0], away[1]).max(1e-9);
        // The share of the line from the ego to the vehicle at which this axis reaches the inset edge; 0 if the ego is
        // already beyond that edge.
        let share = |axis: usize| {
            let edge = if away[axis] > 0.0 { view.size_px[axis] - INSET_PX } else { INSET_PX };
            if away[axis] == 0.0 { 1.0 } else { ((edge - from[axis]) / away[axis]).clamp(0.0, 1.0) }
        };
        let share = share(0).min(share(1));
        let at = [0, 1].map(|axis| (from[axis] + share * away[axis]).clamp(INSET_PX, view.size_px[axis] - INSET_PX));
        let [x, y] = states[index].position();
        let distance_m = libm::hypot(x - ego.x_m, y - ego.y_m);
        let decimals = usize::from(distance_m < 9.95);
        let words = format!("{}, {distance_m:.decimals$} m", scenario.vehicles[index].name);
        EdgeMark { vehicle: index, at, toward: away.map(|part| part / length), words }
    };
    mentioned.iter().copied().filter(|index| !is_seen(*index)).map(mark).collect()
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;

    /// Of two vehicles ahead only the one out of view has a mark, at the edge toward it.
    #[test]
    fn a_vehicle_out_of_view_is_marked_at_the_edge_toward_it() {
        let scenario = load("lane-change/front-nice", &[]).expect("embedded");
        let at = |x_m: f64, y_m: f64| State { x_m, y_m, ..State::default() };
        let view = CameraView { centre_m: [0.0, 0.0], px_per_m: 100.0, size_px: [720.0, 300.0] };
        let states = [at(0.0, 0.0), at(2.0, 0.0), at(30.0, 0.0)];
        let marks = edge_marks(&scenario, &view, &states, &[1, 2]);
        let name = &scenario.vehicles[2].name;
        assert_eq!(marks.len(), 1);
        assert_eq!((marks[0].vehicle, marks[0].words.as_str()), (2, format!("{name}, 30 m").as_str()));
        assert_eq!((marks[0].at, marks[0].toward, marks[0].arrow()), ([708.0, 150.0], [1.0, 0.0], '→'));
        let above = edge_marks(&scenario, &view, &[at(0.0, 0.0), at(2.0, 0.0), at(-0.3, 4.0)], &[2]);
        assert_eq!((above[0].at[1], above[0].arrow()), (12.0, '↑'));
        assert!(above[0].words.ends_with(", 4.0 m"), "{}", above[0].words);
    }
}
