//! `completions`: scripts that complete command lines in a shell.

use clap::CommandFactory;
use clap_complete::{Shell, generate};
use service::exit::Exit;

use crate::Outcome;
use crate::cli::Cli;
use crate::output::Output;

/// Prints the script.
pub(super) fn completions(shell: Shell, out: &mut Output<'_>) -> Outcome {
    let mut script = Vec::new();
    generate(shell, &mut Cli::command(), "whichone", &mut script);
    out.text(&String::from_utf8_lossy(&script))?;
    Ok(Exit::Ok)
}
