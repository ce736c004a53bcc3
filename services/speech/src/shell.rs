//! The speech service's topics and devices.

use crate::devices::ear::{Ear, EarEvent, EarOptions, EarState as Hearing, Sound};
use crate::devices::recogniser::{Hypothesis as Decoded, Outcome, PocketSphinxOptions};
use crate::devices::vad::SegmenterOptions;
use crate::devices::voice::{Voice, VoiceEvent as Device, VoiceOptions, VoiceOutput};
use crate::{
    Config, Hypothesis, In, Line, Out, Recognised, Segment, SpeechNode, Spoken, VoiceEvent,
};
use crossbeam_channel::Receiver;
use language::{Language, Reader as TextReader};
use protocol::{
    Activity, AppliedMark, ArmStatus, EarState, Injection, MotionCommand, Presented, Receipt,
    RobotAct, Service, Utterance, topics,
};
use runtime::bus::{EncodedReader, PortError, Reader, Writer};
use runtime::device::DeviceSender;
use runtime::driver::{Context, Program, Shell};
use runtime::exit::Failure;
use runtime::lifecycle::Environment;
use settings::Settings;
use std::path::Path;

/// Speech as a program.
#[derive(Debug)]
pub struct SpeechProgram;

impl Program for SpeechProgram {
    const SERVICE: Service = Service::Speech;
    const RECORD: Option<&'static str> = Some("speech/3");
    const ABOUT: &'static str = "hears what people say or type, and says the robot's questions";
    type Node = SpeechNode;
    type Shell = SpeechShell;

    fn config(_: &Environment, settings: &Settings) -> Result<Config, Failure> {
        // The stop word is found by the careful reading whatever the dialogue is read by: it is a
        // matter of safety and not of the model.
        let reader = TextReader::new(&settings.scene, Language::Careful);
        Ok(Config {
            reader,
            utterance_bytes_max: settings.speech.utterance_bytes_max,
            gestures: settings.dialogue.gesture.enabled,
        })
    }
}

/// The speech service's topics and devices.
pub struct SpeechShell {
    injections: EncodedReader<Injection>,
    marks: Reader<AppliedMark>,
    acts: Reader<RobotAct>,
    arm: Reader<ArmStatus>,
    utterances: Writer<Utterance>,
    receipts: Writer<Receipt>,
    presented: Writer<Presented>,
    activity: Writer<Activity>,
    motion: Writer<MotionCommand>,
    ear: EarDevice,
    voice: VoiceDevice,
}

impl Shell<SpeechNode> for SpeechShell {
    fn open(context: &Context<'_, In>) -> Result<Self, Failure> {
        let bus = context.bus;
        let work = context.environment.paths.run();
        Ok(Self {
            injections: bus.encoded_reader(&topics::INJECTION)?,
            marks: bus.reader(&topics::MARK)?,
            acts: bus.reader(&topics::ACT)?,
            arm: bus.reader(&topics::STATUS)?,
            utterances: bus.writer(&topics::UTTERANCE)?,
            receipts: bus.writer(&topics::RECEIPT)?,
            presented: bus.writer(&topics::PRESENTED)?,
            activity: bus.writer(&topics::ACTIVITY)?,
            motion: bus.writer(&topics::MOTION)?,
            ear: EarDevice::start(context.settings, &work, &context.devices),
            voice: VoiceDevice::start(context.settings, &work, &context.devices),
        })
    }

    fn drain(&mut self, take: &mut dyn FnMut(In)) -> Result<(), PortError> {
        self.marks.drain(|message| take(In::Mark(*message)))?;
        self.arm.drain(|message| take(In::Arm(*message)))?;
        self.acts.drain(|message| take(In::Act(Box::new(*message))))?;
        while let Some(injection) = self.injections.take()? {
            take(In::Injection(injection));
        }
        Ok(())
    }

    fn publish(&mut self, output: Out) -> Result<(), PortError> {
        match output {
            Out::Utterance(message) => self.utterances.send(&message),
            Out::Receipt(message) => self.receipts.send(&message),
            Out::Presented(message) => self.presented.send(&message),
            Out::Activity(message) => self.activity.send(&message),
            Out::Motion(message) => self.motion.send(&message),
            Out::Recognise(sound, path) => {
                self.ear.recognise(sound, path);
                Ok(())
            }
            Out::Speak(line) => {
                self.voice.speak(&line);
                Ok(())
            }
            Out::Hush => {
                self.voice.0.interrupt();
                Ok(())
            }
        }
    }
}

/// The recogniser, where there is one.
struct EarDevice {
    ear: Option<Ear>,
    inbox: DeviceSender<In>,
}

impl EarDevice {
    fn start(settings: &Settings, work: &Path, inbox: &DeviceSender<In>) -> Self {
        let inbox = inbox.clone();
        if settings.speech.recogniser == settings::Recogniser::None {
            inbox.send(In::Ear(EarState::Off));
            return Self { ear: None, inbox };
        }
        let (ear, events) = Ear::start(&settings.scene, ear_options(settings, work));
        let translated = inbox.clone();
        forward("ear", events, move |event| translated.send(heard(event)));
        Self { ear: Some(ear), inbox }
    }

