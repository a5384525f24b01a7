//! What the unknown timing of heat within a row does to the temperatures at its end.
//!
//! Heat of strength P is on for a share d of a row of length h, from τ on, and off otherwise. The model takes the mean P d for the
//! whole row, and so errs by
//!
//! ```text
//! g(τ) = P ∫_τ^{τ+dh} e^{A(h−s)} b ds − P d Γ₀ b = P (F(h−τ) − F(h−τ−dh) − d F(h)),     F(t) = ∫_0^t e^{As} b ds
//! ```
//!
//! If τ is uniform in [0, (1−d)h], the mean of g shifts the temperatures and its covariance adds to their random part; for slow modes it
//! is about (Ab)(Ab)ᵀ P² d² (1−d)² h⁴/12. If the place is known, g is a shift alone. A heater that cycles n times within a row has a deviation
//! n times smaller: g is multiplied by a number s in [0, 1], one a zone, which is 0 for heat that is held.

use nalgebra::DMatrix;

use super::exponential::{Number, phi_functions, real};
use super::heat_rows::{HeatRows, PARTS, PartialHeat, Placement};
use super::linear_model::{ContinuousModel, SampledModel};

/// What a row of one class adds to a step, beyond the effect of its mean heat.
#[derive(Debug, Clone)]
pub(super) struct RowEffect {
    /// Shift of the states \[K\].
    pub shift: Vec<Number>,
    /// Covariance of the random part of the step, Q included, n × n row by row \[K²\].
    pub noise: Vec<Number>,
}

/// The effect of each class of rows; `None` if the model is too fast for the step.
pub(super) fn row_effects(
    model: &ContinuousModel,
    sampled: &SampledModel,
    rows: &HeatRows,
    step_s: f64,
) -> Option<Vec<RowEffect>> {
    let n = model.dynamics.nrows();
    let plain = RowEffect { shift: vec![real(0.0); n], noise: sampled.noise.transpose().iter().copied().collect() };
    let mut effects = vec![plain.clone(); rows.classes.len()];
    let is_timed = rows.classes.iter().any(|class| !class.is_empty());
    if !is_timed {
        return Some(effects);
    }
    let part_s = step_s / PARTS as f64;
    let [transition, first, _] = phi_functions(&model.dynamics.map(|entry| entry * part_s))?;
    // F of each zone with partial heat.
    let responses: Vec<Option<Vec<Vec<Number>>>> = (0..model.heat_swing.len())
        .map(|zone| {
            let column = rows.classes.iter().flatten().find(|it| it.zone == zone)?.column;
            Some(response(model, (&transition, &first), column, part_s))
        })
        .collect();
    for (class, effect) in rows.classes.iter().zip(&mut effects) {
        for partial in class {
            if let Some(response) = &responses[partial.zone] {
                add_effect(effect, partial, response, model.heat_swing[partial.zone]);
            }
        }
    }
    Some(effects)
}

/// F at the ends of the parts of a row, from 0 to h, for an input `column`.
fn response(
    model: &ContinuousModel,
    (transition, first): (&DMatrix<Number>, &DMatrix<Number>),
    column: usize,
    part_s: f64,
) -> Vec<Vec<Number>> {
    let n = model.dynamics.nrows();
    let times = |matrix: &DMatrix<Number>, vector: &dyn Fn(usize) -> Number| -> Vec<Number> {
        (0..n).map(|i| (0..n).fold(real(0.0), |sum, j| sum + matrix[(i, j)] * vector(j))).collect()
    };
    let of_part: Vec<Number> =
        times(first, &|j| model.inputs[(j, column)]).into_iter().map(|entry| entry * part_s).collect();
    let mut all = vec![vec![real(0.0); n]];
    for part in 0..PARTS {
        let moved = times(transition, &|j| all[part][j]);
        all.push(moved.iter().zip(&of_part).map(|(moved, added)| moved + added).collect());
    }
    all
}

