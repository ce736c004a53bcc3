//! One spoken dialogue with the real group: a user asks for an object, answers the questions, and
//! gets something.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use dialogue::Model;
use evaluation::simulation::SimulatedUser;
use evaluation::simulation::users::{Domain, Manners, Policy, Turn};
use language::Reader;
use messages::{EarState, Outcome, ReceiptStatus};
use preflight::Pace;
use scene::{Question, Reading, Scene};
use serde::Serialize;
use service::client::Client;
use service::clock;
use service::{Span, Time};
use speech_engines::voice::Synthesiser;
use vocabulary::{Language, Params, Rng};

use super::room::Room;
use super::sound::{Noise, SPEAKERS, SPEECH_RMS, levelled};
use super::taps::{News, Said, Taps};
use super::words::understand;
use crate::{Group, wait_for};

/// Conditions of a dialogue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// Signal to noise ratio, decibels.
    pub snr_db: f64,
    /// What the noise is.
    pub noise: Noise,
    /// Number of the dialogue: determines the object, the voice, the words and the times.
    pub number: u64,
    /// Seed of all dialogues.
    pub seed: u64,
}

/// A dialogue that was held.
#[derive(Clone, Debug, Serialize)]
pub struct Held {
    /// Its number.
    pub number: u64,
    /// The user's voice.
    pub speaker: &'static str,
    /// The wanted object.
    pub wanted: String,
    /// The object that was brought, if any.
    pub brought: Option<String>,
    /// Questions that were asked.
    pub questions: u32,
    /// From the user's first sound to the decision what to bring, seconds.
    pub seconds: f64,
    /// From the end of the user's voice to the first sound of the reply, milliseconds, of each reply.
    pub replies_ms: Vec<f64>,
    /// The user's utterances.
    pub said: u32,
    /// Those that were rejected or not heard.
    pub rejected: u32,
    /// Those that were misunderstood.
    pub misunderstood: u32,
    /// Log of the dialogue.
    pub story: Vec<String>,
}

impl Held {
    /// Returns how it ended.
    pub fn ending(&self) -> Ending {
        match self.brought.as_deref() {
            Some(brought) if brought == self.wanted => Ending::Right,
            Some(_) => Ending::Another,
            None => Ending::Nothing,
        }
    }
}

/// How a dialogue ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The wanted object was brought.
    Right,
    /// Another object was brought.
    Another,
    /// None was brought in time.
    Nothing,
}

/// Probability of a remark after an answer.
const SECOND_THOUGHT: f64 = 0.06;
/// Pause before that remark, seconds.
const SECOND_THOUGHT_S: (f64, f64) = (0.9, 2.5);
/// A dialogue that takes longer has failed.
const LONGEST: Duration = Duration::from_secs(150);
/// Time without a reaction after which a request is repeated, seconds.
const PATIENCE_S: f64 = 6.0;
/// Polling interval of the robot's topics.
const LOOK: Duration = Duration::from_millis(4);
/// Tolerance of the detected onset and end, seconds.
const EDGE_S: f64 = 0.6;
/// How long the robot has listened to the room before the first request.
const LISTENED: Span = Span::from_ms(4_000);

/// Runs a dialogue with its own group.
///
/// # Panics
/// If the group does not start, or a topic breaks.
pub fn converse(conditions: Conditions) -> Held {
    let folder = tempfile::tempdir().expect("a folder");
    let pipe = folder.path().join("microphone");
    let noise = SPEECH_RMS / 10_f64.powf(conditions.snr_db / 20.0);
    let seed = conditions.seed ^ (conditions.number << 20);
    let noise = conditions.noise.sound(noise, seed, folder.path());
    let room = Room::open(&pipe, noise);
    let settings = settings(&pipe);
    let group = Group::up(&settings.iter().map(String::as_str).collect::<Vec<_>>());
    let client = Client::join(group.paths()).expect("a running group");
    let scene = config::Settings::load_snapshot(&group.paths().run()).expect("a snapshot").scene;
    let mut talk = Talk::new(&client, scene, room, folder.path(), conditions);
    talk.hold();
    let held = talk.held();
    drop(client);
    group.verify_journals();
    group.down();
    held
}

/// Names the model of the second recogniser, where one is to be used.
const MODEL: &str = "WHICHONE_WHISPER_MODEL";

/// Returns the model of the second recogniser, if the environment names one.
pub fn second_model() -> Option<PathBuf> {
    std::env::var_os(MODEL).map(PathBuf::from)
}

