//! All random numbers of runs, the same on every machine.
//!
//! [`Random`] is ChaCha's stream, with the normal distribution through `libm`. [`SplitMix64`] draws the random change
//! of starts and mixes the numbers of a sensor's errors. Both generators must stay: the seeds of recorded runs and of
//! the tables in the documents depend on their numbers.

use std::f64::consts::TAU;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

/// A stream of random numbers (ChaCha with 8 rounds). Streams of one seed with different labels are independent.
#[derive(Clone, Debug)]
pub struct Random(ChaCha8Rng);

impl Random {
    /// The stream of a seed and a label; each purpose has a stream of its own, so that draws for one do not shift those for
    /// another.
    pub fn new(seed: u64, label: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(label);
        Self(generator)
    }

    /// Uniform in \[low, high).
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// True with this probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// True with this probability; uses half as much of the stream as [`Random::chance`].
    pub fn chance_of_32_bits(&mut self, probability: f64) -> bool {
        f64::from(self.0.next_u32()) < probability * 4_294_967_296.0
    }

    /// Normal with mean and standard deviation (Box and Muller; the second number is not kept, so that every draw takes
    /// the same amount of the stream).
    pub fn normal(&mut self, mean: f64, deviation: f64) -> f64 {
        let radius = libm::sqrt(-2.0 * libm::log(1.0 - self.unit()));
        mean + deviation * radius * libm::cos(TAU * self.unit())
    }

    fn unit(&mut self) -> f64 {
        unit(self.0.next_u64())
    }
}

/// A number in [0, 1) from the upper 53 bits of another.
fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

/// A number for a name, the same on every machine: FNV-1a over its bytes.
pub fn hash_of(name: &str) -> u64 {
    name.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// A sequence of 64-bit numbers from a seed (Steele, Lea and Flood, 2014).
#[derive(Clone, Debug)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// The sequence of a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The state of the sequence: the sequence of this seed continues it.
    pub fn state(&self) -> u64 {
        self.0
    }

    /// The next number of the sequence.
    pub fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in \[low, high).
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * unit(self.next_u64())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first numbers of the reference implementation for the seed 1234567.
    #[test]
    fn split_mix_is_the_published_generator() {
        let mut sequence = SplitMix64::new(1_234_567);
        let numbers: Vec<u64> = (0..3).map(|_| sequence.next_u64()).collect();
        assert_eq!(numbers, [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423]);
    }

    #[test]
    fn sample_moments_match_their_distributions() {
        let mut random = Random::new(1, 2);
        const COUNT: usize = 100_000;
        let normal: Vec<f64> = (0..COUNT).map(|_| random.normal(3.0, 2.0)).collect();
        let uniform: Vec<f64> = (0..COUNT).map(|_| random.uniform(-1.0, 5.0)).collect();
        let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
        let variance = |x: &[f64], mean: f64| x.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / x.len() as f64;
        // Four standard errors.
        let tolerance = 4.0 / (COUNT as f64).sqrt();
        assert!((mean(&normal) - 3.0).abs() < 2.0 * tolerance);
        assert!((variance(&normal, 3.0) / 4.0 - 1.0).abs() < 2.0_f64.sqrt() * tolerance);
        assert!((mean(&uniform) - 2.0).abs() < 3.0_f64.sqrt() * tolerance);
        assert!(uniform.iter().all(|u| (-1.0..5.0).contains(u)));
    }

    #[test]
    fn random_streams_repeat_and_differ_by_label() {
        let draw = |seed, label| Random::new(seed, label).uniform(0.0, 1.0);
        assert_eq!(draw(1, 1), draw(1, 1));
        assert!(draw(1, 1) != draw(1, 2) && draw(1, 1) != draw(2, 1));
    }
}
