//! How models predict recorded cars, as tables.

use std::fmt::Write;

use interplay_recordings::{
    ComparedModel, DrivingStatistics, GroupComparison, MeasureInterval, PredictionComparison, Spread,
};

use super::columns::Align::{Left, Right};
use super::columns::{Align, lines};

/// A comparison as a text: for each group of recordings a table of errors, then what was fitted.
pub fn prediction(comparison: &PredictionComparison) -> String {
    let mut text = String::new();
    // Writing to a text cannot fail.
    let _ = write_comparison(&mut text, comparison);
    text
}

fn write_comparison(text: &mut String, comparison: &PredictionComparison) -> std::fmt::Result {
    for group in &comparison.groups {
        let GroupComparison { name, starts, cars, .. } = group;
        writeln!(text, "{name}: {starts} starts of {cars} cars that no model was fitted on")?;
        for line in lines(&errors_header(), group.models.iter().map(errors_row)) {
            writeln!(text, "  {line}")?;
        }
        writeln!(text)?;
        let recorded = vec![
            "the record itself".to_owned(),
            String::new(),
            String::new(),
            share(group.recorded_contact_share_3s),
            String::new(),
            optional(group.recorded_off_road_share),
            String::new(),
        ];
        let rows = group.models.iter().map(rates_row).chain([recorded]);
        for line in lines(&rates_header(), rows) {
            writeln!(text, "  {line}")?;
        }
        writeln!(text)?;
    }
    writeln!(
        text,
        "In brackets: intervals at 95 % by a bootstrap over cars. Fitted on {} starts of {} other cars:",
        comparison.fitted_on_starts, comparison.fitted_on_cars
    )?;
    let models = comparison.groups.first().map(|group| group.models.as_slice()).unwrap_or_default();
    for ComparedModel { model, .. } in models.iter().filter(|it| !it.model.fitted.is_empty()) {
        let values: Vec<String> = model.fitted.iter().map(|(name, value)| format!("{name} {value}")).collect();
        writeln!(text, "  {}: {}", model.name, values.join(", "))?;
    }
    writeln!(text, "\nHow the recorded cars drive: median [5 % to 95 %]")?;
    for line in lines(&driving_header(), comparison.driving.iter().map(driving_row)) {
        writeln!(text, "  {line}")?;
    }
    Ok(())
}

fn errors_header() -> [(&'static str, Align); 8] {
    [
        ("along the road, RMSE [m] after", Left),
        ("1 s", Right),
        ("2 s", Right),
        ("3 s", Right),
        ("4 s", Right),
        ("5 s", Right),
        ("of constant velocity, 3 s", Right),
        ("of fitted IDM, 3 s", Right),
    ]
}

fn errors_row(compared: &ComparedModel) -> Vec<String> {
    let measures = &compared.measures;
    let along = |index: usize| measures.horizons.get(index).map(|errors| errors.along_rmse_m);
    let plain = |index: usize| along(index).map_or_else(String::new, |it| format!("{:.2}", it.value));
    let third = along(2).map_or_else(String::new, |it| format!("{:.2} [{:.2} to {:.2}]", it.value, it.low, it.high));
    vec![
        compared.model.name.clone(),
        plain(0),
        plain(1),
        third,
        plain(3),
        plain(4),
        share(measures.along_ratio_to_constant_velocity),
        share(measures.along_ratio_to_idm),
    ]
}

fn rates_header() -> [(&'static str, Align); 7] {
    [
        ("after 3 s", Left),
        ("across, RMSE [m]", Right),
        ("misses by 2 m", Right),
        ("contacts", Right),
        ("contacts within 5 s", Right),
        ("off the road", Right),
        ("-log likelihood", Right),
    ]
}

fn rates_row(compared: &ComparedModel) -> Vec<String> {
    let measures = &compared.measures;
    let third = measures.horizons.get(2);
    let number = |it: Option<MeasureInterval>| it.map_or_else(String::new, |it| format!("{:.2}", it.value));
    vec![
        compared.model.name.clone(),
        number(third.map(|errors| errors.across_rmse_m)),
        share(measures.miss_share),
        share(measures.contact_share_3s),
        share(measures.contact_share_5s),
        optional(measures.off_road_share),
        number(third.map(|errors| errors.negative_log_likelihood)),
    ]
}

fn driving_header() -> Vec<(&'static str, Align)> {
    let titles = [
        "time gap [s]",
        "below 0.5 s",
        "steady gap beyond 3.5 m [s]",
        "peak braking [m/s²]",
        "lane changes: gap ahead [s]",
        "behind [s]",
        "the one behind brakes [m/s²]",
        "duration [s]",
    ];
    [("", Left)].into_iter().chain(titles.map(|title| (title, Right))).collect()
}

fn driving_row(driving: &DrivingStatistics) -> Vec<String> {
    let spread = |it: Option<Spread>| {
        it.map_or_else(String::new, |it| format!("{:.2} [{:.2} to {:.2}]", it.median, it.low, it.high))
    };
    let below = driving.time_gap_below_half_share;
    vec![
        driving.name.clone(),
        spread(driving.time_gap_s),
        below.map_or_else(String::new, |share| format!("{:.1} %", 100.0 * share)),
        spread(driving.steady_time_gap_s),
        spread(driving.peak_braking_mps2),
        spread(driving.accepted_lead_gap_s),
        spread(driving.accepted_lag_gap_s),
        spread(driving.lag_braking_mps2),
        spread(driving.lane_change_s),
    ]
}

/// A share with its interval.
fn share(estimate: MeasureInterval) -> String {
    let [value, low, high] = [estimate.value, estimate.low, estimate.high].map(|share| 100.0 * share);
    format!("{value:.1} % [{low:.1} to {high:.1}]")
}

fn optional(estimate: Option<MeasureInterval>) -> String {
    estimate.map_or_else(|| "no map".to_owned(), share)
}
