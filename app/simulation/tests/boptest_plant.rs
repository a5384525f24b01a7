//! A test case of BOPTEST as the plant, with a server of ours in its place: what is sent, what is measured and computed, and that
//! whatever else a server does ends the run with an error and in time.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use interplay_scenarios::{
    BoptestIndicators, BoptestInput, BoptestPlantConfig, BoptestPrices, BoptestZone, BuildingPlant, Scenario,
};
use interplay_simulation::Simulation;
use interplay_simulation::report::Report;
use serde_json::{Value, json};

const STEP_S: f64 = 1800.0;
const STEPS: usize = 48;

/// What a server is asked: method and path, and the body.
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
            log.lock().expect("nobody panicked").push((request.clone(), body.clone()));
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

/// A case whose zone is always at 20 °C where at least 21 °C are wanted, and whose heat pump always takes 960 W.
fn sound(request: &str, body: &Value) -> Option<(u16, String)> {
    let state = json!({ "time": 86_400.0, "reaT_y": 293.15 });
    let payload = match request {
        "POST /testcases/a-case/select" => return Some((200, json!({ "testid": "1f-2" }).to_string())),
        "GET /inputs/1f-2" => json!({ "oveY_u": {}, "oveY_activate": {} }),
        "GET /measurements/1f-2" => json!({ "reaT_y": {}, "reaP_y": {} }),
        "PUT /scenario/1f-2" => json!({ "electricity_price": "dynamic", "time_period": state }),
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

fn config(url: String) -> BoptestPlantConfig {
    let input =
        BoptestInput { name: "oveY_u".to_owned(), at_zero: 0.0, per_kw: 0.1, min: 0.0, max: 1.0, least_on: None };
    BoptestPlantConfig {
        url,
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
        timeout_s: 5.0,
    }
}

/// A day of one zone at the server.
fn scenario(config: BoptestPlantConfig) -> Scenario {
    let text = "title = 'A'\nshows = 'B'\niterations = 1\n[[building.zone]]\nname = 'house'\nheating_limit_kw = 8.0\n\
                [[building.wall]]\nbetween = ['house', 'ambient']\nresistance_k_per_kw = 5.0\n[weather]\nkind = 'synthetic'\n\
                [weather.climate]\nmean_c = 5.0\n[setpoints]\noccupied_c = [21.0]\n[controller]\nkind = 'pid'";
    let mut scenario = interplay_scenarios::from_text("a.toml", text, &[]).expect("a scenario");
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
fn heat_becomes_inputs_and_measurements_become_indicators() {
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

    let asked = asked.lock().expect("nobody panicked");
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
fn whatever_a_server_does_wrong_is_an_error() {
    let wrong: [(&str, &str, Option<(u16, &str)>, &str); 10] = [
        ("POST /testcases/a-case/select", "refused", Some((404, r#"{"message":"no such case"}"#)), "no such case"),
        ("POST /testcases/a-case/select", "without identifier", Some((200, "{}")), "no `testid`"),
        ("GET /inputs/1f-2", "other inputs", Some((200, r#"{"payload":{"oveZ_u":{}}}"#)), "zones.0.inputs.0.name"),
        ("GET /measurements/1f-2", "other names", Some((200, r#"{"payload":{"reaX_y":{}}}"#)), "reaX_y"),
        ("PUT /scenario/1f-2", "no such period", Some((200, r#"{"payload":{"time_period":null}}"#)), "a_period"),
        ("POST /advance/1f-2", "no number", Some((200, r#"{"payload":{"reaT_y":"warm"}}"#)), "no number `reaT_y`"),
        ("POST /advance/1f-2", "in Celsius", Some((200, r#"{"payload":{"reaT_y":21.0}}"#)), "-252.15 °C"),
        ("POST /advance/1f-2", "a failure", Some((200, r#"{"status":500,"message":"solver"}"#)), "status 500"),
        ("POST /advance/1f-2", "a crash", None, "advance"),
        ("PUT /results/1f-2", "no JSON", Some((200, "<html>")), "no JSON"),
    ];
    for (path, what, answer, said) in wrong {
        let answer = answer.map(|(status, text)| (status, text.to_owned()));
        let (url, _) = server(move |request, body| if request == path { answer.clone() } else { sound(request, body) });
        let error = run(config(url)).map(|_| ()).expect_err(what);
        assert!(error.contains(said), "{what}: {error}");
    }
}

#[test]
fn a_server_that_is_silent_ends_the_run_in_time() {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let url = format!("http://{}", listener.local_addr().expect("an address"));
    let began = Instant::now();
    let error = run(BoptestPlantConfig { timeout_s: 0.2, ..config(url) }).map(|_| ()).expect_err("silent");
    assert!(error.contains("within 0.2 s"), "{error}");
    assert!(began.elapsed() < Duration::from_secs(20));
}

#[test]
fn nobody_at_the_address_is_an_error() {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let url = format!("http://{}", listener.local_addr().expect("an address"));
    drop(listener);
    let error = run(config(url)).map(|_| ()).expect_err("nobody listens");
    assert!(error.contains("cannot connect") && error.contains("building.plant.url"), "{error}");
}
