//! The check of detectors: whether their lanes and the detectors before them exist.

use super::checker::Checker;
use crate::model::traffic::lane_reference::LaneReference;
use crate::text::error::quoted;

/// A lane as its file names it.
fn lane_words(lane: &LaneReference) -> String {
    match lane {
        LaneReference::Number(number) => number.to_string(),
        LaneReference::Name(name) => quoted(name),
    }
}

impl Checker<'_> {
    pub(super) fn detectors(&mut self) {
        let detectors = &self.scenario.detectors;
        for (index, detector) in detectors.iter().enumerate() {
            let key = |key: &str| format!("detector.{index}.{key}");
            let name = quoted(&detector.name);
            if detectors[..index].iter().any(|other| other.name == detector.name) {
                self.refuse(
                    &key("name"),
                    "a second one",
                    format!("there are two detectors {name}"),
                    "name one otherwise",
                );
            }
            if let Some((at, lane)) =
                detector.lanes.iter().enumerate().find(|(at, lane)| detector.lanes[..*at].contains(lane))
            {
                let message = format!("detector {name} lists lane {lane} twice", lane = lane_words(lane));
                self.refuse(
                    &key(&format!("lanes.{at}")),
                    "the second",
                    message,
                    "list each lane once: it counts its vehicles once",
                );
            }
            let is_missing = |lane| self.scenario.detector_line(lane, detector.along_m).is_none();
            if detector.lanes.iter().any(is_missing) {
                let message =
                    format!("a lane of detector {name} is not there, or does not reach {} m", detector.along_m);
                self.refuse(
                    &key("lanes"),
                    "no such place",
                    message,
                    "name lanes of the road, and a place on all of them",
                );
            }
            if let Some(after) = &detector.after
                && !detectors.iter().any(|other| other.name == *after && other.name != detector.name)
            {
                let message = format!("there is no other detector {} before {name}", quoted(after));
                self.refuse(&key("after"), "no such detector", message, "name another `[[detector]]`");
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::from_text;

    #[test]
    fn a_lane_that_a_detector_lists_twice_is_refused() {
        let text = "title = 'a'\nshows = 'a'\nroad = { kind = 'lanes', lane_count = 2, lane_width_m = 3.5 }\n[defaults]\nclass = 'car'\n\
                    [[vehicle]]\nname = 'ego'\nstart = { lane = 0, along_m = 0.0, speed_mps = 10.0 }\n\
                    [[detector]]\nname = 'exit'\nlanes = [0, 1, 0]\nalong_m = 50.0\n";
        let error = from_text("a.toml", text, &[]).map(|_| ()).expect_err("refused");
        assert_eq!(error.faults()[0].message(), "detector `exit` lists lane 0 twice");
        assert!(from_text("a.toml", &text.replace("1, 0]", "1]"), &[]).is_ok());
    }
}
