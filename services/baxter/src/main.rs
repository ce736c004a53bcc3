//! The simulated Baxter.

fn main() -> std::process::ExitCode {
    baxter::run()
}
