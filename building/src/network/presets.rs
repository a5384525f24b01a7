//! Networks that the dissertation and the benchmarks use.

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

    /// Rooms of the testbed on one floor, called `room 1`, `room 2`, … by rows, each with a wall to its neighbours in the
    /// grid and one to the air outside.
    ///
    /// # Panics
    /// When the grid has no rooms.
    pub fn grid(rows: usize, columns: usize) -> Self {
        Self::tower(1, rows, columns)
    }

    /// Floors of rooms above one another, each a [`Network::grid`]; ceilings conduct like walls. Rooms are numbered floor
    /// by floor from the ground and, if there are several, called `floor 1 room 1`, ….
    ///
    /// # Panics
    /// When there are no rooms.
    pub fn tower(floors: usize, rows: usize, columns: usize) -> Self {
        let name = |floor: usize, row: usize, column: usize| {
            let room = format!("room {}", row * columns + column + 1);
            if floors == 1 { room } else { format!("floor {} {room}", floor + 1) }
        };
        let (mut zones, mut walls) = (Vec::new(), Vec::new());
        for floor in 0..floors {
            for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
                let here = name(floor, row, column);
                zones.push(Zone::named(&here));
                let beside = [(0, 0, 1), (0, 1, 0), (1, 0, 0)].map(|(up, down, right)| {
                    let [floor, row, column] = [floor + up, row + down, column + right];
                    (floor < floors && row < rows && column < columns).then(|| name(floor, row, column))
                });
                walls.extend(beside.into_iter().flatten().map(|there| Wall::new(&here, there, ROOM_TO_ROOM_K_PER_KW)));
                walls.push(Wall::new(&here, AMBIENT, ROOM_TO_AMBIENT_K_PER_KW));
            }
        }
        match Self::new(&zones, &walls) {
            Ok(network) => network,
            Err(error) => panic!("a tower of {floors} floors of {rows} by {columns} rooms: {error}"),
        }
    }
}
