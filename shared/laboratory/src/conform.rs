//! `conform`: tests a service against the contract of its kind, in a group of its own.

use std::time::{Duration, Instant};

use command_line::Outcome;
use command_line::configuration;
use command_line::interrupt::Interrupt;
use command_line::output::{Ink, Output};
use messages::{Epoch, Service, Topic};
use recording::log_tail::LogFile;
use serde_json::{Value as Json, json};
use service::bus::{BusError, PortError};
use service::exit::{Exit, Failure};

use crate::args::ConformArgs;
use bench::{Bench, Written};
use subject::{Subject, WATCHDOG};

mod bench;
mod grounding;
mod rules;
mod subject;

/// Timeout for the first publication of a service with no known inputs.
const PUBLISHES_WITHIN: Duration = Duration::from_millis(800);
/// Lines of the service's log that are shown if a rule is broken.
const LOG_LINES: usize = 8;
/// Pause after a message that makes no sense: a reader that holds one sees each.
const PAUSE: Duration = Duration::from_millis(20);

/// A rule that holds.
pub(super) enum Kept {
    /// A finding.
    Fact(String),
    /// The reason why there is nothing to test.
    NotApplicable(String),
}

/// A rule that does not hold.
#[derive(Debug)]
pub(super) struct Broken {
    what: String,
    help: String,
}

impl Broken {
    fn new(what: impl Into<String>, help: impl Into<String>) -> Self {
        Self { what: what.into(), help: help.into() }
    }
}

/// The test itself cannot continue.
impl From<Failure> for Broken {
    fn from(failure: Failure) -> Self {
        let help = "free shared memory and descriptors, then test again";
        Self::new(format!("not tested: {failure}"), help)
    }
}

impl From<BusError> for Broken {
    fn from(error: BusError) -> Self {
        Failure::from(error).into()
    }
}

impl From<PortError> for Broken {
    fn from(error: PortError) -> Self {
        Failure::from(error).into()
    }
}

/// A rule of the contract.
struct Rule {
    name: &'static str,
    about: &'static str,
    test: fn(&mut Test<'_>) -> Result<Kept, Broken>,
}

const fn rule(
    name: &'static str,
    about: &'static str,
    test: fn(&mut Test<'_>) -> Result<Kept, Broken>,
) -> Rule {
    Rule { name, about, test }
}

/// Rules for every service, but for its end.
const FOR_ALL: [Rule; 6] = [
    rule("ready", "reports READY=1 within its start deadline", rules::ready),
    rule("beats", "sends heartbeats while nothing happens", rules::beats),
    rule("identity", "stamps its messages with its epoch and incarnation", rules::identity),
    rule("topics", "writes its own topics alone", rules::own_topics),
    rule("malformed", "survives messages that make no sense", rules::malformed),
    rule("restart", "starts again after kill -9", rules::restart),
];

/// Rules for the end of every service.
const ENDS: [Rule; 2] = [
    rule("stop", "ends with code 0 on SIGTERM", rules::stop),
    rule("orphan", "ends when its supervisor is gone", rules::orphan),
];

/// Returns the rules for the service, in the order in which they are tested.
fn rules_of(service: Service) -> Vec<&'static Rule> {
    let own: &[Rule] = if service == Service::Grounding { &grounding::RULES } else { &[] };
    FOR_ALL.iter().chain(own).chain(&ENDS).collect()
}

/// Tests the service, and prints a line for each rule.
pub fn conform(args: &ConformArgs, out: &mut Output<'_>) -> Outcome {
    let service = Service::named(&args.service);
    let rules = chosen(args, service)?;
    let settings = configuration::settings(&args.config)?;
    let interrupt = Interrupt::listen()?;
    let bench = Bench::new(settings, &args.service)?;
    let mut test = Test::new(bench, &args.command);
    // A command that cannot be started is a wrong command line, not a broken rule.
    test.start()?;
    let (mut results, mut broken) = (Vec::new(), 0);
    for rule in rules {
        if interrupt.is_requested() {
            return Err(Failure::new(Exit::NotReached, "interrupted"));
        }
        let began = Instant::now();
        let result = (rule.test)(&mut test);
        broken += usize::from(result.is_err());
        if !out.is_json() {
            out.line(line(rule, &result, out))?;
        }
        results.push(as_json(rule, &result, began.elapsed()));
    }
    let log = LogFile::new(&args.service, test.bench.log_file()).last_lines(LOG_LINES);
    let log = log.unwrap_or_default();
    let is_kept = broken == 0;
    if out.is_json() {
        let command = &args.command;
        out.json(&json!({
            "service": args.service, "command": command, "ok": is_kept, "rules": results,
            "log": if is_kept { Vec::new() } else { log },
        }))?;
    } else if is_kept {
        out.line(format_args!("{} keeps the contract", args.service))?;
    } else {
        for text in log {
            out.line(format_args!("  log: {text}"))?;
        }
        let broken = scene::count(broken, "rule");
        out.line(format_args!("{} breaks {broken} of {}", args.service, results.len()))?;
    }
    Ok(if is_kept { Exit::Ok } else { Exit::NotReached })
}

/// Returns the rules that the command line names; all rules if it names none.
fn chosen(args: &ConformArgs, service: Service) -> Result<Vec<&'static Rule>, Failure> {
    let all = rules_of(service);
    let names = || all.iter().map(|rule| rule.name);
    for wanted in &args.rules {
        if !names().any(|name| name == wanted) {
            let help = diagnostics::suggestion(wanted, names(), || {
                format!("use one of {}", names().collect::<Vec<_>>().join(", "))
            });
            let what = format!("no rule `{wanted}` for {}; help: {help}", args.service);
            return Err(Failure::new(Exit::Usage, what));
        }
    }
    let is_chosen =
        |rule: &&Rule| args.rules.is_empty() || args.rules.iter().any(|wanted| wanted == rule.name);
    Ok(all.into_iter().filter(is_chosen).collect())
}

