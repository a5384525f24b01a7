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

/// A lane as a file states it: parallel lanes have numbers, others names.
fn reference(lane: &str) -> String {
    if lane.bytes().all(|byte| byte.is_ascii_digit()) { lane.to_owned() } else { format!("\"{lane}\"") }
}

/// A driver that keeps its speed, or stands.
pub(crate) const SCRIPTED: &str = "{ kind = \"scripted\" }";

pub(crate) struct Draftee<'a> {
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
pub(crate) struct Draft {
    random: Random,
    road: String,
    vehicles: String,
    expectations: String,
    pub duration_s: f64,
    /// Whether no vehicle may touch another one.
    pub is_untouched: bool,
}

/// A stationary obstacle beside the middle of a lane.
pub(crate) struct Parked<'a> {
    pub name: &'a str,
    /// Word of its kind, such as `parked-car`.
    pub kind: &'a str,
    pub lane: &'a str,
    pub along_m: f64,
    /// Distance from the middle of the lane, positive to the left \[m\].
    pub aside_m: f64,
}

impl Draft {
    pub fn new(seed: u64, stream: u64) -> Draft {
        let random = Random::new(seed, stream);
        let (road, vehicles, expectations) = (String::new(), String::new(), String::new());
        Draft { random, road, vehicles, expectations, duration_s: 40.0, is_untouched: true }
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

    /// Adds a straight lane of a network from one position to another; `more` are its other keys, one a line.
    pub fn lane(&mut self, name: &str, [from, to]: [[f64; 2]; 2], width_m: f64, more: &str) {
        let [[ax, ay], [bx, by]] = [from, to];
        self.road(&format!(
            "\n[[road.lane]]\nname = \"{name}\"\npoints = [[{ax:.2}, {ay:.2}], [{bx:.2}, {by:.2}]]\nwidth_m = {width_m}\n{more}"
        ));
    }

    /// Adds an obstacle.
    pub fn parked(&mut self, parked: Parked<'_>) {
        let Parked { name, kind, lane, along_m, aside_m } = parked;
        self.table(&format!(
            "[[obstacle]]\nname = \"{name}\"\nkind = \"{kind}\"\nlane = \"{lane}\"\nalong_m = {along_m:.1}\n\
             lateral_offset_m = {aside_m:.2}"
        ));
    }

    /// Adds a table of the file, such as a traffic light.
    pub fn table(&mut self, lines: &str) {
        self.vehicles.push('\n');
        self.vehicles.push_str(lines);
        self.vehicles.push('\n');
    }

    /// Adds an expectation to those of every street.
    pub fn expect(&mut self, line: &str) {
        self.expectations.push_str(line);
        self.expectations.push('\n');
    }

    /// Adds a bound on a metric; without a vehicle it holds for all.
    pub fn expect_at_most(&mut self, metric: &str, vehicle: Option<&str>, most: f64) {
        let vehicle = vehicle.map(|name| format!("vehicle = \"{name}\"\n")).unwrap_or_default();
        self.expect(&format!("\n[[expect.metric]]\nname = \"{metric}\"\n{vehicle}at_most = {most:.1}"));
    }

    /// Adds a vehicle.
    pub fn vehicle(&mut self, vehicle: Draftee<'_>) {
        let Draftee { name, class, lane, along_m, speed_mps, to, wanted_mps, driver } = vehicle;
        let driver = driver.unwrap_or_else(|| self.one_of(&DRIVERS).to_owned());
        let (lane, to) = (reference(lane), to.map(|lane| format!("lane = {}, ", reference(lane))).unwrap_or_default());
        // Writing to a text cannot fail.
        let _ = write!(
            self.vehicles,
            "\n[[vehicle]]\nname = \"{name}\"\nclass = \"{class}\"\n\
             start = {{ lane = {lane}, along_m = {along_m:.1}, speed_mps = {speed_mps:.1} }}\n\
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
        let Draft { road, vehicles, expectations, duration_s, is_untouched, .. } = self;
        let untouched = if is_untouched { "no_collision = true\n" } else { "" };
        format!(
            "title = \"{title}\"\nshows = \"{shows}\"\nduration_s = {duration_s:.1}\n\n[defaults]\nclass = \"car\"\n\n\
             [road]\n{road}{vehicles}\n[expect]\n{untouched}off_road_at_most_m = 0.05\n{expectations}"
        )
    }
}
