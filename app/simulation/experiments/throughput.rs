//! Simulation speed: by family, by number of vehicles, and by number of zones.
//!
//! ```sh
//! cargo run --release -p interplay-simulation --example throughput -- [families] [vehicles] [motorway] [zones] [only NAME...] [subscribed FILE]
//! ```
//!
//! prints a Markdown table for each word (all four without any). `only` times the authored scenarios of these names. `subscribed FILE`
//! steps the world of a file that measures contacts, progress and the digest of the states alone, and prints that digest. Times are
//! processor times of this process, which other programs on the machine disturb less than wall times; a world runs on one thread.
//! Each figure is the shortest of [`BATCHES`] means over as many runs as take [`BATCH_S`].

#![allow(clippy::print_stdout, reason = "the tables are the result")]

use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::time::Instant;

use interplay_scenarios::{Override, Scenario, embedded, from_text, load};
use interplay_simulation::Simulation;
use interplay_simulation::measure::Subscriptions;
use interplay_simulation::run::run;

/// Number of batches of the same runs.
const BATCHES: usize = 3;
/// Minimum duration of a batch \[s\].
const BATCH_S: f64 = 0.5;
/// Unit of processor time in the kernel (`USER_HZ` of Linux).
const CLOCK_TICKS_PER_S: f64 = 100.0;
const VEHICLES: [usize; 5] = [2, 4, 8, 16, 32];
/// Numbers of vehicles on a motorway.
const ON_MOTORWAY: [usize; 9] = [5, 10, 20, 40, 80, 100, 160, 320, 1000];
/// Drivers of the vehicles, with conduct, and the maximum number of vehicles.
const MOTORISTS: [(&str, &str, &str, usize); 3] = [
    ("IDM", "idm", "", 1000),
    ("human of the dissertation", "human", "conduct = 'source'", 160),
    ("human of people", "human", "", 100),
];
/// Rows and columns of grids of zones.
const GRIDS: [[usize; 2]; 8] = [[1, 2], [2, 2], [2, 4], [4, 4], [4, 8], [8, 8], [8, 16], [16, 16]];
/// Duration of a drive \[s\].
const DRIVE_S: f64 = 10.0;
/// Number of days of a building.
const DAYS: usize = 4;
/// Spacing of vehicles in a lane \[m\], at 1/10 scale.
const SPACING_M: f64 = 2.0;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if let [word, path] = words.as_slice()
        && word == "subscribed"
    {
        return subscribed(path);
    }
    let is_asked = |word: &str| {
        words.is_empty() || words.first().is_some_and(|first| first != "only") && words.iter().any(|one| one == word)
    };
    if is_asked("families") {
        families()?;
    }
    if is_asked("vehicles") {
        vehicles()?;
    }
    if is_asked("motorway") {
        motorway()?;
    }
    if is_asked("zones") {
        zones()?;
    }
    if let Some((_, names)) = words.split_first().filter(|(first, _)| *first == "only") {
        println!("| scenario | ms a world | simulated s | times real time |\n|---|---|---|---|");
        for name in names {
            let scenario = load(name, &[Override::Set("counterfactual=[]".to_owned())])?;
            let speed = Speed::measure(&scenario)?;
            println!(
                "| {name} | {:.1} | {} | {:.0} |",
                1e3 * speed.processor_s,
                speed.simulated_s,
                speed.real_time_factor()
            );
        }
    }
    Ok(())
}

/// Steps the world of a file that measures nothing but contacts, progress and the digest of the states.
fn subscribed(path: &str) -> Result<(), Box<dyn Error>> {
    let scenario = from_text(path, &fs::read_to_string(path)?, &[])?;
    let builder = Simulation::builder(&scenario).subscribed_to(Subscriptions::only(&[], &[]));
    let mut simulation = builder.build()?;
    while simulation.step()?.is_some() {}
    let report = simulation.finish()?;
    println!("{} {} contacts", report.digest, report.collisions.len());
    Ok(())
}

/// The time that a world takes.
#[derive(Clone, Copy)]
struct Speed {
    /// Processor time of one run \[s\].
    processor_s: f64,
    /// Simulated time of one run \[s\].
    simulated_s: f64,
}

