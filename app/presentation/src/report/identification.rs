//! An identification as tables.

use std::fmt::{self, Write};

use interplay_building::identify::{
    Confidence, ErrorReport, Identification, IdentificationReport, ModelRow, Quantity, ResidualForecast, ZoneReport,
};

use interplay_common::spelling::counted;

use super::columns::{Align, write_table, written};

/// All findings as text: parameters with uncertainty and verdict, residuals, errors, and warnings.
pub fn identification(file: &str, found: &Identification) -> String {
    written(|text| write_report(text, file, &found.report))
}

fn write_report(text: &mut String, file: &str, report: &IdentificationReport) -> fmt::Result {
    let method = serde_json::to_value(report.method).ok();
    let method = method.as_ref().and_then(|word| word.as_str()).unwrap_or_default();
    writeln!(text, "Thermal parameters from {file}, by {method}")?;
    writeln!(
        text,
        "  {} every {} s in {}, {} trained on, {} left out",
        counted(report.rows, "row"),
        report.step_s,
        counted(report.segments, "piece"),
        report.train_rows,
        report.left_out_rows
    )?;
    write_models(text, report)?;
    for zone in &report.zones {
        write_zone(text, zone)?;
    }
    if !report.walls.is_empty() {
        writeln!(text, "\nwalls between two zones, seen from both sides [kW/K]")?;
    }
    for wall in &report.walls {
        let side = |side: Option<(f64, f64)>| {
            side.map_or_else(|| "?".to_owned(), |(value, error)| format!("{} ± {}", number(value), number(error)))
        };
        let (one, other) = &wall.between;
        let (first, second) = (side(wall.from_first), side(wall.from_second));
        writeln!(text, "  {one} - {other}: {first} and {second}: {}", wall.words)?;
    }
    if !report.warnings.is_empty() {
        writeln!(text, "\nwarnings")?;
    }
    report.warnings.iter().try_for_each(|warning| writeln!(text, "  - {warning}"))
}

/// The models that were compared.
fn write_models(text: &mut String, report: &IdentificationReport) -> fmt::Result {
    if report.models.is_empty() {
        return Ok(());
    }
    use Align::{Left, Right};
    let header = [
        ("", Left),
        ("model", Left),
        ("states", Right),
        ("parameters", Right),
        ("log-likelihood", Right),
        ("twice the gain", Right),
        ("p", Right),
    ];
    let row = |model: &ModelRow| {
        let (gain, p_value) = match model.gain {
            Some((gain, p_value)) => (format!("{gain:.1}"), format!("{p_value:.3}")),
            None => ("-".to_owned(), "-".to_owned()),
        };
        vec![
            if model.chosen { "*" } else { "" }.to_owned(),
            model.model.clone(),
            model.states.to_string(),
            model.parameters.to_string(),
            format!("{:.2}", model.log_likelihood),
            gain,
            p_value,
        ]
    };
    writeln!(
        text,
        "\nmodels, each with one more hidden temperature than the one it extends (likelihood-ratio test; * chosen)"
    )?;
    write_table(text, &header, report.models.iter().map(row))
}

fn write_zone(text: &mut String, zone: &ZoneReport) -> fmt::Result {
    writeln!(text, "\nzone {}", zone.name)?;
    use Align::{Left, Right};
    let header = [
        ("parameter", Left),
        ("estimate", Right),
        ("std error", Right),
        ("unit", Left),
        ("95 % interval", Right),
        ("verdict", Left),
    ];
    let rows = zone.coefficients.iter().chain(&zone.physical).map(row);
    write_table(text, &header, rows)?;
    let white = &zone.whiteness;
    writeln!(
        text,
        "  residuals: {}; Ljung-Box Q = {:.1} on {} degrees, p = {:.3}",
        white.words, white.ljung_box.statistic, white.ljung_box.degrees, white.ljung_box.p_value
    )?;
    write_errors(text, "trained on", &zone.train)?;
    zone.test.iter().try_for_each(|test| write_errors(text, "tested on", test))
}

fn row(quantity: &Quantity) -> Vec<String> {
    let known = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), number);
    let (low, high) = quantity.interval;
    let interval = match (low, high) {
        (Some(low), Some(high)) => format!("{} … {}", number(low), number(high)),
        (Some(low), None) => format!("at least {}", number(low)),
        (None, Some(high)) => format!("at most {}", number(high)),
        (None, None) => "-".to_owned(),
    };
    vec![
        quantity.name.clone(),
        known(quantity.value),
        known(quantity.standard_error),
        quantity.unit.clone(),
        interval,
        word(quantity.verdict.confidence).to_owned(),
    ]
}

fn write_errors(text: &mut String, rows: &str, errors: &ErrorReport) -> fmt::Result {
    let free = &errors.free_run;
    let of = |wanted: ResidualForecast| {
        let found = free.errors_k.iter().find(|(forecast, _)| *forecast == wanted).and_then(|(_, error)| *error);
        found.map_or_else(|| "-".to_owned(), |error| format!("{error:.3} K"))
    };
    write!(text, "  {rows}: one step ahead {:.4} K", errors.one_step_k)?;
    if let Some(error_k) = errors.one_step_with_residual_model_k {
        write!(text, ", with residual model {error_k:.4} K")?;
    }
    let alone = of(ResidualForecast::None);
    write!(text, "; {} free runs of {} h: network alone {alone}", free.runs, free.horizon_h)?;
    match free.mean_of_data_k {
        Some(mean_k) => writeln!(text, ", mean of the data {mean_k:.3} K"),
        None if errors.one_step_with_residual_model_k.is_some() => {
            writeln!(text, ", with daily profile and ARMA {}", of(ResidualForecast::ProfileArma))
        }
        None => writeln!(text),
    }
}

/// A verdict in a few words; the warnings below the tables have details.
fn word(confidence: Confidence) -> &'static str {
    match confidence {
        Confidence::Identified => "identified",
        Confidence::Weak => "weak",
        Confidence::NotDistinguishableFromZero => "may be zero",
        Confidence::Disputed => "disputed",
        Confidence::WrongSign => "wrong sign",
        Confidence::NotIdentifiable => "not identifiable",
    }
}

/// Four significant digits, without an exponent where it can be avoided.
pub(super) fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&size) {
        let digits = (3 - libm::floor(libm::log10(size)) as i64).clamp(0, 6);
        format!("{value:.*}", digits as usize)
    } else {
        format!("{value:.3e}")
    }
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_have_four_significant_digits() {
        let cases = [(0.0, "0"), (31.25, "31.25"), (1000.4, "1000"), (-0.0123456, "-0.01235"), (1.5e-7, "1.500e-7")];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
        assert_eq!(number(123_456.0), "123456");
        assert_eq!(number(2.5e9), "2.500e9");
    }
}
