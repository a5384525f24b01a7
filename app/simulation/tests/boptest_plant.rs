//! A test case of BOPTEST as the plant, with a mock server: requests, measurements and indicators. Any
//! misbehaviour of the server ends the run with an error and in time.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use interplay_scenarios::{
    BoptestForecast, BoptestIndicators, BoptestInput, BoptestPlantConfig, BoptestPrices, BoptestZone, BuildingPlant,
    Scenario,
};
use interplay_simulation::Simulation;
use interplay_simulation::report::Report;
use serde_json::{Value, json};

const STEP_S: f64 = 1800.0;
const STEPS: usize = 48;

/// A request to the server: method and path, and the body.
type Asked = Arc<Mutex<Vec<(String, Value)>>>;

/// A server that gives `answer` to each request; `None` closes the connection without an answer.
fn server(answer: impl Fn(&str, &Value) -> Option<(u16, String)> + Send + 'static) -> (String, Asked) {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let url = format!("http://{}", listener.local_addr().expect("an address"));
    let asked = Asked::default();
    let log = Arc::clone(&asked);
    thread::spawn(move || {
        for stream in listener.incoming() {
            let Ok(mut stream) = stream else { return };
            let Some((request, body)) = read(&mut stream) else { continue };
            log.lock().expect("no thread panics").push((request.clone(), body.clone()));
            if let Some((status, text)) = answer(&request, &body) {
                let _ = write!(stream, "HTTP/1.0 {status} X\r\nContent-Length: {}\r\n\r\n{text}", text.len());
            }
        }
    });
    (url, asked)
}

fn read(stream: &mut TcpStream) -> Option<(String, Value)> {
    let (mut received, mut buffer) = (Vec::new(), [0; 4096]);
    loop {
        let text = String::from_utf8_lossy(&received).into_owned();
        if let Some((head, body)) = text.split_once("\r\n\r\n") {
            let length = head.lines().find_map(|line| line.strip_prefix("Content-Length: "))?.parse::<usize>().ok()?;
            if body.len() >= length {
                let words: Vec<&str> = head.split(' ').collect();
                let body = serde_json::from_str(body).unwrap_or(Value::Null);
                return Some((format!("{} {}", words[0], words[1]), body));
            }
        }
        match stream.read(&mut buffer).ok()? {
            0 => return None,
            count => received.extend_from_slice(&buffer[..count]),
        }
    }
}

/// A case whose zone is always at 20 °C with a target of at least 21 °C, and whose heat pump always takes 960 W.
fn sound(request: &str, body: &Value) -> Option<(u16, String)> {
    let state = json!({ "time": 86_400.0, "reaT_y": 293.15 });
    let payload = match request {
        "POST /testcases/a-case/select" => return Some((200, json!({ "testid": "1f-2" }).to_string())),
        "GET /inputs/1f-2" => json!({ "oveY_u": {}, "oveY_activate": {} }),
        "GET /measurements/1f-2" => json!({ "reaT_y": {}, "reaP_y": {} }),
        "PUT /scenario/1f-2" => json!({ "electricity_price": "dynamic", "time_period": state }),
        "PUT /forecast/1f-2" if body["point_names"][0] == "TDryBul" => foretold(body),
        "PUT /forecast/1f-2" => json!({
            "time": [86_400.0, 172_800.0],
            "LowerSetp[1]": [294.15, 294.15],
            "UpperSetp[1]": [297.15, 297.15],
            "PriceElectricPowerDynamic": [0.25, 0.25],
            "EmissionsElectricPower": [0.167, 0.167],
        }),
        "PUT /results/1f-2" => {
            assert_eq!((&body["start_time"], &body["final_time"]), (&json!(86_400.0), &json!(172_800.0)));
            let times: Vec<f64> = (0..=2880).map(|index| 86_400.0 + 30.0 * f64::from(index)).collect();
            let (temperatures, powers) = (vec![293.15; times.len()], vec![960.0; times.len()]);
            json!({ "time": times, "reaT_y": temperatures, "reaP_y": powers })
        }
        "GET /kpi/1f-2" => json!({ "tdis_tot": 24.0, "ener_tot": 0.12, "pgas_tot": null }),
        _ => state,
    };
    Some((200, json!({ "status": 200, "message": "done", "payload": payload }).to_string()))
}

