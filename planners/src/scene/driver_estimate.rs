//! What is believed of another driver, in a few numbers: the kinds of driver that it may be, and their probabilities.

/// The safety weights of the hypothesised humans, from tough to nice. Weights between them need no hypothesis of their own:
/// their plans nearly coincide with one of these.
pub(crate) const SAFETY_WEIGHTS: [f64; 3] = [0.0, 8.0, 50.0];

/// Between which weights each hypothesised human is the nearest: a driver with the weight 0.2 is after a second as far from
/// where a tough driver would be as from where a normal one would be, and one with 16 is between normal and nice (medians of 1,100
/// scenes in which they can be told apart, `--example belief_calibration`). The last stands for all weights above 16.
pub const SAFETY_WEIGHT_EDGES: [f64; 4] = [0.0, 0.2, 16.0, 100.0];

/// A kind of driver; the humans come in the order of their safety weights, from tough to nice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriverModel {
    /// A human driver with safety weight 0.
    Tough,
    /// A human driver with safety weight 8.
    Normal,
    /// A human driver with safety weight 50.
    Nice,
    /// The intelligent driver model.
    Idm,
    /// None of these: it goes on at constant velocity, with large errors.
    Unknown,
}

impl DriverModel {
    /// All kinds, in the order in which probabilities are listed.
    pub const ALL: [DriverModel; 5] =
        [DriverModel::Tough, DriverModel::Normal, DriverModel::Nice, DriverModel::Idm, DriverModel::Unknown];

    /// Its place in [`DriverModel::ALL`].
    pub(crate) fn index(self) -> usize {
        self as usize
    }

    /// The kind in words, as part of a sentence.
    pub fn name(self) -> &'static str {
        match self {
            DriverModel::Tough => "tough",
            DriverModel::Normal => "normal",
            DriverModel::Nice => "nice",
            DriverModel::Idm => "an IDM driver",
            DriverModel::Unknown => "none of the known drivers",
        }
    }

    /// Whether it takes notice of vehicles outside its own lane, as far as is known.
    pub fn can_be_asked(self) -> bool {
        match self {
            DriverModel::Tough | DriverModel::Normal | DriverModel::Nice => true,
            DriverModel::Idm | DriverModel::Unknown => false,
        }
    }
}

/// The probability that the interval of the safety weight contains, and the names that are credible, at least.
const CREDIBLE_PROBABILITY: f64 = 0.9;
/// Rounding of a sum of probabilities.
const ROUNDING: f64 = 1e-12;

/// The belief about one observed driver.
#[derive(Clone, Debug, PartialEq)]
pub struct DriverEstimate {
    /// The name of the driver's vehicle.
    pub vehicle: String,
    /// The kind of driver whose plan is used as the prediction.
    pub model: DriverModel,
    /// Probabilities of the kinds of driver, in the order of [`DriverModel::ALL`].
    pub probabilities: [f64; 5],
    /// Mean of the safety weight, if it is a human.
    pub safety_weight: f64,
    /// Interval of the safety weight that contains it with a probability of at least 0.9, if it is a human: from edge to edge of
    /// [`SAFETY_WEIGHT_EDGES`].
    pub safety_weight_interval: [f64; 2],
    /// Entropy of the probabilities; 0 where all is certain, `ln 5` at most \[nat\].
    pub entropy: f64,
}

impl DriverEstimate {
    /// The estimate that follows from the probabilities of the kinds of driver.
    pub(crate) fn new(vehicle: &str, model: DriverModel, probabilities: [f64; 5]) -> DriverEstimate {
        let [tough, normal, nice, ..] = probabilities;
        let human = tough + normal + nice;
        let styles = [tough, normal, nice].map(|p| p / human);
        let terms = probabilities.iter().filter(|p| **p > 0.0).map(|p| -p * libm::log(*p));
        DriverEstimate {
            vehicle: vehicle.to_owned(),
            model,
            probabilities,
            safety_weight: styles.iter().zip(SAFETY_WEIGHTS).map(|(p, weight)| p * weight).sum(),
            safety_weight_interval: interval(styles),
            entropy: terms.sum(),
        }
    }

