//! A building that is another program: a server that answers with our own network gives our own run, and any wrong answer of a
//! server is an error, not a panic.

use std::io::{BufRead, BufReader, Write};
use std::net::{TcpListener, TcpStream};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use interplay_building::discretise::Model;
use interplay_scenarios::{BuildingPlant, Scenario, SocketPlantConfig};
use serde_json::{Value, json};

use crate::command::{Outcome, interplay, scratch};
use crate::film::{authored, film};

/// A server for one run; `answer` makes lines of messages, and no line ends the connection.
fn server(answer: impl FnMut(&Value) -> Option<String> + Send + 'static) -> (String, JoinHandle<Vec<Value>>) {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let address = listener.local_addr().expect("an address").to_string();
    (address, thread::spawn(move || serve(&listener, answer)))
}

/// Answers one run; returns what was asked.
fn serve(listener: &TcpListener, mut answer: impl FnMut(&Value) -> Option<String>) -> Vec<Value> {
    let (mut stream, _) = listener.accept().expect("a connection");
    let reader = BufReader::new(stream.try_clone().expect("a second handle"));
    let mut asked = Vec::new();
    for line in reader.lines().map_while(Result::ok) {
        let message: Value = serde_json::from_str(&line).expect("the run sends JSON");
        asked.push(message.clone());
        if message["message"] == "end" {
            break;
        }
        let Some(line) = answer(&message) else { break };
        if write(&mut stream, &line).is_err() {
            break;
        }
    }
    asked
}

fn write(stream: &mut TcpStream, line: &str) -> std::io::Result<()> {
    stream.write_all(format!("{line}\n").as_bytes())
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|number| number.as_f64().expect("a number")).collect()
}

/// A server's answers that are those of the network of a scenario; its walls begin at `walls_c`, or like the zones.
fn own_network(scenario: &Scenario, walls_c: Option<f64>) -> impl FnMut(&Value) -> Option<String> + Send + 'static {
    let building = scenario.building.clone().expect("a building");
    let network = building.network().expect("a network");
    let model = Model::new(&network, building.method, building.step_s).expect("a model");
    let mut nodes_c = vec![building.initial_c; network.node_count()];
    let zones = network.zone_count();
    nodes_c[zones..].fill(walls_c.unwrap_or(building.initial_c));
    move |message: &Value| {
        let answer = if message["message"] == "start" {
            json!({ "message": "ready", "protocol": 1, "temperatures_c": nodes_c[..zones] })
        } else {
            let heat_kw = numbers(&message["heat_kw"]);
            let ambient_c = message["ambient_c"].as_f64().expect("a number");
            model.step(&mut nodes_c, &heat_kw, ambient_c, &numbers(&message["gains_kw"]));
            json!({ "message": "state", "step": message["step"], "temperatures_c": nodes_c[..zones] })
        };
        Some(answer.to_string())
    }
}

/// An authored scenario whose building is behind a socket.
fn behind_socket(name: &str, address: String) -> Scenario {
    let mut scenario = authored(name, &[]);
    if let Some(building) = &mut scenario.building {
        building.plant = BuildingPlant::Socket(SocketPlantConfig { address, timeout_s: 20.0 });
    }
    scenario
}

/// Trajectories of a scenario with its own plant and with the same plant behind a socket. The building has no walls that store
/// heat, so nothing is estimated.
#[test]
fn the_same_network_behind_a_socket_gives_the_same_run() {
    for name in ["building/model-predictive", "building/iterative-model-error", "building/concurrent-uncertain"] {
        let own = authored(name, &[]);
        let (address, served) = server(own_network(&own, None));
        let (own_run, foreign_run) = (film(name, own.clone()), film(name, behind_socket(name, address)));
        let asked = served.join().expect("the server ends");
        let steps = own.days() * own.building.as_ref().map_or(0, |building| building.steps_per_day());
        assert_eq!(asked.len(), steps + 2, "a start, {steps} steps and an end");
        assert_eq!((&asked[0]["message"], &asked[steps + 1]["message"]), (&json!("start"), &json!("end")));
        let (mut count, mut worst_k) = (0, 0.0_f64);
        for (own, foreign) in own_run.frames.iter().zip(&foreign_run.frames) {
            let (Some(own), Some(foreign)) = (&own.building, &foreign.building) else {
                panic!("a building in every frame")
            };
            for (own, foreign) in own.zones.iter().zip(&foreign.zones) {
                worst_k = worst_k.max((own.next_c - foreign.next_c).abs()).max((own.heat_kw - foreign.heat_kw).abs());
                count += 1;
            }
        }
        assert_eq!(count, steps * 4, "{name}");
        assert!(worst_k < 1e-9, "{name}: {worst_k} K or kW");
        let days = &foreign_run.report.building.as_ref().expect("a building").iterations;
        assert!(days.iter().all(|day| day.regret.is_none() && day.day_ahead.is_some()), "{name}");
    }
}