/// The shipped speech settings with the pipe for a microphone, and a voice that takes its time.
fn settings(pipe: &Path) -> Vec<String> {
    let model = second_model();
    let model = model.map(|model| format!("speech.whisper_model=\"{}\"", model.display()));
    let mut settings = vec![
        "speech.voice=espeak-ng".to_owned(),
        "speech.player=[\"none\"]".to_owned(),
        "speech.recogniser=pocketsphinx".to_owned(),
        "speech.microphone.mode=hands-free".to_owned(),
        format!("speech.microphone.command=[\"cat\", \"{}\"]", pipe.display()),
        "speech.microphone.barge_in=false".to_owned(),
    ];
    settings.extend(model);
    settings
}

/// An utterance of the user.
struct Sentence {
    text: String,
    /// The question that it answers.
    question: Question,
    began: Time,
    ended: Time,
    heard: bool,
}

/// A remark that is still to come.
struct Thought {
    at: Time,
    text: String,
}

struct Talk {
    number: u64,
    speaker: &'static str,
    scene: Scene,
    reader: Reader,
    model: Model,
    user: SimulatedUser,
    wanted: scene::ObjectId,
    voice: Synthesiser,
    room: Room,
    taps: Taps,
    begun: HashSet<Said>,
    replies_ms: Vec<f64>,
    /// End of the user's voice that has no reply yet.
    unreplied: Option<Time>,
    answered: HashSet<Said>,
    thought: Option<Thought>,
    sentences: Vec<Sentence>,
    /// The question that was answered last.
    question: Question,
    requests: u32,
    reacted: bool,
    decided: Option<Time>,
    misunderstood: u32,
    story: Vec<String>,
}

impl Talk {
    fn new(
        client: &Client,
        scene: Scene,
        room: Room,
        folder: &Path,
        conditions: Conditions,
    ) -> Self {
        let mut rng = Rng::new(conditions.seed);
        let policy = Policy::Talkative(&Manners::ATTENTIVE);
        let stream = rng.next_u64() ^ conditions.number.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let number = conditions.number as usize;
        let wanted = scene::ObjectId::from(number % scene.objects().len());
        let speaker = SPEAKERS[(number / scene.objects().len() + number) % SPEAKERS.len()];
        Self {
            number: conditions.number,
            speaker: speaker.name,
            reader: Reader::new(&scene, Language::Careful),
            model: Model::new(&scene, Params::default()),
            user: SimulatedUser::new(policy, wanted, Rng::new(stream)),
            wanted,
            voice: speaker.synthesiser(&folder.join("user")),
            room,
            taps: Taps::open(client),
            begun: HashSet::new(),
            replies_ms: Vec::new(),
            unreplied: None,
            answered: HashSet::new(),
            thought: None,
            sentences: Vec::new(),
            question: Question::None,
            requests: 0,
            reacted: false,
            decided: None,
            misunderstood: 0,
            story: Vec::new(),
            scene,
        }
    }

    fn hold(&mut self) {
        wait_for("a recogniser that is ready", 30.0, || {
            self.taps.look();
            (self.taps.ear == Some(EarState::Ready)).then_some(())
        });
        let request = self.turn(|user, domain| user.request(domain));
        self.say(clock::now() + LISTENED, request, Question::None);
        let begun = Instant::now();
        while self.taps.view.last.is_none() && begun.elapsed() < LONGEST {
            let news = self.taps.look();
            self.follow(news);
            self.speak_up();
            std::thread::sleep(LOOK);
        }
    }

    fn follow(&mut self, news: News) {
        for receipt in &news.receipts {
            let note = receipt.note.as_str().unwrap_or_default().to_owned();
            let accepted = receipt.status == ReceiptStatus::Accepted;
            self.heard(Time(receipt.onset_ns), &note, accepted, receipt.snr_db);
        }
        for (said, at) in news.began {
            if !self.begun.insert(said) {
                continue;
            }
            if let Some(ended) = self.unreplied.take_if(|ended| *ended <= Time(at)) {
                self.replies_ms.push(Time(at).since(ended).s() * 1e3);
            }
            if let Some(words) = self.taps.questions.get(&said).cloned() {
                self.log(Time(at), format!("robot: {words}"));
            }
        }
        for (said, at) in news.ended {
            let words = self.taps.questions.get(&said).cloned();
            if let (Some(words), true) = (words, self.answered.insert(said)) {
                self.reacted = true;
                self.answer(&words, Time(at));
            }
        }
        if self.taps.picks && self.decided.is_none() {
            self.decided = Some(clock::now());
            let text = self.taps.view.text.clone();
            self.log(clock::now(), format!("robot: {text}"));
        }
    }

