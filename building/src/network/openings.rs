//! Where the sun comes into a network.

use super::window::Window;
use crate::sun::Plane;

/// The openings through which the sun warms the nodes of a network.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Openings {
    /// Horizontal apertures of each node \[m²\].
    pub horizontal_m2: Vec<f64>,
    /// The planes of all windows, each once.
    pub planes: Vec<Plane>,
    /// Windows: the node, the plane by its index, and the aperture \[m²\].
    pub windows: Vec<(usize, usize, f64)>,
}

impl Openings {
    /// Adds the openings of the next node.
    pub fn push(&mut self, horizontal_m2: f64, windows: &[Window]) {
        let node = self.horizontal_m2.len();
        self.horizontal_m2.push(horizontal_m2);
        for window in windows.iter().filter(|window| window.aperture_m2() > 0.0) {
            let plane = window.plane();
            let known = self.planes.iter().position(|other| *other == plane);
            let index = known.unwrap_or_else(|| {
                self.planes.push(plane);
                self.planes.len() - 1
            });
            self.windows.push((node, index, window.aperture_m2()));
        }
    }

    /// Whether the sun falls on one of the nodes from this one on.
    pub fn any_from(&self, first: usize) -> bool {
        self.horizontal_m2[first..].iter().any(|aperture_m2| *aperture_m2 > 0.0)
            || self.windows.iter().any(|(node, ..)| *node >= first)
    }
}