/// The temperatures of walls are not measured. Their estimate starts at rest, which is wrong here by many kelvins, and converges within
/// days: then the model predicts the day to the last digits, since forecast and model are exact.
#[test]
fn estimated_wall_temperatures_converge_to_the_true_ones() {
    let name = "../assets/telemetry/cabin-scenario.toml";
    let keys = ["least_bias", "greatest_bias", "scatter", "shift_h", "meeting_probability", "noise_kw"];
    let changes = keys.map(|key| format!("occupancy.deviation.{key}=0"));
    let own = authored(name, &changes.each_ref().map(String::as_str));
    let (address, served) = server(own_network(&own, Some(30.0)));
    let mut foreign = own.clone();
    foreign.building = behind_socket(name, address).building;
    let days = film(name, foreign).report.building.expect("a building").iterations;
    served.join().expect("the server ends");
    let errors_c: Vec<f64> = days.iter().filter_map(|day| Some(day.day_ahead?.model_rmse_c)).collect();
    assert_eq!(errors_c.len(), 14);
    assert!(errors_c[0] > 0.5 && errors_c[3] < 1e-3 * errors_c[0] && errors_c[13] < 1e-9, "{errors_c:?}");
}

/// A plant receives people, sun and outdoor temperature separately; the gains are their sum, as in the network.
#[test]
fn a_plant_receives_people_sun_and_outdoor_temperature() {
    let name = "building/epw-weather";
    let own = authored(name, &[]);
    let network = own.building.as_ref().and_then(|building| building.network().ok()).expect("a network");
    let (address, served) = server(own_network(&own, None));
    film(name, behind_socket(name, address));
    let asked = served.join().expect("the server ends");
    assert_eq!(asked[0]["zones"].as_array().map(Vec::len), Some(network.zone_count()));
    assert_eq!(
        (&asked[0]["protocol"], &asked[0]["step_s"]),
        (&json!(1), &json!(own.building.as_ref().map(|b| b.step_s)))
    );
    let steps: Vec<&Value> = asked.iter().filter(|message| message["message"] == "step").collect();
    assert!(steps.iter().any(|step| step["sun_w_per_m2"].as_f64() > Some(100.0)), "the sun shines");
    for (number, step) in steps.iter().enumerate() {
        assert_eq!(step["step"], json!(number));
        let sun_kw = network.solar_gains_kw(step["sun_w_per_m2"].as_f64().expect("a number"));
        let parts = numbers(&step["people_kw"]).into_iter().zip(sun_kw).map(|(people, sun)| people + sun);
        assert!(parts.zip(numbers(&step["gains_kw"])).all(|(sum, gain)| (sum - gain).abs() < 1e-12), "step {number}");
    }
}

/// Runs the command against a server.
fn run_against(test: &str, address: &str, timeout_s: f64) -> Outcome {
    let plant = format!("building.plant={{ kind = \"socket\", address = \"{address}\", timeout_s = {timeout_s} }}");
    let arguments = ["run", "building/four-room-pid", "--no-record", "--set", &plant, "--set", "iterations=2"];
    interplay(&scratch(test), &arguments)
}

/// A run that ends with exit code 3, says why, and prints no report.
#[track_caller]
fn unfinished(outcome: &Outcome, pieces: &[&str]) {
    assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(3), ""), "{outcome:?}");
    for piece in pieces {
        assert!(outcome.stderr.contains(piece), "`{piece}` is not said in:\n{}", outcome.stderr);
    }
}

const READY: &str = r#"{"message":"ready","protocol":1,"temperatures_c":[28,28,28,28]}"#;

