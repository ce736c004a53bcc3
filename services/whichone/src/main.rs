//! `whichone`: the command line program; and, started under the name of another program of the group that is
//! not installed, that program.

use std::process::ExitCode;

mod hosted;
mod shipped_files;

fn main() -> ExitCode {
    build_info::register(source_commit::source_commit!(), hosted::features());
    parts::register();
    hosted::run().unwrap_or_else(|| whichone::run(std::env::args_os(), shipped_files::FILES).code())
}
