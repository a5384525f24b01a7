//! Traffic lights in a recording, logged when their colours change.

use interplay_scenarios::Scenario;

use super::palette::opaque;
use super::re_sdk_types::archetypes::LineStrips3D;
use super::re_sdk_types::components::Radius;
use super::{Logged, RecordedTick};
use crate::light_shapes::LightShape;
use crate::palette::Colour;

/// Height and thickness of the bar of a light, in widths of its lane.
const HEIGHT_LANES: f64 = 0.02;
const RADIUS_LANES: f64 = 0.06;

/// The traffic lights of a road.
pub struct LightLayer {
    lights: Vec<LightShape>,
    lane_m: f64,
    /// The colour that each light was logged with.
    shown: Vec<Option<Colour>>,
}

impl LightLayer {
    /// The lights of a scenario.
    pub fn begin(scenario: &Scenario) -> LightLayer {
        let lights = scenario.network.as_deref().map(LightShape::all).unwrap_or_default();
        LightLayer { shown: vec![None; lights.len()], lane_m: scenario.road.lane_width_m(), lights }
    }

    /// Logs the lights whose colour has changed.
    pub fn log_frame(&mut self, tick: &RecordedTick) -> Logged {
        for (light, shown) in self.lights.iter().zip(&mut self.shown) {
            let colour = light.colour_at(tick.frame.time_s);
            if shown.replace(colour) != Some(colour) {
                let height = (HEIGHT_LANES * self.lane_m) as f32;
                let bar = light.bar.map(|[x, y]| [x as f32, y as f32, height]);
                let radius = Radius::new_scene_units((RADIUS_LANES * self.lane_m) as f32);
                let strip = LineStrips3D::new([bar]).with_colors([opaque(colour)]).with_radii([radius]);
                tick.stream.log(format!("world/light/{}", light.lane), &strip)?;
            }
        }
        Ok(())
    }
}
