//! The optimum of a whole run, with perfect foresight of all its days, the true model, and the final temperatures of the run.
//!
//! ```text
//! cost     minimise Σ W_e (r − T)² + W_u u²                       (3.2), over all days
//! money    minimise Σ h p u/COP + ϖ P_max + c h Σ s               |r − T| ≤ band + s while occupied
//! both     x(t+1) = A x(t) + B u(t) + d(t),   x(N) = the temperatures at which the run ended
//! ```
//!
//! No controller that ends at these temperatures is cheaper, whatever it knows. The optimum of a single day
//! ([`crate::control::optimum()`]) leaves the building in any final state, so a controller that looks further ahead can be cheaper
//! than a sequence of such days. Both are problems of stages ([`crate::staged`]): their time is linear in the length of the run.

use crate::comfort::Targets;
use crate::control::{ControlError, Disturbance, money_stages};
use crate::discretise::Model;
use crate::energy::{EnergySupply, mean_size};
use crate::staged::{self, HeatInput, PlanStage, SoftBound, StageMap, StagedProgram, StagedSolution};

/// The most operations that the optimum of a run may take: some seconds.
const MAX_OPERATIONS: f64 = 3e10;
/// Operations of an iteration at a stage, in cubes of the nodes, times the number of iterations.
const OPERATIONS_PER_CUBE: f64 = 300.0;
/// Accuracy of the optimum's cost.
const TOLERANCE: f64 = 1e-7;
/// Price of discomfort in the optimum, in mean prices of a kilowatt-hour for a kelvin and hour: so high that there is none where
/// the equipment can prevent it.
const DISCOMFORT_PRICES: f64 = 100.0;
/// Cost of a kelvin by which the end differs, as a multiple of what it could save.
const END_FACTOR: f64 = 20.0;

/// The history of a run, as far as its optimum depends on it.
#[derive(Clone, Debug, Default)]
pub struct RunHistory {
    initial_c: Vec<f64>,
    days: Vec<(Targets, Disturbance)>,
    end_c: Vec<f64>,
}

/// The optimum of a whole run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunOptimum {
    /// Heat of each zone \[kW\], stacked over all days.
    pub heat_kw: Vec<f64>,
    /// Temperatures of the zones at the ends of the steps \[°C\], stacked over all days.
    pub temperatures_c: Vec<f64>,
    /// Cost J (3.2).
    pub cost: f64,
    /// What its electricity costs, with the demand charge \[currency\]; the electricity \[kWh\] without a tariff.
    pub energy_cost: f64,
    /// The part of it that is the demand charge \[currency\].
    pub demand_cost: f64,
    /// Discomfort \[K·h per zone\].
    pub discomfort_k_h: f64,
}

impl RunHistory {
    /// Adds a day that is over. `targets` are those under the actual outdoor temperature; `nodes_c` are the temperatures of all nodes at
    /// its start and at its end \[°C\].
    pub fn add(&mut self, targets: &Targets, actual: &Disturbance, [start_c, end_c]: [&[f64]; 2]) {
        if self.days.is_empty() {
            self.initial_c = start_c.to_vec();
        }
        self.days.push((Targets { tomorrow: None, ..targets.clone() }, actual.clone()));
        self.end_c = end_c.to_vec();
    }

    /// Whether the optimum takes only a few seconds.
    pub fn is_small(&self) -> bool {
        let steps: usize = self.days.iter().map(|(targets, _)| targets.steps()).sum();
        OPERATIONS_PER_CUBE * (self.initial_c.len() as f64).powi(3).max(100.0) * steps as f64 <= MAX_OPERATIONS
    }

    /// The price of the highest electric power of the run \[currency/kW\]; 0 without a demand charge.
    pub fn demand_per_kw(&self) -> f64 {
        self.days.iter().map(|(targets, _)| targets.supply.demand_per_kw).fold(0.0, f64::max)
    }

