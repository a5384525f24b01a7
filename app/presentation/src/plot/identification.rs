//! Three figures for each zone of an identification: the fit, the residuals, and their autocorrelation.

use std::ops::Range;
use std::path::{Path, PathBuf};

use interplay_building::identify::{Identification, Whiteness, ZoneSeries};
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::axis::range;
use super::figure::{Drawn, FONT, Figure, PlotError, make_folder, save};

/// Colours of Okabe and Ito, which colour-blind readers can distinguish.
const BLUE: RGBColor = RGBColor(0x00, 0x72, 0xB2);
const ORANGE: RGBColor = RGBColor(0xE6, 0x9F, 0x00);
const GREEN: RGBColor = RGBColor(0x00, 0x9E, 0x73);
const GREY: RGBColor = RGBColor(0x66, 0x66, 0x66);

/// A day \[s\].
const DAY_S: f64 = 86_400.0;

type Chart<'a, B> = ChartContext<'a, B, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Writes fit, residuals and autocorrelation of every zone into a folder. Returns the paths of the files.
///
/// # Errors
/// [`PlotError`] if a file cannot be written.
pub fn identification(folder: &Path, found: &Identification) -> Result<Vec<PathBuf>, PlotError> {
    make_folder(folder)?;
    let mut written = Vec::new();
    for (number, (series, zone)) in found.series.iter().zip(&found.report.zones).enumerate() {
        // The name of a zone may have any characters. The number keeps the file names unique after they are replaced.
        let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' };
        let name = format!("{}-{}", number + 1, series.name.chars().map(plain).collect::<String>());
        written.extend(save(folder, &format!("{name}-fit"), &Fit(series))?);
        written.extend(save(folder, &format!("{name}-residuals"), &Residuals(series))?);
        let white = Autocorrelation { name: &series.name, white: &zone.whiteness };
        written.extend(save(folder, &format!("{name}-autocorrelation"), &white)?);
    }
    Ok(written)
}

/// Draws the axes and the title of a figure.
fn chart<'a, B: DrawingBackend>(
    area: &'a DrawingArea<B, Shift>,
    title: &str,
    [across, along]: [&str; 2],
    (x, y): (Range<f64>, Range<f64>),
) -> Result<Chart<'a, B>, DrawingAreaErrorKind<B::ErrorType>> {
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(area)
        .caption(title, (FONT, 22))
        .margin(12)
        .x_label_area_size(46)
        .y_label_area_size(64)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .x_desc(across)
        .y_desc(along)
        .label_style((FONT, 15))
        .axis_desc_style((FONT, 16))
        .light_line_style(WHITE)
        .draw()?;
    Ok(chart)
}

fn legend<'a, B: DrawingBackend + 'a>(chart: &mut Chart<'a, B>) -> Drawn<B> {
    chart
        .configure_series_labels()
        .label_font((FONT, 15))
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.85))
        .border_style(GREY)
        .draw()
}

/// The pieces of a series between gaps, as points over days.
fn pieces<'a>(series: &'a ZoneSeries, values: &'a [f64]) -> impl Iterator<Item = Vec<(f64, f64)>> + 'a {
    let ends = series.segment_starts.iter().skip(1).copied().chain([values.len()]);
    series.segment_starts.iter().zip(ends).map(|(&start, end)| {
        let finite = (start..end).filter(|&row| values[row].is_finite());
        finite.map(|row| (series.time_s[row] / DAY_S, values[row])).collect()
    })
}

/// A series with its name in the legend, broken at gaps. Its line is thin: Plotters puts spikes on the corners of thick
/// ones.
fn line<B: DrawingBackend>(
    chart: &mut Chart<'_, B>,
    series: &ZoneSeries,
    values: &[f64],
    name: &str,
    colour: RGBColor,
) -> Drawn<B> {
    for (index, piece) in pieces(series, values).enumerate() {
        let drawn = chart.draw_series(LineSeries::new(piece, colour))?;
        if index == 0 {
            drawn.label(name).legend(move |(x, y)| PathElement::new([(x, y), (x + 22, y)], colour.stroke_width(3)));
        }
    }
    Ok(())
}

