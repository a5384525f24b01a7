//! The `interplay` command under a name of its own, so that the end-to-end tests can start it.

fn main() -> std::process::ExitCode {
    interplay::main()
}
