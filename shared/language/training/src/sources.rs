//! Training data: the authors' lines, the same with a slip, templates, and the reader's own tables.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use language::{Example, Features, Polarity};
use scene::Question;
use vocabulary::Rng;

use crate::line::{Line, Marked, lines};
use crate::linear::Lesson;
use crate::recurrent::Utterance;
use crate::scenes::{Scenes, files, question};
use crate::score::labels;
use crate::slips::with_typo;
use crate::table::{Row, table};
use crate::templates::templates;

/// How much a lesson of the reader's own tables counts.
const OWN: f64 = 2.0;
/// Files of templates, lines of each template in each scene, and how much a lesson of them counts.
const TEMPLATES: [(&str, usize, f64); 2] =
    [("templates.txt", 3, 1.0), ("hard_templates.txt", 1, 0.5)];
/// The reader's own tables.
pub(crate) const TABLES: [&str; 4] = [
    "shared/language/src/tests/conversation.txt",
    "shared/language/src/tests/cases.txt",
    "tests/fixtures/utterances/fresh_1.txt",
    "tests/fixtures/utterances/fresh_2.txt",
];
/// Name of the tables' examples among the sources.
const OWN_TABLES: &str = "own tables";
/// How much a lesson of a line with a slip counts.
const SLIP: f64 = 0.5;

/// An utterance with the training examples from it.
#[derive(Clone, Debug)]
pub struct Taught {
    /// The line.
    pub line: Line,
    /// The question before the utterance.
    pub asked: Question,
    /// One for each value word with a label.
    pub lessons: Vec<Lesson>,
    /// The utterance for the recurrent part.
    pub utterance: Utterance,
    /// The same line with a typing error in a word that is not a value.
    pub slips: Vec<Taught>,
}

/// Examples from each author, the tables and the templates.
#[derive(Clone, Debug)]
pub struct Sources {
    /// Utterances by name of the source.
    pub all: BTreeMap<String, Vec<Taught>>,
    /// Names of the authors.
    pub authors: Vec<String>,
}

impl Sources {
    /// Reads all sources.
    ///
    /// # Errors
    /// A file that cannot be read, or has a wrong line.
    pub fn load(scenes: &Scenes) -> Result<Self, String> {
        let here = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mut all = authors(scenes, &here.join("lines"))?;
        // Files by whole words belong to no author: their lines were made with the judge in mind.
        let authors = all.keys().filter(|name| name.len() == 1).cloned().collect();
        for file in TABLES {
            let taught = of_table(scenes, &here.join("../../..").join(file))?;
            all.entry(OWN_TABLES.into()).or_default().extend(taught);
        }
        for (file, times, weight) in TEMPLATES {
            all.insert(file.into(), of_templates(scenes, &here.join(file), times, weight)?);
        }
        Ok(Self { all, authors })
    }

    /// Names of sources that are not authors.
    pub fn others(&self) -> impl Iterator<Item = &str> {
        self.all.keys().map(String::as_str).filter(|name| !self.authors.iter().any(|it| it == name))
    }

    /// The lessons of the lines that are chosen by the name of their source and their number.
    pub fn lessons(&self, is_chosen: impl Fn(&str, usize) -> bool) -> Vec<Lesson> {
        let mut lessons = Vec::new();
        for (name, all) in &self.all {
            for (_, taught) in all.iter().enumerate().filter(|(n, _)| is_chosen(name, *n)) {
                let slips = taught.slips.iter().flat_map(|it| &it.lessons);
                lessons.extend(taught.lessons.iter().chain(slips).cloned());
            }
        }
        lessons
    }

    /// The utterances of the chosen lines, with their slips.
    pub fn utterances(&self, is_chosen: impl Fn(&str, usize) -> bool) -> Vec<&Utterance> {
        let mut utterances = Vec::new();
        for (name, all) in &self.all {
            for (_, taught) in all.iter().enumerate().filter(|(n, _)| is_chosen(name, *n)) {
                utterances.push(&taught.utterance);
                utterances.extend(taught.slips.iter().map(|slip| &slip.utterance));
            }
        }
        utterances
    }
}

impl Taught {
    fn new(
        line: Line,
        asked: Question,
        features: Features,
        labels: Vec<Option<Polarity>>,
        weight: f64,
    ) -> Self {
        let labels: Vec<Option<usize>> =
            labels.into_iter().map(|label| label.map(|label| label as usize)).collect();
        let lessons = features.examples.into_iter().zip(&labels);
        let lessons = lessons
            .filter_map(|(it, label)| Some(Lesson { rows: it.rows, label: (*label)?, weight }))
            .collect();
        let utterance = Utterance { sequence: features.sequence, labels, weight };
        Self { line, asked, lessons, utterance, slips: Vec::new() }
    }
}

pub(crate) fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

fn authors(scenes: &Scenes, folder: &Path) -> Result<BTreeMap<String, Vec<Taught>>, String> {
    let mut authors = BTreeMap::<String, Vec<Taught>>::new();
    for path in files(folder) {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mut random = Rng::new(1);
        for line in lines(&name, &read(&path)?)? {
            let mut taught = of_line(scenes, line, 1.0)?;
            if let Some(slip) = with_typo(&taught.line, &mut random) {
                taught.slips.push(of_line(scenes, slip, SLIP)?);
            }
            authors.entry(name.clone()).or_default().push(taught);
        }
    }
    Ok(authors)
}

fn of_line(scenes: &Scenes, line: Line, weight: f64) -> Result<Taught, String> {
    let (scene, reader) = scenes.get(&line.scene)?;
    let asked = question(scene, &line.question);
    let features = reader.features(&line.text, asked);
    let labels = labels(&line, features.examples.iter().map(|example| &*example.surface));
    Ok(Taught::new(line, asked, features, labels, weight))
}

fn of_templates(
    scenes: &Scenes,
    path: &Path,
    times: usize,
    weight: f64,
) -> Result<Vec<Taught>, String> {
    let text = read(path)?;
    let mut taught = Vec::new();
    for name in scenes.names().filter(|name| !name.starts_with("table ")) {
        for line in templates(&text, times, name, &scenes.get(name)?.0)? {
            taught.push(of_line(scenes, line, weight)?);
        }
    }
    Ok(taught)
}

fn of_table(scenes: &Scenes, path: &Path) -> Result<Vec<Taught>, String> {
    let mut taught = Vec::new();
    for Row { scene, question: asked, text, said, kind, .. } in table(scenes, path)? {
        let (_, reader) = scenes.get(&scene)?;
        let features = reader.features(&text, asked);
        let polarity =
            |example: &Example| match said.each_ref().map(|it| it.contains(&example.word)) {
                [true, _] => Polarity::Wanted,
                [_, true] => Polarity::Denied,
                _ => Polarity::Neither,
            };
        let marked = |it: &Example| Marked { surface: it.surface.clone(), polarity: polarity(it) };
        let marked: Vec<Marked> = features.examples.iter().map(marked).collect();
        // The tables omit retracted values, and authors deny them.
        let is_plain =
            |polarity: &Polarity| kind != "self-repair" || *polarity != Polarity::Neither;
        let labels = marked.iter().map(|it| Some(it.polarity).filter(is_plain)).collect();
        let line = Line { scene, text, marked, ..Line::default() };
        taught.push(Taught::new(line, asked, features, labels, OWN));
    }
    Ok(taught)
}
