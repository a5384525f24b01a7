//! Writes an identified network as a scenario file.

use std::fmt::{self, Write};

use interplay_building::identify::{IdentificationReport, IdentifiedNetwork, RecordedDays};

use super::columns::written;

/// The smallest and largest factor of `[building.believed]`.
const BELIEVED: (f64, f64) = (0.1, 10.0);

/// Most days that a scenario takes from a record.
const MAX_DAYS: usize = 14;

/// What the controller of a scenario believes its building to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Believed {
    /// The estimate, which is also what is simulated.
    Estimate,
    /// The upper ends of the 95 % intervals, while the estimate is simulated: a test of how much a wrong model costs.
    UpperEnds,
}

/// Returns a scenario file with the network that was identified from `file`, which its controller believes or not. `weather` is the path of a table of recorded weather, and its days; without it, the weather is synthetic.
pub fn identified_scenario(
    file: &str,
    report: &IdentificationReport,
    network: &IdentifiedNetwork,
    weather: Option<(&str, &RecordedDays)>,
    believed: Believed,
) -> String {
    written(|text| write_scenario(text, file, (report, network), weather, believed))
}

fn write_scenario(
    text: &mut String,
    file: &str,
    (report, network): (&IdentificationReport, &IdentifiedNetwork),
    weather: Option<(&str, &RecordedDays)>,
    believed: Believed,
) -> fmt::Result {
    let file = file.replace(char::is_control, " ");
    writeln!(text, "# A building as identified from {file}.")?;
    for zone in &report.zones {
        for quantity in &zone.physical {
            let words = quantity.verdict.words.replace(char::is_control, " ");
            writeln!(text, "# {}: {words}.", zone.name.replace(char::is_control, " "))?;
        }
    }
    network.remarks.iter().try_for_each(|remark| writeln!(text, "# {}.", remark.replace(char::is_control, " ")))?;
    let examples = if weather.is_some() { "Set-points are examples" } else { "Weather and set-points are examples" };
    writeln!(text, "# {examples}: replace them, and choose a controller by `[controller]`.\n")?;
    writeln!(text, "title = {}", quoted(&format!("As identified from {file}")))?;
    writeln!(text, "shows = \"What a controller does in the building whose measurements these are\"")?;
    writeln!(text, "iterations = {}\n", weather.map_or(5, |(_, recorded)| recorded.days.min(MAX_DAYS)))?;
    writeln!(text, "[building]")?;
    let step_s = weather.and_then(|(_, recorded)| recorded.step_s).unwrap_or(1800.0);
    writeln!(text, "step_s = {step_s:?}")?;
    writeln!(text, "initial_c = {:?}\n", rounded(network.mean_c.0))?;
    if believed == Believed::UpperEnds {
        write_believed(text, network)?;
    }
    for zone in &network.zones {
        writeln!(text, "[[building.zone]]")?;
        writeln!(text, "name = {}", quoted(&zone.name))?;
        writeln!(text, "capacity_kj_per_k = {:?}", zone.capacity_kj_per_k)?;
        writeln!(text, "heating_limit_kw = {:?}", zone.heating_limit_kw.unwrap_or(zone.limit_kw))?;
        writeln!(text, "cooling_limit_kw = {:?}", zone.cooling_limit_kw.unwrap_or(zone.limit_kw))?;
        writeln!(text, "solar_aperture_m2 = {:?}\n", zone.solar_aperture_m2)?;
    }
    for wall in &network.walls {
        writeln!(text, "[[building.wall]]")?;
        writeln!(text, "between = [{}, {}]", quoted(&wall.between[0]), quoted(&wall.between[1]))?;
        writeln!(text, "resistance_k_per_kw = {:?}", wall.resistance_k_per_kw)?;
        if let Some(capacity) = wall.capacity_kj_per_k {
            writeln!(text, "capacity_kj_per_k = {capacity:?}")?;
        }
        if let Some(position) = wall.mass_position {
            writeln!(text, "mass_position = {position:?}")?;
        }
        if wall.solar_aperture_m2 > 0.0 {
            writeln!(text, "solar_aperture_m2 = {:?}", wall.solar_aperture_m2)?;
        }
        writeln!(text)?;
    }
    write_weather(text, network, weather)?;
    writeln!(text, "\n[setpoints]\noccupied_c = [{:?}]", rounded(network.mean_c.0))
}

/// Writes the recorded weather, or synthetic weather with the same mean temperature.
fn write_weather(
    text: &mut String,
    network: &IdentifiedNetwork,
    weather: Option<(&str, &RecordedDays)>,
) -> fmt::Result {
    let Some((file, recorded)) = weather else {
        writeln!(text, "[weather]\nkind = \"synthetic\"")?;
        let climate = |outdoor_c| writeln!(text, "climate = {{ mean_c = {:?} }}", rounded(outdoor_c));
        return network.mean_c.1.map_or(Ok(()), climate);
    };
    writeln!(text, "# As recorded; day {} of the record is the first.", recorded.skip_days + 1)?;
    if recorded.has_other_sun {
        writeln!(text, "# The sun is that of the first zone with irradiance; a scenario has only one.")?;
    }
    let rows = if recorded.are_means { "mean-from" } else { "instant" };
    writeln!(text, "[weather]\nkind = \"csv\"\nfile = {}\nrows = \"{rows}\"", quoted(file))?;
    writeln!(text, "skip_days = {}", recorded.skip_days)
}

fn write_believed(text: &mut String, network: &IdentifiedNetwork) -> fmt::Result {
    let range = &network.uncertainty;
    writeln!(
        text,
        "# The building as the controller believes it to be: the upper ends of the 95 % intervals. With all factors 1 its model"
    )?;
    writeln!(text, "# is the estimate. The intervals, as multiples of the estimates:")?;
    let factors = [
        ("capacity_factor", range.capacity),
        ("inner_resistance_factor", range.inner_resistance),
        ("outer_resistance_factor", range.outer_resistance),
    ];
    for (key, (low, high)) in factors {
        writeln!(text, "#   {key}: {low:.3} to {high:.3}")?;
    }
    writeln!(text, "[building.believed]")?;
    for (key, (_, high)) in factors {
        writeln!(text, "{key} = {:?}", (1000.0 * high.clamp(BELIEVED.0, BELIEVED.1)).round() / 1000.0)?;
    }
    writeln!(text)
}

/// A text as TOML, with its quotes.
fn quoted(text: &str) -> String {
    let mut quoted = String::from('"');
    for character in text.chars() {
        match character {
            '"' | '\\' => quoted.extend(['\\', character]),
            control if control.is_control() => {
                let _ = write!(quoted, "\\u{:04X}", u32::from(control));
            }
            other => quoted.push(other),
        }
    }
    quoted + "\""
}

fn rounded(value: f64) -> f64 {
    (10.0 * value).round() / 10.0
}
