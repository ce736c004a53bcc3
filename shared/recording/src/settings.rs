//! `[recorder]` of `group.toml`: space and content of the recordings.

use std::time::Duration;

use config::Section;
use diagnostics::Fields;

/// The recorder's ring of files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recorder {
    /// Bytes of all files together; the oldest are deleted.
    pub bytes_max: u64,
    /// Age at which a file is deleted.
    pub age_max: Duration,
    /// Time after which the next file begins.
    pub file_max: Duration,
    /// Space of the disk that recording leaves free, bytes; it pauses below.
    pub free_min: u64,
    /// Whether sound that clients stream is recorded.
    pub sound: bool,
}

impl Section for Recorder {
    const KEY: &'static [&'static str] = &["group", "recorder"];

    fn read(f: &mut Fields<'_>) -> Self {
        Self {
            bytes_max: f.whole::<u64>("mib_max", 8..=1 << 24) << 20,
            age_max: f.seconds("age_max_h", 0.01..=87_600.0) * 3600,
            file_max: f.seconds("file_minutes", 0.05..=1440.0) * 60,
            free_min: f.whole::<u64>("free_min_mib", 0..=1 << 24) << 20,
            sound: f.flag("sound"),
        }
    }
}
