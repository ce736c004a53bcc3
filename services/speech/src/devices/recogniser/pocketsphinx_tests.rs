use std::process::Command;
use std::sync::OnceLock;
use std::time::Duration;

use scene::Scene;
use tempfile::TempDir;

use super::super::ffi::Scored;
use super::super::{Gate, Outcome, RejectReason};
use super::*;
use crate::devices::audio::{RATE_HZ, read_wav};
use crate::devices::child;
use crate::devices::testing::{bowls, tools};
use crate::devices::voice::{Synthesiser, VoiceOptions};

fn scored(text: &str, ln_score: f64) -> Scored {
    Scored { text: text.to_owned(), ln_score }
}

fn decoded(best: &[&str], n_best: Vec<Scored>) -> Decoded {
    Decoded { best: best.iter().map(|&word| word.to_owned()).collect(), n_best }
}

#[test]
fn marks_of_pronunciation_and_silence_are_no_words() {
    let paths = vec![
        scored("<s> the white one", -100.0),
        scored("the one", -120.0),
        scored("the white(2) <sil> one", -100.0),
    ];
    let best = ["<s>", "the", "white(2)", "<sil>", "one", "</s>"];
    let found = heard(&decoded(&best, paths), 5);
    let texts: Vec<&str> = found.iter().map(|h| h.text.as_str()).collect();
    assert_eq!(texts, ["the white one", "the one"]);
    let other = (-20.0 / SCORE_SCALE).exp() as f32;
    assert!((found[0].confidence - 2.0 / (2.0 + other)).abs() < 1e-6);
    assert!((found[0].words[1].1 - found[0].confidence).abs() < 1e-6);
    assert!((found[1].words[1].1 - 1.0).abs() < 1e-6);
}

#[test]
fn silence_alone_is_no_hypothesis_and_a_best_path_alone_is_one() {
    assert_eq!(heard(&decoded(&["<sil>"], Vec::new()), 5), []);
    let alone = heard(&decoded(&["yes"], Vec::new()), 5);
    assert_eq!((alone[0].text.as_str(), alone[0].confidence), ("yes", 1.0));
    let outside = heard(&decoded(&["yes"], vec![scored("no", -9.0)]), 5);
    assert_eq!((outside[0].text.as_str(), outside[0].confidence), ("yes", 0.5));
}

#[test]
fn a_missing_library_is_named_with_its_package() {
    let folder = tempfile::tempdir().unwrap();
    let options = PocketSphinxOptions {
        library: "libpocketsphinx-of-no-machine.so.3".into(),
        ..PocketSphinxOptions::debian(folder.path())
    };
    let Err(error) = PocketSphinx::open(&bowls(), &options) else { panic!("no such library") };
    let text = error.to_string();
    assert!(text.contains("libpocketsphinx-of-no-machine.so.3"), "{text}");
    assert!(text.contains("install the package libpocketsphinx3"), "{text}");
}

#[test]
fn a_missing_model_is_named_with_its_package() {
    let Some(world) = World::new() else { return };
    let options = PocketSphinxOptions { model: "/nonexistent".into(), ..world.options() };
    let Err(error) = PocketSphinx::open(&bowls(), &options) else { panic!("no such model") };
    let text = error.to_string();
    assert!(text.contains("/nonexistent/en-us/mdef"), "{text}");
    assert!(text.contains("install the package pocketsphinx-en-us"), "{text}");
}

#[test]
fn a_broken_model_is_refused_with_the_librarys_reason() {
    let Some(world) = World::new() else { return };
    let options = PocketSphinxOptions { model: world.model_with("means", ""), ..world.options() };
    let Err(error) = PocketSphinx::open(&bowls(), &options) else { panic!("a broken model") };
    assert!(matches!(error, RecogniserUnavailable::Refused { .. }), "{error}");
    assert!(error.to_string().contains("Failed to read means"), "{error}");
}

#[test]
fn last_words_of_the_library_keep_it_shut_for_one_start() {
    let Some(world) = World::new() else { return };
    let options = world.options();
    fs::create_dir_all(&options.work).unwrap();
    let last_words = "INFO: x\nFATAL: \"mdef.c\", line 526: Empty file: mdef\n";
    fs::write(options.work.join("pocketsphinx.log"), last_words).unwrap();
    let Err(error) = PocketSphinx::open(&bowls(), &options) else { panic!("it ended the process") };
    assert!(error.to_string().contains("Empty file: mdef"), "{error}");
    assert!(PocketSphinx::open(&bowls(), &options).is_ok());
}

