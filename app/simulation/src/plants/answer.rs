//! Answers of a plant, and their validation.

use serde::Deserialize;

use super::error::{PlantError, TEMPERATURES_C};

/// The version of the protocol.
pub const PROTOCOL: u32 = 1;
/// Maximum length of an invalid answer in an error \[characters\].
const MAX_SHOWN_CHARACTERS: usize = 120;

/// A message of the plant; keys that are not listed are ignored.
#[derive(Debug, Deserialize)]
#[serde(tag = "message", rename_all = "kebab-case")]
enum Answer {
    /// Answer to `start`: the temperatures of the zones at the first midnight \[°C\].
    Ready { protocol: u32, temperatures_c: Vec<f64> },
    /// Answer to `step`: the temperatures of the zones at the end of that step \[°C\].
    State { step: usize, temperatures_c: Vec<f64> },
    /// Answer to either: the program cannot continue.
    Error { reason: String },
}

/// A question, with the requirements on its answer.
#[derive(Clone, Debug)]
pub struct Question<'a> {
    /// The question in words, for errors.
    pub words: String,
    /// The requested step; none at the start.
    pub step: Option<usize>,
    /// The names of the zones.
    pub zones: &'a [String],
}

impl Question<'_> {
    /// The temperatures of the zones in an answer \[°C\].
    ///
    /// # Errors
    /// [`PlantError`] if the line does not answer this question, or if a number cannot be the temperature of a zone.
    pub fn temperatures_c(&self, line: &str) -> Result<Vec<f64>, PlantError> {
        let question = || self.words.clone();
        let invalid = |reason: String| PlantError::Invalid { question: question(), reason };
        let answer = serde_json::from_str(line).map_err(|error| PlantError::NoMessage {
            question: question(),
            reason: without_line(&error),
            answer: line.chars().take(MAX_SHOWN_CHARACTERS).collect(),
        })?;
        let temperatures_c = match (answer, self.step) {
            (Answer::Error { reason }, _) => {
                let reason = reason.chars().take(MAX_SHOWN_CHARACTERS).flat_map(char::escape_debug).collect();
                return Err(PlantError::Reported { question: question(), reason });
            }
            (Answer::Ready { protocol, .. }, None) if protocol != PROTOCOL => {
                return Err(invalid(format!("it speaks protocol {protocol}, and this program speaks {PROTOCOL}")));
            }
            (Answer::Ready { temperatures_c, .. }, None) => temperatures_c,
            (Answer::Ready { .. }, Some(_)) => return Err(invalid("it is `ready`; wanted is `state`".to_owned())),
            (Answer::State { .. }, None) => return Err(invalid("it is a `state`; wanted is `ready`".to_owned())),
            (Answer::State { step, .. }, Some(wanted)) if step != wanted => {
                return Err(invalid(format!("it is about step {step}; wanted is step {wanted}")));
            }
            (Answer::State { temperatures_c, .. }, Some(_)) => temperatures_c,
        };
        self.check(&temperatures_c).map_err(invalid)?;
        Ok(temperatures_c)
    }

    fn check(&self, temperatures_c: &[f64]) -> Result<(), String> {
        let (given, wanted) = (temperatures_c.len(), self.zones.len());
        if given != wanted {
            let noun = if given == 1 { "temperature" } else { "temperatures" };
            return Err(format!("it has {given} {noun}; wanted is one for each zone, {wanted}"));
        }
        match self.zones.iter().zip(temperatures_c).find(|(_, value)| !TEMPERATURES_C.contains(*value)) {
            None => Ok(()),
            Some((zone, value)) => Err(format!(
                "zone `{zone}` has {value:.6} °C, which is outside of {} to {} °C",
                TEMPERATURES_C.start(),
                TEMPERATURES_C.end()
            )),
        }
    }
}

/// The message of the JSON parser; an answer is one line, so only the column helps.
fn without_line(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    match text.strip_suffix(&place) {
        Some(what) => format!("{what} at character {}", error.column()),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answered(step: Option<usize>, line: &str) -> Result<Vec<f64>, String> {
        let zones = ["office".to_owned(), "store".to_owned()];
        let question = Question { words: "the question".to_owned(), step, zones: &zones };
        question.temperatures_c(line).map_err(|error| error.to_string())
    }

    #[test]
    fn valid_answers_are_accepted() {
        let ready = r#"{"message":"ready","protocol":1,"temperatures_c":[20,21.5],"name":"extra keys are ignored"}"#;
        assert_eq!(answered(None, ready), Ok(vec![20.0, 21.5]));
        assert_eq!(answered(Some(3), r#"{"message":"state","step":3,"temperatures_c":[-5,0]}"#), Ok(vec![-5.0, 0.0]));
    }

    #[test]
    fn an_invalid_answer_is_refused_with_the_expected_message() {
        let wrong = [
            (None, "", "not a message"),
            (None, "hello", "in `hello`"),
            (None, "[]", "not a message"),
            (None, r#"{"message":"ready","temperatures_c":[1,2]}"#, "protocol"),
            (None, r#"{"message":"ready","protocol":2,"temperatures_c":[1,2]}"#, "this program speaks 1"),
            (None, r#"{"message":"state","step":0,"temperatures_c":[1,2]}"#, "wanted is `ready`"),
            (Some(3), r#"{"message":"ready","protocol":1,"temperatures_c":[1,2]}"#, "wanted is `state`"),
            (Some(3), r#"{"message":"state","step":2,"temperatures_c":[1,2]}"#, "wanted is step 3"),
            (Some(3), r#"{"message":"state","step":3,"temperatures_c":[1]}"#, "1 temperature; wanted is one for each"),
            (Some(3), r#"{"message":"state","step":3,"temperatures_c":[1,NaN]}"#, "NaN"),
            (Some(3), r#"{"message":"state","step":3,"temperatures_c":[1,null]}"#, "null"),
            (Some(3), r#"{"message":"state","step":3,"temperatures_c":[1,1e999]}"#, "out of range"),
            (Some(3), r#"{"message":"state","step":3,"temperatures_c":[1,294.15]}"#, "`store` has 294.150000 °C"),
            (Some(3), r#"{"message":"error","reason":"the boiler broke"}"#, "the boiler broke"),
        ];
        for (step, line, said) in wrong {
            let error = answered(step, line).expect_err(line);
            assert!(error.contains(said) && error.contains("the question"), "{line}: {error}");
        }
    }
}
