//! The offline recogniser: Debian's pocketsphinx with a language model made for the scene.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use scene::Scene;

use super::agreement::hypotheses;
use super::ffi::{Decoded, Decoder, DecoderFiles, Library, Passes};
use super::scene_files::SceneFiles;
use super::{
    Hypothesis, Preview, PreviewOpener, RecogniseError, Recogniser, RecogniserUnavailable,
};
use crate::devices::audio::{denoised, with_noise_floor};
use crate::devices::language_model::Weights;

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
    files: Files,
}

/// What decoders are opened with.
#[derive(Clone)]
struct Files {
    library: PathBuf,
    acoustic_model: PathBuf,
    dictionary: PathBuf,
    language_model: PathBuf,
    work: PathBuf,
}

impl Files {
    fn library(&self) -> Result<Library, RecogniserUnavailable> {
        Library::open(&self.library).map_err(|error| RecogniserUnavailable::Library {
            file: self.library.clone(),
            reason: reason(&error),
        })
    }

    /// Where the library's messages go.
    fn log(&self, passes: Passes) -> PathBuf {
        self.work.join(match passes {
            Passes::All => "pocketsphinx.log",
            Passes::First => "preview.log",
        })
    }

    fn open(&self, passes: Passes) -> Result<Decoder, RecogniserUnavailable> {
        let library = self.library()?;
        let log = self.log(passes);
        fs::write(&log, "")
            .map_err(|source| RecogniserUnavailable::Work { path: log.clone(), source })?;
        let files = DecoderFiles {
            acoustic_model: &self.acoustic_model,
            dictionary: &self.dictionary,
            language_model: &self.language_model,
            log: &log,
            passes,
        };
        Decoder::open(library, &files)
            .ok_or_else(|| RecogniserUnavailable::Refused { reason: complaints(&log) })
    }
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
        // The library comes first: where it is missing, its package brings the rest.
        let files = Files {
            library: options.library.clone(),
            acoustic_model: options.model.join("en-us"),
            dictionary: PathBuf::new(),
            language_model: PathBuf::new(),
            work: options.work.clone(),
        };
        files.library()?;
        // The library may end the process over a missing file, so each is looked for first.
        for file in ["mdef", "means", "variances", "transition_matrices", "sendump", "feat.params"]
        {
            readable(&files.acoustic_model.join(file))?;
        }
        let pronouncing = options.model.join("cmudict-en-us.dict");
        let scene = SceneFiles::get(scene, options.weights, &pronouncing, &options.work)?;
        if let Some(reason) = last_words(&files.log(Passes::All)) {
            scene.forget();
            return Err(RecogniserUnavailable::Refused { reason });
        }
        let SceneFiles { dictionary, language_model, .. } = &scene;
        let (dictionary, language_model) = (dictionary.clone(), language_model.clone());
        let files = Files { dictionary, language_model, ..files };
        let decoder = files.open(Passes::All).inspect_err(|_| scene.forget())?;
        let unpronounceable = scene.unpronounceable;
        Ok(Self { decoder, n_best_max: options.n_best_max, unpronounceable, files })
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

    fn is_quick(&self) -> bool {
        true
    }

    fn preview(&self) -> Option<PreviewOpener> {
        let files = self.files.clone();
        Some(Box::new(move || match files.open(Passes::First) {
            Ok(decoder) => Some(Box::new(Rough { decoder, heard: Vec::new() }) as Box<dyn Preview>),
            Err(error) => {
                tracing::warn!(%error, "no transcript while somebody speaks");
                None
            }
        }))
    }
}

/// A decoder that goes through the sound once while it comes in: less sure than one that has heard
/// the whole.
struct Rough {
    decoder: Decoder,
    heard: Vec<i16>,
}

impl Preview for Rough {
    fn begin(&mut self) -> Result<(), RecogniseError> {
        self.heard.clear();
        self.decoder.begin().ok_or(RecogniseError::Failed)
    }

    fn hear(&mut self, pcm: &[i16]) -> Result<String, RecogniseError> {
        let known = self.heard.len();
        self.heard.extend_from_slice(pcm);
        // How much noise it lacks can be told better the more was heard.
        let new = &with_noise_floor(&self.heard)[known..];
        let text = self.decoder.hear(new).ok_or(RecogniseError::Failed)?;
        Ok(plain(&text))
    }
}

/// What a path's score is divided by before it becomes a weight: path scores are far too sure of
/// themselves because frames are not independent. It is the library's own (its option `-ascale`),
/// and with it the words' probabilities are about as often right as they say.
const SCORE_SCALE: f64 = 20.0;

fn heard(decoded: &Decoded, at_most: usize) -> Vec<Hypothesis> {
    let mut paths: Vec<(String, f64)> =
        decoded.n_best.iter().map(|path| (plain(&path.text), path.ln_score)).collect();
    // The best path may lie outside the paths that were looked at; it is the best all the same.
    let best = plain(&decoded.best.join(" "));
    if paths.iter().all(|(text, _)| *text != best) {
        let top = paths.iter().map(|(_, score)| *score).reduce(f64::max).unwrap_or(0.0);
        paths.insert(0, (best, top));
    }
    hypotheses(&paths, SCORE_SCALE, at_most)
}

/// The words without marks and fillers.
fn plain(text: &str) -> String {
    text.split(' ').filter_map(spelling).collect::<Vec<_>>().join(" ")
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