    /// Answers a question that ended then, after a while of thinking.
    fn answer(&mut self, words: &str, ended: Time) {
        let question = understand(&self.scene, &self.reader, words);
        self.question = question;
        let reaction = Span::from_s(Pace::default().reaction_s(self.user.rng()));
        let text = self.turn(|user, domain| user.answer(domain, question));
        let end = self.say(ended + reaction, text, question);
        if self.user.rng().uniform() < SECOND_THOUGHT {
            let text = self.turn(|user, domain| user.answer(domain, Question::None));
            let pause = Span::from_s(self.user.rng().between(SECOND_THOUGHT_S));
            self.thought = Some(Thought { at: end + pause, text });
        }
    }

    /// The words of a turn, without the pauses that a synthesiser makes of commas.
    fn turn(&mut self, turn: impl Fn(&mut SimulatedUser, Domain<'_>) -> Turn) -> String {
        let domain = Domain { scene: &self.scene, model: &self.model };
        turn(&mut self.user, domain).reply.text().unwrap_or_default().replace(',', "")
    }

    /// Remarks, and the request again where it met with nothing.
    fn speak_up(&mut self) {
        let now = clock::now();
        let due = |thought: &mut Thought| thought.at <= now;
        if let Some(Thought { at, text }) = self.thought.take_if(due)
            && self.decided.is_none()
        {
            self.say(at, text, self.question);
        }
        let last = self.sentences.last().map_or(now, |sentence| sentence.ended);
        let unheard = !self.reacted && self.decided.is_none();
        if unheard && now >= last + Span::from_s(PATIENCE_S) && self.requests < 4 {
            let request = format!("get me the {}", self.scene.noun());
            self.say(now, request, Question::None);
        }
    }

    fn say(&mut self, at: Time, text: String, question: Question) -> Time {
        self.requests += u32::from(question == Question::None);
        let samples = self.voice.samples(&text).expect("a synthesised voice");
        let (began, ended) = self.room.say(at, levelled(&samples));
        self.log(began, format!("user: {text}"));
        self.unreplied = Some(ended);
        self.sentences.push(Sentence { text, question, began, ended, heard: false });
        ended
    }

    /// Handles a receipt of the robot.
    fn heard(&mut self, onset: Time, note: &str, accepted: bool, snr_db: f32) {
        let edge = Span::from_s(EDGE_S);
        let is_it = |sentence: &&mut Sentence| {
            onset + edge >= sentence.began && onset < sentence.ended + edge
        };
        let said = self.sentences.iter_mut().rev().find(is_it);
        let what = match (said, accepted) {
            (Some(said), true) => {
                said.heard = true;
                let meaning = |text: &str| meaning(&self.reader.read(text, said.question));
                let right = meaning(&said.text) == meaning(note);
                self.misunderstood += u32::from(!right);
                if right { "heard" } else { "heard WRONGLY" }
            }
            (None, true) => "heard OUT OF NOTHING",
            (_, false) => "heard, not for me",
        };
        self.log(clock::now(), format!("  {what}: {note} ({snr_db:.0} dB)"));
    }

    fn log(&mut self, at: Time, what: String) {
        let began = self.sentences.first().map_or(at, |first| first.began);
        let seconds = (at.ns() as f64 - began.ns() as f64) / 1e9;
        self.story.push(format!("{seconds:7.2} s  {what}"));
    }

    fn held(self) -> Held {
        let last = self.taps.view.last.as_ref();
        let delivered = last.filter(|last| last.outcome == Outcome::Delivered);
        let began = self.sentences.first().map_or(Time(0), |first| first.began);
        let ended = self.decided.unwrap_or_else(clock::now);
        Held {
            number: self.number,
            speaker: self.speaker,
            wanted: self.scene.object(self.wanted).name.clone(),
            brought: delivered.and_then(|last| last.name.clone()),
            questions: last.map_or(0, |last| last.questions),
            seconds: ended.since(began).s(),
            replies_ms: self.replies_ms,
            said: self.sentences.len() as u32,
            rejected: self.sentences.iter().filter(|sentence| !sentence.heard).count() as u32,
            misunderstood: self.misunderstood,
            story: self.story,
        }
    }
}

/// The relevant parts of a reading: the words as a set, the exclusions, and the answer.
fn meaning(reading: &Reading) -> impl PartialEq + use<> {
    let mut base = reading.base.clone();
    base.sort_unstable();
    base.dedup();
    let mut excluded = reading.excluded.clone();
    excluded.sort_unstable();
    (base, excluded, reading.response)
}
