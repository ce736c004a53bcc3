//! Fuzz targets: everything that reads bytes of others. Each asserts what must hold for any input:
//! no panic, bounded results, and a round trip of what is accepted.
//!
//! They run on stable over the kept corpus and mutations of it (`tests/fuzz_corpus.rs`), and under
//! libFuzzer (`scripts/fuzz`). An input that once failed stays in `tests/fixtures/fuzz/TARGET`.

mod bytes;
mod config;
mod console;
mod control;
mod detections;
mod flight;
mod group;
mod journal;
mod language;
mod mutate;
mod payload;
mod peers;
mod robot;
mod ros1;
mod scene;
mod wav;
mod wire;
mod wyoming;

use std::path::PathBuf;

pub use mutate::Mutator;

/// A fuzz target.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name, and that of its folder in the corpus.
    pub name: &'static str,
    /// Checks one input.
    pub run: fn(&[u8]),
    /// Valid inputs to begin with, made by the code of today.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Mutations in a test run: the slower a target, the fewer.
    pub mutations: usize,
}

/// Every target.
pub const TARGETS: [Target; 16] = [
    Target { name: "journal", run: journal::run, seeds: journal::seeds, mutations: 1_000 },
    Target {
        name: "records",
        run: journal::run_records,
        seeds: journal::record_seeds,
        mutations: 500,
    },
    Target { name: "flight", run: flight::run, seeds: flight::seeds, mutations: 100 },
    Target { name: "wire", run: wire::run, seeds: wire::seeds, mutations: 4_000 },
    Target { name: "payload", run: payload::run, seeds: payload::seeds, mutations: 4_000 },
    Target { name: "peers", run: peers::run, seeds: peers::seeds, mutations: 100 },
    Target { name: "config", run: config::run, seeds: config::seeds, mutations: 300 },
    Target { name: "scene", run: scene::run, seeds: scene::seeds, mutations: 1_000 },
    Target { name: "robot", run: robot::run, seeds: robot::seeds, mutations: 500 },
    Target { name: "ros1", run: ros1::run, seeds: ros1::seeds, mutations: 1_000 },
    Target { name: "wav", run: wav::run, seeds: wav::seeds, mutations: 2_000 },
    Target { name: "console", run: console::run, seeds: console::seeds, mutations: 4_000 },
    Target { name: "control", run: control::run, seeds: control::seeds, mutations: 4_000 },
    Target { name: "detections", run: detections::run, seeds: detections::seeds, mutations: 1_000 },
    Target { name: "language", run: language::run, seeds: language::seeds, mutations: 1_000 },
    Target { name: "wyoming", run: wyoming::run, seeds: wyoming::seeds, mutations: 4_000 },
];

/// Returns a target by its name.
///
/// # Errors
/// No such target; the message lists those there are.
pub fn target(name: &str) -> Result<&'static Target, String> {
    let known = || TARGETS.map(|target| target.name).join(", ");
    let found = TARGETS.iter().find(|target| target.name == name);
    found.ok_or_else(|| {
        format!("expected a fuzz target, found `{name}`; help: use one of {}", known())
    })
}

impl Target {
    /// Folder of the kept inputs.
    pub fn corpus(&self) -> PathBuf {
        let all = concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures/fuzz");
        PathBuf::from(all).join(self.name)
    }

    /// The kept inputs by the names of their files, sorted.
    pub fn kept(&self) -> Vec<(String, Vec<u8>)> {
        let files = std::fs::read_dir(self.corpus()).into_iter().flatten().flatten();
        let mut kept: Vec<_> = files
            .filter_map(|file| {
                let bytes = std::fs::read(file.path()).ok()?;
                Some((file.file_name().to_string_lossy().into_owned(), bytes))
            })
            .collect();
        kept.sort();
        kept
    }
}
