//! Economic model predictive control: at every step the plan that costs the least money within the comfort band.
//!
//! ```text
//! minimise    Σ h p(t) (u⁺/COP_h + u⁻/COP_c) + c h Σ s + ϖ P_max − πᵀx(N)         over the next hours
//! subject to  x(t+1) = A x(t) + B (u⁺ − u⁻ + w + d) + B k T₀,   limits of u⁺ and u⁻,   |r − T| ≤ band − margin + s
//! ```
//!
//! (Rawlings, Mayne and Diehl, *Model Predictive Control*, 2017, section 2.8.) `p` is the price of electricity with that of its
//! emissions, `P_max` the highest electric power of the run, whose price ϖ is the demand charge. The state is estimated by a Kalman
//! filter (`kalman`), the disturbance is the forecast with what was learned of its errors (`learned`).
//!
//! π is the value of the heat that remains at the end of the horizon. It is the multiplier of the state at the start of
//! the last plan, so that heat a day ahead is worth as much as heat now. Without it, every plan would end with a cold
//! building. It is limited to the highest price of heat in the horizon.
//!
//! The margin follows from what predictions of the next step missed (`spread`): errors further ahead are corrected by later plans. Prices
//! of discomfort are multiples of those of energy, so that plans do not depend on the currency.
//!
//! Learns the heat that the forecast misses at the same hour of every day.
//!
//! ```text
//! m ← (1 − λ) m + λ d_k          mean of the missed heat of a step and zone
//! v ← (1 − λ) (v + λ (d_k − m)²) its variance from day to day
//! bias = m · m² / (m² + v λ/(2 − λ))
//! ```
//!
//! A mean that is small compared with its own uncertainty `v λ/(2 − λ)` is not trusted: an error that does not repeat
//! is not expected again.

mod kalman;
mod settings;
mod spread;

pub use settings::EconomicSettings;

use super::interface::ControllerKind;
use super::money_stages::{Prices, Span, discomfort_prices, energy_price, inputs, stage};
use super::optimum::check_size;
use super::planning::RecedingPlan;
use super::{Control, ControlError, DayAhead, DayRecord, Design, Disturbance, Observation};
use crate::comfort::Targets;
use crate::discretise::Model;
use crate::energy::mean_size;
use crate::staged::{HeatInput, Peak, StageMap, StagedProgram, solve};
use kalman::Kalman;

/// Accuracy of a plan: its cost is that of the cheapest to this share.
const PLAN_TOLERANCE: f64 = 1e-5;
/// Price of discomfort, in what a zone loses for a kelvin.
const DISCOMFORT_FACTOR: f64 = 25.0;
/// The margin, in standard deviations of what predictions of the next step miss.
const MARGIN_DEVIATIONS: f64 = 2.0;

/// An economic model predictive controller with its estimates.
#[derive(Clone, Debug)]
pub struct Economic {
    settings: EconomicSettings,
    model: Model,
    inputs: Vec<HeatInput>,
    /// Maps of stages of 1, 2, … steps, as far as plans have them.
    maps: Vec<StageMap>,
    filter: Kalman,
    learned: LearnedForecast,
    /// The forecast of today and of the next day.
    forecast: Disturbance,
    steps: usize,
    /// π \[currency/K\], of each node.
    end_value: Vec<f64>,
    /// The highest electric power so far \[kW\].
    peak_kw: f64,
    plan: RecedingPlan,
}

impl Economic {
    /// A controller before its first day of `steps` steps.
    ///
    /// # Errors
    /// [`ControlError::Setting`], and [`ControlError::TooLarge`] for an exact model without matrices.
    pub fn new(settings: EconomicSettings, model: &Model, steps: usize) -> Result<Self, ControlError> {
        settings.check()?;
        check_size(model)?;
        let network = model.network();
        let longest = settings.spans(0, model.step_s()).into_iter().max().unwrap_or(1);
        let rate = if settings.learn_forecast { settings.learning_rate } else { 0.0 };
        Ok(Self {
            settings,
            inputs: inputs(network),
            maps: (1..=longest).map(|span| StageMap::new(model, span)).collect(),
            filter: Kalman::new(model, &settings, steps),
            learned: LearnedForecast::new(steps * network.zone_count(), rate),
            forecast: Disturbance { ambient_c: Vec::new(), gains_kw: Vec::new() },
            steps,
            end_value: vec![0.0; network.node_count()],
            peak_kw: 0.0,
            plan: RecedingPlan::default(),
            model: model.clone(),
        })
    }

