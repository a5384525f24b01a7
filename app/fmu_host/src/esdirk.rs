//! A stiff integrator: ARK4(3)6L\[2\]SA-ESDIRK (Kennedy and Carpenter, *Applied Numerical Mathematics* 44, 2003), six stages, order 4
//! with an embedded solution of order 3, L-stable and stiffly accurate.
//!
//! Stages are solved by Newton's method with a Jacobian of differences, which is kept until the iteration fails.

use crate::linear::Factors;

/// Diagonal of the method's matrix.
const GAMMA: f64 = 0.25;
/// Times of the stages, as shares of the step.
const TIMES: [f64; 6] = [0.0, 0.5, 83.0 / 250.0, 31.0 / 50.0, 17.0 / 20.0, 1.0];
/// The matrix below its diagonal. Its last row is that of the weights, but for the last weight.
const MATRIX: [[f64; 5]; 6] = [
    [0.0; 5],
    [0.25, 0.0, 0.0, 0.0, 0.0],
    [8611.0 / 62_500.0, -1743.0 / 31_250.0, 0.0, 0.0, 0.0],
    [5_012_029.0 / 34_652_500.0, -654_441.0 / 2_922_500.0, 174_375.0 / 388_108.0, 0.0, 0.0],
    [
        15_267_082_809.0 / 155_376_265_600.0,
        -71_443_401.0 / 120_774_400.0,
        730_878_875.0 / 902_184_768.0,
        2_285_395.0 / 8_070_912.0,
        0.0,
    ],
    [82_889.0 / 524_892.0, 0.0, 15_625.0 / 83_664.0, 69_875.0 / 102_672.0, -2260.0 / 8211.0],
];
/// Weights of the embedded solution.
const EMBEDDED: [f64; 6] = [
    4_586_570_599.0 / 29_645_900_160.0,
    0.0,
    178_811_875.0 / 945_068_544.0,
    814_220_225.0 / 1_159_782_912.0,
    -3_700_637.0 / 11_593_932.0,
    61_727.0 / 225_920.0,
];
const MAX_ITERATIONS: usize = 8;
/// Error of a stage that is left by the iteration, as a share of the tolerance of a step.
const STAGE_ERROR: f64 = 0.01;
/// Slower iterations are given up.
const MAX_RATE: f64 = 0.9;
/// Increment of a difference, relative to the state.
const INCREMENT: f64 = 1e-7;
/// Share of the nominal value that is added to the size of a state in the tolerance.
const NOMINAL_SHARE: f64 = 0.01;
/// A step below this share of the time is at the end of floating-point numbers.
const LEAST_STEP: f64 = 1e-14;

/// Ordinary differential equations.
pub trait Equations {
    /// Writes the time derivatives of the states. Returns `false` where they do not exist: the step was too long.
    ///
    /// # Errors
    /// A failure that ends the simulation, in words.
    fn rates(&mut self, time_s: f64, states: &[f64], rates: &mut [f64]) -> Result<bool, String>;
}

/// The end of a step.
#[derive(Debug)]
pub struct Stepped {
    pub time_s: f64,
    pub states: Vec<f64>,
}

#[derive(Debug)]
pub struct Esdirk {
    /// Relative tolerance.
    tolerance: f64,
    nominals: Vec<f64>,
    /// The length that the next step should have \[s\].
    step_s: f64,
    jacobian: Option<Jacobian>,
    /// Factors of `I - γ h J`, with that `h`.
    factors: Option<(f64, Factors)>,
}

#[derive(Debug)]
struct Jacobian {
    /// Row by row.
    values: Vec<f64>,
    time_s: f64,
}

enum Attempt {
    /// States and the error as a share of the tolerance.
    Solved(Vec<f64>, f64),
    Diverged,
}

impl Esdirk {
    pub fn new(tolerance: f64, nominals: Vec<f64>) -> Self {
        Self { tolerance, nominals, step_s: 0.0, jacobian: None, factors: None }
    }

