//! Model exchange against a closed form: the unit `units/unit.c`, compiled here, runs in a process of its own.
//!
//! This program has no test harness, since it is also that process.
#![allow(clippy::print_stdout, reason = "it says what it skips")]

mod units;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;
use std::{env, fs};

use interplay_fmu_host::{Host, HostError, HostProgram, Request, Unit, serve};

const SECONDS: Duration = Duration::from_secs(60);
const STEP_S: f64 = 300.0;
/// Steps until the power is changed, and in all.
const FIRST: usize = 24;
const STEPS: usize = 48;
/// References of the unit's variables.
const STATES_ON_SEEN: [u32; 6] = [0, 1, 2, 3, 4, 5];
const POWER: u32 = 6;
/// Largest difference from the closed form, with a relative tolerance of 1e-9.
const MAX_DIFFERENCE: f64 = 1e-6;

fn main() {
    if let [library, guid, resources, exchange] = &env::args().skip(1).collect::<Vec<_>>()[..] {
        return serve(Path::new(library), guid, resources, Some(exchange)).expect("served");
    }
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) || Command::new("cc").arg("--version").output().is_err()
    {
        return println!("skipped: no C compiler `cc` was found, or this is not Linux on x86-64");
    }
    for prefixed in [false, true] {
        the_closed_form_is_met(&built(prefixed));
    }
    a_ball_bounces_at_its_times(&built(false));
    crashes_and_hangs_are_errors(&built(false));
    println!("model exchange: all passed");
}

struct Built {
    _folder: tempfile::TempDir,
    unit: Unit,
}

/// Compiles the unit; with `prefixed` its functions have the name of the model before their own.
fn built(prefixed: bool) -> Built {
    let folder = tempfile::tempdir().expect("a folder");
    let source = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/units/unit.c");
    let library = folder.path().join("unit.so");
    let flags = if prefixed { &["-DPREFIX"][..] } else { &[] };
    let arguments = ["-O2", "-shared", "-fPIC"];
    let compiled = Command::new("cc").args(arguments).args(flags).arg(source).arg("-o").arg(&library).status();
    assert!(compiled.expect("cc runs").success());
    let library = fs::read(library).expect("a library");
    let description = include_str!("units/unit.xml");
    let files = [("modelDescription.xml", description.as_bytes()), ("binaries/linux64/unit.so", &library)];
    Built { unit: units::unit(folder.path(), &files).expect("a unit"), _folder: folder }
}

fn started(built: &Built, timeout: Duration) -> Host {
    let program = HostProgram { program: env::current_exe().expect("a program").into(), arguments: Vec::new() };
    Host::start(&program, &built.unit, timeout).expect("it starts")
}

fn steps(from_s: f64, step_s: f64, count: usize) -> Request {
    Request::Steps { from_s, step_s, count, reals: STATES_ON_SEEN.to_vec(), booleans: Vec::new() }
}

fn set_power(kw: f64) -> Request {
    Request::Set { reals: vec![(POWER, kw)], booleans: Vec::new() }
}

/// A room with a thermostat, whose temperature between two events is an exponential.
struct Room {
    time_s: f64,
    temperature_c: f64,
    is_on: bool,
    power_kw: f64,
    low_c: f64,
    high_c: f64,
    /// Where the temperature went until now; an event at this time has changed that, but not yet the sensor.
    towards_c: f64,
}

impl Room {
    const GAIN: f64 = 0.1;
    const TIME_S: f64 = 1000.0 / Self::GAIN;

    fn settled_c(&self) -> f64 {
        5.0 + if self.is_on { self.power_kw / Self::GAIN } else { 0.0 }
    }

    fn switch(&mut self) {
        if self.is_on && self.temperature_c >= self.high_c {
            self.is_on = false;
        } else if !self.is_on && self.temperature_c <= self.low_c {
            self.is_on = true;
        }
    }

    fn advance(&mut self, end_s: f64) {
        while self.time_s < end_s {
            let (settled_c, wanted_c) = (self.settled_c(), if self.is_on { self.high_c } else { self.low_c });
            let share = (wanted_c - settled_c) / (self.temperature_c - settled_c);
            let switched_s = if share > 0.0 { self.time_s - Self::TIME_S * share.ln() } else { f64::INFINITY };
            let raised_s = if self.low_c < 20.0 { 3600.0 } else { f64::INFINITY };
            let next_s = switched_s.min(raised_s).min(end_s);
            self.towards_c = settled_c;
            let left = (-(next_s - self.time_s) / Self::TIME_S).exp();
            self.temperature_c = settled_c + (self.temperature_c - settled_c) * left;
            self.time_s = next_s;
            if next_s == raised_s {
                (self.low_c, self.high_c) = (self.low_c + 2.0, self.high_c + 2.0);
            }
            if next_s == switched_s {
                self.temperature_c = wanted_c;
            }
            self.switch();
        }
    }

