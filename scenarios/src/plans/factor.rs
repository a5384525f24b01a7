//! A path whose value varies, and its values.

use interplay_building::control::uncertainty::normal_quantile;
use interplay_common::random::Random;
use interplay_common::spelling::nearest;

use crate::format::json_schema::SchemaNode;
use crate::format::read::overrides::SettingPath;
use crate::format::read::tree::{Table, TomlNode, TomlValue, kind_of};
use crate::plans::plan_file::Sampling;
use crate::text::error::{Fault, Place, quoted};

#[derive(Clone)]
pub(super) struct Factor {
    pub path: SettingPath,
    pub place: Place,
    values: Values,
    draws: UnitDraws,
}

#[derive(Clone)]
enum Values {
    List(Vec<TomlNode>),
    /// Evenly spaced whole numbers: the first, the step, and how many.
    Integers(i128, i128, usize),
    /// Evenly spaced numbers: the first, the last, and how many.
    Numbers(f64, f64, usize),
    /// Uniformly distributed between two bounds.
    Uniform(f64, f64),
    /// Log-uniformly distributed between two bounds.
    LogUniform(f64, f64),
    /// Normally distributed: mean and standard deviation.
    Normal(f64, f64),
}

/// The keys of a table that stands for values.
const DISTRIBUTIONS: [&str; 4] = ["range", "uniform", "normal", "log_uniform"];
/// The most values of a range.
const MAX_VALUES: usize = 1_000_000;
/// The forms of a value, for errors.
const EXAMPLE: &str = "write a list of values, or for example `{ range = [0.0, 1.0], count = 11 }`, `{ uniform = [0.0, 1.0] }`, \
    `{ normal = { mean = 1.0, sd = 0.1 } }` or `{ log_uniform = [0.1, 10.0] }`";

/// The sampling, the seed, and the number of samples.
pub(super) type DrawSettings = (Sampling, u64, u64);

/// The factors of a `vary` table, in the order of their paths.
pub(super) fn factors(vary: &Table, settings: DrawSettings, schema: SchemaNode) -> Result<Vec<Factor>, Vec<Fault>> {
    let (mut found, mut faults) = (Vec::new(), Vec::new());
    collect(&SettingPath::root(), vary, settings, schema, &mut found, &mut faults);
    if faults.is_empty() { Ok(found) } else { Err(faults) }
}

fn collect(
    before: &SettingPath,
    vary: &Table,
    settings: DrawSettings,
    schema: SchemaNode,
    found: &mut Vec<Factor>,
    faults: &mut Vec<Fault>,
) {
    for (key, entry) in vary {
        let path = match before.join(key, &entry.key) {
            Ok(path) if path.written() != "seed" => path,
            Ok(_) => {
                let fault = Fault::at(&entry.key, "cannot vary", "the seed of a run follows from its sample");
                faults.push(fault.help("state `samples`, and the `seed` of the first"));
                continue;
            }
            Err(fault) => {
                faults.push(fault);
                continue;
            }
        };
        match &entry.node.value {
            TomlValue::Table(table) if !table.keys().any(|key| DISTRIBUTIONS.contains(&key.as_str())) => {
                match misspelt(&path, table, schema) {
                    Some(fault) => faults.push(fault),
                    None => collect(&path, table, settings, schema, found, faults),
                }
            }
            _ => match values_of(&entry.node) {
                Ok(values) => {
                    let (sampling, seed, samples) = settings;
                    let draws = UnitDraws::new(seed, &path.written(), sampling, samples);
                    found.push(Factor { path, place: entry.node.place.clone(), values, draws });
                }
                Err(fault) => faults.push(fault),
            },
        }
    }
}