    pub fn set_nominals(&mut self, nominals: Vec<f64>) {
        self.nominals = nominals;
    }

    /// Makes a step from `states`, at most until `until_s`.
    ///
    /// # Errors
    /// The failure of the equations, or that no step is short enough.
    pub fn step(
        &mut self,
        system: &mut dyn Equations,
        from_s: f64,
        states: &[f64],
        until_s: f64,
    ) -> Result<Stepped, String> {
        let most_s = until_s - from_s;
        let mut rates = vec![0.0; states.len()];
        if !system.rates(from_s, states, &mut rates)? {
            return Err(format!("its derivatives do not exist at {from_s} s"));
        }
        if states.is_empty() || most_s <= LEAST_STEP * from_s.abs() {
            let states = states.iter().zip(&rates).map(|(state, rate)| state + most_s * rate).collect();
            return Ok(Stepped { time_s: until_s, states });
        }
        if self.step_s <= 0.0 {
            let size = self.norm(&rates, states);
            self.step_s = if size > 0.0 { (0.01 / size / self.tolerance).min(most_s) } else { most_s };
            self.step_s *= self.tolerance.powf(0.25);
        }
        loop {
            let step_s = if self.step_s >= most_s { most_s } else { self.step_s.min(0.5 * most_s.max(self.step_s)) };
            if step_s <= LEAST_STEP * from_s.abs() || step_s <= 0.0 {
                return Err(format!("its solution cannot be continued at {from_s} s: no step is short enough"));
            }
            let is_fresh = self.prepare(system, from_s, states, &rates, step_s)?;
            match self.attempt(system, (from_s, step_s), states, &rates)? {
                Attempt::Solved(next, error) => {
                    let factor = (0.9 * error.max(1e-9).powf(-0.25)).clamp(0.2, 4.0);
                    if error <= 1.0 {
                        // A step that was cut off says nothing against the length before.
                        let longer = step_s * if (0.9..1.2).contains(&factor) { 1.0 } else { factor };
                        self.step_s = if step_s < self.step_s { longer.max(self.step_s) } else { longer };
                        let time_s = if step_s >= most_s { until_s } else { from_s + step_s };
                        return Ok(Stepped { time_s, states: next });
                    }
                    self.step_s = step_s * factor.min(0.9);
                }
                Attempt::Diverged if is_fresh => self.step_s = 0.25 * step_s,
                Attempt::Diverged => self.jacobian = None,
            }
        }
    }

    /// Makes the Jacobian, if there is none, and its factors. Returns whether the Jacobian is that of this time.
    fn prepare(
        &mut self,
        system: &mut dyn Equations,
        time_s: f64,
        states: &[f64],
        rates: &[f64],
        step_s: f64,
    ) -> Result<bool, String> {
        if self.jacobian.is_none() {
            self.jacobian = Some(self.differences(system, time_s, states, rates)?);
            self.factors = None;
        }
        let Some(jacobian) = &self.jacobian else { return Ok(false) };
        if self.factors.as_ref().is_none_or(|(known_s, _)| *known_s != step_s) {
            let size = states.len();
            let mut matrix: Vec<f64> = jacobian.values.iter().map(|value| -GAMMA * step_s * value).collect();
            (0..size).for_each(|index| matrix[index * (size + 1)] += 1.0);
            self.factors = Factors::new(matrix, size).map(|factors| (step_s, factors));
        }
        Ok(jacobian.time_s == time_s)
    }

    fn differences(
        &self,
        system: &mut dyn Equations,
        time_s: f64,
        states: &[f64],
        rates: &[f64],
    ) -> Result<Jacobian, String> {
        let size = states.len();
        let (mut values, mut moved, mut changed) = (vec![0.0; size * size], states.to_vec(), vec![0.0; size]);
        for column in 0..size {
            let by = INCREMENT * (states[column].abs() + self.nominals[column].abs());
            // Where the derivatives do not exist on one side, they are tried on the other.
            for by in [by, -by] {
                moved[column] = states[column] + by;
                if system.rates(time_s, &moved, &mut changed)? {
                    let by = moved[column] - states[column];
                    (0..size).for_each(|row| values[row * size + column] = (changed[row] - rates[row]) / by);
                    break;
                }
            }
            moved[column] = states[column];
        }
        Ok(Jacobian { values, time_s })
    }

