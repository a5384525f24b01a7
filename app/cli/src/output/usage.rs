//! Advice for arguments that a command does not take.

use clap::error::{ContextKind, ContextValue, ErrorKind};
use interplay_common::spelling::nearest;

/// What works in place of `--style` where a command does not take it.
const INSTEAD_OF_STYLE: &str = "'--set vehicle.NAME.driver.style=tough' gives a vehicle a style";

/// The error with advice on what would work: the commands that take an unknown flag, or the command that was probably meant.
pub(crate) fn with_advice(mut error: clap::Error, command: &clap::Command) -> clap::Error {
    let stated = |error: &clap::Error, kind: ContextKind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.clone()),
        _ => None,
    };
    match error.kind() {
        ErrorKind::UnknownArgument if error.get(ContextKind::SuggestedArg).is_none() => {
            let advice = stated(&error, ContextKind::InvalidArg).and_then(|flag| advice_for(&flag, command));
            if let Some(advice) = advice {
                error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![advice.into()]));
            }
        }
        ErrorKind::InvalidSubcommand if error.get(ContextKind::SuggestedSubcommand).is_none() => {
            let word = stated(&error, ContextKind::InvalidSubcommand).unwrap_or_default();
            let names = command.get_subcommands().filter(|one| !one.is_hide_set()).map(clap::Command::get_name);
            if let Some(name) = nearest(&word, names) {
                error.insert(ContextKind::SuggestedSubcommand, ContextValue::Strings(vec![name.to_owned()]));
            }
        }
        _ => {}
    }
    error
}

/// The commands that take a flag such as `--style`; `None` if there are none.
fn advice_for(flag: &str, command: &clap::Command) -> Option<String> {
    let long = flag.strip_prefix("--")?.split('=').next()?;
    let takes = |one: &&clap::Command| one.get_arguments().any(|argument| argument.get_long() == Some(long));
    let visible = command.get_subcommands().filter(|one| !one.is_hide_set());
    let takers: Vec<String> = visible.filter(takes).map(|one| format!("'interplay {}'", one.get_name())).collect();
    let verb = if takers.len() == 1 { "takes" } else { "take" };
    let taken = (!takers.is_empty()).then(|| format!("{} {verb} '--{long}'", takers.join(", ")));
    let instead = (long == "style").then(|| INSTEAD_OF_STYLE.to_owned());
    let advice: Vec<String> = instead.into_iter().chain(taken).collect();
    (!advice.is_empty()).then(|| advice.join("; "))
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::Registry;

    use super::*;

    fn said(arguments: &[&str]) -> String {
        let mut command = crate::command(Registry::standard());
        let error = command.try_get_matches_from_mut(arguments).expect_err("refused");
        with_advice(error, &command).render().to_string()
    }

    #[test]
    fn a_flag_of_another_command_is_advised_where_it_works() {
        let said = said(&["interplay", "run", "--style", "tough"]);
        assert!(said.contains("tip: '--set vehicle.NAME.driver.style=tough' gives a vehicle a style"), "{said}");
        assert!(said.contains("'interplay sweep'") && !said.contains("-- --style"), "{said}");
    }

    #[test]
    fn a_misspelt_command_is_corrected_after_help_too() {
        for arguments in [["interplay", "help", "rum"].as_slice(), &["interplay", "rum"]] {
            let said = said(arguments);
            assert!(said.contains("'run'"), "{said}");
        }
    }
}
