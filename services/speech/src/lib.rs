//! Speech: hears people, numbers what they say, and says what the robot has to say.
//!
//! [`SpeechNode`] is the reducer. An utterance is accepted once its record is durable; from then on
//! it is sent, in order, until the policy's mark says that it is applied. A prompt counts as heard
//! only once it was said to its end.

pub mod devices;
mod doctor;
mod ears;
mod inspection;
mod listening;
pub mod live;
mod mouth;
pub mod record;
mod said;
pub mod shell;
mod transcript;

#[cfg(test)]
mod tests;

use devices::microphone::MicrophoneStatus;
use devices::stream::Cut;
use ears::Ears;
use live::Live;
use messages::{
    Activity, AppliedMark, ArmStatus, EarState, Hearing, Injection, MotionCommand, Partial,
    Presented, PromptId, Receipt, RobotAct, Utterance,
};
use mouth::Mouth;
use record::Record;
use service::{Effects, Event, Node, NodeError, Span, Time};

pub use record::Hypothesis;

/// How often what is not yet superseded is sent again.
const RESEND_EVERY: Span = Span::from_ms(250);

/// What arrives.
#[derive(Clone, Debug)]
pub enum In {
    /// From a client.
    Injection(Injection),
    /// From the policy: how far the belief has come.
    Mark(AppliedMark),
    /// From the policy: what to say.
    Act(Box<RobotAct>),
    /// From the arm: what it points at.
    Arm(ArmStatus),
    /// From a microphone or a client's stream.
    Live(Live),
    /// From the microphone: how it is.
    Microphone(MicrophoneStatus),
    /// From the recogniser.
    Recognised(Recognised),
    /// From the recogniser: what is being said.
    SoFar {
        /// The sound's number.
        sound: u64,
        /// The words so far.
        text: String,
    },
    /// From the recogniser: whether it works.
    Ear(EarState),
    /// From the voice.
    Voice(VoiceEvent),
}

/// What is published or asked of the devices.
#[derive(Clone, Debug)]
pub enum Out {
    /// To grounding.
    Utterance(Box<Utterance>),
    /// To clients.
    Receipt(Box<Receipt>),
    /// To the policy.
    Presented(Presented),
    /// To the policy.
    Activity(Activity),
    /// To the arm: somebody said stop.
    Motion(MotionCommand),
    /// To clients: how well the robot hears.
    Hearing(Hearing),
    /// To clients: what is being said.
    Partial(Box<Partial>),
    /// To the recogniser: the next samples of what is being said.
    Overhear(u64, Vec<i16>),
    /// To the recogniser: perhaps this is all that will be said.
    Expect(u64, Cut),
    /// To the recogniser: what is said in this? The number comes back with the answer.
    Recognise(u64, ToRecognise),
    /// To the microphone: listen for one utterance, for so long at most. The number comes back with
    /// it.
    Talk(u64, Span),
    /// To the voice: say this, breaking off what is being said.
    Speak(Line),
    /// To the voice: be silent.
    Hush,
}

/// What the recogniser is to listen to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ToRecognise {
    /// A WAV file, absolute path.
    File(String),
    /// One utterance of a live source.
    Speech(Cut),
}

/// What the voice is to say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// Comes back with the voice's events.
    pub number: u64,
    /// The prompt that it says.
    pub prompt: PromptId,
    /// Which presentation of the prompt.
    pub presentation: u32,
    /// The words.
    pub text: String,
}

/// How the voice has come along with a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VoiceEvent {
    /// The line's number.
    pub line: u64,
    /// What happened.
    pub what: Spoken,
}

/// What happened to a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spoken {
    /// Its sound began.
    Started,
    /// Its sound ended as it should.
    Ended,
    /// It was broken off.
    Interrupted,
}

