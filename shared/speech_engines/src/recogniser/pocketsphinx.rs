//! The offline recogniser: Debian's pocketsphinx with a language model of the scene.

use std::error::Error as _;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use scene::Scene;

use super::ffi::{Decoded, Decoder, DecoderFiles, FRAMES_PER_S, Library, Passes};
use super::scene_files::SceneFiles;
use super::word_confidence::hypotheses;
use super::{
    FirstView, InterimDecoder, InterimDecoderOpener, RecogniseError, Recogniser,
    RecogniserUnavailable, Recognition,
};
use crate::audio::{RATE_HZ, denoised, with_noise_floor};
use messages::Hypothesis;

/// Files and settings of the recogniser.
#[derive(Clone, Debug, PartialEq)]
pub struct PocketSphinxOptions {
    /// The shared object: a path, or a name for the loader.
    pub library: PathBuf,
    /// The folder with `en-us` (the acoustic model) and `cmudict-en-us.dict`.
    pub model: PathBuf,
    /// Private folder for the scene's dictionary and language model.
    pub work: PathBuf,
}

impl PocketSphinxOptions {
    /// Returns the files of Debian's packages, with work files in `work`.
    pub fn debian(work: impl Into<PathBuf>) -> Self {
        Self {
            library: "libpocketsphinx.so.3".into(),
            model: "/usr/share/pocketsphinx/model/en-us".into(),
            work: work.into(),
        }
    }
}

/// A recogniser for the words of one scene.
pub struct PocketSphinx {
    decoder: Decoder,
    unpronounceable: Vec<String>,
    opener: Opener,
}

/// Parts needed to open a decoder.
#[derive(Clone)]
struct Opener {
    library: PathBuf,
    files: DecoderFiles,
    work: PathBuf,
}

impl Opener {
    /// Returns the file for the library's messages.
    fn log(&self, passes: Passes) -> PathBuf {
        self.work.join(match passes {
            Passes::All => "pocketsphinx.log",
            Passes::First => "interim.log",
        })
    }

    fn open(&self, passes: Passes) -> Result<Decoder, RecogniserUnavailable> {
        let (library, log) = (library(&self.library)?, self.log(passes));
        safe_files::create_private(&log)
            .map_err(|error| RecogniserUnavailable::unwritable(&log, &error))?;
        Decoder::open(library, &self.files, passes, &log)
            .ok_or_else(|| RecogniserUnavailable::rejected(&last_errors(&log)))
    }
}

fn library(file: &Path) -> Result<Library, RecogniserUnavailable> {
    Library::open(file).map_err(|error| {
        // The source is the loader's own message.
        let source = error.source().map(|source| format!(": {source}")).unwrap_or_default();
        RecogniserUnavailable::Missing(format!(
            "{} cannot be loaded: {error}{source}; help: install the package libpocketsphinx3",
            file.display()
        ))
    })
}

impl PocketSphinx {
    /// Opens a decoder with the scene's language model and dictionary, which it makes first if
    /// necessary. Takes about 0.1 s.
    ///
    /// # Errors
    /// If the library, the model or the folder for work files is missing.
    pub fn open(
        scene: &Scene,
        options: &PocketSphinxOptions,
    ) -> Result<Self, RecogniserUnavailable> {
        // The library is checked first: its package depends on the rest.
        library(&options.library)?;
        // The library may end the process over a missing file, so each one is checked first.
        let acoustic_model = options.model.join("en-us");
        for file in ["mdef", "means", "variances", "transition_matrices", "sendump", "feat.params"]
        {
            let file = acoustic_model.join(file);
            safe_files::open_regular(&file)
                .map_err(|error| RecogniserUnavailable::unreadable(&file, &error))?;
        }
        let pronouncing = options.model.join("cmudict-en-us.dict");
        let scene = SceneFiles::get(scene, &pronouncing, &options.work)?;
        let (dictionary, language_model) = (scene.dictionary.clone(), scene.language_model.clone());
        let opener = Opener {
            library: options.library.clone(),
            files: DecoderFiles { acoustic_model, dictionary, language_model },
            work: options.work.clone(),
        };
        if let Some(reason) = last_fatal_error(&opener.log(Passes::All)) {
            scene.invalidate();
            return Err(RecogniserUnavailable::rejected(&reason));
        }
        let decoder = opener.open(Passes::All).inspect_err(|_| scene.invalidate())?;
        let unpronounceable = scene.unpronounceable;
        Ok(Self { decoder, unpronounceable, opener })
    }

    /// Returns the scene's words that cannot be recognised, as their pronunciation is unknown.
    pub fn unpronounceable(&self) -> &[String] {
        &self.unpronounceable
    }
}

/// Audio before the voice that is decoded: 0.2 s. The rest of the lead serves to estimate the
/// noise; to decode it too costs an eighth of the time, and no accuracy is gained.
const LEAD: usize = RATE_HZ as usize / 5;
/// Paths through the lattice that are examined: the same words recur with other times.
const PATHS_MAX: usize = 100;

