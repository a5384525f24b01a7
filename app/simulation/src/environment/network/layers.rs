//! A network of dense layers: sums in a fixed order, and functions that are the same on every processor.

use serde::de::DeserializeOwned;
use xxhash_rust::xxh3::xxh3_128;

use super::super::{Action, ActionSpace, AgentView, Policy, PolicyError};
use super::tensors::{Tensor, TensorFile};

/// Largest number of layers.
const MAX_LAYERS: usize = 16;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Activation {
    Linear,
    Tanh,
    Relu,
}

impl Activation {
    fn named(word: &str) -> Option<Activation> {
        match word {
            "linear" => Some(Activation::Linear),
            "tanh" => Some(Activation::Tanh),
            "relu" => Some(Activation::Relu),
            _ => None,
        }
    }

    fn of(self, value: f64) -> f64 {
        match self {
            Activation::Linear => value,
            Activation::Tanh => libm::tanh(value),
            Activation::Relu => value.max(0.0),
        }
    }
}

#[derive(Clone, Debug)]
struct Layer {
    /// Row by row: the weights of all inputs of each output.
    weights: Vec<f32>,
    bias: Vec<f32>,
    activation: Activation,
}

impl Layer {
    fn inputs(&self) -> usize {
        self.weights.len() / self.bias.len()
    }

    /// Bias first, then one product after the other in the order of the inputs, in 64 bits.
    fn of(&self, inputs: &[f64]) -> Vec<f64> {
        let rows = self.weights.chunks_exact(inputs.len()).zip(&self.bias);
        let sum = |(row, bias): (&[f32], &f32)| {
            let products = row.iter().zip(inputs);
            products.fold(f64::from(*bias), |sum, (weight, input)| sum + f64::from(*weight) * input)
        };
        rows.map(|row| self.activation.of(sum(row))).collect()
    }
}

/// A trained network, with what it sees and decides.
#[derive(Clone, Debug)]
pub(super) struct Network {
    pub observations: Vec<AgentView>,
    pub action: Action,
    pub decision_s: Option<f64>,
    /// Digest of the file.
    pub digest: String,
    layers: Vec<Layer>,
    /// The function of the numbers of an action.
    output: Activation,
}

impl Network {
    /// The network of the bytes of a file; or what is wrong with them.
    pub fn parse(bytes: &[u8]) -> Result<Network, String> {
        let mut file = TensorFile::parse(bytes)?;
        let observations: Vec<AgentView> = stated(&file, "observations")?.ok_or("does not state its `observations`")?;
        let action = stated(&file, "action")?.ok_or("does not state its `action`")?;
        if let Some(fault) = observations.iter().find_map(AgentView::fault) {
            return Err(format!("states `observations` of which {fault}"));
        }
        let [hidden, output] = [("activation", "tanh"), ("output", "linear")].map(|(key, usual)| {
            let word = file.metadata.get(key).map_or(usual, String::as_str);
            Activation::named(word).ok_or(format!("states {key} `{word}`; choose from tanh, relu, linear"))
        });
        let (hidden, output) = (hidden?, output?);
        let layers = layers(&mut file, hidden)?;
        if let Some(unknown) = file.tensors.keys().next() {
            return Err(format!(
                "has a tensor `{unknown}`; layers are called `layers.0.weight`, `layers.0.bias` and so on"
            ));
        }
        let decision_s = stated(&file, "decision_s")?;
        let digest = format!("{:032x}", xxh3_128(bytes));
        Ok(Network { observations, action, decision_s, digest, layers, output })
    }

    /// The fault of the network for observations and actions of these lengths, if there is one.
    pub fn misfit(&self, observation_len: usize, action: ActionSpace) -> Option<String> {
        let outputs = match action {
            ActionSpace::OneOf(count) => count,
            ActionSpace::Rows(_) => action.len(),
        };
        let inputs = self.inputs();
        let found = self.layers.last().map_or(0, |layer| layer.bias.len());
        if inputs != observation_len {
            return Some(format!("has {inputs} inputs, and its observations {observation_len} numbers"));
        }
        (found != outputs).then(|| format!("has {found} outputs, and its actions need {outputs}"))
    }

    /// Number of numbers of an observation.
    pub fn inputs(&self) -> usize {
        self.layers[0].inputs()
    }

    /// The outputs of the last layer for an observation.
    pub fn outputs(&self, observation: &[f32]) -> Vec<f64> {
        let inputs: Vec<f64> = observation.iter().copied().map(f64::from).collect();
        self.layers.iter().fold(inputs, |inputs, layer| layer.of(&inputs))
    }

    /// The most probable action for an observation.
    pub fn action_for(&self, observation: &[f32]) -> Vec<f32> {
        let outputs = self.outputs(observation);
        if self.action != Action::DiscreteMeta {
            return outputs.into_iter().map(|mean| self.output.of(mean) as f32).collect();
        }
        let better = |best: usize, (place, value): (usize, &f64)| if *value > outputs[best] { place } else { best };
        vec![outputs.iter().enumerate().fold(0, better) as f32]
    }
}

impl Policy for Network {
    fn act(&self, observation: &[f32]) -> Result<Vec<f32>, PolicyError> {
        Ok(self.action_for(observation))
    }
}

/// What a file states under a key: JSON, or a word.
fn stated<T: DeserializeOwned>(file: &TensorFile, key: &str) -> Result<Option<T>, String> {
    let Some(text) = file.metadata.get(key) else { return Ok(None) };
    let json = serde_json::from_str(text).unwrap_or_else(|_| serde_json::Value::from(text.as_str()));
    serde_json::from_value(json).map(Some).map_err(|error| format!("states `{key}` that cannot be read: {error}"))
}

fn layers(file: &mut TensorFile, hidden: Activation) -> Result<Vec<Layer>, String> {
    let mut layers: Vec<Layer> = Vec::new();
    while let Some(weight) = file.tensors.remove(&format!("layers.{}.weight", layers.len())) {
        let name = format!("layers.{}", layers.len());
        let Tensor { numbers: weights, shape } = weight;
        let bias = file.tensors.remove(&format!("{name}.bias")).ok_or(format!("has no tensor `{name}.bias`"))?.numbers;
        let [rows, columns] = shape[..] else { return Err(format!("has `{name}.weight` with {} axes", shape.len())) };
        let before = layers.last().map_or(columns, |layer| layer.bias.len());
        if rows == 0 || columns == 0 || rows != bias.len() || columns != before {
            return Err(format!(
                "has `{name}.weight` of the shape {rows} × {columns}, which does not fit the layers beside it"
            ));
        }
        layers.push(Layer { weights, bias, activation: hidden });
    }
    match layers.last_mut() {
        Some(last) => last.activation = Activation::Linear,
        None => return Err("has no tensor `layers.0.weight`".to_owned()),
    }
    if layers.len() > MAX_LAYERS { Err(format!("has more than {MAX_LAYERS} layers")) } else { Ok(layers) }
}
