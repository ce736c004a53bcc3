//! `cargo run --release -p reader_training --bin answers`: scores each author's answers with a judge trained on the
//! others. `FILE…` scores those answers as they are read now; `--wrong` before it prints the wrong ones. `--write`
//! trains on all, and replaces `vocabulary/answer_judge.bin`.

#![allow(clippy::print_stdout, reason = "a program for the terminal")]

use std::path::Path;
use std::process::ExitCode;

use reader_training::{
    AnswerScore, Scenes, answers, answers_of, answers_trained_on, answers_without, exit_code,
    train_answers,
};

fn main() -> ExitCode {
    exit_code(run())
}

fn run() -> Result<(), String> {
    let scenes = Scenes::load()?;
    let named: Vec<String> = std::env::args().skip(1).collect();
    if named == ["--write"] {
        let all = answers(&scenes)?;
        let bytes = train_answers(&scenes, all.values().flatten(), answers_trained_on()?)?;
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../src/vocabulary/answer_judge.bin");
        return safe_files::write_output(&path, &bytes)
            .map_err(|error| format!("{}: {error}", path.display()));
    }
    let (show, files): (Vec<_>, Vec<_>) = named.into_iter().partition(|it| it == "--wrong");
    let mut all = AnswerScore::default();
    for file in &files {
        let mut score = AnswerScore::default();
        for answer in answers_of(&scenes, Path::new(file))? {
            let right = score.add(&scenes, &answer)?;
            if !show.is_empty() && right < 0.5 {
                println!(
                    "{right:.2} {}: {:?} {}",
                    answer.scene,
                    language::ANSWERS[answer.meaning],
                    answer.text
                );
            }
        }
        println!("{score}  {file}");
        all.extend(score);
    }
    if files.is_empty() {
        let answers = answers(&scenes)?;
        for author in answers.keys() {
            let score = answers_without(&scenes, &answers, author)?;
            println!("{score}  {author}, not seen");
            all.extend(score);
        }
    }
    println!("{all}  all");
    Ok(())
}
