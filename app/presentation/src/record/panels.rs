//! Panels of words, which every layout has.

use super::re_sdk_types::blueprint::archetypes::TextLogColumns;
use super::re_sdk_types::blueprint::datatypes::{TextLogColumn, TextLogColumnKind};

use super::blueprint::{LayoutNode, View};
use super::plots;

/// What the recording is, and what to look for.
pub fn about() -> LayoutNode {
    LayoutNode::View(View::new("TextDocument", "What this is", vec!["/about".to_owned()]))
}

/// What happened, in words.
pub fn events() -> LayoutNode {
    let column = |kind| TextLogColumn { visible: true.into(), kind };
    let columns = [TextLogColumnKind::LogLevel, TextLogColumnKind::Body].map(column);
    let view = View::new("TextLog", "Events", vec![format!("/{}", plots::LOG)]);
    LayoutNode::View(view.with("TextLogColumns", TextLogColumns::new().with_text_log_columns(columns)))
}
