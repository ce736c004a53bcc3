//! Identity of a build, wherever one is stated: `--version`, status, logs, metrics, recordings, flights.
//!
//! The version and the target are constants. Commit and features belong to the program that is linked, which
//! [`register`]s them first of all: a constant here would rebuild every crate at each commit.

use std::fmt;
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

/// Version of the workspace, as in `Cargo.toml`.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Target triple of the build.
pub const TARGET: &str = env!("WHICHONE_TARGET");

static REGISTERED: OnceLock<BuildInfo> = OnceLock::new();

/// A build of the programs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BuildInfo {
    /// Version of the workspace.
    pub version: String,
    /// Commit of the sources, abbreviated. None if it is unknown, as in a build from an archive without it. Changes
    /// that were not committed do not show.
    pub commit: Option<String>,
    /// Day of that commit, YYYY-MM-DD.
    pub date: Option<String>,
    /// Optional features that are compiled in, sorted.
    pub features: Vec<String>,
    /// Target triple.
    pub target: String,
}

/// Registers the identity of the linked program; the first call counts. `commit` is a hash and a day,
/// separated by a space.
pub fn register(commit: Option<&str>, features: impl IntoIterator<Item = &'static str>) {
    let _ = REGISTERED.set(BuildInfo::new(commit, features));
}

/// Returns the identity of this build. Without a registration, as in a service that is built as a program of its own,
/// commit and features are unknown.
pub fn current() -> &'static BuildInfo {
    static ANONYMOUS: OnceLock<BuildInfo> = OnceLock::new();
    REGISTERED.get().unwrap_or_else(|| ANONYMOUS.get_or_init(|| BuildInfo::new(None, [])))
}

/// Returns the version with its commit in one word, for columns and headers: see [`BuildInfo::full`].
pub fn full_version() -> String {
    current().full()
}

impl BuildInfo {
    fn new(commit: Option<&str>, features: impl IntoIterator<Item = &'static str>) -> Self {
        let (commit, date) = match commit.map(|text| text.split_once(' ').unwrap_or((text, ""))) {
            Some((commit, date)) => (Some(commit), Some(date).filter(|date| !date.is_empty())),
            None => (None, None),
        };
        let mut features: Vec<String> = features.into_iter().map(str::to_owned).collect();
        features.sort_unstable();
        Self {
            version: VERSION.to_owned(),
            commit: commit.map(str::to_owned),
            date: date.map(str::to_owned),
            features,
            target: TARGET.to_owned(),
        }
    }

    /// Returns the version with day and commit as build metadata, `0.1.0+20261130.4fd360ed3a1b`; without a known commit
    /// the version alone.
    pub fn full(&self) -> String {
        let day = self.date.as_deref().map(|date| format!("{}.", date.replace('-', "")));
        match &self.commit {
            Some(commit) => format!("{}+{}{commit}", self.version, day.unwrap_or_default()),
            None => self.version.clone(),
        }
    }
}

impl fmt::Display for BuildInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let commit = self.commit.as_deref().unwrap_or("unknown");
        write!(f, "{} (commit {commit}", self.version)?;
        if let Some(date) = &self.date {
            write!(f, " of {date}")?;
        }
        write!(f, ", {}", self.target)?;
        if !self.features.is_empty() {
            write!(f, ", with {}", self.features.join(", "))?;
        }
        f.write_str(")")
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;

    #[test]
    fn build_is_stated_in_a_line_and_in_a_word() {
        let build = BuildInfo::new(Some("4fd360ed3a1b 2026-11-30"), ["zenoh", "dds"]);
        assert_eq!(
            build.to_string(),
            format!("{VERSION} (commit 4fd360ed3a1b of 2026-11-30, {TARGET}, with dds, zenoh)")
        );
        assert_eq!(build.full(), format!("{VERSION}+20261130.4fd360ed3a1b"));
        let json = serde_json::to_string(&build).unwrap();
        assert_eq!(serde_json::from_str::<BuildInfo>(&json).unwrap(), build);
    }

    #[test]
    fn unknown_commit_is_called_unknown() {
        let build = BuildInfo::new(None, []);
        assert_eq!(build.to_string(), format!("{VERSION} (commit unknown, {TARGET})"));
        assert_eq!(build.full(), VERSION);
        assert_eq!(BuildInfo::new(Some("4fd360ed"), []).full(), format!("{VERSION}+4fd360ed"));
    }

    #[test]
    fn target_is_a_triple() {
        assert!(TARGET.starts_with(std::env::consts::ARCH), "{TARGET}");
    }
}
