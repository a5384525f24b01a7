//! The command without a subcommand: a first run, and what to try next.

use interplay_presentation::shell;

use crate::output::print_error;
use crate::output::program::this_program;

/// The scenario of the first run: two real cars come to a crossing without priority.
pub(crate) const SCENARIO: &str = "people/intersection";

/// Prints three commands to try next, a line each with its effect.
pub(crate) fn print_next_commands() {
    let program = this_program();
    let commands = [
        (vec!["why", SCENARIO], "what the order depends on"),
        (vec!["play", SCENARIO, "--as", "crossing"], "drive the other car yourself"),
        (vec!["new", "my.toml", "--from", SCENARIO], "a scenario of your own"),
    ];
    let lines = commands.map(|(words, effect)| (shell::line([program.as_str()].into_iter().chain(words)), effect));
    let width = lines.iter().map(|(command, _)| command.len()).max().unwrap_or_default();
    for (command, effect) in lines {
        print_error(&format!("next: {command:width$}  ({effect})"));
    }
}
