//! Lanelets: a left and a right bound, and references to other lanelets.

use super::super::xml::{Element, Unread};
use super::geometry::points;
use crate::text::error::Fault;

pub(crate) struct Lanelet<'a> {
    pub id: String,
    pub element: Element<'a>,
    /// The points of the left bound, in the direction of driving \[m\].
    pub left: Vec<[f64; 2]>,
    /// The points of the right bound \[m\].
    pub right: Vec<[f64; 2]>,
    pub predecessors: Vec<String>,
    pub successors: Vec<String>,
    /// The lanelets on the left and on the right.
    pub beside: [Option<Adjacent>; 2],
    /// Whether the left and the right bound are lines that must not be crossed.
    pub is_solid: [bool; 2],
    /// Its types, such as `urban` or `crosswalk`; several are allowed.
    pub types: Vec<String>,
    /// The road users that may use it; all if none are stated.
    pub users: Vec<String>,
    /// Whether it may also be driven against its direction.
    pub is_two_way: bool,
    /// The speed limit of version 2018b \[m/s\].
    pub speed_limit_mps: Option<f64>,
    /// The signs that hold on it, by their ids.
    pub signs: Vec<String>,
    /// The traffic lights at its end, by their ids.
    pub lights: Vec<String>,
    pub has_stop_line: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Adjacent {
    pub id: String,
    /// Whether it is driven in the opposite direction.
    pub is_oncoming: bool,
}

impl<'a> Lanelet<'a> {
    const READ: [&'static str; 14] = [
        "leftBound",
        "rightBound",
        "predecessor",
        "successor",
        "adjacentLeft",
        "adjacentRight",
        "stopLine",
        "laneletType",
        "userOneWay",
        "userBidirectional",
        "speedLimit",
        "trafficSignRef",
        "trafficLightRef",
        "centerLine",
    ];

    pub(super) fn read(element: Element<'a>, unread: &mut Unread) -> Result<Lanelet<'a>, Fault> {
        let [left, right] = [element.required("leftBound")?, element.required("rightBound")?];
        let refs = |name: &'static str| -> Result<Vec<String>, Fault> {
            element.children(name).map(|other| Ok(other.required_attribute("ref")?.to_owned())).collect()
        };
        let texts = |name: &'static str| element.children(name).map(|stated| stated.text().to_owned());
        let two_way: Vec<String> = texts("userBidirectional").collect();
        let of_line = element.child("stopLine").into_iter().flat_map(|line| line.children("trafficSignRef"));
        let of_line: Vec<String> =
            of_line.map(|sign| Ok(sign.required_attribute("ref")?.to_owned())).collect::<Result<_, Fault>>()?;
        unread.count_beyond(element, &Lanelet::READ);
        Ok(Lanelet {
            id: element.required_attribute("id")?.to_owned(),
            element,
            left: bound(left)?,
            right: bound(right)?,
            predecessors: refs("predecessor")?,
            successors: refs("successor")?,
            beside: [adjacent(element, "adjacentLeft")?, adjacent(element, "adjacentRight")?],
            is_solid: [left, right].map(is_solid),
            types: texts("laneletType").collect(),
            is_two_way: two_way.iter().any(|user| user != "pedestrian" && user != "bicycle"),
            users: texts("userOneWay").chain(two_way).collect(),
            speed_limit_mps: element.child("speedLimit").map(|limit| limit.number()).transpose()?,
            signs: [refs("trafficSignRef")?, of_line].concat(),
            lights: refs("trafficLightRef")?,
            has_stop_line: element.child("stopLine").is_some(),
        })
    }

    /// Whether only people on foot use it.
    pub(crate) fn is_for_walkers(&self) -> bool {
        let of_walkers = |word: &String| ["crosswalk", "sidewalk"].contains(&word.as_str());
        let walks = |user: &String| user == "pedestrian";
        self.types.iter().any(of_walkers) || (!self.users.is_empty() && self.users.iter().all(walks))
    }

    /// Whether it is a crossing for people on foot.
    pub(crate) fn is_crosswalk(&self) -> bool {
        self.types.iter().any(|word| word == "crosswalk")
    }

    /// Whether it is reserved for some vehicles, such as buses.
    pub(crate) fn is_reserved(&self) -> bool {
        self.types.iter().any(|word| ["busLane", "bicycleLane"].contains(&word.as_str()))
    }
}

fn bound(element: Element<'_>) -> Result<Vec<[f64; 2]>, Fault> {
    let found = points(element)?;
    if found.len() >= 2 {
        return Ok(found);
    }
    let message = format!("`{}` has {} points; a line needs two", element.name(), found.len());
    Err(element.fault("no line", message))
}

fn is_solid(bound: Element<'_>) -> bool {
    bound.child("lineMarking").is_some_and(|marking| matches!(marking.text(), "solid" | "broad_solid"))
}

fn adjacent(element: Element<'_>, name: &'static str) -> Result<Option<Adjacent>, Fault> {
    let Some(other) = element.child(name) else { return Ok(None) };
    let id = other.required_attribute("ref")?.to_owned();
    Ok(Some(Adjacent { id, is_oncoming: other.attribute("drivingDir") == Some("opposite") }))
}

pub(crate) struct Intersection {
    /// The lanelets of each approach, by their ids.
    pub incoming: Vec<Vec<String>>,
}

impl Intersection {
    pub(super) fn read(element: Element<'_>, unread: &mut Unread) -> Result<Intersection, Fault> {
        let mut incoming = Vec::new();
        for approach in element.children("incoming") {
            let lanelets = approach.children("incomingLanelet");
            incoming
                .push(lanelets.map(|it| Ok(it.required_attribute("ref")?.to_owned())).collect::<Result<_, Fault>>()?);
        }
        unread.count_beyond(element, &["incoming"]);
        Ok(Intersection { incoming })
    }
}
