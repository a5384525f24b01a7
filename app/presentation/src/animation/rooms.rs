//! The layout of the rooms of a floor plan, with floors beside one another, and the drawing of a room.

use interplay_scenarios::FloorPlan;

use super::canvas::{Align, Canvas};
use super::letters::cut;
use crate::palette::{Colour, one_decimal};

const WALL: Colour = [0x2F, 0x32, 0x36];
const WORDS: Colour = [0xFF, 0xFF, 0xFF];
/// Smallest rooms that have a number, and a name \[px\].
const NUMBERED_PX: f64 = 34.0;
const NAMED_PX: f64 = 90.0;
/// Space around the building and between floors \[px\].
const AROUND_PX: f64 = 30.0;
const BETWEEN_PX: f64 = 18.0;
/// Size of the name of a floor, and its distance above the floor \[px\].
const FLOOR_NAME_PX: f64 = 12.0;
const ABOVE_FLOOR_PX: f64 = 8.0;

pub struct Rooms {
    plan: FloorPlan,
    names: Vec<String>,
    /// Number of floors side by side.
    across: usize,
    /// Upper left corner of the first room, and the side of every room \[px\].
    corner: [f64; 2],
    side: f64,
}

impl Rooms {
    /// Lays out the rooms as large as possible between left, top, right and bottom \[px\].
    pub fn new(plan: FloorPlan, names: Vec<String>, [left, top, right, bottom]: [f64; 4]) -> Rooms {
        let (wide, high) = (right - left - 2.0 * AROUND_PX, bottom - top - 2.0 * AROUND_PX);
        let blocks = |across: usize| [across, plan.floors.div_ceil(across)];
        let side = |across: usize| {
            let [columns, rows] = blocks(across).map(|count| count as f64);
            let space =
                |length: f64, count: f64, rooms: usize| (length - (count - 1.0) * BETWEEN_PX) / (count * rooms as f64);
            space(wide, columns, plan.columns.max(1)).min(space(high, rows, plan.rows.max(1)))
        };
        let across = (1..=plan.floors.max(1)).max_by(|a, b| side(*a).total_cmp(&side(*b))).unwrap_or(1);
        let side = side(across).floor().max(1.0);
        let [columns, rows] = blocks(across).map(|count| count as f64);
        let size = [
            columns * side * plan.columns as f64 + (columns - 1.0) * BETWEEN_PX,
            rows * side * plan.rows as f64 + (rows - 1.0) * BETWEEN_PX,
        ];
        let corner = [0.5 * (left + right - size[0]), 0.5 * (top + bottom - size[1])].map(f64::round);
        Rooms { plan, names, across, corner, side }
    }

    /// Left, top, right and bottom of a room \[px\].
    pub fn place(&self, room: usize) -> [f64; 4] {
        let FloorPlan { columns, rows, .. } = self.plan;
        let (floor, room) = (room / (rows * columns).max(1), room % (rows * columns).max(1));
        let along = |block: usize, rooms: usize, room: usize| {
            block as f64 * (rooms as f64 * self.side + BETWEEN_PX) + room as f64 * self.side
        };
        let left = self.corner[0] + along(floor % self.across, columns, room % columns);
        let top = self.corner[1] + along(floor / self.across, rows, room / columns);
        [left, top, left + self.side, top + self.side]
    }

    /// Draws the names of the floors above them, where there are several.
    pub fn draw_floor_names(&self, canvas: &mut Canvas, ink: Colour) {
        let FloorPlan { columns, rows, floors } = self.plan;
        for floor in 0..if floors > 1 { floors } else { 0 } {
            let [left, top, ..] = self.place(floor * rows * columns);
            let middle = [left + 0.5 * self.side * columns as f64, top - ABOVE_FLOOR_PX];
            let words = format!("floor {}", floor + 1);
            let wide = self.side * columns as f64 + BETWEEN_PX;
            canvas.text(middle, Align::Middle, FLOOR_NAME_PX, &cut(&words, FLOOR_NAME_PX, wide), ink);
        }
    }

    /// Draws a room with its name, temperature and heat \[kW\], as far as there is space.
    pub fn draw(&self, canvas: &mut Canvas, room: usize, colour: Colour, temperature_c: f64, heat_kw: f64) {
        let [left, top, right, bottom] = self.place(room);
        let ring = [[left, top], [right, top], [right, bottom], [left, bottom]];
        canvas.fill(&ring, colour);
        canvas.outline(&ring, if self.side > NUMBERED_PX { 3.0 } else { 1.0 }, WALL);
        let middle = [0.5 * (left + right), 0.5 * (top + bottom)];
        if self.side < NUMBERED_PX {
            return;
        }
        if self.side < NAMED_PX {
            canvas.text(middle, Align::Middle, 12.0, &one_decimal(temperature_c), WORDS);
            return;
        }
        let name = cut(&self.names[room], 14.0, self.side - 10.0);
        canvas.text([middle[0], middle[1] - 24.0], Align::Middle, 14.0, &name, WORDS);
        canvas.text(middle, Align::Middle, 20.0, &format!("{} °C", one_decimal(temperature_c)), WORDS);
        let does = if heat_kw < 0.0 { "cools" } else { "heats" };
        let words = if heat_kw.abs() < 0.005 { "off".to_owned() } else { format!("{does} {:.2} kW", heat_kw.abs()) };
        canvas.text([middle[0], middle[1] + 24.0], Align::Middle, 13.0, &words, WORDS);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rooms_of_a_floor_plan_lie_inside_it_and_never_overlap() {
        for (columns, rows, floors) in [(2, 2, 1), (5, 5, 4), (3, 1, 7), (10, 10, 1)] {
            let plan = FloorPlan { columns, rows, floors };
            let count = columns * rows * floors;
            let rooms = Rooms::new(plan, vec!["room".to_owned(); count], [10.0, 20.0, 380.0, 370.0]);
            let places: Vec<[f64; 4]> = (0..count).map(|room| rooms.place(room)).collect();
            for (index, [l, t, r, b]) in places.iter().enumerate() {
                assert!(*l >= 10.0 && *t >= 20.0 && *r <= 380.0 && *b <= 370.0, "{plan:?}");
                let overlaps = |[x, y, right, bottom]: &[f64; 4]| l < right && x < r && t < bottom && y < b;
                assert!(!places[..index].iter().any(overlaps), "{plan:?}: room {index}");
            }
        }
    }
}
