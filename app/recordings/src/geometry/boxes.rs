//! Bodies of vehicles as rectangles.

use interplay_planners::plan::certificate::overlap_m;

/// A rectangle in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Box2 {
    /// Its centre \[m\].
    pub middle: [f64; 2],
    /// The direction of its length \[rad\].
    pub heading_rad: f64,
    /// Half its length and half its width \[m\].
    pub half_m: [f64; 2],
}

impl Box2 {
    /// Whether two rectangles overlap.
    pub(crate) fn overlaps(&self, other: &Box2) -> bool {
        overlap_m(&self.corners(), &other.corners()) > 0.0
    }

    /// Front right, front left, rear right, rear left \[m\].
    fn corners(&self) -> [[f64; 2]; 4] {
        let (sin, cos) = libm::sincos(self.heading_rad);
        let [x, y] = self.middle;
        let [length_m, width_m] = self.half_m;
        [[1.0, -1.0], [1.0, 1.0], [-1.0, -1.0], [-1.0, 1.0]].map(|[ahead, left]| {
            let [ahead_m, left_m] = [ahead * length_m, left * width_m];
            [x + ahead_m * cos - left_m * sin, y + ahead_m * sin + left_m * cos]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_overlap_unless_a_side_separates_them() {
        let at = |x_m: f64, y_m: f64, heading_rad: f64| Box2 { middle: [x_m, y_m], heading_rad, half_m: [2.0, 1.0] };
        let one = at(0.0, 0.0, 0.0);
        assert!(one.overlaps(&at(3.9, 0.0, 0.0)) && !one.overlaps(&at(4.1, 0.0, 0.0)));
        assert!(one.overlaps(&at(2.9, 0.0, std::f64::consts::FRAC_PI_2)));
        // The corner of a rotated box comes near without touching.
        assert!(!one.overlaps(&at(3.6, 2.6, std::f64::consts::FRAC_PI_4)));
    }
}