    /// The mean of a quantity that depends on the kind of driver.
    pub fn mean(&self, of: impl Fn(DriverModel) -> f64) -> f64 {
        DriverModel::ALL.into_iter().map(|model| self.probability(model) * of(model)).sum()
    }

    /// The fewest kinds of driver that contain this one with a probability of at least 0.9, the likeliest first: a highest posterior
    /// density set. A driver who cannot be told from another kind is named by both.
    pub fn credible_models(&self) -> Vec<DriverModel> {
        let mut models = DriverModel::ALL;
        models.sort_by(|a, b| self.probability(*b).total_cmp(&self.probability(*a)));
        let mut mass = 0.0;
        let needed = models.iter().take_while(|model| {
            let is_needed = mass < CREDIBLE_PROBABILITY - ROUNDING;
            mass += self.probability(**model);
            is_needed
        });
        needed.copied().collect()
    }

    /// The probability of a kind of driver.
    pub fn probability(&self, model: DriverModel) -> f64 {
        self.probabilities[model.index()]
    }
}

/// The shortest run of weights whose probabilities sum to [`CREDIBLE_PROBABILITY`]; of equally many the likeliest.
fn interval(styles: [f64; 3]) -> [f64; 2] {
    for count in 1..=styles.len() {
        let runs = (0..=styles.len() - count).map(|first| (first, styles[first..first + count].iter().sum::<f64>()));
        let best = runs.max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
        if let Some((first, _)) = best.filter(|(_, mass)| *mass >= CREDIBLE_PROBABILITY) {
            return [SAFETY_WEIGHT_EDGES[first], SAFETY_WEIGHT_EDGES[first + count]];
        }
    }
    [SAFETY_WEIGHT_EDGES[0], SAFETY_WEIGHT_EDGES[styles.len()]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn interval_of(probabilities: [f64; 5]) -> [f64; 2] {
        DriverEstimate::new("a", DriverModel::Nice, probabilities).safety_weight_interval
    }

    #[test]
    fn the_interval_holds_nine_tenths_of_the_humans() {
        assert_eq!(interval_of([0.01, 0.02, 0.9, 0.03, 0.04]), [16.0, 100.0]);
        assert_eq!(interval_of([0.02, 0.3, 0.6, 0.0, 0.08]), [0.2, 100.0]);
        assert_eq!(interval_of([0.3, 0.3, 0.3, 0.05, 0.05]), [0.0, 100.0]);
        assert_eq!(interval_of([0.5, 0.02, 0.0, 0.4, 0.08]), [0.0, 0.2]);
    }

    #[test]
    fn a_driver_is_named_by_all_kinds_that_it_may_well_be() {
        let credible = |p| DriverEstimate::new("a", DriverModel::Nice, p).credible_models();
        assert_eq!(credible([0.02, 0.37, 0.55, 0.03, 0.03]), [DriverModel::Nice, DriverModel::Normal]);
        assert_eq!(credible([0.95, 0.05, 0.0, 0.0, 0.0]), [DriverModel::Tough]);
        assert_eq!(
            credible([0.1, 0.3, 0.6, 0.0, 0.0]),
            [DriverModel::Nice, DriverModel::Normal],
            "0.6 + 0.3 rounds below 0.9"
        );
        assert_eq!(credible([0.2; 5]).len(), 5);
    }

    #[test]
    fn entropy_is_that_of_shannon() {
        let certain = DriverEstimate::new("a", DriverModel::Nice, [0.0, 0.0, 1.0, 0.0, 0.0]);
        let even = DriverEstimate::new("a", DriverModel::Nice, [0.2; 5]);
        assert_eq!(certain.entropy, 0.0);
        assert!((even.entropy - 5.0_f64.ln()).abs() < 1e-12);
        assert!((even.safety_weight - 58.0 / 3.0).abs() < 1e-12);
    }
}
