//! `export`: data of the project in formats of other programs.

use crate::Outcome;
use crate::cli::ExportVerb;
use crate::output::Output;

mod mcap;
mod pomdp;

/// Executes `export`.
pub(super) fn export(verb: &ExportVerb, out: &mut Output<'_>) -> Outcome {
    match verb {
        ExportVerb::Pomdp(args) => pomdp::export(args, out),
        ExportVerb::Mcap(args) => mcap::export(args, out),
    }
}
