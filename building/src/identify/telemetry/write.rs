//! Writes telemetry as a table, and the mapping that reads it back bit for bit.

use std::fmt::Write as _;

use super::mapping::{BoundaryColumns, Gaps, HeatColumns, Mapping, SolarColumn, TimeAxis, ZoneColumns};
use super::measurements::{Boundary, MeasuredZone, Telemetry};
use super::units::{AirFlowUnit, IrradianceUnit, PowerUnit, TableForm};
use crate::identify::IdentifySettings;

/// Heat that air carries is written as a flow of this unit.
const FLOW: AirFlowUnit = AirFlowUnit::KwPerK;

/// A column: its title and its values.
type Column<'a> = (String, &'a [f64]);

/// See [`Telemetry::to_csv`].
pub(super) fn to_csv(telemetry: &Telemetry) -> String {
    let columns = columns(telemetry);
    let mut csv = String::from("time_s,recording");
    // Titles contain names that the user chose, which may include separators, quotes and line breaks.
    columns.iter().for_each(|(title, _)| csv.extend([",\"", &title.replace('"', "\"\""), "\""]));
    for (recording, segment) in telemetry.segments.iter().enumerate() {
        for row in segment.clone() {
            // Writing to a string cannot fail.
            let _ = write!(csv, "\n{},{recording}", telemetry.time_s[row]);
            for (_, values) in &columns {
                let value = values[row];
                let _ = if value.is_nan() { write!(csv, ",") } else { write!(csv, ",{value}") };
            }
        }
    }
    csv.push('\n');
    csv
}

fn columns(telemetry: &Telemetry) -> Vec<Column<'_>> {
    let mut columns: Vec<Column<'_>> = Vec::new();
    for boundary in &telemetry.boundaries {
        columns.push((format!("{} [°C]", boundary.name), &boundary.temperature_c));
    }
    for zone in &telemetry.zones {
        columns.push((temperature(zone), &zone.temperature_c));
        columns.push((power(zone), &zone.power_kw));
        for (index, air) in zone.supply_air.iter().enumerate() {
            columns.push((flow(zone, index), &air.conductance_kw_per_k));
            columns.push((supply(zone, index), &air.temperature_c));
        }
        columns.extend(zone.irradiance_kw_per_m2.as_ref().map(|values| (sun(zone), values.as_slice())));
    }
    columns
}

/// See [`Telemetry::mapping`].
pub(super) fn mapping(telemetry: &Telemetry) -> Mapping {
    let zone = |zone: &MeasuredZone| {
        let unit = if zone.power_has_unit { PowerUnit::Kw } else { PowerUnit::Unknown };
        let mut heat = Vec::new();
        if !(zone.power_kw.iter().all(|&power| power == 0.0)) {
            heat.push(HeatColumns::Power { column: power(zone), unit, factor: 1.0 });
        }
        heat.extend((0..zone.supply_air.len()).map(|index| HeatColumns::SupplyAir {
            flow: flow(zone, index),
            flow_unit: FLOW,
            temperature: supply(zone, index),
        }));
        let solar =
            SolarColumn { column: sun(zone), unit: IrradianceUnit::KwPerM2, factor: 1.0, hold: zone.irradiance_hold };
        ZoneColumns {
            name: zone.name.clone(),
            temperature: temperature(zone),
            heat,
            heat_hold: zone.power_hold,
            solar: zone.irradiance_kw_per_m2.is_some().then_some(solar),
        }
    };
    let boundary = |boundary: &Boundary| BoundaryColumns {
        name: boundary.name.clone(),
        temperature: format!("{} [°C]", boundary.name),
        hold: boundary.hold,
    };
    Mapping {
        table: TableForm::default(),
        time: TimeAxis {
            column: Some("time_s".into()),
            format: "seconds".into(),
            zone: None,
            step_s: telemetry.step_s,
            gaps: if has_missing(telemetry) { Gaps::Bridge } else { Gaps::Refuse },
            batch: Some("recording".into()),
        },
        boundaries: telemetry.boundaries.iter().map(boundary).collect(),
        zones: telemetry.zones.iter().map(zone).collect(),
        walls: (telemetry.walls.iter())
            .map(|wall| [telemetry.zones[wall.zone].name.clone(), telemetry.name(wall.other).to_owned()])
            .collect(),
        columns: Vec::new(),
        identify: IdentifySettings::default(),
    }
}

/// Whether a temperature of a zone is missing.
fn has_missing(telemetry: &Telemetry) -> bool {
    telemetry.zones.iter().any(|zone| zone.temperature_c.iter().any(|value| value.is_nan()))
}

fn temperature(zone: &MeasuredZone) -> String {
    format!("{} [°C]", zone.name)
}

fn power(zone: &MeasuredZone) -> String {
    format!("{} heat [{}]", zone.name, if zone.power_has_unit { "kW" } else { "?" })
}

fn flow(zone: &MeasuredZone, index: usize) -> String {
    format!("{} air {index} [kW/K]", zone.name)
}

fn supply(zone: &MeasuredZone, index: usize) -> String {
    format!("{} air {index} [°C]", zone.name)
}

fn sun(zone: &MeasuredZone) -> String {
    format!("{} sun [kW/m²]", zone.name)
}
