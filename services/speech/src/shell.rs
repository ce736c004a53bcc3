//! The speech service's topics and devices.

use std::path::PathBuf;
use std::sync::Arc;

use crate::devices::client_streams::ClientStreams;
use crate::devices::stream::OwnVoice;
use crate::devices::watched_folder::WatchedFolder;
use crate::live::Live;
use crate::record::Record;
use crate::{Config, In, Out, Recognised, SpeechNode, doctor, inspection};
use config::Settings;
use crossbeam_channel::Receiver;
use language::{Language, Reader as TextReader};
use messages::{
    Activity, AppliedMark, ArmStatus, AudioChunk, Hearing, Injection, MotionCommand, Partial,
    Presented, Receipt, RobotAct, Service, Utterance, topics,
};
use service::Span;
use service::bus::{EncodedReader, PortError, Reader, Writer};
use service::exit::Failure;
use service::inspection::{Finding, Part};
use service::lifecycle::Environment;
use service::service_loop::{Context, Program, Shell};
use service::worker_channel::DeviceSender;

mod ear;
mod microphone;
mod voice;

use ear::EarDevice;
use microphone::MicrophoneDevice;
use voice::VoiceDevice;

/// Speech as a program.
#[derive(Debug)]
pub struct SpeechProgram;

impl Program for SpeechProgram {
    const SERVICE: Service = Service::Speech;
    const RECORD: Option<&'static str> = Some("speech/4");
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

    fn describe(record: &Record) -> String {
        inspection::line(record)
    }

    fn verify(_: Settings, parts: &[Part<Record>]) -> Result<Vec<String>, Failure> {
        inspection::verify(parts)
    }

    fn doctor(settings: &Settings) -> Vec<Finding> {
        doctor::examine(settings)
    }
}

/// The speech service's topics and devices.
pub struct SpeechShell {
    injections: EncodedReader<Injection>,
    audio: Reader<AudioChunk>,
    marks: Reader<AppliedMark>,
    acts: Reader<RobotAct>,
    arm: Reader<ArmStatus>,
    utterances: Writer<Utterance>,
    receipts: Writer<Receipt>,
    presented: Writer<Presented>,
    activity: Writer<Activity>,
    motion: Writer<MotionCommand>,
    hearing: Writer<Hearing>,
    partials: Writer<Partial>,
    ear: EarDevice,
    microphone: MicrophoneDevice,
    streams: ClientStreams,
    watched: Option<WatchedFolder>,
    voice: VoiceDevice,
    inbox: DeviceSender<In>,
    /// Answers of the devices for which there was no room in the inbox.
    answers: Vec<In>,
}

impl SpeechShell {
    /// Answers in a device's place, without waiting: the main loop must not wait for itself.
    fn answer(&mut self, message: In) {
        self.answers.extend(self.inbox.offer(message).err());
    }
}

impl Shell<SpeechNode> for SpeechShell {
    fn open(context: &Context<'_, In>) -> Result<Self, Failure> {
        let bus = context.bus;
        let work = context.environment.paths.run();
        let (settings, inbox) = (context.settings, &context.devices);
        let echo = Span::from_s(settings.speech.microphone.echo_pause.as_secs_f64());
        let own_voice = Arc::new(OwnVoice::new(echo));
        let watched = settings.speech.watch_dir.clone().map(|folder| watch(folder, inbox));
        Ok(Self {
            injections: bus.encoded_reader(&topics::INJECTION)?,
            audio: bus.reader(&topics::AUDIO)?,
            marks: bus.reader(&topics::MARK)?,
            acts: bus.reader(&topics::ACT)?,
            arm: bus.reader(&topics::STATUS)?,
            utterances: bus.writer(&topics::UTTERANCE)?,
            receipts: bus.writer(&topics::RECEIPT)?,
            presented: bus.writer(&topics::PRESENTED)?,
            activity: bus.writer(&topics::ACTIVITY)?,
            motion: bus.writer(&topics::MOTION)?,
            hearing: bus.writer(&topics::HEARING)?,
            partials: bus.writer(&topics::PARTIAL)?,
            ear: EarDevice::start(settings, &work, inbox),
            microphone: MicrophoneDevice::start(settings, &own_voice, inbox),
            streams: microphone::streams(settings, &own_voice, inbox),
            watched,
            voice: VoiceDevice::start(settings, &work, own_voice, inbox),
            inbox: inbox.clone(),
            answers: Vec::new(),
        })
    }

    fn drain(&mut self, take: &mut dyn FnMut(In)) -> Result<(), PortError> {
        self.answers.drain(..).for_each(&mut *take);
        self.acts.drain(|message| take(In::Act(Box::new(*message))))?;
        self.marks.drain(|message| take(In::Mark(*message)))?;
        self.arm.drain(|message| take(In::Arm(*message)))?;
        self.audio.drain(|chunk| self.streams.take(chunk))?;
        while let Some(injection) = self.injections.take()? {
            take(In::Injection(injection));
        }
        Ok(())
    }

    fn publish(&mut self, output: Out) -> Result<(), PortError> {
        match output {
            Out::Utterance(message) => self.utterances.send(&message),
            Out::Receipt(message) => {
                self.watched.iter().for_each(|watched| watched.told(&message));
                self.receipts.send(&message)
            }
            Out::Presented(message) => self.presented.send(&message),
            Out::Activity(message) => self.activity.send(&message),
            Out::Motion(message) => self.motion.send(&message),
            Out::Hearing(message) => self.hearing.send(&message),
            Out::Partial(message) => self.partials.send(&message),
            Out::Overhear(sound, samples) => {
                self.ear.overhear(sound, samples);
                Ok(())
            }
            Out::Expect(sound, cut) => {
                self.ear.expect(sound, cut);
                Ok(())
            }
            Out::Recognise(sound, what) => {
                if let Err(reason) = self.ear.recognise(sound, what) {
                    tracing::warn!(reason, "a sound was not listened to");
                    self.answer(In::Recognised(Recognised { sound, segments: Err(reason) }));
                }
                Ok(())
            }
            Out::Talk(sound, longest) => {
                if let Err(reason) = self.microphone.talk(sound, longest) {
                    self.answer(In::Live(Live::Silent { sound, reason }));
                }
                Ok(())
            }
            Out::Speak(line) => {
                self.voice.speak(&line);
                Ok(())
            }
            Out::Hush => {
                self.voice.hush();
                Ok(())
            }
        }
    }
}

/// A folder is a client within the service.
fn watch(folder: PathBuf, inbox: &DeviceSender<In>) -> WatchedFolder {
    let inbox = inbox.clone();
    // One for which there is no room is given again.
    let give = move |injection| drop(inbox.offer(In::Injection(injection)));
    WatchedFolder::start(folder, Box::new(give))
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
