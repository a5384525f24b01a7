//! Identifies thermal parameters from a CSV and its mapping, and prints what was found.
//!
//! ```sh
//! cargo run --release -p interplay-building --example identify -- experiments/dutch3.toml blg_1.csv [--json]
//! ```

#![allow(clippy::print_stdout, reason = "this is a program: its results go to standard output")]

use std::error::Error;
use std::fs;

use interplay_building::identify::{
    ErrorReport, IdentificationReport, Mapping, Quantity, Telemetry, ZoneReport, identify,
};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [mapping_file, table_file, options @ ..] = arguments.as_slice() else {
        return Err("usage: identify MAPPING.toml TABLE.csv [--json]".into());
    };
    let mapping =
        Mapping::parse(mapping_file, &fs::read_to_string(mapping_file)?).map_err(|error| error.to_string())?;
    let telemetry =
        Telemetry::read(table_file, &fs::read_to_string(table_file)?, &mapping).map_err(|error| error.to_string())?;
    let report = identify(&telemetry, &mapping.identify)?.report;
    if options.iter().any(|option| option == "--json") {
        println!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        print_report(&report);
    }
    Ok(())
}

fn print_report(report: &IdentificationReport) {
    println!(
        "{:?}: {} rows, {} trained on, step {} s, {} segments",
        report.method, report.rows, report.train_rows, report.step_s, report.segments
    );
    for model in &report.models {
        let (gain, p) = model.gain.unwrap_or((0.0, f64::NAN));
        println!(
            "  {} {:45} {} states {:2} parameters, log-likelihood {:.3}, twice the gain {gain:.2}, p = {p:.4}",
            if model.chosen { "*" } else { " " },
            model.model,
            model.states,
            model.parameters,
            model.log_likelihood
        );
    }
    report.zones.iter().for_each(print_zone);
    for wall in &report.walls {
        let side =
            |side: Option<(f64, f64)>| side.map_or("?".into(), |(value, error)| format!("{value:.3} ± {error:.3}"));
        let (one, other) = &wall.between;
        println!(
            "\nwall {one} - {other} [kW/K]: {} and {}: {}",
            side(wall.from_first),
            side(wall.from_second),
            wall.words
        );
    }
    println!("\nwarnings");
    report.warnings.iter().for_each(|warning| println!("  - {warning}"));
}

fn print_zone(zone: &ZoneReport) {
    println!("\n{}", zone.name);
    zone.coefficients.iter().chain(&zone.physical).for_each(print_quantity);
    if let Some(model) = &zone.residual_model {
        let arma = &model.profile;
        println!(
            "  residual model: α {:?}, μ {:.3}, innovation {:.4} K",
            arma.autoregressive, arma.moving_average, arma.innovation_sd
        );
    }
    let white = &zone.whiteness;
    println!(
        "  residuals: {}; Ljung-Box {:.1} on {}, p = {:.3}; nCPBES {:?}",
        white.words,
        white.ljung_box.statistic,
        white.ljung_box.degrees,
        white.ljung_box.p_value,
        white.periodogram_excess
    );
    print_errors("train", &zone.train);
    zone.test.iter().for_each(|test| print_errors("test", test));
}

fn print_quantity(quantity: &Quantity) {
    let number = |number: Option<f64>| number.map_or("-".into(), |number| format!("{number:.4e}"));
    let (low, high) = quantity.interval;
    println!(
        "  {:34} {:>11} ± {:>10} {:10} [{}, {}]  {}",
        quantity.name,
        number(quantity.value),
        number(quantity.standard_error),
        quantity.unit,
        number(low),
        number(high),
        quantity.verdict.words
    );
}

fn print_errors(part: &str, errors: &ErrorReport) {
    let free: Vec<_> = errors
        .free_run
        .errors_k
        .iter()
        .map(|(how, error)| format!("{how:?} {:.3}", error.unwrap_or(f64::NAN)))
        .collect();
    println!(
        "  {part}: one step {:.4} K, with residual model {:.4} K; free run of {} h ({} runs) [K]: {}, mean of the data {:.3}",
        errors.one_step_k,
        errors.one_step_with_residual_model_k.unwrap_or(f64::NAN),
        errors.free_run.horizon_h,
        errors.free_run.runs,
        free.join(", "),
        errors.free_run.mean_of_data_k.unwrap_or(f64::NAN)
    );
}
