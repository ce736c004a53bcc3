//! Speech: recognises users' words, numbers their utterances, and speaks the robot's prompts.
//!
//! [`SpeechNode`] is the reducer. An utterance is accepted once its record is durable; from then on
//! it is sent, in order, until the policy's mark confirms that it is applied. A prompt counts as
//! heard only once it was spoken to its end.

mod asr_worker;
mod doctor;
mod endpointing;
pub mod hearing;
mod inspection;
mod io;
mod journal_record;
pub mod options;
mod pending_sounds;
mod prompt_player;
mod recent_lines;
pub mod record;
pub mod shell;
mod utterance_content;
mod utterance_intake;

#[cfg(test)]
mod tests;

use messages::UtteranceSeq;
use prompt_player::PromptPlayer;
use record::Record;
use service::{Effects, Event, Node, NodeError, SetAside, Span, Time};
use speech_engines::stream::StreamEvent;
use std::process::ExitCode;
use utterance_intake::UtteranceIntake;

pub use endpointing::{EarlyDecoding, Endpointing, PreparedJudge};
pub use io::{In, Out, PlaybackRequest, Recognised, RecognisedSegment, RecognitionInput};
pub use messages::Hypothesis;
pub use speech_engines::live_events::MicrophoneStatus;
pub use speech_engines::voice::{PlaybackEvent, PlaybackState};
pub use speech_engines::{Device, WHISPER};

/// Runs the program: a service of a group, or an inspection of its records.
pub fn run() -> ExitCode {
    service::service_loop::run::<shell::SpeechProgram>()
}

/// Interval at which everything not yet superseded is sent again.
const RESEND_EVERY: Span = Span::from_ms(250);

type Fx = Effects<Out, Record>;

/// Speech as a reducer.
pub struct SpeechNode {
    intake: UtteranceIntake,
    player: PromptPlayer,
    next_send: Time,
    /// What stands in the place of each device's server.
    notes: [Option<String>; 2],
    status: Option<String>,
}

/// Settings of the reducer.
pub struct Config {
    /// Judges when utterances in progress end, and finds the stop word.
    pub endpointing: Endpointing,
    /// Longest utterance, bytes.
    pub utterance_bytes_max: usize,
    /// `true` if pointing gestures are accepted.
    pub gestures: bool,
}

impl Node for SpeechNode {
    type Config = Config;
    type In<'a> = In<'a>;
    type Out = Out;
    type Record = Record;

    fn recover(config: Config, records: Vec<Record>) -> Result<Self, NodeError> {
        let mut intake = UtteranceIntake::new(config);
        let mut player = PromptPlayer::default();
        for record in records {
            match record {
                Record::Accepted(accepted) => intake.restore(accepted),
                Record::Presented(presentation) => player.restore(presentation),
                stop => intake.stop.restore(&stop),
            }
        }
        Ok(Self { intake, player, next_send: Time(0), notes: [None, None], status: None })
    }

    fn on(&mut self, event: Event<In<'_>>, now: Time, fx: &mut Fx) {
        match event {
            Event::SetAside(SetAside { over, .. }) => {
                self.intake.accepted.skip(UtteranceSeq(over));
            }
            Event::Started => {
                self.intake.stop.resume(now, fx);
                self.send(now, fx);
            }
            Event::Message(message) => self.handle(message, now, fx),
            Event::Tick => {
                self.intake.stop.tick(now);
                if now >= self.next_send {
                    self.intake.accept_waiting(&mut self.player, now, fx);
                    self.send(now, fx);
                }
            }
            Event::Shutdown => {
                fx.publish(Out::StopSpeaking);
                return fx.exit();
            }
        }
        self.player.play_next(self.intake.is_busy(now), now, fx);
    }

    fn deadline(&self) -> Option<Time> {
        let deadlines = [self.player.deadline(), self.intake.stop.deadline(), Some(self.next_send)];
        deadlines.into_iter().flatten().min()
    }

