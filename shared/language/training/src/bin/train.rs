//! `cargo run --release -p reader_training --bin train [--write]`: trains the judge. It prints how the judge does on each author's
//! lines when it has seen the others' alone, and with `--write` replaces `vocabulary/judge.bin`.

#![allow(clippy::print_stdout, reason = "a program for the terminal")]

use std::collections::BTreeMap;
use std::path::Path;
use std::process::ExitCode;

use language::{Mention, Polarity, ROWS};
use reader_training::{
    Lesson, Line, Linear, Row, Scenes, Score, exit_code, files, lines, pairs, question, table,
    trained_on,
};

/// Passes over the lessons.
const EPOCHS: usize = 4;
/// Rate of the first step of a weight.
const RATE: f64 = 0.0125;
/// Probability, under everything, that nothing was said, as in `language::judge`.
const FLOOR: f64 = 0.01;
/// How much a lesson of the reader's own tables counts: the rules were made for these lines, and are less often right
/// elsewhere.
const OWN: f64 = 0.5;
/// Temperature at which lines that were not seen are scored, as it was fitted to them.
const TEMPERATURE: f64 = 1.15;
/// The reader's own tables, whose labels are what the rules propose.
const TABLES: [&str; 4] = [
    "shared/language/src/tests/conversation.txt",
    "shared/language/src/tests/cases.txt",
    "tests/fixtures/utterances/fresh_1.txt",
    "tests/fixtures/utterances/fresh_2.txt",
];

fn main() -> ExitCode {
    exit_code(run())
}

/// A labelled line with what the judge looks at.
struct Taught {
    line: Line,
    mentions: Vec<Mention>,
    rows: Vec<Vec<u32>>,
}

impl Taught {
    fn lessons(&self) -> Vec<Lesson> {
        let labels = pairs(&self.line, &self.mentions);
        let lesson = |(rows, label): (&Vec<u32>, Option<Polarity>)| {
            Some(Lesson { rows: rows.clone(), label: label? as usize, weight: 1.0 })
        };
        self.rows.iter().zip(labels).filter_map(lesson).collect()
    }

    fn judged(&self, model: &Linear) -> Vec<Mention> {
        let judged = self.mentions.iter().zip(&self.rows).map(|(mention, rows)| {
            let [wanted, denied, neither] =
                model.stated(rows, model.temperature).map(|stated| stated * (1.0 - FLOOR));
            Mention { wanted, denied, neither: neither + FLOOR, ..mention.clone() }
        });
        judged.collect()
    }
}

fn run() -> Result<(), String> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let root = here.join("../../..");
    let scenes = Scenes::load()?;
    let authors = authors(&scenes, &here.join("lines"))?;
    let mut own = Vec::new();
    for file in TABLES {
        own.extend(of_table(&scenes, &root.join(file))?);
    }
    let (mut all, mut unseen) = (Score::default(), Vec::new());
    for (left_out, taught) in &authors {
        let others = authors.iter().filter(|(name, _)| *name != left_out);
        let others = others.flat_map(|(_, taught)| taught).flat_map(Taught::lessons);
        let lessons: Vec<Lesson> = others.chain(own.iter().cloned()).collect();
        let mut model = Linear::train(&lessons, EPOCHS, RATE, 1);
        let lessons: Vec<Lesson> = taught.iter().flat_map(Taught::lessons).collect();
        unseen.extend(lessons.iter().map(|it| (model.sums(&it.rows), it.label)));
        model.temperature = TEMPERATURE;
        let mut score = Score::default();
        for one in taught {
            score.add(&one.line, &one.judged(&model));
            all.add(&one.line, &one.judged(&model));
        }
        println!("{score}  {left_out}, not seen");
    }
    println!("{all}  all, not seen");
    if !std::env::args().any(|argument| argument == "--write") {
        return Ok(());
    }
    let lessons: Vec<Lesson> =
        authors.values().flatten().flat_map(Taught::lessons).chain(own).collect();
    let mut model = Linear::train(&lessons, EPOCHS, RATE, 1);
    model.temperature = Linear::temperature_for(&unseen);
    println!("{} lessons, temperature {:.2}", lessons.len(), model.temperature);
    let path = root.join("shared/language/src/vocabulary/judge.bin");
    safe_files::write_output(&path, &bytes(&model, trained_on()?))
        .map_err(|e| format!("{}: {e}", path.display()))
}

fn authors(scenes: &Scenes, folder: &Path) -> Result<BTreeMap<String, Vec<Taught>>, String> {
    let mut authors: BTreeMap<String, Vec<Taught>> = BTreeMap::new();
    for path in files(folder) {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let text =
            std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        for line in lines(&name, &text)? {
            let (scene, reader) = scenes.get(&line.scene)?;
            let asked = question(scene, &line.question);
            let mentions = reader.mentions(&line.text, asked);
            let rows = reader.examples(&line.text, asked).into_iter().map(|it| it.rows).collect();
            authors.entry(name.clone()).or_default().push(Taught { line, mentions, rows });
        }
    }
    Ok(authors)
}

fn of_table(scenes: &Scenes, path: &Path) -> Result<Vec<Lesson>, String> {
    let mut lessons = Vec::new();
    for Row { scene, question, text } in table(scenes, path)? {
        let (_, reader) = scenes.get(&scene)?;
        for example in reader.examples(&text, question) {
            let label = example.proposal as usize;
            lessons.push(Lesson { rows: example.rows, label, weight: OWN });
        }
    }
    Ok(lessons)
}

/// The file of the weights: hash, scale, weights of 16 bits.
fn bytes(model: &Linear, hash: u64) -> Vec<u8> {
    let most =
        (0..ROWS).flat_map(|row| model.row(row)).fold(1e-9, |most: f64, it| most.max(it.abs()));
    let step = most / f64::from(i16::MAX);
    let mut bytes = hash.to_le_bytes().to_vec();
    bytes.extend(((step / model.temperature) as f32).to_le_bytes());
    for weight in (0..ROWS).flat_map(|row| model.row(row)) {
        bytes.extend(((weight / step).round() as i16).to_le_bytes());
    }
    bytes
}
