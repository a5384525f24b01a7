//! Vehicle models, one a file: what a state and an input lead to, with exact derivatives.

mod bicycle;

pub use bicycle::{Bicycle, Curvature, Jacobian};