    /// Plans from step `step` of the day on: heat of each zone in each step of the horizon \[kW\], stacked.
    fn plan(&mut self, step: usize, targets: &Targets) -> Result<Vec<f64>, ControlError> {
        ControlError::check_finite("the temperatures", &self.filter.nodes_c)?;
        let horizon = self.settings.horizon(self.model.step_s());
        let expected = self.expected(step, horizon);
        expected.check_finite()?;
        let mut ahead = targets.ahead(step, horizon);
        ahead.supply = targets.supply_ahead(step, horizon);
        if self.inputs.is_empty() {
            return Ok(vec![0.0; horizon * targets.zones]);
        }
        let spans = self.settings.spans(step, self.model.step_s());
        let program = self.program(&ahead, &expected, &spans);
        let solution = solve(&program, PLAN_TOLERANCE)?;
        self.value_end(&solution.initial_value, &ahead, &expected);
        let mut heat_kw = Vec::with_capacity(horizon * targets.zones);
        for (span, values) in spans.iter().zip(solution.inputs.chunks_exact(self.inputs.len())) {
            let mut zones_kw = vec![0.0; targets.zones];
            for (input, value) in self.inputs.iter().zip(values) {
                zones_kw[input.zone] += input.sign * value;
            }
            (0..*span).for_each(|_| heat_kw.extend_from_slice(&zones_kw));
        }
        Ok(heat_kw)
    }

    /// The problem of a plan.
    fn program(&self, ahead: &Targets, expected: &Disturbance, spans: &[usize]) -> StagedProgram {
        let demand_per_kw = ahead.supply.demand_per_kw;
        let (discomfort, margin_k) = (self.discomfort(ahead), self.margin_k());
        let prices = Prices {
            discomfort: &discomfort,
            empty_c: (self.settings.frost_c, self.settings.overheating_c),
            emissions_per_kg: self.settings.emission_price_per_kg,
            margin_k: &margin_k,
            has_peak: demand_per_kw > 0.0,
        };
        let mut first = 0;
        let mut stages = Vec::with_capacity(spans.len());
        for &steps in spans {
            let span = Span { map: steps - 1, first, steps };
            stages.push(stage(&self.model, &self.inputs, (ahead, expected), prices, span));
            first += steps;
        }
        if let Some(last) = stages.last_mut() {
            last.nodes = self.end_value.iter().enumerate().map(|(node, value)| (node, *value, 0.0)).collect();
        }
        StagedProgram {
            maps: self.maps.clone(),
            inputs: self.inputs.clone(),
            initial_c: self.filter.nodes_c.clone(),
            stages,
            peak: prices.has_peak.then_some(Peak { price: demand_per_kw, least_kw: self.peak_kw }),
        }
    }

    /// Price of a kelvin beyond the band for an hour, of each zone.
    fn discomfort(&self, ahead: &Targets) -> Vec<f64> {
        if let Some(price) = self.settings.discomfort_price {
            return vec![price; ahead.zones];
        }
        let emission_price = self.settings.emission_price_per_kg;
        let prices: Vec<f64> =
            (0..ahead.steps()).map(|step| energy_price(&ahead.supply, step, emission_price)).collect();
        discomfort_prices(self.model.network(), DISCOMFORT_FACTOR, mean_size(&prices))
    }

    /// How far plans stay within the band \[K\], of each zone.
    fn margin_k(&self) -> Vec<f64> {
        let deviations_k = self.filter.spread.deviations_k();
        match self.settings.margin_k {
            Some(margin_k) => vec![margin_k; deviations_k.len()],
            None => deviations_k.iter().map(|deviation_k| MARGIN_DEVIATIONS * deviation_k).collect(),
        }
    }

    /// π from the multiplier of the state at the start of a plan, within the dearest price of heat.
    fn value_end(&mut self, initial_value: &[f64], ahead: &Targets, expected: &Disturbance) {
        let price = |heats: bool| -> f64 {
            let of_step = |step: usize| {
                let cop = ahead.supply.heat_pump.as_ref().map_or(1.0, |pump| pump.cop(heats, expected.ambient_c[step]));
                energy_price(&ahead.supply, step, self.settings.emission_price_per_kg) / cop
            };
            (0..expected.ambient_c.len()).map(of_step).fold(0.0, f64::max)
        };
        let (heating, cooling) = (price(true), price(false));
        let capacities = self.model.network().capacities_kj_per_k().iter();
        let bounded = initial_value.iter().zip(capacities).map(|(value, capacity_kj_per_k)| {
            let kwh_per_k = capacity_kj_per_k / 3600.0;
            if value.is_finite() { value.clamp(-heating * kwh_per_k, cooling * kwh_per_k) } else { 0.0 }
        });
        self.end_value = bounded.collect();
    }