fn line(rule: &Rule, result: &Result<Kept, Broken>, out: &Output<'_>) -> String {
    let (mark, ink, text) = match result {
        Ok(Kept::Fact(fact)) => ("pass", Ink::Green, format!("{} ({fact})", rule.about)),
        Ok(Kept::NotApplicable(why)) => ("skip", Ink::Dim, format!("{} ({why})", rule.about)),
        Err(Broken { what, help }) => ("FAIL", Ink::Red, format!("{what}; help: {help}")),
    };
    format!("{} {:<9} {text}", out.style().paint(ink, mark), rule.name)
}

fn as_json(rule: &Rule, result: &Result<Kept, Broken>, took: Duration) -> Json {
    let (ok, found, help) = match result {
        Ok(Kept::Fact(found)) => (Json::from(true), found, Json::Null),
        Ok(Kept::NotApplicable(why)) => (Json::Null, why, Json::Null),
        Err(Broken { what, help }) => (Json::from(false), what, help.as_str().into()),
    };
    json!({ "rule": rule.name, "about": rule.about, "ok": ok, "found": found, "help": help,
            "seconds": took.as_secs_f64() })
}

/// The service under test in its group.
pub(super) struct Test<'a> {
    bench: Bench,
    command: &'a [String],
    subject: Option<Subject>,
    /// Incarnation of the latest start.
    incarnation: u32,
    /// Whether a start has led to nothing: further ones would, too, after the same time.
    is_given_up: bool,
    /// Messages written so far, other than the tester's own.
    written: Vec<Written>,
    /// The tester's topics, in the place of speech and policy.
    speaking: Option<grounding::Speaking>,
}

impl<'a> Test<'a> {
    fn new(bench: Bench, command: &'a [String]) -> Self {
        let (subject, incarnation, is_given_up) = (None, 0, false);
        let (written, speaking) = (Vec::new(), None);
        Self { bench, command, subject, incarnation, is_given_up, written, speaking }
    }

    /// Starts the next incarnation.
    fn start(&mut self) -> Result<(), Failure> {
        self.note_written()?;
        self.incarnation += 1;
        self.subject = Some(Subject::start(&self.bench, self.command, self.incarnation)?);
        Ok(())
    }

    /// Returns the service, ready; starts it if it does not run.
    fn running(&mut self) -> Result<&mut Subject, Broken> {
        if self.is_given_up {
            return Err(Broken::new("not tested: it has not become ready", "mend that first"));
        }
        if self
            .subject
            .as_mut()
            .is_none_or(|subject| subject.exit().is_some_and(|_| subject.ready.is_some()))
        {
            self.forget();
            self.start()?;
        }
        let patience = self.start_deadline();
        let subject = self.subject.as_mut().expect("just started");
        if subject.wait(patience, |subject| subject.ready.is_some()) {
            return Ok(self.subject.as_mut().expect("just started"));
        }
        let broken = match subject.exit() {
            Some(exit) => Broken::new(
                format!("expected READY=1, found its end: {exit}"),
                rules::of_exit(exit),
            ),
            None => Broken::new(
                format!("expected READY=1 within {}, found none", rules::seconds(patience)),
                "send READY=1 to $NOTIFY_SOCKET once its topics are open",
            ),
        };
        self.is_given_up = true;
        self.forget();
        Err(broken)
    }

