//! Pictures of a run with a building.

use interplay_building::control::Exchange;
use interplay_building::network::Network;
use interplay_simulation::climate::people;
use interplay_simulation::frame::{BuildingFrame, ZoneFrame};

use super::recorded_run::RecordedRun;
use crate::palette::GREEN;
use crate::plot::style::{self, BLUE, Dash, LIMIT, LineStyle, ORANGE, WANTED};
use crate::plot::{Curve, Panel, Panels};

/// Most zones that are drawn individually.
pub const MAX_DRAWN_ZONES: usize = 4;
/// Most days that are drawn individually.
const MAX_DRAWN_DAYS: usize = 5;

fn steps(recorded: &RecordedRun) -> impl Iterator<Item = &BuildingFrame> {
    recorded.frames.iter().filter_map(|frame| frame.building.as_ref())
}

/// Sampling time \[h\].
fn step_h(recorded: &RecordedRun) -> f64 {
    recorded.scenario.building.as_ref().map_or(1.0, |building| building.step_s / 3600.0)
}

fn network(recorded: &RecordedRun) -> Option<Network> {
    recorded.scenario.building.as_ref().and_then(|building| building.network().ok())
}

/// The days that are drawn individually: all, or the first ones and the last.
fn days(recorded: &RecordedRun) -> Vec<usize> {
    let count = steps(recorded).last().map_or(0, |step| step.day + 1);
    let first = (0..count).take(if count > MAX_DRAWN_DAYS { MAX_DRAWN_DAYS - 1 } else { count });
    first.chain((count > MAX_DRAWN_DAYS).then(|| count - 1)).collect()
}

/// The first zones of a building.
pub fn first_zones(recorded: &RecordedRun) -> Vec<usize> {
    let zones = steps(recorded).next().map_or(0, |step| step.zones.len());
    (0..zones.min(MAX_DRAWN_ZONES)).collect()
}

/// A value of a zone over a day, at the start of each step \[h\].
fn day_of(recorded: &RecordedRun, day: usize, zone: usize, value: impl Fn(&ZoneFrame) -> f64) -> Vec<[f64; 2]> {
    let step_h = step_h(recorded);
    let today = steps(recorded).filter(|step| step.day == day);
    today.map(|step| [step.step as f64 * step_h, value(&step.zones[zone])]).collect()
}

/// The temperature of a zone over a day, from midnight to midnight.
fn temperature_of(recorded: &RecordedRun, day: usize, zone: usize) -> Vec<[f64; 2]> {
    let mut points = day_of(recorded, day, zone, |now| now.temperature_c);
    let last = steps(recorded).filter(|step| step.day == day).last();
    points.extend(last.map(|step| [(step.step + 1) as f64 * step_h(recorded), step.zones[zone].next_c]));
    points
}

/// Temperatures of some zones over the day, one curve per day, with the wanted temperature and the comfort band.
pub fn temperatures(title: &str, recorded: &RecordedRun, zones: &[usize]) -> Panels {
    let panel = |&zone: &usize| {
        let mut curves: Vec<Curve> = days(recorded)
            .into_iter()
            .zip(style::line_styles())
            .map(|(day, style)| Curve::new(format!("day {}", day + 1), style, temperature_of(recorded, day, zone)))
            .collect();
        let people = day_of(recorded, 0, zone, |now| now.band_k.unwrap_or(f64::NAN));
        let occupied: Vec<bool> = people.iter().map(|[_, band_k]| band_k.is_finite()).collect();
        for (name, side, style) in
            [("wanted", 0.0, WANTED), ("comfort band", 1.0, LIMIT), ("comfort band", -1.0, LIMIT)]
        {
            let beside_k = |now: &ZoneFrame| if side == 0.0 { Some(0.0) } else { Some(side * now.band_k?) };
            let place = |now: &ZoneFrame| Some(now.reference_c? + beside_k(now)?);
            let value = |now: &ZoneFrame| place(now).unwrap_or(f64::NAN);
            let points = stepped(day_of(recorded, 0, zone, value), occupied.clone(), step_h(recorded));
            if points.iter().any(|point| point[1].is_finite()) {
                curves.push(Curve::new(format!("{name}{}", day_suffix(recorded)), style, points));
            }
        }
        Panel { name: format!("{}: temperature [°C]", name(recorded, zone)), curves, ..Panel::default() }
    };
    over_day(title, zones.iter().map(panel).collect())
}

/// Suffix of names in the legend, if the wanted temperatures differ from day to day.
fn day_suffix(recorded: &RecordedRun) -> &'static str {
    let differ = recorded.scenario.timetable().is_ok_and(|timetable| timetable.days_differ());
    if differ { " on day 1" } else { "" }
}

