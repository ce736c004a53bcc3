//! The console's program.

fn main() -> std::process::ExitCode {
    console::run()
}
