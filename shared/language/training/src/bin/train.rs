//! `cargo run --release -p reader_training --bin train`: trains the judge, and says how it does on each author's lines when it
//! has not seen them.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::ExitCode;

use language::Mention;
use reader_training::{
    Lesson, Line, Linear, Row, Scenes, Score, files, lines, pairs, question, table,
};

/// Share of the floor under every probability: nothing was said.
const FLOOR: f64 = 0.01;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("error: {why}");
            ExitCode::FAILURE
        }
    }
}

/// A labelled line with its lessons.
struct Taught {
    line: Line,
    mentions: Vec<Mention>,
    rows: Vec<Vec<u32>>,
}

fn run() -> Result<(), String> {
    let scenes = Scenes::load()?;
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("lines");
    let mut authors: BTreeMap<String, Vec<Taught>> = BTreeMap::new();
    for path in files(&folder) {
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
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let of_table = |file: &str| -> Result<Vec<Vec<Lesson>>, String> {
        let rows = table(&scenes, &root.join(file))?;
        let lessons = |row: &Row| {
            let (_, reader) = scenes.get(&row.scene)?;
            let examples = reader.examples(&row.text, row.question).into_iter();
            Ok(examples
                .map(|it| Lesson { rows: it.rows, label: it.proposal as usize, weight: 1.0 })
                .collect())
        };
        rows.iter().map(lessons).collect()
    };
    let known: Vec<Lesson> =
        ["shared/language/src/tests/cases.txt", "tests/fixtures/utterances/fresh_1.txt"]
            .iter()
            .map(|file| of_table(file))
            .collect::<Result<Vec<_>, _>>()?
            .into_iter()
            .flatten()
            .flatten()
            .collect();
    let ordinary: Vec<Lesson> =
        of_table("tests/fixtures/utterances/fresh_2.txt")?.into_iter().flatten().collect();
    println!("{} known, {} ordinary", known.len(), ordinary.len());
    let mut all = Score::default();
    let mut fresh = [0usize; 4];
    for left_out in authors.keys() {
        let others = authors.iter().filter(|(name, _)| *name != left_out);
        let lessons: Vec<Lesson> =
            others.flat_map(|(_, taught)| taught).flat_map(lessons).collect();
        let lessons: Vec<Lesson> = lessons.into_iter().chain(known.iter().cloned()).collect();
        let mut model = Linear::train(&lessons, var("E", 8.0) as usize, var("R", 0.0125), 1);
        let own = &authors[left_out];
        let half: Vec<Lesson> = own.iter().step_by(2).flat_map(lessons_of).collect();
        model.fit_temperature(&half);
        for lesson in &ordinary {
            let stated = model.stated(&lesson.rows, model.temperature);
            let best = (0..3).max_by(|a, b| stated[*a].total_cmp(&stated[*b])).unwrap_or(0);
            fresh[0] += 1;
            fresh[1] += usize::from(best == lesson.label);
            fresh[2] += usize::from(best != lesson.label && stated[best] >= 0.9);
            fresh[3] += usize::from(stated[best] < 0.9);
        }
        let mut score = Score::default();
        for taught in own {
            let judged = judge(&model, taught);
            if std::env::var("SHOW").is_ok() {
                for ((m, j), truth) in
                    taught.mentions.iter().zip(&judged).zip(pairs(&taught.line, &taught.mentions))
                {
                    let Some(truth) = truth else { continue };
                    let s = [j.wanted, j.denied, j.neither];
                    let best = (0..3).max_by(|a, b| s[*a].total_cmp(&s[*b])).unwrap_or(0);
                    if best != truth as usize {
                        println!(
                            "ERR {truth:?}->{best} {:.2} r{:.0}{:.0}{:.0} {} | {} | {} | {} [{}]",
                            s[best],
                            m.wanted,
                            m.denied,
                            m.neither,
                            taught.line.act,
                            taught.line.scene,
                            taught.line.question,
                            taught.line.text,
                            m.surface
                        );
                    }
                }
            }
            score.add(&taught.line, &judged);
            all.add(&taught.line, &judged);
        }
        println!("{score}  {left_out} (T {:.2})", model.temperature);
    }
    println!("{all}  all");
    println!(
        "fresh_2: right {:.3} certain and wrong {:.3} unsure {:.3}",
        fresh[1] as f64 / fresh[0] as f64,
        fresh[2] as f64 / fresh[0] as f64,
        fresh[3] as f64 / fresh[0] as f64
    );
    Ok(())
}

fn var(name: &str, otherwise: f64) -> f64 {
    std::env::var(name).ok().and_then(|it| it.parse().ok()).unwrap_or(otherwise)
}

fn lessons_of(taught: &Taught) -> Vec<Lesson> {
    lessons(taught)
}

fn lessons(taught: &Taught) -> Vec<Lesson> {
    let labels = pairs(&taught.line, &taught.mentions);
    let rows = taught.rows.iter().zip(labels);
    let lesson = |(rows, label): (&Vec<u32>, Option<language::Polarity>)| {
        Some(Lesson { rows: rows.clone(), label: label? as usize, weight: 1.0 })
    };
    rows.filter_map(lesson).collect()
}

fn judge(model: &Linear, taught: &Taught) -> Vec<Mention> {
    let judged = taught.mentions.iter().zip(&taught.rows).map(|(mention, rows)| {
        let [wanted, denied, neither] = model.stated(rows, model.temperature);
        Mention {
            wanted: wanted * (1.0 - FLOOR),
            denied: denied * (1.0 - FLOOR),
            neither: neither * (1.0 - FLOOR) + FLOOR,
            ..mention.clone()
        }
    });
    judged.collect()
}
