//! The largest value of a quantity in a run, and when it was reached.

/// The largest positive value so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Peak {
    /// The value; 0 if it was never positive.
    pub value: f64,
    /// When it was reached first \[s\]; none if it was never positive.
    pub time_s: Option<f64>,
}

impl Peak {
    /// Takes the value at one time.
    pub fn observe(&mut self, value: f64, time_s: f64) {
        if value > self.value {
            *self = Peak { value, time_s: Some(time_s) };
        }
    }
}
