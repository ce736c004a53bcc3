//! Options of the benchmark.

use clap::Parser;
use std::path::PathBuf;

/// Benchmarks: all parts unless some are named
#[derive(Parser)]
#[command(name = "bench")]
pub(crate) struct Options {
    /// Measure nothing; compare the figures of the documents with these reports
    /// [target/bench/report.json]
    #[arg(long, value_name = "REPORT", num_args = 0.., exclusive = true)]
    pub(crate) compare: Option<Vec<PathBuf>>,
    /// Measure nothing; write the figures of these reports into the documents
    /// [target/bench/report.json]
    #[arg(long, value_name = "REPORT", num_args = 0.., exclusive = true)]
    pub(crate) write: Option<Vec<PathBuf>>,
    /// Measure that many times; the report holds every run
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) runs: usize,
    /// Fewer repetitions and smaller series
    #[arg(long)]
    pub(crate) quick: bool,
    /// Only the decision core, without starting a group
    #[arg(long)]
    pub(crate) core: bool,
    /// Only certified bounds on hard scenes against time; --quick: on one of each size
    #[arg(long)]
    pub(crate) bounds: bool,
    /// Seconds that a scene of --bounds gets at last
    /// [60; 5 among all parts or with --quick]
    #[arg(long, value_name = "N")]
    seconds: Option<f64>,
    /// Only the arm: inverse kinematics, motions and clearances beside other solvers
    #[arg(long)]
    pub(crate) kinematics: bool,
    /// Only the running group: start, recovery, latency through all processes, idle load
    #[arg(long)]
    pub(crate) processes: bool,
    /// Only a message between sleeping processes, beside other transports; part of --processes
    #[arg(long)]
    pub(crate) hops: bool,
    /// Only the recorder: its cost, and latencies with and without it
    #[arg(long)]
    pub(crate) recorder: bool,
    /// Only the flight recorder: its cost, latencies with and without it, and the size of flights
    #[arg(long)]
    pub(crate) flight: bool,
    /// Only one interaction of very many utterances: journals, memory, restart
    #[arg(long)]
    pub(crate) long: bool,
    /// Only how steadily joint states come
    #[arg(long)]
    pub(crate) joints: bool,
    /// Only orders to the arm: how soon they are accepted, how steadily joint states come meanwhile
    #[arg(long)]
    pub(crate) orders: bool,
    /// Only the ROS 1 bridge: from joint states to commands; needs rosmaster and rospy
    #[arg(long)]
    pub(crate) ros1: bool,
    /// Only spoken input: what is understood of spoken sentences, how late
    #[arg(long)]
    pub(crate) speech: bool,
    /// With --speech: the sentences and voices that are kept apart, instead of the others
    #[arg(long, requires = "speech")]
    pub(crate) kept_apart: bool,
    /// Only ends of utterances: how soon after the voice, how often in the middle of a sentence
    #[arg(long)]
    pub(crate) endings: bool,
    /// Only stops of the arm, in each shortage
    #[arg(long)]
    pub(crate) stops: bool,
    /// Only turn-taking in simulated time: answers late, early, overlapping, doubled
    #[arg(long)]
    pub(crate) turns: bool,
    /// Only the console: many pages while dialogues run
    #[arg(long)]
    pub(crate) console: bool,
    /// Only groups with thousands of objects; --quick: with one thousand
    #[arg(long)]
    pub(crate) size: bool,
    /// Only dialogues by voice with the real group, in real time
    #[arg(long)]
    pub(crate) spoken: bool,
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

    /// Returns whether all parts are selected.
    pub(crate) fn wants_all(&self) -> bool {
        let Self { core, bounds, kinematics, processes, long, joints, orders, stops, ros1, .. } =
            *self;
        let Self { hops, speech, endings, turns, console, size, spoken, recorder, flight, .. } =
            *self;
        let measured =
            core || bounds || kinematics || processes || long || joints || orders || stops || ros1;
        !(measured
            || hops
            || speech
            || endings
            || turns
            || console
            || size
            || spoken
            || recorder
            || flight)
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
