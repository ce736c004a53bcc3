//! A grounder with one fault, which its first argument names: `--fault NAME`. `whichone conform` finds each.

#![expect(clippy::unwrap_used, reason = "a fixture fails loudly")]

use std::ops::ControlFlow;
use std::process::ExitCode;
use std::time::Duration;

use messages::{AudioChunk, Code, Epoch, Incarnation, Observation, Service, Utterance, topics};
use runtime::bus::{Bus, Identity, Reader, WakeListener, Writer};
use runtime::clock;
use runtime::exit::{Exit, Failure};
use runtime::lifecycle::{Cycle, Environment, Health, Lifecycle, Ready, Sources, drive};
use runtime::notify::Notifier;
use runtime::{Span, Time};
use scene::{Intent, Reading, Scene, WordId};
use whichone_sdk::grounding::{Grounded, Grounder, Heard, certain, observation};
use whichone_sdk::{Hypothesis, Interpretation, Question, settings};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [flag, fault] = &arguments[..] else { return Exit::Usage.code() };
    assert_eq!(flag, "--fault");
    let environment = Environment::read(Vec::new()).unwrap();
    match fault.as_str() {
        "exits-at-once" => return ExitCode::from(3),
        "never-ready" => forever(|| {}),
        "survives-its-supervisor" => survive_all(),
        "dies-when-restarted" if environment.incarnation.0 > 1 => return ExitCode::from(4),
        _ => {}
    }
    let lifecycle = Lifecycle::begin(&environment.paths).unwrap();
    let mut broken = BrokenGrounder::open(fault, &environment);
    match drive(lifecycle, &mut broken) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.exit.code(),
    }
}

fn forever(mut act: impl FnMut()) -> ! {
    loop {
        act();
        std::thread::sleep(Duration::from_millis(100));
    }
}

/// Is ready and beats, whatever becomes of its supervisor.
fn survive_all() -> ! {
    let mut notifier = Notifier::from_environment().unwrap();
    notifier.say("READY=1");
    forever(|| notifier.beat("WATCHDOG=1"))
}

/// Understands that the first word of the scene was said.
struct FirstWord<'a> {
    fault: &'a str,
    count: u64,
}

impl Grounder for FirstWord<'_> {
    fn read(&mut self, _: &Hypothesis, _: Question, _: &Scene) -> Vec<(f64, Reading)> {
        let word = if self.fault == "invents-words" { 999 } else { 0 };
        certain(Reading { base: vec![WordId(word)], ..Reading::default() })
    }

    fn ground(&mut self, heard: &Heard, scene: &Scene) -> Grounded {
        let fault = self.fault;
        let places = (0..heard.questions.len()).map(Some).chain([None]);
        let places = places.filter(|place| fault != "ignores-questions" || place.is_none());
        let weight = if self.fault == "halves-weights" { 0.5 } else { 1.0 };
        let hypothesis = Hypothesis::certain("");
        let readings = places.map(|answers| {
            let (_, mut reading) = self.read(&hypothesis, Question::None, scene).remove(0);
            if self.fault == "changes-its-mind" && self.count % 2 == 1 {
                reading.intent = Intent::Greet;
            }
            Interpretation { weight, answers, reading }
        });
        let interpretations = readings.collect();
        self.count += 1;
        Grounded { interpretations, unknown: None }
    }
}

struct BrokenGrounder<'a> {
    fault: &'a str,
    reader: FirstWord<'a>,
    scene: Scene,
    listener: WakeListener,
    utterances: Reader<Utterance>,
    /// Of the next epoch.
    others: Reader<Utterance>,
    observations: Writer<Observation>,
    audio: Writer<AudioChunk>,
    is_ending: bool,
    _buses: [Bus; 3],
}

impl<'a> BrokenGrounder<'a> {
    fn open(fault: &'a str, environment: &Environment) -> Self {
        let Environment { paths, epoch, incarnation, .. } = environment;
        let own = Identity { epoch: *epoch, incarnation: *incarnation };
        let next_epoch = Identity { epoch: Epoch(epoch.0 + 1), ..own };
        let stamped = match fault {
            "forgets-its-epoch" => next_epoch,
            "forgets-its-incarnation" => Identity { incarnation: Incarnation(77), ..own },
            _ => own,
        };
        let open = |identity| Bus::open(paths, "grounding", identity).unwrap();
        let buses = [open(own), open(next_epoch), open(stamped)];
        Self {
            fault,
            reader: FirstWord { fault, count: 0 },
            scene: settings::scene(paths).unwrap(),
            listener: buses[0].wake_listener(Service::Grounding).unwrap(),
            utterances: buses[0].reader(&topics::UTTERANCE).unwrap(),
            others: buses[1].reader(&topics::UTTERANCE).unwrap(),
            observations: buses[2].writer(&topics::OBSERVATION).unwrap(),
            audio: buses[0].writer(&topics::AUDIO).unwrap(),
            is_ending: false,
            _buses: buses,
        }
    }

    fn answer(&mut self, utterance: &Utterance) {
        match self.fault {
            "is-silent" => return,
            "is-slow" => std::thread::sleep(Duration::from_millis(1_300)),
            "trusts-its-input" => drop(Heard::new(utterance, &self.scene).unwrap()),
            "speaks-for-users" => self.audio.send(&AudioChunk::default()).unwrap(),
            _ => {}
        }
        let Ok(observed) = observation(&mut self.reader, &self.scene, utterance, clock::now())
        else {
            return;
        };
        let observed = match self.fault {
            "renumbers" => Observation { seq: observed.seq + 1_000_000, ..observed },
            "drops-fields" => Observation { accepted_ns: 0, ..observed },
            "mistakes-the-scene" => Observation { scene_key: 1, ..observed },
            "invents-codes" => Observation { source: Code::from_raw(99), ..observed },
            _ => observed,
        };
        self.observations.send(&observed).unwrap();
    }
}

impl Cycle for BrokenGrounder<'_> {
    fn listener(&self) -> &WakeListener {
        &self.listener
    }

    fn wake(&self, now: Time) -> (Sources<'_>, Time) {
        ([None, None, None], now + Span::from_ms(100))
    }

    fn shut_down(&mut self) {
        self.is_ending = self.fault != "ignores-requests-to-end";
    }

    fn pass(&mut self, _: Ready) -> Result<ControlFlow<()>, Failure> {
        self.listener.take();
        if self.is_ending && self.fault == "fails-at-its-end" {
            return Err(Failure::new(Exit::NotReached, ""));
        }
        if self.is_ending {
            return Ok(ControlFlow::Break(()));
        }
        let mut heard: Vec<Box<Utterance>> = Vec::new();
        self.utterances.drain(|one| heard.push(Box::new(*one)))?;
        if self.fault == "answers-the-latest" {
            std::thread::sleep(Duration::from_millis(30));
            self.utterances.drain(|one| heard.push(Box::new(*one)))?;
            heard = heard.pop().into_iter().collect();
        }
        if self.fault == "believes-any-epoch" {
            self.others.drain(|one| heard.push(Box::new(*one)))?;
        }
        heard.iter().for_each(|one| self.answer(one));
        Ok(ControlFlow::Continue(()))
    }

    fn health(&mut self, _: Time) -> Health {
        if self.fault == "is-without-beats" { Health::Stuck } else { Health::Working(None) }
    }
}
