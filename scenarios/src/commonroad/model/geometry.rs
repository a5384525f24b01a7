//! Points and shapes.

use super::super::xml::Element;
use crate::text::error::Fault;

/// A rectangle: length and width \[m\], the direction of its length \[rad\], and its middle \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rectangle {
    pub length_m: f64,
    pub width_m: f64,
    pub orientation_rad: f64,
    pub centre: [f64; 2],
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Region {
    Rectangle(Rectangle),
    Circle { radius_m: f64, centre: [f64; 2] },
    Polygon(Vec<[f64; 2]>),
    Point([f64; 2]),
    Lanelets(Vec<String>),
}

impl Region {
    /// The regions that stand in an element.
    ///
    /// # Errors
    /// For shapes without size, and for invalid numbers.
    pub(super) fn read_all(element: Element<'_>) -> Result<Vec<Region>, Fault> {
        let mut found = Vec::new();
        let mut lanelets = Vec::new();
        for shape in element.elements() {
            match shape.name() {
                "point" => found.push(Region::Point(point(shape)?)),
                "rectangle" => found.push(Region::Rectangle(rectangle(shape)?)),
                "circle" => {
                    let radius_m = size(shape, "radius")?;
                    found.push(Region::Circle { radius_m, centre: centre(shape)? });
                }
                "polygon" => {
                    let corners = points(shape)?;
                    if corners.len() < 3 {
                        let message = format!("{} has {} corners; it needs three", shape.shown(), corners.len());
                        return Err(shape.fault("no polygon", message));
                    }
                    found.push(Region::Polygon(corners));
                }
                "lanelet" => lanelets.push(shape.required_attribute("ref")?.to_owned()),
                _ => {}
            }
        }
        if !lanelets.is_empty() {
            found.push(Region::Lanelets(lanelets));
        }
        Ok(found)
    }

    /// Its middle; `None` for lanelets \[m\].
    pub(crate) fn middle(&self) -> Option<[f64; 2]> {
        match self {
            Region::Rectangle(Rectangle { centre, .. }) | Region::Circle { centre, .. } => Some(*centre),
            Region::Point(point) => Some(*point),
            Region::Polygon(corners) => {
                let count = corners.len() as f64;
                Some([0, 1].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / count))
            }
            Region::Lanelets(_) => None,
        }
    }

    /// A rectangle around the shape of a vehicle, and whether it is the shape itself; `None` for a region that is not a shape.
    pub(crate) fn rectangle(&self) -> Option<(Rectangle, bool)> {
        match self {
            Region::Rectangle(rectangle) => Some((*rectangle, true)),
            Region::Circle { radius_m, centre } => {
                let side_m = 2.0 * radius_m;
                let square = Rectangle { length_m: side_m, width_m: side_m, orientation_rad: 0.0, centre: *centre };
                Some((square, false))
            }
            Region::Polygon(corners) => {
                let bounds = [0, 1].map(|axis| {
                    let along = corners.iter().map(|corner| corner[axis]);
                    along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
                });
                let [length_m, width_m] = bounds.map(|[low, high]| high - low);
                let centre = bounds.map(|[low, high]| 0.5 * (low + high));
                let around = Rectangle { length_m, width_m, orientation_rad: 0.0, centre };
                (length_m > 0.0 && width_m > 0.0).then_some((around, false))
            }
            Region::Point(_) | Region::Lanelets(_) => None,
        }
    }
}

fn rectangle(shape: Element<'_>) -> Result<Rectangle, Fault> {
    let orientation_rad = shape.child("orientation").map_or(Ok(0.0), |orientation| orientation.number())?;
    let (length_m, width_m) = (size(shape, "length")?, size(shape, "width")?);
    Ok(Rectangle { length_m, width_m, orientation_rad, centre: centre(shape)? })
}

/// A positive number \[m\].
fn size(shape: Element<'_>, key: &'static str) -> Result<f64, Fault> {
    let stated = shape.required(key)?;
    let size_m = stated.number()?;
    if size_m > 0.0 {
        return Ok(size_m);
    }
    Err(stated.fault("no size", format!("`{key}` is {size_m}; it must be above 0 m")))
}

/// The stated centre; the origin without one \[m\].
fn centre(shape: Element<'_>) -> Result<[f64; 2], Fault> {
    shape.child("center").map_or(Ok([0.0; 2]), point)
}

/// A point in the plane; its height is left out \[m\].
pub(super) fn point(element: Element<'_>) -> Result<[f64; 2], Fault> {
    Ok([element.required("x")?.number()?, element.required("y")?.number()?])
}

/// The points that stand in an element \[m\].
pub(super) fn points(element: Element<'_>) -> Result<Vec<[f64; 2]>, Fault> {
    element.children("point").map(point).collect()
}
