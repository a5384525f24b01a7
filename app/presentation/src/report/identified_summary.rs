//! An identification in a few lines: what is known, what is not and why, and what to measure next.

use std::fmt::{self, Write};

use interplay_building::identify::{
    Confidence, Identification, IdentificationReport, Quantity, SuspectedCause, ZoneReport,
};
use interplay_common::spelling::counted;

use super::columns::written;
use super::identification::number;

/// The most lines of a summary.
const MAX_LINES: usize = 40;
/// Kilojoules above which heat capacities are stated in megajoules \[kJ\].
const LARGE_KJ: f64 = 1e4;

/// The findings in at most forty lines.
pub fn identified_summary(file: &str, found: &Identification) -> String {
    let text = written(|text| write_summary(text, file, &found.report));
    let lines: Vec<&str> = text.lines().collect();
    if lines.len() <= MAX_LINES {
        return text;
    }
    let left = lines.len() - MAX_LINES + 1;
    format!("{}\n  … {left} more lines with --details\n", lines[..MAX_LINES - 1].join("\n"))
}

fn write_summary(text: &mut String, file: &str, report: &IdentificationReport) -> fmt::Result {
    let minutes = report.step_s / 60.0;
    let days = report.rows as f64 * report.step_s / 86_400.0;
    let rows = counted(report.rows, "row");
    writeln!(text, "{file}: {rows} every {} min, {days:.1} days", number(minutes))?;
    for zone in &report.zones {
        write_known(text, report, zone)?;
        write_unknown(text, report, zone)?;
        write_prediction(text, zone)?;
    }
    if !report.suspicions.is_empty() {
        writeln!(text, "\nwhy numbers are disputed, the most probable cause first")?;
        for suspicion in &report.suspicions {
            writeln!(text, "  - {}", suspicion.words)?;
        }
    }
    let next = what_next(report);
    if !next.is_empty() {
        writeln!(text, "\nwhat to measure next")?;
        next.iter().try_for_each(|words| writeln!(text, "  - {words}"))?;
    }
    writeln!(text, "\n--details prints all numbers, models and tests; --scenario FILE.toml writes the building")
}

/// Name of a zone, where there are several.
fn of_zone(report: &IdentificationReport, zone: &ZoneReport) -> String {
    if report.zones.len() > 1 { format!(" of {}", zone.name) } else { String::new() }
}

/// The physical quantities that a reader looks for: a resistance says what its conductance says.
fn quantities(zone: &ZoneReport) -> impl Iterator<Item = &Quantity> {
    let all = if zone.physical.is_empty() { &zone.coefficients } else { &zone.physical };
    all.iter().filter(|quantity| !quantity.name.starts_with("resistance to"))
}

fn write_known(text: &mut String, report: &IdentificationReport, zone: &ZoneReport) -> fmt::Result {
    let is_known = |quantity: &&Quantity| quantity.verdict.confidence == Confidence::Identified;
    let known: Vec<&Quantity> = quantities(zone).filter(is_known).collect();
    if known.is_empty() {
        return Ok(());
    }
    writeln!(text, "\nwhat is known{}, if the recorded heat is right (95 % intervals)", of_zone(report, zone))?;
    known.iter().try_for_each(|quantity| writeln!(text, "  {}: {}", quantity.name, in_words(quantity)))
}

fn write_unknown(text: &mut String, report: &IdentificationReport, zone: &ZoneReport) -> fmt::Result {
    let unknown: Vec<&Quantity> =
        quantities(zone).filter(|quantity| quantity.verdict.confidence != Confidence::Identified).collect();
    if unknown.is_empty() {
        return Ok(());
    }
    writeln!(text, "\nwhat is not known{}", of_zone(report, zone))?;
    for quantity in unknown {
        let reason = match quantity.verdict.confidence {
            Confidence::Disputed => "disputed",
            Confidence::Weak => "too uncertain",
            Confidence::NotDistinguishableFromZero => "may be zero",
            Confidence::WrongSign => "has the wrong sign",
            Confidence::NotIdentifiable | Confidence::Identified => "the record does not tell",
        };
        let words = in_words(quantity);
        let words = if words.is_empty() { reason.to_owned() } else { format!("{reason}: {words}") };
        writeln!(text, "  {}: {words}", quantity.name)?;
    }
    Ok(())
}

