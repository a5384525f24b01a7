//! State space.

#[cfg(test)]
mod armadillo_test;
mod exponential;
mod gains;
mod likelihood;
mod linear_model;
mod scoring;