    /// The least cost J (3.2) of the whole run.
    ///
    /// # Errors
    /// [`ControlError`] if the problem is malformed or not solved.
    pub fn least_cost(&self, model: &Model) -> Result<RunOptimum, ControlError> {
        let (targets, disturbance) = self.joined();
        let limits = model.network().limits();
        let zones = (0..targets.zones).filter(|&zone| limits.heating_kw[zone] + limits.cooling_kw[zone] > 0.0);
        let inputs: Vec<HeatInput> = zones.map(|zone| HeatInput { zone, sign: 1.0 }).collect();
        let stage = |step: usize| {
            let entry = |zone: usize| step * targets.zones + zone;
            let of = |values: &[f64], sign: f64| inputs.iter().map(|input| sign * values[input.zone]).collect();
            let weighted = |zone: usize| {
                let (weight, reference_c) = (targets.error_weight[entry(zone)], targets.reference_c[entry(zone)]);
                (zone, -2.0 * weight * reference_c, 2.0 * weight)
            };
            PlanStage {
                map: 0,
                drift_k: money_stages::drift_k(model, &disturbance, step..step + 1),
                lower: of(&limits.cooling_kw, -1.0),
                upper: of(&limits.heating_kw, 1.0),
                linear: vec![0.0; inputs.len()],
                quadratic: inputs.iter().map(|input| 2.0 * targets.input_weight[entry(input.zone)]).collect(),
                nodes: (0..targets.zones).map(weighted).filter(|(_, _, weight)| *weight > 0.0).collect(),
                soft: Vec::new(),
                power: Vec::new(),
            }
        };
        let stages = (0..targets.steps()).map(stage).collect();
        let weight = targets.error_weight.iter().chain(&targets.input_weight).copied().fold(1e-9, f64::max);
        let end_price = self.end_c.iter().map(|_| END_FACTOR * 10.0 * weight).collect();
        let solution = self.solve(model, &inputs, stages, None, end_price)?;
        Ok(self.outcome(model, &targets, &inputs, &solution))
    }

    /// The least money that the run costs without discomfort, or with the least discomfort that is possible.
    ///
    /// # Errors
    /// [`ControlError`] if the problem is malformed or not solved.
    pub fn least_money(&self, model: &Model) -> Result<RunOptimum, ControlError> {
        let (targets, disturbance) = self.joined();
        let supply = &targets.supply;
        let prices = supply.price_per_kwh.clone().unwrap_or_else(|| vec![1.0]);
        let demand_per_kw = supply.demand_per_kw;
        let discomfort = money_stages::discomfort_prices(model.network(), DISCOMFORT_PRICES, mean_size(&prices));
        let margin_k = vec![0.0; targets.zones];
        let plan_prices = money_stages::Prices {
            discomfort: &discomfort,
            empty_c: money_stages::EMPTY_ROOM_C,
            emissions_per_kg: 0.0,
            margin_k: &margin_k,
            has_peak: demand_per_kw > 0.0,
        };
        let inputs = money_stages::inputs(model.network());
        let stage = |first: usize| {
            let span = money_stages::Span { map: 0, first, steps: 1 };
            money_stages::stage(model, &inputs, (&targets, &disturbance), plan_prices, span)
        };
        let stages = (0..targets.steps()).map(stage).collect();
        let dearest = prices.iter().fold(0.0, |dearest: f64, price| dearest.max(price.abs()));
        let capacities = model.network().capacities_kj_per_k().iter();
        let end_price = capacities.map(|capacity| END_FACTOR * dearest * capacity / 3600.0).collect();
        let peak = plan_prices.has_peak.then_some(staged::Peak { price: demand_per_kw, least_kw: 0.0 });
        let solution = self.solve(model, &inputs, stages, peak, end_price)?;
        Ok(self.outcome(model, &targets, &inputs, &solution))
    }

    /// Solves the problem with the end of the run; `end_price` is what a kelvin of difference costs at each node.
    fn solve(
        &self,
        model: &Model,
        inputs: &[HeatInput],
        mut stages: Vec<PlanStage>,
        peak: Option<staged::Peak>,
        end_price: Vec<f64>,
    ) -> Result<StagedSolution, ControlError> {
        if let Some(last) = stages.last_mut() {
            for (node, linear) in end_price.into_iter().enumerate() {
                for sign in [1.0, -1.0] {
                    last.soft.push(SoftBound { node, sign, bound: sign * self.end_c[node], linear, quadratic: 0.0 });
                }
            }
        }
        let (maps, initial_c) = (vec![StageMap::new(model, 1)], self.initial_c.clone());
        let program = StagedProgram { maps, inputs: inputs.to_vec(), initial_c, stages, peak };
        Ok(staged::solve(&program, TOLERANCE)?)
    }

