//! The electricity that the heat of a day takes, and its cost.

use super::HeatPump;

/// Prices and outdoor temperatures of the steps of a day, with the equipment that turns electricity into heat.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EnergySupply {
    /// The price of electricity in each step \[currency/kWh\]; none without a tariff.
    pub price_per_kwh: Option<Vec<f64>>,
    /// Emissions of electricity in each step \[kg/kWh\]; none where the tariff does not state them.
    pub emissions_kg_per_kwh: Option<Vec<f64>>,
    /// What the highest electric power of the run costs \[currency/kW\]; 0 without a demand charge.
    pub demand_per_kw: f64,
    /// The heat pump; without it a kilowatt of heat takes a kilowatt of electricity.
    pub heat_pump: Option<HeatPump>,
    /// The outdoor temperature of each step \[°C\]; empty as long as it is not known.
    pub outdoor_c: Vec<f64>,
    /// Weights W_u with the prices and without the heat pump, stacked; empty without a heat pump, and where energy has
    /// no weight.
    pub price_weight: Vec<f64>,
}

impl EnergySupply {
    /// Electric power of the equipment that adds `heat_kw` to a zone or, if negative, removes it \[kW\].
    pub fn electric_kw(&self, step: usize, heat_kw: f64) -> f64 {
        match (&self.heat_pump, self.outdoor_c.get(step)) {
            (Some(heat_pump), Some(outdoor_c)) => heat_kw.abs() / heat_pump.cop(heat_kw > 0.0, *outdoor_c),
            _ => heat_kw.abs(),
        }
    }

    /// The cost of `electric_kwh` in a step \[currency\]; `None` without a tariff.
    pub fn money(&self, step: usize, electric_kwh: f64) -> Option<f64> {
        Some(self.price_per_kwh.as_ref()?.get(step)? * electric_kwh)
    }

    /// How much more than on average a kilowatt of heat counts in a plan, by the COP alone. A zone is expected to be heated
    /// where it is colder outdoors than wanted, and cooled where it is not.
    pub(crate) fn cop_weight(&self, wanted_c: f64, outdoor_c: f64) -> f64 {
        self.heat_pump.as_ref().map_or(1.0, |heat_pump| heat_pump.relative(outdoor_c < wanted_c, outdoor_c))
    }
}