    fn recognise(&self, sound: u64, path: String) {
        let off = || "speech recognition is switched off (speech.recogniser)".to_owned();
        let taken = match &self.ear {
            Some(ear) => ear.hear(sound, Sound::File(path.into())).map_err(|e| e.to_string()),
            None => Err(off()),
        };
        if let Err(reason) = taken {
            self.inbox.send(In::Recognised(Recognised { sound, segments: Err(reason) }));
        }
    }
}

fn ear_options(settings: &Settings, work: &Path) -> EarOptions {
    let speech = &settings.speech;
    let recogniser = PocketSphinxOptions::debian(work.join("recogniser"));
    let model = speech.model_dir.clone().unwrap_or_else(|| recogniser.model.clone());
    EarOptions {
        recogniser: PocketSphinxOptions { model, ..recogniser },
        segmenter: SegmenterOptions {
            closing_pause_s: speech.closing_pause.as_secs_f64(),
            ..SegmenterOptions::default()
        },
        gate_threshold: speech.accept_score_min as f32,
        longest_s: speech.recording_max.as_secs_f64(),
    }
}

fn heard(event: EarEvent) -> In {
    match event {
        EarEvent::State(state) => In::Ear(hearing(&state)),
        EarEvent::Heard { id, segments } => {
            let segments = segments.into_iter().map(|segment| Segment {
                span_s: (segment.onset_s, segment.end_s),
                heard: understood(segment.outcome),
            });
            In::Recognised(Recognised { sound: id, segments: Ok(segments.collect()) })
        }
        EarEvent::Failed { id, error } => {
            In::Recognised(Recognised { sound: id, segments: Err(error) })
        }
    }
}

fn hearing(state: &Hearing) -> EarState {
    match state {
        Hearing::Loading => EarState::Loading,
        Hearing::Ready { unpronounceable } => {
            if !unpronounceable.is_empty() {
                tracing::warn!(?unpronounceable, "words of the scene that cannot be recognised");
            }
            EarState::Ready
        }
        Hearing::Off { reason } => {
            tracing::warn!(reason, "speech cannot be recognised; typed text works");
            EarState::Off
        }
    }
}

fn understood(outcome: Outcome) -> Result<Vec<Hypothesis>, String> {
    match outcome {
        Outcome::Accepted(decoded) => Ok(decoded.into_iter().map(hypothesis).collect()),
        Outcome::Rejected { text, reason } => {
            tracing::info!(text, ?reason, "heard, but not for the robot");
            Err(text)
        }
    }
}

fn hypothesis(decoded: Decoded) -> Hypothesis {
    Hypothesis {
        weight: f64::from(decoded.confidence.max(1e-3)),
        confidence: decoded.words.iter().map(|(_, confidence)| *confidence).collect(),
        text: decoded.text,
    }
}

/// The voice.
struct VoiceDevice(Voice);

impl VoiceDevice {
    fn start(settings: &Settings, work: &Path, inbox: &DeviceSender<In>) -> Self {
        let (voice, events) = Voice::start(VoiceOptions::of(&settings.speech, &work.join("voice")));
        let inbox = inbox.clone();
        forward("voice", events, move |event| match spoken(event) {
            Some((line, what)) => inbox.send(In::Voice(VoiceEvent { line, what })),
            None => true,
        });
        Self(voice)
    }

    fn speak(&self, line: &Line) {
        self.0.interrupt();
        if let Err(error) = self.0.speak(line.number, &line.number.to_string(), &line.text) {
            tracing::warn!(%error, "not said");
        }
    }
}

fn spoken(event: Device) -> Option<(u64, Spoken)> {
    match event {
        Device::Output(VoiceOutput::Aloud(player)) => {
            tracing::info!(program = player.program, "questions are spoken");
            None
        }
        Device::Output(VoiceOutput::Text { reason }) => {
            tracing::info!(reason, "questions are shown as text");
            None
        }
        Device::Started { id } => Some((id, Spoken::Started)),
        Device::Ended { id } => Some((id, Spoken::Ended)),
        Device::Interrupted { id } => Some((id, Spoken::Interrupted)),
        // Consoles show the text all the same, so the question counts as asked.
        Device::Failed { id, error } => {
            tracing::warn!(error, "shown as text instead of spoken");
            Some((id, Spoken::Ended))
        }
    }
}

/// Hands a device's events to the main loop until either ends.
fn forward<T: Send + 'static>(
    name: &str,
    events: Receiver<T>,
    hand_over: impl Fn(T) -> bool + Send + 'static,
) {
    let work = move || while events.recv().is_ok_and(&hand_over) {};
    if let Err(error) = std::thread::Builder::new().name(name.to_owned()).spawn(work) {
        tracing::error!(%error, name, "no thread for a device");
    }
}
