//! The child's side: a loop that turns requests into calls of the unit.

use std::io::{self, BufRead, Write};
use std::path::Path;

use crate::description::Shape;
use crate::exchange::ModelExchange;
use crate::library::{Instance, Interface};
use crate::protocol::{HostAnswer, Request, Values};
use crate::standard_output;

/// Loads a library, creates an instance of the unit, and answers requests from the standard input until the request to end or the end
/// of the input. Output that the unit itself prints goes to the standard error. `exchange` is the [`Shape`] of a unit for model exchange;
/// without it the unit is one for co-simulation.
///
/// # Errors
/// Errors of reading and writing. A failure of the unit is an answer, not an error.
pub fn serve(library: &Path, guid: &str, resources: &str, exchange: Option<&str>) -> io::Result<()> {
    let mut output = standard_output::taken()?;
    let mut running = match Running::start(library, guid, resources, exchange) {
        Ok(running) => running,
        Err(reason) => return answer(&mut output, &HostAnswer::Failed { reason }),
    };
    answer(&mut output, &HostAnswer::Done)?;
    for line in io::stdin().lock().lines() {
        let request = match serde_json::from_str(&line?) {
            Ok(request) => request,
            Err(error) => {
                answer(&mut output, &HostAnswer::Failed { reason: format!("it is not a request: {error}") })?;
                continue;
            }
        };
        answer(&mut output, &running.handle(&request).unwrap_or_else(|reason| HostAnswer::Failed { reason }))?;
        if request == Request::End {
            break;
        }
    }
    Ok(())
}

fn answer(output: &mut impl Write, answer: &HostAnswer) -> io::Result<()> {
    let mut line = serde_json::to_string(answer)?;
    line.push('\n');
    output.write_all(line.as_bytes())
}

/// A unit of either kind.
enum Running {
    CoSimulation(Instance),
    Exchange(Box<ModelExchange>),
}

impl Running {
    fn start(library: &Path, guid: &str, resources: &str, exchange: Option<&str>) -> Result<Self, String> {
        let Some(shape) = exchange else {
            return Ok(Self::CoSimulation(Instance::new(library, guid, resources, Interface::CoSimulation)?));
        };
        let shape: Shape = shape.parse()?;
        let instance = Instance::new(library, guid, resources, Interface::ModelExchange)?;
        Ok(Self::Exchange(Box::new(ModelExchange::new(instance, shape))))
    }

    fn instance(&self) -> &Instance {
        match self {
            Self::CoSimulation(instance) => instance,
            Self::Exchange(exchange) => exchange.instance(),
        }
    }

    fn step(&mut self, from_s: f64, step_s: f64) -> Result<(), String> {
        match self {
            Self::CoSimulation(instance) => instance.step(from_s, step_s),
            Self::Exchange(exchange) => exchange.advance(from_s + step_s),
        }
    }

    fn handle(&mut self, request: &Request) -> Result<HostAnswer, String> {
        let finite = |values: Vec<f64>| values.into_iter().map(|value| value.is_finite().then_some(value)).collect();
        match (request, &mut *self) {
            (Request::Initialize { start_s }, Self::CoSimulation(instance)) => instance.initialize(*start_s)?,
            (Request::Initialize { start_s }, Self::Exchange(exchange)) => exchange.initialize(*start_s)?,
            (Request::Set { reals, booleans }, Self::CoSimulation(instance)) => instance.set(reals, booleans)?,
            (Request::Set { reals, booleans }, Self::Exchange(exchange)) => exchange.set(reals, booleans)?,
            (Request::Get { reals, booleans, strings }, _) => {
                let rows = vec![finite(self.instance().numbers(reals, booleans)?)];
                return Ok(HostAnswer::Values(Values { rows, strings: self.instance().strings(strings)? }));
            }
            (Request::Steps { from_s, step_s, count, reals, booleans }, _) => {
                let mut rows = Vec::with_capacity(*count);
                for step in 0..*count {
                    self.step(from_s + step as f64 * step_s, *step_s)?;
                    rows.push(finite(self.instance().numbers(reals, booleans)?));
                }
                return Ok(HostAnswer::Values(Values { rows, strings: Vec::new() }));
            }
            (Request::Reset, Self::CoSimulation(instance)) => instance.reset()?,
            (Request::Reset, Self::Exchange(exchange)) => exchange.reset()?,
            (Request::End, _) => self.instance().terminate()?,
        }
        Ok(HostAnswer::Done)
    }
}
