//! Expectations in words: what was wanted and what a run gave, with units, instead of JSON.

use std::fmt;

use interplay_common::units::{quantity_of, unit_of};
use serde_json::Value;

use super::outcome::Expectation;

impl Expectation {
    /// The wanted and the actual outcome in words: `oncoming lets ego go first` and `oncoming first, 6.0 s before ego`.
    pub fn words(&self) -> [String; 2] {
        let [want, got] = self.shown();
        let (key, rest) = self.what.split_once('.').unwrap_or((&self.what, ""));
        let [wanted, got] = match key {
            "no_collision" => [contacts(&want), contacts(&got)],
            "collisions" => [pairs(&want), pairs(&got)],
            "rules_kept" => [rules(&want), rules(&got)],
            "order_differs" => [order(&want), order(&got)],
            "yields" => {
                let (second, first) = rest.split_once(".to.").unwrap_or((rest, ""));
                [format!("{second} lets {first} go first"), right_of_way(&got)]
            }
            "completes" => [window(rest, &want), at_time(&got)],
            "later" | "earlier" => {
                let by = value_in_words(&want["by_s"]);
                let [own, changed] = ["main_s", "counterfactual_s"].map(|key| at_time(&got[key]));
                [format!("{rest} arrives at least {by} s {key}"), format!("{changed}, and {own} without the change")]
            }
            _ => bound(&self.what, &want, &got),
        };
        [wanted, self.at.iter().fold(got, |got, at| format!("{got} ({at})"))]
    }
}

impl fmt::Display for Expectation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [wanted, got] = self.words();
        write!(f, "{}: wanted: {wanted}; got: {got}", self.what)
    }
}

fn contacts(none: &Value) -> String {
    if none == &Value::Bool(true) { "no contact" } else { "a contact" }.to_owned()
}

fn order(differs: &Value) -> String {
    if differs == &Value::Bool(true) { "another order" } else { "the same order" }.to_owned()
}

/// `ego with front, rear with ego`.
fn pairs(all: &Value) -> String {
    let pair = |pair: &Value| format!("{} with {}", value_in_words(&pair[0]), value_in_words(&pair[1]));
    let all: Vec<String> = all.as_array().into_iter().flatten().map(pair).collect();
    if all.is_empty() { "no contact".to_owned() } else { all.join(", ") }
}

fn rules(kept: &Value) -> String {
    let Some(broken) = kept.get("rules_broken").and_then(Value::as_object) else {
        return if kept == &Value::Bool(true) { "all rules kept" } else { "a rule broken" }.to_owned();
    };
    let times = |count: &Value| if count == 1 { "once".to_owned() } else { format!("{count} times") };
    let all: Vec<String> = broken.iter().map(|(name, count)| format!("{name} broke a rule {}", times(count))).collect();
    all.join(", ")
}

/// Which vehicle went first through one or several zones.
fn right_of_way(got: &Value) -> String {
    if let Value::Array(all) = got {
        return all.iter().map(right_of_way).collect::<Vec<_>>().join("; ");
    }
    let Some(first) = got["first"].as_str() else { return value_in_words(got) };
    let second = value_in_words(&got["second"]);
    let closely = if got["yielded"] == false { ", which neither slowed down nor kept its distance" } else { "" };
    match (got["first_s"].as_f64(), got["second_s"].as_f64()) {
        (Some(first_s), Some(second_s)) => {
            let before_s = second_s - first_s;
            format!("{first} first, {before_s:.1} s before {second}{closely}")
        }
        _ => format!("{first} first; {second} never entered"),
    }
}

/// When a vehicle is to reach its goal.
fn window(vehicle: &str, want: &Value) -> String {
    let limit = |key: &str, word: &str| Some(format!("{word} {} s", value_in_words(want.get(key)?)));
    let limits = [limit("after_s", "not before"), limit("before_s", "by")].into_iter().flatten();
    let limits = limits.collect::<Vec<_>>().join(" and ");
    format!("{vehicle} reaches its goal {limits}").trim_end().to_owned()
}

fn at_time(got: &Value) -> String {
    match got {
        Value::Null => "never".to_owned(),
        Value::Number(time_s) => format!("at {time_s} s"),
        other => value_in_words(other),
    }
}

