//! `cargo run -p reader_training --bin score -- FILE…`: scores the reader on labelled lines.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program for the terminal")]

use std::process::ExitCode;

use language::Polarity;
use reader_training::{Scenes, Score, lines, pairs, question};

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("error: {why}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), String> {
    let scenes = Scenes::load()?;
    let (show, files): (Vec<_>, Vec<_>) = std::env::args().skip(1).partition(|it| it == "--wrong");
    let mut all = Score::default();
    for file in files {
        let text = std::fs::read_to_string(&file).map_err(|error| format!("{file}: {error}"))?;
        let mut score = Score::default();
        for line in lines(&file, &text)? {
            let (scene, reader) = scenes.get(&line.scene)?;
            let mentions = reader.mentions(&line.text, question(scene, &line.question));
            if !show.is_empty() {
                for (mention, truth) in mentions.iter().zip(pairs(&line, &mentions)) {
                    if truth == Some(Polarity::Denied) && mention.wanted > 0.9 {
                        println!("{}: {} [{}]", line.scene, line.text, mention.surface);
                    }
                }
            }
            score.add(&line, &mentions);
            all.add(&line, &mentions);
        }
        println!("{score}  {file}");
    }
    println!("{all}  all");
    Ok(())
}
