//! `cargo run --release -p reader_training --bin train`: prints how the judge does on each author's lines when it has seen
//! the others' alone, and on these with one typo. With `--write` it trains on all of them, and replaces `vocabulary/judge.bin`.

#![allow(clippy::print_stdout, reason = "a program for the terminal")]

use std::collections::BTreeMap;
use std::path::Path;
use std::process::ExitCode;

use language::{FLOOR, Polarity, ROWS};
use reader_training::{
    Lesson, Line, Linear, Row, Scenes, Score, Scored, exit_code, files, lines, pairs, question,
    table, templates, trained_on, with_typo,
};
use vocabulary::Rng;

/// Passes over the lessons.
const EPOCHS: usize = 4;
/// Rate of the first step of a weight.
const RATE: f64 = 0.0125;
/// How much a lesson of the reader's own tables counts: the rules were made for these lines, and are less often right
/// elsewhere.
const OWN: f64 = 0.5;
/// How much a lesson of a template counts.
const TEMPLATE: f64 = 1.0;
/// Temperature of the judge, as it was fitted to lines that were not seen.
const TEMPERATURE: f64 = 1.15;
/// Parts into which the tables and templates are cut, to score each with what the others teach.
const FOLDS: usize = 5;
/// The reader's own tables, whose labels are what the rules propose.
const TABLES: [&str; 4] = [
    "shared/language/src/tests/conversation.txt",
    "shared/language/src/tests/cases.txt",
    "tests/fixtures/utterances/fresh_1.txt",
    "tests/fixtures/utterances/fresh_2.txt",
];
/// Name of what the tables teach, among the sources.
const OWN_TABLES: &str = "own tables";
/// Name of what the templates teach.
const TEMPLATES: &str = "templates";

fn main() -> ExitCode {
    exit_code(run())
}

/// What one line teaches.
#[derive(Default)]
struct Taught {
    lessons: Vec<Lesson>,
    /// The same line with a slip of the finger in a word that is no value: scored, and not learnt from.
    slips: Vec<Lesson>,
    missed: usize,
    extra: usize,
}

/// What each author, the tables and the templates teach.
type Sources = BTreeMap<String, Vec<Taught>>;

fn run() -> Result<(), String> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let root = here.join("../../..");
    let scenes = Scenes::load()?;
    let mut sources = authors(&scenes, &here.join("lines"))?;
    let authors: Vec<String> = sources.keys().cloned().collect();
    for file in TABLES {
        sources.entry(OWN_TABLES.into()).or_default().extend(of_table(&scenes, &root.join(file))?);
    }
    sources.insert(TEMPLATES.into(), of_templates(&scenes, &here.join("templates.txt"))?);
    if !std::env::args().any(|argument| argument == "--write") {
        validate(&sources, &authors);
        return Ok(());
    }
    let lessons = lessons(&sources, |_, _| true);
    println!("{} lessons", lessons.len());
    let bytes = bytes(&Linear::train(&lessons, EPOCHS, RATE, 1), trained_on()?);
    let path = root.join("shared/language/src/vocabulary/judge.bin");
    safe_files::write_output(&path, &bytes).map_err(|e| format!("{}: {e}", path.display()))
}

/// Prints how each source does when it is not seen, and which temperature fits the authors.
fn validate(sources: &Sources, authors: &[String]) {
    let (mut all, mut slips, mut unseen) = (Score::default(), Score::default(), Vec::new());
    for left_out in authors {
        let (model, score) = without(sources, |name, _| name == left_out);
        let lessons = sources[left_out].iter().flat_map(|taught| &taught.lessons);
        unseen.extend(lessons.map(|it| (model.sums(&it.rows), it.label)));
        println!("{score}  {left_out}, not seen");
        all.extend(score);
        let lessons = sources[left_out].iter().flat_map(|taught| &taught.slips);
        slips.scored.extend(lessons.map(|lesson| judged(&model, lesson)));
    }
    let fitted = Linear::temperature_for(&unseen);
    println!("{all}  all, not seen; temperature {fitted:.2} fits");
    println!("{slips}  the same with one typo a line, not seen");
    for part in [OWN_TABLES, TEMPLATES] {
        let mut all = Score::default();
        for fold in 0..FOLDS {
            all.extend(without(sources, |name, n| name == part && n % FOLDS == fold).1);
        }
        println!("{all}  {part}, each fifth not seen");
    }
}

