//! The recognisers of one robot and its gate: from the samples of an utterance to accepted words.

use std::ops::Range;
use std::time::{Duration, Instant};

use crossbeam_channel::Receiver;

use messages::Hypothesis;
use speech_engines::audio::{RATE_HZ, VoiceEvidence};
use speech_engines::recogniser::{
    FirstView, InterimDecoderOpener, Opinion, PendingOpinion, RecogniseError, Recogniser,
    SecondOpinion,
};

use super::gate::{Gate, Rejected};
use super::heard::{Heard, SecondView};

/// Sound around the voice that the second recogniser hears.
const AROUND: usize = RATE_HZ as usize / 5;
/// Probability from which on a voice speaks: that of most knocks is lower, and that of hardly any
/// voice (docs/speech.md).
const VOICE_MIN: f32 = 0.994;
/// Share of the voiced sound that the words cover, at least: of music and knocks only a part
/// resembles any (docs/speech.md).
const WORDS_MIN: f32 = 0.7;
/// Time limit of the second recogniser for recordings.
const UNHURRIED: Duration = Duration::from_secs(20);

/// The recogniser of the configuration, an optional second one that is asked if the first one is in
/// doubt, and the gate.
pub struct Ensemble {
    first: Box<dyn Recogniser>,
    second: Option<SecondOpinion>,
    gate: Gate,
}

impl Ensemble {
    /// Returns recognisers that are asked in this order.
    pub fn new(first: Box<dyn Recogniser>, second: Option<SecondOpinion>, gate: Gate) -> Self {
        Self { first, second, gate }
    }

    /// Asks the first recogniser; see [`Recogniser::recognise`].
    ///
    /// # Errors
    /// If it fails on these samples.
    pub fn ask_first(
        &mut self,
        pcm: &[i16],
        speech: Range<usize>,
    ) -> Result<FirstView, RecogniseError> {
        self.first.recognise(pcm, speech)
    }

    /// Returns whether the second recogniser decides alone; see [`SecondOpinion::decides`].
    pub fn second_decides(&self) -> bool {
        self.second.as_ref().is_some_and(SecondOpinion::decides)
    }

    /// Returns whether a second recogniser is to be asked: one that decides always, another one if
    /// the first one's hypotheses are worth it. A stop waits for none.
    pub fn is_in_doubt(&self, first: &[Hypothesis]) -> bool {
        let Some(second) = &self.second else { return false };
        let best = first.first();
        let is_stop = best.is_some_and(|best| language::is_stop(&best.text));
        !is_stop && (second.decides() || best.is_some() && !self.gate.is_clear(first))
    }

    /// Returns the views of an utterance about which the second recogniser was asked; without its
    /// opinion it was late.
    pub fn heard(&self, first: FirstView, opinion: Option<Opinion>) -> Heard {
        match opinion {
            None => Heard { first, second: SecondView::Late },
            // Lengths of the first one's words say nothing about other words.
            Some(opinion) if self.second_decides() => {
                let first = FirstView { hypotheses: decided(&opinion), words_s: None, ..first };
                Heard { first, second: SecondView::NotAsked }
            }
            Some(opinion) => Heard { first, second: SecondView::Heard(opinion) },
        }
    }

    /// Lets the second recogniser listen, if there is one and it is free. Beginning together with
    /// the first one saves time; drop the result if that one is sure.
    pub fn second_listens(
        &self,
        pcm: &[i16],
        speech: &Range<usize>,
        until: Instant,
    ) -> Option<PendingOpinion> {
        let end = pcm.len().min(speech.end + AROUND);
        self.second.as_ref()?.begin(&pcm[speech.start.saturating_sub(AROUND)..end], until)
    }

    /// Asks all recognisers needed. `wait` waits for the second one's opinion until a time and
    /// returns whether it has come.
    ///
    /// # Errors
    /// If the first one fails on these samples.
    pub fn recognise(
        &mut self,
        pcm: &[i16],
        speech: Range<usize>,
        wait: impl FnOnce(&Receiver<Opinion>, Instant) -> bool,
    ) -> Result<Heard, RecogniseError> {
        let listening = self.second_listens(pcm, &speech, Instant::now() + UNHURRIED);
        let first = self.ask_first(pcm, speech)?;
        if !self.is_in_doubt(&first.hypotheses) {
            return Ok(Heard { first, second: SecondView::NotAsked });
        }
        let opinion = listening.and_then(|pending| {
            pending.ask_about(&first.hypotheses);
            let is_there = wait(pending.opinion(), pending.until());
            pending.opinion().try_recv().ok().filter(|_| is_there)
        });
        Ok(self.heard(first, opinion))
    }

    /// Returns the hypotheses that count for the samples, in which `speech` are those of the voice.
    ///
    /// # Errors
    /// If the sound has no speech, or none for the robot.
    pub fn judge(
        &self,
        heard: &Heard,
        pcm: &[i16],
        speech: &Range<usize>,
    ) -> Result<Vec<Hypothesis>, Rejected> {
        self.gate.judge(heard, || is_voice(&heard.first, pcm, speech))
    }

    /// See [`Recogniser::is_quick`].
    pub fn is_quick(&self) -> bool {
        self.first.is_quick()
    }

    /// See [`Recogniser::interim_decoder`].
    pub fn interim_decoder(&self) -> Option<InterimDecoderOpener> {
        self.first.interim_decoder()
    }
}

/// Returns the hypotheses of a recogniser that decides alone. Of too many words only a stop counts.
fn decided(opinion: &Opinion) -> Vec<Hypothesis> {
    if opinion.is_too_long() && !language::is_stop(&opinion.text) {
        let words = opinion.text.split_whitespace().count();
        tracing::warn!(words, "words of the server are too many for an utterance");
        return Vec::new();
    }
    opinion.alone()
}

/// Returns whether a voice says the words of the samples, in which `speech` are those of the voice.
pub fn is_voice(first: &FirstView, pcm: &[i16], speech: &Range<usize>) -> bool {
    let voice = first.voice.unwrap_or_else(|| VoiceEvidence::in_speech(pcm, speech));
    let is_said = |words_s| words_s > 0.0 && words_s >= WORDS_MIN * voice.voiced_s;
    voice.probability >= VOICE_MIN && first.words_s.is_none_or(is_said)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_a_server_that_are_too_many_count_only_if_they_stop_the_arm() {
        let decided = |text: String| {
            decided(&Opinion { text, ln_own: 0.0, ln_likelihood: Vec::new(), no_speech: 0.0 })
        };
        assert_eq!(decided("white ".repeat(32))[0].word_confidence.len(), 32);
        assert!(decided("white ".repeat(33)).is_empty());
        assert!(decided("x".repeat(2_001)).is_empty());
        assert_eq!(decided("stop ".repeat(33)).len(), 1);
    }

    #[test]
    fn voice_says_words_that_are_most_of_its_sound() {
        let voice = |probability, voiced_s| Some(VoiceEvidence { probability, voiced_s });
        for (words_s, voice, expected) in [
            (Some(0.4), voice(0.999, 0.45), true),
            (Some(0.4), voice(0.99, 0.45), false),
            (Some(0.2), voice(0.999, 0.45), false),
            (Some(0.0), voice(0.999, 0.0), false),
            (None, voice(0.999, 2.0), true),
        ] {
            let first = FirstView { words_s, voice, ..FirstView::default() };
            assert_eq!(is_voice(&first, &[], &(0..0)), expected, "{first:?}");
        }
    }
}
