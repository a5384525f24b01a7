//! Bodies of vehicles as rectangles.

/// A rectangle in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Box2 {
    /// Its middle \[m\].
    pub middle: [f64; 2],
    /// The direction of its length \[rad\].
    pub heading_rad: f64,
    /// Half its length and half its width \[m\].
    pub half_m: [f64; 2],
}

impl Box2 {
    /// Whether two rectangles overlap: no side of either parts them.
    pub(crate) fn overlaps(&self, other: &Box2) -> bool {
        let apart = [other.middle[0] - self.middle[0], other.middle[1] - self.middle[1]];
        let reach_m = self.half_m[0] + self.half_m[1] + other.half_m[0] + other.half_m[1];
        if libm::hypot(apart[0], apart[1]) > reach_m {
            return false;
        }
        let axes = [self.axes(), other.axes()].concat();
        axes.iter().all(|axis| {
            let distance_m = (apart[0] * axis[0] + apart[1] * axis[1]).abs();
            distance_m < self.reach_m(axis) + other.reach_m(axis)
        })
    }

    fn axes(&self) -> [[f64; 2]; 2] {
        let (sin, cos) = libm::sincos(self.heading_rad);
        [[cos, sin], [-sin, cos]]
    }

    /// How far it reaches from its middle along an axis \[m\].
    fn reach_m(&self, axis: &[f64; 2]) -> f64 {
        let reach = |(own, half_m): (&[f64; 2], f64)| half_m * (own[0] * axis[0] + own[1] * axis[1]).abs();
        self.axes().iter().zip(self.half_m).map(reach).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_overlap_where_no_side_parts_them() {
        let at = |x_m: f64, y_m: f64, heading_rad: f64| Box2 { middle: [x_m, y_m], heading_rad, half_m: [2.0, 1.0] };
        let one = at(0.0, 0.0, 0.0);
        assert!(one.overlaps(&at(3.9, 0.0, 0.0)) && !one.overlaps(&at(4.1, 0.0, 0.0)));
        assert!(one.overlaps(&at(2.9, 0.0, std::f64::consts::FRAC_PI_2)));
        // The corner of a turned box comes near without touching.
        assert!(!one.overlaps(&at(3.6, 2.6, std::f64::consts::FRAC_PI_4)));
    }
}
