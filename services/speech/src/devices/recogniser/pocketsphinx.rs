//! The offline recogniser: Debian's pocketsphinx with a language model made for the scene.

use std::path::{Path, PathBuf};
use std::{fs, io};

use scene::Scene;

use super::ffi::{Decoded, Decoder, DecoderFiles, Library};
use super::{Hypothesis, RecogniseError, Recogniser};
use crate::devices::audio::with_noise_floor;
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

/// Why there is no recogniser.
#[derive(Debug, thiserror::Error)]
pub enum RecogniserUnavailable {
    /// The shared object is missing or is another one.
    #[error("{} cannot be used: {reason} (install the package libpocketsphinx3)", file.display())]
    Library {
        /// The file that was looked for.
        file: PathBuf,
        /// The loader's reason.
        reason: String,
    },
    /// A file of the model is missing.
    #[error("{} cannot be read: {source} (install the package pocketsphinx-en-us)", path.display())]
    Model {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// The scene's dictionary or language model could not be written.
    #[error("{} cannot be written: {source}", path.display())]
    Work {
        /// The file or folder.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// The library would not open a decoder.
    #[error("pocketsphinx refused its model: {reason}")]
    Refused {
        /// The last errors that it reported.
        reason: String,
    },
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
    fn recognise(&mut self, pcm: &[i16]) -> Result<Vec<Hypothesis>, RecogniseError> {
        let pcm = with_noise_floor(pcm);
        let decoded = self.decoder.decode(&pcm, PATHS_MAX).ok_or(RecogniseError::Failed)?;
        Ok(hypotheses(decoded, self.n_best_max))
    }
}

/// The library's own weight of acoustic scores in posteriors (its option `-ascale`): path scores
/// are far too sure of themselves because frames are not independent.
const ACOUSTIC_SCALE: f64 = 20.0;

fn hypotheses(decoded: Decoded, at_most: usize) -> Vec<Hypothesis> {
    let words: Vec<(String, f32)> = (decoded.words.into_iter())
        .filter_map(|(word, ln)| Some((spelling(&word)?, ln.exp().min(1.0) as f32)))
        .collect();
    if words.is_empty() {
        return Vec::new();
    }
    let text = words.iter().map(|(word, _)| word.as_str()).collect::<Vec<_>>().join(" ");
    let mut best = Hypothesis { text, confidence: 0.0, words };
    let mut others: Vec<Hypothesis> = Vec::new();
    let top = decoded.n_best.iter().map(|s| s.ln_score).fold(f64::NEG_INFINITY, f64::max);
    for path in &decoded.n_best {
        let weight = ((path.ln_score - top) / ACOUSTIC_SCALE).exp() as f32;
        let text = path.text.split(' ').filter_map(spelling).collect::<Vec<_>>().join(" ");
        match std::iter::once(&mut best).chain(&mut others).find(|h| h.text == text) {
            Some(hypothesis) => hypothesis.confidence += weight,
            None => others.push(Hypothesis { text, confidence: weight, words: Vec::new() }),
        }
    }
    others.sort_by(|a, b| b.confidence.total_cmp(&a.confidence));
    // The best path may lie outside the paths that were looked at; it is the best all the same.
    let runner_up = others.first().map_or(1.0, |h| h.confidence);
    best.confidence = best.confidence.max(runner_up);
    let mut found = vec![best];
    found.append(&mut others);
    let total: f32 = found.iter().map(|h| h.confidence).sum();
    found.iter_mut().for_each(|h| h.confidence /= total);
    found.truncate(at_most);
    found
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
