//! Observation and control of the zones of a building from outside.

use super::Simulation;
use crate::climate::{Building, Node, Temperature};
use crate::measure::BuildingMeasures;
use crate::simulation::run_error::RunError;

/// A zone of a building before its next step.
#[derive(Clone, Debug, PartialEq)]
pub struct ZoneNow {
    /// Its name.
    pub name: String,
    /// Its temperature \[°C\].
    pub temperature_c: f64,
    /// The target temperature; none if it is free \[°C\].
    pub reference_c: Option<f64>,
    /// Half-width of the comfort band; none while the zone is unoccupied \[K\].
    pub band_k: Option<f64>,
    /// Maximum heating power of its equipment \[kW\].
    pub heating_kw: f64,
    /// Maximum cooling power of its equipment, at least 0 \[kW\].
    pub cooling_kw: f64,
}

impl Simulation {
    /// The present zones of the building, with the targets of the next step; none without a building.
    pub fn zones(&self) -> Vec<ZoneNow> {
        let (Some(building), Some(measures)) =
            (self.world.get_resource::<Building>(), self.world.get_resource::<BuildingMeasures>())
        else {
            return Vec::new();
        };
        let (day, step) = building.date();
        let targets = building.agenda.of_day(day);
        let limits = building.model.network().limits();
        let (reference_c, band_k) = (targets.reference_at(step), targets.band_at(step));
        let temperatures_c = self.node_temperatures_c();
        let zone = |(index, name): (usize, &String)| ZoneNow {
            name: name.clone(),
            temperature_c: temperatures_c.get(index).copied().unwrap_or(f64::NAN),
            reference_c: Some(reference_c[index]).filter(|_| targets.weight_at(step)[index] > 0.0),
            band_k: band_k[index],
            heating_kw: limits.heating_kw[index],
            cooling_kw: limits.cooling_kw[index],
        };
        measures.zone_names.iter().enumerate().map(zone).collect()
    }

    /// The temperatures of all nodes, zones first \[°C\].
    fn node_temperatures_c(&self) -> Vec<f64> {
        let Some(mut nodes) = self.world.try_query::<(&Node, &Temperature)>() else { return Vec::new() };
        let mut found: Vec<(usize, f64)> =
            nodes.iter(&self.world).map(|(node, temperature)| (node.index, temperature.0)).collect();
        found.sort_by_key(|(index, _)| *index);
        found.into_iter().map(|(_, temperature_c)| temperature_c).collect()
    }

    /// Sets the heat of every zone for the next step of the building, negative for cooling \[kW\], instead of the scenario's
    /// controller. Heat is limited by the equipment. The last call before a step counts.
    ///
    /// # Errors
    /// [`RunError::NoBuilding`]; [`RunError::WrongHeats`]; [`RunError::NotFinite`].
    pub fn apply_heats(&mut self, heat_kw: &[f64]) -> Result<(), RunError> {
        const WHO: &str = "the building";
        let Some(mut building) = self.world.get_resource_mut::<Building>() else { return Err(RunError::NoBuilding) };
        let zones = building.targets.zones;
        if heat_kw.len() != zones {
            return Err(RunError::WrongHeats { found: heat_kw.len(), zones });
        }
        if !heat_kw.iter().all(|heat_kw| heat_kw.is_finite()) {
            return Err(RunError::NotFinite { vehicle: WHO.to_owned() });
        }
        building.handed_in_kw = Some(heat_kw.to_vec());
        // A snapshot as text repeats only inputs of vehicles.
        if !self.course.replaced.iter().any(|replaced| replaced == WHO) {
            self.course.replaced.push(WHO.to_owned());
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::Simulation;

    /// Heat from outside acts on the zones, limited by their equipment.
    #[test]
    fn heat_set_by_the_caller_is_limited_by_the_equipment() {
        let scenario = interplay_scenarios::load("building/four-room-pid", &[]).expect("authored");
        let temperature_after = |heat: f64| {
            let mut world = Simulation::new(&scenario).expect("a world");
            let zones = world.zones();
            let heat_kw: Vec<f64> = zones.iter().map(|zone| heat * zone.heating_kw).collect();
            for _ in 0..12 {
                world.apply_heats(&heat_kw).expect("as many heats as zones");
                world.step().expect("a step");
            }
            let frame = world.frame().and_then(|frame| frame.building.clone()).expect("a building");
            assert!(frame.zones.iter().zip(&zones).all(|(now, zone)| now.heat_kw <= zone.heating_kw));
            world.zones()[0].temperature_c
        };
        assert!(temperature_after(1.0) > temperature_after(0.0) + 0.1);
        assert_eq!(temperature_after(1.0).to_bits(), temperature_after(50.0).to_bits());
        let mut world = Simulation::new(&scenario).expect("a world");
        assert!(world.apply_heats(&[f64::NAN; 1]).is_err());
        assert!(
            Simulation::new(&interplay_scenarios::load("lane-change/front-nice", &[]).expect("authored"))
                .expect("a world")
                .apply_heats(&[])
                .is_err()
        );
    }
}
