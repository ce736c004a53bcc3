//! `whichone-supervisor`: runs one group of services until it is stopped.

fn main() -> std::process::ExitCode {
    parts::register();
    supervisor::cli::run()
}