    /// Lets go of a process that has ended or is to end.
    fn forget(&mut self) {
        self.subject = None;
        self.bench.clean_dead();
    }

    fn start_deadline(&self) -> Duration {
        self.configured().map_or(Duration::from_secs(10), |service| service.start_deadline)
    }

    fn stop_deadline(&self) -> Duration {
        self.configured().map_or(Duration::from_secs(5), |service| service.stop_deadline)
    }

    fn configured(&self) -> Option<&config::ServiceConfig> {
        let mut all = self.bench.settings.group.services.iter();
        all.find(|service| service.name == self.bench.service.name())
    }

    /// Topics that the service reads: those of the table, and those of the configuration.
    fn read_topics(&self) -> Vec<Topic> {
        let configured = self.configured().into_iter().flat_map(|service| &service.reads);
        let configured = configured.filter_map(|name| Topic::named(name));
        rules::table_reads(self.bench.service).chain(configured).collect()
    }

    fn is_of_service(&self, topic: &Topic) -> bool {
        topic.writer == Some(self.bench.service)
    }

    /// Whether the service has a part in writing this topic.
    fn may_write(&self, topic: &Topic) -> bool {
        let of_part = config::part_service(self.bench.service.name());
        let is_client = topic.writer.is_none()
            && (self.bench.service == Service::Console || of_part.is_some_and(|it| it.is_client));
        let is_configured =
            self.configured().is_some_and(|it| it.writes.iter().any(|it| it == topic.name));
        is_client || is_configured || self.is_of_service(topic)
    }

    /// Makes the service do the work of its kind.
    fn exercise(&mut self) -> Result<(), Broken> {
        self.running()?;
        if self.bench.service == Service::Grounding {
            // Wrong answers are for other rules.
            return grounding::exercise(self);
        }
        self.survives("while nothing happened", PUBLISHES_WITHIN)
    }

    /// Takes note of messages written by others than the tester.
    fn note_written(&mut self) -> Result<(), Failure> {
        let read = self.read_topics();
        self.written.extend(self.bench.written(&read)?);
        Ok(())
    }

    /// Watches the service for a while.
    fn survives(&mut self, what: &str, patience: Duration) -> Result<(), Broken> {
        let Some(subject) = &mut self.subject else { return Ok(()) };
        if subject.wait(patience, |subject| subject.exit().is_some()) {
            return Err(self.died(what));
        }
        Ok(())
    }

    /// The service has ended without a request.
    fn died(&mut self, what: &str) -> Broken {
        let exit = self.subject.as_mut().and_then(Subject::exit);
        let found = exit.map_or("its end".to_owned(), |exit| exit.to_string());
        let help = exit.map_or("see its log", rules::of_exit);
        self.forget();
        Broken::new(format!("expected it to run on {what}, found {found}"), help)
    }

    /// Waits for a heartbeat.
    fn beats_again(&mut self, what: &str) -> Result<(), Broken> {
        let subject = self.running()?;
        subject.beats.clear();
        if subject.wait(WATCHDOG, |subject| !subject.beats.is_empty()) {
            return Ok(());
        }
        if subject.exit().is_some() {
            return Err(self.died(what));
        }
        let what =
            format!("expected a heartbeat within {} {what}, found none", rules::seconds(WATCHDOG));
        Err(Broken::new(what, "send WATCHDOG=1 to $NOTIFY_SOCKET from the main loop"))
    }

    /// Writes bytes to a topic that the service reads, as its writer of `epoch`.
    fn inject(
        &mut self,
        topic: &Topic,
        epoch: Epoch,
        all: &[(&'static str, Vec<u8>)],
    ) -> Result<(), Broken> {
        // Topics have one writer at a time.
        self.speaking = None;
        let bus = self.bench.bus(topic.writer.map_or("client", Service::name), epoch)?;
        let writer = bus.raw_writer(topic)?;
        for (what, bytes) in all {
            writer.send(bytes)?;
            bus.wake_readers_of(topic)?;
            self.survives(&format!("after {what} on {}", topic.name), PAUSE)?;
        }
        Ok(())
    }
}