/// The refusal of a table that is meant as a distribution: it replaces a setting that is not a table, or its
/// first key is nearly the name of one.
fn misspelt(path: &SettingPath, table: &Table, schema: SchemaNode) -> Option<Fault> {
    let (key, entry) =
        table.iter().find(|(key, _)| nearest(key, DISTRIBUTIONS).is_some()).or_else(|| table.iter().next())?;
    let property = path.schema(schema);
    let is_value =
        property.is_some_and(|schema| matches!(schema.type_name(), Some("number" | "integer" | "boolean" | "string")));
    let is_close = nearest(key, DISTRIBUTIONS).is_some_and(|near| key.len().abs_diff(near.len()) <= 2);
    if !is_value && (!is_close || property.is_none_or(|schema| schema.property(key).is_some())) {
        return None;
    }
    let message = format!("{} is not a distribution of the values of {}", quoted(key), quoted(&path.written()));
    let near = nearest(key, DISTRIBUTIONS).map(|near| format!("did you mean `{near}`? "));
    Some(Fault::at(&entry.key, "unknown", message).help(format!("{}{EXAMPLE}", near.unwrap_or_default())))
}

fn values_of(node: &TomlNode) -> Result<Values, Fault> {
    match &node.value {
        TomlValue::Array(items) if items.is_empty() => {
            Err(Fault::at(&node.place, "empty", "a list of values must not be empty").help(EXAMPLE))
        }
        TomlValue::Array(items) => Ok(Values::List(items.clone())),
        TomlValue::Table(table) => distribution(node, table),
        other => {
            let message = format!("{} is neither a list nor a distribution", kind_of(other));
            Err(Fault::at(&node.place, "does not vary", message)
                .help(format!("{EXAMPLE}; one value belongs in `[set]`")))
        }
    }
}

fn distribution(node: &TomlNode, table: &Table) -> Result<Values, Fault> {
    let mut stated = DISTRIBUTIONS.iter().filter_map(|key| Some((*key, table.get(*key)?)));
    let Some((key, entry)) = stated.next() else {
        return Err(Fault::at(&node.place, "no distribution", "a table of values needs a distribution").help(EXAMPLE));
    };
    let allowed: &[&str] = if key == "range" { &["range", "count", "step"] } else { &[key] };
    if let Some((other, unknown)) = table.iter().find(|(other, _)| !allowed.contains(&other.as_str())) {
        let message = format!("`{other}` does not belong beside `{key}`");
        return Err(Fault::at(&unknown.key, "unknown here", message).help(EXAMPLE));
    }
    if key == "normal" {
        let part = |name: &str| entry.node.table().and_then(|table| number(&table.get(name)?.node));
        return match (part("mean"), part("sd")) {
            (Some(mean), Some(sd)) if sd > 0.0 => Ok(Values::Normal(mean, sd)),
            (Some(_), Some(_)) => {
                Err(Fault::at(&entry.node.place, "not above 0", "`sd` must be above 0").help(EXAMPLE))
            }
            _ => {
                Err(Fault::at(&entry.node.place, "incomplete", "`normal` needs the numbers `mean` and `sd`")
                    .help(EXAMPLE))
            }
        };
    }
    let ends = match &entry.node.value {
        TomlValue::Array(items) => items.iter().map(number).collect::<Option<Vec<f64>>>().unwrap_or_default(),
        _ => Vec::new(),
    };
    let [from, to] = ends.as_slice() else {
        let message = format!("`{key}` needs two numbers, from and to");
        return Err(Fault::at(&entry.node.place, "not two numbers", message).help(EXAMPLE));
    };
    let refuse = |label: &str, message: String| Err(Fault::at(&entry.node.place, label, message).help(EXAMPLE));
    match key {
        "range" if from > to => refuse("empty", format!("a range from {from} to {to} is empty")),
        "range" => range(entry.node.place.clone(), &entry.node, table, [*from, *to]),
        _ if from >= to => refuse("empty", format!("`{key}` from {from} to {to} is empty")),
        "log_uniform" if *from <= 0.0 => refuse("not above 0", "`log_uniform` needs bounds above 0".to_owned()),
        "log_uniform" => Ok(Values::LogUniform(*from, *to)),
        _ => Ok(Values::Uniform(*from, *to)),
    }
}

