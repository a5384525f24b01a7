//! Panels of words, which every layout has.

use super::re_sdk_types::blueprint::archetypes::TextLogColumns;
use super::re_sdk_types::blueprint::datatypes::{TextLogColumn, TextLogColumnKind, TimelineColumn};

use super::blueprint::{LayoutNode, View};
use super::plots;
use super::status;
use super::timelines::{SIM_TIME, TICK};

/// The panel that says what the recording is and what to look for.
pub fn about() -> LayoutNode {
    LayoutNode::View(View::new("TextDocument", "What this is", vec!["/about".to_owned()]))
}

/// The panel that says what each driver wants and does.
pub fn status() -> LayoutNode {
    let contents = vec![format!("/{}", status::STATUS)];
    LayoutNode::View(View::new("TextDocument", "What each driver does now", contents))
}

/// The panel of events in words. The texts begin with their time, which the viewer's own column would cut off.
pub fn events(path: &str) -> LayoutNode {
    log("What happens", path)
}

/// The panel of the optimisers' reasons for finding nothing.
pub fn reasons() -> LayoutNode {
    log("Why optimisers found nothing", plots::REASONS)
}

fn log(title: &str, path: &str) -> LayoutNode {
    let hidden = |timeline: &str| TimelineColumn { visible: false.into(), timeline: timeline.into() };
    let columns = TextLogColumns::new()
        .with_timeline_columns([SIM_TIME, TICK].map(hidden))
        .with_text_log_columns([TextLogColumn { visible: true.into(), kind: TextLogColumnKind::Body }]);
    let view = View::new("TextLog", title, vec![format!("/{path}")]);
    LayoutNode::View(view.with("TextLogColumns", columns))
}