#[test]
fn a_folder_that_cannot_be_written_is_named() {
    let Some(world) = World::new() else { return };
    let options = PocketSphinxOptions { work: "/dev/null/folder".into(), ..world.options() };
    let Err(error) = PocketSphinx::open(&bowls(), &options) else { panic!("no such folder") };
    assert!(error.to_string().contains("/dev/null/folder"), "{error}");
}

#[test]
fn requests_and_answers_about_the_bowls_are_understood() {
    let Some(world) = World::new() else { return };
    let mut ear = world.ear(&bowls());
    for (voice, said, meant) in [
        (world.human(), "get me the small white bowl", &["small", "white"][..]),
        ("espeak-ng", "get me the small white bowl", &["small", "white"]),
        (world.human(), "yes", &["yes"]),
        ("espeak-ng", "yes", &["yes"]),
        (world.human(), "no, the clear one", &["no", "clear"]),
        ("espeak-ng", "no, the clear one", &["no", "clear"]),
        (world.human(), "the counter", &["counter"]),
        ("espeak-ng", "the counter", &["counter"]),
        (
            world.human(),
            "bring me the big metal bowl from the cabinet",
            &["big", "metal", "cabinet"],
        ),
        (world.human(), "no, not the white one", &["no", "not", "white"]),
        ("espeak-ng", "it is in the dishwasher", &["dishwasher"]),
        ("espeak-ng", "stop", &["stop"]),
        (world.human(), "never mind", &["never", "mind"]),
    ] {
        let heard = ear.hear(&world.say(voice, said));
        let Outcome::Accepted(hypotheses) = heard else { panic!("{voice}: {said}: {heard:?}") };
        // "nope" says what "no" says.
        let words = hypotheses[0].text.split(' ').map(|w| if w == "nope" { "no" } else { w });
        let content: Vec<&str> = words.filter(|w| CONTENT.contains(w)).collect();
        assert_eq!(content, meant, "{voice}: {said}: {hypotheses:?}");
    }
}

#[test]
fn talk_about_other_things_is_turned_away_with_its_text() {
    let Some(world) = World::new() else { return };
    let mut ear = world.ear(&bowls());
    for said in ["my brother works at the hospital in the city", "i have a meeting this afternoon"]
    {
        match ear.hear(&world.say(world.human(), said)) {
            Outcome::Rejected { text, reason: RejectReason::NotForTheRobot { .. } } => {
                assert!(text.contains(' '), "{said}: {text}");
            }
            outcome => panic!("{said}: {outcome:?}"),
        }
    }
    // Most of its words are words for the robot too; what is let in must carry no meaning.
    if let Outcome::Accepted(heard) = ear.hear(&world.say(world.human(), "what time is it")) {
        assert!(!heard[0].text.split(' ').any(|w| CONTENT.contains(&w)), "{heard:?}");
    }
}

#[test]
fn equal_sound_is_understood_equally_whatever_came_before() {
    let Some(world) = World::new() else { return };
    let mut ear = world.ear(&tools());
    let pen = world.say("espeak-ng", "pass me the long black pen");
    let first = ear.recognise(&pen).unwrap();
    assert!(first[0].text.contains("black pen"), "{first:?}");
    ear.recognise(&world.say("espeak-ng", "no the red one")).unwrap();
    assert_eq!(ear.recognise(&pen).unwrap(), first);
    let mut again = world.ear(&tools());
    assert_eq!(again.recognise(&pen).unwrap(), first);
}

#[test]
fn silence_and_scraps_of_sound_are_nothing() {
    let Some(world) = World::new() else { return };
    let mut ear = world.ear(&bowls());
    for samples in [0, 1, 100, 400, 1_600, 16_000] {
        let heard = ear.hear(&vec![0; samples]);
        assert!(matches!(heard, Outcome::Rejected { .. }), "{samples}: {heard:?}");
    }
}

#[test]
fn every_word_of_the_scenes_can_be_pronounced() {
    let Some(world) = World::new() else { return };
    for scene in [bowls(), tools()] {
        let recogniser = PocketSphinx::open(&scene, &world.options()).unwrap();
        assert_eq!(recogniser.unpronounceable(), [""; 0], "{}", scene.name());
    }
}

/// Words that mean something to the robot in these tests.
const CONTENT: &[&str] = &[
    "small",
    "white",
    "big",
    "metal",
    "metallic",
    "clear",
    "plastic",
    "round",
    "counter",
    "cabinet",
    "dishwasher",
    "yes",
    "no",
    "not",
    "stop",
    "never",
    "mind",
];