impl Speed {
    fn measure(scenario: &Scenario) -> Result<Speed, Box<dyn Error>> {
        let mut best = Speed { processor_s: f64::INFINITY, simulated_s: 0.0 };
        for _ in 0..BATCHES {
            let (began_s, mut runs) = (processor_s()?, 0);
            loop {
                best.simulated_s = run("timed", scenario, Vec::new())?.simulated_s;
                runs += 1;
                let taken_s = processor_s()? - began_s;
                if taken_s >= BATCH_S {
                    best.processor_s = best.processor_s.min(taken_s / f64::from(runs));
                    break;
                }
            }
        }
        Ok(best)
    }

    fn real_time_factor(self) -> f64 {
        self.simulated_s / self.processor_s
    }
}

/// Processor time of this process so far \[s\]; wall time on systems that do not report it.
fn processor_s() -> Result<f64, Box<dyn Error>> {
    static BEGAN: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    let Ok(stat) = fs::read_to_string("/proc/self/stat") else {
        return Ok(BEGAN.get_or_init(Instant::now).elapsed().as_secs_f64());
    };
    // The program's name, in brackets, may contain spaces. Of the fields after it, user and system time are the 12th and 13th.
    let after = stat.rsplit_once(')').ok_or("a strange /proc/self/stat")?.1;
    let times = after.split_whitespace().skip(11).take(2).map(str::parse::<f64>).collect::<Result<Vec<f64>, _>>()?;
    Ok(times.iter().sum::<f64>() / CLOCK_TICKS_PER_S)
}

/// Prints a line for each family of authored scenarios.
fn families() -> Result<(), Box<dyn Error>> {
    let mut names: Vec<&str> = embedded().iter().filter_map(|file| file.name.split('/').next()).collect();
    names.dedup();
    println!(
        "| family | scenarios | worlds a second | times real time, slowest scenario | the slowest |\n|---|---|---|---|---|"
    );
    for family in names {
        let mut speeds = Vec::new();
        for file in embedded().iter().filter(|file| file.name.split('/').next() == Some(family)) {
            let scenario = load(file.name, &[Override::Set("counterfactual=[]".to_owned())])?;
            speeds.push((Speed::measure(&scenario)?, file.name));
        }
        let all_s: f64 = speeds.iter().map(|(speed, _)| speed.processor_s).sum();
        let slowest = speeds.iter().min_by(|a, b| a.0.real_time_factor().total_cmp(&b.0.real_time_factor()));
        let Some((slowest, name)) = slowest else { continue };
        println!(
            "| `{family}` | {} | {:.1} | {:.0} | `{name}` |",
            speeds.len(),
            speeds.len() as f64 / all_s,
            slowest.real_time_factor()
        );
    }
    println!();
    Ok(())
}

/// Prints a line for each number of vehicles on a straight road with two lanes.
fn vehicles() -> Result<(), Box<dyn Error>> {
    println!(
        "| vehicles | IDM: times real time | of that with 2 | human: times real time | of that with 2 |\n|---|---|---|---|---|"
    );
    let mut first = None;
    for count in VEHICLES {
        let speed = |driver: &str| -> Result<f64, Box<dyn Error>> {
            let scenario = from_text("straight road", &straight_road(count, driver), &[])?;
            Ok(Speed::measure(&scenario)?.real_time_factor())
        };
        let [idm, human] = [speed("{ kind = 'idm' }")?, speed("{ kind = 'human', style = 'normal' }")?];
        let [idm_of_two, human_of_two] = *first.get_or_insert([idm, human]);
        println!("| {count} | {idm:.0} | {:.3} | {human:.1} | {:.3} |", idm / idm_of_two, human / human_of_two);
    }
    println!();
    Ok(())
}

