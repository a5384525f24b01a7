//! Reads a table into [`Telemetry`] by its mapping.

use std::ops::Range;

use super::error::{Problem, TelemetryError};
use super::mapping::{Gaps, HeatColumns, Mapping, MeterReading, TimeAxis, ZoneColumns};
use super::measurements::{Boundary, Hold, MeasuredWall, MeasuredZone, Neighbour, SupplyAir, Telemetry};
use super::table::{Column, Row, Table};
use super::units::PowerUnit;
use crate::series::clock::{ClockTime, NamedZone, OFFSET};
use crate::series::home_assistant::Export;

/// The lowest and highest temperature that a building or its weather can have \[°C\].
const PLAUSIBLE_C: (f64, f64) = (-60.0, 90.0);

/// Reads `text`; see [`Telemetry::read`].
pub(super) fn read(file: &str, text: &str, mapping: &Mapping) -> Result<Telemetry, TelemetryError> {
    let export = Export::read(text);
    let text = export.as_ref().map_or(text, |export| export.table.as_str());
    let mut table = Table::split(file, text, mapping)?;
    table.export = export.as_ref();
    let rows = complete_rows(&table, mapping)?;
    let reader = Reader { table: &table, mapping, rows: &rows.kept, segments: &rows.segments };
    let boundaries = mapping
        .boundaries
        .iter()
        .map(|boundary| {
            let role = format!("temperature of boundary {}", boundary.name);
            Ok(Boundary {
                name: boundary.name.clone(),
                temperature_c: reader.temperature(&boundary.temperature, &role)?,
                hold: boundary.hold,
            })
        })
        .collect::<Result<_, TelemetryError>>()?;
    let zones = mapping.zones.iter().map(|zone| reader.zone(zone)).collect::<Result<_, TelemetryError>>()?;
    Ok(Telemetry {
        step_s: mapping.time.step_s,
        time_s: rows.time_s,
        segments: rows.segments,
        left_out_rows: table.rows.len() - rows.kept.len(),
        zones,
        boundaries,
        walls: walls(mapping),
    })
}

/// The rows without a missing value, by their place in the table, and where they follow each other without a gap.
struct CompleteRows {
    kept: Vec<usize>,
    time_s: Vec<f64>,
    segments: Vec<Range<usize>>,
}

/// Every column that the mapping names, with its role.
fn wanted(mapping: &Mapping) -> Vec<(&str, String)> {
    let mut wanted = Vec::new();
    for boundary in &mapping.boundaries {
        wanted.push((boundary.temperature.as_str(), format!("temperature of boundary {}", boundary.name)));
    }
    for zone in &mapping.zones {
        let role = |what: &str| format!("{what} of zone {}", zone.name);
        wanted.push((&zone.temperature, role("temperature")));
        for heat in &zone.heat {
            match heat {
                HeatColumns::Power { column, .. } => wanted.push((column, role("power"))),
                HeatColumns::Meter { column, .. } => wanted.push((column, role("energy"))),
                HeatColumns::SupplyAir { flow, temperature, .. } => {
                    wanted.push((flow, role("supply air flow")));
                    wanted.push((temperature, role("supply air temperature")));
                }
                HeatColumns::Water { flow, inlet, outlet, .. } => {
                    wanted.push((flow, role("water flow")));
                    wanted.push((inlet, role("inlet temperature")));
                    wanted.push((outlet, role("outlet temperature")));
                }
            }
        }
        if let Some(solar) = &zone.solar {
            wanted.push((&solar.column, role("irradiance")));
        }
    }
    wanted
}

fn complete_rows(table: &Table<'_>, mapping: &Mapping) -> Result<CompleteRows, TelemetryError> {
    let axis = &mapping.time;
    let time = axis.column.as_ref().map(|name| table.column(name, "time")).transpose()?;
    let batch = axis.batch.as_ref().map(|name| table.column(name, "batch")).transpose()?;
    let columns = wanted(mapping).iter().map(|(name, role)| table.column(name, role)).collect::<Result<Vec<_>, _>>()?;
    let columns = match axis.gaps {
        Gaps::Bridge => without_zone_temperatures(table, mapping, columns)?,
        Gaps::Refuse | Gaps::Split => columns,
    };
    let mut segments: Vec<Range<usize>> = Vec::new();
    let (mut kept, mut time_s) = (Vec::new(), Vec::new());
    // Days begin at midnight at the place where the first row was measured.
    let mut offset_s = 0.0;
    // The row before, if it was complete: its time and batch.
    let mut before: Option<(f64, &str)> = None;
    let clock = axis.zone.as_deref().and_then(NamedZone::find);
    let mut last: Option<ClockTime> = None;
    for (index, row) in table.rows.iter().enumerate() {
        let now = match time {
            Some(column) => table.time(row, column, (axis, clock.as_ref()), last)?,
            None => ClockTime { elapsed_s: index as f64 * axis.step_s, offset_s: 0.0 },
        };
        let now_s = now.elapsed_s;
        last = Some(now);
        if !is_complete(table, row, &columns, axis.gaps)? {
            before = None;
            continue;
        }
        let recording = batch.map_or("", |column| table.text(row, column));
        let continues = match before {
            Some((then_s, batch)) if batch == recording => {
                let on_time = is_step(now_s - then_s, axis.step_s);
                if let (false, Gaps::Refuse, Some(column)) = (on_time, axis.gaps, time) {
                    return Err(table.at(row, column, gap(table.text(row, column), now_s - then_s, axis)));
                }
                on_time
            }
            _ => false,
        };
        match segments.last_mut() {
            Some(segment) if continues => segment.end += 1,
            _ => segments.push(kept.len()..kept.len() + 1),
        }
        if kept.is_empty() {
            offset_s = now.offset_s;
        }
        kept.push(index);
        time_s.push(now_s);
        before = Some((now_s, recording));
    }
    let midnight = time_s.first().map_or(0.0, |first| libm::floor((first + offset_s) / 86_400.0) * 86_400.0 - offset_s);
    time_s.iter_mut().for_each(|time| *time -= midnight);
    Ok(CompleteRows { kept, time_s, segments })
}

