//! The server with pages that are invalid, slow, gone, or from another site.

mod pages;
mod study;

use std::path::Path;
use std::time::{Duration, Instant};

use interplay_scenarios::load;
use interplay_simulation::run::run;
use serde_json::json;
use tungstenite::Message;

use self::pages::Served;

fn files(folder: &Path) -> usize {
    std::fs::read_dir(folder).map_or(0, Iterator::count)
}

fn wait_for(what: &str, is_so: impl Fn() -> bool) {
    let began = Instant::now();
    while !is_so() {
        assert!(began.elapsed() < Duration::from_secs(20), "{what}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn only_paths_with_the_token_are_served() {
    let folder = tempfile::tempdir().expect("a folder");
    let served = Served::start(folder.path());
    let (host, token) = (format!("Host: {}\r\n", served.address), served.token().to_owned());
    assert_eq!(served.status(&format!("/{token}/"), &host), 200);
    assert_eq!(served.status(&format!("/{token}/page.js"), &host), 200);
    for path in ["/", "/0123456789abcdef0123456789abcdef/", &format!("/{token}x/"), &format!("/{token}/../{token}/")] {
        assert_eq!(served.status(path, &host), 404, "{path}");
    }
    assert_eq!(served.status(&format!("/{token}/"), "Host: evil.example\r\n"), 403);
    assert_eq!(served.status(&format!("/{token}/"), &format!("{host}Origin: http://evil.example\r\n")), 403);
    assert!(served.page("", "http://evil.example").is_none());
    assert!(served.address.ip().is_loopback());
    served.end();
}

#[test]
fn the_played_run_is_saved_when_the_page_is_gone_and_is_deterministic() {
    let folder = tempfile::tempdir().expect("a folder");
    let served = Served::start(folder.path());
    let mut page = served.own_page();
    assert_eq!(page.hear("world")["seat"], "ego");
    let mut other = served.page("?seat=rear", &format!("http://{}", served.address)).expect("a second page");
    assert_eq!(other.hear("world")["seat"], "rear");
    page.drive();
    while page.hear("frame")["tick"].as_u64().unwrap_or_default() < 8 {}
    other.say(&json!({ "type": "input", "acceleration": -0.5, "steering": 0.0 }));
    page.say(&json!({ "type": "hand_over", "to": "negotiation" }));
    while page.hear("frame")["driven_by"] != "negotiation" {}
    drop(page);
    drop(other);
    wait_for("the played run is saved", || files(folder.path()) == 1);
    served.end();
    let path = folder.path().join("lane-change-front-nice-1.toml");
    let scenario = load(&path.to_string_lossy(), &[]).expect("the played run is a scenario");
    let twice = [1, 2].map(|_| run("played", &scenario, Vec::new()).expect("a run").digest);
    assert_eq!(twice[0], twice[1]);
    assert!(scenario.vehicles.iter().filter(|vehicle| vehicle.driver.kind() == "inputs").count() == 2);
}

#[test]
fn garbage_is_refused_and_does_not_disturb_other_pages() {
    let folder = tempfile::tempdir().expect("a folder");
    let served = Served::start(folder.path());
    let mut page = served.own_page();
    page.hear("world");
    let mut state = 1_u64;
    // Ten thousand messages; fewer at a time than the queue of a page holds.
    for round in 0..100 {
        for _ in 0..100 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let letter = |at: u64| char::from(32 + ((state >> (at % 32)) % 95) as u8);
            let garbage: String = (0..state % 60).map(letter).collect();
            page.0.write(Message::text(garbage)).expect("the server reads");
        }
        page.0.flush().expect("the server reads");
        page.say(&json!({ "type": "echo", "at": f64::from(round) }));
        assert_eq!(page.hear("echo")["at"], f64::from(round));
    }
    for wrong in [
        json!({ "type": "start", "scenario": "nowhere", "seat": "ego" }),
        json!({ "type": "seat", "seat": "stranger" }),
    ] {
        page.say(&wrong);
    }
    page.hear("refused");
    let mut huge = served.own_page();
    let _ = huge.0.send(Message::text("x".repeat(100_000)));
    let mut bytes = served.own_page();
    let _ = bytes.0.send(Message::binary(vec![0_u8; 64]));
    page.say(&json!({ "type": "start", "scenario": "lane-change/front-nice", "seat": "front" }));
    assert_eq!(page.hear("world")["seat"], "front");
    served.end();
}

/// A page that reads nothing does not delay other pages.
#[test]
fn the_server_does_not_wait_for_a_slow_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let served = Served::start(folder.path());
    let mut slow = served.own_page();
    let mut page = served.own_page();
    page.hear("world");
    slow.drive();
    page.say(&json!({ "type": "rate", "ratio": 16.0 }));
    page.drive();
    let score = page.hear("score");
    assert_eq!(score["you"]["name"], "you");
    wait_for("the run is saved", || files(folder.path()) == 1);
    served.end();
}
