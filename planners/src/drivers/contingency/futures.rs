//! What the others may do together, and when the ego will know.

use super::settings::Settings;
use crate::scene::inferred_futures::Alternative;
use crate::{Scene, Trajectory};

/// A possible future: one motion of each other vehicle, with its probability.
#[derive(Clone, Debug, PartialEq)]
pub struct Future {
    /// The hypothesis about the driver of each other vehicle, in the order of the scene; a future has the same ones in
    /// the next plan.
    pub hypotheses: Vec<usize>,
    /// Probability of this future.
    pub probability: f64,
    /// The motion of each of the others, in the order of the scene.
    pub predictions: Vec<Trajectory>,
}

/// The likeliest futures, whose probabilities sum to 1, in the order of their hypotheses; at least one.
///
/// The others are taken for independent of each other. Plans of one vehicle that cannot be told apart are one, with the motion of
/// the likeliest of them. What is less likely than the settings ask for is left out. A vehicle that the ego cannot meet has one
/// future, its prediction.
pub fn futures(scene: &Scene, alternatives: &[Vec<Alternative>], settings: &Settings) -> Vec<Future> {
    let mut futures = vec![Future { hypotheses: Vec::new(), probability: 1.0, predictions: Vec::new() }];
    for (index, other) in scene.others.iter().enumerate() {
        let known = alternatives.get(index).filter(|known| !known.is_empty() && scene.ego.may_meet(other));
        let certain = || vec![Alternative { hypothesis: 0, probability: 1.0, prediction: (*other.prediction).clone() }];
        let motions = known.map_or_else(certain, |known| different(known, settings.told_apart_m));
        let product = futures.iter().flat_map(|future| motions.iter().map(|motion| future.and(motion)));
        futures = likeliest(product.collect(), settings);
    }
    let mass: f64 = futures.iter().map(|future| future.probability).sum();
    futures.iter_mut().for_each(|future| future.probability /= mass);
    futures.sort_by(|a, b| a.hypotheses.cmp(&b.hypotheses));
    futures
}

/// In how many first steps the ego does not yet know which of the futures is the true one: until the last two of them are
/// `told_apart_m` apart, and the `delay` of its sight in steps. 0 for one future, otherwise between 1 and `horizon − 1`.
pub fn shared_steps(futures: &[Future], told_apart_m: f64, delay: usize, horizon: usize) -> usize {
    let pairs = futures.iter().enumerate().flat_map(|(i, a)| futures[..i].iter().map(move |b| (a, b)));
    let known = pairs.map(|(a, b)| {
        let motions = a.predictions.iter().zip(&b.predictions);
        motions.filter_map(|(a, b)| first_apart(a, b, told_apart_m)).min().unwrap_or(horizon)
    });
    known.max().map_or(0, |step| (step + delay).clamp(1, horizon.saturating_sub(1).max(1)))
}

impl Future {
    /// The future in which another vehicle does this besides.
    fn and(&self, motion: &Alternative) -> Future {
        let Future { mut hypotheses, probability, mut predictions } = self.clone();
        hypotheses.push(motion.hypothesis);
        predictions.push(motion.prediction.clone());
        Future { hypotheses, probability: probability * motion.probability, predictions }
    }
}

/// Those that are likely enough, the likeliest first, and not too many; at least one.
fn likeliest(mut futures: Vec<Future>, settings: &Settings) -> Vec<Future> {
    futures.sort_by(|a, b| b.probability.total_cmp(&a.probability).then_with(|| a.hypotheses.cmp(&b.hypotheses)));
    let likely = futures.iter().take_while(|future| future.probability >= settings.probability_at_least).count();
    futures.truncate(likely.clamp(1, settings.futures_at_most.max(1)));
    futures
}

/// The motions that can be told apart, each with the probability of all that look like it, under the number of the first of them.
fn different(alternatives: &[Alternative], told_apart_m: f64) -> Vec<Alternative> {
    let mut by_probability: Vec<&Alternative> = alternatives.iter().collect();
    by_probability.sort_by(|a, b| b.probability.total_cmp(&a.probability).then(a.hypothesis.cmp(&b.hypothesis)));
    let mut groups: Vec<Alternative> = Vec::new();
    for alternative in by_probability {
        let same =
            |group: &&mut Alternative| first_apart(&group.prediction, &alternative.prediction, told_apart_m).is_none();
        match groups.iter_mut().find(same) {
            Some(group) => {
                group.probability += alternative.probability;
                group.hypothesis = group.hypothesis.min(alternative.hypothesis);
            }
            None => groups.push(alternative.clone()),
        }
    }
    groups
}

/// The first step after which two motions are farther apart than a distance \[m\].
fn first_apart(a: &Trajectory, b: &Trajectory, distance_m: f64) -> Option<usize> {
    a.states.iter().zip(&b.states).position(|(a, b)| {
        let ([ax, ay], [bx, by]) = (a.position(), b.position());
        (ax - bx) * (ax - bx) + (ay - by) * (ay - by) > distance_m * distance_m
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::State;
    use crate::fixture::{agent, scene};
    use crate::prediction::constant_velocity;

    fn alternative(hypothesis: usize, probability: f64, speed_mps: f64) -> Alternative {
        let state = State { x_m: 2.0, y_m: 0.0, heading_rad: 0.0, speed_mps };
        Alternative { hypothesis, probability, prediction: constant_velocity(&state, 30, 0.1) }
    }

    fn between_two(first: &[Alternative], second: &[Alternative], settings: &Settings) -> Vec<Future> {
        let seen = scene(agent(0.0, 0.0, 0.0, 1.0), vec![agent(2.0, 0.0, 0.0, 1.0), agent(2.5, 0.1, 0.0, 1.0)]);
        futures(&seen, &[first.to_vec(), second.to_vec()], settings)
    }

    #[test]
    fn what_cannot_be_told_apart_is_one_and_what_is_unlikely_is_left_out() {
        let alike =
            [alternative(0, 0.5, 1.0), alternative(1, 0.3, 1.01), alternative(2, 0.17, 0.6), alternative(3, 0.03, 0.0)];
        let found = between_two(&alike, &[alternative(0, 1.0, 1.0)], &Settings::default());
        let probabilities: Vec<f64> = found.iter().map(|future| future.probability).collect();
        assert_eq!(found.len(), 2);
        assert!((probabilities[0] - 0.8 / 0.97).abs() < 1e-12 && (probabilities[1] - 0.17 / 0.97).abs() < 1e-12);
        // At 1.0 and 0.6 m/s they are 4 cm apart after a step, and 8 cm after two.
        assert_eq!(shared_steps(&found, 0.05, 0, 30), 2);
        assert_eq!(shared_steps(&found, 0.05, 3, 30), 5);
        assert_eq!(shared_steps(&found[..1], 0.05, 3, 30), 0);
    }

    #[test]
    fn two_vehicles_multiply_and_the_likeliest_stay() {
        let one = [alternative(0, 0.6, 1.0), alternative(1, 0.4, 0.5)];
        let found = between_two(&one, &one, &Settings::default());
        let hypotheses: Vec<&[usize]> = found.iter().map(|future| &future.hypotheses[..]).collect();
        assert_eq!(hypotheses, [&[0, 0][..], &[0, 1], &[1, 0]]);
        assert!((found.iter().map(|future| future.probability).sum::<f64>() - 1.0).abs() < 1e-12);
        let likeliest = Settings { probability_at_least: 1.0, ..Settings::default() };
        assert_eq!(between_two(&one, &one, &likeliest).len(), 1);
    }
}
