//! A unit for model exchange: its equations are integrated here, with its events in time, of state and after steps.

use crate::description::Shape;
use crate::esdirk::{Equations, Esdirk, Stepped};
use crate::library::{EventOutcome, Instance};

/// An event of state is located to this share of the step in which it lies, and of the time.
const LOCATED: f64 = 1e-10;
const LOCATED_OF_TIME: f64 = 1e-14;
/// More events within a communication step are taken for chattering.
const MAX_EVENTS: usize = 100_000;
/// A moment, as a share of the time and of a second.
const MOMENT: f64 = 1e-12;
/// Steps that are repeated to end at an event.
const MAX_REPEATS: usize = 20;

pub struct ModelExchange {
    instance: Instance,
    shape: Shape,
    solver: Esdirk,
    time_s: f64,
    states: Vec<f64>,
    /// Whether each event indicator is above zero.
    is_above: Vec<bool>,
    next_event_s: Option<f64>,
    is_initialized: bool,
}

impl Equations for Instance {
    fn rates(&mut self, time_s: f64, states: &[f64], rates: &mut [f64]) -> Result<bool, String> {
        self.place(time_s, states)?;
        self.read("fmi2GetDerivatives", rates)
    }
}

impl ModelExchange {
    pub fn new(instance: Instance, shape: Shape) -> Self {
        let solver = Esdirk::new(shape.tolerance, vec![1.0; shape.states]);
        Self {
            instance,
            shape,
            solver,
            time_s: 0.0,
            states: vec![0.0; shape.states],
            is_above: Vec::new(),
            next_event_s: None,
            is_initialized: false,
        }
    }

    pub fn instance(&self) -> &Instance {
        &self.instance
    }

    pub fn initialize(&mut self, start_s: f64) -> Result<(), String> {
        self.instance.initialize(start_s)?;
        (self.time_s, self.is_initialized) = (start_s, true);
        self.solver = Esdirk::new(self.shape.tolerance, vec![1.0; self.shape.states]);
        let event = self.instance.update()?;
        self.follow(EventOutcome { states: true, nominals: true, ..event })
    }

    pub fn reset(&mut self) -> Result<(), String> {
        self.is_initialized = false;
        self.instance.reset()
    }

    /// Sets inputs, which is an event once the unit is initialised.
    pub fn set(&mut self, reals: &[(u32, f64)], booleans: &[(u32, bool)]) -> Result<(), String> {
        if !self.is_initialized {
            return self.instance.set(reals, booleans);
        }
        let event = self.instance.event(|instance| instance.set(reals, booleans))?;
        self.follow(event)
    }

    /// Integrates until the end of a communication step.
    pub fn advance(&mut self, end_s: f64) -> Result<(), String> {
        let mut events = 0;
        while self.time_s < end_s {
            let until_s = self.next_event_s.map_or(end_s, |next_s| next_s.clamp(self.time_s, end_s));
            let crossed = if until_s > self.time_s { self.step(until_s)? } else { false };
            let is_due = self.next_event_s.is_some_and(|next_s| next_s <= self.time_s);
            let is_wanted = self.shape.needs_completed_steps && self.instance.complete_step()?;
            if crossed || is_due || is_wanted {
                events += 1;
                if events > MAX_EVENTS {
                    return Err(format!("it has more than {MAX_EVENTS} events before {end_s} s"));
                }
                let event = self.instance.event(|_| Ok(())).map_err(|reason| self.at(&reason))?;
                self.follow(event)?;
            }
        }
        Ok(())
    }

    fn at(&self, reason: &str) -> String {
        format!("{reason}, at {} s", self.time_s)
    }

