//! `whichone-supervisor`: runs one group of services until it is stopped.

fn main() -> std::process::ExitCode {
    supervisor::cli::run()
}