/// Two days of the case: -3 °C outdoors, a sun of 100 W/m², people who give 200 W and are away from 8 to 18 o'clock, and electricity that
/// is expensive from 12 o'clock on.
fn foretold(body: &Value) -> Value {
    assert_eq!((&body["horizon"], &body["interval"]), (&json!(172_800.0), &json!(900.0)));
    let hours: Vec<f64> = (0..=192).map(|quarter| f64::from(quarter % 96) / 4.0).collect();
    let by_hour = |value: &dyn Fn(f64) -> f64| hours.iter().map(|hour| value(*hour)).collect::<Vec<f64>>();
    let is_away = |hour: f64| (8.0..18.0).contains(&hour);
    json!({
        "time": (0..=192).map(|quarter| 86_400.0 + 900.0 * f64::from(quarter)).collect::<Vec<f64>>(),
        "TDryBul": by_hour(&|_| 270.15),
        "HGloHor": by_hour(&|_| 100.0),
        "LowerSetp[1]": by_hour(&|hour| if is_away(hour) { 288.15 } else { 294.15 }),
        "UpperSetp[1]": by_hour(&|hour| if is_away(hour) { 303.15 } else { 297.15 }),
        "InternalGainsCon[1]": by_hour(&|hour| if is_away(hour) { 0.0 } else { 150.0 }),
        "InternalGainsRad[1]": by_hour(&|hour| if is_away(hour) { 0.0 } else { 50.0 }),
        "PriceElectricPowerDynamic": by_hour(&|hour| if hour < 12.0 { 0.1 } else { 0.3 }),
        "EmissionsElectricPower": by_hour(&|_| 0.167),
    })
}

fn config(url: String) -> BoptestPlantConfig {
    let input =
        BoptestInput { name: "oveY_u".to_owned(), at_zero: 0.0, per_kw: 0.1, min: 0.0, max: 1.0, least_on: None };
    BoptestPlantConfig {
        url: Some(url),
        fmu: None,
        sampling_s: 30.0,
        case: Some("a-case".to_owned()),
        period: Some("a_period".to_owned()),
        start_day: 0,
        warmup_days: 0,
        prices: BoptestPrices::Dynamic,
        zones: vec![BoptestZone { temperature: "reaT_y".to_owned(), inputs: vec![input] }],
        indicators: Some(BoptestIndicators {
            area_m2: 192.0,
            zones: vec!["1".to_owned()],
            carbon_dioxide: Vec::new(),
            electricity: vec!["reaP_y".to_owned()],
            gas: Vec::new(),
            district_heat: Vec::new(),
        }),
        forecast: None,
        timeout_s: 5.0,
    }
}

/// A day of one zone on the server.
fn scenario(config: BoptestPlantConfig) -> Scenario {
    scenario_with(config, "controller.kind=\"pid\"")
}

fn scenario_with(config: BoptestPlantConfig, controller: &str) -> Scenario {
    let text = "title = 'A'\nshows = 'B'\niterations = 1\n[[building.zone]]\nname = 'house'\nheating_limit_kw = 8.0\n\
                [[building.wall]]\nbetween = ['house', 'ambient']\nresistance_k_per_kw = 5.0\n[weather]\nkind = 'synthetic'\n\
                [weather.climate]\nmean_c = 5.0\n[setpoints]\noccupied_c = [21.0]\n";
    let text = format!("{controller}\n{text}");
    let mut scenario = interplay_scenarios::from_text("a.toml", &text, &[]).expect("a scenario");
    scenario.building.as_mut().expect("a building").plant = BuildingPlant::Boptest(Box::new(config));
    scenario
}

fn run(config: BoptestPlantConfig) -> Result<Report, String> {
    let simulation = Simulation::new(&scenario(config)).map_err(|error| error.to_string())?;
    let mut simulation = simulation;
    while simulation.step().map_err(|error| error.to_string())?.is_some() {}
    simulation.finish().map_err(|error| error.to_string())
}

