//! The days of a building as a readable table.

use std::fmt::Write;

use interplay_simulation::measure::Fallback;
use interplay_simulation::report::BuildingReport;

/// The most days that a summary lists.
const LISTED: usize = 14;

/// The days as a table.
pub(super) fn write(text: &mut String, building: &BuildingReport) -> std::fmt::Result {
    let radius = building.iterations.last().and_then(|day| day.spectral_radius);
    let radius = radius.map(|radius| format!(", spectral radius {radius:.3}")).unwrap_or_default();
    writeln!(text, "  {} zones, controller {}{radius}", building.zones, building.controller)?;
    for remark in &building.remarks {
        writeln!(text, "  note: {remark}")?;
    }
    writeln!(
        text,
        "  {:>4}  {:>9}  {:>9}  {:>6}  {:>14}  {:>10}  {:>7}  {:>13}  {:>9}",
        "day", "cost", "regret", "rmse K", "discomfort K·h", "energy kWh", "peak kW", "over limit kW", "design ms"
    )?;
    let count = building.iterations.len();
    for (index, day) in building.iterations.iter().enumerate() {
        if count > LISTED && (LISTED / 2..count - LISTED / 2).contains(&index) {
            if index == LISTED / 2 {
                writeln!(text, "     …  {} more in --json", count - LISTED)?;
            }
            continue;
        }
        let figures = &day.figures;
        let regret = day.regret.map_or_else(|| "-".to_owned(), |regret| format!("{regret:.2}"));
        writeln!(
            text,
            "  {:>4}  {:>9.2}  {regret:>9}  {:>6.3}  {:>14.3}  {:>10.2}  {:>7.2}  {:>13.3}  {:>9.2}",
            index + 1,
            figures.cost,
            figures.tracking_rmse_c,
            figures.discomfort_k_h,
            figures.energy_kwh,
            figures.peak_kw,
            figures.input_violation_kw,
            1e3 * day.design_s
        )?;
    }
    write_exchange(text, building)?;
    for Fallback { day, reason } in building.fallbacks.iter().take(LISTED) {
        writeln!(text, "  day {day} repeated the one before: {reason}")?;
    }
    Ok(())
}

/// How zones that plan together did on the last day.
fn write_exchange(text: &mut String, building: &BuildingReport) -> std::fmt::Result {
    let Some(spoken) = building.iterations.last().and_then(|day| day.exchange) else { return Ok(()) };
    let per_zone = spoken.messages as f64 / building.zones as f64;
    write!(text, "  last plan: {} rounds, {per_zone:.0} messages a zone", spoken.rounds)?;
    if spoken.undelivered > 0 {
        write!(text, " ({} in all not delivered in time)", spoken.undelivered)?;
    }
    write!(text, ", J from {:.2} to {:.2}", spoken.first_cost, spoken.cost)?;
    if let Some(centralised) = spoken.centralised_cost {
        write!(text, ", {:.3} % above the centralised {centralised:.2}", 100.0 * (spoken.cost / centralised - 1.0))?;
    }
    writeln!(text)
}