/// What the recogniser found in a sound.
#[derive(Clone, Debug, PartialEq)]
pub struct Recognised {
    /// The sound's number.
    pub sound: u64,
    /// The utterances in it, or why it could not be listened to.
    pub segments: Result<Vec<Segment>, String>,
}

/// One utterance in a sound.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// When it begins and ends, seconds from the start of the sound.
    pub span_s: (f64, f64),
    /// How far it stands above the noise around it, decibels, 0 to 60.
    pub snr_db: f32,
    /// What was heard, or what was heard but is not for the robot.
    pub heard: Result<Vec<Hypothesis>, String>,
}

type Fx = Effects<Out, Record>;

/// Speech as a reducer.
pub struct SpeechNode {
    ears: Ears,
    mouth: Mouth,
    next_send: Time,
}

/// How it hears.
pub struct Config {
    /// Finds the stop word.
    pub reader: language::Reader,
    /// Longest utterance, bytes.
    pub utterance_bytes_max: usize,
    /// Whether pointing gestures are taken.
    pub gestures: bool,
}

impl Node for SpeechNode {
    type Config = Config;
    type In = In;
    type Out = Out;
    type Record = Record;

    fn recover(config: Config, records: Vec<Record>) -> Result<Self, NodeError> {
        let mut ears = Ears::new(config);
        let mut mouth = Mouth::default();
        for record in records {
            match record {
                Record::Accepted(accepted) => ears.remember(accepted),
                Record::Presented(said) => mouth.remember(said),
            }
        }
        Ok(Self { ears, mouth, next_send: Time(0) })
    }

    fn on(&mut self, event: Event<In>, now: Time, fx: &mut Fx) {
        match event {
            Event::Started => self.send(now, fx),
            Event::Message(message) => self.take(message, now, fx),
            Event::Tick => {
                if now >= self.next_send {
                    self.send(now, fx);
                }
            }
            Event::Shutdown => {
                fx.publish(Out::Hush);
                return fx.exit();
            }
        }
        self.mouth.go_on(self.ears.somebody_speaks(now), now, fx);
    }

    fn deadline(&self) -> Option<Time> {
        Some(self.mouth.deadline().map_or(self.next_send, |at| at.min(self.next_send)))
    }

    fn pending_since(&self) -> Option<Time> {
        self.ears.pending_since()
    }

    fn snapshot(&self) -> Option<Vec<Record>> {
        let accepted = self.ears.snapshot()?.into_iter().map(Record::Accepted);
        Some(accepted.chain(self.mouth.snapshot().map(Record::Presented)).collect())
    }
}

impl SpeechNode {
    fn take(&mut self, message: In, now: Time, fx: &mut Fx) {
        match message {
            In::Injection(injection) => {
                // Who talks by key, types or points does not wait for the robot to end.
                if self.ears.hear(injection, &self.mouth, now, fx) {
                    self.mouth.interrupted(now, fx);
                }
            }
            In::Recognised(recognised) => {
                self.ears.recognised(recognised, &self.mouth, now, fx);
                self.send(now, fx);
            }
            In::Live(live) => {
                if matches!(&live, Live::Began(began) if began.interrupts) {
                    self.mouth.interrupted(now, fx);
                }
                self.ears.live(live, now, fx);
            }
            In::SoFar { sound, text } => self.ears.so_far(sound, &text, fx),
            In::Microphone(status) => self.ears.set_microphone(&status, fx),
            In::Ear(state) => self.ears.set_state(state, fx),
            In::Mark(mark) => {
                if self.ears.acknowledge(mark) {
                    self.send(now, fx);
                }
            }
            In::Act(act) => self.mouth.act(&act, now, fx),
            In::Arm(status) => self.mouth.aimed(&status),
            In::Voice(event) => self.mouth.spoken(event, now, fx),
        }
    }

    fn send(&mut self, now: Time, fx: &mut Fx) {
        self.ears.send(fx);
        self.mouth.send(fx);
        self.next_send = now + RESEND_EVERY;
    }
}
