//! The mapping of a table: which column contains which quantity, in which unit and with which sampling.
//!
//! A mapping is a small TOML file beside the CSV:
//!
//! ```toml
//! walls = [["living", "outdoor"]]
//!
//! [table]
//! separator = ";"
//!
//! [time]
//! column = "t"
//! format = "%Y-%m-%d %H:%M:%S"
//! step_s = 900.0
//!
//! [[boundary]]
//! name = "outdoor"
//! temperature = "Ta"
//!
//! [[zone]]
//! name = "living"
//! temperature = "yTi"
//! heat = [{ kind = "power", column = "P", unit = "kw" }]
//! solar = { column = "Ps", unit = "kw-per-m2" }
//! ```

use interplay_common::setting::SettingKey;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml::de::DeTable;

use super::error::{Problem, TelemetryError, listed};
use super::form;
use super::measurements::Hold;
use super::units::{AirFlowUnit, EnergyUnit, IrradianceUnit, PowerUnit, TableForm, WaterFlowUnit};
use crate::identify::IdentifySettings;
use crate::series::clock::NamedZone;

/// A mapping: which column of a table is which quantity. Unknown keys are refused.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mapping {
    /// The form of the table.
    #[serde(default)]
    pub table: TableForm,
    /// The time axis.
    pub time: TimeAxis,
    /// Measured temperatures that act on zones and are not modelled: outdoors, corridors.
    #[serde(default, rename = "boundary")]
    pub boundaries: Vec<BoundaryColumns>,
    /// The zones whose parameters are wanted.
    #[serde(rename = "zone")]
    #[schemars(length(min = 1))]
    pub zones: Vec<ZoneColumns>,
    /// Pairs of names, zone and zone or zone and boundary, between which heat flows.
    pub walls: Vec<[String; 2]>,
    /// Columns that are computed from those of the table, and then named like them.
    #[serde(default, rename = "column", skip_serializing_if = "Vec::is_empty")]
    pub columns: Vec<ComputedColumn>,
    /// How to identify; defaults for what is left out.
    #[serde(default)]
    pub identify: IdentifySettings,
}

/// A column that is computed: the mean of others, times a factor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ComputedColumn {
    /// Its name, which no column of the table has.
    pub name: String,
    /// The columns of the table of which it is the mean; a value is missing where one of theirs is.
    #[schemars(length(min = 1))]
    pub mean_of: Vec<String>,
    /// What the mean is multiplied by.
    #[serde(default = "one")]
    #[schemars(extend("not" = { "const": 0.0 }))]
    pub factor: f64,
}

/// The time axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TimeAxis {
    /// The column of times; without it, rows follow each other at `step_s`, the first at midnight.
    #[serde(default)]
    pub column: Option<String>,
    /// The form of the times: `seconds`, `hours`, or a pattern of `strptime` such as `%Y-%m-%d %H:%M:%S`. `%z` stands for an
    /// offset from UTC, such as `+08:00` or `+0800`.
    #[serde(default = "default_format")]
    pub format: String,
    /// The time zone of times without an offset, by its name in the tz database, such as `Europe/Zurich`: clocks that are put forward
    /// and back leave no gap. Without it clocks are taken to run evenly.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(example = &"Europe/Zurich")]
    pub zone: Option<String>,
    /// Sampling time \[s\].
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub step_s: f64,
    /// What to do about a gap in time or a missing value.
    #[serde(default)]
    pub gaps: Gaps,
    /// A column whose value changes where one recording ends and another begins.
    #[serde(default)]
    pub batch: Option<String>,
}

fn default_format() -> String {
    "%Y-%m-%d %H:%M:%S".into()
}

/// What to do about a gap in time or a missing value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Gaps {
    /// An error says where it is.
    #[default]
    Refuse,
    /// Incomplete rows are left out, and what follows is a recording of its own. Time may also go backwards there.
    Split,
    /// As `split`, but rows that lack only temperatures of zones are kept: `state-space` predicts these.
    Bridge,
}

/// A measured temperature that is not modelled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoundaryColumns {
    /// Name by which walls refer to it.
    pub name: String,
    /// The column of its temperature.
    pub temperature: String,
    /// How the series goes on between rows.
    #[serde(default = "Hold::first_order")]
    pub hold: Hold,
}

/// The columns of a zone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ZoneColumns {
    /// Name by which walls refer to it.
    pub name: String,
    /// The column of its temperature.
    pub temperature: String,
    /// Everything known that heats or cools it: control input u and predicted disturbance w of eq. 2.4, summed.
    #[serde(default)]
    pub heat: Vec<HeatColumns>,
    /// How the heat goes on between rows.
    #[serde(default = "Hold::zero_order")]
    pub heat_hold: Hold,
    /// Irradiance, whose effect gets a coefficient of its own (an aperture).
    #[serde(default)]
    pub solar: Option<SolarColumn>,
}

