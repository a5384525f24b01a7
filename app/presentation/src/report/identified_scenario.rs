//! An identified network as a scenario file.

use std::fmt::{self, Write};

use interplay_building::identify::{IdentificationReport, IdentifiedNetwork};

/// The smallest and largest factor of `[building.believed]`.
const BELIEVED: (f64, f64) = (0.1, 10.0);

/// A scenario with the network that was identified from `file`. Its `[building.believed]` is wrong by as much as the data allow.
pub fn identified_scenario(file: &str, report: &IdentificationReport, network: &IdentifiedNetwork) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = write_scenario(&mut text, file, report, network);
    text
}

fn write_scenario(
    text: &mut String,
    file: &str,
    report: &IdentificationReport,
    network: &IdentifiedNetwork,
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
    writeln!(
        text,
        "# Weather and set-points are examples: replace them, and choose a controller by `[controller]`.\n"
    )?;
    writeln!(text, "title = {}", quoted(&format!("As identified from {file}")))?;
    writeln!(text, "shows = \"What a controller does in the building whose measurements these are\"")?;
    writeln!(text, "iterations = 5\n")?;
    writeln!(text, "[building]")?;
    writeln!(text, "step_s = 1800.0")?;
    writeln!(text, "initial_c = {:?}\n", rounded(network.mean_c.0))?;
    write_believed(text, network)?;
    for zone in &network.zones {
        writeln!(text, "[[building.zone]]")?;
        writeln!(text, "name = {}", quoted(&zone.name))?;
        writeln!(text, "capacity_kj_per_k = {:?}", zone.capacity_kj_per_k)?;
        writeln!(text, "limit_kw = {:?}", zone.limit_kw)?;
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
    writeln!(text, "[weather]\nkind = \"synthetic\"")?;
    if let Some(outdoor_c) = network.mean_c.1 {
        writeln!(text, "climate = {{ mean_c = {:?} }}", rounded(outdoor_c))?;
    }
    writeln!(text, "\n[setpoints]\noccupied_c = [{:?}]", rounded(network.mean_c.0))
}

fn write_believed(text: &mut String, network: &IdentifiedNetwork) -> fmt::Result {
    let range = &network.uncertainty;
    writeln!(
        text,
        "# What the controller takes the building for: the upper ends of the 95 % intervals. With all factors 1 its model"
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

/// To a tenth.
fn rounded(value: f64) -> f64 {
    (10.0 * value).round() / 10.0
}