    /// Without the policy's mark no utterance can be numbered.
    fn is_ready(&self) -> bool {
        self.intake.accepted.is_marked()
    }

    fn pending_since(&self) -> Option<Time> {
        self.intake.accepted.pending_since()
    }

    fn status(&self) -> Option<&str> {
        self.status.as_deref()
    }

    fn checkpoint(&self) -> Option<Vec<u8>> {
        let Self { intake, player, next_send, .. } = self;
        let later = (player.lines(), player.newest());
        postcard::to_stdvec(&(intake.checkpoint()?, player, next_send, later)).ok()
    }

    fn resume(config: Config, checkpoint: &[u8]) -> Result<Self, NodeError> {
        let foreign = NodeError::foreign_checkpoint;
        let parts: Result<((Vec<u8>, PromptPlayer, _), _), _> =
            postcard::take_from_bytes(checkpoint);
        let ((intake, mut player, next_send), rest) = parts.map_err(|_| foreign())?;
        // Checkpoints of earlier builds end here, as they knew no lines, or behind the lines.
        if !rest.is_empty() {
            let (lines, rest) = postcard::take_from_bytes(rest).map_err(|_| foreign())?;
            player.restore_lines(lines, postcard::from_bytes(rest).unwrap_or_default());
        }
        let intake = UtteranceIntake::resume(config, &intake).ok_or_else(foreign)?;
        Ok(Self { intake, player, next_send, notes: [None, None], status: None })
    }

    fn snapshot(&self) -> Option<Vec<Record>> {
        let accepted = self.intake.accepted.snapshot().map(Record::Accepted);
        let presented = self.player.snapshot().map(Record::Presented);
        Some(accepted.chain(presented).chain(self.intake.stop.snapshot()).collect())
    }
}

impl SpeechNode {
    fn handle(&mut self, message: In<'_>, now: Time, fx: &mut Fx) {
        match message {
            In::Injection(injection) => {
                // A user who presses talk, types or points interrupts the robot.
                if self.intake.inject(injection, &mut self.player, now, fx) {
                    self.player.interrupt(now, fx);
                }
            }
            In::Recognised(recognised) => {
                if self.intake.recognised(recognised, &mut self.player, now, fx) {
                    self.player.repeat();
                }
                self.send(now, fx);
            }
            In::Stream(event) => {
                if let StreamEvent::Began(began) = &event {
                    self.player.give_way(began.interrupts, now, fx);
                }
                self.intake.stream_event(event, now, fx);
            }
            In::InterimResult { sound, text } => self.intake.interim_result(sound, &text, fx),
            In::EarlyResult { sound, at, result } => {
                self.intake.early_result(sound, at, result.as_deref(), self.player.standing(), fx);
            }
            In::Microphone(status) => self.intake.set_microphone(&status, fx),
            In::RecogniserState(state) => self.intake.set_recogniser(state, fx),
            In::Mark(mark) => {
                if self.intake.accepted.acknowledge(mark) {
                    self.intake.accept_waiting(&mut self.player, now, fx);
                    self.send(now, fx);
                }
            }
            In::Act(act) => {
                self.player.on_act(&act, now, fx);
                self.intake.accept_waiting(&mut self.player, now, fx);
            }
            In::Arm(status) => self.player.on_arm_status(&status),
            In::StopSettled(given) => self.intake.stop.settle(given, fx),
            In::Playback(event) => self.player.on_playback(event, now, fx),
            In::Server { of, note } => {
                self.notes[of as usize] = note;
                let notes: Vec<&str> = self.notes.iter().flatten().map(String::as_str).collect();
                self.status = (!notes.is_empty()).then(|| notes.join("; "));
            }
        }
    }

    fn send(&mut self, now: Time, fx: &mut Fx) {
        self.intake.send(fx);
        self.player.send(fx);
        self.next_send = now + RESEND_EVERY;
    }
}
