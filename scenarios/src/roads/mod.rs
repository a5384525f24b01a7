//! Roads, one file for each form.
//!
//! A road of parallel lanes begins along x and its right edge there is y = 0; another one may cross it. Lanes are counted from
//! the right in driving direction: the centre of lane `i` lies `(i + ½) w` to the left of the right edge.
//!
//! Other roads are networks of lanes with names.
//!
//! Coordinates along and across a road are those of a [`Route`]. On a straight road they are the projections on its
//! direction and on the normal of that, from the origin. On a curve, along is the arc length of the road's middle, and across
//! is the distance from the middle, positive to the left. On a network they are those of the lanes of the route.

mod curve;
mod form;
mod junctions;
mod lanes;
mod network;

use std::sync::Arc;

use interplay_common::foreign::{ForeignSettings, KindTable};
use interplay_planners::road::network::Lane;
use interplay_planners::{Corridor, LaneEnd, Route};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize, Serializer};

pub(crate) use curve::{CurveFault, PieceFault, Turn};
pub use curve::{CurveLaneEnd, CurvePiece, RoadCurve};
pub(crate) use form::to_centimetres;
pub use form::{RoadFault, RoadForm};
pub use junctions::*;
pub use lanes::{Intersection, Lanes, RampMerge};
pub use network::{LaneConfig, LaneNetwork, LanePlaceConfig, LaneWidth, NeighbourConfig, NeighbourTable};

/// The settings of a road whose form another crate provides.
pub type ForeignRoad = ForeignSettings<dyn RoadForm>;

/// Declares [`Road`] with the forms in `junctions`, and the methods of every form.
macro_rules! road {
    ($($file:ident::$Form:ident: $about:literal;)*) => {
        /// A road; `kind` chooses.
        #[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
        #[serde(tag = "kind", rename_all = "kebab-case")]
        pub enum Road {
            /// A straight road along x with parallel lanes; its right edge is y = 0.
            Lanes(Lanes),
            /// The same, but lane 0 is a ramp that ends: its vehicles must merge into lane 1 before, or stop.
            RampMerge(RampMerge),
            /// Two roads that cross, each with lanes in one direction; the key `road` of a vehicle selects the one on which it drives.
            Intersection(Intersection),
            /// A road of straight and curved pieces with parallel lanes, of which lane 0 may end.
            Curve(RoadCurve),
            /// Lanes with names, each with its line, its width, and the lanes after and beside it.
            Network(LaneNetwork),
            $(#[doc = $about] $Form($Form),)*
            /// A form of another crate. It is read by the registry that knows it.
            #[serde(skip)]
            Foreign(ForeignRoad),
        }

        /// A table with the `kind` and the settings, as a scenario file has it.
        impl Serialize for Road {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                match self {
                    Road::Lanes(settings) => KindTable { kind: "lanes", settings }.serialize(serializer),
                    Road::RampMerge(settings) => KindTable { kind: "ramp-merge", settings }.serialize(serializer),
                    Road::Intersection(settings) => KindTable { kind: "intersection", settings }.serialize(serializer),
                    Road::Curve(settings) => KindTable { kind: "curve", settings }.serialize(serializer),
                    Road::Network(settings) => KindTable { kind: "network", settings }.serialize(serializer),
                    $(Road::$Form(settings) => {
                        KindTable { kind: &stringify!($file).replace('_', "-"), settings }.serialize(serializer)
                    })*
                    Road::Foreign(foreign) => foreign.serialize(serializer),
                }
            }
        }

        impl Road {
            /// The lanes of a network, unchecked; `None` on a road of parallel lanes.
            ///
            /// # Errors
            /// For lanes without a line or a width.
            pub(crate) fn network_lanes(&self) -> Option<Result<Vec<Lane>, RoadFault>> {
                match self {
                    Road::Lanes(_) | Road::RampMerge(_) | Road::Intersection(_) | Road::Curve(_) => None,
                    Road::Network(network) => Some(network.lanes()),
                    $(Road::$Form(form) => Some(form.lanes()),)*
                    Road::Foreign(form) => Some(form.settings().lanes()),
                }
            }

            /// Width of one lane; where lanes differ, of the first of them where it begins \[m\].
            pub fn lane_width_m(&self) -> f64 {
                match self {
                    Road::Lanes(lanes) => lanes.lane_width_m,
                    Road::RampMerge(ramp) => ramp.lane_width_m,
                    Road::Intersection(crossing) => crossing.lane_width_m,
                    Road::Curve(curve) => curve.lane_width_m,
                    Road::Network(network) => network.lanes.first().map_or(0.0, |lane| lane.width_m.first_m()),
                    $(Road::$Form(form) => form.lane_width_m,)*
                    Road::Foreign(form) => form.settings().lane_width_m(),
                }
            }
        }
    };
}

junctions::forms!(road);

/// The road that a vehicle drives on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Branch {
    /// The road along x.
    #[default]
    Main,
    /// The road that crosses it; only at an intersection.
    Cross,
}

