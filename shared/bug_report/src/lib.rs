//! `whichone report`: diagnostics of a group for a maintainer, in one archive or folder; and `whichone logs`.
//!
//! | contents | file |
//! |---|---|
//! | the logs for a reader at the machine | `logs.rs` |
//! | sources | `collection.rs`, `own_program.rs`, `machine.rs` |
//! | keys, passwords and tokens, which never leave | `secrets.rs`, `secret_names.rs` |
//! | what people said, which leaves on request only | `words.rs` |
//! | the archive or the folder | `bundle.rs` |
//!
//! Invariant: every text passes the [`Scrubber`](secrets::Scrubber); a file that cannot be scrubbed is left out if it
//! holds a known secret, and without `--with-words` in any case. What is left out is listed with its reason.

mod bundle;
mod collection;
mod logs;
mod machine;
mod own_program;
mod secret_names;
mod secrets;
mod words;

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests;

use std::path::PathBuf;
use std::time::{SystemTime, UNIX_EPOCH};

use clap::Args;
use command_line::Outcome;
use command_line::args::ConfigArgs;
use command_line::output::{Output, note};
use serde_json::json;
use service::exit::{Exit, Failure};
use service::group::{GroupName, GroupPaths};
use vocabulary::wall_time;

use bundle::Bundle;
pub use logs::{LogsArgs, logs};

/// Arguments of `report`.
#[derive(Debug, Args)]
pub struct ReportArgs {
    /// The configuration, if it is not the running group's.
    #[command(flatten)]
    pub config: ConfigArgs,
    /// The new file, which ends in `.tar.gz`, or else a new folder [default: whichone-report-GROUP-TIME.tar.gz here].
    #[arg(long, value_name = "PATH")]
    pub out: Option<PathBuf>,
    /// Add what people said: journals and flights whole, as a replay needs them.
    #[arg(long)]
    pub with_words: bool,
}

/// Collects a report, writes it and lists its contents.
///
/// # Errors
/// The output exists already or cannot be written.
pub fn report(paths: &GroupPaths, args: &ReportArgs, out: &mut Output<'_>) -> Outcome {
    let path = args.out.clone().unwrap_or_else(|| default_path(paths.name()));
    bundle::check_free(&path)?;
    let bundle = collection::collect(paths, args);
    bundle.write(&path)?;
    print(&bundle, &path, args.with_words, out)?;
    Ok(Exit::Ok)
}

fn default_path(group: &GroupName) -> PathBuf {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let time = wall_time::text(u64::try_from(now.as_nanos()).unwrap_or_default());
    let digits: String =
        time.chars().take(19).filter(|it| *it == 'T' || it.is_ascii_digit()).collect();
    format!("whichone-report-{group}-{digits}.tar.gz").into()
}

fn print(
    bundle: &Bundle,
    path: &std::path::Path,
    with_words: bool,
    out: &mut Output<'_>,
) -> Result<(), Failure> {
    if out.is_json() {
        let file = |(name, bytes): (&str, usize)| json!({ "name": name, "bytes": bytes });
        let files: Vec<_> = bundle.files().map(file).collect();
        let left = |(what, why): (&str, &str)| json!({ "what": what, "why": why });
        let left_out: Vec<_> = bundle.left_out().map(left).collect();
        return out.json(&json!({ "file": path, "files": files, "left_out": left_out }));
    }
    for (name, bytes) in bundle.files() {
        out.line(format_args!("{bytes:>9}  {name}"))?;
    }
    for (what, why) in bundle.left_out() {
        out.line(format_args!(" left out  {what}: {why}"))?;
    }
    out.line(path.display())?;
    note(match with_words {
        true => {
            "it holds what people said and who they are; keys, passwords and tokens are left out"
        }
        false => "keys, passwords, tokens and what people said are left out",
    });
    note(
        "look through it before you attach it to an issue: it holds the configuration and names of this machine",
    );
    Ok(())
}
