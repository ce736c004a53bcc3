//! The corpora: sentences, voices, noise.

use super::voices::Voices;
use ::speech::devices::audio::RATE_HZ;
use dialogue::Rng;
use realfft::RealFftPlanner;
use realfft::num_complex::Complex;
use scene::{Question, Scene};
use std::f64::consts::TAU;
use std::ops::Range;
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
    Speaker::flite("awb"),
    Speaker::flite("kal16"),
];

/// Quiet before and behind the voice, seconds.
const LEAD_S: f64 = 0.5;
const TAIL_S: f64 = 0.8;

impl Corpus {
    /// The corpus on which the service was tuned, by half.
    pub(super) fn main() -> Self {
        let everything = fixture("everything.toml");
        let scene = Scene::from_toml("everything.toml", &everything).expect("a scene that holds");
        Self::of("main", vec![scene], &fixture("main.txt"), &SPEAKERS)
    }

    /// Sentences and voices on which nothing was tuned.
    pub(super) fn fresh() -> Self {
        Self::of("fresh", configured(), &fixture("fresh.txt"), FRESH_SPEAKERS)
    }

    /// The public utterances, as far as they can be spoken.
    pub(super) fn utterances() -> Self {
        let scenes = configured();
        let lines = include_str!("../../fixtures/utterances/public.jsonl").lines();
        let sentences = lines.filter_map(|line| spoken(&scenes, line)).collect();
        Self { name: "utterances", scenes, sentences, voices: FRESH_SPEAKERS }
    }

    fn of(name: &'static str, scenes: Vec<Scene>, text: &str, voices: &'static [Speaker]) -> Self {
        let lines = text.lines().filter(|line| !line.starts_with('#'));
        let lines = lines.filter_map(|line| line.split_once(" | "));
        let sentence = |(n, (to, text)): (usize, (&str, &str))| {
            let scene = scenes.iter().position(|scene| scene.name() == to);
            // Talk about other things is heard by each of the robots in turn.
            let turn = n % scenes.len();
            let question = Question::None;
            let for_the_robot = scene.is_some();
            Sentence {
                scene: scene.unwrap_or(turn),
                for_the_robot,
                text: text.to_owned(),
                question,
            }
        };
        let sentences = lines.enumerate().map(sentence).collect();
        Self { name, scenes, sentences, voices }
    }

    /// Sentence `n` in a voice with noise `snr_db` below it: the same samples in every run.
    pub(super) fn clip(&self, voices: &Voices, n: usize, voice: usize, snr_db: f64) -> Clip {
        let text = &self.sentences[n].text;
        let spoken = voices.speak(&self.voices[voice], text);
        let (lead, tail) = (samples(LEAD_S), samples(TAIL_S));
        let level = rms(&spoken) / 10_f64.powf(snr_db / 20.0);
        let seed = (n * self.voices.len() + voice) as u64 * 1_000 + snr_db as u64;
        let noise = pink(lead + spoken.len() + tail, seed);
        let mixed = noise.iter().enumerate().map(|(at, noise)| {
            let voice = at.checked_sub(lead).and_then(|at| spoken.get(at)).copied().unwrap_or(0);
            // The cast saturates: what exceeds full scale is clipped.
            (f64::from(voice) + level * noise) as i16
        });
        Clip { samples: mixed.collect(), speech: lead..lead + spoken.len() }
    }
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

/// So many samples of noise of power 1 that falls by 3 dB an octave, as that of most rooms does; the
/// same for the same seed. Every frequency gets a random amplitude and phase (Box and Muller),
/// divided by the root of the frequency.
fn pink(len: usize, seed: u64) -> Vec<f64> {
    let transform = RealFftPlanner::new().plan_fft_inverse(len.next_power_of_two());
    let (mut spectrum, mut noise) = (transform.make_input_vec(), transform.make_output_vec());
    let mut rng = Rng::new(seed);
    let [_, bins @ .., _] = &mut spectrum[..] else { unreachable!("a spectrum has two ends") };
    for (bin, k) in bins.iter_mut().zip(1..) {
        let radius = (-2.0 * (1.0 - rng.uniform()).ln()).sqrt();
        *bin = Complex::from_polar(radius / f64::from(k).sqrt(), TAU * rng.uniform());
    }
    transform.process(&mut spectrum, &mut noise).expect("vectors of the transform's own lengths");
    noise.truncate(len);
    let power = noise.iter().map(|x| x * x).sum::<f64>() / len as f64;
    noise.into_iter().map(|x| x / power.sqrt()).collect()
}

fn samples(seconds: f64) -> usize {
    (seconds * f64::from(RATE_HZ)) as usize
}

fn rms(samples: &[i16]) -> f64 {
    let squares = samples.iter().map(|&s| f64::from(s) * f64::from(s));
    (squares.sum::<f64>() / samples.len().max(1) as f64).sqrt()
}
