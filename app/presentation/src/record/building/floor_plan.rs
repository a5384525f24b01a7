//! The floor plan: rooms coloured by temperature, floors side by side, and the air outside around them.

use interplay_scenarios::FloorPlan;
use interplay_simulation::frame::{BuildingFrame, ZoneFrame};
use rerun::{RecordingStream, RecordingStreamResult};

use super::super::Logged;
use super::super::palette::NEUTRAL;
use super::super::re_sdk_types::archetypes::{Image, Points2D};
use super::super::re_sdk_types::components::Radius;
use crate::palette::{deviation_colour, middle_c, one_decimal, zone_colour};

/// Width of a room, from wall to wall.
const ROOM_PX: usize = 24;
const WALL_PX: usize = 1;
/// Width of the strip around the building that stands for the outdoor air, of one floor and of several, which have names.
const OUTDOORS_PX: [usize; 2] = [10, 44];
const BETWEEN_FLOORS_PX: usize = 40;
/// Labels of more rooms than this have no space for names.
const MAX_NAMED_ROOMS: usize = 16;
/// More rooms than this have no space for labels.
const MAX_LABELLED_ROOMS: usize = 144;

/// The floor plan of a building in a recording.
pub struct FloorPlanLayer {
    rooms: FloorPlan,
    /// The usual wanted temperature of each zone, the middle of the colour scale while none is wanted \[°C\].
    middles_c: Vec<f64>,
}

impl FloorPlanLayer {
    /// Logs the static style of the labels.
    pub fn begin(
        stream: &RecordingStream,
        rooms: FloorPlan,
        middles_c: Vec<f64>,
    ) -> RecordingStreamResult<FloorPlanLayer> {
        let style = Points2D::update_fields()
            .with_colors([NEUTRAL.solid()])
            .with_radii([Radius::new_ui_points(0.0)])
            .with_draw_order(1.0);
        stream.log_static("building/plan/labels", &style)?;
        Ok(FloorPlanLayer { rooms, middles_c })
    }

    pub fn step(&self, stream: &RecordingStream, names: &[String], frame: &BuildingFrame) -> Logged {
        let [width, height] = self.size();
        let pixels = self.pixels(frame, [width, height]);
        stream.log("building/plan/rooms", &Image::from_rgb24(pixels, [width as u32, height as u32]))?;
        let few = names.len() <= MAX_NAMED_ROOMS;
        let words = |(name, zone): (&String, &ZoneFrame)| match zone.reference_c {
            Some(wanted_c) if few => {
                format!("{name}\n{} °C\nwanted {}", one_decimal(zone.temperature_c), one_decimal(wanted_c))
            }
            None if few => format!("{name}\n{} °C", one_decimal(zone.temperature_c)),
            _ => one_decimal(zone.temperature_c),
        };
        let outdoors = format!("outdoors {} °C", one_decimal(frame.ambient_c));
        let labelled = if names.len() <= MAX_LABELLED_ROOMS { names.len() } else { 0 };
        let labels =
            names.iter().zip(&frame.zones).take(labelled).map(words).chain([outdoors]).chain(self.floor_names());
        // The viewer writes labels below their positions. With several floors, the names of the floors are above them.
        let outdoors_y = if self.rooms.floors > 1 { height as f32 - 40.0 } else { 0.0 };
        let centre = |index: usize| {
            let [left, top] = self.corner(index);
            [(left + ROOM_PX / 2) as f32, (top + ROOM_PX / 4) as f32]
        };
        let places = (0..labelled).map(centre).chain([[0.5 * width as f32, outdoors_y]]).chain(self.floor_places());
        let labels = Points2D::update_fields().with_positions(places).with_labels(labels).with_show_labels(true);
        stream.log("building/plan/labels", &labels)
    }

    fn outdoors_px(&self) -> usize {
        OUTDOORS_PX[usize::from(self.rooms.floors > 1)]
    }

    /// The names of the floors, if there are several.
    fn floor_names(&self) -> impl Iterator<Item = String> {
        let floors = if self.rooms.floors > 1 { self.rooms.floors } else { 0 };
        (1..=floors).map(|floor| format!("floor {floor}"))
    }

    /// The places of the names, above each floor.
    fn floor_places(&self) -> impl Iterator<Item = [f32; 2]> {
        let FloorPlan { columns, rows, floors } = self.rooms;
        let place = move |floor: usize| {
            let [left, top] = self.corner(floor * rows * columns);
            let wide = columns * (ROOM_PX + WALL_PX);
            [left as f32 + 0.5 * wide as f32, top as f32 - BETWEEN_FLOORS_PX as f32]
        };
        (0..if floors > 1 { floors } else { 0 }).map(place)
    }

