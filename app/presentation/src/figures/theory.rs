//! Pictures and tables that need no run: parameters, payoffs, probability weighting, and the identified classroom.

use interplay_building::comfort::Setpoints;
use interplay_building::discretise::Model;
use interplay_building::identify::synthetic_classroom::{self, Classroom};
use interplay_building::identify::{
    ErrorReport, Estimator, Identification, IdentifySettings, Quantity, ResidualForecast, ZoneReport, identify,
};
use interplay_building::network::Network;
use interplay_planners::drivers::game::payoff::Stakes;
use interplay_planners::drivers::game::prospect::{ProspectTheory, weighting};
use interplay_planners::{Body, Limits, SafetyEllipse};
use interplay_scenarios::load;

use super::entry::FigureContent;
use super::lookup::FigureError;
use crate::plot::style::{BLACK, BLUE, Dash, GREY, LineStyle, ORANGE};
use crate::plot::{Curve, Panel, Panels, TextTable};

/// Number of days of training data of the classroom.
const TRAIN_DAYS: f64 = 9.0;

/// The identified classroom over the rows trained on, or over the others (Figs. 2.5 and 2.6).
pub fn identification(title: &str, test: bool) -> Result<FigureContent, FigureError> {
    let telemetry = Classroom::default().simulate();
    let identified = |method: Estimator| {
        let settings = IdentifySettings { method, train_days: Some(TRAIN_DAYS), ..IdentifySettings::default() };
        identify(&telemetry, &settings)
    };
    let (found, source) = (identified(Estimator::PredictionError)?, identified(Estimator::Semiparametric)?);
    let (Some(zone), Some(other)) = (found.report.zones.first(), source.report.zones.first()) else {
        return Err(FigureError::NoZone);
    };
    let errors = if test { zone.test.as_ref() } else { Some(&zone.train) };
    let tables = errors.map(fit_errors).into_iter().chain([parameters_found(zone, other)]).collect();
    Ok(FigureContent { pictures: vec![fit(title, &found, test).drawing()], tables, ..FigureContent::default() })
}

/// Rows from one drawn prediction to the next: one hour.
const PREDICTION_EVERY_ROWS: usize = 4;

fn fit(title: &str, found: &Identification, test: bool) -> Panels {
    let Some(series) = found.series.first() else { return Panels::default() };
    let rows = if test { series.test_start..series.measured_c.len() } else { 0..series.test_start };
    let curve = |name: &str, style: LineStyle, values: &[f64]| {
        let points = rows.clone().map(|row| [series.time_s[row] / 86_400.0, values[row]]);
        Curve::new(name, style.thin(), points.collect())
    };
    let measured = || {
        let curve = curve("measured", LineStyle::new(GREY, Dash::Solid), &series.measured_c);
        Curve { style: LineStyle { width: 1, ..curve.style }, ..curve }
    };
    let panel = |name: &str, predicted: Curve| Panel {
        name: name.to_owned(),
        // One dot per hour leaves the measurements between them visible.
        curves: vec![measured(), predicted.dotted(PREDICTION_EVERY_ROWS)],
        ..Panel::default()
    };
    let one_step = curve(
        "predicted a step (15 min) ahead, a dot an hour",
        LineStyle::new(ORANGE, Dash::Solid),
        &series.one_step_c,
    );
    let free_run = series.free_run_with_residual_model_c.as_ref().unwrap_or(&series.free_run_c);
    let free_run =
        curve("predicted a day ahead, from midnight on, a dot an hour", LineStyle::new(BLUE, Dash::Solid), free_run);
    Panels {
        title: title.to_owned(),
        across: "time [days]".to_owned(),
        columns: 1,
        every: Some(1.0),
        panels: vec![panel("temperature [°C]", one_step), panel("temperature [°C]", free_run)],
    }
}

fn fit_errors(errors: &ErrorReport) -> TextTable {
    let kelvin = |value: f64| format!("{value:.3}");
    let mut rows = vec![["one step ahead, network alone".to_owned(), kelvin(errors.one_step_k)]];
    let with_residual_model = errors.one_step_with_residual_model_k;
    rows.extend(with_residual_model.map(|error_k| ["one step ahead, with residual model".to_owned(), kelvin(error_k)]));
    let words = |forecast: &ResidualForecast| match forecast {
        ResidualForecast::None => "network alone",
        ResidualForecast::Constant => "with a constant",
        ResidualForecast::Arma => "with a constant and ARMA, as in the dissertation",
        ResidualForecast::Profile => "with a daily profile",
        ResidualForecast::ProfileArma => "with a daily profile and ARMA",
    };
    let runs = errors.free_run.errors_k.iter();
    rows.extend(runs.filter_map(|(how, error_k)| Some([format!("a day ahead, {}", words(how)), kelvin((*error_k)?)])));
    TextTable::new("Measured: errors, root mean square", ["prediction", "error [K]"], rows)
}

