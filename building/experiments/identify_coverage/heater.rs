//! Heat as heaters give it: minute by minute, by the temperature of the room. A meter records the mean of each row.

use interplay_common::random::Random;

const MINUTES_PER_DAY: usize = 1440;
/// A modulating heater cycles below this share of its power.
const LEAST_MODULATION: f64 = 0.2;
/// Minutes between two decisions of a modulating heater.
const MODULATION_MINUTES: usize = 5;

/// How a heater is controlled.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Way {
    /// On and off, with hysteresis.
    Thermostat,
    /// Power in proportion to what the room lacks, minute by minute.
    Proportional,
    /// Levels that are held for an hour or more.
    Steps,
    /// Proportional and integral, with a least power below which it cycles.
    Modulating,
}

impl Way {
    /// The way of a house, by its number: half of all have a thermostat.
    pub fn of_house(house: u64) -> Self {
        [Self::Thermostat, Self::Proportional, Self::Thermostat, Self::Steps, Self::Thermostat, Self::Modulating]
            [house as usize % 6]
    }
}

/// A heater with its control.
#[derive(Clone, Debug)]
pub struct Heater {
    way: Way,
    most_kw: f64,
    day_c: f64,
    night_c: f64,
    /// Hours at which the day begins and ends.
    day_h: (f64, f64),
    hysteresis_k: f64,
    /// Share of the power for a kelvin that is lacking.
    gain_per_k: f64,
    /// How long a level is held on average \[min\].
    held_minutes: f64,
    on: bool,
    level: f64,
    integral: f64,
}

impl Heater {
    /// A heater for a house that needs `design_kw` in the cold.
    pub fn random(way: Way, design_kw: f64, random: &mut Random) -> Self {
        Self {
            way,
            most_kw: design_kw * random.uniform(1.2, 2.2),
            day_c: random.uniform(19.5, 22.5),
            night_c: random.uniform(15.0, 18.5),
            day_h: (random.uniform(5.0, 8.0), random.uniform(20.0, 23.5)),
            hysteresis_k: random.uniform(0.15, 0.6),
            gain_per_k: random.uniform(0.3, 1.0),
            held_minutes: random.uniform(60.0, 240.0),
            on: false,
            level: 0.0,
            integral: 0.0,
        }
    }

    /// Heat in a minute, given the temperature of the room \[kW\].
    pub fn next_kw(&mut self, minute: usize, air_c: f64, random: &mut Random) -> f64 {
        let hour = (minute % MINUTES_PER_DAY) as f64 / 60.0;
        let is_day = hour >= self.day_h.0 && hour < self.day_h.1;
        let lack_k = if is_day { self.day_c } else { self.night_c } - air_c;
        let share = match self.way {
            Way::Thermostat => {
                self.switch(lack_k);
                f64::from(u8::from(self.on))
            }
            Way::Proportional => (self.gain_per_k * lack_k).clamp(0.0, 1.0),
            Way::Steps => {
                // The draw is made in every minute, so that the stream of random numbers does not depend on the way.
                if random.chance(1.0 / self.held_minutes) {
                    self.level = if self.level > 0.5 { 0.1 } else { 0.9 };
                }
                if lack_k < -2.0 { 0.0 } else { self.level }
            }
            Way::Modulating => {
                if minute.is_multiple_of(MODULATION_MINUTES) {
                    self.integral = (self.integral + 0.02 * lack_k).clamp(0.0, 1.0);
                    self.level = (self.gain_per_k * lack_k + self.integral).clamp(0.0, 1.0);
                    self.switch(lack_k);
                }
                match self.level < LEAST_MODULATION {
                    true => LEAST_MODULATION * f64::from(u8::from(self.on)),
                    false => self.level,
                }
            }
        };
        self.most_kw * share
    }

    fn switch(&mut self, lack_k: f64) {
        if lack_k > self.hysteresis_k {
            self.on = true;
        } else if lack_k < -self.hysteresis_k {
            self.on = false;
        }
    }
}

/// Where the heat of a simulation comes from.
pub enum Heat<'a> {
    Heater(Heater),
    /// The mean of each row, held \[kW\].
    Held(&'a [f64]),
}