/// A bound by its key, such as `min_gap_m` or `metric.cut_ins.at_most`, with the unit of the key.
fn bound(what: &str, want: &Value, got: &Value) -> [String; 2] {
    let key = what.rsplit('.').next().unwrap_or(what);
    let metric = what.strip_prefix("metric.").and_then(|rest| rest.split('.').next());
    let unit = unit_of(metric.unwrap_or(key)).map_or_else(String::new, |unit| format!(" {unit}"));
    let ends = |ending: &[&str]| ending.iter().any(|ending| key.contains(ending));
    let side = match want {
        Value::Number(_) if ends(&["at_most"]) => "at most ",
        Value::Number(_) if ends(&["at_least"]) || key == "min_gap_m" => "at least ",
        Value::Number(_) if ends(&["_below"]) => "below ",
        Value::Number(_) if ends(&["_above"]) => "above ",
        _ => "",
    };
    let with_unit = |value: &Value| match value {
        Value::Number(number) => format!("{number}{unit}"),
        other => value_in_words(other),
    };
    let got = match got.get("peak") {
        Some(peak) => format!("{}{}", with_unit(peak), moment(got)),
        None => with_unit(got),
    };
    [format!("{side}{}", with_unit(want)), got]
}

/// ` at 3.2 s`, for a table with a time.
fn moment(table: &Value) -> String {
    table.get("time_s").filter(|time| !time.is_null()).map_or_else(String::new, |time_s| format!(" at {time_s} s"))
}

/// A value of JSON in words, with units for the keys that end with one: `4.529 m between ego and ring at 5.06 s`.
fn value_in_words(value: &Value) -> String {
    match value {
        Value::Null => "none".to_owned(),
        Value::Bool(holds) => if *holds { "yes" } else { "no" }.to_owned(),
        Value::Number(number) => number.to_string(),
        Value::String(word) => word.clone(),
        Value::Array(items) if items.is_empty() => "none".to_owned(),
        Value::Array(items) => items.iter().map(value_in_words).collect::<Vec<_>>().join(", "),
        Value::Object(table) => {
            let plain = |key: &&String| !["time_s", "between", "vehicle"].contains(&key.as_str());
            let entry = |key: &String| {
                // The key of a length may consist of its unit alone.
                let suffixed = format!("_{key}");
                let quantity = quantity_of(&suffixed).replace('_', " ");
                let quantity = if key == "value" { "" } else { quantity.trim() };
                let unit = unit_of(&suffixed).unwrap_or_default();
                format!("{quantity} {} {unit}", value_in_words(&table[key])).trim().to_owned()
            };
            let entries: Vec<String> = table.keys().filter(plain).map(entry).collect();
            let between = table.get("between").and_then(Value::as_array).map_or_else(String::new, |pair| {
                format!(" between {}", pair.iter().map(value_in_words).collect::<Vec<_>>().join(" and "))
            });
            let of = table.get("vehicle").map_or_else(String::new, |name| format!(" of {}", value_in_words(name)));
            format!("{}{between}{of}{}", entries.join(", "), moment(value))
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// The line of a report for an expectation.
    fn line(what: &str, want: Value, got: Value) -> String {
        Expectation { what: what.to_owned(), want, got, passed: false, at: None }.to_string()
    }

    #[test]
    fn expectations_are_told_in_words() {
        let passage = json!({ "first": "oncoming", "second": "ego", "first_s": 2.02, "second_s": 8.0,
            "post_encroachment_s": 4.0, "yielded": true });
        let strict = json!({ "first": "ego", "second": "oncoming", "yielded": true });
        for (what, want, got, words) in [
            (
                "yields.oncoming.to.ego",
                strict,
                passage,
                "wanted: oncoming lets ego go first; got: oncoming first, 6.0 s before ego",
            ),
            ("no_collision", json!(true), json!(false), "wanted: no contact; got: a contact"),
            ("collisions", json!([]), json!([["a", "b"]]), "wanted: no contact; got: a with b"),
            (
                "completes.ego",
                json!({ "before_s": 9.0 }),
                json!(null),
                "wanted: ego reaches its goal by 9.0 s; got: never",
            ),
            ("completes.ego", json!("any time"), json!(4.5), "wanted: ego reaches its goal; got: at 4.5 s"),
            ("min_gap_m", json!(9.0), json!(0.5), "wanted: at least 9.0 m; got: 0.5 m"),
            ("speed.ego.min_above_mps", json!(1.0), json!(0.5), "wanted: above 1.0 m/s; got: 0.5 m/s"),
            ("metric.cut_ins.ego.at_most", json!(0), json!(2), "wanted: at most 0; got: 2"),
            (
                "rules_kept",
                json!(true),
                json!({ "rules_broken": { "ego": 1 } }),
                "wanted: all rules kept; got: ego broke a rule once",
            ),
            ("order_differs", json!(true), json!(false), "wanted: another order; got: the same order"),
            (
                "gap_at_least_m",
                json!(0.5),
                json!({ "m": 0.3, "between": ["a", "b"], "time_s": 16.6 }),
                "wanted: at least 0.5 m; got: 0.3 m between a and b at 16.6 s",
            ),
        ] {
            assert_eq!(line(what, want, got), format!("{what}: {words}"));
        }
    }
}
