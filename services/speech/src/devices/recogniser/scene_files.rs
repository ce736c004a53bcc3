//! The files that the recogniser knows a scene by, made once and kept.
//!
//! Invariant: a file is used only if it is byte for byte what was made from the same scene, weights,
//! pronouncing dictionary and program.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use scene::{Fnv1a, Scene};

use super::RecogniserUnavailable;
use crate::devices::language_model::{Trigram, Weights, common_words, scene_sentences};
use crate::devices::pronunciation::{EspeakSpelling, Pronunciations};

/// A scene's files.
pub(super) struct SceneFiles {
    pub(super) dictionary: PathBuf,
    pub(super) language_model: PathBuf,
    /// Words of the scene that cannot be recognised because nothing tells how they sound.
    pub(super) unpronounceable: Vec<String>,
    mark: PathBuf,
}

impl SceneFiles {
    /// Those that lie in `work` where they are still right, else new ones.
    pub(super) fn get(
        scene: &Scene,
        weights: Weights,
        pronouncing: &Path,
        work: &Path,
    ) -> Result<Self, RecogniserUnavailable> {
        let origin = origin(scene, weights, pronouncing);
        let mut files = Self {
            dictionary: work.join("scene.dict"),
            language_model: work.join("scene.lm"),
            unpronounceable: Vec::new(),
            mark: work.join("scene.mark"),
        };
        if !files.are_of(origin) {
            files.make(scene, weights, pronouncing, work, origin)?;
        }
        Ok(files)
    }

    /// Has them made anew the next time.
    pub(super) fn forget(&self) {
        // Where it cannot be removed, it cannot be written anew either, which is told then.
        let _ = fs::remove_file(&self.mark);
    }

    /// Whether the files are those of this origin, and as they were written.
    fn are_of(&self, origin: u64) -> bool {
        let text = |file| fs::read_to_string(file).unwrap_or_default();
        let contents = contents(&text(&self.dictionary), &text(&self.language_model));
        text(&self.mark) == mark(origin, contents)
    }

    fn make(
        &mut self,
        scene: &Scene,
        weights: Weights,
        pronouncing: &Path,
        work: &Path,
        origin: u64,
    ) -> Result<(), RecogniserUnavailable> {
        let dictionary = fs::read_to_string(pronouncing).map_err(|source| {
            RecogniserUnavailable::Model { path: pronouncing.to_owned(), source }
        })?;
        let model = Trigram::train(&scene_sentences(scene), common_words(), weights);
        let spoken = Pronunciations::collect(model.vocabulary(), &dictionary, &EspeakSpelling);
        let (dictionary, model) = (spoken.to_text(), model.to_arpa());
        self.unpronounceable = spoken.missing().to_vec();
        write(work, &self.dictionary, &dictionary)?;
        write(work, &self.language_model, &model)?;
        if spoken.missing().is_empty() {
            write(work, &self.mark, &mark(origin, contents(&dictionary, &model)))?;
        }
        // Else they are made again the next time: by then there may be a program that knows the words.
        Ok(())
    }
}

/// Everything that the files depend on.
fn origin(scene: &Scene, weights: Weights, pronouncing: &Path) -> u64 {
    let program = std::env::current_exe().unwrap_or_default();
    let scene = (scene.name(), scene.noun(), scene.objects(), scene.attributes(), scene.words());
    let mut hash = Fnv1a::new();
    hash.text(&format!("{scene:?} {weights:?} {} {}", stand(pronouncing), stand(&program)));
    hash.value()
}

/// Length and time of a file; empty where it cannot be told.
fn stand(file: &Path) -> String {
    let Ok(metadata) = fs::metadata(file) else { return String::new() };
    let changed = metadata.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
    format!("{} {:?}", metadata.len(), changed)
}

fn contents(dictionary: &str, model: &str) -> u64 {
    let mut hash = Fnv1a::new();
    hash.text(dictionary);
    hash.text(model);
    hash.value()
}

fn mark(origin: u64, contents: u64) -> String {
    format!("{origin:016x} {contents:016x}")
}

fn write(folder: &Path, file: &Path, text: &str) -> Result<(), RecogniserUnavailable> {
    let written = fs::create_dir_all(folder).and_then(|()| fs::write(file, text));
    written.map_err(|source| RecogniserUnavailable::Work { path: file.to_owned(), source })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::testing::{bowls, tools};

    fn changed(files: &SceneFiles) -> std::time::SystemTime {
        fs::metadata(&files.language_model).unwrap().modified().unwrap()
    }

    #[test]
    fn they_are_made_once_and_again_when_anything_has_changed() {
        let work = tempfile::tempdir().unwrap();
        let pronouncing = work.path().join("words.dict");
        fs::copy("/usr/share/pocketsphinx/model/en-us/cmudict-en-us.dict", &pronouncing).unwrap();
        let get = |scene: &Scene, weights| {
            SceneFiles::get(scene, weights, &pronouncing, &work.path().join("made")).unwrap()
        };
        let first = get(&bowls(), Weights::default());
        let made = changed(&first);
        let again = get(&bowls(), Weights::default());
        assert_eq!(first.unpronounceable, Vec::<String>::new());
        assert_eq!(changed(&again), made);
        assert_eq!((&again.unpronounceable, first.unpronounceable.len()), (&Vec::new(), 0));
        fs::write(&first.dictionary, "cut short").unwrap();
        let mended = get(&bowls(), Weights::default());
        assert!(fs::read_to_string(&mended.dictionary).unwrap().contains("B OW L"));
        let bowls_model = fs::read_to_string(&first.language_model).unwrap();
        let tools = get(&tools(), Weights::default());
        assert_ne!(fs::read_to_string(&tools.language_model).unwrap(), bowls_model);
        let made = changed(&tools);
        tools.forget();
        assert_ne!(changed(&get(&self::tools(), Weights::default())), made);
    }
}