/// Evenly spaced values between two ends, by a count or by a step.
fn range(place: Place, ends: &TomlNode, table: &Table, [from, to]: [f64; 2]) -> Result<Values, Fault> {
    let integers = match &ends.value {
        TomlValue::Array(items) => items.iter().filter_map(integer).collect(),
        _ => Vec::new(),
    };
    let refuse = |place: &Place, label: &str, message: &str| Err(Fault::at(place, label, message).help(EXAMPLE));
    match (table.get("count"), table.get("step"), integers.as_slice()) {
        (Some(count), Some(_), _) => refuse(&count.key, "beside `step`", "a range has a `count` or a `step`"),
        (Some(count), None, _) => match integer(&count.node).and_then(|count| usize::try_from(count).ok()) {
            Some(1) if from < to => refuse(&count.node.place, "too few", "one value does not reach from end to end"),
            Some(count @ 1..=MAX_VALUES) => Ok(Values::Numbers(from, to, count)),
            _ => refuse(&count.node.place, "not 1 to 1000000", "`count` must be a whole number from 1 to 1000000"),
        },
        (None, step, [from, to]) if step.is_none_or(|step| integer(&step.node).is_some()) => {
            let step = step.and_then(|step| integer(&step.node)).unwrap_or(1);
            match usize::try_from((to - from).checked_div(step).unwrap_or(-1)) {
                Ok(steps) if step > 0 && steps < MAX_VALUES => Ok(Values::Integers(*from, step, steps + 1)),
                _ => refuse(&place, "too many, or none", "a range has 1 to 1000000 values, `step` apart"),
            }
        }
        (None, Some(step), _) => match number(&step.node) {
            Some(width) if width > 0.0 && (to - from) / width < MAX_VALUES as f64 => {
                // If the step divides the range, up to rounding, the last value is the end of the range.
                let steps = ((to - from) / width + 1e-9).floor();
                Ok(Values::Numbers(from, from + steps * width, steps as usize + 1))
            }
            _ => refuse(&step.node.place, "no step", "`step` must be a number above 0, with at most 1000000 values"),
        },
        (None, None, _) => refuse(&place, "how many?", "a range of numbers needs a `count` or a `step`"),
    }
}

fn number(node: &TomlNode) -> Option<f64> {
    match node.value {
        TomlValue::Integer(integer) => Some(integer as f64),
        TomlValue::Float(float) => Some(float).filter(|float| float.is_finite()),
        _ => None,
    }
}

fn integer(node: &TomlNode) -> Option<i128> {
    match node.value {
        TomlValue::Integer(integer) => Some(integer),
        _ => None,
    }
}

impl Factor {
    /// Whether all values are numbers.
    pub fn is_numeric(&self) -> bool {
        match &self.values {
            Values::List(items) => items.iter().all(|item| number(item).is_some()),
            _ => true,
        }
    }

    /// The place at which the last word of its path is written.
    pub fn key(&self) -> &Place {
        self.path.places().last().unwrap_or(&self.place)
    }

    /// The values of a list.
    pub fn listed(&self) -> &[TomlNode] {
        match &self.values {
            Values::List(items) => items,
            _ => &[],
        }
    }

    /// The number of values, if finite.
    pub fn count(&self) -> Option<usize> {
        match &self.values {
            Values::List(items) => Some(items.len()),
            Values::Integers(_, _, count) | Values::Numbers(_, _, count) => Some(*count),
            Values::Uniform(..) | Values::LogUniform(..) | Values::Normal(..) => None,
        }
    }

    /// The value with this index, for a factor with finitely many values.
    pub fn value(&self, index: usize) -> TomlNode {
        match &self.values {
            Values::List(items) => items[index].clone(),
            Values::Integers(first, step, _) => self.node(TomlValue::Integer(first + step * index as i128)),
            Values::Numbers(first, last, count) => {
                let share = if *count > 1 { index as f64 / (count - 1) as f64 } else { 0.0 };
                self.node(TomlValue::Float(if share == 1.0 { *last } else { first + share * (last - first) }))
            }
            Values::Uniform(..) | Values::LogUniform(..) | Values::Normal(..) => self.drawn(index as u64),
        }
    }

    /// The value that is drawn for a sample.
    pub fn drawn(&self, sample: u64) -> TomlNode {
        let unit = self.draws.at(sample);
        if let Some(count) = self.count() {
            return self.value(((unit * count as f64) as usize).min(count - 1));
        }
        let number = match self.values {
            Values::Uniform(from, to) => from + unit * (to - from),
            Values::LogUniform(from, to) => libm::exp(libm::log(from) + unit * (libm::log(to) - libm::log(from))),
            Values::Normal(mean, sd) => mean + sd * normal_quantile(unit),
            Values::List(_) | Values::Integers(..) | Values::Numbers(..) => unit,
        };
        self.node(TomlValue::Float(number))
    }