/// Heat from the equipment of some zones over the day, one curve per day, with its limits.
pub fn inputs(title: &str, recorded: &RecordedRun, zones: &[usize]) -> Panels {
    let network = network(recorded);
    let limits = network.as_ref().map(Network::limits);
    let panel = |&zone: &usize| {
        let curves = days(recorded).into_iter().zip(style::line_styles()).map(|(day, style)| {
            let points = day_of(recorded, day, zone, |now| now.heat_kw);
            Curve::held(format!("day {}", day + 1), style, &points, step_h(recorded))
        });
        let limit = limits.map_or(Vec::new(), |limits| vec![limits.heating_kw[zone], -limits.cooling_kw[zone]]);
        Panel {
            name: format!("{}: heat, cooling below 0 [kW]", name(recorded, zone)),
            curves: curves.collect(),
            limits: limit.into_iter().map(|limit_kw| (limit_kw, "limit of the equipment".to_owned())).collect(),
            ..Panel::default()
        }
    };
    over_day(title, zones.iter().map(panel).collect())
}

/// The wanted temperature as steps at the times at which occupancy begins and ends; `occupied` tells the occupancy of each point.
/// Midnight belongs to both days.
fn stepped(mut points: Vec<[f64; 2]>, mut occupied: Vec<bool>, step_h: f64) -> Vec<[f64; 2]> {
    if let (Some([_, value]), Some([hour, _]), Some(is)) = (points.first(), points.last(), occupied.first()) {
        points.push([hour + step_h, *value]);
        occupied.push(*is);
    }
    let pairs = points.windows(2).zip(&occupied).zip(occupied.iter().skip(1));
    pairs
        .flat_map(|((pair, before), after)| {
            let turn_h = if *before && !*after { pair[0][0] } else { pair[1][0] };
            [pair[0], [turn_h, pair[0][1]], [turn_h, pair[1][1]], pair[1]]
        })
        .collect()
}

/// Plots over a day, with the same vertical axis so that rooms can be compared.
fn over_day(title: &str, mut panels: Vec<Panel>) -> Panels {
    let curves = panels.iter().flat_map(|panel| &panel.curves).flat_map(|curve| &curve.points).map(|point| point[1]);
    let limits = panels.iter().flat_map(|panel| &panel.limits).map(|(limit, _)| *limit);
    let finite = curves.chain(limits).filter(|value| value.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if low <= high {
        panels.iter_mut().for_each(|panel| panel.reaches = vec![low, high]);
    }
    Panels { title: title.to_owned(), across: "time of day [h]".to_owned(), columns: 2, every: Some(4.0), panels }
}

fn name(recorded: &RecordedRun, zone: usize) -> String {
    let named = network(recorded).and_then(|network| network.names().get(zone).cloned());
    named.unwrap_or_else(|| format!("zone {}", zone + 1))
}

/// The cost of each day, of one or several runs.
pub fn costs(title: &str, recorded_runs: &[&RecordedRun]) -> Panels {
    let curve = |(recorded, style): (&&RecordedRun, LineStyle)| {
        let days = recorded.report.building.iter().flat_map(|building| &building.iterations);
        let points = days.enumerate().map(|(day, figures)| [day as f64 + 1.0, figures.figures.cost]).collect();
        Curve::new(recorded.label.as_str(), style, points).marked()
    };
    let mut curves: Vec<Curve> = recorded_runs.iter().zip(style::line_styles()).map(curve).collect();
    if let ([recorded], [own]) = (recorded_runs, &mut curves[..]) {
        let days = recorded.report.building.iter().flat_map(|building| &building.iterations).enumerate();
        let least = days.filter_map(|(day, figures)| Some([day as f64 + 1.0, figures.figures.cost - figures.regret?]));
        let least: Vec<[f64; 2]> = least.collect();
        if !least.is_empty() {
            if own.name.is_empty() {
                own.name = format!("with the {} controller", recorded.scenario.controller().kind());
            }
            curves.push(Curve::new("cheapest possible, known only afterwards", WANTED, least));
        }
    }
    let values = curves.iter().flat_map(|curve| &curve.points).map(|point| point[1]);
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), cost| (low.min(cost), high.max(cost)));
    let days = curves.iter().map(|curve| curve.points.len()).max().unwrap_or(0);
    let every = (days <= 20).then_some(1.0);
    let panel = Panel {
        name: "cost J of the day [–]".to_owned(),
        curves,
        logarithmic: low > 0.0 && high > 5.0 * low,
        ..Panel::default()
    };
    Panels { title: title.to_owned(), across: "day (iteration)".to_owned(), columns: 1, every, panels: vec![panel] }
}