    fn outcome(&self, model: &Model, targets: &Targets, inputs: &[HeatInput], solution: &StagedSolution) -> RunOptimum {
        let (zones, nodes) = (targets.zones, model.network().node_count());
        let mut heat_kw = vec![0.0; zones * targets.steps()];
        for (step, values) in solution.inputs.chunks_exact(inputs.len().max(1)).enumerate() {
            for (input, value) in inputs.iter().zip(values) {
                heat_kw[step * zones + input.zone] += input.sign * value;
            }
        }
        let temperatures_c: Vec<f64> =
            solution.states_c.chunks_exact(nodes).flat_map(|nodes_c| nodes_c[..zones].to_vec()).collect();
        let hours = model.step_s() / 3600.0;
        let supply = &targets.supply;
        let mut energy_cost = 0.0;
        let mut peak_kw: f64 = 0.0;
        for (step, heat_kw) in heat_kw.chunks_exact(zones).enumerate() {
            let electric_kw: f64 = heat_kw.iter().map(|kw| supply.electric_kw(step, *kw)).sum();
            energy_cost += supply.money(step, hours * electric_kw).unwrap_or(hours * electric_kw);
            peak_kw = peak_kw.max(electric_kw);
        }
        let beyond_k: f64 = temperatures_c.iter().enumerate().map(|(i, t)| targets.beyond_k(i, *t)).sum();
        RunOptimum {
            cost: targets.cost(&temperatures_c, &heat_kw),
            energy_cost: energy_cost + supply.demand_per_kw * peak_kw,
            demand_cost: supply.demand_per_kw * peak_kw,
            discomfort_k_h: hours * beyond_k / zones as f64,
            heat_kw,
            temperatures_c,
        }
    }

    /// Targets and disturbances of all days as those of one.
    fn joined(&self) -> (Targets, Disturbance) {
        let all = |of: fn(&Targets) -> &[f64]| -> Vec<f64> {
            self.days.iter().flat_map(|(targets, _)| of(targets).to_vec()).collect()
        };
        let supplies = || self.days.iter().map(|(targets, _)| &targets.supply);
        let joined = |of: fn(&EnergySupply) -> &Option<Vec<f64>>| -> Option<Vec<f64>> {
            Some(supplies().map(|supply| of(supply).clone()).collect::<Option<Vec<_>>>()?.concat())
        };
        let supply = EnergySupply {
            price_per_kwh: joined(|supply| &supply.price_per_kwh),
            emissions_kg_per_kwh: joined(|supply| &supply.emissions_kg_per_kwh),
            demand_per_kw: supplies().map(|supply| supply.demand_per_kw).fold(0.0, f64::max),
            heat_pump: supplies().next().and_then(|supply| supply.heat_pump.clone()),
            outdoor_c: self.days.iter().flat_map(|(_, actual)| actual.ambient_c.clone()).collect(),
            price_weight: Vec::new(),
        };
        let targets = Targets {
            zones: self.days.first().map_or(0, |(targets, _)| targets.zones),
            reference_c: all(|targets| &targets.reference_c),
            error_weight: all(|targets| &targets.error_weight),
            occupied: self.days.iter().flat_map(|(targets, _)| targets.occupied.clone()).collect(),
            input_weight: all(|targets| &targets.input_weight),
            band_k: all(|targets| &targets.band_k),
            supply,
            tomorrow: None,
        };
        let disturbance = Disturbance {
            ambient_c: targets.supply.outdoor_c.clone(),
            gains_kw: self.days.iter().flat_map(|(_, actual)| actual.gains_kw.clone()).collect(),
        };
        (targets, disturbance)
    }
}
