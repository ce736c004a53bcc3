//! The console's program.

fn main() -> std::process::ExitCode {
    parts::register();
    console::run()
}