    /// What is expected over the horizon: the forecast, what was learned of it, and the missed heat, which dies out.
    fn expected(&self, step: usize, horizon: usize) -> Disturbance {
        let (known, zones) = (self.forecast.ambient_c.len(), self.filter.missed_kw.len());
        // Beyond the known steps, the last day repeats.
        let known_step = |t: usize| if t < known { t } else { known - self.steps + t % self.steps };
        let mut gains = Vec::with_capacity(horizon * self.model.network().gain_count());
        for t in step..step + horizon {
            let mut row = self.gains_kw(known_step(t)).to_vec();
            let left = self.filter.left_after(t - step);
            let bias = self.learned.bias_kw(t % self.steps, zones).zip(&self.filter.missed_kw);
            row.iter_mut().zip(bias).for_each(|(gain, (bias, missed))| *gain += bias + left * missed);
            gains.extend(row);
        }
        let ambient_c = (step..step + horizon).map(|t| self.forecast.ambient_c[known_step(t)]).collect();
        Disturbance { ambient_c, gains_kw: gains }
    }

    /// Forecast gains of the nodes in a step from midnight on \[kW\].
    fn gains_kw(&self, t: usize) -> &[f64] {
        let count = self.model.network().gain_count();
        &self.forecast.gains_kw[t * count..(t + 1) * count]
    }

    /// Learns what the forecast missed in the step before `step`.
    fn note(&mut self, step: usize, unforecast_kw: Option<Vec<f64>>) {
        let zones = self.filter.missed_kw.len();
        let Some(unforecast_kw) = unforecast_kw else { return };
        let bias = self.learned.bias_kw(step, zones);
        let missed_kw: Vec<f64> = unforecast_kw.iter().zip(bias).map(|(missed, bias)| missed + bias).collect();
        self.learned.note(step, &missed_kw);
    }
}

impl ControllerKind for EconomicSettings {
    fn kind(&self) -> &'static str {
        "economic-mpc"
    }

    fn look_for(&self) -> &'static str {
        "heat is bought when it is cheap and stored in walls, and temperatures keep to the edge of the comfort band"
    }

    fn controller(&self, model: &Model, steps: usize) -> Result<Box<dyn Control>, ControlError> {
        Ok(Box::new(Economic::new(*self, model, steps)?))
    }

    fn operations_per_day(&self, zones: f64, steps: f64) -> f64 {
        // The solver needs about 15 iterations, each with some dense products of nodes by nodes per stage; there are as
        // many walls as zones.
        let stages = self.spans(0, 86_400.0 / steps).len() as f64;
        steps * stages * 15.0 * (0.2 * (2.0 * zones).powi(3) + 5000.0)
    }
}

impl Control for Economic {
    fn start_of_day(&mut self, day_ahead: &DayAhead<'_>) -> Result<(), ControlError> {
        let network = self.model.network();
        ControlError::check_length("a row of targets", day_ahead.targets.zones, network.zone_count())?;
        ControlError::check_length("the day", day_ahead.targets.steps(), self.steps)?;
        ControlError::check_length("the temperatures at midnight", day_ahead.initial_c.len(), network.node_count())?;
        day_ahead.forecast.check(day_ahead.targets, network)?;
        if let Some(outlook) = day_ahead.outlook {
            outlook.check(day_ahead.targets, network)?;
        }
        let unforecast_kw = self.filter.begin(day_ahead.initial_c);
        self.note(self.steps - 1, unforecast_kw);
        self.learned.end_day();
        self.forecast = day_ahead.forecast.clone();
        if let Some(outlook) = day_ahead.outlook {
            self.forecast.ambient_c.extend_from_slice(&outlook.ambient_c);
            self.forecast.gains_kw.extend_from_slice(&outlook.gains_kw);
        }
        Ok(())
    }

