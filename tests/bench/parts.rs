//! The parts of the benchmarks. The help of `scripts/bench` repeats their names, because it builds nothing.

use crate::options::Options;
use crate::report::Report;
use crate::{
    arm, console, core, flight, hop, idle, jitter, latency, long, orders, recorder, ros1, size,
    speech, spoken, start, stops, turns,
};
use clap::{Arg, ArgAction, ArgMatches, Command};

/// A part, which `--NAME` selects.
pub(crate) struct Part {
    pub(crate) name: &'static str,
    help: &'static str,
    /// The part that measures it, too.
    within: Option<&'static str>,
    /// Measures it.
    pub(crate) measure: fn(&mut Report, &Options),
}

const PARTS: [Part; 18] = [
    part("core", "the decision core, without starting a group", |report, options| {
        let effort = if options.quick { core::Effort::QUICK } else { core::Effort::FULL };
        core::measure(report, effort);
    }),
    part(
        "bounds",
        "certified bounds on hard scenes against time; --quick: on one of each size",
        |report, options| core::bounds::measure(report, options.seconds(), options.quick),
    ),
    part(
        "kinematics",
        "the arm: inverse kinematics, motions and clearances beside other solvers",
        |report, options| arm::measure(report, options.quick),
    ),
    part(
        "processes",
        "the running group: start, recovery, latency through all processes, idle load",
        |report, _| {
            report.part = "hops";
            hop::measure(report);
            report.part = "processes";
            start::measure(report);
            latency::measure(report);
            idle::measure(report);
        },
    ),
    part(
        "hops",
        "a message between sleeping processes, beside other transports; part of --processes",
        |report, _| hop::measure(report),
    )
    .within("processes"),
    part(
        "recorder",
        "the recorder: its cost, and latencies with and without it",
        |report, options| recorder::measure(report, options.quick),
    ),
    part(
        "flight",
        "the flight recorder: its cost, latencies with and without it, and the size of flights",
        |report, options| flight::measure(report, options.quick),
    ),
    part(
        "long",
        "one interaction of very many utterances: journals, memory, restart",
        long::measure,
    ),
    part("joints", "how steadily joint states come", |report, _| jitter::measure(report)),
    part(
        "orders",
        "orders to the arm: how soon they are accepted, how steadily joint states come meanwhile",
        |report, options| orders::measure(report, options.quick),
    ),
    part("stops", "stops of the arm, in each shortage", |report, options| {
        stops::measure(report, options.quick);
    }),
    part(
        "ros1",
        "the ROS 1 bridge: from joint states to commands; needs rosmaster and rospy",
        |report, options| ros1::measure(report, options.quick),
    ),
    part(
        "speech",
        "spoken input: what is understood of spoken sentences, how late",
        |report, options| speech::measure(report, options.quick, options.kept_apart),
    ),
    part(
        "endings",
        "ends of utterances: how soon after the voice, how often in the middle of a sentence",
        |report, options| speech::measure_endings(report, options.quick),
    ),
    part(
        "turns",
        "turn-taking in simulated time: answers late, early, overlapping, doubled",
        turns::measure,
    ),
    part("console", "the console: many pages while dialogues run", console::measure),
    part("size", "groups with thousands of objects; --quick: with one thousand", size::measure),
    part("spoken", "dialogues by voice with the real group, in real time", spoken::measure),
];

const fn part(name: &'static str, help: &'static str, measure: fn(&mut Report, &Options)) -> Part {
    Part { name, help, within: None, measure }
}

impl Part {
    const fn within(self, other: &'static str) -> Self {
        Self { within: Some(other), ..self }
    }
}

/// The parts that are named; all where none is.
pub(crate) struct Named(pub(crate) Vec<&'static str>);

impl Named {
    /// The parts to measure, each once.
    pub(crate) fn selected(&self) -> impl Iterator<Item = &'static Part> {
        let is_selected = |name: &'static str| self.0.is_empty() || self.0.contains(&name);
        PARTS.iter().filter(move |part| {
            let elsewhere = part.within.is_some_and(is_selected);
            is_selected(part.name) && !elsewhere
        })
    }
}

impl clap::Args for Named {
    fn augment_args(command: Command) -> Command {
        command.args(PARTS.iter().map(|part| {
            let help = format!("Only {}", part.help);
            Arg::new(part.name).long(part.name).help(help).action(ArgAction::SetTrue)
        }))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl clap::FromArgMatches for Named {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let names = PARTS.iter().map(|part| part.name);
        Ok(Self(names.filter(|name| matches.get_flag(name)).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::PARTS;
    use std::path::Path;

    #[test]
    fn script_knows_the_parts() {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scripts/bench");
        let script = std::fs::read_to_string(script).unwrap();
        // As the script itself finds them.
        let lines = script.lines().filter_map(|line| line.strip_prefix("#   scripts/bench --"));
        let named = lines.filter(|line| line.contains(" only "));
        let mut named: Vec<&str> = named.filter_map(|line| line.split(' ').next()).collect();
        let mut parts = PARTS.map(|part| part.name);
        named.sort_unstable();
        parts.sort_unstable();
        assert_eq!(named, parts);
    }
}
