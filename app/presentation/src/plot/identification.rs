//! Three pictures for each zone of an identification: the fit, the residuals, and their autocorrelation.

use std::path::{Path, PathBuf};

use interplay_building::identify::{Identification, Whiteness, ZoneSeries};

use super::style::{BLACK, BLUE, Dash, GREY, LineStyle, ORANGE};
use super::{Curve, Panel, Panels, PlotError};
use crate::palette::GREEN;

/// A day \[s\].
const DAY_S: f64 = 86_400.0;

/// Writes fit, residuals and autocorrelation of every zone into a folder. Returns the paths of the files.
///
/// # Errors
/// [`PlotError`] if a file cannot be written.
pub fn identification(folder: &Path, found: &Identification) -> Result<Vec<PathBuf>, PlotError> {
    let mut written = Vec::new();
    for (number, (series, zone)) in found.series.iter().zip(&found.report.zones).enumerate() {
        // The name of a zone may contain any character. The number keeps file names unique after special characters are replaced.
        let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' };
        let name = format!("{}-{}", number + 1, series.name.chars().map(plain).collect::<String>());
        let pictures = [
            ("fit", fit(series)),
            ("residuals", residuals(series)),
            ("autocorrelation", autocorrelation(&series.name, &zone.whiteness)),
        ];
        for (what, panels) in pictures {
            written.extend(panels.drawing().save(folder, &format!("{name}-{what}"))?);
        }
    }
    Ok(written)
}

/// A picture with one plot.
fn panels(title: String, across: &str, panel: Panel) -> Panels {
    Panels { title, across: across.to_owned(), panels: vec![panel], ..Panels::default() }
}

/// A curve over days, broken at the gaps of the series.
fn curve(series: &ZoneSeries, name: &str, values: &[f64], style: LineStyle) -> Curve {
    let point = |row: usize| [series.time_s[row] / DAY_S, values[row]];
    let broken = |row: usize| series.segment_starts.contains(&row).then_some([f64::NAN; 2]);
    let points = (0..values.len()).flat_map(|row| broken(row).into_iter().chain([point(row)]));
    Curve::new(name, style.thin(), points.collect())
}

/// A vertical line at the first row that was not used for training.
fn test_start(series: &ZoneSeries) -> Vec<(f64, LineStyle, String)> {
    let start_s = series.time_s.get(series.test_start);
    let line = LineStyle::new(BLACK, Dash::Short);
    start_s.map(|time_s| (time_s / DAY_S, line, "from here on not trained on".to_owned())).into_iter().collect()
}

/// Measured temperature, and the temperature of the model in a free run.
fn fit(series: &ZoneSeries) -> Panels {
    let solid = |colour| LineStyle::new(colour, Dash::Solid);
    let mut curves = vec![curve(series, "free run, network alone", &series.free_run_c, solid(ORANGE))];
    if let Some(with) = &series.free_run_with_residual_model_c {
        curves.push(curve(series, "free run with daily profile and ARMA", with, solid(BLUE)));
    }
    curves.push(curve(series, "measured", &series.measured_c, solid(BLACK)));
    let panel = Panel { name: "temperature [°C]".to_owned(), curves, events: test_start(series), ..Panel::default() };
    panels(format!("{}: measured, and the model running freely", series.name), "time [days]", panel)
}

/// Residuals of the one-step prediction.
fn residuals(series: &ZoneSeries) -> Panels {
    let style = LineStyle::new(GREEN.rgb, Dash::Solid);
    let curves = vec![curve(series, "residuals (innovations)", &series.innovations_k, style)];
    let panel = Panel { name: "error [K]".to_owned(), curves, events: test_start(series), ..Panel::default() };
    panels(format!("{}: errors of the prediction one step ahead", series.name), "time [days]", panel)
}

/// Autocorrelation of the residuals, with the bounds of white residuals.
fn autocorrelation(name: &str, white: &Whiteness) -> Panels {
    let Whiteness { autocorrelation, bound, ljung_box, words, .. } = white;
    let lags = autocorrelation.len() as f64 + 0.5;
    let bar = |(index, value): (usize, &f64)| {
        let lag = index as f64 + 1.0;
        [[lag, 0.0], [lag, *value], [f64::NAN; 2]]
    };
    let test = format!("Ljung-Box Q = {:.1}, p = {:.3}", ljung_box.statistic, ljung_box.p_value);
    let bars = LineStyle { width: 8, ..LineStyle::new(BLUE, Dash::Solid) };
    let zero = LineStyle::new(GREY, Dash::Solid).thin();
    let edge = |value: f64| (value, "95 % of white residuals lie between".to_owned());
    let panel = Panel {
        name: "autocorrelation [–]".to_owned(),
        curves: vec![
            Curve::new("", zero, vec![[0.0, 0.0], [lags, 0.0]]),
            Curve::new(test, bars, autocorrelation.iter().enumerate().flat_map(bar).collect()),
        ],
        limits: vec![edge(*bound), edge(-bound)],
        ..Panel::default()
    };
    let verdict = words.split(['(', ':', ';']).next().unwrap_or_default().trim();
    panels(format!("{name}: autocorrelation of the residuals ({verdict})"), "lag [steps]", panel)
}