    fn attempt(
        &self,
        system: &mut dyn Equations,
        (from_s, step_s): (f64, f64),
        states: &[f64],
        rates: &[f64],
    ) -> Result<Attempt, String> {
        let Some((_, factors)) = &self.factors else { return Ok(Attempt::Diverged) };
        let mut slopes = vec![rates.to_vec()];
        let mut last = states.to_vec();
        for stage in 1..TIMES.len() {
            let known: Vec<f64> = (0..states.len())
                .map(|index| {
                    let sum: f64 = slopes.iter().zip(MATRIX[stage]).map(|(slope, weight)| weight * slope[index]).sum();
                    states[index] + step_s * sum
                })
                .collect();
            let before = &slopes[stage - 1];
            last = known.iter().zip(before).map(|(known, slope)| known + GAMMA * step_s * slope).collect();
            let time_s = from_s + TIMES[stage] * step_s;
            if !self.solve(system, factors, (time_s, GAMMA * step_s), &known, &mut last)? {
                return Ok(Attempt::Diverged);
            }
            slopes.push(last.iter().zip(&known).map(|(state, known)| (state - known) / (GAMMA * step_s)).collect());
        }
        let weights = (0..TIMES.len()).map(|stage| MATRIX[5].get(stage).copied().unwrap_or(GAMMA) - EMBEDDED[stage]);
        let weights: Vec<f64> = weights.collect();
        let mut error: Vec<f64> = (0..states.len())
            .map(|index| step_s * slopes.iter().zip(&weights).map(|(slope, weight)| weight * slope[index]).sum::<f64>())
            .collect();
        // Stiff parts of the error, which the method itself damps, do not shorten steps.
        factors.solve(&mut error);
        let error = self.norm(&error, states);
        Ok(if error.is_finite() { Attempt::Solved(last, error) } else { Attempt::Diverged })
    }

    /// Solves `x = known + γ h f(x)` from the guess `x`; returns whether it converged.
    fn solve(
        &self,
        system: &mut dyn Equations,
        factors: &Factors,
        (time_s, weight_s): (f64, f64),
        known: &[f64],
        x: &mut [f64],
    ) -> Result<bool, String> {
        let (mut rates, mut before) = (vec![0.0; x.len()], None);
        for _ in 0..MAX_ITERATIONS {
            if !system.rates(time_s, x, &mut rates)? {
                return Ok(false);
            }
            let mut change: Vec<f64> =
                (0..x.len()).map(|index| known[index] + weight_s * rates[index] - x[index]).collect();
            factors.solve(&mut change);
            let size = self.norm(&change, x);
            if !size.is_finite() {
                return Ok(false);
            }
            x.iter_mut().zip(&change).for_each(|(x, change)| *x += change);
            let left = before.map_or(size, |before| {
                let rate: f64 = size / before;
                if rate < MAX_RATE { size * rate / (1.0 - rate) } else { f64::INFINITY }
            });
            if left < STAGE_ERROR || size == 0.0 {
                return Ok(true);
            }
            if left.is_infinite() {
                return Ok(false);
            }
            before = Some(size);
        }
        Ok(false)
    }

