//! How much the ego's own cost counts (eq. 6.18).

/// The weight `w` of the ego's cost against the other's deviation; starts at one half.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Concession {
    weight: f64,
}

impl Default for Concession {
    fn default() -> Self {
        Concession { weight: 0.5 }
    }
}

impl Concession {
    /// The present weight.
    pub fn weight(&self) -> f64 {
        self.weight
    }

    /// `w ← max(floor, w β^{1 − p_a})`: a refusal costs a factor `β`, full acceptance nothing.
    ///
    /// Eq. 6.18 has no floor; without one the ego's cost vanishes for good.
    pub fn concede(&mut self, accepted: f64, beta: f64, floor: f64) {
        self.weight = (self.weight * libm::pow(beta, 1.0 - accepted)).max(floor);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn full_acceptance_keeps_the_weight_and_refusal_lowers_it_to_the_floor() {
        let mut concession = Concession::default();
        concession.concede(1.0, 0.8, 0.02);
        assert_eq!(concession.weight(), 0.5);
        concession.concede(0.0, 0.8, 0.02);
        assert!((concession.weight() - 0.4).abs() < 1e-15);
        (0..100).for_each(|_| concession.concede(0.0, 0.8, 0.02));
        assert_eq!(concession.weight(), 0.02);
    }
}
