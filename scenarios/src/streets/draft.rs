//! A scenario file under construction.

use std::fmt::Write;

use interplay_common::random::Random;

/// Drivers of the other vehicles: people of all styles, and occasionally an IDM driver.
const DRIVERS: [&str; 6] = [
    "{ kind = \"human\", style = \"nice\" }",
    "{ kind = \"human\", style = \"considerate\" }",
    "{ kind = \"human\", style = \"normal\" }",
    "{ kind = \"human\", style = \"assertive\" }",
    "{ kind = \"human\", style = \"tough\" }",
    "{ kind = \"idm\" }",
];

/// A driver that keeps its speed, or stands.
pub(super) const SCRIPTED: &str = "{ kind = \"scripted\" }";

pub(super) struct Draftee<'a> {
    pub name: &'a str,
    pub class: &'a str,
    pub lane: &'a str,
    pub along_m: f64,
    pub speed_mps: f64,
    /// The lane to which it drives; `None` if its route is unique.
    pub to: Option<&'a str>,
    pub wanted_mps: f64,
    /// Its driver; `None` draws one of all kinds.
    pub driver: Option<String>,
}

/// A scenario file under construction, and the random numbers for it.
pub(super) struct Draft {
    random: Random,
    road: String,
    vehicles: String,
    pub duration_s: f64,
}

impl Draft {
    pub fn new(seed: u64, stream: u64) -> Draft {
        let random = Random::new(seed, stream);
        Draft { random, road: String::new(), vehicles: String::new(), duration_s: 40.0 }
    }

    /// A random number between two bounds, rounded to tenths, as a person would write it.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        (10.0 * self.random.uniform(low, high)).round() / 10.0
    }

    /// A random whole number between two bounds, both included.
    pub fn count(&mut self, low: usize, high: usize) -> usize {
        let drawn = self.random.uniform(low as f64, high as f64 + 1.0) as usize;
        drawn.clamp(low, high)
    }

    pub fn chance(&mut self, probability: f64) -> bool {
        self.random.chance(probability)
    }

    /// A random word of these.
    pub fn one_of<'a>(&mut self, words: &[&'a str]) -> &'a str {
        words[self.count(0, words.len() - 1)]
    }

    /// Adds lines about the road.
    pub fn road(&mut self, lines: &str) {
        self.road.push_str(lines);
        self.road.push('\n');
    }

    /// Adds a vehicle.
    pub fn vehicle(&mut self, vehicle: Draftee<'_>) {
        let Draftee { name, class, lane, along_m, speed_mps, to, wanted_mps, driver } = vehicle;
        let driver = driver.unwrap_or_else(|| self.one_of(&DRIVERS).to_owned());
        let to = to.map(|lane| format!("lane = \"{lane}\", ")).unwrap_or_default();
        // Writing to a text cannot fail.
        let _ = write!(
            self.vehicles,
            "\n[[vehicle]]\nname = \"{name}\"\nclass = \"{class}\"\n\
             start = {{ lane = \"{lane}\", along_m = {along_m:.1}, speed_mps = {speed_mps:.1} }}\n\
             goal = {{ {to}speed_mps = {wanted_mps:.1} }}\ndriver = {driver}\n"
        );
    }

    /// Adds the ego: a human of a drawn style, in a car.
    pub fn ego(&mut self, lane: &str, along_m: f64, speed_mps: f64, to: Option<&str>, wanted_mps: f64) {
        let driver = Some(self.one_of(&DRIVERS[..5]).to_owned());
        self.vehicle(Draftee { name: "ego", class: "car", lane, along_m, speed_mps, to, wanted_mps, driver });
    }

    /// The text of the whole scenario file.
    pub fn finished(self, title: &str, shows: &str) -> String {
        let Draft { road, vehicles, duration_s, .. } = self;
        format!(
            "title = \"{title}\"\nshows = \"{shows}\"\nduration_s = {duration_s:.1}\n\n[defaults]\nclass = \"car\"\n\n\
             [road]\n{road}{vehicles}\n[expect]\nno_collision = true\noff_road_at_most_m = 0.05\n"
        )
    }
}
