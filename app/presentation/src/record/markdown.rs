//! Texts as Markdown.

/// A text to be shown as it is: between more backticks than it has in a row.
pub fn code(text: &str) -> String {
    let most = text.split(|character| character != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(most + 1);
    if most == 0 { format!("{fence}{text}{fence}") } else { format!("{fence} {text} {fence}") }
}

#[cfg(test)]
mod tests {
    use super::code;

    #[test]
    fn backticks_in_a_command_do_not_end_it() {
        assert_eq!(code("interplay run a"), "`interplay run a`");
        assert_eq!(code("--set 'title=`a` ``b``'"), "``` --set 'title=`a` ``b``' ```");
    }
}
