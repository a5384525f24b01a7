//! Random numbers that are a function of what they are for: of seed, observer, observed vehicle, tick and purpose.
//!
//! No stream is consumed, so one measurement does not depend on whether another one was made, on the number of vehicles, or on
//! threads.

use std::f64::consts::TAU;

use interplay_common::random::{SplitMix64, hash_of};

/// What a random number is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Draw {
    /// The error of the coordinate x.
    X,
    /// The error of the coordinate y.
    Y,
    /// The error of the heading.
    Heading,
    /// The error of the speed.
    Speed,
    /// Whether the measurement is missing.
    Missing,
}

/// The random numbers of one observer about one observed vehicle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise(u64);

impl Noise {
    /// The numbers of a seed for an observer and an observed vehicle, by their names.
    pub(super) fn new(seed: u64, observer: &str, observed: &str) -> Noise {
        let names = [hash_of(observer), hash_of(observed)];
        Noise(names.into_iter().fold(mixed(seed), |mix, name| mixed(mix ^ name)))
    }

    /// Uniform in [0, 1), from the upper 53 bits.
    pub(super) fn uniform(&self, tick: usize, draw: Draw) -> f64 {
        self.unit(tick, draw, 0)
    }

    /// Normal with mean 0 and standard deviation 1 (Box and Muller).
    pub(super) fn normal(&self, tick: usize, draw: Draw) -> f64 {
        let radius = libm::sqrt(-2.0 * libm::log(1.0 - self.unit(tick, draw, 0)));
        radius * libm::cos(TAU * self.unit(tick, draw, 1))
    }

    fn unit(&self, tick: usize, draw: Draw, part: u64) -> f64 {
        SplitMix64::new(self.0 ^ mixed(tick as u64 ^ mixed(2 * draw as u64 + part))).uniform(0.0, 1.0)
    }
}

/// A number whose bits all depend on all bits of another.
fn mixed(number: u64) -> u64 {
    SplitMix64::new(number).next_u64()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_normal_and_independent_of_each_other() {
        let noise = Noise::new(1, "ego", "other");
        const COUNT: usize = 50_000;
        let draws = |draw| (0..COUNT).map(|tick| noise.normal(tick, draw)).collect::<Vec<f64>>();
        let (x, y) = (draws(Draw::X), draws(Draw::Y));
        let mean = |products: &dyn Fn(usize) -> f64| (0..COUNT).map(products).sum::<f64>() / COUNT as f64;
        // Four standard errors, and of the variance √2 times as many.
        let tolerance = 4.0 / (COUNT as f64).sqrt();
        assert!(mean(&|k| x[k]).abs() < tolerance);
        assert!((mean(&|k| x[k] * x[k]) - 1.0).abs() < 2.0_f64.sqrt() * tolerance);
        assert!(mean(&|k| x[k] * y[k]).abs() < tolerance, "x and y");
        assert!(mean(&|k| x[k] * x[(k + 1) % COUNT]).abs() < tolerance, "one tick and the next");
        let others = Noise::new(1, "ego", "third");
        assert!(mean(&|k| x[k] * others.normal(k, Draw::X)).abs() < tolerance, "two observed vehicles");
    }

    #[test]
    fn a_missing_measurement_is_as_rare_as_stated() {
        let noise = Noise::new(7, "a", "b");
        let missing = (0..20_000).filter(|tick| noise.uniform(*tick, Draw::Missing) < 0.2).count();
        assert!((missing as f64 / 20_000.0 - 0.2).abs() < 0.012, "{missing}");
    }

    #[test]
    fn seed_observer_and_observed_change_the_numbers() {
        let first = |seed, observer, observed| Noise::new(seed, observer, observed).normal(0, Draw::X);
        let one = first(1, "a", "b");
        assert_eq!(one, first(1, "a", "b"));
        assert!(one != first(2, "a", "b") && one != first(1, "b", "a") && one != first(1, "a", "c"));
    }
}
