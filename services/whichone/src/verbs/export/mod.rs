//! `export`: data of the project in formats of other programs.

use service::group::{GroupError, GroupPaths};

use crate::Outcome;
use crate::cli::ExportVerb;
use crate::output::Output;

mod mcap;
mod pomdp;

/// Executes `export`.
pub(super) fn export(
    paths: impl FnOnce() -> Result<GroupPaths, GroupError>,
    verb: &ExportVerb,
    out: &mut Output<'_>,
) -> Outcome {
    match verb {
        ExportVerb::Pomdp(args) => pomdp::export(args, out),
        ExportVerb::Mcap(args) => mcap::export(paths, args, out),
    }
}