fn state(message: &Value, temperatures_c: &str) -> String {
    format!(r#"{{"message":"state","step":{},"temperatures_c":{temperatures_c}}}"#, message["step"])
}

/// A server that is sound until a step, and then says something else.
fn spoilt(test: &str, at_step: u64, last: impl Fn(&Value) -> Option<String> + Send + 'static, pieces: &[&str]) {
    let (address, served) = server(move |message| match message["step"].as_u64() {
        None => Some(READY.to_owned()),
        Some(step) if step < at_step => Some(state(message, "[27,27,27,27]")),
        Some(_) => last(message),
    });
    unfinished(&run_against(test, &address, 5.0), pieces);
    served.join().expect("the server ends");
}

#[test]
fn a_plant_with_a_wrong_answer_ends_the_run_with_an_error() {
    let day = "the run ended on day 2";
    let step = "step 53 (step 5 of day 2)";
    spoilt("plant-nan", 53, |message| Some(state(message, "[27,NaN,27,27]")), &[day, step, "NaN"]);
    spoilt("plant-null", 53, |message| Some(state(message, "[27,null,27,27]")), &[day, step, "null"]);
    spoilt(
        "plant-few",
        53,
        |message| Some(state(message, "[27,27,27]")),
        &[day, step, "3 temperatures", "each zone, 4"],
    );
    spoilt(
        "plant-kelvin",
        53,
        |message| Some(state(message, "[300.15,27,27,27]")),
        &[day, step, "300.15", "-100 to 200 °C"],
    );
    spoilt("plant-text", 53, |_| Some("hello".to_owned()), &[day, step, "`hello`"]);
    spoilt("plant-late", 53, |_| Some(state(&json!({ "step": 52 }), "[27,27,27,27]")), &[day, "about step 52"]);
    spoilt("plant-error", 53, |_| Some(r#"{"message":"error","reason":"no gas"}"#.to_owned()), &[day, step, "no gas"]);
    spoilt("plant-closed", 53, |_| None, &[day, step, "closed the connection"]);
    spoilt("plant-long", 53, |_| Some("x".repeat(200_000)), &[day, step, "one line of JSON"]);
    // The last step of a day, after which the controller would learn.
    spoilt("plant-midnight", 47, |_| None, &["the run ended on day 1", "closed the connection"]);
}

#[test]
fn a_plant_that_is_silent_absent_or_of_another_version_is_an_error() {
    // An answer that never ends, a byte now and then: a byte does not begin the time anew.
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let address = listener.local_addr().expect("an address").to_string();
    let dripping = thread::spawn(move || {
        let (mut stream, _) = listener.accept().expect("a connection");
        while stream.write_all(b" ").is_ok() {
            thread::sleep(Duration::from_millis(50));
        }
    });
    let began = Instant::now();
    unfinished(&run_against("plant-drips", &address, 0.5), &["the start of the run", "within 0.5 s"]);
    assert!(began.elapsed() < Duration::from_secs(20), "{:?}", began.elapsed());
    dripping.join().expect("the server ends");

    let (address, served) = server(|message| {
        if message["step"].is_u64() {
            thread::sleep(Duration::from_secs(4));
        }
        Some(READY.to_owned())
    });
    let began = Instant::now();
    unfinished(&run_against("plant-silent", &address, 2.0), &["step 0", "within 2 s", "timeout_s"]);
    assert!(began.elapsed() < Duration::from_secs(20), "{:?}", began.elapsed());
    served.join().expect("the server ends");

    let (address, served) =
        server(|_| Some(r#"{"message":"ready","protocol":7,"temperatures_c":[1,1,1,1]}"#.to_owned()));
    unfinished(&run_against("plant-version", &address, 5.0), &["protocol 7", "speaks 1"]);
    served.join().expect("the server ends");

    // Port 1: another test may listen on a port that was free a moment ago.
    unfinished(&run_against("plant-absent", "127.0.0.1:1", 5.0), &["cannot connect", "127.0.0.1:1"]);
}

#[test]
fn a_wrong_plant_address_is_located_before_any_run() {
    for (address, said) in
        [("localhost", "no port"), ("localhost:99999", "from 1 to 65535"), ("a b:1", "neither a name")]
    {
        let outcome = run_against("plant-address", address, 5.0);
        assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(2), ""), "{outcome:?}");
        assert!(outcome.stderr.contains(said) && outcome.stderr.contains("127.0.0.1:7878"), "{}", outcome.stderr);
    }
    let outcome = run_against("plant-timeout", "localhost:1", 0.0);
    assert_eq!(outcome.code, Some(2), "{outcome:?}");
    assert!(outcome.stderr.contains("timeout_s"), "{}", outcome.stderr);
}
