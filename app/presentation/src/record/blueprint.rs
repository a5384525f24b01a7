//! A layout of the viewer as a tree of panels, written into a Rerun blueprint.
//!
//! The viewer reads a blueprint as a separate recording, in which every container and view is an entity named by a
//! UUID. The builder in the SDK cannot set bounds or axes of the views used here, so the tree is written directly;
//! and it counts the UUIDs, so that the same layout is the same blueprint.

use super::Logged;
use super::SIM_TIME;
use super::re_sdk_types::blueprint::archetypes::{
    ContainerBlueprint, PanelBlueprint, TimePanelBlueprint, ViewBlueprint, ViewContents, ViewportBlueprint,
};
use super::re_sdk_types::blueprint::components::{
    ActiveTab, ColumnShare, ContainerKind, IncludedContent, LoopMode, PanelState, PlayState, RootContainer, RowShare,
};
use super::re_sdk_types::datatypes::Uuid;
use rerun::external::re_log_types::BlueprintActivationCommand;
use rerun::log::LogMsg;
use rerun::{AsComponents, RecordingStream, RecordingStreamBuilder, RecordingStreamResult};
use xxhash_rust::xxh3::xxh3_128;

/// A node of the tree of panels.
pub enum LayoutNode {
    /// Side by side, with shares of the width.
    Row(Vec<(f32, LayoutNode)>),
    /// One below the other, with shares of the height.
    Column(Vec<(f32, LayoutNode)>),
    /// Tabs with their titles, the first one active. A view on a tab shows its own title.
    Tabs(Vec<(&'static str, LayoutNode)>),
    View(View),
}

pub struct View {
    class: &'static str,
    title: String,
    origin: String,
    contents: Vec<String>,
    properties: Vec<(String, Box<dyn AsComponents>)>,
}

impl View {
    /// A view of one of the viewer's classes (`2D`, `3D`, `TimeSeries`, `TextLog`, `TextDocument`), of the entities that
    /// `contents` matches.
    pub fn new(class: &'static str, title: &str, contents: Vec<String>) -> View {
        View { class, title: title.to_owned(), origin: "/".to_owned(), contents, properties: Vec::new() }
    }

    #[cfg(test)]
    pub fn title(&self) -> &str {
        &self.title
    }

    pub fn without(mut self, entity: &str) -> View {
        self.contents.push(format!("- {entity}"));
        self
    }

    /// The view in the coordinates of an entity.
    pub fn from(mut self, origin: &str) -> View {
        self.origin = origin.to_owned();
        self
    }

    /// The view with a property, by the name of its archetype.
    pub fn with(mut self, property: &str, value: impl AsComponents + 'static) -> View {
        self.properties.push((property.to_owned(), Box::new(value)));
        self
    }

    /// The view with an override for one of its entities.
    pub fn with_override(self, entity: &str, rule: impl AsComponents + 'static) -> View {
        self.with(&format!("ViewContents/overrides/{entity}/visualizers"), rule)
    }
}

/// Sends the layout to the viewer or the file behind `stream`, with its clock in the state `play`. The
/// viewer plays at `speed` times real time.
pub fn send(
    stream: &RecordingStream,
    application: &'static str,
    root: &LayoutNode,
    (play, speed): (PlayState, f64),
) -> Logged {
    let (blueprint, messages) =
        RecordingStreamBuilder::new(application).recording_id("layout").blueprint().enabled(true).memory()?;
    blueprint.set_time_sequence("blueprint", 0);
    blueprint.set_log_time_enabled(false);
    blueprint.set_log_tick_enabled(false);
    let mut writer = Writer { stream: &blueprint, count: 0 };
    let (root, _) = writer.panel(root, "")?;
    blueprint.log(
        "viewport",
        &ViewportBlueprint::new()
            .with_root_container(RootContainer(root))
            .with_auto_layout(false)
            .with_auto_views(false),
    )?;
    blueprint.log("blueprint_panel", &PanelBlueprint::new().with_state(PanelState::Collapsed))?;
    blueprint.log("selection_panel", &PanelBlueprint::new().with_state(PanelState::Collapsed))?;
    blueprint.log(
        "time_panel",
        &TimePanelBlueprint::new()
            .with_state(PanelState::Collapsed)
            .with_timeline(SIM_TIME)
            .with_play_state(play)
            .with_playback_speed(speed)
            .with_loop_mode(LoopMode::All),
    )?;
    let messages = messages.take();
    let named = messages.iter().find_map(|message| match message {
        LogMsg::SetStoreInfo(info) => Some(info.info.store_id.clone()),
        _ => None,
    });
    if let Some(blueprint_id) = named {
        let show = BlueprintActivationCommand { blueprint_id, make_active: true, make_default: true };
        stream.send_blueprint(messages, show);
    }
    Ok(())
}

struct Writer<'a> {
    stream: &'a RecordingStream,
    count: usize,
}

impl Writer<'_> {
    /// Writes a panel and its contents; `title` is that of its tab. Returns its UUID and its path.
    fn panel(&mut self, panel: &LayoutNode, title: &str) -> RecordingStreamResult<(Uuid, String)> {
        self.count += 1;
        let (sort, class) = match panel {
            LayoutNode::View(view) => ("view", view.class),
            LayoutNode::Row(_) => ("container", "row"),
            LayoutNode::Column(_) => ("container", "column"),
            LayoutNode::Tabs(_) => ("container", "tabs"),
        };
        // The viewer keeps state by the UUID of a view, across the layouts of recordings. A UUID must therefore never be that of a
        // view of another class.
        let name = Uuid { bytes: xxh3_128(format!("{class} {}", self.count).as_bytes()).to_be_bytes() };
        let path = format!("{sort}/{name}");
        match panel {
            LayoutNode::View(view) => self.view(&path, view)?,
            LayoutNode::Row(parts) => {
                let row = ContainerBlueprint::new(ContainerKind::Horizontal).with_contents(self.contents(parts)?);
                let row = row.with_col_shares(parts.iter().map(|(share, _)| ColumnShare((*share).into())));
                self.stream.log(path.as_str(), &titled(row, title))?;
            }
            LayoutNode::Column(parts) => {
                let column = ContainerBlueprint::new(ContainerKind::Vertical).with_contents(self.contents(parts)?);
                let column = column.with_row_shares(parts.iter().map(|(share, _)| RowShare((*share).into())));
                self.stream.log(path.as_str(), &titled(column, title))?;
            }
            LayoutNode::Tabs(parts) => {
                let mut contents = Vec::new();
                for (title, part) in parts {
                    contents.push(IncludedContent(self.panel(part, title)?.1.into()));
                }
                let mut tabs = ContainerBlueprint::new(ContainerKind::Tabs).with_contents(contents.clone());
                if let Some(first) = contents.into_iter().next() {
                    tabs = tabs.with_active_tab(ActiveTab(first.0));
                }
                self.stream.log(path.as_str(), &titled(tabs, title))?;
            }
        }
        Ok((name, path))
    }

    fn contents(&mut self, parts: &[(f32, LayoutNode)]) -> RecordingStreamResult<Vec<IncludedContent>> {
        parts.iter().map(|(_, part)| Ok(IncludedContent(self.panel(part, "")?.1.into()))).collect()
    }

    fn view(&self, path: &str, view: &View) -> Logged {
        let contents = ViewContents::new(view.contents.iter().map(String::as_str));
        self.stream.log(format!("{path}/ViewContents"), &contents)?;
        let header = ViewBlueprint::new(view.class);
        let header = header.with_display_name(view.title.as_str()).with_space_origin(view.origin.as_str());
        self.stream.log(path, &header)?;
        for (name, value) in &view.properties {
            self.stream.log(format!("{path}/{name}"), value.as_ref())?;
        }
        Ok(())
    }
}

/// A container with the title of its tab.
fn titled(container: ContainerBlueprint, title: &str) -> ContainerBlueprint {
    if title.is_empty() { container } else { container.with_display_name(title) }
}