/// The lessons of the lines that are chosen by the name of their source and their number.
fn lessons(sources: &Sources, is_chosen: impl Fn(&str, usize) -> bool) -> Vec<Lesson> {
    let mut lessons = Vec::new();
    for (name, all) in sources {
        let chosen = all.iter().enumerate().filter(|(n, _)| is_chosen(name, *n));
        lessons.extend(chosen.flat_map(|(_, taught)| taught.lessons.iter().cloned()));
    }
    lessons
}

/// Trains without some lines, and scores these.
fn without(sources: &Sources, is_left_out: impl Fn(&str, usize) -> bool) -> (Linear, Score) {
    let model = Linear::train(&lessons(sources, |name, n| !is_left_out(name, n)), EPOCHS, RATE, 1);
    let mut score = Score::default();
    for (name, all) in sources {
        for (_, taught) in all.iter().enumerate().filter(|(n, _)| is_left_out(name, *n)) {
            score.missed += taught.missed;
            score.extra += taught.extra;
            score.scored.extend(taught.lessons.iter().map(|lesson| judged(&model, lesson)));
        }
    }
    (model, score)
}

fn judged(model: &Linear, lesson: &Lesson) -> Scored {
    let [wanted, denied, neither] =
        model.stated(&lesson.rows, TEMPERATURE).map(|stated| stated * (1.0 - FLOOR));
    let truth = [Polarity::Wanted, Polarity::Denied, Polarity::Neither][lesson.label];
    Scored { truth, stated: [wanted, denied, neither + FLOOR] }
}

fn authors(scenes: &Scenes, folder: &Path) -> Result<Sources, String> {
    let mut authors = Sources::new();
    for path in files(folder) {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let text =
            std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let mut random = Rng::new(1);
        for line in lines(&name, &text)? {
            let mut taught = of_line(scenes, &line, 1.0)?;
            if let Some(slip) = with_typo(&line, &mut random) {
                taught.slips = of_line(scenes, &slip, 1.0)?.lessons;
            }
            authors.entry(name.clone()).or_default().push(taught);
        }
    }
    Ok(authors)
}

fn of_line(scenes: &Scenes, line: &Line, weight: f64) -> Result<Taught, String> {
    let (scene, reader) = scenes.get(&line.scene)?;
    let asked = question(scene, &line.question);
    let mentions = reader.mentions(&line.text, asked);
    let labels = pairs(line, &mentions);
    let examples = reader.examples(&line.text, asked);
    let lesson = |(example, label): (language::Example, &Option<Polarity>)| {
        Some(Lesson { rows: example.rows, label: (*label)? as usize, weight })
    };
    let lessons: Vec<Lesson> = examples.into_iter().zip(&labels).filter_map(lesson).collect();
    let (found, marked) = (lessons.len(), line.marked.len());
    Ok(Taught { lessons, missed: marked - found, extra: labels.len() - found, ..Taught::default() })
}

fn of_templates(scenes: &Scenes, path: &Path) -> Result<Vec<Taught>, String> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut taught = Vec::new();
    for name in scenes.names().filter(|name| !name.starts_with("table ")) {
        for line in templates(&text, name, &scenes.get(name)?.0)? {
            taught.push(of_line(scenes, &line, TEMPLATE)?);
        }
    }
    Ok(taught)
}

fn of_table(scenes: &Scenes, path: &Path) -> Result<Vec<Taught>, String> {
    let mut taught = Vec::new();
    for Row { scene, question, text } in table(scenes, path)? {
        let (_, reader) = scenes.get(&scene)?;
        let lesson = |example: language::Example| {
            let label = example.proposal as usize;
            Lesson { rows: example.rows, label, weight: OWN }
        };
        let lessons = reader.examples(&text, question).into_iter().map(lesson).collect();
        taught.push(Taught { lessons, ..Taught::default() });
    }
    Ok(taught)
}

/// The file of the weights: hash, scale, weights of 16 bits.
fn bytes(model: &Linear, hash: u64) -> Vec<u8> {
    let most =
        (0..ROWS).flat_map(|row| model.row(row)).fold(1e-9, |most: f64, it| most.max(it.abs()));
    let step = most / f64::from(i16::MAX);
    let mut bytes = hash.to_le_bytes().to_vec();
    bytes.extend(((step / TEMPERATURE) as f32).to_le_bytes());
    for weight in (0..ROWS).flat_map(|row| model.row(row)) {
        bytes.extend(((weight / step).round() as i16).to_le_bytes());
    }
    bytes
}
