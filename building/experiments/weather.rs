//! What `tests/peers/sun.py` and `tests/peers/epw_files.py` compare with pvlib: positions of the sun, radiation on planes, and what is
//! read of weather files.
//!
//! `cargo run --release -p interplay-building --example weather -- sun < moments` prints zenith and azimuth \[°\] for each line of latitude,
//! longitude and days since noon (UTC) of the 1st of January 2000. `planes FILE FACING TILT` prints the middle of each row's interval in
//! those days and the radiation on a plane. `read FILE` prints a JSON object: what was read, or why not.

#![allow(clippy::print_stdout, reason = "an example talks to its user")]

use std::io::{BufRead, Write};

use interplay_building::sun::{Plane, Site};
use interplay_building::weather::Epw;
use interplay_building::weather::epw::{EpwUse, Field};
use serde_json::json;

const USED: [Field; 4] = [Field::DryBulb, Field::GlobalHorizontal, Field::DirectNormal, Field::DiffuseHorizontal];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    match words.as_slice() {
        ["sun"] => {
            for line in std::io::stdin().lock().lines() {
                let line = line?;
                let numbers: Vec<f64> = line.split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
                let [latitude_deg, longitude_deg, days] = numbers[..] else {
                    return Err("three numbers a line".into());
                };
                let sun = Site { latitude_deg, longitude_deg, elevation_m: 0.0 }.sun(days);
                writeln!(out, "{} {}", sun.zenith_rad.to_degrees(), sun.azimuth_rad.to_degrees())?;
            }
        }
        ["planes", file, facing, tilt] => {
            let plane = Plane { facing_deg: facing.parse()?, tilt_deg: tilt.parse()?, ground_reflectance: 0.2 };
            let weather = Epw::parse(&text(file)?)?.weather();
            let days = weather.sky.as_ref().map(|sky| sky.utc_days.clone()).ok_or("no radiation")?;
            let on_plane = weather.on_plane_w_per_m2(&plane).ok_or("no radiation")?;
            for (days, value) in days.iter().zip(&on_plane.values) {
                writeln!(out, "{days} {value}")?;
            }
        }
        ["read", file] => writeln!(out, "{}", read(&text(file)?))?,
        _ => return Err("sun, planes FILE FACING TILT, or read FILE".into()),
    }
    Ok(())
}

fn text(file: &str) -> std::io::Result<String> {
    Ok(String::from_utf8_lossy(&std::fs::read(file)?).into_owned())
}

/// What a file says of its whole period, or why it is refused.
fn read(text: &str) -> serde_json::Value {
    let epw = match Epw::parse(text) {
        Ok(epw) => epw,
        Err(error) => return json!({ "refused": error.to_string() }),
    };
    let to_s = epw.rows() as f64 * epw.interval_s;
    let usage = EpwUse { fields: &USED, from_s: 0.0, to_s, bridge_gaps_h: 6.0 };
    let (used, remarks) = match epw.check_use(&usage) {
        Ok(remarks) => (None, remarks.iter().map(|remark| format!("line {}: {}", remark.line, remark.text)).collect()),
        Err(error) => (Some(error.to_string()), Vec::new()),
    };
    // A run in February, which does not mind the other months.
    let month_s = |month: u32| epw.midnight_s(month, 1).unwrap_or(0.0);
    let february = epw.check_use(&EpwUse { from_s: month_s(2), to_s: month_s(3), ..usage });
    let february = february.map_or_else(|error| error.to_string(), |remarks| format!("{} remarks", remarks.len()));
    let weather = epw.weather();
    json!({
        "city": epw.location.city,
        "latitude_deg": epw.location.latitude_deg,
        "time_zone_h": epw.location.time_zone_h,
        "rows": epw.rows(),
        "leap": epw.is_leap(),
        "mean_c": weather.ambient_c.mean(),
        "sun_kwh_per_m2": weather.sun_w_per_m2.mean() * to_s / 3.6e6,
        "refused_in_use": used,
        "february": february,
        "remarks": remarks,
    })
}
