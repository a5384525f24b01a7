//! A fitted model with heat of unknown strengths β into a zone, in addition to its own inputs.

use nalgebra::DMatrix;

use super::World;
use crate::identify::state_space::exponential::{Number, real};
use crate::identify::state_space::likelihood::{Evaluation, Observations, evaluate};
use crate::identify::state_space::linear_model::ContinuousModel;
use crate::identify::state_space::scoring::{Ascent, Maximum};
use crate::identify::state_space::structure::{ParameterKind, Structure};

/// Largest magnitude of β.
const MOST_STRENGTH: f64 = 1e4;
/// An ascent ends when a step promises less than this gain of the log-likelihood.
const LEAST_GAIN: f64 = 1e-2;
const MOST_STEPS: usize = 15;

/// Heat in each row, for β = 1 \[kW\].
#[derive(Clone)]
pub(super) struct HeatColumn {
    pub kw: Vec<f64>,
    /// The node that it enters.
    pub node: usize,
}

/// The observations with the columns as further inputs.
pub(super) struct Widened<'a> {
    world: &'a World<'a>,
    pub observations: Observations,
    nodes: Vec<usize>,
}

impl<'a> Widened<'a> {
    pub fn new(world: &'a World<'a>, columns: &[HeatColumn]) -> Self {
        let known = world.observations;
        let (p, m) = known.widths;
        let rows = known.outputs.len() / p;
        let wider = |values: &[f64], added: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
            let row = |row: usize| {
                let known = values[row * m..(row + 1) * m].iter().copied();
                known.chain((0..columns.len()).map(move |column| added(row, column)))
            };
            (0..rows).flat_map(row).collect()
        };
        let observations = Observations {
            inputs: wider(&known.inputs, &|row, column| columns[column].kw[row]),
            slopes: wider(&known.slopes, &|_, _| 0.0),
            widths: (p, m + columns.len()),
            ..known.clone()
        };
        Self { world, observations, nodes: columns.iter().map(|column| column.node).collect() }
    }

    fn structure(&self) -> &Structure {
        &self.world.fit.structure
    }

    /// The model of θ followed by β.
    fn model(&self, theta: &[Number]) -> ContinuousModel {
        let m = self.world.observations.widths.1;
        let (own, strengths) = theta.split_at(self.world.fit.maximum.theta.len());
        let structure = self.structure();
        let mut model = structure.model(own);
        let resized = |matrix: &DMatrix<Number>| matrix.clone().resize_horizontally(m + strengths.len(), real(0.0));
        model.inputs = resized(&model.inputs);
        model.initial.from_inputs = resized(&model.initial.from_inputs);
        for (column, (strength, &node)) in strengths.iter().zip(&self.nodes).enumerate() {
            let described = structure.nodes[node];
            let capacity = structure.value(own, ParameterKind::Capacity(described.zone, described.place));
            model.inputs[(node, m + column)] = *strength / capacity;
        }
        model
    }

    /// θ followed by β = 0.
    fn start(&self) -> Vec<f64> {
        self.world.fit.maximum.theta.iter().copied().chain(self.nodes.iter().map(|_| 0.0)).collect()
    }

    /// The likelihood with its derivatives by θ and by β, at β = 0.
    pub fn at_zero(&self) -> Option<Evaluation> {
        evaluate(&|theta: &[Number]| self.model(theta), &self.start(), &self.observations)
    }

    /// The best θ and β near the estimate.
    pub fn fit(&self) -> Option<Maximum> {
        let model = |theta: &[Number]| self.model(theta);
        let added = self.nodes.iter().map(|_| (-MOST_STRENGTH, MOST_STRENGTH));
        let bounds: Vec<(f64, f64)> = self.world.fit.bounds.iter().copied().chain(added).collect();
        let ascent = Ascent {
            model: &model,
            observations: &self.observations,
            bounds: &bounds,
            constraint: None,
            least_gain: LEAST_GAIN,
        };
        ascent.run(&self.start(), MOST_STEPS)
    }
}
