//! Quoting of words for a POSIX shell, and the search for programs on the path.

use std::env;
use std::path::PathBuf;

/// One line that a shell splits into exactly these words.
pub fn line<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    words.into_iter().map(quoted).collect::<Vec<_>>().join(" ")
}

/// A word in single quotes unless it needs none.
fn quoted(word: &str) -> String {
    let plain = |character: char| character.is_ascii_alphanumeric() || "_-./=:,+@%".contains(character);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// Whether a program with this name is in a folder of `PATH`.
pub fn is_on_path(program: &str) -> bool {
    let is_program = |file: PathBuf| file.is_file() || file.with_extension("exe").is_file();
    let folders = env::var_os("PATH").unwrap_or_default();
    env::split_paths(&folders).any(|folder| is_program(folder.join(program)))
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use super::*;

    #[test]
    fn words_without_special_characters_are_not_quoted() {
        assert_eq!(line(["run", "a/b.toml", "--set", "x.y=1.5"]), "run a/b.toml --set x.y=1.5");
        assert_eq!(line(["--set", r#"title="It's""#, ""]), r#"--set 'title="It'\''s"' ''"#);
    }

    #[test]
    fn a_shell_splits_a_quoted_line_into_the_same_words() {
        let words = ["a b", "it's", "$HOME `ls` \\ \"q\"", "*?[x]~#!&|;<>(){}", "", "line\nbreak", "Größe=ü", "-x"];
        let script = format!("for word in {}; do printf '%s\\0' \"$word\"; done", line(words));
        let output = Command::new("sh").args(["-c", &script]).output().expect("there is a shell");
        let text = String::from_utf8(output.stdout).expect("UTF-8 in, UTF-8 out");
        assert_eq!(text.split_terminator('\0').collect::<Vec<_>>(), words);
    }
}