/// Outdoor temperature and its forecast, and the price of electricity if there is one, over all days.
pub fn weather(title: &str, recorded: &RecordedRun) -> Panels {
    let step_h = step_h(recorded);
    let per_day = (24.0 / step_h).round();
    let curve = |name: &str, style: LineStyle, value: fn(&BuildingFrame) -> f64| {
        let points = steps(recorded).map(|step| [step.day as f64 + step.step as f64 / per_day, value(step)]);
        Curve::held(name, style, &points.collect::<Vec<_>>(), 1.0 / per_day)
    };
    let panel = Panel {
        name: "outdoor temperature [°C]".to_owned(),
        curves: vec![
            curve("forecast at midnight", LineStyle::new(BLUE, Dash::Long), |step| step.forecast_c),
            curve("real", LineStyle::new(ORANGE, Dash::Solid), |step| step.ambient_c),
        ],
        ..Panel::default()
    };
    let mut panels = vec![panel];
    if steps(recorded).any(|step| step.price_per_kwh.is_some()) {
        let currency = recorded.report.building.iter().find_map(|building| building.currency.as_deref());
        let style = LineStyle::new(GREEN.rgb, Dash::Solid);
        panels.push(Panel {
            name: format!("price of electricity [{}/kWh]", currency.unwrap_or("money")),
            curves: vec![curve("price", style, |step| step.price_per_kwh.unwrap_or(f64::NAN))],
            ..Panel::default()
        });
    }
    Panels { title: title.to_owned(), across: "time [days]".to_owned(), columns: 1, every: Some(1.0), panels }
}

/// The net effect of weather and people on each zone on the first day, predicted and real, as the equivalent outdoor temperature
/// T₀ + w R₀.
pub fn disturbance(title: &str, recorded: &RecordedRun, zones: &[usize]) -> Panels {
    let per_kw: Vec<f64> = network(recorded).map_or(Vec::new(), |network| network.ambient_kw_per_k().to_vec());
    let scheduled_kw = scheduled_kw(recorded);
    let count = steps(recorded).next().map_or(1, |step| step.zones.len());
    let step_h = step_h(recorded);
    let panel = |&zone: &usize| {
        let equivalent =
            |ambient_c: f64, gains_kw: f64| ambient_c + gains_kw / per_kw.get(zone).copied().unwrap_or(1.0);
        let today = || steps(recorded).filter(|step| step.day == 0);
        let expected = today().map(|step| {
            let gains_kw = scheduled_kw.get(step.step * count + zone).copied().unwrap_or(0.0);
            [step.step as f64 * step_h, equivalent(step.forecast_c, gains_kw)]
        });
        let real =
            today().map(|step| [step.step as f64 * step_h, equivalent(step.ambient_c, step.zones[zone].gains_kw)]);
        Panel {
            name: format!("{}: net disturbance [°C]", name(recorded, zone)),
            curves: vec![
                Curve::held("predicted", LineStyle::new(BLUE, Dash::Long), &expected.collect::<Vec<_>>(), step_h),
                Curve::held("real", LineStyle::new(ORANGE, Dash::Solid), &real.collect::<Vec<_>>(), step_h),
            ],
            ..Panel::default()
        }
    };
    over_day(title, zones.iter().map(panel).collect())
}

/// Scheduled heat of people, which the controllers expect \[kW\], stacked.
fn scheduled_kw(recorded: &RecordedRun) -> Vec<f64> {
    let Some(building) = &recorded.scenario.building else { return Vec::new() };
    let zones = network(recorded).map_or(0, |network| network.zone_count());
    people(&recorded.scenario, zones).scheduled_kw(0, building.step_s, building.steps_per_day())
}

/// The cost of the common plan over the rounds of an exchange of messages, for each day with an exchange.
pub fn rounds(title: &str, recorded: &RecordedRun) -> Panels {
    let exchanges = steps(recorded).filter_map(|step| Some((step.day, step.design.as_ref()?.exchange.as_ref()?)));
    let exchanges: Vec<(usize, &Exchange)> = exchanges.filter(|(_, exchange)| exchange.costs.len() > 1).collect();
    let mut curves = Vec::new();
    for ((day, exchange), style) in exchanges.iter().zip(style::line_styles()) {
        let points = exchange.costs.iter().enumerate().map(|(round, cost)| [round as f64, *cost]);
        curves.push(Curve::new(format!("day {}", day + 1), style, points.collect()));
        if let Some(centralised) = exchange.centralised {
            let ends = [0.0, exchange.costs.len() as f64 - 1.0];
            let name = format!("day {}: the same in one problem", day + 1);
            curves.push(Curve::new(name, WANTED, ends.map(|round| [round, centralised]).to_vec()));
        }
    }
    let values = curves.iter().flat_map(|curve| &curve.points).map(|point| point[1]);
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), cost| (low.min(cost), high.max(cost)));
    let name = "expected cost J of the plan [–]".to_owned();
    let panel = Panel { name, curves, logarithmic: low > 0.0 && high > 5.0 * low, ..Panel::default() };
    let across = "round of messages k^c".to_owned();
    Panels { title: title.to_owned(), across, columns: 1, every: None, panels: vec![panel] }
}
