//! The file `plant.txt`, which the shared library reads (format in `library/plant.rs`).

use std::fmt::{Display, Write};

use interplay_building::day::Surroundings;
use interplay_building::discretise::Model;

/// Weather and heat gains over a run, stacked over all steps.
#[derive(Clone, Debug)]
pub(crate) struct OutsideSeries {
    /// Outdoor temperature T₀ of each step \[°C\].
    pub ambient_c: Vec<f64>,
    /// Heat w of people, sun and machines, one number per step and heated node \[kW\].
    pub gains_kw: Vec<f64>,
}

impl OutsideSeries {
    /// Collects the actual values of all days.
    pub(crate) fn collect(surroundings: &Surroundings, model: &Model, steps_per_day: usize, days: usize) -> Self {
        let actual = (0..days).map(|day| surroundings.actual(model, steps_per_day, day));
        let mut all = Self { ambient_c: Vec::new(), gains_kw: Vec::new() };
        for day in actual {
            all.ambient_c.extend(day.ambient_c);
            all.gains_kw.extend(day.gains_kw);
        }
        all
    }
}

/// The content of the file without its GUID.
pub(crate) fn plant_text(model: &Model, initial_c: f64, outside: &OutsideSeries) -> String {
    let network = model.network();
    let (nodes, zones) = (network.node_count(), network.zone_count());
    let (state, gain) = (model.state_matrix(), model.disturbance_matrix());
    let mut text = String::new();
    row(&mut text, "step_s", [model.step_s()]);
    row(&mut text, "nodes", [nodes]);
    row(&mut text, "zones", [zones]);
    row(&mut text, "gained", [network.gain_count()]);
    row(&mut text, "steps", [outside.ambient_c.len()]);
    row(&mut text, "initial_c", vec![initial_c; nodes]);
    row(&mut text, "state", state.row_iter().flat_map(|row| row.iter().copied().collect::<Vec<f64>>()));
    row(&mut text, "gain", gain.row_iter().flat_map(|row| row.iter().copied().collect::<Vec<f64>>()));
    row(&mut text, "outdoor", model.gain_product(network.ambient_kw_per_k()));
    row(&mut text, "ambient_c", &outside.ambient_c);
    row(&mut text, "gains_kw", &outside.gains_kw);
    text
}

/// Writes a line of a word and numbers, which round-trip exactly.
fn row<T: Display>(text: &mut String, word: &str, numbers: impl IntoIterator<Item = T>) {
    text.push_str(word);
    for number in numbers {
        // Writing to a text cannot fail.
        let _ = write!(text, " {number}");
    }
    text.push('\n');
}
