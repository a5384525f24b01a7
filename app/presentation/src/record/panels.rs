//! Panels of words, which every layout has.

use super::re_sdk_types::blueprint::archetypes::TextLogColumns;
use super::re_sdk_types::blueprint::datatypes::{TextLogColumn, TextLogColumnKind};

use super::blueprint::{Panel, View};
use super::plots;

/// What the recording is, and what to look for.
pub fn about() -> Panel {
    Panel::View(View::new("TextDocument", "What this is", vec!["/about".to_owned()]))
}

/// What happened, in words.
pub fn events() -> Panel {
    let column = |kind| TextLogColumn { visible: true.into(), kind };
    let columns = [TextLogColumnKind::LogLevel, TextLogColumnKind::Body].map(column);
    let view = View::new("TextLog", "Events", vec![format!("/{}", plots::LOG)]);
    Panel::View(view.with("TextLogColumns", TextLogColumns::new().with_text_log_columns(columns)))
}