/// A scenario with vehicles at different speeds on two lanes of a straight road.
fn straight_road(count: usize, driver: &str) -> String {
    let mut text = format!(
        "title = 'Straight road'\nshows = 'Vehicles one behind another'\nduration_s = {DRIVE_S:?}\nstep_s = 0.1\nhorizon_steps = 30\nroad = {{ kind = 'lanes', lane_count = 2, lane_width_m = 0.37 }}\n"
    );
    for index in 0..count {
        let (lane, place) = (index % 2, index / 2);
        let (x_m, y_m) = (-SPACING_M * place as f64, 0.185 + 0.37 * lane as f64);
        // The vehicles behind drive slightly faster.
        let speed_mps = 1.1 + 0.02 * (place % 5) as f64;
        let _ = write!(
            text,
            "[[vehicle]]\nname = 'car-{index}'\nstart = {{ x_m = {x_m:?}, y_m = {y_m:?}, speed_mps = {speed_mps:?} }}\n\
             goal = {{ lane = {lane}, speed_mps = {speed_mps:?} }}\ndriver = {driver}\n"
        );
    }
    text
}

/// Prints a line for each number of cars at 25 m/s on a motorway of three lanes, 40 m apart in each lane.
fn motorway() -> Result<(), Box<dyn Error>> {
    println!("| drivers | vehicles | times real time | for twice as many |\n|---|---|---|---|");
    for (name, kind, conduct, most) in MOTORISTS {
        let mut last: Option<(usize, f64)> = None;
        for count in ON_MOTORWAY.into_iter().filter(|count| *count <= most) {
            let scenario = from_text("motorway", &three_lanes(count, kind, conduct), &[])?;
            let factor = Speed::measure(&scenario)?.real_time_factor();
            // Growth factor for each doubling of the number of vehicles.
            let growth = last.map(|(fewer, before)| {
                (before / factor).powf(std::f64::consts::LN_2 / (count as f64 / fewer as f64).ln())
            });
            let growth = growth.map_or_else(String::new, |growth| format!("{growth:.2}"));
            println!("| {name} | {count} | {factor:.1} | {growth} |");
            last = Some((count, factor));
        }
    }
    println!();
    Ok(())
}

/// A motorway of three lanes with cars at about 25 m/s.
fn three_lanes(count: usize, kind: &str, conduct: &str) -> String {
    let mut text = format!(
        "title = 'Motorway'\nshows = 'Three lanes'\nscale = 'full'\n{conduct}\nduration_s = 20.0\n\
         budget = {{ plans = 1000000000, steps = 100000000000 }}\n\
         road = {{ kind = 'lanes', lane_count = 3, lane_width_m = 3.5 }}\n\
         defaults = {{ class = 'car', driver = {{ kind = '{kind}' }} }}\n"
    );
    for index in 0..count {
        let (lane, place) = (index % 3, index / 3);
        let along_m = -40.0 * place as f64 - 13.0 * lane as f64;
        let speed_mps = 25.0 + 0.8 * ((index * 7) % 5) as f64 - 1.6;
        let _ = write!(
            text,
            "[[vehicle]]\nname = 'car-{index}'\nstart = {{ lane = {lane}, along_m = {along_m:?}, speed_mps = {speed_mps:?} }}\n\
             goal = {{ lane = {lane}, speed_mps = {speed_mps:?} }}\n"
        );
    }
    text
}

/// Prints a line for each number of zones.
fn zones() -> Result<(), Box<dyn Error>> {
    const CONTROLLERS: [&str; 3] = ["building/four-room-pid", "building/hundred-zones", "building/distributed-hundred"];
    println!(
        "| zones | PID: days a second | of that with 2 | iterative learning | of that with 2 | distributed | of that with 2 |"
    );
    println!("|---|---|---|---|---|---|---|");
    let mut first: Option<Vec<f64>> = None;
    for [rows, columns] in GRIDS {
        let mut days_per_s = Vec::new();
        for name in CONTROLLERS {
            let changes = [
                format!("building.grid={{ rows = {rows}, columns = {columns} }}"),
                format!("iterations={DAYS}"),
                "expect={}".to_owned(),
                "counterfactual=[]".to_owned(),
                "setpoints.occupied_c=[23.0]".to_owned(),
            ];
            let scenario = load(name, &changes.map(Override::Set))?;
            days_per_s.push(DAYS as f64 / Speed::measure(&scenario)?.processor_s);
        }
        let of_two = first.get_or_insert_with(|| days_per_s.clone());
        let cells: Vec<String> =
            days_per_s.iter().zip(of_two.iter()).map(|(now, two)| format!("{now:.1} | {:.4}", now / two)).collect();
        println!("| {} | {} |", rows * columns, cells.join(" | "));
    }
    Ok(())
}
