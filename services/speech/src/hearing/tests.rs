use messages::{GateVerdict, Hypothesis};
use speech_engines::recogniser::{PocketSphinx, PocketSphinxOptions, Recogniser};
use speech_engines::testing::{Said, bowls, say};
use tempfile::TempDir;

use super::*;

/// The first recogniser and the gate, in a room of the bowls.
struct Ears {
    folder: TempDir,
    recogniser: PocketSphinx,
    gate: Gate,
}

impl Ears {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let options = PocketSphinxOptions::debian(folder.path().join("recogniser"));
        let recogniser = PocketSphinx::open(&bowls(), &options).unwrap();
        Self { folder, recogniser, gate: Gate::new(&bowls(), Gate::THRESHOLD) }
    }

    fn hear(&mut self, text: &str, human: bool) -> Result<Vec<Hypothesis>, Rejected> {
        let said = say(text, human, &self.folder.path().join("voice"));
        self.judge(&said)
    }

    fn judge(&mut self, Said { samples, speech }: &Said) -> Result<Vec<Hypothesis>, Rejected> {
        let first = self.recogniser.recognise(samples, speech.clone()).unwrap();
        let first = first.hypotheses.into();
        self.gate.judge(&Heard { first, second: SecondView::NotAsked }, || true)
    }
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn hearing_understands_requests_and_answers_about_the_bowls() {
    let mut ears = Ears::new();
    for (human, text, meant) in [
        (true, "get me the small white bowl", "small white"),
        (false, "get me the small white bowl", "small white"),
        (true, "yes", "yes"),
        (false, "yes", "yes"),
        (true, "no, the clear one", "no clear"),
        (false, "no, the clear one", "no clear"),
        (true, "the counter", "counter"),
        (false, "the counter", "counter"),
        (true, "bring me the big metal bowl from the cabinet", "big metal cabinet"),
        (true, "no, not the white one", "no not white"),
        (false, "it is in the dishwasher", "dishwasher"),
        (false, "stop", "stop"),
        (true, "never mind", "never mind"),
    ] {
        let hypotheses = ears.hear(text, human).unwrap();
        assert_eq!(content(&hypotheses[0]), meant, "{human}: {text}: {hypotheses:?}");
    }
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn hearing_rejects_talk_about_other_things_with_its_text() {
    let mut ears = Ears::new();
    for text in ["my brother works at the hospital in the city", "i have a meeting this afternoon"]
    {
        let rejected = ears.hear(text, true).unwrap_err();
        assert!(
            rejected.text.contains(' ') && rejected.reason == GateVerdict::OtherTalk,
            "{text}: {rejected:?}"
        );
    }
    // Most of its words are words for the robot too; if it is accepted, it must carry no meaning.
    if let Ok(accepted) = ears.hear("what time is it", true) {
        assert_eq!(content(&accepted[0]), "", "{accepted:?}");
    }
    for samples in [0, 1, 100, 400, 1_600, 16_000] {
        let silence =
            Said { samples: vec![0; samples], speech: samples / 2..samples - samples / 2 };
        assert!(ears.judge(&silence).is_err(), "{samples} samples of silence");
    }
}

/// Returns the words that mean something to the robot in these tests; "nope" counts as "no".
fn content(hypothesis: &Hypothesis) -> String {
    const CONTENT: &str = " small white big metal metallic clear plastic round counter cabinet \
        dishwasher yes no not stop never mind ";
    let words = hypothesis.text.split(' ').map(|w| if w == "nope" { "no" } else { w });
    let content: Vec<&str> = words.filter(|w| CONTENT.contains(&format!(" {w} "))).collect();
    content.join(" ")
}
