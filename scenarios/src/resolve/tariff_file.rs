//! Reads the table of prices of a scenario when the scenario is loaded; its faults are reported then, with their lines.

use interplay_building::energy::Tariff;
use interplay_building::series::{SeriesColumn, SeriesError};

use super::series_file::SeriesFile;
use crate::format::read::tree::TomlNode;
use crate::model::building::config::DAY_S;
use crate::model::scenario::Scenario;
use crate::text::error::Fault;
use crate::text::readable::readable;

/// The most prices, as of a list in the scenario.
const MAX_PRICES: usize = 100_000;
/// The largest price, as of a list in the scenario \[currency/kWh\].
const MAX_PRICE_PER_KWH: f64 = 1000.0;
/// Prices above this get a remark: they are probably in cents \[currency/kWh\] …
const MAX_USUAL_PRICE_PER_KWH: f64 = 5.0;
/// … and above this per megawatt-hour.
const MAX_PRICE_IN_CENTS_PER_KWH: f64 = 60.0;
/// Errors in prices are listed after those in the scenario.
const RANK: usize = 1001;
/// The title of the column of prices; a table with one series may use another.
const PRICE: &str = "price_per_kwh";

/// The tariff with the prices of its table, if it names one; and a remark on unusually high prices.
pub(crate) fn read(tariff: &Tariff, scenario: &Scenario, tree: &TomlNode) -> Result<(Tariff, Option<Fault>), Fault> {
    let Some(name) = &tariff.file else { return Ok((tariff.clone(), unusual_in_list(tariff, tree))) };
    let file = SeriesFile::read(name, "tariff.file", tree, "table of prices", RANK)?;
    let refused = |line: usize, problem: String| Err(file.fault(&SeriesError { line, problem }));
    let column = match (file.table.column(PRICE), file.table.columns.as_slice()) {
        (Some(column), _) | (None, [column]) => column,
        _ => {
            let problem = format!("there is no column `{PRICE}` among `{}`", file.table.titles().join("`, `"));
            return refused(file.table.header_line, problem);
        }
    };
    if let Some(line) = file.table.missing_line(column) {
        return refused(line, format!("`{}` is missing", column.title));
    }
    if let Some(row) = column.values.iter().position(|price| price.abs() > MAX_PRICE_PER_KWH) {
        let problem = format!(
            "the price is {}; it must be a number from -{MAX_PRICE_PER_KWH} to {MAX_PRICE_PER_KWH}",
            column.values[row]
        );
        return refused(file.table.lines[row], problem);
    }
    if column.values.len() > MAX_PRICES {
        return refused(file.table.lines[MAX_PRICES], format!("there are more than {MAX_PRICES} prices"));
    }
    let prices_per_kwh = from_first_midnight(&file, column, scenario)?;
    let interval_s = file.table.interval_s;
    if (60.0..=DAY_S).contains(&interval_s) {
        let read = Tariff { prices_per_kwh, interval_s, file: None, ..tariff.clone() };
        return Ok((read, unusual(&file, column)));
    }
    refused(file.table.header_line, format!("the rows are {interval_s} s apart; 60 s to a day work"))
}

/// A remark on the first unusually high price of a table.
fn unusual(file: &SeriesFile, column: &SeriesColumn) -> Option<Fault> {
    let row = column.values.iter().position(|price| *price > MAX_USUAL_PRICE_PER_KWH)?;
    let problem = in_words(column.values[row]);
    let remark = file.remark(&SeriesError { line: file.table.lines[row], problem });
    Some(remark.help(format!("`{PRICE}` is a price per kilowatt-hour; {}", conversion(column.values[row]))))
}

/// The same for the list in the scenario.
fn unusual_in_list(tariff: &Tariff, tree: &TomlNode) -> Option<Fault> {
    const KEY: &str = "tariff.prices_per_kwh";
    let price = tariff.prices_per_kwh.iter().copied().find(|price| *price > MAX_USUAL_PRICE_PER_KWH)?;
    let remark = Fault::at(tree.place_of(KEY), "per kWh", in_words(price));
    Some(remark.help(format!("`{KEY}` has prices per kilowatt-hour; {}", conversion(price))))
}

fn in_words(price: f64) -> String {
    let question = if price <= MAX_PRICE_IN_CENTS_PER_KWH { "is it in cents?" } else { "is it per MWh?" };
    format!("the price is {} per kWh: {question}", readable(price))
}

/// How an unusually high price becomes one per kilowatt-hour.
fn conversion(price: f64) -> &'static str {
    if price <= MAX_PRICE_IN_CENTS_PER_KWH { "divide cents by 100" } else { "divide prices per megawatt-hour by 1000" }
}

/// The prices from the first midnight of the run on.
fn from_first_midnight(file: &SeriesFile, column: &SeriesColumn, scenario: &Scenario) -> Result<Vec<f64>, Fault> {
    let (first_s, interval_s) = (file.table.first_s, file.table.interval_s);
    let skipped = (file.start(scenario, 0).start_s - first_s) / interval_s;
    let first_row = skipped.round();
    if (skipped - first_row).abs() < 1e-6 && (0.0..column.values.len() as f64).contains(&first_row) {
        return Ok(column.values[first_row as usize..].to_vec());
    }
    let problem = match file.table.first_day {
        None => "the first row is not that of hour 0, the first midnight".to_owned(),
        Some(day) => format!(
            "the rows begin on {day} at hour {:.2} and do not hold the midnight at which the run begins; `calendar.first_day` says on \
             which day that is",
            first_s / 3600.0
        ),
    };
    let line = file.table.lines.first().copied().unwrap_or(1);
    Err(file.fault(&SeriesError { line, problem }))
}