/// What the tests need of the machine: the library, its model and a voice.
struct World {
    folder: TempDir,
    flite: bool,
}

/// Samples of quiet before and behind what is said.
const QUIET: usize = RATE_HZ as usize / 2;

struct TestEar {
    recogniser: PocketSphinx,
    gate: Gate,
}

/// What a preview makes of a sound that comes in pieces: the words after each.
fn previewed(preview: &mut dyn Preview, pcm: &[i16]) -> Vec<String> {
    preview.begin().unwrap();
    let mut told: Vec<String> =
        pcm.chunks(5_600).map(|piece| preview.hear(piece).unwrap()).collect();
    told.dedup();
    told
}

#[test]
fn what_is_being_said_is_told_while_it_comes_in() {
    let Some(world) = World::new() else { return };
    let ear = world.ear(&bowls());
    let mut preview = ear.recogniser.preview().unwrap()().unwrap();
    for voice in [world.human(), "espeak-ng"] {
        let pcm = world.say(voice, "bring me the big metal bowl from the cabinet");
        let told = previewed(preview.as_mut(), &pcm);
        assert!(told.len() > 3, "{told:?}");
        let last = told.last().unwrap();
        assert!(last.contains("metal bowl") || last.contains("cabinet"), "{voice}: {told:?}");
    }
}

impl TestEar {
    fn hear(&mut self, pcm: &[i16]) -> Outcome {
        let hypotheses = self.recognise(pcm).unwrap();
        self.gate.judge(hypotheses)
    }

    /// What the quiet that [`World::say`] adds lies around.
    fn recognise(&mut self, pcm: &[i16]) -> Result<Vec<Hypothesis>, RecogniseError> {
        let quiet = QUIET.min(pcm.len() / 2);
        self.recogniser.recognise(pcm, quiet..pcm.len() - quiet)
    }
}

impl World {
    /// `None` where the machine lacks what is needed; an error where it must not.
    fn new() -> Option<Self> {
        static MISSING: OnceLock<Option<String>> = OnceLock::new();
        let world = Self { folder: tempfile::tempdir().unwrap(), flite: works("flite").is_ok() };
        let missing = MISSING.get_or_init(|| {
            let opened = PocketSphinx::open(&bowls(), &world.options());
            opened.err().map(|e| e.to_string()).or(works("espeak-ng").err())
        });
        let Some(missing) = missing else { return Some(world) };
        let required = std::env::var_os("WHICHONE_REQUIRE_SPEECH").is_some_and(|v| v == "1");
        assert!(!required, "WHICHONE_REQUIRE_SPEECH=1, but {missing}");
        println!("not run here: {missing}");
        None
    }

    fn options(&self) -> PocketSphinxOptions {
        PocketSphinxOptions::debian(self.folder.path().join("ear"))
    }

    /// A copy of the model in which one file of the acoustic model is another.
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

    fn ear(&self, scene: &Scene) -> TestEar {
        let recogniser = PocketSphinx::open(scene, &self.options()).unwrap();
        TestEar { recogniser, gate: Gate::new(scene, Gate::THRESHOLD) }
    }

    /// The voice nearest to a person's: flite's is cut from recordings.
    fn human(&self) -> &'static str {
        if self.flite { "flite" } else { "espeak-ng" }
    }

    /// The sentence with half a second of quiet on either side.
    fn say(&self, voice: &str, text: &str) -> Vec<i16> {
        let quiet = vec![0; QUIET];
        let speech = match voice {
            "flite" => {
                let file = self.folder.path().join("flite.wav");
                let mut flite = Command::new("flite");
                flite.args(["-voice", "slt", "-t", text, "-o"]).arg(&file);
                child::run(flite, Duration::from_secs(20)).unwrap();
                read_wav(&file, 20.0).unwrap()
            }
            _ => {
                let options = VoiceOptions::new(self.folder.path().join("voice"));
                Synthesiser::new(&options).samples(text).unwrap()
            }
        };
        [quiet.as_slice(), &speech, &quiet].concat()
    }
}

/// Whether the program is installed; flite ends its version with an error.
fn works(program: &str) -> Result<(), String> {
    let mut command = Command::new(program);
    command.arg("--version");
    match child::run(command, Duration::from_secs(20)) {
        Ok(()) | Err(child::ChildError::Failed { .. }) => Ok(()),
        Err(error) => Err(error.to_string()),
    }
}