    /// The extreme values; of a list, all values up to `limit`.
    pub fn extremes(&self, limit: usize) -> Vec<TomlNode> {
        let ends = |ends: [f64; 2]| ends.map(|end| self.node(TomlValue::Float(end))).to_vec();
        match &self.values {
            Values::List(items) => items.iter().take(limit).cloned().collect(),
            Values::Integers(_, _, count) | Values::Numbers(_, _, count) => vec![self.value(0), self.value(count - 1)],
            Values::Uniform(from, to) | Values::LogUniform(from, to) => ends([*from, *to]),
            // A normal distribution has no extremes; instead, every drawn value is checked.
            Values::Normal(mean, _) => vec![self.node(TomlValue::Float(*mean))],
        }
    }

    fn node(&self, value: TomlValue) -> TomlNode {
        TomlNode { place: self.place.clone(), value }
    }
}

/// The random numbers of one path of a plan.
#[derive(Clone, Debug)]
pub(super) struct UnitDraws {
    /// The seed of the path's streams; each sample has a stream of its own.
    seed: u64,
    /// In a Latin hypercube, the part of the unit interval from which each sample is drawn.
    strata: Vec<u32>,
}

/// The stream of a path's permutation; samples have the streams from 0 on.
const PERMUTATION_STREAM: u64 = u64::MAX;

impl UnitDraws {
    /// The random numbers of a path under the seed of a plan.
    pub fn new(seed: u64, path: &str, sampling: Sampling, samples: u64) -> UnitDraws {
        let seed = seed.wrapping_add(hash(path));
        let count = if sampling == Sampling::LatinHypercube { u32::try_from(samples).unwrap_or(u32::MAX) } else { 0 };
        let mut strata: Vec<u32> = (0..count).collect();
        // The Fisher-Yates shuffle.
        let mut random = Random::new(seed, PERMUTATION_STREAM);
        for last in (1..strata.len()).rev() {
            let other = random.uniform(0.0, (last + 1) as f64) as usize;
            strata.swap(last, other.min(last));
        }
        UnitDraws { seed, strata }
    }

    /// The number of a sample, in the open interval (0, 1).
    pub fn at(&self, sample: u64) -> f64 {
        // Adding half a step avoids zero: a normal distribution has infinite quantiles at both ends.
        let unit = Random::new(self.seed, sample).uniform(0.0, 1.0) + 0.5_f64.powi(54);
        let stratum = usize::try_from(sample).ok().and_then(|sample| self.strata.get(sample));
        let drawn = stratum.map_or(unit, |stratum| (f64::from(*stratum) + unit) / self.strata.len() as f64);
        drawn.min(1.0 - 0.5_f64.powi(53))
    }
}

/// The FNV-1a hash of a text.
fn hash(text: &str) -> u64 {
    text.bytes().fold(0xCBF2_9CE4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01B3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stratum_of_a_latin_hypercube_has_one_sample() {
        let draws = UnitDraws::new(1, "a.b", Sampling::LatinHypercube, 50);
        let mut parts: Vec<usize> = (0..50).map(|sample| (draws.at(sample) * 50.0) as usize).collect();
        assert!(parts.windows(2).any(|pair| pair[1] < pair[0]), "not in order");
        parts.sort_unstable();
        assert_eq!(parts, (0..50).collect::<Vec<_>>());
    }

    #[test]
    fn drawn_numbers_do_not_depend_on_sample_count_or_other_paths() {
        let [few, many] = [10, 1000].map(|samples| UnitDraws::new(7, "a.b", Sampling::Random, samples));
        assert!((0..10).all(|sample| few.at(sample) == many.at(sample)));
        let other = UnitDraws::new(7, "a.c", Sampling::Random, 10);
        assert!((0..10).all(|sample| few.at(sample) != other.at(sample)));
        let mean = (0..1000).map(|sample| many.at(sample)).sum::<f64>() / 1000.0;
        // Four standard errors.
        assert!((mean - 0.5).abs() < 4.0 / (12.0_f64 * 1000.0).sqrt(), "{mean}");
    }
}
