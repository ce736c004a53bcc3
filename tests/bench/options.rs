//! Options of the benchmark.

use crate::parts::Named;
use clap::Parser;

/// Benchmarks: all parts unless some are named
#[derive(Parser)]
#[command(name = "bench")]
pub(crate) struct Options {
    /// Also write what the named parts measure into docs/benchmarks.md
    #[arg(long, conflicts_with = "quick")]
    pub(crate) write: bool,
    /// Fewer repetitions and smaller series
    #[arg(long)]
    pub(crate) quick: bool,
    #[command(flatten)]
    pub(crate) parts: Named,
    /// Seconds that a scene of --bounds gets at last
    /// [60; 5 among all parts or with --quick]
    #[arg(long, value_name = "N")]
    seconds: Option<f64>,
    /// With --speech: the sentences and voices that are kept apart, instead of the others
    #[arg(long, requires = "speech")]
    pub(crate) kept_apart: bool,
    /// Dialogues of --turns [500] and, in each noise, of --spoken [60; 6 among all parts]
    #[arg(long, value_name = "N")]
    pub(crate) dialogues: Option<u64>,
    /// Utterances of --long [20000; 1000 among all parts]
    #[arg(long, value_name = "N")]
    pub(crate) utterances: Option<u64>,
    /// Seed of these dialogues, and of the scenes of --size
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Only this noise of --spoken: quiet, steady or babble
    #[arg(long, value_name = "NOISE", requires = "spoken")]
    pub(crate) noise: Option<SpokenNoise>,
    /// Groups that hold spoken dialogues at a time
    #[arg(long, value_name = "N", default_value_t = 3)]
    pub(crate) groups: usize,
    /// Pages of --console
    #[arg(long, value_name = "N", default_value_t = 20)]
    pub(crate) viewers: usize,
    /// How long they look on [10; 1 among all parts or with --quick]
    #[arg(long, value_name = "N")]
    pub(crate) minutes: Option<u64>,
}

impl Options {
    /// Seconds of `--bounds`.
    pub(crate) fn seconds(&self) -> f64 {
        let few = self.quick || self.wants_all();
        self.seconds.unwrap_or(if few { 5.0 } else { 60.0 })
    }

    /// Returns whether all parts are measured.
    pub(crate) fn wants_all(&self) -> bool {
        self.parts.0.is_empty()
    }
}

/// A noise under spoken dialogues.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum SpokenNoise {
    /// Steady, at 40 dB.
    Quiet,
    /// Steady, at 20 dB.
    Steady,
    /// Six people who talk to each other, at 10 dB.
    Babble,
}
