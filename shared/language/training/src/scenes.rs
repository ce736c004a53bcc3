//! The scenes of the lines, with a reader for each.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use language::{AnswerJudge, Judge, Reader};

use scene::{AttributeId, Question, Scene, ValueId};
use vocabulary::Language;

/// Scenes by their names.
pub struct Scenes(BTreeMap<String, (Scene, Reader)>);

impl Scenes {
    /// Loads the scenes of the project.
    ///
    /// # Errors
    /// A file that cannot be read, or is not a scene.
    pub fn load() -> Result<Self, String> {
        let here = Path::new(env!("CARGO_MANIFEST_DIR"));
        let folders = [
            "scenes",
            "../../../config/scenes",
            "../../../tests/talk/scenes",
            "../../../tests/fixtures/utterances",
        ];
        let mut scenes = BTreeMap::new();
        for path in folders.iter().flat_map(|folder| files(&here.join(folder))) {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            // The words of a scene that `robot import` writes are those of `blocks`.
            let is_imported = stem.ends_with("-blocks");
            if is_imported || path.extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let is_fixture = path.components().any(|part| part.as_os_str() == "utterances");
            let name = if is_fixture { format!("table {stem}") } else { stem };
            let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
            let scene = Scene::from_toml(&name, &text).map_err(|problems| problems.to_string())?;
            let reader = Reader::new(&scene, Language::Careful);
            scenes.insert(name, (scene, reader));
        }
        Ok(Self(scenes))
    }

    /// Returns the same scenes, read with another judge.
    pub fn with_judge(&self, judge: &Arc<Judge>) -> Self {
        self.with(|reader| reader.with_judge(judge.clone()))
    }

    /// Returns the same scenes, read with another judge of answers.
    pub fn with_answer_judge(&self, judge: &Arc<AnswerJudge>) -> Self {
        self.with(|reader| reader.with_answer_judge(judge.clone()))
    }

    fn with(&self, change: impl Fn(Reader) -> Reader) -> Self {
        let changed = |(name, (scene, reader)): (&String, &(Scene, Reader))| {
            (name.clone(), (scene.clone(), change(reader.clone())))
        };
        Self(self.0.iter().map(changed).collect())
    }

    /// The names of the scenes.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }

    /// Returns a scene with the reader for it.
    ///
    /// # Errors
    /// The name is not that of a scene.
    pub fn get(&self, name: &str) -> Result<&(Scene, Reader), String> {
        self.0.get(name).ok_or_else(|| format!("scene {name} does not exist"))
    }
}

/// The files of a folder, sorted.
pub fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    files.sort();
    files
}

/// Returns the question that an author has worded freely, as far as the scene knows its words.
pub fn question(scene: &Scene, words: &str) -> Question {
    let words = words.to_lowercase();
    let is_open = ["which", "what", "where", "how"].iter().any(|open| words.starts_with(open));
    let attributes = || scene.attributes().iter().enumerate();
    if is_open {
        let named = attributes().find(|(_, attribute)| words.contains(&attribute.name));
        let place = || {
            attributes().find(|(_, it)| words.starts_with("where") && it.name.ends_with("ation"))
        };
        return named
            .or_else(place)
            .map_or(Question::None, |(k, _)| Question::Which(AttributeId::from(k)));
    }
    let values = attributes().flat_map(|(k, attribute)| {
        attribute.values.iter().enumerate().map(move |(v, value)| (k, v, &value.name))
    });
    let found = values.filter(|(.., name)| words.contains(&name.to_lowercase()));
    let longest = found.max_by_key(|(.., name)| name.len());
    longest.map_or(Question::None, |(k, v, _)| {
        Question::Attribute(AttributeId::from(k), ValueId::from(v))
    })
}
