//! The speech service's topics and devices.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use crate::asr_worker::AsrWorker;
use crate::record::Record;
use crate::{
    Config, Endpointing, In, Out, PlaybackRequest, PreparedJudge, Recognised, RecognitionInput,
    SpeechNode, doctor, inspection,
};
use crate::{journal_record, options};
use config::Settings;
use crossbeam_channel::Receiver;
use messages::{
    Activity, AppliedMark, ArmStatus, AudioChunk, EarState, Hearing, Injection, Partial, Presented,
    Receipt, RobotAct, Service, SoundFile, Utterance, topics,
};
use service::bus::{EncodedReader, PortError, Reader, Writer};
use service::exit::Failure;
use service::inspection::{Finding, Part, SharedFacts};
use service::journal_record::JournalRecord;
use service::lifecycle::Environment;
use service::service_loop::{Context, Program, Shell};
use service::stop_socket::RepeatedStop;
use service::worker_channel::DeviceSender;
use service::{Span, Time};
use speech_engines::client_streams::ClientStreams;
use speech_engines::microphone::Microphone;
use speech_engines::stream::{Closings, PlaybackMask, StreamEvent};
use speech_engines::voice::Voice;

mod microphone;
mod voice;

/// Speech as a program.
#[derive(Debug)]
pub struct SpeechProgram;

impl Program for SpeechProgram {
    const SERVICE: Service = Service::Speech;
    const RECORD: Option<&'static str> = Some("speech/6");
    const OLDER_RECORDS: &'static [&'static str] = &["speech/5"];
    const ABOUT: &'static str =
        "recognises what users say or type, and speaks the robot's questions";
    type Node = SpeechNode;
    type Shell = SpeechShell;

    fn config(_: &Environment, settings: &Settings) -> Result<Config, Failure> {
        Ok(Config {
            endpointing: Endpointing {
                judge: PreparedJudge::new(&settings.scene),
                complete: settings.speech.complete_pause,
                closing: settings.speech.closing_pause,
                open: settings.speech.open_pause,
            },
            utterance_bytes_max: settings.speech.utterance_bytes_max,
            gestures: settings.dialogue.gesture.enabled,
        })
    }

    fn recorded_at(record: &Record) -> Time {
        inspection::recorded_at(record)
    }

    fn describe(_: &[Settings], record: &Record) -> String {
        inspection::line(record)
    }

    fn explain(settings: &[Settings], record: &Record) -> Option<JournalRecord> {
        Some(JournalRecord::Speech(Box::new(journal_record::explain(settings, record))))
    }

    fn verify(_: &[Settings], parts: &[Part<Record>]) -> Result<Vec<String>, Failure> {
        inspection::verify(parts)
    }

    fn shared_facts(parts: &[Part<Record>]) -> SharedFacts {
        inspection::shared_facts(parts)
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
    stop: RepeatedStop,
    hearing: Writer<Hearing>,
    partials: Writer<Partial>,
    /// The recogniser, or why it is off.
    recogniser: Result<AsrWorker, String>,
    /// The microphone, or why it is off.
    microphone: Result<Microphone, String>,
    streams: ClientStreams,
    /// Pauses that close utterances in progress.
    closings: Arc<Closings>,
    voice: Voice,
    inbox: DeviceSender<In<'static>>,
    /// Replies on behalf of the devices that did not fit into the inbox.
    replies: Vec<In<'static>>,
}

impl SpeechShell {
    /// Replies on behalf of a device, without waiting: the main loop must not wait for itself.
    fn reply(&mut self, message: In<'static>) {
        self.replies.extend(self.inbox.offer(message).err());
    }

    fn recognise(&self, sound: u64, input: RecognitionInput) -> Result<(), String> {
        let submitted = self.recogniser.as_ref()?.submit(sound, input);
        submitted.map_err(|error| format!("speech recognition is {error}"))
    }

    /// Records one utterance.
    fn talk(&self, sound: u64, longest: Span) -> Result<(), String> {
        let talk = self.microphone.as_ref()?.talk(sound, Duration::from_secs_f64(longest.s()));
        talk.map_err(|error| format!("the microphone is {error}"))
    }

    fn speak(&self, PlaybackRequest { playback, prompt, presentation, text }: &PlaybackRequest) {
        self.voice.interrupt();
        let file = SoundFile { prompt: prompt.0, presentation: *presentation };
        if let Err(error) = self.voice.speak(*playback, file, text) {
            tracing::warn!("prompt not spoken: the voice is {error}");
        }
    }
}