/// A dashed vertical line at the first row that was not used for training.
fn test_start<B: DrawingBackend>(chart: &mut Chart<'_, B>, series: &ZoneSeries, y: &Range<f64>) -> Drawn<B> {
    let Some(time_s) = series.time_s.get(series.test_start) else { return Ok(()) };
    let day = time_s / DAY_S;
    let ends = [(day, y.start), (day, y.end)];
    let upright = DashedLineSeries::new(ends, 6, 4, BLACK.stroke_width(2));
    chart.draw_series(upright)?.label("from here on not trained on");
    Ok(())
}

/// Extends the y range to leave space for a legend at the top.
fn with_legend(y: Range<f64>) -> Range<f64> {
    y.start..y.end + 0.3 * (y.end - y.start)
}

fn days(series: &ZoneSeries) -> Range<f64> {
    range(series.time_s.iter().map(|time_s| time_s / DAY_S))
}

/// Measured temperature, and the temperature of the model in a free run.
struct Fit<'a>(&'a ZoneSeries);

impl Figure for Fit<'_> {
    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Drawn<B> {
        let series = self.0;
        let with = series.free_run_with_residual_model_c.as_ref();
        let shown = [&series.free_run_c, &series.measured_c].into_iter().chain(with).flatten().copied();
        let y = with_legend(range(shown.filter(|value| value.is_finite())));
        let title = format!("{}: measured, and the model running freely", series.name);
        let mut chart = chart(area, &title, ["time [days]", "temperature [°C]"], (days(series), y.clone()))?;
        line(&mut chart, series, &series.free_run_c, "free run, network alone", ORANGE)?;
        if let Some(with) = with {
            line(&mut chart, series, with, "free run with daily profile and ARMA", BLUE)?;
        }
        line(&mut chart, series, &series.measured_c, "measured", BLACK)?;
        test_start(&mut chart, series, &y)?;
        legend(&mut chart)
    }
}

/// Residuals of the one-step prediction.
struct Residuals<'a>(&'a ZoneSeries);

impl Figure for Residuals<'_> {
    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Drawn<B> {
        let series = self.0;
        let y = with_legend(range(series.innovations_k.iter().copied().filter(|value| value.is_finite())));
        let title = format!("{}: errors of the prediction one step ahead", series.name);
        let mut chart = chart(area, &title, ["time [days]", "error [K]"], (days(series), y.clone()))?;
        line(&mut chart, series, &series.innovations_k, "residuals (innovations)", GREEN)?;
        test_start(&mut chart, series, &y)?;
        legend(&mut chart)
    }
}

/// Whether the residuals are white.
struct Autocorrelation<'a> {
    name: &'a str,
    white: &'a Whiteness,
}

impl Figure for Autocorrelation<'_> {
    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Drawn<B> {
        let Whiteness { autocorrelation, bound, ljung_box, words, .. } = self.white;
        let lags = autocorrelation.len() as f64 + 0.5;
        let y = with_legend(range(autocorrelation.iter().copied().chain([1.6 * bound, -1.6 * bound])));
        let test = format!("Ljung-Box Q = {:.1}, p = {:.3}", ljung_box.statistic, ljung_box.p_value);
        let verdict = words.split(['(', ':', ';']).next().unwrap_or_default().trim();
        let title = format!("{}: autocorrelation of the residuals ({verdict})", self.name);
        let mut chart = chart(area, &title, ["lag [steps]", "autocorrelation"], (0.0..lags, y))?;
        let bars = autocorrelation.iter().enumerate().map(|(index, &value)| {
            let lag = index as f64 + 1.0;
            Rectangle::new([(lag - 0.3, 0.0), (lag + 0.3, value)], BLUE.filled())
        });
        let swatch = |(x, y)| Rectangle::new([(x, y - 5), (x + 22, y + 5)], BLUE.filled());
        chart.draw_series(bars)?.label(test).legend(swatch);
        for (end, name) in [(*bound, Some("95 % of white residuals lie between")), (-bound, None)] {
            let edge = LineSeries::new([(0.0, end), (lags, end)], ORANGE.stroke_width(2));
            let drawn = chart.draw_series(edge)?;
            if let Some(name) = name {
                let dash = |(x, y)| PathElement::new([(x, y), (x + 22, y)], ORANGE.stroke_width(3));
                drawn.label(name).legend(dash);
            }
        }
        chart.draw_series(LineSeries::new([(0.0, 0.0), (lags, 0.0)], BLACK.stroke_width(1)))?;
        legend(&mut chart)
    }
}