/// A known heat flow into a zone, from one or several columns. Heating is positive.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, tag = "kind", rename_all = "kebab-case")]
pub enum HeatColumns {
    /// A power meter, a schedule, or a signal in proportion to power.
    Power {
        /// The column.
        column: String,
        /// Its unit; `unknown` for a signal without one.
        unit: PowerUnit,
        /// What the column is multiplied by, −1 for a cooling power.
        #[serde(default = "one")]
        #[schemars(extend("not" = { "const": 0.0 }))]
        factor: f64,
    },
    /// A meter of energy, such as one of kilowatt-hours: the mean power from a row to the next follows from it. The last row of a
    /// recording keeps the power before it.
    Meter {
        /// The column.
        column: String,
        /// Its unit.
        unit: EnergyUnit,
        /// What a row states.
        #[serde(default)]
        reading: MeterReading,
        /// What the column is multiplied by, −1 for a cooling energy, or the efficiency of a boiler.
        #[serde(default = "one")]
        #[schemars(extend("not" = { "const": 0.0 }))]
        factor: f64,
    },
    /// Air blown in: ṁ c_p (T_supply − T_zone), the control input of eq. 2.2.
    SupplyAir {
        /// The column of the flow.
        flow: String,
        /// Its unit.
        flow_unit: AirFlowUnit,
        /// The column of the supply temperature.
        temperature: String,
    },
    /// A coil or radiator in the zone: flow · heat capacity of water · (T_inlet − T_outlet).
    Water {
        /// The column of the flow.
        flow: String,
        /// Its unit.
        flow_unit: WaterFlowUnit,
        /// The column of the inlet temperature.
        inlet: String,
        /// The column of the outlet temperature.
        outlet: String,
    },
}

fn one() -> f64 {
    1.0
}

/// What a row of a meter of energy states.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MeterReading {
    /// The count of the meter, which only rises; energies are differences.
    #[default]
    Counter,
    /// The energy from the row before to this one.
    UntilRow,
    /// The energy from this row to the next.
    FromRow,
}

/// A column of irradiance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolarColumn {
    /// The column.
    pub column: String,
    /// Its unit.
    pub unit: IrradianceUnit,
    /// What the column is multiplied by.
    #[serde(default = "one")]
    #[schemars(extend("not" = { "const": 0.0 }))]
    pub factor: f64,
    /// How the series goes on between rows.
    #[serde(default = "Hold::first_order")]
    pub hold: Hold,
}

impl TimeAxis {
    /// Whether times are dates, and not numbers.
    pub(super) fn has_dates(&self) -> bool {
        !["seconds", "hours"].contains(&self.format.as_str())
    }
}

impl Mapping {
    /// Reads a mapping; `file` is its name for messages.
    ///
    /// # Errors
    /// [`TelemetryError`], with line and column, when the text is not TOML of this form, or a value makes no sense. Everything that is
    /// wrong with the form is told at once.
    pub fn parse(file: &str, text: &str) -> Result<Self, TelemetryError> {
        let refused = |offset: Option<usize>, problem| {
            TelemetryError::new(file, offset.map(|offset| line_and_column(text, offset)), problem)
        };
        let unreadable = |error: toml::de::Error| {
            let reason = error.message().trim().replace('\n', ", ");
            refused(
                error.span().map(|span| span.start),
                Problem::new(format!("not valid TOML: {reason}"), form::SEE_EXAMPLES),
            )
        };
        let document = DeTable::parse(text).map_err(unreadable)?;
        let faults = form::check::<Self>(&document);
        let faults = faults.into_iter().map(|(offset, problem)| refused(Some(offset), problem)).collect();
        if let Some(error) = TelemetryError::of_all(faults) {
            return Err(error);
        }
        let mapping: Self = toml::from_str(text).map_err(unreadable)?;
        mapping.check().map_err(|(keys, problem)| {
            let stated = keys.iter().find_map(|key| form::place_of(document.get_ref(), key.as_str()));
            refused(stated, problem)
        })?;
        Ok(mapping)
    }

    /// Checks what the form alone cannot.
    fn check(&self) -> Result<(), Refusal> {
        self.check_separator()?;
        self.check_time_zone()?;
        for (index, zone) in self.zones.iter().enumerate() {
            zone.check_heat(&SettingKey::from("zone").entry(index))?;
        }
        self.check_names()?;
        self.identify.check(self.time.step_s).map_err(|error| {
            let key = SettingKey::from("identify").key(error.key.as_str());
            let problem = Problem::out_of_bounds(&key, error.value, error.bound);
            // If the key is not stated, its default does not fit the sampling time.
            (vec![key, "time.step_s".into()], problem)
        })
    }