fn parameters_found(zone: &ZoneReport, other: &ZoneReport) -> TextTable {
    let number = |value: Option<f64>| value.map_or_else(|| "undetermined".to_owned(), |value| format!("{value:.4}"));
    let truth = |name: &str| match name {
        "heat capacity" => format!("{:.1}", synthetic_classroom::CAPACITY_KJ_PER_K),
        "resistance to outdoor" => format!("{:.2}", synthetic_classroom::OUTDOOR_K_PER_KW),
        "resistance to room-b" | "resistance to room-c" => format!("{:.2}", synthetic_classroom::ROOM_K_PER_KW),
        _ => String::new(),
    };
    let rows = zone.physical.iter().map(|quantity| {
        let Quantity { name, value, standard_error, unit, .. } = quantity;
        let by_source = other.physical.iter().find(|other| other.name == *name).and_then(|other| other.value);
        [name.clone(), truth(name), number(*value), number(*standard_error), number(by_source), unit.clone()]
    });
    let header = ["parameter", "simulated with", "estimate", "standard error", "by the dissertation's method", "unit"];
    TextTable::new("Measured: parameters", header, rows.collect())
}

/// Table 2.1 in a consistent unit, and the eigenvalues that follow from each reading of the printed unit.
pub fn thermal_parameters(title: &str) -> Result<FigureContent, FigureError> {
    let network = Network::testbed();
    let found = Model::euler(&network, 1800.0)?;
    let constants = network.time_constants_s();
    let row = |name: &str, printed: &str, value: String, unit: &str| {
        [name.to_owned(), printed.to_owned(), value, unit.to_owned()]
    };
    let conductance = |from: usize| 1.0 / network.ambient_kw_per_k()[from];
    let wall = network.links().first();
    let wall = wall.map_or(f64::NAN, |link| 1.0 / link.conductance_kw_per_k);
    let rows = vec![
        row("c1 … c4", "1000 kJ/K", format!("{:.0}", network.capacities_kj_per_k()[0]), "kJ/K"),
        row("R12, R13, R24, R34", "1.0417 kW/K", format!("{wall:.2}"), "K/kW"),
        row("R14, R23", "10000 kW/K", "no wall".to_owned(), ""),
        row("R01 … R04", "0.5208 kW/K", format!("{:.2}", conductance(0)), "K/kW"),
    ];
    let table = TextTable::new(title, ["parameter", "printed", "as used here", "unit"], rows);
    let list = |values: Vec<f64>, digits: usize| {
        let words: Vec<String> = values.into_iter().map(|value| format!("{value:.digits$}")).collect();
        words.join(", ")
    };
    let as_printed = printed_eigenvalues();
    let findings = vec![
        ["K·min/kJ (as used here)".to_owned(), list(found.eigenvalues(), 3), "stable".to_owned()],
        ["kW/K (as printed)".to_owned(), list(as_printed, 2), "unstable: grows from step to step".to_owned()],
    ];
    let hours = list(constants.into_iter().map(|seconds| seconds / 3600.0).collect(), 1);
    let findings = TextTable::new(
        "Measured: eigenvalues of A = I + T_s C⁻¹ R with steps of half an hour",
        ["unit of the resistances", "eigenvalues", ""],
        findings,
    );
    let constants = TextTable::new("Measured: time constants", ["time constants [h]"], vec![[hours]]);
    Ok(FigureContent { pictures: vec![table.drawing()], tables: vec![findings, constants], ..FigureContent::default() })
}

/// Eigenvalues of the step of forward Euler if Table 2.1's numbers were conductances \[kW/K\], as printed. The four rooms
/// form a ring, whose Laplacian has the eigenvalues 0, 2, 2 and 4.
fn printed_eigenvalues() -> Vec<f64> {
    let (step_s, capacity, wall, outer) = (1800.0, 1000.0, 1.0417, 0.5208);
    [0.0, 2.0, 2.0, 4.0].map(|mode| 1.0 - step_s / capacity * (wall * mode + outer)).to_vec()
}

