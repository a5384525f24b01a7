//! A scenario of CommonRoad as plain values, one file per concept; the documentation of CommonRoad describes the format, versions 2018b and
//! 2020a.

mod geometry;
mod lanelet;
mod obstacle;
mod sign;

#[cfg(test)]
pub(super) use geometry::Rectangle;
pub(super) use geometry::Region;
pub(super) use lanelet::{Adjacent, Intersection, Lanelet};
pub(super) use obstacle::{Goal, Obstacle, PlanningProblem, Role};
pub(super) use sign::{Light, Sign, SignMeaning};

use super::xml::{Element, Unread};
use crate::text::error::{Fault, quoted};

/// The name of the outermost element.
pub(super) const ROOT: &str = "commonRoad";
/// The versions of the format that are read.
const VERSIONS: [&str; 2] = ["2018b", "2020a"];
/// The shortest and the longest step of time \[s\].
const STEPS_S: [f64; 2] = [0.001, 10.0];

pub(super) struct CommonRoad<'a> {
    /// Its name among the benchmarks.
    pub benchmark: String,
    /// Length of a step of time \[s\].
    pub step_s: f64,
    pub lanelets: Vec<Lanelet<'a>>,
    pub signs: Vec<Sign>,
    pub lights: Vec<Light>,
    pub intersections: Vec<Intersection>,
    pub obstacles: Vec<Obstacle<'a>>,
    pub problems: Vec<PlanningProblem<'a>>,
}

impl<'a> CommonRoad<'a> {
    /// Reads a scenario.
    ///
    /// # Errors
    /// If it is not a scenario of a known version.
    pub(super) fn read(root: Element<'a>, unread: &mut Unread) -> Result<CommonRoad<'a>, Fault> {
        if root.name() != ROOT {
            let message = format!("the outermost element is {}, not `{ROOT}`", quoted(root.name()));
            return Err(root.fault("no scenario of CommonRoad", message));
        }
        let version = root.required_attribute("commonRoadVersion")?;
        if !VERSIONS.contains(&version) {
            let message = format!("version {} of CommonRoad is not read", quoted(version));
            return Err(root.fault("another version", message).help(format!("{} are", VERSIONS.join(" and "))));
        }
        let step_s = root.as_number(root.required_attribute("timeStepSize")?)?;
        if !(STEPS_S[0]..=STEPS_S[1]).contains(&step_s) {
            let message = format!("`timeStepSize` is {step_s}; it must be from {} to {} s", STEPS_S[0], STEPS_S[1]);
            return Err(root.fault("no step of time", message));
        }
        // The location and the author of a scenario do not affect the motion.
        let mut scenario = CommonRoad {
            benchmark: root.attribute("benchmarkID").unwrap_or_default().to_owned(),
            step_s,
            lanelets: Vec::new(),
            signs: Vec::new(),
            lights: Vec::new(),
            intersections: Vec::new(),
            obstacles: Vec::new(),
            problems: Vec::new(),
        };
        for element in root.elements() {
            match element.name() {
                "lanelet" => scenario.lanelets.push(Lanelet::read(element, unread)?),
                "trafficSign" => scenario.signs.push(Sign::read(element)?),
                "trafficLight" => scenario.lights.push(Light::read(element, unread)?),
                "intersection" => scenario.intersections.push(Intersection::read(element, unread)?),
                name if Obstacle::is_read_from(name) => scenario.obstacles.push(Obstacle::read(element, unread)?),
                "planningProblem" => scenario.problems.push(PlanningProblem::read(element, unread)?),
                _ => {}
            }
        }
        unread.count_beyond(root, &READ);
        Ok(scenario)
    }
}

/// The elements of a scenario that are read or do not affect the motion.
const READ: [&str; 12] = [
    "location",
    "scenarioTags",
    "lanelet",
    "trafficSign",
    "trafficLight",
    "intersection",
    "obstacle",
    "staticObstacle",
    "dynamicObstacle",
    "environmentObstacle",
    "phantomObstacle",
    "planningProblem",
];
