//! Networks that the source and the benchmarks use.

use super::{AMBIENT, Network, Wall, Zone};

/// Resistance between adjacent rooms of the testbed \[K/kW\]: 1.0417 K·min/kJ in Table 2.1, whose printed unit is wrong.
const ROOM_TO_ROOM_K_PER_KW: f64 = 62.5;
/// Resistance from a room to the air outside \[K/kW\]: 0.5208 K·min/kJ in Table 2.1.
const ROOM_TO_AMBIENT_K_PER_KW: f64 = 31.25;

impl Network {
    /// The four-room testbed of section 2.4: rooms 1 and 2 over 3 and 4, each 1000 kJ/K, ±2 kW, 62.5 K/kW to each of two
    /// neighbours and 31.25 K/kW to the air outside. The resistances R₁₄ and R₂₃ of Table 2.1 (10000) stand for no wall.
    pub fn testbed() -> Self {
        Self::grid(2, 2)
    }

    /// Rooms of the testbed, called `room 1`, `room 2`, … by rows, each with a wall to its neighbours in the grid and one
    /// to the air outside.
    ///
    /// # Panics
    /// When the grid has no rooms.
    pub fn grid(rows: usize, columns: usize) -> Self {
        let name = |row: usize, column: usize| format!("room {}", row * columns + column + 1);
        let places = || (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        let zones: Vec<Zone> = places().map(|(row, column)| Zone::named(name(row, column))).collect();
        let mut walls = Vec::new();
        for (row, column) in places() {
            if column + 1 < columns {
                walls.push(Wall::new(name(row, column), name(row, column + 1), ROOM_TO_ROOM_K_PER_KW));
            }
            if row + 1 < rows {
                walls.push(Wall::new(name(row, column), name(row + 1, column), ROOM_TO_ROOM_K_PER_KW));
            }
            walls.push(Wall::new(name(row, column), AMBIENT, ROOM_TO_AMBIENT_K_PER_KW));
        }
        match Self::new(&zones, &walls) {
            Ok(network) => network,
            Err(error) => panic!("a grid of {rows} by {columns} rooms: {error}"),
        }
    }
}