#[test]
fn a_boptest_run_sends_heat_and_computes_the_indicators() {
    let (url, asked) = server(sound);
    let building = run(config(url)).expect("a run").building.expect("a building");
    let benchmark = building.benchmark.expect("indicators");
    assert_eq!(benchmark.official["tdis_tot"], Some(24.0));
    assert_eq!(benchmark.official["pgas_tot"], None);
    let ours = benchmark.ours.expect("ours");
    assert!((ours.tdis_k_h - 24.0).abs() < 1e-9, "{ours:?}");
    assert!((ours.ener_kwh_per_m2 - 0.12).abs() < 1e-6, "{ours:?}");
    assert!((ours.cost_per_m2 - 0.03).abs() < 1e-6, "{ours:?}");
    assert!((ours.pele_kw_per_m2.expect("electricity") - 0.005).abs() < 1e-12, "{ours:?}");
    assert!(benchmark.time_ratio.is_some_and(|ratio| ratio > 0.0 && ratio < 0.01));

    let asked = asked.lock().expect("no thread panics");
    let step = asked.iter().find(|(request, _)| request == "PUT /step/1f-2").expect("a step");
    assert_eq!(step.1, json!({ "step": STEP_S }));
    let advances: Vec<&Value> =
        asked.iter().filter(|(request, _)| request == "POST /advance/1f-2").map(|(_, body)| body).collect();
    assert_eq!(advances.len(), STEPS);
    for body in &advances {
        assert_eq!(body["oveY_activate"], json!(1));
        let value = body["oveY_u"].as_f64().expect("a number");
        assert!((0.0..=0.8).contains(&value), "{value}: at most 8 kW with 0.1 per kW");
    }
    assert!(advances[24]["oveY_u"].as_f64().expect("a number") > 0.0, "a cold zone is heated");
    assert_eq!(asked.last().map(|(request, _)| request.as_str()), Some("PUT /stop/1f-2"));
}

#[test]
fn a_boptest_case_provides_forecasts_prices_and_comfort_bounds() {
    let (url, _) = server(sound);
    let forecast = BoptestForecast { zones: vec!["1".to_owned()], ..BoptestForecast::default() };
    let mut scenario = scenario(BoptestPlantConfig { forecast: Some(forecast), ..config(url) });
    scenario.building.as_mut().expect("a building").zones[0].solar_aperture_m2 = 2.0;
    let mut simulation = Simulation::new(&scenario).expect("a simulation");
    let mut steps = Vec::new();
    while let Some(frame) = simulation.step().expect("a step") {
        steps.push(frame.building.clone().expect("a building"));
    }
    let step = |hour: usize| &steps[2 * hour];
    assert_eq!((step(3).ambient_c, step(3).forecast_c, step(3).sun_w_per_m2), (-3.0, -3.0, 100.0));
    assert!((step(3).zones[0].gains_kw - 0.4).abs() < 1e-12 && (step(10).zones[0].gains_kw - 0.2).abs() < 1e-12);
    assert_eq!((step(3).zones[0].reference_c, step(3).zones[0].band_k), (Some(22.5), Some(1.5)));
    assert_eq!((step(10).zones[0].reference_c, step(10).zones[0].band_k), (None, None));
    assert_eq!((step(3).price_per_kwh, step(13).price_per_kwh), (Some(0.1), Some(0.3)));
    let building = simulation.finish().expect("a report").building.expect("a building");
    let metered = building.iterations[0].metered.expect("a meter");
    assert!(
        (metered.electric_kwh - 23.04).abs() < 1e-4 && (metered.electric_peak_kw - 0.96).abs() < 1e-9,
        "{metered:?}"
    );
    assert!((metered.electric_cost - 23.04 * 0.25).abs() < 1e-4, "{metered:?}");
}

#[test]
fn learning_and_economic_controllers_run_on_a_boptest_case() {
    for kind in ["economic-mpc", "model-predictive", "iterative", "concurrent"] {
        let (url, _) = server(sound);
        let forecast = BoptestForecast { zones: vec!["1".to_owned()], ..BoptestForecast::default() };
        let text = format!("controller.kind=\"{kind}\"");
        let scenario = scenario_with(BoptestPlantConfig { forecast: Some(forecast), ..config(url) }, &text);
        let mut simulation = Simulation::new(&scenario).expect(kind);
        while simulation.step().expect(kind).is_some() {}
        let building = simulation.finish().expect(kind).building.expect("a building");
        assert!(building.benchmark.is_some(), "{kind}");
    }
}

