//! The designs of the controller: learned bias, feedback, convergence, and the exchange between zones.
//!
//! ```text
//! building/learned/<n>                        learned heat beyond the forecast
//! building/feedback/gain/<n>/{own,others}     K: heat of a zone for its own error, and summed for those of the others
//! building/feedback/tap/<l>                   Q: heat of a zone l steps after its own deviation; mean of the zones
//! building/convergence/{spectral-radius,largest-singular-value,one}
//! building/exchange/cost                      log₁₀ J before the first round and after each, of the first exchange
//! building/exchange/messages                  messages that each zone has sent
//! ```

use std::collections::BTreeSet;

use interplay_building::control::{Design, Exchange};
use interplay_simulation::frame::BuildingFrame;
use rerun::{RecordingStream, RecordingStreamResult};

use super::super::Logged;
use super::super::palette::{self, FAILURE, NEUTRAL};
use super::super::re_sdk_types::archetypes::{BarChart, Scalars};
use super::super::re_sdk_types::components::TensorData;
use super::super::re_sdk_types::datatypes;
use super::series::style;

/// Path of the learned bias.
pub const LEARNED: &str = "building/learned";
/// Path of the feedback gain K.
pub const GAIN: &str = "building/feedback/gain";
/// Path of the taps of the filter Q.
pub const TAPS: &str = "building/feedback/tap";
/// Path of spectral radius and largest singular value.
pub const CONVERGENCE: &str = "building/convergence";
/// Path of the cost J by round.
pub const COST: &str = "building/exchange/cost";
/// Path of the messages by zone.
pub const MESSAGES: &str = "building/exchange/messages";

/// Logs the designs of a controller.
#[derive(Default)]
pub struct DesignPlots {
    /// Whether this controller makes plans.
    learns: bool,
    design: Design,
    /// Messages sent so far, by zone.
    messages: Vec<usize>,
    /// The plots that have data.
    seen: BTreeSet<&'static str>,
}

impl DesignPlots {
    /// Logs names and colours; `learns` tells whether this controller makes plans.
    pub fn begin(
        stream: &RecordingStream,
        names: &[String],
        shown: &[usize],
        learns: bool,
    ) -> RecordingStreamResult<DesignPlots> {
        if !learns {
            return Ok(DesignPlots::default());
        }
        for (place, &index) in shown.iter().enumerate() {
            let (series_colour, name) = (palette::zone(place), &names[index]);
            style(stream, &indexed(LEARNED, index), name, series_colour.solid(), 1.5)?;
            style(stream, &(indexed(GAIN, index) + "/own"), &format!("{name}: own error"), series_colour.solid(), 2.0)?;
            style(
                stream,
                &(indexed(GAIN, index) + "/others"),
                &format!("{name}: others'"),
                series_colour.translucent(130),
                1.5,
            )?;
        }
        for (name, words, series_colour) in [
            ("one", "limit of convergence", FAILURE),
            ("spectral-radius", "spectral radius", palette::series(0)),
            ("largest-singular-value", "largest singular value", NEUTRAL),
        ] {
            style(stream, &format!("{CONVERGENCE}/{name}"), words, series_colour.solid(), 1.5)?;
        }
        Ok(DesignPlots { learns, ..DesignPlots::default() })
    }

    /// Whether the plot `part` has data.
    pub fn has(&self, part: &str) -> bool {
        self.seen.contains(part)
    }

    pub fn step(&mut self, stream: &RecordingStream, shown: &[usize], frame: &BuildingFrame) -> Logged {
        if !self.learns {
            return Ok(());
        }
        if let Some(design) = &frame.design {
            self.design = (**design).clone();
            self.note_design(stream)?;
            if let Some(exchange) = &design.exchange {
                self.exchange(stream, exchange)?;
            }
        }
        for &index in shown {
            // On the first day nothing is learned yet.
            let bias_kw = self.design.bias_kw.get(frame.step * frame.zones.len() + index).copied().unwrap_or(0.0);
            stream.log(indexed(LEARNED, index), &Scalars::single(bias_kw))?;
        }
        self.feedback(stream, shown)?;
        self.convergence(stream)
    }

    /// Notes which plots a new design has data for, and logs the names and colours of its taps.
    fn note_design(&mut self, stream: &RecordingStream) -> Logged {
        let Design { gain_kw_per_k, taps_kw_per_k, spectral_radius, .. } = &self.design;
        self.seen.insert(LEARNED);
        self.seen.extend((!gain_kw_per_k.is_empty()).then_some(GAIN));
        self.seen.extend(spectral_radius.map(|_| CONVERGENCE));
        if !taps_kw_per_k.is_empty() && self.seen.insert(TAPS) {
            for delay in 0..taps_kw_per_k.len() {
                let words = format!("after {delay} steps");
                style(stream, &indexed(TAPS, delay), &words, palette::series(delay).solid(), 1.5)?;
            }
        }
        Ok(())
    }

    fn feedback(&self, stream: &RecordingStream, shown: &[usize]) -> Logged {
        let Design { gain_kw_per_k, taps_kw_per_k, .. } = &self.design;
        for (index, row) in shown.iter().filter_map(|&index| Some((index, gain_kw_per_k.get(index)?))) {
            let own = row[index];
            let others = row.iter().sum::<f64>() - own;
            stream.log(indexed(GAIN, index) + "/own", &Scalars::single(own))?;
            stream.log(indexed(GAIN, index) + "/others", &Scalars::single(others))?;
        }
        for (delay, tap) in taps_kw_per_k.iter().enumerate() {
            let own = tap.iter().enumerate().map(|(zone, row)| row[zone]).sum::<f64>() / tap.len() as f64;
            stream.log(indexed(TAPS, delay), &Scalars::single(own))?;
        }
        Ok(())
    }

    fn convergence(&self, stream: &RecordingStream) -> Logged {
        let log = |name: &str, value: f64| stream.log(format!("{CONVERGENCE}/{name}"), &Scalars::single(value));
        if let Some(radius) = self.design.spectral_radius {
            log("one", 1.0)?;
            log("spectral-radius", radius)?;
        }
        self.design.largest_singular_value.map_or(Ok(()), |value| log("largest-singular-value", value))
    }

    fn exchange(&mut self, stream: &RecordingStream, exchange: &Exchange) -> Logged {
        if self.seen.insert(COST) {
            let logarithms = exchange.costs.iter().map(|cost| cost.log10()).collect();
            stream.log_static(COST, &bars(logarithms).with_color(palette::series(1).solid()))?;
        }
        self.seen.insert(MESSAGES);
        self.messages.resize(exchange.messages.len(), 0);
        for (all, today) in self.messages.iter_mut().zip(&exchange.messages) {
            *all += today;
        }
        let counts = self.messages.iter().map(|&count| count as f64).collect();
        stream.log_static(MESSAGES, &bars(counts).with_color(palette::series(0).solid()))
    }
}

/// The path of a part for a zone or a delay.
fn indexed(part: &str, index: usize) -> String {
    format!("{part}/{}", index + 1)
}

fn bars(values: Vec<f64>) -> BarChart {
    let buffer = datatypes::TensorBuffer::F64(values.clone().into());
    BarChart::new(TensorData(datatypes::TensorData::new(vec![values.len() as u64], buffer)))
}