    /// Root mean square of a difference of states, as a share of the tolerance.
    fn norm(&self, difference: &[f64], states: &[f64]) -> f64 {
        let parts = difference.iter().zip(states).zip(&self.nominals);
        let sum: f64 = parts
            .map(|((part, state), nominal)| part / (state.abs() + NOMINAL_SHARE * nominal.abs()))
            .map(|share| share * share)
            .sum();
        (sum / difference.len().max(1) as f64).sqrt() / self.tolerance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Function<F>(F);

    impl<F: FnMut(f64, &[f64], &mut [f64])> Equations for Function<F> {
        fn rates(&mut self, time_s: f64, states: &[f64], rates: &mut [f64]) -> Result<bool, String> {
            (self.0)(time_s, states, rates);
            Ok(true)
        }
    }

    /// The states at a time, and the number of steps.
    fn solved(f: impl FnMut(f64, &[f64], &mut [f64]), start: &[f64], end_s: f64, tolerance: f64) -> (Vec<f64>, usize) {
        let (mut system, mut solver) = (Function(f), Esdirk::new(tolerance, vec![1.0; start.len()]));
        let (mut at, mut steps) = (Stepped { time_s: 0.0, states: start.to_vec() }, 0);
        while at.time_s < end_s {
            at = solver.step(&mut system, at.time_s, &at.states, end_s).expect("a step");
            steps += 1;
        }
        (at.states, steps)
    }

    #[test]
    fn rows_of_the_method_are_consistent() {
        let weights = |stage: usize| MATRIX[5].get(stage).copied().unwrap_or(GAMMA);
        for (stage, time) in TIMES.iter().enumerate().skip(1) {
            assert!((MATRIX[stage].iter().sum::<f64>() + GAMMA - time).abs() < 1e-14, "{stage}");
        }
        for power in 0..4 {
            let sum = |of: &dyn Fn(usize) -> f64| (0..6).map(|stage| of(stage) * TIMES[stage].powi(power)).sum::<f64>();
            let right = 1.0 / f64::from(power + 1);
            assert!((sum(&weights) - right).abs() < 1e-14, "{power}");
            assert!(power == 3 || (sum(&|stage| EMBEDDED[stage]) - right).abs() < 1e-12, "{power}");
        }
    }

    #[test]
    fn an_oscillator_keeps_its_closed_form() {
        let f = |_: f64, x: &[f64], rates: &mut [f64]| (rates[0], rates[1]) = (x[1], -x[0]);
        for tolerance in [1e-6, 1e-9] {
            let (found, _) = solved(f, &[1.0, 0.0], 10.0, tolerance);
            let error = (found[0] - 10.0_f64.cos()).abs().max((found[1] + 10.0_f64.sin()).abs());
            assert!(error < 100.0 * tolerance, "{tolerance}: {error}");
        }
    }

    /// An explicit method would need steps below 2e-6 s.
    #[test]
    fn a_stiff_system_takes_few_steps() {
        let f = |time: f64, x: &[f64], rates: &mut [f64]| {
            rates[0] = -1e6 * (x[0] - time.cos()) - time.sin();
            rates[1] = x[0] - x[1];
        };
        let (found, steps) = solved(f, &[1.0, 0.0], 10.0, 1e-8);
        // x1 = (cos t + sin t - e^-t) / 2.
        let exact = 0.5 * (10.0_f64.cos() + 10.0_f64.sin() - (-10.0_f64).exp());
        assert!((found[0] - 10.0_f64.cos()).abs() < 1e-6 && (found[1] - exact).abs() < 1e-6, "{found:?} for {exact}");
        assert!(steps < 2000, "{steps}");
    }

    /// Robertson's reaction, a usual test of stiff methods: its masses are kept, and are those of Hairer and Wanner at 40 s.
    #[test]
    fn robertsons_reaction_has_its_known_end() {
        let f = |_: f64, x: &[f64], rates: &mut [f64]| {
            let (slow, back, fast) = (0.04 * x[0], 1e4 * x[1] * x[2], 3e7 * x[1] * x[1]);
            (rates[0], rates[1], rates[2]) = (back - slow, slow - back - fast, fast);
        };
        let (found, _) = solved(f, &[1.0, 0.0, 0.0], 40.0, 1e-9);
        for (found, known) in found.iter().zip([0.715_827_068_7, 9.185_534_764e-6, 0.284_163_745_7]) {
            assert!((found - known).abs() < 1e-6 * known + 1e-9, "{found} for {known}");
        }
    }
}
