//! `export`: data of the project in formats of other programs.

use command_line::Outcome;
use command_line::output::Output;
use service::group::{GroupError, GroupPaths};

use crate::args::ExportVerb;

mod journals;
mod mcap;
mod pomdp;
mod trace;

/// Executes `export`.
pub(super) fn export(
    paths: impl FnOnce() -> Result<GroupPaths, GroupError>,
    verb: &ExportVerb,
    out: &mut Output<'_>,
) -> Outcome {
    match verb {
        ExportVerb::Pomdp(args) => pomdp::export(args, out),
        ExportVerb::Mcap(args) => mcap::export(paths, args, out),
        ExportVerb::Trace(args) => trace::export(paths, args, out),
    }
}
