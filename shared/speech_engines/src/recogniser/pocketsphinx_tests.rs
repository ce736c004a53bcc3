use scene::Scene;
use tempfile::TempDir;

use super::*;
use crate::testing::{Said, bowls, say, tools};

fn decoded(best: &str, n_best: &[(&str, f64)]) -> Decoded {
    let scored = |&(text, ln_score): &(&str, f64)| (text.to_owned(), ln_score);
    let best = best.split(' ').map(|word| (word.to_owned(), FRAMES_EACH)).collect();
    Decoded { best, n_best: n_best.iter().map(scored).collect() }
}

/// Length of the words of [`decoded`]: 0.2 s.
const FRAMES_EACH: u32 = 20;

#[test]
fn pocketsphinx_measures_the_words_without_markers_and_noises() {
    for (best, expected_s) in [
        ("<s> the white(2) <sil> one [NOISE] </s>", 0.6),
        ("<s> nah [SPEECH] </s>", 0.4),
        ("<s> [SPEECH] </s>", 0.0),
        ("<sil>", 0.0),
    ] {
        let found = words_s(&decoded(best, &[("no", -9.0)]).best);
        assert!((found - expected_s).abs() < 1e-6, "{best}: {found}");
    }
}

#[test]
fn pocketsphinx_hypotheses_omit_markers_and_silence() {
    let paths =
        [("<s> the white one", -100.0), ("the one", -120.0), ("the white(2) <sil> one", -100.0)];
    let found = weighed(&decoded("<s> the white(2) <sil> one </s>", &paths));
    let texts: Vec<&str> = found.iter().map(|h| h.text.as_str()).collect();
    assert_eq!(texts, ["the white one", "the one"]);
    let other = (-20.0 / SCORE_SCALE).exp();
    assert!((found[0].weight - 2.0 / (2.0 + other)).abs() < 1e-6);
    assert!((f64::from(found[0].word_confidence[1]) - found[0].weight).abs() < 1e-6);
    assert!((found[1].word_confidence[1] - 1.0).abs() < 1e-6);
    assert_eq!(weighed(&decoded("<sil>", &[])), []);
    for (paths, weight) in [(&[][..], 1.0), (&[("no", -9.0)], 0.5)] {
        let best = weighed(&decoded("yes", paths));
        assert_eq!((best[0].text.as_str(), best[0].weight), ("yes", weight), "best path alone");
    }
}

#[test]
fn pocketsphinx_names_the_package_of_a_missing_library() {
    let folder = tempfile::tempdir().unwrap();
    let options = PocketSphinxOptions {
        library: "libpocketsphinx-of-no-machine.so.3".into(),
        ..PocketSphinxOptions::debian(folder.path())
    };
    let error = PocketSphinx::open(&bowls(), &options).err().unwrap().to_string();
    assert!(error.contains("libpocketsphinx-of-no-machine.so.3"), "{error}");
    assert!(error.contains("install the package libpocketsphinx3"), "{error}");
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn pocketsphinx_rejects_missing_and_broken_files_by_name() {
    let speech = Speech::new();
    let usual = speech.options();
    let model = |model| PocketSphinxOptions { model, ..usual.clone() };
    let work = PocketSphinxOptions { work: "/dev/null/folder".into(), ..usual.clone() };
    for (options, expected) in [
        (model("/nonexistent".into()), "/nonexistent/en-us/mdef"),
        (model("/nonexistent".into()), "install the package pocketsphinx-en-us"),
        (model(speech.model_with("means", "")), "Failed to read means"),
        (work, "/dev/null/folder"),
    ] {
        let error = PocketSphinx::open(&bowls(), &options).err().unwrap().to_string();
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn pocketsphinx_stays_closed_for_one_start_after_a_fatal_error() {
    let speech = Speech::new();
    let options = speech.options();
    fs::create_dir_all(&options.work).unwrap();
    let fatal = "INFO: x\nFATAL: \"mdef.c\", line 526: Empty file: mdef\n";
    fs::write(options.work.join("pocketsphinx.log"), fatal).unwrap();
    let error = PocketSphinx::open(&bowls(), &options).err().unwrap().to_string();
    assert!(error.contains("Empty file: mdef"), "{error}");
    assert!(PocketSphinx::open(&bowls(), &options).is_ok());
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn pocketsphinx_is_deterministic_whatever_came_before() {
    let speech = Speech::new();
    let mut recogniser = speech.recogniser(&tools());
    let pen = speech.say("pass me the long black pen", false);
    let first = recognise(&mut recogniser, &pen);
    assert!(first[0].text.contains("black pen"), "{first:?}");
    recognise(&mut recogniser, &speech.say("no the red one", false));
    assert_eq!(recognise(&mut recogniser, &pen), first);
    assert_eq!(recognise(&mut speech.recogniser(&tools()), &pen), first);
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn pocketsphinx_can_pronounce_every_word_of_the_scenes() {
    for scene in [bowls(), tools()] {
        let recogniser = PocketSphinx::open(&scene, &Speech::new().options()).unwrap();
        assert_eq!(recogniser.unpronounceable(), [""; 0], "{}", scene.name());
    }
}

#[test]
#[ignore = "needs espeak-ng and pocketsphinx"]
fn pocketsphinx_publishes_interim_results() {
    let speech = Speech::new();
    let recogniser = speech.recogniser(&bowls());
    let mut decoder = recogniser.interim_decoder().unwrap()().unwrap();
    for human in [true, false] {
        let said = speech.say("bring me the big metal bowl from the cabinet", human);
        decoder.begin().unwrap();
        let mut texts: Vec<String> =
            said.samples.chunks(5_600).map(|block| decoder.decode(block).unwrap()).collect();
        texts.dedup();
        assert!(texts.len() > 3, "{texts:?}");
        let last = texts.last().unwrap();
        assert!(last.contains("metal bowl") || last.contains("cabinet"), "{human}: {texts:?}");
    }
}

fn recognise(recogniser: &mut PocketSphinx, said: &Said) -> Vec<Hypothesis> {
    recogniser.recognise(&said.samples, said.speech.clone()).unwrap().hypotheses
}

/// Synthesised speech and the recogniser's files.
struct Speech {
    folder: TempDir,
}

impl Speech {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    fn options(&self) -> PocketSphinxOptions {
        PocketSphinxOptions::debian(self.folder.path().join("recogniser"))
    }

    /// Copies the model with another content of one file of the acoustic model.
    fn model_with(&self, file: &str, content: &str) -> PathBuf {
        let (genuine, copy) = (self.options().model, self.folder.path().join("model"));
        fs::create_dir_all(copy.join("en-us")).unwrap();
        for entry in fs::read_dir(genuine.join("en-us")).unwrap() {
            let entry = entry.unwrap();
            fs::copy(entry.path(), copy.join("en-us").join(entry.file_name())).unwrap();
        }
        fs::write(copy.join("en-us").join(file), content).unwrap();
        fs::write(copy.join("cmudict-en-us.dict"), "yes Y EH S\n").unwrap();
        copy
    }

    fn recogniser(&self, scene: &Scene) -> PocketSphinx {
        PocketSphinx::open(scene, &self.options()).unwrap()
    }

    fn say(&self, text: &str, human: bool) -> Said {
        say(text, human, &self.folder.path().join("voice"))
    }
}
