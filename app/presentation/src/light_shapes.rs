//! Traffic lights as they are drawn: a bar across the lane at its end, in the colour that the light shows.

use std::sync::Arc;

use interplay_planners::road::network::{LightColour, LightCycle, RoadNetwork};

use crate::palette::{Colour, VERMILLION};

const RED: Colour = VERMILLION.rgb;
const AMBER: Colour = [0xF5, 0xB8, 0x2E];
const GREEN: Colour = [0x3D, 0xD6, 0x8C];
const OFF: Colour = [0x70, 0x74, 0x7A];

/// The light at the end of a lane.
#[derive(Clone, Debug, PartialEq)]
pub struct LightShape {
    /// The name of the lane.
    pub lane: String,
    /// The ends of the bar, on the right and on the left of the lane \[m\].
    pub bar: [[f64; 2]; 2],
    /// Its colours over time.
    pub cycle: Arc<LightCycle>,
}

impl LightShape {
    /// The lights of a network.
    pub fn all(network: &RoadNetwork) -> Vec<LightShape> {
        let lit = network.lanes().iter().filter_map(|lane| Some((lane, lane.light.as_ref()?)));
        let shape = |(lane, cycle): (&interplay_planners::road::network::Lane, &Arc<LightCycle>)| {
            let end_m = lane.centre.length_m();
            let half_m = lane.half_width_m(end_m);
            let bar = [-half_m, half_m].map(|across_m| lane.centre.position(end_m, across_m));
            LightShape { lane: lane.name.clone(), bar, cycle: Arc::clone(cycle) }
        };
        lit.map(shape).collect()
    }

    /// The colour at a time \[s\].
    pub fn colour_at(&self, time_s: f64) -> Colour {
        match self.cycle.colour_at(time_s) {
            LightColour::Red => RED,
            LightColour::RedAmber | LightColour::Amber => AMBER,
            LightColour::Green => GREEN,
            LightColour::Off => OFF,
        }
    }
}