    /// Number of floors side by side, such that the picture is about square.
    fn across(&self) -> usize {
        let FloorPlan { columns, rows, floors } = self.rooms;
        let square = (floors as f64 * rows as f64 / columns.max(1) as f64).sqrt();
        (square.round() as usize).clamp(1, floors.max(1))
    }

    /// Width and height of the picture \[pixels\].
    pub fn size(&self) -> [usize; 2] {
        let FloorPlan { columns, rows, floors } = self.rooms;
        let along = |blocks: usize, rooms: usize| {
            2 * self.outdoors_px() + blocks * (rooms * (ROOM_PX + WALL_PX) - WALL_PX) + (blocks - 1) * BETWEEN_FLOORS_PX
        };
        [along(self.across(), columns), along(floors.div_ceil(self.across()), rows)]
    }

    /// The upper left corner of a room.
    fn corner(&self, index: usize) -> [usize; 2] {
        let FloorPlan { columns, rows, .. } = self.rooms;
        let (floor, room) = (index / (rows * columns), index % (rows * columns));
        let along = |block: usize, rooms: usize, room: usize| {
            self.outdoors_px()
                + block * (rooms * (ROOM_PX + WALL_PX) - WALL_PX + BETWEEN_FLOORS_PX)
                + room * (ROOM_PX + WALL_PX)
        };
        [along(floor % self.across(), columns, room % columns), along(floor / self.across(), rows, room / columns)]
    }

    /// Red, green and blue of every picture element, row by row.
    fn pixels(&self, frame: &BuildingFrame, [width, height]: [usize; 2]) -> Vec<u8> {
        let middle_c = middle_c(&self.middles_c);
        let outdoors = deviation_colour(frame.ambient_c - middle_c).map(|part| part / 2);
        let mut pixels: Vec<u8> = std::iter::repeat_n(outdoors, width * height).flatten().collect();
        for (index, zone) in frame.zones.iter().enumerate() {
            let [left, top] = self.corner(index);
            let usual_c = self.middles_c.get(index).copied().unwrap_or(middle_c);
            let colour = zone_colour(zone, zone.temperature_c, usual_c);
            for row in top..top + ROOM_PX {
                let first = 3 * (row * width + left);
                pixels[first..first + 3 * ROOM_PX].chunks_exact_mut(3).for_each(|pixel| pixel.copy_from_slice(&colour));
            }
        }
        pixels
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rooms_have_the_colours_of_their_temperatures() {
        let plan = FloorPlanLayer { rooms: FloorPlan { columns: 2, rows: 2, floors: 1 }, middles_c: vec![25.0; 4] };
        let zone = |temperature_c| ZoneFrame { temperature_c, ..ZoneFrame::default() };
        let zones: Vec<ZoneFrame> = [20.0, 25.0, 30.0].map(zone).to_vec();
        let frame = BuildingFrame { zones, ambient_c: 25.0, forecast_c: 25.0, ..BuildingFrame::default() };
        let [width, height] = plan.size();
        assert_eq!(
            [width, height],
            [2 * OUTDOORS_PX[0] + 2 * ROOM_PX + WALL_PX; 2],
            "two columns, the second row half empty"
        );
        let pixels = plan.pixels(&frame, [width, height]);
        assert_eq!(pixels.len(), 3 * width * height);
        let at = |x: usize, y: usize| [0, 1, 2].map(|part| pixels[3 * (y * width + x) + part]);
        let (first, second) = (OUTDOORS_PX[0] + 3, OUTDOORS_PX[0] + ROOM_PX + WALL_PX + 3);
        assert_eq!(at(first, first), [30, 90, 190], "cold");
        assert_eq!(at(second, first), [95, 100, 95], "at the wanted temperature");
        assert_eq!(at(first, second), [200, 60, 20], "warm");
        assert_eq!(at(second, second), at(0, 0), "no room");
    }

    #[test]
    fn floors_lie_side_by_side_and_never_overlap() {
        let plan = FloorPlanLayer { rooms: FloorPlan { columns: 5, rows: 5, floors: 16 }, middles_c: Vec::new() };
        assert_eq!(plan.across(), 4);
        let [width, height] = plan.size();
        assert_eq!(width, height);
        let mut covered = vec![0; width * height];
        for index in 0..400 {
            let [left, top] = plan.corner(index);
            for (x, y) in (0..ROOM_PX).flat_map(|x| (0..ROOM_PX).map(move |y| (x, y))) {
                covered[(top + y) * width + left + x] += 1;
            }
        }
        assert_eq!(covered.iter().sum::<i32>(), (400 * ROOM_PX * ROOM_PX) as i32);
        assert_eq!(covered.iter().max(), Some(&1));
        assert_eq!(plan.corner(399), [width - OUTDOORS_PX[1] - ROOM_PX; 2]);
    }
}
