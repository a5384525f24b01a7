//! How the time to design a day grows with the number of rooms, as a table and as a picture.
//!
//! ```sh
//! cargo run --release -p interplay-building --example growth [OUT.svg]
//! ```
//!
//! Times are processor times of the whole design of a day that follows one day of experience, feedback included: what it
//! takes on one core that has nothing else to do. They are averages of as many repetitions as fit into a second.

#![allow(clippy::print_stdout, reason = "an example talks to its user")]

#[path = "../benches/case/mod.rs"]
mod case;

use std::fmt::Write;
use std::{env, fs, hint};

use case::Case;
use interplay_building::control::Controller;

/// Processor time for which a design is repeated \[s\].
const ENOUGH_S: f64 = 1.0;
/// The kernel counts processor time in hundredths of a second.
const TICKS_PER_S: f64 = 100.0;
/// Width, height and margin of the picture.
const WIDTH: f64 = 800.0;
const HEIGHT: f64 = 480.0;
const MARGIN: f64 = 70.0;
/// The decades of rooms and of seconds that it shows.
const ROOMS: [f64; 2] = [0.5, 2.9];
const SECONDS: [f64; 2] = [-3.0, 2.5];

struct Curve {
    name: &'static str,
    colour: &'static str,
    /// Rooms and seconds.
    points: Vec<(usize, f64)>,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let grids = [(2, 2), (3, 3), (4, 4), (5, 5), (7, 7), (10, 10), (14, 14), (20, 20)];
    let designs = [
        ("iterative", "#0072b2", Controller::Iterative(Default::default()), 3),
        ("concurrent", "#cc79a7", Controller::Concurrent(Default::default()), 3),
        ("distributed", "#d55e00", Controller::Distributed(Default::default()), grids.len()),
        ("centralised, sparse", "#009e73", Controller::Centralised(Default::default()), grids.len()),
    ];
    let mut curves = Vec::new();
    for (name, colour, controller, count) in designs {
        let mut points = Vec::new();
        for &(rows, columns) in &grids[..count] {
            let seconds = seconds(&Case::new(controller.clone(), rows, columns))?;
            println!("{name:20} {:4} rooms  {seconds:9.4} s", rows * columns);
            points.push((rows * columns, seconds));
        }
        curves.push(Curve { name, colour, points });
    }
    println!("largest memory {:.0} MB", status_kb("VmHWM:")? / 1024.0);
    if let Some(path) = env::args().nth(1) {
        fs::write(path, picture(&curves)?)?;
    }
    Ok(())
}

/// Processor time of a day-ahead design \[s\].
fn seconds(case: &Case) -> Result<f64, Box<dyn std::error::Error>> {
    let began = processor_s()?;
    let mut count = 0.0;
    loop {
        hint::black_box(case.plan_day_ahead(&mut *case.controller.fork().expect("ours can be copied")));
        count += 1.0;
        let passed = processor_s()? - began;
        if passed >= ENOUGH_S {
            return Ok(passed / count);
        }
    }
}

/// Processor time of this process so far, by all its threads, as Linux counts it \[s\].
fn processor_s() -> Result<f64, Box<dyn std::error::Error>> {
    let text = fs::read_to_string("/proc/self/stat")?;
    // The name in brackets may have spaces; user time is the 12th number after it.
    let after = text.rsplit(')').next().unwrap_or_default();
    let ticks: f64 = after.split_whitespace().nth(11).ok_or("no user time")?.parse()?;
    Ok(ticks / TICKS_PER_S)
}

/// A line of the process's status in kB.
fn status_kb(key: &str) -> Result<f64, Box<dyn std::error::Error>> {
    let text = fs::read_to_string("/proc/self/status")?;
    let line = text.lines().find_map(|line| line.strip_prefix(key)).ok_or("no such line")?;
    Ok(line.trim().trim_end_matches(" kB").parse()?)
}

/// The place of a number of rooms from the left, by decades.
fn across(rooms: f64) -> f64 {
    MARGIN + (rooms.log10() - ROOMS[0]) / (ROOMS[1] - ROOMS[0]) * (WIDTH - 2.0 * MARGIN)
}

/// The place of a time from above, by decades.
fn down(seconds: f64) -> f64 {
    HEIGHT - MARGIN - (seconds.log10() - SECONDS[0]) / (SECONDS[1] - SECONDS[0]) * (HEIGHT - 2.0 * MARGIN)
}

fn picture(curves: &[Curve]) -> Result<String, std::fmt::Error> {
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" font-family=\"sans-serif\" \
         font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    axes(&mut svg)?;
    source(&mut svg)?;
    for Curve { name, colour, points } in curves {
        let places: Vec<(f64, f64)> = points.iter().map(|&(n, seconds)| (across(n as f64), down(seconds))).collect();
        let line: Vec<String> = places.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
        let line = line.join(" ");
        writeln!(svg, "<polyline points=\"{line}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>")?;
        for (x, y) in &places {
            writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{colour}\"/>")?;
        }
        if let Some((x, y)) = places.last() {
            let (x, y) = (x + 8.0, y + 14.0);
            writeln!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\" fill=\"{colour}\" text-anchor=\"start\">{name}</text>")?;
        }
    }
    svg.push_str("</svg>\n");
    Ok(svg)
}

fn axes(svg: &mut String) -> std::fmt::Result {
    let (left, right, bottom) = (MARGIN, WIDTH - MARGIN, HEIGHT - MARGIN + 20.0);
    for seconds in [0.001, 0.01, 0.1, 1.0, 10.0, 100.0] {
        let y = down(seconds);
        writeln!(svg, "<path d=\"M{left} {y:.1}H{right}\" stroke=\"#ddd\"/>")?;
        writeln!(svg, "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{seconds} s</text>", left - 6.0, y + 4.0)?;
    }
    for rooms in [4.0, 9.0, 16.0, 25.0, 49.0, 100.0, 196.0, 400.0] {
        writeln!(svg, "<text x=\"{:.1}\" y=\"{bottom}\" text-anchor=\"middle\">{rooms}</text>", across(rooms))?;
    }
    let middle = WIDTH / 2.0;
    writeln!(svg, "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">rooms</text>", HEIGHT - 20.0)?;
    writeln!(svg, "<text x=\"{left}\" y=\"30\" font-size=\"15\">Processor time to design a day of 48 steps</text>")
}

/// What the dissertation says of its own four rooms.
fn source(svg: &mut String) -> std::fmt::Result {
    let x = across(4.0);
    for (name, seconds, lower) in [
        ("source, chapter 3", 120.0, 4.0),
        ("source, chapter 5, centralised", 10.21, -2.0),
        ("source, chapter 5, distributed", 8.03, 12.0),
    ] {
        let y = down(seconds);
        writeln!(svg, "<path d=\"M{:.1} {y:.1}h8m-4 -4v8\" stroke=\"black\"/>", x - 4.0)?;
        writeln!(svg, "<text x=\"{:.1}\" y=\"{:.1}\" fill=\"#444\">{name}</text>", x + 8.0, y + lower)?;
    }
    Ok(())
}
