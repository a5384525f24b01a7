//! How smoothly a vehicle drives.

use interplay_planners::Input;

/// Means of the absolute acceleration and of its change.
#[derive(Clone, Copy, Debug)]
pub struct RideComfort {
    step_s: f64,
    previous: f64,
    acceleration_sum: f64,
    jerk_sum: f64,
    count: usize,
}

impl RideComfort {
    /// A vehicle that has not accelerated yet.
    pub fn new(step_s: f64) -> Self {
        RideComfort { step_s, previous: 0.0, acceleration_sum: 0.0, jerk_sum: 0.0, count: 0 }
    }

    /// Takes the input of one tick.
    pub fn observe(&mut self, input: &Input) {
        self.acceleration_sum += input.acceleration_mps2.abs();
        self.jerk_sum += (input.acceleration_mps2 - self.previous).abs() / self.step_s;
        self.previous = input.acceleration_mps2;
        self.count += 1;
    }

    /// Mean absolute acceleration \[m/s²\].
    pub fn mean_abs_acceleration(&self) -> f64 {
        self.acceleration_sum / self.count.max(1) as f64
    }

    /// Mean absolute jerk \[m/s³\].
    pub fn mean_abs_jerk(&self) -> f64 {
        self.jerk_sum / self.count.max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_of_a_pulse() {
        let mut comfort = RideComfort::new(0.1);
        for acceleration_mps2 in [0.0, 1.0, -1.0, 0.0] {
            comfort.observe(&Input { acceleration_mps2, steering_rad: 0.0 });
        }
        assert!((comfort.mean_abs_acceleration() - 0.5).abs() < 1e-12);
        assert!((comfort.mean_abs_jerk() - 10.0).abs() < 1e-12);
    }
}
