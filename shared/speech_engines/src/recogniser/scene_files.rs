//! The recogniser's files of a scene, made once and cached.
//!
//! Invariant: a file is used only if it is byte for byte the one made from the same scene,
//! pronouncing dictionary and program.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use scene::{Scene, StableHash};

use super::RecogniserUnavailable;
use crate::language_model::{Trigram, common_words, scene_sentences};
use crate::pronunciation::{Pronunciations, espeak_phones};

/// Files of a scene.
pub(super) struct SceneFiles {
    pub(super) dictionary: PathBuf,
    pub(super) language_model: PathBuf,
    /// Words of the scene that cannot be recognised because their pronunciation is unknown.
    pub(super) unpronounceable: Vec<String>,
    mark: PathBuf,
}

impl SceneFiles {
    /// Returns the files in `work` if they are still valid, otherwise makes them.
    pub(super) fn get(
        scene: &Scene,
        pronouncing: &Path,
        work: &Path,
    ) -> Result<Self, RecogniserUnavailable> {
        let origin = origin(scene, pronouncing);
        let mut files = Self {
            dictionary: work.join("scene.dict"),
            language_model: work.join("scene.lm"),
            unpronounceable: Vec::new(),
            mark: work.join("scene.mark"),
        };
        if !files.are_of(origin) {
            files.make(scene, pronouncing, work, origin)?;
        }
        Ok(files)
    }

    /// Invalidates the files, so that they are made again the next time.
    pub(super) fn invalidate(&self) {
        // A file that cannot be removed cannot be rewritten either, which is reported then.
        let _ = fs::remove_file(&self.mark);
    }

    /// Returns whether the files are of this origin and unchanged.
    fn are_of(&self, origin: u64) -> bool {
        let text = |file| fs::read_to_string(file).unwrap_or_default();
        let contents = contents(&text(&self.dictionary), &text(&self.language_model));
        text(&self.mark) == mark(origin, contents)
    }

    fn make(
        &mut self,
        scene: &Scene,
        pronouncing: &Path,
        work: &Path,
        origin: u64,
    ) -> Result<(), RecogniserUnavailable> {
        let dictionary = fs::read_to_string(pronouncing)
            .map_err(|error| RecogniserUnavailable::unreadable(pronouncing, &error))?;
        let model = Trigram::train(&scene_sentences(scene), common_words());
        let spoken = Pronunciations::collect(model.vocabulary(), &dictionary, &espeak_phones);
        let (dictionary, model) = (spoken.to_text(), model.to_arpa());
        self.unpronounceable = spoken.missing().to_vec();
        write(work, &self.dictionary, &dictionary)?;
        write(work, &self.language_model, &model)?;
        if spoken.missing().is_empty() {
            write(work, &self.mark, &mark(origin, contents(&dictionary, &model)))?;
        }
        // Otherwise they are made again the next time: espeak-ng may be installed by then.
        Ok(())
    }
}

/// Returns a hash of everything that the files depend on.
fn origin(scene: &Scene, pronouncing: &Path) -> u64 {
    let program = std::env::current_exe().unwrap_or_default();
    let scene = (scene.name(), scene.noun(), scene.objects(), scene.attributes(), scene.words());
    let mut hash = StableHash::default();
    hash.text(&format!("{scene:?} {} {}", version(pronouncing), version(&program)));
    hash.value()
}

/// Returns length and modification time of a file; empty if they are unknown.
fn version(file: &Path) -> String {
    let Ok(metadata) = fs::metadata(file) else { return String::new() };
    let changed = metadata.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
    format!("{} {:?}", metadata.len(), changed)
}

fn contents(dictionary: &str, model: &str) -> u64 {
    let mut hash = StableHash::default();
    hash.text(dictionary);
    hash.text(model);
    hash.value()
}

fn mark(origin: u64, contents: u64) -> String {
    format!("{origin:016x} {contents:016x}")
}

fn write(folder: &Path, file: &Path, text: &str) -> Result<(), RecogniserUnavailable> {
    let written = fs::create_dir_all(folder).and_then(|()| safe_files::replace_private(file, text));
    written.map_err(|error| RecogniserUnavailable::unwritable(file, &error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{bowls, tools};

    fn changed(files: &SceneFiles) -> std::time::SystemTime {
        fs::metadata(&files.language_model).unwrap().modified().unwrap()
    }

    #[test]
    #[ignore = "needs espeak-ng and pocketsphinx"]
    fn scene_files_are_made_once_and_again_after_any_change() {
        let work = tempfile::tempdir().unwrap();
        let pronouncing = work.path().join("words.dict");
        fs::copy("/usr/share/pocketsphinx/model/en-us/cmudict-en-us.dict", &pronouncing).unwrap();
        let get = |scene: &Scene| {
            SceneFiles::get(scene, &pronouncing, &work.path().join("made")).unwrap()
        };
        let first = get(&bowls());
        let made = changed(&first);
        let again = get(&bowls());
        assert_eq!(first.unpronounceable, Vec::<String>::new());
        assert_eq!(changed(&again), made);
        assert_eq!((&again.unpronounceable, first.unpronounceable.len()), (&Vec::new(), 0));
        fs::write(&first.dictionary, "cut short").unwrap();
        let mended = get(&bowls());
        assert!(fs::read_to_string(&mended.dictionary).unwrap().contains("B OW L"));
        let bowls_model = fs::read_to_string(&first.language_model).unwrap();
        let tools = get(&tools());
        assert_ne!(fs::read_to_string(&tools.language_model).unwrap(), bowls_model);
        let made = changed(&tools);
        tools.invalidate();
        assert_ne!(changed(&get(&self::tools())), made);
    }
}
