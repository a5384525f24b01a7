//! Comparisons of models that predict recorded cars, as tables.

use std::fmt::Write;

use interplay_recordings::{
    ComparedModel, DrivingDistance, DrivingStatistics, GroupComparison, MeasureInterval, PredictionComparison, Spread,
};

use super::columns::{Align, write_table, written};

/// A comparison as a text: for each group of recordings a table of errors, then what was fitted.
pub fn prediction(comparison: &PredictionComparison) -> String {
    written(|text| write_comparison(text, comparison))
}

fn write_comparison(text: &mut String, comparison: &PredictionComparison) -> std::fmt::Result {
    for group in &comparison.groups {
        let GroupComparison { name, starts, cars, .. } = group;
        writeln!(text, "{name}: {starts} starts of {cars} cars outside the data of the fits")?;
        write_table(text, &errors_header(), group.models.iter().map(errors_row))?;
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
        write_table(text, &rates_header(), rows)?;
        writeln!(text)?;
        if comparison.leaves_one_out {
            write_fitted(text, &group.models)?;
            writeln!(text)?;
        }
    }
    writeln!(text, "In brackets: 95 % intervals by a bootstrap over cars.")?;
    if comparison.leaves_one_out {
        return writeln!(text, "Each group was judged by models that were fitted on all others.");
    }
    let PredictionComparison { fitted_on_starts, fitted_on_cars, .. } = comparison;
    writeln!(text, "Fitted on {fitted_on_starts} starts of {fitted_on_cars} other cars:")?;
    write_fitted(text, comparison.groups.first().map(|group| group.models.as_slice()).unwrap_or_default())?;
    writeln!(text)?;
    write_driving(text, &comparison.driving)
}

fn write_driving(text: &mut String, driving: &[DrivingStatistics]) -> std::fmt::Result {
    writeln!(text, "How the recorded cars drive: median [5 % to 95 %]")?;
    write_table(text, &driving_header(), driving.iter().map(driving_row))
}

/// How recorded cars drive, and how far those of each group are from those of the first.
pub fn driving(driving: &[DrivingStatistics], distances: &[DrivingDistance]) -> String {
    written(|text| {
        write_driving(text, driving)?;
        let first = driving.first().map(|it| it.name.as_str()).unwrap_or_default();
        let titles = ["", "samples", "Wasserstein", "Kolmogorov", "within 5 to 95 %"];
        let row = |it: &DrivingDistance| {
            let [_, count] = it.counts;
            vec![
                it.name.clone(),
                it.quantity.to_owned(),
                count.to_string(),
                format!("{:.2}", it.wasserstein),
                format!("{:.2}", it.largest_difference),
                format!("{:.0} %", 100.0 * it.inside_share),
            ]
        };
        if !distances.is_empty() {
            writeln!(text, "\nHow far from {first}")?;
            write_table(text, &header("", &titles), distances.iter().map(row))?;
        }
        Ok(())
    })
}

fn write_fitted(text: &mut String, models: &[ComparedModel]) -> std::fmt::Result {
    for ComparedModel { model, .. } in models.iter().filter(|it| !it.model.fitted.is_empty()) {
        let values: Vec<String> = model.fitted.iter().map(|(name, value)| format!("{name} {value}")).collect();
        writeln!(text, "  {}: {}", model.name, values.join(", "))?;
    }
    Ok(())
}

/// A header with a left column and right-aligned ones.
fn header(first: &'static str, titles: &[&'static str]) -> Vec<(&'static str, Align)> {
    [(first, Align::Left)].into_iter().chain(titles.iter().map(|title| (*title, Align::Right))).collect()
}

fn errors_header() -> Vec<(&'static str, Align)> {
    let titles = ["1 s", "2 s", "3 s", "4 s", "5 s", "of constant velocity, 3 s", "of fitted IDM, 3 s"];
    header("along the road, RMSE [m] after", &titles)
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

fn rates_header() -> Vec<(&'static str, Align)> {
    let titles =
        ["across, RMSE [m]", "misses by 2 m", "contacts", "contacts within 5 s", "off the road", "-log likelihood"];
    header("after 3 s", &titles)
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
    header("", &titles)
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

fn share(estimate: MeasureInterval) -> String {
    let [value, low, high] = [estimate.value, estimate.low, estimate.high].map(|share| 100.0 * share);
    format!("{value:.1} % [{low:.1} to {high:.1}]")
}

fn optional(estimate: Option<MeasureInterval>) -> String {
    estimate.map_or_else(|| "no map".to_owned(), share)
}
