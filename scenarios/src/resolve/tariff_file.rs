//! Reads the table of prices of a scenario, when the scenario is loaded: whatever is wrong with it is said then, with its line.

use interplay_building::energy::Tariff;

use crate::error::{Fault, quoted};
use crate::read::regular_file::read_regular;
use crate::read::stated_path::{base_in_words, path_beside};
use crate::read::text_line::line_of;
use crate::read::tree::TomlNode;

/// The largest file that is read; a century by the hour takes less \[bytes\].
const MAX_FILE_BYTES: u64 = 1 << 24;
/// The most prices, as of a list in the scenario.
const MAX_PRICES: usize = 100_000;
/// The largest price, as of a list in the scenario \[currency/kWh\].
const MAX_PRICE_PER_KWH: f64 = 1000.0;
/// Errors in prices are listed after those in the scenario.
const RANK: usize = 1001;
const HEADER: &str = "hour,price_per_kwh";

/// The tariff with the prices of the table that it names, if it names one.
pub(crate) fn read(tariff: &Tariff, tree: &TomlNode) -> Result<Tariff, Fault> {
    let Some(file) = &tariff.file else { return Ok(tariff.clone()) };
    let place = tree.place_of("tariff.file");
    let path = path_beside(place, file);
    let title = path.display().to_string();
    let refused = |reason: String| {
        let message = format!("cannot read {}: {reason}", quoted(&title));
        Fault::at(place, "this file", message).help(base_in_words(place))
    };
    let bytes = read_regular(&path, MAX_FILE_BYTES).map_err(|error| refused(error.to_string()))?;
    let bytes = bytes.ok_or_else(|| refused("it is larger than 16 MiB, and no table of prices is".to_owned()))?;
    let text = String::from_utf8(bytes).map_err(|_| refused("it is no text in UTF-8".to_owned()))?;
    let prices_per_kwh = parse(&text).map_err(|(line, problem)| {
        let message = format!("{} is no table of prices: line {line}: {problem}", quoted(&title));
        let help = format!("the first line is `{HEADER}`, then there is a row an hour from 0 on, such as `0,0.31`");
        Fault::at(&line_of(&title, &text, line, RANK), "this line", message).help(help)
    })?;
    Ok(Tariff { prices_per_kwh, file: None, ..tariff.clone() })
}

/// The prices of a table; or the line, from 1, and what is wrong with it.
fn parse(text: &str) -> Result<Vec<f64>, (usize, String)> {
    let mut lines =
        text.trim_start_matches('\u{feff}').lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    let header = lines.next().map_or("", |(_, header)| header);
    if header.split(',').map(str::trim).ne(HEADER.split(',')) {
        return Err((1, format!("the header is `{}` and not `{HEADER}`", header.chars().take(40).collect::<String>())));
    }
    let mut prices = Vec::new();
    for (line, row) in lines.filter(|(_, row)| !row.is_empty()) {
        let Some((hour, price)) = row.split_once(',') else { return Err((line, "it has no comma".to_owned())) };
        if hour.trim().parse() != Ok(prices.len()) {
            return Err((line, format!("the hour is `{}`, and {} comes next", hour.trim(), prices.len())));
        }
        let price = price.trim();
        let value: Option<f64> = price.parse().ok();
        let Some(value) = value.filter(|value| value.abs() <= MAX_PRICE_PER_KWH) else {
            let range = format!("a number from -{MAX_PRICE_PER_KWH} to {MAX_PRICE_PER_KWH}");
            return Err((line, format!("the price is `{price}`; it must be {range}")));
        };
        if prices.len() == MAX_PRICES {
            return Err((line, format!("there are more than {MAX_PRICES} prices")));
        }
        prices.push(value);
    }
    if prices.is_empty() { Err((1, "there are no prices below the header".to_owned())) } else { Ok(prices) }
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn a_table_has_a_price_for_each_hour() {
        assert_eq!(parse("hour,price_per_kwh\r\n0,0.25\r\n1, -0.01\r\n"), Ok(vec![0.25, -0.01]));
    }

    #[test]
    fn the_line_at_fault_is_named() {
        let cases = [
            ("", 1, "header"),
            ("hour;price\n", 1, "header"),
            ("hour,price_per_kwh\n", 1, "no prices"),
            ("hour,price_per_kwh\n0,0.3\n2,0.3\n", 3, "1 comes next"),
            ("hour,price_per_kwh\n0,0.3\n1;0.3\n", 3, "comma"),
            ("hour,price_per_kwh\n0,NaN\n", 2, "`NaN`"),
            ("hour,price_per_kwh\n0,inf\n", 2, "`inf`"),
            ("hour,price_per_kwh\n0,1,2\n", 2, "`1,2`"),
        ];
        for (text, line, word) in cases {
            let (found, problem) = parse(text).expect_err(text);
            assert!(found == line && problem.contains(word), "{text:?}: line {found}: {problem}");
        }
    }
}
