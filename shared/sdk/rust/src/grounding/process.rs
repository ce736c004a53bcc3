//! A grounder as the group's service `grounding`.

use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::process::ExitCode;

use messages::topics::{self, WINDOW};
use messages::{Observation, Service, Utterance};
use runtime::bus::{Bus, PortError, Reader, WakeListener, Writer};
use runtime::clock;
use runtime::exit::Failure;
use runtime::lifecycle::{Cycle, Health, Ready, Sources};
use runtime::port_failures::PortFailures;
use runtime::{Span, Time};
use scene::Scene;

use super::worker::Worker;
use super::{Grounder, Heard};
use crate::service::{Context, serve};

/// Inputs are polled this often even if a wake-up was lost.
const LOOK_EVERY: Span = Span::from_ms(500);
/// Longest work on one utterance before the service counts as stuck, and is restarted by its supervisor.
const WORK_MAX: Span = Span::from_ms(30_000);

/// Runs the grounder as the group's service `grounding` until the supervisor ends it. Returns the exit code.
///
/// The grounder runs on a thread of its own, and the service beats meanwhile. An answer that is invalid (a word that
/// the scene does not have, weights that do not sum to 1) is logged, and nothing counts as understood.
pub fn run(grounder: impl Grounder + Send + 'static) -> ExitCode {
    run_with(|_| Ok(grounder))
}

/// As [`run`], with a grounder that is made for the group's scene and the program's arguments.
pub fn run_with<G: Grounder + Send + 'static>(
    make: impl FnOnce(&Context) -> Result<G, Failure>,
) -> ExitCode {
    serve(|context| {
        let worker = Worker::start(make(context)?, context.scene().clone()).map_err(|error| {
            Failure::new(runtime::exit::Exit::NotReached, format!("grounder's thread: {error}"))
        })?;
        let bus = context.bus();
        Ok(Process {
            listener: bus.wake_listener(Service::Grounding)?,
            utterances: bus.reader(&topics::UTTERANCE)?,
            observations: bus.writer(&topics::OBSERVATION)?,
            worker,
            answered: VecDeque::new(),
            failures: PortFailures::default(),
            bus: context.bus_handle(),
            scene: context.scene().clone(),
            is_ending: false,
        })
    })
}

struct Process {
    listener: WakeListener,
    utterances: Reader<Utterance>,
    observations: Writer<Observation>,
    worker: Worker,
    /// The latest answers: an utterance that is sent again gets the same one.
    answered: VecDeque<(Box<Utterance>, Box<Observation>)>,
    failures: PortFailures,
    bus: std::rc::Rc<Bus>,
    scene: Scene,
    is_ending: bool,
}

impl Cycle for Process {
    fn listener(&self) -> &WakeListener {
        &self.listener
    }

    fn wake(&self, now: Time) -> (Sources<'_>, Time) {
        ([Some(self.worker.fd()), None, None], now + LOOK_EVERY)
    }

    fn shut_down(&mut self) {
        self.is_ending = true;
    }

    fn pass(&mut self, ready: Ready) -> Result<ControlFlow<()>, Failure> {
        if ready.by_wake
            && let Some(joined) = self.listener.take()
        {
            self.bus.connect(joined);
        }
        if self.is_ending {
            return Ok(ControlFlow::Break(()));
        }
        let failed = self.take_in()?.err();
        let failed = failed.or(self.publish()?.err());
        self.failures.judge(failed, clock::now())?;
        Ok(ControlFlow::Continue(()))
    }

    fn health(&mut self, now: Time) -> Health {
        let since = self.worker.pending_since();
        match since.is_some_and(|since| now.since(since) > WORK_MAX) {
            true => Health::Stuck,
            false => Health::Working(since),
        }
    }

    fn shortage(&self) -> Option<&str> {
        self.failures.shortage()
    }
}

impl Process {
    /// Gives utterances to the grounder, and answers those at once that it has answered.
    fn take_in(&mut self) -> Result<Result<(), PortError>, Failure> {
        let Self { utterances, observations, worker, answered, scene, .. } = self;
        let mut sent = Ok(());
        let mut given = Ok(());
        let read = utterances.drain(|utterance| {
            match answered.iter().find(|(known, _)| **known == *utterance) {
                Some((_, observation)) => sent = observations.send(observation),
                None if Heard::new(utterance, scene).is_ok() => {
                    let worked = worker.give(utterance, clock::now());
                    given = std::mem::replace(&mut given, Ok(())).and(worked);
                }
                // Speech sends it again; a broken sender shows in its input age.
                None => tracing::warn!(seq = utterance.seq, "utterance refused"),
            }
        });
        given.map(|()| read.and(sent))
    }

    /// Publishes what the grounder has answered.
    fn publish(&mut self) -> Result<Result<(), PortError>, Failure> {
        let mut sent = Ok(());
        while let Some((utterance, observation)) = self.worker.take()? {
            let Some(observation) = observation else { continue };
            sent = sent.and(self.observations.send(&observation));
            self.answered.push_back((utterance, observation));
            if self.answered.len() > WINDOW {
                self.answered.pop_front();
            }
        }
        Ok(sent)
    }
}