/// Wanted temperatures (Tables 3.1 and 4.1).
pub fn setpoints(title: &str, setpoints: &Setpoints) -> FigureContent {
    let rooms = setpoints.occupied_c.iter().enumerate();
    let rows = rooms.map(|(room, wanted_c)| [format!("{}", room + 1), format!("{wanted_c:.1}")]).collect();
    let table = TextTable::new(title, ["room", "temperature [°C]"], rows);
    let Setpoints { from_h, to_h, band_k, .. } = setpoints;
    let other = setpoints.other_c.map_or_else(|| "free".to_owned(), |other_c| format!("{other_c:.1} °C"));
    let rows = vec![[format!("{from_h:.1} h to {to_h:.1} h"), other, format!("±{band_k:.1} K")]];
    let findings = TextTable::new("As used here", ["working hours", "at other times", "comfort band"], rows);
    FigureContent { pictures: vec![table.drawing()], tables: vec![findings], ..FigureContent::default() }
}

/// The size of vehicles (Table 6.1).
pub fn dimensions(title: &str) -> FigureContent {
    let body = Body::default();
    let lane = interplay_scenarios::Lanes::default().lane_width_m;
    let values = [
        ("L_f", "front axle to mass centre", body.front_axle_m),
        ("L_r", "rear axle to mass centre", body.rear_axle_m),
        ("W_V", "width of a vehicle", body.width_m),
        ("W_L", "width of a lane", lane),
    ];
    let row = |(symbol, name, value): (&str, &str, f64)| [symbol.to_owned(), name.to_owned(), format!("{value:.2} m")];
    let table = TextTable::new(title, ["symbol", "meaning", "value"], values.map(row).to_vec());
    FigureContent { pictures: vec![table.drawing()], ..FigureContent::default() }
}

/// An angle as π divided by a whole number, where it is one; otherwise in decimals.
fn angle(angle_rad: f64) -> String {
    let shares = std::f64::consts::PI / angle_rad;
    if (shares - shares.round()).abs() < 1e-9 { format!("π/{}", shares.round()) } else { format!("{angle_rad:.3}") }
}

/// Settings of the optimisation of plans (Table 6.2).
pub fn configuration(title: &str) -> Result<FigureContent, FigureError> {
    let scenario = load("lane-change/front-nice", &[])?;
    let (limits, ellipse) = (Limits::default(), SafetyEllipse::default());
    let row = |symbol: &str, name: &str, value: String| [symbol.to_owned(), name.to_owned(), value];
    let steering = angle(limits.steering_max_rad);
    let rows = vec![
        row("T_s", "step", format!("{} s", scenario.step_s)),
        row("N", "steps of the horizon", scenario.horizon_steps.to_string()),
        row(
            "u_a",
            "acceleration",
            format!("{:+.1} to {:+.1} m/s²", limits.acceleration_min_mps2, limits.acceleration_max_mps2)
                .replace('-', "−"),
        ),
        row("u_δ", "steering angle", format!("−{steering} to +{steering} rad")),
        row("y", "lateral position of the corners", format!("0 to {:.2} m", scenario.road.width_m())),
        row("v", "speed", format!("{:.1} to {:.1} m/s", limits.speed_min_mps, limits.speed_max_mps)),
        row("a_s", "half axis of the safety ellipse along the road", format!("{:.2} m", ellipse.along_m)),
        row("b_s", "half axis across it", format!("{:.2} m", ellipse.across_m)),
    ];
    let table = TextTable::new(title, ["symbol", "meaning", "value"], rows);
    Ok(FigureContent { pictures: vec![table.drawing()], ..FigureContent::default() })
}

