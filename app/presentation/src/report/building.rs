//! The days of a building as a table.

use std::fmt::Write;

use interplay_building::day::ZoneFigures;
use interplay_common::spelling::counted;
use interplay_simulation::day::DayFigures;
use interplay_simulation::measure::Fallback;
use interplay_simulation::report::{BuildingReport, ZoneOutcome};

use super::columns::{Align, lines, write_table};

/// The most days that a summary lists.
const MAX_LISTED_DAYS: usize = 14;
/// The most zones that a summary lists.
const MAX_LISTED_ZONES: usize = 24;

/// The days as a table.
pub(super) fn write(text: &mut String, building: &BuildingReport) -> std::fmt::Result {
    let radius = building.iterations.last().and_then(|day| day.spectral_radius);
    let radius = radius.map(|radius| format!(", spectral radius {radius:.3}")).unwrap_or_default();
    writeln!(text, "  {}, controller {}{radius}", counted(building.zones, "zone"), building.controller)?;
    for remark in &building.remarks {
        writeln!(text, "  note: {remark}")?;
    }
    write_days(text, building)?;
    write_whole_run(text, building)?;
    write_zones(text, building)?;
    write_exchange(text, building)?;
    write_benchmark(text, building)?;
    for Fallback { day, reason } in building.fallbacks.iter().take(MAX_LISTED_DAYS) {
        writeln!(text, "  day {day} {reason}")?;
    }
    for Fallback { day, reason } in building.weaker_feedbacks.iter().take(MAX_LISTED_DAYS) {
        writeln!(text, "  day {day}: {reason}")?;
    }
    Ok(())
}

/// The indicators of a benchmark as it computed them, and as Interplay computes them.
fn write_benchmark(text: &mut String, building: &BuildingReport) -> std::fmt::Result {
    let Some(benchmark) = &building.benchmark else { return Ok(()) };
    let official = benchmark.official.iter().filter_map(|(name, value)| Some(format!("{name} {:.5}", (*value)?)));
    let official: Vec<String> = official.collect();
    if !official.is_empty() {
        writeln!(text, "  benchmark: {}", official.join(", "))?;
    }
    let Some(ours) = &benchmark.ours else { return Ok(()) };
    writeln!(
        text,
        "  computed by Interplay: thermal discomfort {:.3} K·h per zone, energy {:.4} kWh/m², cost {:.5} per m², emissions {:.5} kg/m²",
        ours.tdis_k_h, ours.ener_kwh_per_m2, ours.cost_per_m2, ours.emis_kg_per_m2
    )
}

/// A line for each day; of many days, the first and the last ones.
fn write_days(text: &mut String, building: &BuildingReport) -> std::fmt::Result {
    let days = &building.iterations;
    let supply = Supply::detect(building);
    let titles = ["day", "cost", "regret", "rmse K", "discomfort K·h", "energy kWh", "peak kW", "over limit kW"];
    let more = supply.titles();
    let header = titles.into_iter().chain(["design ms"]).chain(more.iter().map(String::as_str));
    let header = header.map(|title| (title, Align::Right));
    let row = |(index, day): (usize, &DayFigures)| {
        let figures = &day.figures;
        let mut cells = vec![
            (index + 1).to_string(),
            format!("{:.2}", figures.cost),
            day.regret.map_or_else(|| "-".to_owned(), |regret| format!("{regret:.2}")),
            format!("{:.3}", figures.tracking_rmse_c),
            format!("{:.3}", figures.discomfort_k_h),
            format!("{:.2}", figures.energy_kwh),
            format!("{:.2}", figures.peak_kw),
            format!("{:.3}", figures.input_violation_kw),
            format!("{:.2}", 1e3 * day.design_s),
        ];
        cells.extend(supply.cells(figures.electricity_kwh, figures.energy_cost));
        cells
    };
    let left_out = days.len().saturating_sub(MAX_LISTED_DAYS);
    let is_listed =
        |index: usize| left_out == 0 || !(MAX_LISTED_DAYS / 2..days.len() - MAX_LISTED_DAYS / 2).contains(&index);
    let listed = days.iter().enumerate().filter(|(index, _)| is_listed(*index)).map(row);
    for (index, line) in lines(&header.collect::<Vec<_>>(), listed).iter().enumerate() {
        if left_out > 0 && index == 1 + MAX_LISTED_DAYS / 2 {
            writeln!(text, "     …  {left_out} more in --json")?;
        }
        writeln!(text, "  {line}")?;
    }
    Ok(())
}

