//! The offline recogniser: Debian's pocketsphinx with a language model made for the scene.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use scene::Scene;

use super::agreement::hypotheses;
use super::ffi::{Decoded, Decoder, DecoderFiles, Library};
use super::{Hypothesis, RecogniseError, Recogniser, RecogniserUnavailable};
use crate::devices::audio::{denoised, with_noise_floor};
use crate::devices::language_model::{Trigram, Weights, common_words, scene_sentences};
use crate::devices::pronunciation::{EspeakSpelling, Pronunciations};

/// Where the recogniser's parts are, and what of it can be set.
#[derive(Clone, Debug, PartialEq)]
pub struct PocketSphinxOptions {
    /// The shared object: a path, or a name that the loader finds.
    pub library: PathBuf,
    /// The folder with `en-us` (the acoustic model) and `cmudict-en-us.dict`.
    pub model: PathBuf,
    /// A folder of this service's own for the scene's dictionary and language model.
    pub work: PathBuf,
    /// Balance of the language model.
    pub weights: Weights,
    /// Hypotheses returned at most.
    pub n_best_max: usize,
}

impl PocketSphinxOptions {
    /// What Debian's packages install, with work files in `work`.
    pub fn debian(work: impl Into<PathBuf>) -> Self {
        Self {
            library: "libpocketsphinx.so.3".into(),
            model: "/usr/share/pocketsphinx/model/en-us".into(),
            work: work.into(),
            weights: Weights::default(),
            n_best_max: 5,
        }
    }
}

/// A recogniser for the words of one scene.
pub struct PocketSphinx {
    decoder: Decoder,
    n_best_max: usize,
    unpronounceable: Vec<String>,
}

impl PocketSphinx {
    /// Builds the scene's language model and dictionary and opens a decoder with them. Takes some
    /// 0.1 s.
    ///
    /// # Errors
    /// If the library, the model or the folder for work files is not there.
    pub fn open(
        scene: &Scene,
        options: &PocketSphinxOptions,
    ) -> Result<Self, RecogniserUnavailable> {
        let library = Library::open(&options.library).map_err(|error| {
            RecogniserUnavailable::Library { file: options.library.clone(), reason: reason(&error) }
        })?;
        let acoustic_model = options.model.join("en-us");
        // The library may end the process over a missing file, so each is looked for first.
        for file in ["mdef", "means", "variances", "transition_matrices", "sendump", "feat.params"]
        {
            readable(&acoustic_model.join(file))?;
        }
        let dictionary = read(&options.model.join("cmudict-en-us.dict"))?;
        let model = Trigram::train(&scene_sentences(scene), common_words(), options.weights);
        let spoken = Pronunciations::collect(model.vocabulary(), &dictionary, &EspeakSpelling);
        let log = options.work.join("pocketsphinx.log");
        if let Some(reason) = last_words(&log) {
            return Err(RecogniserUnavailable::Refused { reason });
        }
        let files = DecoderFiles {
            acoustic_model: &acoustic_model,
            dictionary: &write(&options.work, "scene.dict", &spoken.to_text())?,
            language_model: &write(&options.work, "scene.lm", &model.to_arpa())?,
            log: &write(&options.work, "pocketsphinx.log", "")?,
        };
        let decoder = Decoder::open(library, &files)
            .ok_or_else(|| RecogniserUnavailable::Refused { reason: complaints(&log) })?;
        let unpronounceable = spoken.missing().to_vec();
        Ok(Self { decoder, n_best_max: options.n_best_max, unpronounceable })
    }

    /// Words of the scene that cannot be recognised because nothing tells how they sound.
    pub fn unpronounceable(&self) -> &[String] {
        &self.unpronounceable
    }
}

/// Paths through the lattice that are looked at: the same words come back with other times.
const PATHS_MAX: usize = 100;

impl Recogniser for PocketSphinx {
    fn recognise(
        &mut self,
        pcm: &[i16],
        speech: Range<usize>,
    ) -> Result<Vec<Hypothesis>, RecogniseError> {
        let clear = denoised(pcm, &speech);
        let pcm = with_noise_floor(&clear);
        let decoded = self.decoder.decode(&pcm, PATHS_MAX).ok_or(RecogniseError::Failed)?;
        Ok(heard(&decoded, self.n_best_max))
    }
}

/// What a path's score is divided by before it becomes a weight: path scores are far too sure of
/// themselves because frames are not independent. It is the library's own (its option `-ascale`),
/// and with it the words' probabilities are about as often right as they say.
const SCORE_SCALE: f64 = 20.0;

fn heard(decoded: &Decoded, at_most: usize) -> Vec<Hypothesis> {
    let words_of = |text: &str| text.split(' ').filter_map(spelling).collect::<Vec<_>>().join(" ");
    let mut paths: Vec<(String, f64)> =
        decoded.n_best.iter().map(|path| (words_of(&path.text), path.ln_score)).collect();
    // The best path may lie outside the paths that were looked at; it is the best all the same.
    let best = words_of(&decoded.best.join(" "));
    if paths.iter().all(|(text, _)| *text != best) {
        let top = paths.iter().map(|(_, score)| *score).reduce(f64::max).unwrap_or(0.0);
        paths.insert(0, (best, top));
    }
    hypotheses(&paths, SCORE_SCALE, at_most)
}

/// The word without its pronunciation mark; `None` for silence, noise and the sentence's ends.
fn spelling(word: &str) -> Option<String> {
    if word.starts_with(['<', '[', '+']) {
        return None;
    }
    let word = word.split_once('(').map_or(word, |(word, _)| word);
    (!word.is_empty()).then(|| word.to_owned())
}

fn readable(path: &Path) -> Result<(), RecogniserUnavailable> {
    match fs::File::open(path) {
        Ok(_) => Ok(()),
        Err(source) => Err(RecogniserUnavailable::Model { path: path.to_owned(), source }),
    }
}

fn read(path: &Path) -> Result<String, RecogniserUnavailable> {
    fs::read_to_string(path)
        .map_err(|source| RecogniserUnavailable::Model { path: path.to_owned(), source })
}

fn write(folder: &Path, name: &str, text: &str) -> Result<PathBuf, RecogniserUnavailable> {
    let path = folder.join(name);
    let written = fs::create_dir_all(folder).and_then(|()| fs::write(&path, text));
    match written {
        Ok(()) => Ok(path),
        Err(source) => Err(RecogniserUnavailable::Work { path, source }),
    }
}

/// The errors in the library's log, the last three.
fn complaints(log: &Path) -> String {
    let text = fs::read_to_string(log).unwrap_or_default();
    let errors: Vec<&str> = text.lines().filter(|line| line.starts_with("ERROR")).collect();
    match errors.len() {
        0 => "no reason given".to_owned(),
        n => errors[n.saturating_sub(3)..].join("; "),
    }
}

/// Why the library ended the process when it was opened last, if it did, which it does over some
/// damaged files. The log is removed, so that the start after this one tries again.
fn last_words(log: &Path) -> Option<String> {
    let text = fs::read_to_string(log).ok()?;
    let words = text.lines().rfind(|line| line.starts_with("FATAL"))?;
    fs::remove_file(log).ok()?;
    Some(words.to_owned())
}

/// The error with what it stems from: the loader's own message comes last.
fn reason(error: &dyn std::error::Error) -> String {
    let source = error.source().map(|source| format!(": {source}")).unwrap_or_default();
    format!("{error}{source}")
}

#[cfg(test)]
#[path = "pocketsphinx_tests.rs"]
mod tests;