    fn act(&mut self, observation: &Observation<'_>) -> Vec<f64> {
        let (step, zones) = (observation.step, observation.temperatures_c.len());
        if step > 0 {
            let unforecast_kw = self.filter.measure(observation.temperatures_c);
            self.note(step - 1, unforecast_kw);
        }
        let outcome = self.plan(step, observation.targets);
        let heat_kw = self.model.network().limits().limited_all(&self.plan.adopt(step, zones, outcome));
        let ambient_c = self.forecast.ambient_c[step];
        let mut gains_kw = self.gains_kw(step).to_vec();
        gains_kw.iter_mut().zip(self.learned.bias_kw(step, zones)).for_each(|(gain, bias)| *gain += bias);
        self.filter.predict(&heat_kw, ambient_c, &gains_kw);
        let supply = EnergyNow { targets: observation.targets, step, ambient_c };
        self.peak_kw = self.peak_kw.max(heat_kw.iter().map(|kw| supply.electric_kw(*kw)).sum());
        heat_kw
    }

    fn end_of_day(&mut self, record: &DayRecord) -> Result<(), ControlError> {
        self.plan.days_with_failures = record.design.fallbacks;
        Ok(())
    }

    fn design(&self) -> Design {
        let bias_kw = self.learned.all_kw(self.filter.missed_kw.len());
        Design { fallbacks: self.plan.days_with_failures, bias_kw, ..Design::default() }
    }

    fn trouble(&self) -> Option<&ControlError> {
        self.plan.failure.as_ref()
    }

    fn fork(&self) -> Option<Box<dyn Control>> {
        Some(Box::new(self.clone()))
    }
}

/// The equipment's electricity in a step.
struct EnergyNow<'a> {
    targets: &'a Targets,
    step: usize,
    ambient_c: f64,
}

impl EnergyNow<'_> {
    fn electric_kw(&self, heat_kw: f64) -> f64 {
        let pump = self.targets.supply.heat_pump.as_ref();
        let outdoor_c = self.targets.supply.outdoor_c.get(self.step).unwrap_or(&self.ambient_c);
        heat_kw.abs() / pump.map_or(1.0, |pump| pump.cop(heat_kw > 0.0, *outdoor_c))
    }
}

/// Learned means of the missed heat of each step and zone.
#[derive(Clone, Debug)]
struct LearnedForecast {
    rate: f64,
    /// Stacked \[kW\].
    mean_kw: Vec<f64>,
    /// Stacked \[kW²\].
    variance_kw2: Vec<f64>,
    /// Missed heat of the day in progress, stacked \[kW\].
    today_kw: Vec<Option<f64>>,
    days: usize,
}

impl LearnedForecast {
    /// Begins without any learned heat; `size` is the number of steps times the number of zones, and `rate` is λ.
    pub fn new(size: usize, rate: f64) -> Self {
        let zeros = vec![0.0; size];
        Self { rate, mean_kw: zeros.clone(), variance_kw2: zeros, today_kw: vec![None; size], days: 0 }
    }

    /// Records the heat of a step that the forecast missed \[kW\], one number per zone.
    pub fn note(&mut self, step: usize, missed_kw: &[f64]) {
        let zones = missed_kw.len();
        for (today, missed_kw) in self.today_kw.iter_mut().skip(step * zones).zip(missed_kw) {
            *today = Some(*missed_kw);
        }
    }

    /// Updates the means and variances with the day that is over.
    pub fn end_day(&mut self) {
        if self.today_kw.iter().all(Option::is_none) {
            return;
        }
        self.days += 1;
        // The first days have equal weights, as in an average.
        let rate = self.rate.max(1.0 / self.days as f64).min(if self.rate > 0.0 { 1.0 } else { 0.0 });
        for (i, today_kw) in self.today_kw.iter_mut().enumerate() {
            let Some(missed_kw) = today_kw.take() else { continue };
            let error_kw = missed_kw - self.mean_kw[i];
            self.mean_kw[i] += rate * error_kw;
            self.variance_kw2[i] = (1.0 - rate) * (self.variance_kw2[i] + rate * error_kw * error_kw);
        }
    }

    /// The heat that is expected beyond the forecast in a step \[kW\], one number per zone.
    pub fn bias_kw(&self, step: usize, zones: usize) -> impl Iterator<Item = f64> + '_ {
        (step * zones..(step + 1) * zones).map(|i| {
            let square = self.mean_kw[i] * self.mean_kw[i];
            // A single day does not show how days vary.
            if self.days < 2 || square == 0.0 {
                return 0.0;
            }
            let uncertainty = self.variance_kw2[i] * self.rate / (2.0 - self.rate);
            self.mean_kw[i] * square / (square + uncertainty)
        })
    }

    /// The bias of all steps, stacked \[kW\].
    pub fn all_kw(&self, zones: usize) -> Vec<f64> {
        (0..self.mean_kw.len() / zones.max(1)).flat_map(|step| self.bias_kw(step, zones)).collect()
    }
}
