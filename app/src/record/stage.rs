//! What stands still: the road, and the text that says what one is looking at.

use super::re_sdk_types::archetypes::{LineStrips2D, TextDocument, Transform3D};
use super::re_sdk_types::components::{MediaType, Radius};
use interplay_scenarios::{Scenario, Vehicle};
use rerun::{RecordingStream, RecordingStreamResult};

use super::building;
use super::palette::{ASPHALT, MARKING, Paint};

/// Length of a lane marking and of the space behind it, in lane widths.
const DASH_LANES: f64 = 0.8;

/// Logs the road between two longitudinal coordinates \[m\].
///
/// # Errors
/// If Rerun refuses a component.
pub fn road(stream: &RecordingStream, scenario: &Scenario, [from_m, to_m]: [f64; 2]) -> RecordingStreamResult<()> {
    let (width, lane, lanes) = (scenario.road.width_m(), scenario.road.lane_width_m(), scenario.road.lane_count());
    // The viewer's y axis points down; the road's points to the left of who drives along it.
    stream.log_static("world", &Transform3D::from_scale([1.0, -1.0, 1.0]))?;
    let heading = scenario.road.heading_rad();
    stream.log_static("world/road", &Transform3D::from_mat3x3(turn(heading)))?;
    let along = |lateral: f64, from: f64, to: f64| [[from as f32, lateral as f32], [to as f32, lateral as f32]];
    stream.log_static(
        "world/road/surface",
        &LineStrips2D::new([along(0.5 * width, from_m, to_m)])
            .with_radii([Radius::new_scene_units(0.5 * width as f32)])
            .with_colors([ASPHALT.solid()])
            .with_draw_order(-3.0),
    )?;
    stream.log_static(
        "world/road/edges",
        &LineStrips2D::new([along(0.0, from_m, to_m), along(width, from_m, to_m)])
            .with_radii([Radius::new_ui_points(1.2)])
            .with_colors([MARKING.solid()])
            .with_draw_order(-2.0),
    )?;
    let period = 2.0 * DASH_LANES * lane;
    let dashes = ((to_m - from_m) / period).ceil() as usize;
    let marking = |between: usize| {
        (0..dashes).map(move |dash| {
            let start = from_m + dash as f64 * period;
            along(between as f64 * lane, start, start + 0.5 * period)
        })
    };
    stream.log_static(
        "world/road/markings",
        &LineStrips2D::new((1..lanes).flat_map(marking))
            .with_radii([Radius::new_ui_points(0.8)])
            .with_colors([MARKING.solid()])
            .with_draw_order(-2.0),
    )
}

/// Columns of the matrix that turns by an angle about z.
pub fn turn(angle_rad: f64) -> [[f32; 3]; 3] {
    let (sin, cos) = (angle_rad.sin() as f32, angle_rad.cos() as f32);
    [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]
}

/// Logs the text beside the pictures.
///
/// # Errors
/// If Rerun refuses a component.
pub fn about(
    stream: &RecordingStream,
    scenario: &Scenario,
    paints: &[Paint],
    command: Option<&str>,
) -> RecordingStreamResult<()> {
    let driving = (!scenario.vehicles.is_empty()).then(|| description(scenario, paints, command));
    let command = command.filter(|_| driving.is_none());
    let building = scenario.building.is_some().then(|| building::about(scenario, command));
    let text = driving.into_iter().chain(building).collect::<Vec<_>>().join("\n\n");
    stream.log_static("about", &TextDocument::new(text).with_media_type(MediaType::MARKDOWN))
}

fn description(scenario: &Scenario, paints: &[Paint], command: Option<&str>) -> String {
    let again = command.map(|command| format!(" Again: {}", code(command))).unwrap_or_default();
    let figure = scenario.figure.as_ref().map(|figure| format!(" (figure {figure})")).unwrap_or_default();
    let who: String =
        scenario.vehicles.iter().zip(paints).map(|(vehicle, paint)| row(scenario, vehicle, *paint)).collect();
    format!(
        "### {title}\n\n{shows}{figure}.{again}\n\n\
         | vehicle | colour | driver | wants |\n|---|---|---|---|\n{who}\n\
         In a vehicle's colour: pale behind it, the path it drove; solid ahead, its plan; dashed, what others expect \
         of it; dotted, what it asks another to do. Ellipses: where the ego's centre keeps out. A plan in {failure} \
         is a fallback, because the planner failed.\n",
        title = scenario.title,
        shows = scenario.shows.trim_end_matches('.'),
        failure = super::palette::FAILURE.word,
    )
}

/// A text to be shown as it is: between more backticks than it has in a row.
pub fn code(text: &str) -> String {
    let most = text.split(|character| character != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(most + 1);
    if most == 0 { format!("{fence}{text}{fence}") } else { format!("{fence} {text} {fence}") }
}

fn row(scenario: &Scenario, vehicle: &Vehicle, paint: Paint) -> String {
    let target = vehicle.target(&scenario.road);
    let wish = match vehicle.goal.lane {
        Some(lane) => format!("lane {lane} at {:.2} m/s", target.speed_mps),
        None => format!("{:.2} m/s", target.speed_mps),
    };
    format!("| **{}** | {} | {} | {wish} |\n", vehicle.name, paint.word, vehicle.driver.kind())
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::super::palette::paints;
    use super::{code, description};

    #[test]
    fn the_text_says_how_to_repeat_the_run() {
        let scenario = load("lane-change/front-nice", &[]).expect("embedded");
        let text = |command| description(&scenario, &paints(&scenario), command);
        assert!(text(Some("interplay run a --seed 2")).contains("(figure 6.1). Again: `interplay run a --seed 2`\n"));
        assert!(!text(None).contains("Again"));
    }

    #[test]
    fn backticks_in_a_command_do_not_end_it() {
        assert_eq!(code("interplay run a"), "`interplay run a`");
        assert_eq!(code("--set 'title=`a` ``b``'"), "``` --set 'title=`a` ``b``' ```");
    }
}
