//! What differs between the world in which a house stands and that which the models take for granted.

use interplay_common::random::Random;

const MINUTES_PER_DAY: usize = 1440;
/// Steps of a sensor that rounds \[K\].
const SENSOR_STEP_K: f64 = 0.1;
/// Heat of a person, and of what is switched on in the evening \[kW\].
const PERSON_KW: f64 = 0.1;
const EVENING_KW: f64 = 0.3;

#[derive(Clone, Copy, PartialEq)]
pub enum World {
    /// Random heat and sensor noise are white, and all else is measured.
    Matched,
    /// The sensor rounds to 0.1 K.
    Quantised,
    /// Random heat is correlated over one to four hours.
    ColouredHeat,
    /// Windows are opened for 15 to 60 minutes, one and a half times a day, and double to quadruple the losses.
    Windows,
    /// The sun shines on the house from 11 to 19 h, and on the sensor from 7 to 17 h.
    SunFromAnotherSide,
    /// The weather's clock is one hour off.
    Clock,
    /// One to four people, and what they switch on in the evening, are in no column.
    People,
    /// The heat meter is 10 % off.
    Meter,
    /// Heat is recorded a row late.
    LateHeat,
    /// The electricity of a heat pump is recorded as its heat.
    Electricity,
}

impl World {
    /// What the sensor says of a temperature.
    pub fn sensed_c(self, temperature_c: f64) -> f64 {
        match self {
            Self::Quantised => libm::round(temperature_c / SENSOR_STEP_K) * SENSOR_STEP_K,
            _ => temperature_c,
        }
    }

    /// Irradiance on the other side, as a share of the brightest.
    pub fn other_side(hour: f64) -> f64 {
        if (11.0..19.0).contains(&hour) { libm::sin(std::f64::consts::PI * (hour - 11.0) / 8.0) } else { 0.0 }
    }

    /// What the meter says of a kilowatt.
    pub fn meter(self, random: &mut Random) -> f64 {
        match self {
            Self::Meter if random.chance(0.5) => 1.1,
            Self::Meter => 0.9,
            _ => 1.0,
        }
    }

    /// Heat as it is recorded, with the factor of a meter \[kW\].
    pub fn recorded_kw(self, heat_kw: &[f64], outdoor_c: &[f64], step_s: f64, meter: f64) -> Vec<f64> {
        let all = 0..heat_kw.len();
        match self {
            // A row, or half an hour where rows are shorter.
            Self::LateHeat => Self::shifted(heat_kw, (1800.0 / step_s).ceil().max(1.0) as isize),
            Self::Electricity => all.map(|row| heat_kw[row] / (3.2 + 0.08 * outdoor_c[row])).collect(),
            _ => all.map(|row| meter * heat_kw[row]).collect(),
        }
    }

    /// Rows by which the weather is recorded too late; negative if too early.
    pub fn clock_rows(self, step_s: f64, random: &mut Random) -> isize {
        let hour = (3600.0 / step_s) as isize;
        match self {
            Self::Clock if random.chance(0.5) => hour,
            Self::Clock => -hour,
            _ => 0,
        }
    }

    /// A series recorded some rows late; its ends go on.
    pub fn shifted(values: &[f64], late: isize) -> Vec<f64> {
        let last = values.len() as isize - 1;
        (0..=last).map(|row| values[(row - late).clamp(0, last) as usize]).collect()
    }
}

/// Unmeasured heat and sun in each minute.
pub struct Unmeasured {
    pub heat_kw: Vec<f64>,
    /// Losses to outdoors through windows.
    pub conductance_kw_per_k: Vec<f64>,
}

impl Unmeasured {
    pub fn new(world: World, minutes: usize, ua: f64, random: &mut Random) -> Self {
        let mut unmeasured = Self { heat_kw: vec![0.0; minutes], conductance_kw_per_k: vec![0.0; minutes] };
        match world {
            World::Windows => unmeasured.open_windows(ua, random),
            World::People => unmeasured.let_people_in(random),
            _ => {}
        }
        unmeasured
    }

    fn open_windows(&mut self, ua: f64, random: &mut Random) {
        for day in 0..self.heat_kw.len() / MINUTES_PER_DAY {
            let times = if random.chance(0.5) { 1 } else { 2 };
            for _ in 0..times {
                let start = day * MINUTES_PER_DAY + (60.0 * random.uniform(7.0, 22.0)) as usize;
                let length = random.uniform(15.0, 60.0) as usize;
                let conductance = ua * random.uniform(1.0, 3.0);
                let end = (start + length).min(self.heat_kw.len());
                self.conductance_kw_per_k[start.min(end)..end].fill(conductance);
            }
        }
    }

    fn let_people_in(&mut self, random: &mut Random) {
        let people = random.uniform(1.0, 5.0).floor();
        for day in 0..self.heat_kw.len().div_ceil(MINUTES_PER_DAY) {
            let (leave, back) = (random.uniform(7.0, 8.5), random.uniform(15.5, 18.5));
            let is_out = day % 7 < 5 || random.chance(0.3);
            for minute in 0..MINUTES_PER_DAY {
                let Some(heat) = self.heat_kw.get_mut(day * MINUTES_PER_DAY + minute) else { return };
                let hour = minute as f64 / 60.0;
                let away = is_out && hour > leave && hour < back;
                *heat = if away { 0.0 } else { PERSON_KW * people };
                if (18.5..22.5).contains(&hour) {
                    *heat += EVENING_KW;
                }
            }
        }
    }
}