    fn check_separator(&self) -> Result<(), Refusal> {
        let TableForm { separator, decimal, .. } = self.table;
        if separator != decimal.character() {
            return Ok(());
        }
        let key = SettingKey::from("table.separator");
        let wanted = "another character than `table.decimal`";
        let problem = conflict(&key, &format!("`{separator}`"), wanted);
        // Suggest to leave out one of the two keys.
        Err((vec![key, "table.decimal".into()], problem))
    }

    fn check_time_zone(&self) -> Result<(), Refusal> {
        let Some(name) = &self.time.zone else { return Ok(()) };
        let key = SettingKey::from("time.zone");
        if NamedZone::find(name).is_none() {
            let problem = form::unknown_word(&key, name, &NamedZone::names());
            return Err((vec![key], problem));
        }
        if self.time.column.is_some() && self.time.has_dates() && !self.time.format.contains("%z") {
            return Ok(());
        }
        let wanted = "left out, or beside a `time.column` of dates without an offset";
        let problem = conflict(&key, &format!("`{name}`"), wanted);
        Err((vec![key], problem))
    }

    fn check_names(&self) -> Result<(), Refusal> {
        let key = |list: &str, index| SettingKey::from(list).entry(index).key("name");
        let zones = self.zones.iter().enumerate().map(|(index, zone)| (&zone.name, key("zone", index)));
        let others = self.boundaries.iter().enumerate().map(|(index, other)| (&other.name, key("boundary", index)));
        let (names, keys): (Vec<&String>, Vec<SettingKey>) = zones.chain(others).unzip();
        let wrong = |key: SettingKey, field: &str, name: &str, fault: &str| {
            let known: Vec<String> = names.iter().map(|&name| name.clone()).collect();
            let text = format!("the name `{name}` in {field} is {fault}");
            Err((vec![key], Problem::new(text, format!("known names: {}", listed(&known)))))
        };
        for (i, name) in names.iter().enumerate() {
            if names[..i].contains(name) {
                return wrong(keys[i].clone(), "zone and boundary", name, "used twice");
            }
        }
        let is_zone = |name: &String| self.zones.iter().any(|zone| zone.name == *name);
        for (i, [one, other]) in self.walls.iter().enumerate() {
            let wall = SettingKey::from("walls").entry(i);
            for (side, name) in [one, other].into_iter().enumerate() {
                if !names.contains(&name) {
                    return wrong(wall.entry(side), "walls", name, "unknown");
                }
            }
            if one == other {
                return wrong(wall, "walls", one, "on both sides of one wall");
            }
            if !is_zone(one) && !is_zone(other) {
                return wrong(wall, "walls", one, "a boundary, and so is the other side: one must be a zone");
            }
            if self.walls[..i].iter().any(|[a, b]| (a, b) == (one, other) || (b, a) == (one, other)) {
                return wrong(wall, "walls", one, "paired twice with the same other side");
            }
        }
        Ok(())
    }
}

/// What is wrong, and the keys that could be blamed for it, numbered throughout; the first one that is stated is.
type Refusal = (Vec<SettingKey>, Problem);

/// The value of a key contradicts that of another key.
fn conflict(key: &SettingKey, value: &str, wanted: &str) -> Problem {
    Problem::new(format!("`{key}` is {value}"), format!("it must be {wanted}"))
}

impl ZoneColumns {
    /// Refuses heat without a unit beside other heat, and energies that would not be means; `numbered` is the key of this zone in the
    /// document.
    fn check_heat(&self, numbered: &SettingKey) -> Result<(), Refusal> {
        let is_meter = |heat: &HeatColumns| matches!(heat, HeatColumns::Meter { .. });
        if self.heat_hold == Hold::FirstOrder && self.heat.iter().any(is_meter) {
            let key = SettingKey::from("zone").key(&self.name).key("heat_hold");
            let value = "`first-order` beside a meter of energy";
            let wanted = "`zero-order`: a meter knows the mean from a row to the next";
            return Err((vec![numbered.key("heat_hold")], conflict(&key, value, wanted)));
        }
        let is_unknown = |heat: &HeatColumns| matches!(heat, HeatColumns::Power { unit: PowerUnit::Unknown, .. });
        let Some(index) = self.heat.iter().position(is_unknown).filter(|_| self.heat.len() > 1) else { return Ok(()) };
        let unit_of = |zone: &SettingKey| zone.key("heat").entry(index).key("unit");
        let value = format!("`unknown` beside other heat of zone `{}`", self.name);
        let wanted = "a known unit, or the zone's only heat: their sum would mean nothing";
        Err((vec![unit_of(numbered)], conflict(&unit_of(&SettingKey::from("zone").key(&self.name)), &value, wanted)))
    }
}

/// Line and column of a byte offset, both from 1, the column in characters.
fn line_and_column(text: &str, offset: usize) -> (usize, usize) {
    let before = &text[..text.floor_char_boundary(offset)];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}
