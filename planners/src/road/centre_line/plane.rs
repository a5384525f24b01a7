//! Products and lengths of vectors in the plane.

pub(super) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(super) fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let apart = [a[0] - b[0], a[1] - b[1]];
    (apart[0] * apart[0] + apart[1] * apart[1]).sqrt()
}