/// A fault of the server: request, name, its answer with status and body, and a fragment of the error.
type Lie<'a> = (&'a str, &'a str, Option<(u16, &'a str)>, &'a str);

#[test]
fn every_fault_of_a_server_is_an_error() {
    let wrong: [Lie<'_>; 11] = [
        ("POST /testcases/a-case/select", "refused", Some((404, r#"{"message":"no such case"}"#)), "no such case"),
        ("POST /testcases/a-case/select", "without identifier", Some((200, "{}")), "no `testid`"),
        ("GET /inputs/1f-2", "other inputs", Some((200, r#"{"payload":{"oveZ_u":{}}}"#)), "zones.0.inputs.0.name"),
        ("GET /measurements/1f-2", "other names", Some((200, r#"{"payload":{"reaX_y":{}}}"#)), "reaX_y"),
        ("PUT /scenario/1f-2", "no such period", Some((200, r#"{"payload":{"time_period":null}}"#)), "a_period"),
        ("POST /advance/1f-2", "no number", Some((200, r#"{"payload":{"reaT_y":"warm"}}"#)), "no number `reaT_y`"),
        ("POST /advance/1f-2", "in Celsius", Some((200, r#"{"payload":{"reaT_y":21.0}}"#)), "-252.15 °C"),
        ("POST /advance/1f-2", "a failure", Some((200, r#"{"status":500,"message":"solver"}"#)), "status 500"),
        ("POST /advance/1f-2", "a crash", None, "advance"),
        ("GET /kpi/1f-2", "a text", Some((200, r#"{"payload":{"tdis_tot":"much"}}"#)), "`tdis_tot` is neither"),
        ("PUT /results/1f-2", "no JSON", Some((200, "<html>")), "not JSON"),
    ];
    for (path, what, answer, said) in wrong {
        let answer = answer.map(|(status, text)| (status, text.to_owned()));
        let (url, _) = server(move |request, body| if request == path { answer.clone() } else { sound(request, body) });
        let error = run(config(url)).map(|_| ()).expect_err(what);
        assert!(error.contains(said), "{what}: {error}");
    }
}

#[test]
fn implausible_temperatures_are_refused() {
    for (name, kelvin) in [("TDryBul", -9.0), ("LowerSetp[1]", 21.0), ("UpperSetp[1]", 1e9)] {
        let (url, _) = server(move |request, body| {
            let (status, text) = sound(request, body)?;
            let mut answer: Value = serde_json::from_str(&text).expect("JSON");
            if request == "PUT /forecast/1f-2" && body["point_names"][0] == "TDryBul" {
                answer["payload"][name][7] = json!(kelvin);
            }
            Some((status, answer.to_string()))
        });
        let forecast = BoptestForecast { zones: vec!["1".to_owned()], ..BoptestForecast::default() };
        let error = run(BoptestPlantConfig { forecast: Some(forecast), ..config(url) }).map(|_| ()).expect_err(name);
        assert!(error.contains(name) && error.contains("outside of -100 to 200 °C"), "{error}");
    }
}

#[test]
fn a_silent_server_ends_the_run_in_time() {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let url = format!("http://{}", listener.local_addr().expect("an address"));
    let began = Instant::now();
    let error = run(BoptestPlantConfig { timeout_s: 0.2, ..config(url) }).map(|_| ()).expect_err("silent");
    assert!(error.contains("within 0.2 s"), "{error}");
    assert!(began.elapsed() < Duration::from_secs(20));
}

#[test]
fn an_address_without_a_server_is_an_error() {
    // Port 1: another test may listen on a port that was free before.
    let error = run(config("http://127.0.0.1:1".to_owned())).map(|_| ()).expect_err("no server listens");
    assert!(error.contains("cannot connect") && error.contains("building.plant.url"), "{error}");
}
