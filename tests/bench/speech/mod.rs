//! Spoken input: how much of it is understood, how late, and what it costs.
//!
//! The sentences are spoken by programs, mixed with noise, and go the service's own way: detector
//! of speech, recogniser, gate, reading. Everything but times is the same in every run. No person
//! spoke: the figures compare methods and show what noise does; they promise nothing about people.

mod conditions;
mod corpus;
mod delays;
mod endings;
mod listener;
mod noise;
mod other_sounds;
mod room;
mod score;
mod tables;
mod voices;

use crate::report::{Report, print};
use ::speech_engines::recogniser::RecogniserUnavailable;
use ::speech_engines::vad::SegmenterOptions;
use conditions::Condition;
use corpus::{Corpus, Sentence};
use language::Reader;
use listener::Listener;
use score::Score;
use std::path::PathBuf;
use vocabulary::Language;
use voices::Voices;

/// One clip's score, and what clip it is.
struct Trial {
    condition: Condition,
    score: Score,
}

/// Which voices and sentences of a corpus are heard.
#[derive(Clone, Copy)]
struct Extent {
    /// Voices per sentence for the robot, in turn; other talk is rare, and all voices speak it.
    voices_each: usize,
    /// Every how many sentences one is heard.
    every: usize,
}

/// Measures on what the service is tuned on, or on what is kept apart from that.
pub(crate) fn measure(report: &mut Report, quick: bool, kept_apart: bool) {
    if let Some(missing) = Voices::missing() {
        return print(&format!("spoken input is left out: {missing} is not installed"));
    }
    let voices = Voices::new().expect("a folder for what is spoken");
    let result = match kept_apart {
        true => measure_kept_apart(report, &voices),
        false => measure_tuned(report, &voices, quick),
    };
    if let Err(error) = result {
        print(&format!("spoken input is left out: {error}"));
    }
}

fn measure_tuned(
    report: &mut Report,
    voices: &Voices,
    quick: bool,
) -> Result<(), RecogniserUnavailable> {
    let levels: &[Condition] = &[conditions::QUIET, conditions::NOISY];
    let steady = [if quick { &[] } else { &conditions::BETWEEN[..] }, levels].concat();
    let some = Extent { voices_each: if quick { 2 } else { usize::MAX }, every: 1 };
    let few = Extent { voices_each: 1, every: if quick { 2 } else { 1 } };
    for corpus in [Corpus::main(), Corpus::fresh(), Corpus::utterances()] {
        let mut ears = Ears::open(&corpus)?;
        let (mut heard, mut trials) = (steady.clone(), ears.hear(&corpus, voices, &steady, some));
        if corpus.name != "utterances" {
            heard.extend(conditions::OTHER);
            trials.extend(ears.hear(&corpus, voices, &conditions::OTHER, few));
        }
        tables::add(report, &corpus, &heard, &trials);
        let what = format!("start of the recogniser: {}", corpus.name);
        report.add(&what, "ms", &ears.starts_ms, "from the scene to ready for the first sound");
        if corpus.name == "main" {
            other_sounds::measure(report, &corpus.scenes[0], &mut ears.listeners[0]);
        }
    }
    Ok(())
}

fn measure_kept_apart(report: &mut Report, voices: &Voices) -> Result<(), RecogniserUnavailable> {
    let corpus = Corpus::kept_apart();
    let levels = [conditions::QUIET, conditions::NOISY];
    let all = Extent { voices_each: usize::MAX, every: 1 };
    let trials = Ears::open(&corpus)?.hear(&corpus, voices, &levels, all);
    tables::add(report, &corpus, &levels, &trials);
    Ok(())
}

pub(crate) fn measure_endings(report: &mut Report, quick: bool) {
    if let Some(missing) = Voices::missing() {
        return print(&format!("ends of utterances are left out: {missing} is not installed"));
    }
    let voices = Voices::new().expect("a folder for what is spoken");
    endings::measure(report, &voices, quick);
    if let Err(error) = delays::measure(report, &voices) {
        print(&format!("delays of spoken input are left out: {error}"));
    }
}

/// The ears of one robot for each scene of a corpus.
struct Ears {
    listeners: Vec<Listener>,
    readers: Vec<Reader>,
    starts_ms: Vec<f64>,
    /// Holds the recognisers' files.
    _work: tempfile::TempDir,
}

/// Number of timed starts of each recogniser.
const STARTS: usize = 5;

impl Ears {
    fn open(corpus: &Corpus) -> Result<Self, RecogniserUnavailable> {
        Self::open_with(corpus, whichone_tests::spoken::second_model())
    }

    fn open_with(corpus: &Corpus, model: Option<PathBuf>) -> Result<Self, RecogniserUnavailable> {
        let work = tempfile::tempdir().expect("a folder for the recogniser");
        let (mut listeners, mut starts_ms) = (Vec::new(), Vec::new());
        for (n, scene) in corpus.scenes.iter().enumerate() {
            let folder = work.path().join(n.to_string());
            for _ in 1..STARTS {
                starts_ms.push(Listener::new(scene, &folder, None)?.start_s * 1e3);
            }
            let listener = Listener::new(scene, &folder, model.clone())?;
            starts_ms.push(listener.start_s * 1e3);
            listeners.push(listener);
        }
        let reader = |scene| Reader::new(scene, Language::Careful);
        let readers = corpus.scenes.iter().map(reader).collect();
        Ok(Self { listeners, readers, starts_ms, _work: work })
    }

    fn hear(
        &mut self,
        corpus: &Corpus,
        voices: &Voices,
        conditions: &[Condition],
        extent: Extent,
    ) -> Vec<Trial> {
        let pause_s = SegmenterOptions::default().closing_pause_s;
        let mut trials = Vec::new();
        for condition in conditions {
            for n in (0..corpus.sentences.len()).step_by(extent.every) {
                let said = &corpus.sentences[n];
                for voice in extent.voices_of(n, said, corpus.voices.len()) {
                    let clip = corpus.clip(voices, n, voice, condition);
                    let heard = self.listeners[said.scene].hear(&clip);
                    let reader = &self.readers[said.scene];
                    let score = Score::of(reader, said, &clip, &heard, pause_s);
                    trials.push(Trial { condition: *condition, score });
                }
            }
        }
        trials
    }
}

impl Extent {
    fn voices_of(self, n: usize, said: &Sentence, all: usize) -> impl Iterator<Item = usize> {
        let steady = self.every == 1 && !said.for_the_robot;
        let count = if steady { all } else { self.voices_each.min(all) };
        // Sentences that follow each other are similar: the next ones are said by other voices.
        (0..count).map(move |k| (n / self.every + k) % all)
    }
}