impl Recogniser for PocketSphinx {
    fn recognise(&mut self, pcm: &[i16], speech: Range<usize>) -> Recognition {
        let (clear, voice) = denoised(pcm, &speech);
        let pcm = with_noise_floor(&clear);
        let near = &pcm[speech.start.saturating_sub(LEAD)..];
        let decoded = self.decoder.decode(near, PATHS_MAX).ok_or_else(failed)?;
        let words_s = Some(words_s(&decoded.best));
        Ok(FirstView { hypotheses: weighed(&decoded), words_s, voice })
    }

    fn is_quick(&self) -> bool {
        true
    }

    fn interim_decoder(&self) -> Option<InterimDecoderOpener> {
        let opener = self.opener.clone();
        Some(Box::new(move || match opener.open(Passes::First) {
            Ok(decoder) => {
                Some(Box::new(FirstPass { decoder, samples: Vec::new() }) as Box<dyn InterimDecoder>)
            }
            Err(error) => {
                tracing::warn!(%error, "no interim results");
                None
            }
        }))
    }
}

fn failed() -> RecogniseError {
    RecogniseError("pocketsphinx rejected the samples".to_owned())
}

/// A single-pass decoder while the audio arrives: less accurate than one of whole utterances.
struct FirstPass {
    decoder: Decoder,
    samples: Vec<i16>,
}

impl InterimDecoder for FirstPass {
    fn begin(&mut self) -> Result<(), RecogniseError> {
        self.samples.clear();
        self.decoder.begin().ok_or_else(failed)
    }

    fn decode(&mut self, pcm: &[i16]) -> Result<String, RecogniseError> {
        let known = self.samples.len();
        self.samples.extend_from_slice(pcm);
        // The estimate of the missing noise improves with the length.
        let new = &with_noise_floor(&self.samples)[known..];
        let text = self.decoder.decode_next(new).ok_or_else(failed)?;
        Ok(plain(&text))
    }
}

/// Divisor of a path's score before it becomes a weight: path scores are overconfident because
/// frames are not independent. It is the library's own (its option `-ascale`), and with it the
/// words' confidences are calibrated.
const SCORE_SCALE: f64 = 20.0;

fn weighed(decoded: &Decoded) -> Vec<Hypothesis> {
    let mut paths: Vec<(String, f64)> =
        decoded.n_best.iter().map(|(text, score)| (plain(text), *score)).collect();
    // The best path may lie outside the paths that were examined; it is the best all the same.
    let best: Vec<String> = decoded.best.iter().filter_map(|(word, _)| spelling(word)).collect();
    let best = best.join(" ");
    if paths.iter().all(|(text, _)| *text != best) {
        let top = paths.iter().map(|(_, score)| *score).reduce(f64::max).unwrap_or(0.0);
        paths.insert(0, (best, top));
    }
    hypotheses(&paths, SCORE_SCALE)
}

/// The acoustic model's name for speech without words, such as the end of a drawn-out "nah".
const SPEECH: &str = "[SPEECH]";

/// Returns the length of the words of a path and the speech between, seconds; 0 without a word.
fn words_s(path: &[(String, u32)]) -> f32 {
    let is_word = |word: &str| spelling(word).is_some();
    if !path.iter().any(|(word, _)| is_word(word)) {
        return 0.0;
    }
    let spoken = path.iter().filter(|(word, _)| is_word(word) || word == SPEECH);
    spoken.map(|(_, frames)| *frames as f32 / FRAMES_PER_S).sum()
}

/// Returns the words without markers and fillers.
fn plain(text: &str) -> String {
    text.split(' ').filter_map(spelling).collect::<Vec<_>>().join(" ")
}

/// Returns the word without its pronunciation marker; `None` for silence, noise and markers.
fn spelling(word: &str) -> Option<String> {
    if word.starts_with(['<', '[', '+']) {
        return None;
    }
    let word = word.split_once('(').map_or(word, |(word, _)| word);
    (!word.is_empty()).then(|| word.to_owned())
}

/// Returns the last three errors in the library's log.
fn last_errors(log: &Path) -> String {
    let text = fs::read_to_string(log).unwrap_or_default();
    let errors: Vec<&str> = text.lines().filter(|line| line.starts_with("ERROR")).collect();
    match errors.len() {
        0 => "no reason given".to_owned(),
        n => errors[n.saturating_sub(3)..].join("; "),
    }
}

/// Returns why the library ended the process when it was opened last, if it did, which it does over
/// some damaged files. Removes the log, so that the start after this one tries again.
fn last_fatal_error(log: &Path) -> Option<String> {
    let text = fs::read_to_string(log).ok()?;
    let words = text.lines().rfind(|line| line.starts_with("FATAL"))?;
    fs::remove_file(log).ok()?;
    Some(words.to_owned())
}

#[cfg(test)]
#[path = "pocketsphinx_tests.rs"]
mod tests;