/// The columns that a row must have although gaps are bridged. Where a zone's heat depends on its temperature, both count.
fn without_zone_temperatures(
    table: &Table<'_>,
    mapping: &Mapping,
    columns: Vec<Column>,
) -> Result<Vec<Column>, TelemetryError> {
    let zones = mapping.zones.iter().map(|zone| table.column(&zone.temperature, "temperature"));
    let zones = zones.collect::<Result<Vec<_>, _>>()?;
    Ok(columns.into_iter().filter(|column| !zones.contains(column)).collect())
}

/// Whether two rows are one sampling time apart, up to a tenth of it.
fn is_step(elapsed_s: f64, step_s: f64) -> bool {
    (elapsed_s - step_s).abs() <= 0.1 * step_s
}

fn gap(text: &str, elapsed_s: f64, axis: &TimeAxis) -> Problem {
    let is_of_clocks = axis.zone.is_none() && axis.has_dates() && !axis.format.contains(OFFSET);
    let is_hour = [3600.0, -3600.0].iter().any(|change_s| is_step(elapsed_s - change_s, axis.step_s));
    let kind = match elapsed_s {
        elapsed if elapsed < 0.0 => "time goes backwards",
        0.0 => "one time stands twice",
        _ => "there is a gap, or the sampling time is another",
    };
    let step_s = axis.step_s;
    let text = format!("`{text}` is {elapsed_s} s after the row before, and the sampling time is {step_s} s: {kind}");
    Problem::new(text, if is_of_clocks && is_hour { REMEDY_OF_CLOCKS } else { REMEDY_OF_GAP })
}

const REMEDY_OF_COUNTER: &str =
    "begin another recording where a meter was changed (`time.batch`), or state `reading` if rows are no counts";
const REMEDY_OF_GAP: &str =
    "add the missing rows, correct `time.step_s`, or set `time.gaps = \"split\"` to start anew after each gap";
const REMEDY_OF_CLOCKS: &str = "state `time.zone` if clocks are put forward or back here, or write times with an offset (`%z` in \
                                `time.format`); or add the missing rows, or set `time.gaps = \"split\"` to start anew after each gap";

/// Whether every wanted field has a value; an error where one has none and may not.
fn is_complete(table: &Table<'_>, row: &Row, columns: &[Column], gaps: Gaps) -> Result<bool, TelemetryError> {
    let mut complete = true;
    for &column in columns {
        if table.number(row, column)?.is_none() {
            if gaps == Gaps::Refuse {
                let text =
                    format!("column `{}` has no value here (`{}`)", table.title(column), table.text(row, column));
                let remedy = "fill the value in, or set `time.gaps = \"split\"` to leave such rows out and start anew";
                return Err(table.at(row, column, Problem::new(text, remedy)));
            }
            complete = false;
        }
    }
    Ok(complete)
}

fn walls(mapping: &Mapping) -> Vec<MeasuredWall> {
    let zone = |name: &String| mapping.zones.iter().position(|zone| zone.name == *name);
    let boundary = |name: &String| mapping.boundaries.iter().position(|boundary| boundary.name == *name);
    mapping
        .walls
        .iter()
        .filter_map(|[one, other]| match (zone(one), zone(other)) {
            (Some(zone), Some(other)) => Some(MeasuredWall { zone, other: Neighbour::Zone(other) }),
            (Some(zone), None) => boundary(other).map(|other| MeasuredWall { zone, other: Neighbour::Boundary(other) }),
            (None, Some(zone)) => boundary(one).map(|other| MeasuredWall { zone, other: Neighbour::Boundary(other) }),
            (None, None) => None,
        })
        .collect()
}