    /// The sensor follows within a hundredth of a second.
    fn sensor_c(&self) -> f64 {
        self.towards_c + (self.temperature_c - self.towards_c) * Self::TIME_S / (Self::TIME_S - 0.01)
    }
}

fn the_closed_form_is_met(built: &Built) {
    let mut host = started(built, SECONDS);
    for round in 0..2 {
        if round == 1 {
            host.ask(&Request::Reset).expect("reset");
        }
        host.ask(&Request::Initialize { start_s: 0.0 }).expect("initialised");
        let mut rows = host.ask(&steps(0.0, STEP_S, FIRST)).expect("steps").rows;
        host.ask(&set_power(3.0)).expect("set");
        rows.extend(host.ask(&steps(FIRST as f64 * STEP_S, STEP_S, STEPS - FIRST)).expect("steps").rows);
        let (is_on, power_kw, low_c, high_c) = (true, 2.0, 19.0, 20.0);
        let mut room = Room { time_s: 0.0, temperature_c: 18.0, is_on, power_kw, low_c, high_c, towards_c: 0.0 };
        for (step, row) in rows.iter().enumerate() {
            room.advance((step + 1) as f64 * STEP_S);
            let right = [room.temperature_c, room.sensor_c(), 0.0, 0.0, f64::from(u8::from(room.is_on)), 1.0];
            for (found, right) in row.iter().zip(right) {
                let found = found.expect("a number");
                assert!((found - right).abs() < MAX_DIFFERENCE, "after {} s: {found} for {right}", room.time_s);
            }
            if step + 1 == FIRST {
                room.power_kw = 3.0;
            }
        }
    }
    host.ask(&Request::End).expect("ended");
}

fn a_ball_bounces_at_its_times(built: &Built) {
    let mut host = started(built, SECONDS);
    host.ask(&Request::Initialize { start_s: 0.0 }).expect("initialised");
    let rows = host.ask(&steps(0.0, 0.01, 200)).expect("steps").rows;
    let (mut began_s, mut height, mut speed) = (0.0, 1.0, 0.0);
    for (step, row) in rows.iter().enumerate() {
        let time_s = 0.01 * (step + 1) as f64;
        let down_s = |height: f64, speed: f64| (speed + (speed * speed + 2.0 * 9.81 * height).sqrt()) / 9.81;
        while began_s + down_s(height, speed) <= time_s {
            let flight_s = down_s(height, speed);
            (began_s, height, speed) = (began_s + flight_s, 0.0, 0.7 * (9.81 * flight_s - speed));
        }
        let flown_s = time_s - began_s;
        let right = height + speed * flown_s - 0.5 * 9.81 * flown_s * flown_s;
        let found = row[2].expect("a number");
        assert!((found - right).abs() < MAX_DIFFERENCE, "after {time_s} s: {found} for {right}");
    }
}

fn crashes_and_hangs_are_errors(built: &Built) {
    for (power, timeout) in [(-1.0, SECONDS), (-2.0, Duration::from_secs(2))] {
        let mut host = started(built, timeout);
        host.ask(&Request::Initialize { start_s: 0.0 }).expect("initialised");
        let asked = host.ask(&set_power(power)).and_then(|_| host.ask(&steps(0.0, STEP_S, 1)));
        let error = asked.map(|_| ()).expect_err("it does not answer");
        let is_right = match power {
            -1.0 => matches!(&error, HostError::Crashed { how, .. } if how == "signal 11"),
            _ => matches!(&error, HostError::Timeout { .. }),
        };
        assert!(is_right, "{error}");
    }
    let files =
        [("modelDescription.xml", include_str!("units/unit.xml").as_bytes()), ("binaries/linux64/unit.so", b"x")];
    let folder = tempfile::tempdir().expect("a folder");
    let unit = units::unit(folder.path(), &files).expect("a unit");
    let program = HostProgram { program: env::current_exe().expect("a program").into(), arguments: Vec::new() };
    let error = Host::start(&program, &unit, SECONDS).map(|_| ()).expect_err("no library");
    assert!(error.to_string().contains("its library cannot be loaded"), "{error}");
}
