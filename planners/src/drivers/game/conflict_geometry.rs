//! The two geometries of a conflict, and what yielding and passing look like in them (eq. 8.2-8.4).

use super::Settings;
use super::intention::Behaviour;
use crate::drivers::partner_choice::distance_to_path;
use crate::scene::relation::Relation;
use crate::{Agent, Scene};

/// How the ways of two vehicles conflict.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ConflictGeometry {
    /// On one road: how far the ego is ahead of the other, `d` \[m\].
    Alongside {
        /// How far the ego is ahead of the other, `d` \[m\].
        lead_m: f64,
    },
    /// Where roads cross: how far the ego and the other are from the conflict zone, `d_c`; negative inside \[m\].
    Crossing {
        /// Distance of the ego from the conflict zone \[m\].
        ego_m: f64,
        /// Distance of the other from the conflict zone \[m\].
        other_m: f64,
    },
}

/// An observation of one vehicle, with what would be observed if it yielded or passed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObservedBehaviour {
    /// Mean speed \[m/s\], or time of arrival \[s\].
    pub observed: f64,
    /// The observations that are expected of one that yields and of one that passes.
    pub behaviour: Behaviour,
}

impl ConflictGeometry {
    /// How the ego meets `other`; `None` for one that comes head-on on a straight road, or whose way is apart.
    pub fn find(scene: &Scene, other: &Agent, settings: &Settings) -> Option<ConflictGeometry> {
        let ego = &scene.ego;
        match ego.relation(other) {
            Relation::Alongside => return Some(ConflictGeometry::Alongside { lead_m: -ego.lead_of(other) }),
            Relation::Apart => return None,
            Relation::CrossingRoads | Relation::Conflict(_) => {}
        }
        let ego_m = distance_to_path(ego, other)? - settings.conflict_edge_m;
        Some(ConflictGeometry::Crossing { ego_m, other_m: distance_to_path(other, ego)? - settings.conflict_edge_m })
    }

    /// Whether neither vehicle has passed the conflict zone.
    pub fn is_open(&self) -> bool {
        match *self {
            ConflictGeometry::Alongside { .. } => true,
            ConflictGeometry::Crossing { ego_m, other_m } => ego_m > 0.0 && other_m > 0.0,
        }
    }

    /// What the ego shows the other and the other shows the ego, at these mean speeds, in the corrected form: a vehicle that passes
    /// keeps the largest speed that it has shown, `v⁰`, and who yields slows down against it.
    ///
    /// On one road `μ_p = v⁰` and `μ_y = v⁰ − d_s/t_f`; at a crossing `μ_p = T⁰` and `μ_y = T⁰ + T_c`, where `T⁰` is the
    /// arrival at `v⁰`. What one vehicle shows does not depend on the other's motion. The means are half as far apart as
    /// printed (`2 d_s/t_f`, `2 T_c`), so the deviation is half of `σ_1` or `σ_2`.
    pub fn own_observations(
        &self,
        mean_mps: [f64; 2],
        fastest_mps: [f64; 2],
        settings: &Settings,
    ) -> [ObservedBehaviour; 2] {
        let distances = match *self {
            ConflictGeometry::Alongside { .. } => [None; 2],
            ConflictGeometry::Crossing { ego_m, other_m } => [Some(ego_m), Some(other_m)],
        };
        [0, 1].map(|who| {
            let (mean, fastest) = (mean_mps[who], fastest_mps[who]);
            let Some(distance) = distances[who] else {
                let yielding = fastest - settings.safety_gap_m / settings.finish_s;
                let behaviour = Behaviour { yielding, passing: fastest, deviation: 0.5 * settings.sigma_1_mps };
                return ObservedBehaviour { observed: mean, behaviour };
            };
            let passing = arrival_s(distance, fastest, settings);
            let yielding = passing + settings.crossing_s;
            let behaviour = Behaviour { yielding, passing, deviation: 0.5 * settings.sigma_2_s };
            ObservedBehaviour { observed: arrival_s(distance, mean, settings), behaviour }
        })
    }

    /// What the ego shows the other and the other shows the ego, at these mean speeds, as printed (eq. 8.3, 8.4).
    pub fn observations(&self, [ego_mps, other_mps]: [f64; 2], settings: &Settings) -> [ObservedBehaviour; 2] {
        match *self {
            ConflictGeometry::Alongside { lead_m } => {
                let seen = |observed: f64, reference: f64, lead_m: f64| {
                    let (gap, finish) = (settings.safety_gap_m, settings.finish_s);
                    let behaviour = Behaviour {
                        yielding: reference - (gap - lead_m) / finish,
                        passing: reference + (gap + lead_m) / finish,
                        deviation: settings.sigma_1_mps,
                    };
                    ObservedBehaviour { observed, behaviour }
                };
                // `d` is how far the one who watches is ahead.
                [seen(ego_mps, other_mps, -lead_m), seen(other_mps, ego_mps, lead_m)]
            }
            ConflictGeometry::Crossing { ego_m, other_m } => {
                let times = [arrival_s(ego_m, ego_mps, settings), arrival_s(other_m, other_mps, settings)];
                let seen = |observed: f64, reference: f64| {
                    let behaviour = Behaviour {
                        yielding: reference + settings.crossing_s,
                        passing: reference - settings.crossing_s,
                        deviation: settings.sigma_2_s,
                    };
                    ObservedBehaviour { observed, behaviour }
                };
                [seen(times[0], times[1]), seen(times[1], times[0])]
            }
        }
    }
}

