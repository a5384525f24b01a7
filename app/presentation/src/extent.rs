//! How far points reach.

/// Least and greatest coordinates of some points; of none from +∞ to −∞.
pub fn extent(points: impl IntoIterator<Item = [f64; 2]>) -> [[f64; 2]; 2] {
    points.into_iter().fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], point| {
        [[0, 1].map(|axis| low[axis].min(point[axis])), [0, 1].map(|axis| high[axis].max(point[axis]))]
    })
}

#[cfg(test)]
mod tests {
    use super::extent;

    #[test]
    fn an_extent_holds_every_point() {
        assert_eq!(extent([[1.0, -2.0], [0.5, 3.0], [0.7, 0.0]]), [[0.5, -2.0], [1.0, 3.0]]);
        assert_eq!(extent([]), [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]]);
    }
}