/// Weighting of cumulative probabilities by prospect theory (Fig. 8.1).
pub fn weights(title: &str) -> FigureContent {
    let ProspectTheory { gamma, eta, .. } = ProspectTheory::default();
    let curve = |name: String, style: LineStyle, weigh: &dyn Fn(f64) -> f64| {
        let points = (0..=200).map(|i| f64::from(i) / 200.0).map(|p| [p, weigh(p)]);
        Curve::new(name, style, points.collect())
    };
    let panel = Panel {
        name: "subjective weight w [–]".to_owned(),
        curves: vec![
            curve(format!("gains, exponent {gamma}"), LineStyle::new(BLUE, Dash::Solid), &|p| weighting(p, gamma)),
            curve(format!("losses, exponent {eta}"), LineStyle::new(ORANGE, Dash::Long), &|p| weighting(p, eta)),
            curve("as probable as it is".to_owned(), LineStyle::new(BLACK, Dash::Short).thin(), &|p| p),
        ],
        ..Panel::default()
    };
    let across = "objective cumulative probability p [–]".to_owned();
    let picture = Panels { title: title.to_owned(), across, columns: 1, every: None, panels: vec![panel] };
    let crossing = |exponent: f64| {
        let above = (1..1000).map(|i| f64::from(i) / 1000.0).take_while(|&p| weighting(p, exponent) > p);
        above.last().unwrap_or_default()
    };
    let row = |name: &str, exponent: f64| {
        let [rare, likely] = [0.05, 0.95].map(|p| format!("{:.3}", weighting(p, exponent)));
        [name.to_owned(), rare, likely, format!("{:.2}", crossing(exponent))]
    };
    let header = ["", "weight of p = 0.05", "weight of p = 0.95", "overweighted up to p ="];
    let findings = TextTable::new("Measured", header, vec![row("gains", gamma), row("losses", eta)]);
    FigureContent { pictures: vec![picture.drawing()], tables: vec![findings], ..FigureContent::default() }
}

/// The game of chicken (Table 8.1).
pub fn chicken(title: &str) -> FigureContent {
    let row = |words: [&str; 3]| words.map(str::to_owned);
    let rows = vec![row(["X swerves", "(1, 1)", "(−1, 2)"]), row(["X drives", "(2, −1)", "(−M, −M)"])];
    let table = TextTable::new(title, ["payoffs (X, Y)", "Y swerves", "Y drives"], rows);
    FigureContent { pictures: vec![table.drawing()], ..FigureContent::default() }
}

/// The payoffs of the driving game (Table 8.2), in symbols and for one pair of intentions.
pub fn payoffs(title: &str) -> FigureContent {
    let row = |words: [&str; 3]| words.map(str::to_owned);
    let rows = vec![row(["SV yields", "(−2x_s, −2x_e)", "(−x_s, x_e)"]), row(["SV passes", "(x_s, −x_e)", "(−M, −M)"])];
    let table = TextTable::new(title, ["payoffs (SV, EV)", "EV yields", "EV passes"], rows);
    // The dissertation's stakes are ratios of probabilities between 0.05 and 0.95.
    let stakes = |[of, over]: [f64; 2]| Stakes { turn: of / over, accident: 2.0 };
    let rows = [[0.5, 0.5], [0.05, 0.95], [0.95, 0.05]].map(|pair| {
        let [[both, alone], [first, accident]] = stakes(pair).payoffs();
        [
            format!("{} / {}", pair[0], pair[1]),
            format!("{both:.2}"),
            format!("{alone:.2}"),
            format!("{first:.2}"),
            format!("{accident:.2}"),
        ]
    });
    let header = ["stake x of a player", "both yield", "it alone yields", "it alone passes", "both pass (M = 2)"];
    let findings = TextTable::new("Measured: what one player gets", header, rows.to_vec());
    FigureContent { pictures: vec![table.drawing()], tables: vec![findings], ..FigureContent::default() }
}

/// The probabilities of the four events (Table 8.3), in symbols and as they are computed.
pub fn events(title: &str) -> FigureContent {
    let row = |words: [&str; 3]| words.map(str::to_owned);
    let rows =
        vec![row(["SV yields", "(1 − p_e)(1 − p_s)", "p_e (1 − p_s)"]), row(["SV passes", "(1 − p_e) p_s", "p_e p_s"])];
    let table = TextTable::new(title, ["probability", "EV yields", "EV passes"], rows);
    let rows = [[0.5, 0.5], [0.8, 0.3]].map(|[p_e, p_s]| {
        let lottery = Stakes { turn: 1.0, accident: 2.0 }.lottery(p_e, p_s).map(|outcome| outcome.probability);
        let total: f64 = lottery.iter().sum();
        let [neither, other, ego, both] = lottery.map(|probability| format!("{probability:.2}"));
        [format!("p_e = {p_e}, p_s = {p_s}"), neither, other, ego, both, format!("{total:.2}")]
    });
    let header = ["for", "both yield", "SV passes alone", "EV passes alone", "both pass", "together"];
    let findings = TextTable::new("Measured", header, rows.to_vec());
    FigureContent { pictures: vec![table.drawing()], tables: vec![findings], ..FigureContent::default() }
}
