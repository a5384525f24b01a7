//! The network in its discrete form, with its weather: what the file `plant.txt` holds, and a step of it.
//!
//! ```text
//! T(t+1) = A T(t) + B (w(t) + u(t)) + b T₀(t)                                      (eq. 2.16)
//! ```
//!
//! `T` are the temperatures of the nodes (zones, then walls that store heat), `u` the heat of the equipment, `w` that of people,
//! sun and machines (of the zones, and of the walls where the sun falls on one), and `T₀` the outdoor temperature.

/// The first line of the file.
pub const HEADER: &str = "interplay-plant 1";

/// A thermal network in discrete time with its weather and its present state.
#[derive(Clone, Debug)]
pub struct DiscretePlant {
    /// The GUID of the FMU, which its description repeats.
    pub guid: String,
    /// Time from one step to the next \[s\].
    pub step_s: f64,
    pub zones: usize,
    nodes: usize,
    /// Number of nodes that get heat of people, sun or machines, zones first.
    gained: usize,
    initial_c: Vec<f64>,
    /// State matrix A, row by row.
    state: Vec<f64>,
    /// Input matrix B, nodes by nodes that get heat, row by row \[K/kW\].
    gain: Vec<f64>,
    /// Effect b of the outdoor temperature, one number per node.
    outdoor: Vec<f64>,
    /// Outdoor temperature T₀ of each step \[°C\].
    ambient_c: Vec<f64>,
    /// Heat w of people, sun and machines, stacked: entry t·m + i is node i of the m that get any, in step t \[kW\].
    gains_kw: Vec<f64>,
    pub present: PlantState,
}

#[derive(Clone, Debug, PartialEq)]
pub struct PlantState {
    /// Number of steps since the first midnight.
    pub step: usize,
    /// Temperatures of the nodes, zones first \[°C\].
    pub nodes_c: Vec<f64>,
    /// Heat u of the equipment, one number per zone, held until it is set anew \[kW\].
    pub heat_kw: Vec<f64>,
}

/// Words of the file, one after the other.
struct Words<'a>(std::str::SplitWhitespace<'a>);

impl<'a> Words<'a> {
    fn next(&mut self, what: &str) -> Result<&'a str, String> {
        self.0.next().ok_or_else(|| format!("the file ends before {what}"))
    }

    fn expect(&mut self, word: &str) -> Result<(), String> {
        let found = self.next(word)?;
        if found == word { Ok(()) } else { Err(format!("expected `{word}`, found `{found}`")) }
    }

    fn count(&mut self, word: &str) -> Result<usize, String> {
        self.expect(word)?;
        let text = self.next(word)?;
        text.parse().map_err(|_| format!("`{text}` is not a count of {word}"))
    }

    fn number(&mut self, what: &str) -> Result<f64, String> {
        let text = self.next(what)?;
        let number: f64 = text.parse().map_err(|_| format!("`{text}` in {what} is not a number"))?;
        if number.is_finite() { Ok(number) } else { Err(format!("`{text}` in {what} is not finite")) }
    }

    fn numbers(&mut self, word: &str, count: usize) -> Result<Vec<f64>, String> {
        self.expect(word)?;
        (0..count).map(|_| self.number(word)).collect()
    }
}

impl DiscretePlant {
    /// Reads the file `plant.txt`.
    ///
    /// # Errors
    /// The first fault of the file.
    pub fn parse(text: &str) -> Result<Self, String> {
        let body = text.strip_prefix(HEADER).ok_or_else(|| format!("the file does not begin with `{HEADER}`"))?;
        let mut words = Words(body.split_whitespace());
        words.expect("guid")?;
        let guid = words.next("guid")?.to_owned();
        words.expect("step_s")?;
        let step_s = words.number("step_s")?;
        let (nodes, zones, gained) = (words.count("nodes")?, words.count("zones")?, words.count("gained")?);
        let steps = words.count("steps")?;
        let sizes = [nodes.checked_mul(nodes), nodes.checked_mul(gained), steps.checked_mul(gained)];
        let [Some(state_size), Some(gain_size), Some(gains_size)] = sizes else {
            return Err("the sizes are too large".to_owned());
        };
        if step_s <= 0.0 || zones == 0 || zones > gained || gained > nodes || steps == 0 {
            return Err(
                "the step length, the number of steps or the number of zones is not positive, or zones exceed nodes"
                    .to_owned(),
            );
        }
        let initial_c = words.numbers("initial_c", nodes)?;
        Ok(Self {
            guid,
            step_s,
            zones,
            nodes,
            gained,
            present: PlantState { step: 0, nodes_c: initial_c.clone(), heat_kw: vec![0.0; zones] },
            initial_c,
            state: words.numbers("state", state_size)?,
            gain: words.numbers("gain", gain_size)?,
            outdoor: words.numbers("outdoor", nodes)?,
            ambient_c: words.numbers("ambient_c", steps)?,
            gains_kw: words.numbers("gains_kw", gains_size)?,
        })
    }

    /// Returns to the first midnight, without heat.
    pub fn reset(&mut self) {
        self.present.nodes_c.clone_from(&self.initial_c);
        self.present.heat_kw.fill(0.0);
        self.present.step = 0;
    }

    /// Time since the first midnight \[s\].
    pub fn time_s(&self) -> f64 {
        self.present.step as f64 * self.step_s
    }

    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// Number of steps for which there is weather.
    pub fn steps(&self) -> usize {
        self.ambient_c.len()
    }

    /// Outdoor temperature of the next step, or of the last one \[°C\].
    pub fn ambient_c(&self) -> f64 {
        self.ambient_c[self.present.step.min(self.steps() - 1)]
    }

    /// Heat of people, sun and machines in the next step, or in the last one, one number per node that gets any, zones
    /// first \[kW\].
    pub fn gains_kw(&self) -> &[f64] {
        let step = self.present.step.min(self.steps() - 1);
        &self.gains_kw[step * self.gained..(step + 1) * self.gained]
    }

    /// Advances by one step.
    ///
    /// # Errors
    /// If the weather has ended, or if a temperature would not be finite. The state is then unchanged.
    pub fn advance(&mut self) -> Result<(), String> {
        if self.present.step >= self.steps() {
            let end_s = self.step_s * self.steps() as f64;
            return Err(format!("the weather in the FMU ends at {end_s} s"));
        }
        let mut net_kw = self.gains_kw().to_vec();
        net_kw.iter_mut().zip(&self.present.heat_kw).for_each(|(net_kw, heat_kw)| *net_kw += heat_kw);
        let ambient_c = self.ambient_c();
        let row = |matrix: &[f64], node: usize, vector: &[f64]| -> f64 {
            let width = vector.len();
            matrix[node * width..(node + 1) * width].iter().zip(vector).map(|(a, x)| a * x).sum()
        };
        let next_c: Vec<f64> = (0..self.nodes)
            .map(|i| {
                row(&self.state, i, &self.present.nodes_c) + row(&self.gain, i, &net_kw) + self.outdoor[i] * ambient_c
            })
            .collect();
        if !next_c.iter().all(|temperature_c| temperature_c.is_finite()) {
            return Err("a temperature is not a finite number; check the heat".to_owned());
        }
        self.present.nodes_c = next_c;
        self.present.step += 1;
        Ok(())
    }
}
