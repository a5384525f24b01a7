//! The size of the road as stated in a file, before the defaults of that size are added and the road is read.

use serde_json::{Map, Value as Json};

use crate::format::json_schema::SchemaNode;
use crate::roads::Road;

/// The road of a scenario as its file states it.
pub(crate) struct StatedRoad<'a> {
    kind: &'a str,
    keys: Option<&'a Map<String, Json>>,
    schema: SchemaNode<'a>,
}

impl<'a> StatedRoad<'a> {
    /// The road of a whole scenario with this schema; parallel lanes if none is stated.
    pub fn read(scenario: &'a Map<String, Json>, schema: SchemaNode<'a>) -> Self {
        let keys = scenario.get("road").and_then(Json::as_object);
        let kind = keys.and_then(|keys| keys.get("kind")?.as_str());
        StatedRoad { kind: kind.unwrap_or(Road::DEFAULT_KIND), keys, schema }
    }

    /// Whether its lanes have names.
    pub fn is_network(&self) -> bool {
        !Road::PARALLEL_KINDS.contains(&self.kind)
    }

    /// The widths of its lanes at their starts; a single one if they are equal \[m\].
    pub fn lane_widths_m(&self) -> impl Iterator<Item = f64> {
        let lanes = self.keys.and_then(|keys| keys.get("lane")?.as_array());
        let of_kind = self.schema.property("road").and_then(|road| road.of_kind(self.kind));
        let default = || of_kind?.property("lane_width_m").and_then(SchemaNode::default);
        let common = self.keys.and_then(|keys| keys.get("lane_width_m")).or_else(default);
        let of_lane = |lane: &'a Json| {
            let width = lane.get("width_m")?;
            width.as_f64().or_else(|| width.get(0)?.get(1)?.as_f64())
        };
        common.and_then(Json::as_f64).into_iter().chain(lanes.into_iter().flatten().filter_map(of_lane))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::registry::Registry;

    /// The values read from the table are those that the road itself returns.
    #[test]
    fn the_table_says_of_every_kind_what_the_road_does() {
        let schema = Registry::standard().complete();
        let kinds = schema.property("road").map(SchemaNode::kinds).unwrap_or_default();
        assert!(kinds.len() > 10, "{kinds:?}");
        for kind in kinds {
            let mut road = serde_json::json!({ "kind": kind });
            if kind == "curve" {
                road["pieces"] = serde_json::json!([{ "straight_m": 3.0 }]);
            }
            if kind == "network" {
                let lane = |name: &str, width: Json| serde_json::json!({ "name": name, "points": [[0.0, 0.0], [9.0, 0.0]], "width_m": width });
                road["lane"] = serde_json::json!([lane("a", 3.0.into()), lane("b", serde_json::json!([[0.0, 3.5]]))]);
            }
            let scenario = serde_json::json!({ "road": road });
            let stated = StatedRoad::read(scenario.as_object().expect("a table"), schema);
            let read: Road = serde_json::from_value(road.clone()).expect("a road");
            assert_eq!(serde_json::to_value(&read).expect("a table")["kind"], kind);
            assert_eq!(stated.is_network(), read.is_network(), "{kind}");
            assert_eq!(stated.lane_widths_m().next(), Some(read.lane_width_m()), "{kind}");
        }
        let none = Map::new();
        let default = StatedRoad::read(&none, schema);
        assert_eq!(
            (default.is_network(), default.lane_widths_m().next()),
            (false, Some(Road::default().lane_width_m()))
        );
    }
}