impl Shell<SpeechNode> for SpeechShell {
    fn open(context: &Context<'_, In<'static>>) -> Result<Self, Failure> {
        let bus = context.bus;
        let paths = &context.environment.paths;
        let work = paths.run();
        let (settings, inbox) = (context.settings, &context.devices);
        let echo = Span::from_s(settings.speech.microphone.echo_pause.as_secs_f64());
        let playback_mask = Arc::new(PlaybackMask::new(echo));
        let closings = Arc::new(Closings::default());
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
            stop: RepeatedStop::open(paths)
                .map_err(|error| Failure::file(&paths.stop_socket(), &error))?,
            hearing: bus.writer(&topics::HEARING)?,
            partials: bus.writer(&topics::PARTIAL)?,
            recogniser: start_recogniser(settings, &paths.recogniser(), inbox),
            microphone: microphone::start(settings, &playback_mask, &closings, inbox),
            streams: ClientStreams::start(
                options::segmenter(&settings.speech),
                Arc::clone(&playback_mask),
                Arc::clone(&closings),
                microphone::sink(inbox),
            ),
            closings,
            voice: voice::start(settings, &work, playback_mask, inbox),
            inbox: inbox.clone(),
            replies: Vec::new(),
        })
    }

    /// Called in each pass, also while the disk is full.
    fn drain_urgent(&mut self, _: bool, take: &mut dyn FnMut(In<'_>)) -> Result<(), PortError> {
        self.stop.pass().into_iter().for_each(|given| take(In::StopSettled(given)));
        Ok(())
    }

    fn drain(&mut self, take: &mut dyn FnMut(In<'_>)) -> Result<(), PortError> {
        self.replies.drain(..).for_each(&mut *take);
        self.acts.drain(|message| take(In::Act(message.into())))?;
        self.marks.drain(|message| take(In::Mark(*message)))?;
        self.arm.drain(|message| take(In::Arm(*message)))?;
        self.audio.drain(|chunk| self.streams.take(chunk))?;
        self.injections.drain_in_turn(|injection| take(In::Injection(injection)))
    }

    fn publish(&mut self, output: Out) -> Result<(), PortError> {
        match output {
            Out::Utterance(message) => return self.utterances.send(&message),
            Out::Receipt(message) => return self.receipts.send(&message),
            Out::Presented(message) => return self.presented.send(&message),
            Out::Activity(message) => return self.activity.send(&message),
            Out::Stop(given) => self.stop.give(given),
            Out::Hearing(message) => return self.hearing.send(&message),
            Out::Partial(message) => return self.partials.send(&message),
            Out::InterimSamples(sound, samples) => {
                if let Ok(recogniser) = &self.recogniser {
                    recogniser.interim_samples(sound, samples);
                }
            }
            Out::DecodeEarly(sound, segment) => {
                if let Ok(recogniser) = &self.recogniser {
                    recogniser.decode_early(sound, segment);
                }
            }
            Out::Close(sound, closing) => self.closings.set(sound, closing),
            Out::Recognise(sound, input) => {
                if let Err(reason) = self.recognise(sound, input) {
                    tracing::warn!(reason, "audio not recognised");
                    self.reply(In::Recognised(Recognised { sound, segments: Err(reason) }));
                }
            }
            Out::OpenMicrophone(sound, longest) => {
                if let Err(reason) = self.talk(sound, longest) {
                    self.reply(In::Stream(StreamEvent::Silent { sound, reason }));
                }
            }
            Out::Speak(request) => self.speak(&request),
            Out::StopSpeaking => self.voice.interrupt(),
        }
        Ok(())
    }
}

/// Starts the recogniser, or returns why it is off.
fn start_recogniser(
    settings: &Settings,
    work: &Path,
    inbox: &DeviceSender<In<'static>>,
) -> Result<AsrWorker, String> {
    if settings.speech.recogniser == config::Recogniser::None {
        inbox.send(In::RecogniserState(EarState::Off));
        return Err("speech recognition is switched off (speech.recogniser)".to_owned());
    }
    let (worker, events) = AsrWorker::start(settings, work);
    let inbox = inbox.clone();
    forward("recogniser", events, move |event| inbox.send(event));
    Ok(worker)
}

/// Forwards a device's events to the main loop until either ends.
fn forward<T: Send + 'static>(
    name: &str,
    events: Receiver<T>,
    mut hand_over: impl FnMut(T) -> bool + Send + 'static,
) {
    let work = move || while events.recv().is_ok_and(&mut hand_over) {};
    if let Err(error) = std::thread::Builder::new().name(name.to_owned()).spawn(work) {
        tracing::error!(%error, name, "the thread of a device cannot be started");
    }
}
