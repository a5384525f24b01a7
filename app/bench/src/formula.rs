//! The constants of the formula. They are hashed with the people: a change needs a new minor version of the set.

/// Time that the ego may need more than the reference driver alone \[s\].
pub const MOST_LOST_S: f64 = 15.0;
/// Delay of another that alone makes the score 0 \[s\].
pub const MOST_DELAY_S: f64 = 10.0;
/// Braking of another that alone makes the score 0 \[m/s\].
pub const MOST_BRAKING_MPS: f64 = 4.0;
/// Braking that is not counted \[m/s²\].
pub const FREE_BRAKING_MPS2: f64 = 2.0;
/// A way is made up for at this speed at least: others that stand are not late by all the time for which they stand \[m/s\].
pub const LEAST_SPEED_MPS: f64 = 1.0;
/// Weight of discomfort.
pub const DISCOMFORT_WEIGHT: f64 = 0.2;
/// Magnitudes above these are uncomfortable: the jerk \[m/s³\] and the lateral acceleration \[m/s²\].
pub const UNCOMFORTABLE: [f64; 2] = [5.0, 3.0];
/// A vehicle is off the road that is further than this beyond its edge \[m\] for longer than this \[s\].
pub const OFF_ROAD: [f64; 2] = [0.3, 0.5];
/// After the goal the run goes on for this time, so that what the ego did to the others shows \[s\].
pub const AFTERWARDS_S: f64 = 4.0;
/// The name of the vehicle that is judged.
pub const EGO: &str = "ego";