/// The cost of all days, compared with the cheapest run with perfect foresight.
fn write_whole_run(text: &mut String, building: &BuildingReport) -> std::fmt::Result {
    let Some(run) = building.whole_run else { return Ok(()) };
    let (cost, least, regret) = (run.cost, run.least_cost, run.regret);
    writeln!(text, "  all days: cost {cost:.2}, the least with perfect foresight {least:.2}, regret {regret:.2}")?;
    if let (Some(cost), Some(least), Some(currency)) = (run.energy_cost, run.least_energy_cost, &building.currency) {
        let currency = currency.replace(char::is_control, " ");
        let discomfort = run.discomfort_k_h;
        let what = if run.demand_cost.is_some() { "energy and demand charge" } else { "energy" };
        let cost = cost + run.demand_cost.unwrap_or(0.0);
        let least = least + run.least_demand_cost.unwrap_or(0.0);
        writeln!(
            text,
            "  {what}: {cost:.2} {currency} at {discomfort:.2} K·h of discomfort, the least without any {least:.2} {currency}"
        )?;
    }
    Ok(())
}

/// The columns about electricity that differ from those of the heat.
struct Supply {
    electricity: bool,
    currency: Option<String>,
}

impl Supply {
    fn detect(building: &BuildingReport) -> Self {
        // The tolerance covers rounding: the two values are sums in different orders.
        let differs = |DayFigures { figures, .. }: &DayFigures| {
            (figures.electricity_kwh - figures.energy_kwh).abs() > 1e-9 * (1.0 + figures.energy_kwh)
        };
        Self { electricity: building.iterations.iter().any(differs), currency: building.currency.clone() }
    }

    fn titles(&self) -> Vec<String> {
        let electricity = self.electricity.then(|| "electricity kWh".to_owned());
        electricity
            .into_iter()
            .chain(self.currency.iter().map(|currency| format!("energy {}", currency.replace(char::is_control, " "))))
            .collect()
    }

    fn cells(&self, electricity_kwh: f64, energy_cost: Option<f64>) -> Vec<String> {
        let electricity = self.electricity.then(|| format!("{electricity_kwh:.2}"));
        electricity.into_iter().chain(energy_cost.map(|cost| format!("{cost:.2}"))).collect()
    }
}

/// A line for each zone, over all days; of many zones, the first.
fn write_zones(text: &mut String, building: &BuildingReport) -> std::fmt::Result {
    let supply = Supply::detect(building);
    let more = supply.titles();
    let titles = ["cost", "discomfort K·h", "energy kWh"].into_iter().chain(more.iter().map(String::as_str));
    let header: Vec<_> =
        [("zone, all days", Align::Left)].into_iter().chain(titles.map(|title| (title, Align::Right))).collect();
    let row = |zone: &ZoneOutcome| {
        let total = |value: fn(&ZoneFigures) -> f64| zone.iterations.iter().map(value).sum::<f64>();
        let mut cells = vec![
            zone.zone.clone(),
            format!("{:.2}", total(|day| day.cost)),
            format!("{:.3}", total(|day| day.discomfort_k_h)),
            format!("{:.2}", total(|day| day.energy_kwh)),
        ];
        let energy_cost: Option<f64> = zone.iterations.iter().map(|day| day.energy_cost).sum();
        cells.extend(supply.cells(total(|day| day.electricity_kwh), energy_cost));
        cells
    };
    write_table(text, &header, building.zone_figures.iter().take(MAX_LISTED_ZONES).map(row))?;
    let left_out = building.zone_figures.len().saturating_sub(MAX_LISTED_ZONES);
    if left_out > 0 {
        writeln!(text, "     …  {left_out} more in --json")?;
    }
    Ok(())
}

/// The exchange of messages of zones that plan together, on the last day.
fn write_exchange(text: &mut String, building: &BuildingReport) -> std::fmt::Result {
    let Some(exchange) = building.iterations.last().and_then(|day| day.exchange) else { return Ok(()) };
    let per_zone = exchange.messages as f64 / building.zones as f64;
    write!(text, "  last plan: {}, {per_zone:.0} messages a zone", counted(exchange.rounds, "round"))?;
    if exchange.undelivered > 0 {
        write!(text, " ({} in all not delivered in time)", exchange.undelivered)?;
    }
    write!(text, ", J from {:.2} to {:.2}", exchange.first_cost, exchange.cost)?;
    if let Some(centralised) = exchange.centralised_cost {
        write!(text, ", {:.3} % above the centralised {centralised:.2}", 100.0 * (exchange.cost / centralised - 1.0))?;
    }
    writeln!(text)
}
