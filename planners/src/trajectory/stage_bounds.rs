//! Bounds of one stage of a plan.

/// What a vehicle may do in step `t` of a plan, and how fast it may be after it; each from least to most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageBounds {
    /// The acceleration in the step \[m/s²\].
    pub acceleration_mps2: [f64; 2],
    /// The steering angle in the step \[rad\].
    pub steering_rad: [f64; 2],
    /// The speed after the step \[m/s\].
    pub speed_mps: [f64; 2],
    /// The largest change of the steering angle from the step before; infinite where wheels turn at once \[rad\].
    pub turn_rad: f64,
}