/// Reads columns over the complete rows.
struct Reader<'a> {
    table: &'a Table<'a>,
    mapping: &'a Mapping,
    rows: &'a [usize],
    segments: &'a [Range<usize>],
}

impl Reader<'_> {
    fn column(&self, name: &str, role: &str) -> Result<Vec<f64>, TelemetryError> {
        let column = self.table.column(name, role)?;
        let number = |&index: &usize| Ok(self.table.number(&self.table.rows[index], column)?.unwrap_or(f64::NAN));
        self.rows.iter().map(number).collect()
    }

    fn temperature(&self, name: &str, role: &str) -> Result<Vec<f64>, TelemetryError> {
        let column = self.table.column(name, role)?;
        let mut values = self.column(name, role)?;
        let (low, high) = PLAUSIBLE_C;
        for (value, &index) in values.iter_mut().zip(self.rows) {
            *value = self.mapping.table.temperature_unit.to_celsius(*value);
            if !(low..=high).contains(value) && !value.is_nan() {
                let text = format!("{value} °C in column `{name}` is outside {low} to {high} °C");
                let remedy =
                    "check the unit in the mapping, or list the text in `table.missing` if it stands for no value";
                return Err(self.table.at(&self.table.rows[index], column, Problem::new(text, remedy)));
            }
        }
        Ok(values)
    }

    fn zone(&self, columns: &ZoneColumns) -> Result<MeasuredZone, TelemetryError> {
        let mut zone = MeasuredZone {
            name: columns.name.clone(),
            temperature_c: self.temperature(&columns.temperature, "temperature")?,
            power_kw: vec![0.0; self.rows.len()],
            power_has_unit: true,
            power_hold: columns.heat_hold,
            supply_air: Vec::new(),
            irradiance_kw_per_m2: None,
            irradiance_hold: columns.solar.as_ref().map_or(Hold::FirstOrder, |solar| solar.hold),
        };
        for heat in &columns.heat {
            self.add_heat(&mut zone, heat)?;
        }
        if let Some(solar) = &columns.solar {
            let values = self.column(&solar.column, "irradiance")?;
            zone.irradiance_kw_per_m2 =
                Some(values.iter().map(|value| value * solar.factor * solar.unit.kw_per_m2()).collect());
        }
        Ok(zone)
    }

    /// The energy from each row to the next, in the unit of its column; that of the last row of a segment is the one before it.
    fn energies(&self, name: &str, reading: MeterReading) -> Result<Vec<f64>, TelemetryError> {
        let column = self.table.column(name, "energy")?;
        let values = self.column(name, "energy")?;
        let mut energies = values.clone();
        for segment in self.segments.iter().filter(|_| reading != MeterReading::FromRow) {
            let last = segment.end - 1;
            for row in segment.start..last {
                let (from, to) = (values[row], values[row + 1]);
                energies[row] = if reading == MeterReading::Counter { to - from } else { to };
                if reading == MeterReading::Counter && to < from {
                    let title = self.table.title(column);
                    let text = format!("the meter in column `{title}` falls from {from} to {to}");
                    let row = &self.table.rows[self.rows[row + 1]];
                    return Err(self.table.at(row, column, Problem::new(text, REMEDY_OF_COUNTER)));
                }
            }
            energies[last] = if last > segment.start { energies[last - 1] } else { 0.0 };
        }
        Ok(energies)
    }

    fn add_heat(&self, zone: &mut MeasuredZone, heat: &HeatColumns) -> Result<(), TelemetryError> {
        match heat {
            HeatColumns::Power { column, unit, factor } => {
                zone.power_has_unit &= *unit != PowerUnit::Unknown;
                let scale = unit.kw() * factor;
                let values = self.column(column, "power")?;
                zone.power_kw.iter_mut().zip(values).for_each(|(power, value)| *power += scale * value);
            }
            HeatColumns::Meter { column, unit, reading, factor } => {
                let scale = unit.kj() * factor / self.mapping.time.step_s;
                let energies = self.energies(column, *reading)?;
                zone.power_kw.iter_mut().zip(energies).for_each(|(power, energy)| *power += scale * energy);
            }
            HeatColumns::SupplyAir { flow, flow_unit, temperature } => {
                let conductance_kw_per_k =
                    self.column(flow, "supply air flow")?.iter().map(|flow| flow * flow_unit.kw_per_k()).collect();
                let temperature_c = self.temperature(temperature, "supply air temperature")?;
                zone.supply_air.push(SupplyAir { conductance_kw_per_k, temperature_c });
            }
            HeatColumns::Water { flow, flow_unit, inlet, outlet } => {
                let (flow, inlet, outlet) = (
                    self.column(flow, "water flow")?,
                    self.temperature(inlet, "inlet")?,
                    self.temperature(outlet, "outlet")?,
                );
                for (row, power) in zone.power_kw.iter_mut().enumerate() {
                    *power += flow[row] * flow_unit.kw_per_k() * (inlet[row] - outlet[row]);
                }
            }
        }
        Ok(())
    }
}
