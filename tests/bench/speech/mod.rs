//! Spoken input: how much of it is understood, how late, and what it costs.
//!
//! The sentences are spoken by programs, mixed with noise, and go the service's own way: detector
//! of speech, recogniser, gate, reading. Everything but times is the same in every run. No person
//! spoke: the figures compare methods and show what noise does; they promise nothing about people.

mod corpus;
mod endings;
mod listener;
mod score;
mod tables;
mod voices;

use crate::report::{Report, print};
use ::speech::devices::recogniser::RecogniserUnavailable;
use ::speech::devices::vad::SegmenterOptions;
use corpus::Corpus;
use language::{Language, Reader};
use listener::Listener;
use score::Score;
use voices::Voices;

/// One clip's score, and what clip it is.
struct Trial {
    sentence: usize,
    snr_db: f64,
    score: Score,
}

pub(crate) fn measure(report: &mut Report, quick: bool) {
    if let Some(missing) = Voices::missing() {
        return print(&format!("spoken input is left out: {missing} is not installed"));
    }
    let voices = Voices::new().expect("a folder for what is spoken");
    let levels: &[f64] = if quick { &[25.0, 10.0] } else { &[25.0, 20.0, 15.0, 10.0] };
    for corpus in [Corpus::main(), Corpus::fresh(), Corpus::utterances()] {
        let mut ears = match Ears::open(&corpus) {
            Ok(ears) => ears,
            Err(error) => return print(&format!("spoken input is left out: {error}")),
        };
        let trials = ears.hear(&corpus, &voices, levels);
        tables::add(report, &corpus, levels, &trials);
        let what = format!("start of the recogniser: {}", corpus.name);
        report.add(&what, "ms", &ears.starts_ms, "from the scene to ready for the first sound");
    }
}

pub(crate) fn measure_endings(report: &mut Report, quick: bool) {
    if let Some(missing) = Voices::missing() {
        return print(&format!("ends of utterances are left out: {missing} is not installed"));
    }
    let voices = Voices::new().expect("a folder for what is spoken");
    endings::measure(report, &voices, quick);
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
        let work = tempfile::tempdir().expect("a folder for the recogniser");
        let (mut listeners, mut starts_ms) = (Vec::new(), Vec::new());
        for (n, scene) in corpus.scenes.iter().enumerate() {
            let folder = work.path().join(n.to_string());
            for _ in 1..STARTS {
                starts_ms.push(Listener::new(scene, &folder)?.start_s * 1e3);
            }
            let listener = Listener::new(scene, &folder)?;
            starts_ms.push(listener.start_s * 1e3);
            listeners.push(listener);
        }
        let reader = |scene| Reader::new(scene, Language::Careful);
        let readers = corpus.scenes.iter().map(reader).collect();
        Ok(Self { listeners, readers, starts_ms, _work: work })
    }

    fn hear(&mut self, corpus: &Corpus, voices: &Voices, levels: &[f64]) -> Vec<Trial> {
        let pause_s = SegmenterOptions::default().closing_pause_s;
        let mut trials = Vec::new();
        for &snr_db in levels {
            for (sentence, said) in corpus.sentences.iter().enumerate() {
                for voice in 0..corpus.voices.len() {
                    let clip = corpus.clip(voices, sentence, voice, snr_db);
                    let heard = self.listeners[said.scene].hear(&clip);
                    let reader = &self.readers[said.scene];
                    let score = Score::of(reader, said, &clip, &heard, pause_s);
                    trials.push(Trial { sentence, snr_db, score });
                }
            }
        }
        trials
    }
}
