//! The `interplay` command.

fn main() -> std::process::ExitCode {
    interplay::main()
}
