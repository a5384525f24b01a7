//! Intersections: groups of lanelets that lead into one place.

use super::super::xml::{Element, Unread};
use crate::text::error::Fault;

/// An intersection.
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