/// The time of arrival at the conflict zone (eq. 8.2; capped, so that it grows as the speed falls).
fn arrival_s(distance_m: f64, speed_mps: f64, settings: &Settings) -> f64 {
    if speed_mps < settings.standstill_mps {
        return settings.arrival_max_s;
    }
    (distance_m.max(0.0) / speed_mps).min(settings.arrival_max_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{agent, crossing, scene};

    /// Both geometries: another beside the ego, and one that comes from the right.
    #[test]
    fn a_meeting_is_known_by_its_roads() {
        let (scene, settings) = (scene(agent(0.0, 0.0, 0.0, 1.0), Vec::new()), Settings::default());
        let beside = ConflictGeometry::find(&scene, &agent(-0.4, 0.4, 0.0, 1.0), &settings);
        assert_eq!(beside, Some(ConflictGeometry::Alongside { lead_m: 0.4 }));
        let Some(ConflictGeometry::Crossing { ego_m, other_m }) =
            ConflictGeometry::find(&scene, &crossing(2.0, -1.5, 1.0), &settings)
        else {
            panic!("the roads cross");
        };
        assert!((ego_m - 1.7).abs() < 1e-12 && (other_m - 1.2).abs() < 1e-12);
        assert_eq!(ConflictGeometry::find(&scene, &agent(3.0, 0.0, std::f64::consts::PI, 1.0), &settings), None);
    }

    #[test]
    fn the_faster_of_two_side_by_side_is_the_one_that_seems_to_pass() {
        let settings = Settings::default();
        let [ego, other] = ConflictGeometry::Alongside { lead_m: 0.0 }.observations([1.2, 1.0], &settings);
        assert!(ego.behaviour.posterior(0.5, ego.observed) > 0.5);
        assert!(other.behaviour.posterior(0.5, other.observed) < 0.5);
        let [same, alike] = ConflictGeometry::Alongside { lead_m: 0.0 }.observations([1.0, 1.0], &settings);
        assert!((same.behaviour.posterior(0.5, 1.0) - 0.5).abs() < 1e-12);
        assert_eq!(same, alike);
    }

    /// Eq. 8.3 with the numbers written out: the other is seen by an ego that is 0.4 m ahead.
    #[test]
    fn expected_speeds_end_a_safety_gap_behind_or_ahead() {
        let settings = Settings { safety_gap_m: 1.5, finish_s: 5.0, ..Settings::default() };
        let [ego, other] = ConflictGeometry::Alongside { lead_m: 0.4 }.observations([1.0, 1.1], &settings);
        assert!((other.behaviour.yielding - (1.0 - 1.1 / 5.0)).abs() < 1e-12);
        assert!((other.behaviour.passing - (1.0 + 1.9 / 5.0)).abs() < 1e-12);
        assert!((ego.behaviour.yielding - (1.1 - 1.9 / 5.0)).abs() < 1e-12);
        assert!((ego.behaviour.passing - (1.1 + 1.1 / 5.0)).abs() < 1e-12);
    }

    const GEOMETRIES: [ConflictGeometry; 2] =
        [ConflictGeometry::Alongside { lead_m: 0.3 }, ConflictGeometry::Crossing { ego_m: 2.0, other_m: 1.5 }];

    #[test]
    fn a_vehicle_that_keeps_its_speed_seems_to_pass_and_one_that_slows_down_to_yield() {
        let settings = Settings::default();
        for geometry in GEOMETRIES {
            let [kept, slowed] = geometry.own_observations([0.8, 0.5], [0.8, 0.8], &settings);
            assert!(kept.behaviour.posterior(0.5, kept.observed) > 0.5);
            assert!(slowed.behaviour.posterior(0.5, slowed.observed) < 0.5);
        }
    }

    #[test]
    fn in_the_corrected_form_one_vehicle_s_motion_says_nothing_about_the_other() {
        let settings = Settings::default();
        for geometry in GEOMETRIES {
            let seen = |ego_mps: f64| geometry.own_observations([ego_mps, 0.7], [1.2, 0.8], &settings)[1];
            assert_eq!(seen(0.2), seen(1.2));
        }
    }

    #[test]
    fn the_first_to_arrive_seems_to_pass() {
        let settings = Settings::default();
        let geometry = ConflictGeometry::Crossing { ego_m: 1.0, other_m: 2.0 };
        let [ego, other] = geometry.observations([1.0, 1.0], &settings);
        assert_eq!((ego.observed, other.observed), (1.0, 2.0));
        assert!(ego.behaviour.posterior(0.5, ego.observed) > 0.5);
        assert!(other.behaviour.posterior(0.5, other.observed) < 0.5);
        assert!(geometry.is_open() && !ConflictGeometry::Crossing { ego_m: -0.1, other_m: 2.0 }.is_open());
    }

    #[test]
    fn a_stationary_vehicle_arrives_last() {
        let settings = Settings::default();
        let times = [0.0, 0.04, 0.06, 0.2, 1.0].map(|speed| arrival_s(2.0, speed, &settings));
        assert!(times.windows(2).all(|pair| pair[0] >= pair[1]), "{times:?}");
        assert_eq!(times[0], settings.arrival_max_s);
    }
}
