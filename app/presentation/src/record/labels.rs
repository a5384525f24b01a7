//! Placement of the labels of vehicles, so that they cover neither vehicles nor each other. Positions are in pixels, y downwards.

use crate::rectangle::{Rectangle, overlap};

/// Width of a letter and of the edges of a label, and its height \[px\].
const LETTER_PX: f64 = 7.3;
const EDGES_PX: f64 = 14.0;
const HEIGHT_PX: f64 = 25.0;
/// Distance between a vehicle and its label \[px\].
const DISTANCE_PX: f64 = 4.0;

/// Places the label of each vehicle. A label is `None` without space or words, or if the vehicle is out of view.
///
/// `vehicles` are rectangles around the bodies, `sides` the candidates that were chosen last and are preferred.
pub fn place_labels(
    vehicles: &[Rectangle],
    words: &[String],
    size_px: [f64; 2],
    sides: &mut [usize],
) -> Vec<Option<Rectangle>> {
    let mut taken = vehicles.to_vec();
    let mut labels = Vec::new();
    for (index, (vehicle, words)) in vehicles.iter().zip(words).enumerate() {
        let [left, top, right, bottom] = *vehicle;
        let is_inside = right > 0.0 && left < size_px[0] && bottom > 0.0 && top < size_px[1];
        let is_seen = is_inside && !words.is_empty();
        let candidates = candidates(*vehicle, width_px(words));
        let is_free = |place: &Rectangle| {
            let [l, t, r, b] = *place;
            let inside = l >= 0.0 && t >= 0.0 && r <= size_px[0] && b <= size_px[1];
            inside && !taken.iter().any(|other| overlap(*place, *other))
        };
        let order = [sides[index]].into_iter().chain(0..candidates.len());
        let found = order.into_iter().find(|side| is_free(&candidates[*side])).filter(|_| is_seen);
        if let Some(side) = found {
            sides[index] = side;
            taken.push(candidates[side]);
        }
        labels.push(found.map(|side| candidates[side]));
    }
    labels
}

/// Places the label of a vehicle out of view at a place on the edge, or as near as there is space along the edge.
pub fn place_edge_label(
    [x, y]: [f64; 2],
    words: &str,
    [width, height]: [f64; 2],
    taken: &[Rectangle],
) -> Option<Rectangle> {
    let half = [0.5 * width_px(words), 0.5 * HEIGHT_PX];
    let beside_edge = x < half[0] || x > width - half[0];
    let [step_x, step_y] = if beside_edge { [0.0, HEIGHT_PX] } else { [2.0 * half[0], 0.0] };
    let candidate = |steps: f64| {
        let x = (x + steps * step_x).clamp(half[0], (width - half[0]).max(half[0]));
        let y = (y + steps * step_y).clamp(half[1], (height - half[1]).max(half[1]));
        [x - half[0], y - half[1], x + half[0], y + half[1]]
    };
    let is_free = |place: &Rectangle| !taken.iter().any(|other| overlap(*place, *other));
    [0.0, 1.0, -1.0, 2.0, -2.0].map(candidate).into_iter().find(is_free)
}

fn width_px(words: &str) -> f64 {
    LETTER_PX * words.chars().count() as f64 + EDGES_PX
}

/// Candidate places, the best first: above, below, to the right, to the left, and at the corners.
fn candidates([left, top, right, bottom]: Rectangle, width_px: f64) -> [Rectangle; 8] {
    let (x, y) = (0.5 * (left + right), 0.5 * (top + bottom));
    let beside = 0.5 * width_px + DISTANCE_PX;
    let away = 0.5 * HEIGHT_PX + DISTANCE_PX;
    let (l, t, r, b) = (left - beside, top - away, right + beside, bottom + away);
    [[x, t], [x, b], [r, y], [l, y], [r, t], [l, t], [r, b], [l, b]]
        .map(|[x, y]| [x - 0.5 * width_px, y - 0.5 * HEIGHT_PX, x + 0.5 * width_px, y + 0.5 * HEIGHT_PX])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_cover_neither_vehicles_nor_each_other() {
        let vehicles = [[100.0, 100.0, 160.0, 130.0], [110.0, 135.0, 170.0, 165.0], [165.0, 100.0, 225.0, 130.0]];
        let words = ["ego 1.00 m/s", "front 1.00 m/s", "rear 1.00 m/s"].map(str::to_owned);
        let mut sides = [0; 3];
        let labels = place_labels(&vehicles, &words, [800.0, 300.0], &mut sides);
        let labels: Vec<Rectangle> = labels.into_iter().map(|label| label.expect("there is space")).collect();
        for (index, label) in labels.iter().enumerate() {
            assert!(vehicles.iter().all(|vehicle| !overlap(*label, *vehicle)), "{label:?}");
            assert!(labels[..index].iter().all(|other| !overlap(*label, *other)), "{label:?}");
        }
    }

    #[test]
    fn a_label_stays_on_its_side_and_vehicles_out_of_view_have_none() {
        let words = ["ego".to_owned()];
        let mut sides = [1];
        let label =
            place_labels(&[[100.0, 100.0, 160.0, 130.0]], &words, [800.0, 300.0], &mut sides)[0].expect("space");
        assert!(label[1] > 130.0 && sides == [1], "below, as before");
        assert_eq!(place_labels(&[[-90.0, 100.0, -30.0, 130.0]], &words, [800.0, 300.0], &mut sides), [None]);
    }
    #[test]
    fn a_label_at_the_edge_avoids_other_rectangles() {
        let size_px = [800.0, 300.0];
        let alone = place_edge_label([788.0, 150.0], "oncoming, 84 m", size_px, &[]).expect("space");
        assert!(alone[2] <= 800.0 && alone[1] < 150.0 && alone[3] > 150.0, "{alone:?}");
        let beside = place_edge_label([788.0, 150.0], "oncoming, 84 m", size_px, &[alone]).expect("space");
        assert!(!overlap(alone, beside), "{beside:?}");
        assert_eq!(place_edge_label([788.0, 150.0], "oncoming", size_px, &[[0.0, 0.0, 800.0, 300.0]]), None);
    }
}
