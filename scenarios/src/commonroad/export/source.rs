//! The parts of the imported XML that stay.

use std::collections::BTreeMap;
use std::path::Path;

use super::super::model::{CommonRoad, Obstacle};
use super::super::xml::{Element, Unread, Xml};
use super::base::{Base, VERSION};
use super::goal::GoalPlaces;
use super::xml_text::Ids;
use crate::format::read::source::imported_text;
use crate::model::scenario::Scenario;
use crate::text::error::Fault;

/// Attributes of the outermost element that stay.
const ATTRIBUTES: [&str; 6] = ["timeStepSize", "benchmarkID", "author", "affiliation", "source", "date"];
/// A scenario of version 2018b states neither a place nor tags as elements.
const NO_PLACE: &str =
    "<location><geoNameId>-999</geoNameId><gpsLatitude>999</gpsLatitude><gpsLongitude>999</gpsLongitude></location>";
const NO_TAGS: &str = "<scenarioTags><urban/></scenarioTags>";

/// Reads the parts that stay.
///
/// # Errors
/// For a text that is not a scenario, and for a run with a different time step.
pub(super) fn base(scenario: &Scenario, path: &Path) -> Result<Base, Fault> {
    let name = path.display().to_string();
    let text = imported_text(path)?;
    let xml = Xml::parse(&name, &text)?;
    let root = xml.root();
    let mut source = CommonRoad::read(root, &mut Unread::default())?;
    if (source.step_s - scenario.step_s).abs() > 1e-9 {
        let message = format!(
            "the run has steps of {} s and the scenario of CommonRoad of {} s; leave out `--set step_s`",
            scenario.step_s, source.step_s
        );
        return Err(Fault::at(&root.place(), "its `timeStepSize`", message));
    }
    let begin = super::super::map::begin(&source);
    // The regions of goals are compared with the driven motion, in the coordinates of the run.
    let origin = source.move_near_origin().unwrap_or_default();
    let problem = source.problems.first();
    let mut ids = Ids::taken(root.elements().flat_map(|it| ids_in(it, is_kept(it.name()))));
    let stated = problem.and_then(|problem| problem.element.attribute("id")).and_then(|id| id.parse().ok());
    Ok(Base {
        attributes: attributes(root),
        benchmark: source.benchmark.clone(),
        roads: roads(root),
        problem: problem.map(|problem| format!("  {}\n", problem.element.source())),
        problem_id: stated.unwrap_or_else(|| ids.give(None)),
        goals: GoalPlaces::of(problem.map_or(&[], |problem| &problem.goals), &source.lanelets),
        kinds: kinds(&source.obstacles),
        ids,
        origin,
        begin: begin.round() as i64,
        ..Base::default()
    })
}

/// Whether elements of a name stay; the driven vehicles replace the obstacles.
fn is_kept(name: &str) -> bool {
    ["location", "scenarioTags", "lanelet", "trafficSign", "trafficLight", "intersection"].contains(&name)
}

fn roads(root: Element<'_>) -> String {
    let find =
        |name: &'static str, none: &str| root.child(name).map_or_else(|| none.to_owned(), |it| it.source().to_owned());
    let mut text = format!("  {}\n  {}\n", find("location", NO_PLACE), find("scenarioTags", NO_TAGS));
    let kept = root.elements().filter(|it| is_kept(it.name()));
    for element in kept.filter(|it| !["location", "scenarioTags"].contains(&it.name())) {
        text.push_str("  ");
        text.push_str(element.source());
        text.push('\n');
    }
    text
}

fn attributes(root: Element<'_>) -> Vec<(String, String)> {
    let stated =
        ATTRIBUTES.iter().map(|name| ((*name).to_owned(), root.attribute(name).unwrap_or_default().to_owned()));
    stated.chain([("commonRoadVersion".to_owned(), VERSION.to_owned())]).collect()
}

/// The ids of an element, and of those in it if it stays.
fn ids_in(element: Element<'_>, is_kept: bool) -> Vec<u64> {
    let is_problem = element.name() == "planningProblem";
    let own = element.attribute("id").filter(|_| is_kept || is_problem).and_then(|id| id.parse().ok());
    let within = element.elements().filter(|_| is_kept).flat_map(|it| ids_in(it, true));
    own.into_iter().chain(within).collect()
}

fn kinds(obstacles: &[Obstacle<'_>]) -> BTreeMap<u64, String> {
    obstacles.iter().filter_map(|obstacle| Some((obstacle.id.parse().ok()?, obstacle.kind.clone()))).collect()
}