/// Adds shift and covariance of a partial heat with s = `swing`.
fn add_effect(effect: &mut RowEffect, partial: &PartialHeat, response: &[Vec<Number>], swing: Number) {
    let n = effect.shift.len();
    let on = partial.on_parts;
    let share = on as f64 / PARTS as f64;
    let factor = swing * partial.swing_kw;
    let error = |begin: usize, i: usize| {
        let end = PARTS - begin;
        (response[end][i] - response[end - on][i] - response[PARTS][i] * share) * factor
    };
    let add_shift = |effect: &mut RowEffect, shift: &dyn Fn(usize) -> Number| {
        effect.shift.iter_mut().enumerate().for_each(|(i, slot)| *slot += shift(i));
    };
    let last = PARTS - on;
    match partial.placement {
        Placement::AtStart => add_shift(effect, &|i| error(0, i)),
        Placement::AtEnd => add_shift(effect, &|i| error(last, i)),
        Placement::Anywhere => {
            let errors: Vec<Vec<Number>> = (0..=last).map(|begin| (0..n).map(|i| error(begin, i)).collect()).collect();
            let weights = simpson(last);
            let weighted =
                |value: &dyn Fn(usize) -> Number| (0..=last).fold(real(0.0), |sum, k| sum + value(k) * weights[k]);
            let mean: Vec<Number> = (0..n).map(|i| weighted(&|k| errors[k][i])).collect();
            for i in 0..n {
                for j in i..n {
                    let covariance = weighted(&|k| (errors[k][i] - mean[i]) * (errors[k][j] - mean[j]));
                    effect.noise[i * n + j] += covariance;
                    if i != j {
                        effect.noise[j * n + i] += covariance;
                    }
                }
            }
            add_shift(effect, &|i| mean[i]);
        }
    }
}

/// Weights of Simpson's rule for the mean over an even number of equal parts.
fn simpson(parts: usize) -> Vec<f64> {
    let weight = |k: usize| match k {
        0 => 1.0,
        k if k == parts => 1.0,
        k if k % 2 == 1 => 4.0,
        _ => 2.0,
    };
    (0..=parts).map(|k| weight(k) / (3.0 * parts as f64)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::state_space::linear_model::tests::one_state;

    /// One slow state: the covariance is about (ab)² P² d² (1−d)² h⁴/12.
    #[test]
    fn the_covariance_of_a_slow_mode_is_that_of_the_time_of_its_heat() {
        let model = one_state(-1e-6, 2e-4);
        let step_s = 900.0;
        let sampled = model.sampled(step_s).expect("sound");
        let partial = |placement| PartialHeat { zone: 0, column: 0, swing_kw: 3.0, on_parts: 12, placement };
        let classes = vec![
            Vec::new(),
            Vec::new(),
            vec![partial(Placement::Anywhere)],
            vec![partial(Placement::AtStart)],
            vec![partial(Placement::AtEnd)],
        ];
        let rows = HeatRows { of_row: Vec::new(), classes };
        let effects = row_effects(&model, &sampled, &rows, step_s).expect("sound");
        let added = effects[2].noise[0].re - sampled.noise[(0, 0)].re;
        let expected = (1e-6_f64 * 2e-4 * 3.0 * 0.25 * 0.75 * step_s * step_s).powi(2) / 12.0;
        assert!((added / expected - 1.0).abs() < 2e-3, "{added} {expected}");
        // Early heat has decayed for longer than late heat.
        let half = 0.5 * 1e-6 * 2e-4 * 3.0 * 0.25 * 0.75 * step_s * step_s;
        assert!((effects[3].shift[0].re / -half - 1.0).abs() < 2e-3, "{}", effects[3].shift[0]);
        assert!((effects[4].shift[0].re / half - 1.0).abs() < 2e-3, "{}", effects[4].shift[0]);
        assert_eq!(effects[1].noise[0], effects[0].noise[0]);
    }

    /// A fast state forgets all heat but the last: the mean of g is not zero, and its variance is that of a heater that was on at the end.
    #[test]
    fn a_fast_mode_is_as_warm_as_its_last_heat() {
        let model = one_state(-0.05, 0.05);
        let step_s = 3600.0;
        let sampled = model.sampled(step_s).expect("sound");
        let partial = PartialHeat { zone: 0, column: 0, swing_kw: 1.0, on_parts: 24, placement: Placement::AtEnd };
        let rows = HeatRows { of_row: Vec::new(), classes: vec![vec![], vec![], vec![partial]] };
        let effects = row_effects(&model, &sampled, &rows, step_s).expect("sound");
        assert!((effects[2].shift[0].re - 0.5).abs() < 1e-6, "{}", effects[2].shift[0]);
    }
}
