//! Random numbers in the unit interval for each path and sample.

use interplay_common::random::Random;

use crate::plans::plan_file::Sampling;

/// The random numbers of one path of a plan.
#[derive(Clone, Debug)]
pub(super) struct UnitDraws {
    /// The seed of the path's streams; each sample has a stream of its own.
    seed: u64,
    /// In a Latin hypercube, the part of the unit interval from which each sample is drawn.
    strata: Vec<u32>,
}

/// The stream of a path's permutation; samples have the streams from 0 on.
const PERMUTATION_STREAM: u64 = u64::MAX;

impl UnitDraws {
    /// The random numbers of a path under the seed of a plan.
    pub fn new(seed: u64, path: &str, sampling: Sampling, samples: u64) -> UnitDraws {
        let seed = seed.wrapping_add(hash(path));
        let count = if sampling == Sampling::LatinHypercube { u32::try_from(samples).unwrap_or(u32::MAX) } else { 0 };
        let mut strata: Vec<u32> = (0..count).collect();
        // The Fisher-Yates shuffle.
        let mut random = Random::new(seed, PERMUTATION_STREAM);
        for last in (1..strata.len()).rev() {
            let other = random.uniform(0.0, (last + 1) as f64) as usize;
            strata.swap(last, other.min(last));
        }
        UnitDraws { seed, strata }
    }

    /// The number of a sample, in the open interval (0, 1).
    pub fn at(&self, sample: u64) -> f64 {
        // Adding half a step avoids zero: a normal distribution has infinite quantiles at both ends.
        let unit = Random::new(self.seed, sample).uniform(0.0, 1.0) + 0.5_f64.powi(54);
        let stratum = usize::try_from(sample).ok().and_then(|sample| self.strata.get(sample));
        let drawn = stratum.map_or(unit, |stratum| (f64::from(*stratum) + unit) / self.strata.len() as f64);
        drawn.min(1.0 - 0.5_f64.powi(53))
    }
}

/// The FNV-1a hash of a text.
fn hash(text: &str) -> u64 {
    text.bytes().fold(0xCBF2_9CE4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01B3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stratum_of_a_latin_hypercube_has_one_sample() {
        let draws = UnitDraws::new(1, "a.b", Sampling::LatinHypercube, 50);
        let mut parts: Vec<usize> = (0..50).map(|sample| (draws.at(sample) * 50.0) as usize).collect();
        assert!(parts.windows(2).any(|pair| pair[1] < pair[0]), "not in order");
        parts.sort_unstable();
        assert_eq!(parts, (0..50).collect::<Vec<_>>());
    }

    #[test]
    fn drawn_numbers_do_not_depend_on_sample_count_or_other_paths() {
        let [few, many] = [10, 1000].map(|samples| UnitDraws::new(7, "a.b", Sampling::Random, samples));
        assert!((0..10).all(|sample| few.at(sample) == many.at(sample)));
        let other = UnitDraws::new(7, "a.c", Sampling::Random, 10);
        assert!((0..10).all(|sample| few.at(sample) != other.at(sample)));
        let mean = (0..1000).map(|sample| many.at(sample)).sum::<f64>() / 1000.0;
        // Four standard errors.
        assert!((mean - 0.5).abs() < 4.0 / (12.0_f64 * 1000.0).sqrt(), "{mean}");
    }
}