/// Value and interval with their unit; only what is known of them.
fn in_words(quantity: &Quantity) -> String {
    let (factor, unit) = match (quantity.unit.as_str(), quantity.interval) {
        ("kJ/K", (Some(end), _) | (None, Some(end))) if end >= LARGE_KJ => (1e-3, "MJ/K"),
        (unit, _) => (1.0, unit),
    };
    let stated = |value: f64| number(factor * value);
    match (quantity.value, quantity.interval) {
        (Some(value), (Some(low), Some(high))) => {
            format!("{} {unit} ({} to {})", stated(value), stated(low), stated(high))
        }
        (_, (Some(low), None)) => format!("at least {} {unit}", stated(low)),
        (_, (None, Some(high))) => format!("at most {} {unit}", stated(high)),
        (Some(value), _) => format!("{} {unit}", stated(value)),
        _ => String::new(),
    }
}

fn write_prediction(text: &mut String, zone: &ZoneReport) -> fmt::Result {
    let errors = zone.test.as_ref().unwrap_or(&zone.train);
    let free = &errors.free_run;
    let Some(error_k) = free.errors_k.iter().find_map(|(_, error_k)| *error_k) else { return Ok(()) };
    write!(text, "\n{}: {} h ahead the network errs by {error_k:.2} K", zone.name, number(free.horizon_h))?;
    match free.mean_of_data_k {
        Some(mean_k) if error_k >= mean_k => {
            writeln!(text, ", the mean of the data by {mean_k:.2} K: do not use it for control")
        }
        Some(mean_k) => writeln!(text, ", the mean of the data by {mean_k:.2} K"),
        None => writeln!(text),
    }
}

/// What would make more numbers known, each once.
fn what_next(report: &IdentificationReport) -> Vec<&'static str> {
    let mut next: Vec<&'static str> = report.suspicions.iter().map(|it| by_cause(it.cause)).collect();
    if report.suspicions.is_empty() {
        let doubtful = report.zones.iter().flat_map(quantities);
        for quantity in doubtful.filter(|it| it.verdict.confidence != Confidence::Identified) {
            next.push(by_quantity(&quantity.name));
        }
    }
    let mut once = Vec::new();
    next.into_iter().for_each(|words| {
        if !once.contains(&words) {
            once.push(words);
        }
    });
    once
}

fn by_cause(cause: SuspectedCause) -> &'static str {
    match cause {
        SuspectedCause::Clock => "the clock and time zone of the weather, against those of the building",
        SuspectedCause::Sun => "irradiance in the plane of the windows, or the hours of shade",
        SuspectedCause::People => "the electricity of appliances, and when people are in",
        SuspectedCause::Windows => "contacts of windows and doors, or two weeks in which they stay shut",
        SuspectedCause::LateHeat => "the time stamps of the heat, against those of the temperature",
        SuspectedCause::VaryingGain => "the heat itself, by a heat meter, in place of electricity or fuel",
        SuspectedCause::Halves => "two weeks in which nothing of the building or its use changes",
    }
}

fn by_quantity(name: &str) -> &'static str {
    if name.contains("aperture") {
        "irradiance over some clear and some dull days"
    } else if name.contains("capacity") || name.contains("time constant") || name.contains("between air") {
        "some days on which the heat is off for half a day and fully on afterwards"
    } else if name.contains("conductance") || name.contains("rate towards") {
        "a longer record, with at least 10 K between inside and outside"
    } else {
        "a longer record, and heat with a unit"
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use interplay_building::identify::ParameterVerdict;

    fn quantity(value: Option<f64>, interval: (Option<f64>, Option<f64>)) -> Quantity {
        Quantity {
            name: "heat capacity".into(),
            symbol: "c".into(),
            unit: "kJ/K".into(),
            value,
            standard_error: None,
            interval,
            verdict: ParameterVerdict { confidence: Confidence::Weak, words: String::new() },
            checks: Vec::new(),
        }
    }

    #[test]
    fn numbers_have_units_and_no_infinite_ends() {
        let cases = [
            (quantity(Some(32_250.0), (Some(32_000.0), Some(32_500.0))), "32.25 MJ/K (32.00 to 32.50)"),
            (quantity(Some(3000.0), (Some(2900.0), Some(3100.0))), "3000 kJ/K (2900 to 3100)"),
            (quantity(None, (Some(3000.0), None)), "at least 3000 kJ/K"),
            (quantity(None, (None, Some(3000.0))), "at most 3000 kJ/K"),
            (quantity(None, (None, None)), ""),
        ];
        for (quantity, words) in cases {
            assert_eq!(in_words(&quantity), words);
        }
    }
}
