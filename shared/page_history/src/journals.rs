//! Reading of the group's journals, each by its service's own program.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::Stdio;

use messages::Service;
use service::group::GroupPaths;
use service::journal_record::JournalLine;
use service::{kept_settings, launch};

/// Follows the journals of speech, policy and arm.
#[derive(Debug)]
pub(super) struct Journals {
    paths: GroupPaths,
    /// Effects before causes: references of a later one are then in an earlier one.
    followed: [Followed; 3],
}

/// A journal that has been read up to a record.
#[derive(Debug)]
struct Followed {
    service: Service,
    /// The next record.
    next: u64,
    /// Length and time of the last change of the file when it was last read.
    seen: Option<(u64, std::time::SystemTime)>,
}

impl Journals {
    pub(super) fn new(paths: GroupPaths) -> Self {
        let followed = [Service::Arm, Service::Policy, Service::Speech];
        let followed = followed.map(|service| Followed { service, next: 1, seen: None });
        Self { paths, followed }
    }

    /// Reads new records: of speech, of the policy, of the arm.
    pub(super) fn read(&mut self) -> [Vec<JournalLine>; 3] {
        let Self { paths, followed } = self;
        let [arm, policy, speech] = followed.each_mut().map(|journal| journal.read(paths));
        [speech, policy, arm]
    }
}

impl Followed {
    fn read(&mut self, paths: &GroupPaths) -> Vec<JournalLine> {
        let file = paths.journal_file(self.service.name());
        let Ok(found) = fs::metadata(&file) else { return Vec::new() };
        let seen = found.modified().ok().map(|modified| (found.len(), modified));
        if seen.is_some() && seen == self.seen {
            return Vec::new();
        }
        match self.list(paths, file) {
            Ok(lines) => {
                self.seen = seen;
                self.next = lines.last().map_or(self.next, |last| last.seq + 1);
                lines
            }
            Err(error) => {
                tracing::debug!(%error, service = self.service.name(), "journal not read");
                Vec::new()
            }
        }
    }

    /// Has the service's program list its journal.
    fn list(&self, paths: &GroupPaths, file: PathBuf) -> std::io::Result<Vec<JournalLine>> {
        let mut command = launch::command(launch::program_of(self.service.name()));
        command.arg("journal").arg(file).args(["--json", "--since", &self.next.to_string()]);
        for folder in std::iter::once(paths.run()).chain(kept_settings::folders(paths)) {
            command.arg("--settings").arg(folder);
        }
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = command.spawn()?;
        let lines = child.stdout.take().map(BufReader::new).into_iter().flat_map(BufRead::lines);
        // A record of another version is skipped.
        let lines = lines.map_while(Result::ok).filter_map(|line| serde_json::from_str(&line).ok());
        let lines = lines.collect();
        child.wait()?;
        Ok(lines)
    }
}
