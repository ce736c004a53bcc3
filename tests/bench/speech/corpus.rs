//! The corpora: sentences, the questions that they answer, voices.

use super::conditions::{Condition, Noise};
use super::noise::samples;
use super::score::has_content;
use super::voices::Voices;
use language::Reader;
use scene::{ObjectId, Question, Scene};
use std::ops::Range;
use vocabulary::Language;
use whichone_tests::spoken::{SPEAKERS, Speaker};

/// Sentences of one kind, and who speaks them.
pub(super) struct Corpus {
    pub(super) name: &'static str,
    pub(super) scenes: Vec<Scene>,
    pub(super) sentences: Vec<Sentence>,
    pub(super) voices: &'static [Speaker],
}

/// A sentence, and to whom it is said.
pub(super) struct Sentence {
    /// Index of the scene whose robot hears it.
    pub(super) scene: usize,
    pub(super) for_the_robot: bool,
    pub(super) text: String,
    /// The question that it answers.
    pub(super) question: Question,
}

/// A sentence as it reaches the microphone.
pub(super) struct Clip {
    /// 16 kHz, one channel.
    pub(super) samples: Vec<i16>,
    /// Range of the voice, samples.
    pub(super) speech: Range<usize>,
}

/// Voices that [`SPEAKERS`] does not hold, of both kinds.
const FRESH_SPEAKERS: &[Speaker] = &[
    Speaker::espeak("en-us+f4", 160),
    Speaker::espeak("en-gb-scotland", 150),
    Speaker::flite("kal16"),
];

/// Voices that speak nothing but the sentences that are kept apart.
const KEPT_APART_SPEAKERS: &[Speaker] = &[
    Speaker::espeak("en-us-nyc+m3", 155),
    Speaker::espeak("en-us+f5", 160),
    Speaker::flite("awb"),
];

/// Other speakers at once in babble.
const BABBLERS: usize = 6;

impl Corpus {
    /// Sentences and voices that the service is tuned on.
    pub(super) fn main() -> Self {
        let everything = fixture("everything.toml");
        let scene = Scene::from_toml("everything.toml", &everything).expect("a scene that holds");
        Self::of("main", vec![scene], "main.txt", &SPEAKERS)
    }

    /// Other sentences and voices, which are scored at every change.
    pub(super) fn fresh() -> Self {
        Self::of("fresh", configured(), "fresh.txt", FRESH_SPEAKERS)
    }

    /// Sentences and voices that are scored at the end of a change only.
    pub(super) fn kept_apart() -> Self {
        Self::of("kept apart", configured(), "kept-apart.txt", KEPT_APART_SPEAKERS)
    }

    /// The public utterances, as far as they can be spoken.
    pub(super) fn utterances() -> Self {
        let scenes = configured();
        let lines = include_str!("../../fixtures/utterances/public.jsonl").lines();
        let sentences = lines.filter_map(|line| spoken(&scenes, line)).collect();
        Self { name: "utterances", scenes, sentences, voices: FRESH_SPEAKERS }
    }

    fn of(name: &'static str, scenes: Vec<Scene>, file: &str, voices: &'static [Speaker]) -> Self {
        let text = fixture(file);
        let lines = text.lines().filter(|line| !line.starts_with('#') && !line.is_empty());
        let sentence = |(n, line): (usize, &str)| {
            let mut columns = line.split(" | ");
            let (to, asked, text) = (columns.next()?, columns.next()?, columns.next()?);
            let scene = scenes.iter().position(|scene| scene.name() == to);
            let for_the_robot = scene.is_some();
            // Talk about other things is heard by each of the robots in turn.
            let scene = scene.unwrap_or(n % scenes.len());
            let question = question(&scenes[scene], asked)?;
            Some(Sentence { scene, for_the_robot, text: text.to_owned(), question })
        };
        let sentence = |at: (usize, &str)| sentence(at).unwrap_or_else(|| panic!("{file}: {at:?}"));
        let sentences: Vec<Sentence> = lines.enumerate().map(sentence).collect();
        let readers: Vec<Reader> =
            scenes.iter().map(|scene| Reader::new(scene, Language::Careful)).collect();
        for said in sentences.iter().filter(|said| said.for_the_robot) {
            // Whatever is not heard would count as right.
            assert!(
                has_content(&readers[said.scene], said),
                "{file}: `{}` means nothing; help: give it the question that it answers",
                said.text
            );
        }
        Self { name, scenes, sentences, voices }
    }

    /// Sentence `n` in a voice as it reaches the microphone: the same samples in every run.
    pub(super) fn clip(&self, voices: &Voices, n: usize, voice: usize, at: &Condition) -> Clip {
        let speak = |n: usize, voice: usize| {
            let (n, voice) = (n % self.sentences.len(), voice % self.voices.len());
            voices.speak(&self.voices[voice], at, &self.sentences[n].text)
        };
        let spoken = speak(n, voice);
        let babblers = if at.noise == Noise::Babble { BABBLERS } else { 0 };
        let others: Vec<Vec<i16>> = (1..=babblers).map(|k| speak(n + 7 * k, voice + k)).collect();
        let seed = (n * self.voices.len() + voice) as u64 * 1_000 + at.snr_db as u64;
        let lead = samples(at.lead_s());
        let samples = at.heard(&spoken, &others, seed);
        Clip { samples, speech: lead..lead + spoken.len() }
    }
}

/// Returns the question of a fixture: `-` (none), `this` (this one?), `color=white` (is it white?) or
/// `color` (which colour is it?).
pub(super) fn question(scene: &Scene, name: &str) -> Option<Question> {
    Some(match (name, name.split_once('=')) {
        ("-", _) => Question::None,
        ("this", _) => Question::Point(ObjectId(0)),
        (name, None) => Question::Which(scene.attribute_named(name)?),
        (_, Some((attribute, value))) => {
            let k = scene.attribute_named(attribute)?;
            Question::Attribute(k, scene.value_named(k, value)?)
        }
    })
}

/// A line of the public utterances; `None` where it exists only in writing, as an empty text or a
/// spelling mistake.
fn spoken(scenes: &[Scene], line: &str) -> Option<Sentence> {
    let line: serde_json::Value = serde_json::from_str(line).expect("a line of JSON");
    let kind = line["kind"].as_str()?;
    if matches!(kind, "empty" | "unicode" | "recogniser-error" | "other-language") {
        return None;
    }
    let scene = scenes.iter().position(|scene| line["scene"] == scene.name())?;
    let question = match &line["last_question"] {
        serde_json::Value::Null => Question::None,
        asked => scene::question_from_json(&scenes[scene], asked).ok()?,
    };
    let text = line["text"].as_str()?.to_owned();
    let for_the_robot = line["expect"]["intent"] != "none";
    Some(Sentence { scene, for_the_robot, text, question })
}

fn configured() -> Vec<Scene> {
    ["bowls", "tools"].map(crate::core::scenes::configured).into()
}

fn fixture(name: &str) -> String {
    let path = format!("{}/fixtures/speech/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}
