//! The child's side: a loop that turns requests into calls of the unit.

use std::io::{self, BufRead, Write};
use std::path::Path;

use crate::library::Instance;
use crate::protocol::{HostAnswer, Request, Values};
use crate::standard_output;

/// Loads a library, creates an instance of the unit, and answers requests from the standard input until the request to end or the end
/// of the input. Output that the unit itself prints goes to the standard error.
///
/// # Errors
/// Errors of reading and writing. A failure of the unit is an answer, not an error.
pub fn serve(library: &Path, guid: &str, resources: &str) -> io::Result<()> {
    let mut output = standard_output::taken()?;
    let instance = match Instance::new(library, guid, resources) {
        Ok(instance) => instance,
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
        answer(&mut output, &handle(&instance, &request).unwrap_or_else(|reason| HostAnswer::Failed { reason }))?;
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

fn handle(instance: &Instance, request: &Request) -> Result<HostAnswer, String> {
    let finite = |values: Vec<f64>| values.into_iter().map(|value| value.is_finite().then_some(value)).collect();
    match request {
        Request::Initialize { start_s } => instance.initialize(*start_s)?,
        Request::Set { reals, booleans } => instance.set(reals, booleans)?,
        Request::Get { reals, booleans, strings } => {
            let rows = vec![finite(instance.numbers(reals, booleans)?)];
            return Ok(HostAnswer::Values(Values { rows, strings: instance.strings(strings)? }));
        }
        Request::Steps { from_s, step_s, count, reals, booleans } => {
            let mut rows = Vec::with_capacity(*count);
            for step in 0..*count {
                instance.step(from_s + step as f64 * step_s, *step_s)?;
                rows.push(finite(instance.numbers(reals, booleans)?));
            }
            return Ok(HostAnswer::Values(Values { rows, strings: Vec::new() }));
        }
        Request::Reset => instance.reset()?,
        Request::End => instance.terminate()?,
    }
    Ok(HostAnswer::Done)
}