/// Lanes side by side that are driven in the same direction, counted from the right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParallelLanes {
    /// How many lanes there are.
    pub count: usize,
    /// Width of each lane \[m\].
    pub width_m: f64,
}

impl Default for Road {
    fn default() -> Self {
        Road::Lanes(Lanes::default())
    }
}

impl Road {
    /// The radius of turns of a junction, its key and its value \[m\]; `None` where no key states it.
    pub(crate) fn turn_radius(&mut self) -> Option<(&'static str, &mut f64)> {
        match self {
            Road::Roundabout(ring) => Some(("radius_m", &mut ring.radius_m)),
            Road::TJunction(form) => Some(("turn_radius_m", &mut form.turn_radius_m)),
            Road::Crossing(form) => Some(("turn_radius_m", &mut form.turn_radius_m)),
            Road::AllWayStop(form) => Some(("turn_radius_m", &mut form.turn_radius_m)),
            _ => None,
        }
    }

    pub(crate) const DEFAULT_KIND: &'static str = "lanes";
    /// The kinds with parallel lanes; the others are networks.
    pub(crate) const PARALLEL_KINDS: [&'static str; 4] = ["lanes", "ramp-merge", "intersection", "curve"];

    /// The route along a road of parallel lanes, from one edge to the other; `None` on a network, where each vehicle has its own,
    /// and on a curve with a fault.
    ///
    /// It is computed anew each time: a loaded [`Vehicle`](crate::Vehicle) has its own.
    pub fn route(&self, branch: Branch) -> Option<Arc<Route>> {
        match self {
            Road::Curve(curve) => curve.route().ok(),
            _ => self.corridor(branch).map(Arc::from),
        }
    }

    /// The straight strip that a vehicle on `branch` may use; `None` on a curve and on a network.
    pub fn corridor(&self, branch: Branch) -> Option<Corridor> {
        if matches!(self, Road::Curve(_)) {
            return None;
        }
        self.parallel_lanes()?;
        let heading_rad = self.heading_rad(branch);
        let (width, middle) = (self.width_m(), self.middle_m(branch));
        let (right_m, left_m) = match branch {
            Branch::Main => (0.0, width),
            Branch::Cross => (middle - 0.5 * width, middle + 0.5 * width),
        };
        Some(Corridor { heading_rad, right_m, left_m, end: self.lane_end() })
    }

    /// Whether the road is a network of lanes with names.
    pub fn is_network(&self) -> bool {
        self.parallel_lanes().is_none()
    }

    /// Direction of the lanes of `branch`, of parallel lanes where they begin \[rad\].
    pub fn heading_rad(&self, branch: Branch) -> f64 {
        match (self, branch) {
            (Road::Intersection(crossing), Branch::Cross) => crossing.angle_deg.to_radians(),
            _ => 0.0,
        }
    }

    /// The end of lane 0 of parallel lanes, if it ends.
    pub fn lane_end(&self) -> Option<LaneEnd> {
        match self {
            Road::RampMerge(ramp) => {
                Some(LaneEnd { end_m: ramp.ramp_end_m, height_m: ramp.lane_width_m, taper_m: ramp.taper_m })
            }
            Road::Curve(curve) => curve.lane_end(),
            _ => None,
        }
    }

    pub(crate) fn turns(&self) -> Vec<Turn> {
        match self {
            Road::Curve(curve) => curve.turns().collect(),
            _ => Vec::new(),
        }
    }

    /// The interval of longitudinal coordinates of `branch` in which any part of it lies on the other road; `None` if no roads cross
    /// \[m\].
    pub fn conflict_zone_m(&self, branch: Branch) -> Option<[f64; 2]> {
        let corridor = self.corridor(branch)?;
        let (right, left) = (self.crossed_m(branch, corridor.right_m)?, self.crossed_m(branch, corridor.left_m)?);
        Some([right[0].min(left[0]), right[1].max(left[1])])
    }

    /// The interval of longitudinal coordinates of `branch` in which its points at a lateral coordinate lie on the other road; `None`
    /// if no roads cross \[m\].
    ///
    /// A point `(s, n)` has the lateral coordinate `n′ = n cos γ − s sin γ` on a road that is turned by `γ` against its own.
    pub fn crossed_m(&self, branch: Branch, lateral_m: f64) -> Option<[f64; 2]> {
        let Road::Intersection(_) = self else { return None };
        let other = match branch {
            Branch::Main => Branch::Cross,
            Branch::Cross => Branch::Main,
        };
        let corridor = self.corridor(other)?;
        let (sin, cos) = libm::sincos(corridor.heading_rad - self.heading_rad(branch));
        let reaches = [corridor.right_m, corridor.left_m].map(|edge_m| (lateral_m * cos - edge_m) / sin);
        Some([reaches[0].min(reaches[1]), reaches[0].max(reaches[1])])
    }

    /// The lanes of a road that is not a network.
    pub fn parallel_lanes(&self) -> Option<ParallelLanes> {
        let (count, width_m) = match self {
            Road::Lanes(lanes) => (lanes.lane_count, lanes.lane_width_m),
            Road::RampMerge(ramp) => (ramp.lane_count, ramp.lane_width_m),
            Road::Intersection(crossing) => (crossing.lane_count, crossing.lane_width_m),
            Road::Curve(curve) => (curve.lane_count, curve.lane_width_m),
            _ => return None,
        };
        Some(ParallelLanes { count, width_m })
    }

    /// The key of the road that states the width of a lane, or of the narrowest lanes.
    pub(crate) fn width_key(&self, lane: &str) -> String {
        match self {
            Road::Network(network) => {
                let number = network.lanes.iter().position(|stated| stated.name == lane);
                number.map_or_else(|| "lane".to_owned(), |number| format!("lane.{number}.width_m"))
            }
            Road::NarrowPassage(passage) if passage.passage_width_m < passage.lane_width_m => {
                "passage_width_m".to_owned()
            }
            _ => "lane_width_m".to_owned(),
        }
    }

    /// Width of all parallel lanes together, of each road; on a network, of one lane \[m\].
    pub fn width_m(&self) -> f64 {
        self.parallel_lanes().map_or(1.0, |lanes| lanes.count as f64) * self.lane_width_m()
    }

    /// Lateral coordinate of the centre of a lane of `branch`, 0 being the rightmost; `None` on a network \[m\].
    pub fn lane_centre_m(&self, branch: Branch, lane: usize) -> Option<f64> {
        self.parallel_lanes()?;
        let right_m = self.corridor(branch).map_or(-0.5 * self.width_m(), |corridor| corridor.right_m);
        Some(right_m + (lane as f64 + 0.5) * self.lane_width_m())
    }

    /// Lateral coordinate of the centre of the lane of `branch` that is nearest to another one; `None` on a network \[m\].
    pub(crate) fn nearest_lane_m(&self, branch: Branch, across_m: f64) -> Option<f64> {
        let centres = (0..self.parallel_lanes()?.count).filter_map(|lane| self.lane_centre_m(branch, lane));
        centres.min_by(|a, b| (a - across_m).abs().total_cmp(&(b - across_m).abs()))
    }

    /// Lateral coordinate of the middle of `branch` \[m\].
    fn middle_m(&self, branch: Branch) -> f64 {
        let (sin, cos) = libm::sincos(self.heading_rad(branch));
        let [x, y] = [0.0, 0.5 * self.width_m()];
        -sin * x + cos * y
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn straight(road: &Road, branch: Branch) -> Corridor {
        road.corridor(branch).expect("a straight road")
    }

    #[test]
    fn lanes_fill_the_road_from_its_right_edge() {
        let road = Road::Lanes(Lanes { lane_count: 5, lane_width_m: 3.5 });
        let corridor = straight(&road, Branch::Main);
        assert_eq!((corridor.right_m, corridor.left_m), (0.0, 17.5));
        assert_eq!(road.lane_centre_m(Branch::Main, 0), Some(1.75));
        assert_eq!(road.lane_centre_m(Branch::Main, 4), Some(15.75));
    }

    /// At any crossing angle, the point in the middle of one road is in the middle of the other.
    #[test]
    fn centre_lines_of_crossing_roads_meet_at_any_angle() {
        for angle_deg in [90.0, -90.0, 60.0, 120.0, -30.0] {
            let road = Road::Intersection(Intersection { lane_count: 3, angle_deg, ..Intersection::default() });
            let meeting = [0.0, 0.5 * road.width_m()];
            for branch in [Branch::Main, Branch::Cross] {
                let corridor = straight(&road, branch);
                assert!((corridor.across(meeting) - 0.5 * (corridor.right_m + corridor.left_m)).abs() < 1e-12);
                let centre_m = road.lane_centre_m(branch, 1).expect("a lane");
                assert!((corridor.across(meeting) - centre_m).abs() < 1e-12);
                let [from, to] = road.conflict_zone_m(branch).expect("they cross");
                assert!((corridor.along(meeting) - 0.5 * (from + to)).abs() < 1e-12);
                let (sin, cos) = angle_deg.to_radians().sin_cos();
                let length_m = road.width_m() * (1.0 + cos.abs()) / sin.abs();
                assert!((to - from - length_m).abs() < 1e-12, "{angle_deg}: {from} to {to}");
            }
        }
        assert_eq!(Road::default().conflict_zone_m(Branch::Main), None);
    }

    #[test]
    fn the_ending_lane_of_a_ramp_has_no_width_past_its_end() {
        let road = Road::RampMerge(RampMerge::default());
        let edge = |along_m| straight(&road, Branch::Main).right_edge_m(along_m);
        assert!(edge(1.0) < 1e-4 && edge(3.5) > 0.36 && edge(9.0) <= 0.37);
    }
}