    /// Makes a step that ends at the first event of state, or at most at `until_s`. Returns whether such an event has come.
    fn step(&mut self, until_s: f64) -> Result<bool, String> {
        let mut until_s = until_s;
        for repeat in 0.. {
            let next = self.solver.step(&mut self.instance, self.time_s, &self.states, until_s)?;
            let is_above = self.above(&next)?;
            let crossed = is_above != self.is_above;
            if crossed && repeat < MAX_REPEATS {
                let located_s = self.located(&next)?;
                if located_s < next.time_s {
                    until_s = located_s;
                    continue;
                }
            }
            self.instance.place(next.time_s, &next.states)?;
            (self.time_s, self.states, self.is_above) = (next.time_s, next.states, is_above);
            return Ok(crossed);
        }
        Ok(false)
    }

    /// Whether each indicator is above zero.
    fn above(&self, at: &Stepped) -> Result<Vec<bool>, String> {
        Ok(self.indicators(at)?.iter().map(|value| *value > 0.0).collect())
    }

    fn indicators(&self, at: &Stepped) -> Result<Vec<f64>, String> {
        self.instance.place(at.time_s, &at.states)?;
        let mut values = vec![0.0; self.shape.indicators];
        self.instance.demand("fmi2GetEventIndicators", &mut values)?;
        Ok(values)
    }

    /// Whether each indicator is above zero after an event. Of one that is zero its sign a moment later counts: a ball that leaves the
    /// ground is above it.
    fn above_after_event(&mut self) -> Result<Vec<bool>, String> {
        let mut rates = vec![0.0; self.states.len()];
        self.instance.rates(self.time_s, &self.states, &mut rates)?;
        let now = Stepped { time_s: self.time_s, states: self.states.clone() };
        let mut values = self.indicators(&now)?;
        if values.contains(&0.0) {
            let moment_s = MOMENT * (1.0 + self.time_s.abs());
            let states = self.states.iter().zip(&rates).map(|(state, rate)| state + moment_s * rate).collect();
            let later = self.indicators(&Stepped { time_s: self.time_s + moment_s, states })?;
            values.iter_mut().zip(later).filter(|(value, _)| **value == 0.0).for_each(|(value, later)| *value = later);
            self.instance.place(now.time_s, &now.states)?;
        }
        Ok(values.iter().map(|value| *value > 0.0).collect())
    }

    /// The earliest time in a step at which an indicator has crossed zero, by bisection on the cubic between both ends; the end itself if
    /// it lies within the tolerance of it.
    fn located(&mut self, end: &Stepped) -> Result<f64, String> {
        let (start_s, length_s) = (self.time_s, end.time_s - self.time_s);
        let mut rates = [vec![0.0; self.states.len()], vec![0.0; self.states.len()]];
        self.instance.rates(start_s, &self.states, &mut rates[0])?;
        self.instance.rates(end.time_s, &end.states, &mut rates[1])?;
        let between = |share: f64| {
            let (s, r) = (share, 1.0 - share);
            let states = (0..self.states.len()).map(|index| {
                let (a, b) = (self.states[index], end.states[index]);
                let (da, db) = (length_s * rates[0][index], length_s * rates[1][index]);
                r * r * (1.0 + 2.0 * s) * a + s * s * (1.0 + 2.0 * r) * b + s * r * (r * da - s * db)
            });
            Stepped { time_s: start_s + s * length_s, states: states.collect() }
        };
        let (mut before, mut after) = (0.0, 1.0);
        let within = LOCATED.max(LOCATED_OF_TIME * start_s.abs() / length_s);
        while after - before > within {
            let middle = 0.5 * (before + after);
            match self.above(&between(middle))? == self.is_above {
                true => before = middle,
                false => after = middle,
            }
        }
        Ok(if after > 1.0 - 2.0 * within { end.time_s } else { start_s + after * length_s })
    }

    /// Reads what an event has changed.
    fn follow(&mut self, event: EventOutcome) -> Result<(), String> {
        self.next_event_s = event.next_s;
        if event.nominals {
            let mut nominals = vec![1.0; self.states.len()];
            self.instance.demand("fmi2GetNominalsOfContinuousStates", &mut nominals)?;
            self.solver.set_nominals(nominals);
        }
        if event.states {
            self.instance.demand("fmi2GetContinuousStates", &mut self.states)?;
        }
        self.is_above = self.above_after_event()?;
        Ok(())
    }
}
