//! `cargo run -p reader_training --bin score -- FILE…`: scores the reader on labelled lines.

#![allow(clippy::print_stdout, reason = "a program for the terminal")]

use std::process::ExitCode;

use language::Polarity;

use reader_training::{Scenes, Score, as_read, exit_code, labels, lines, question};

fn main() -> ExitCode {
    exit_code(run())
}

fn run() -> Result<(), String> {
    let scenes = Scenes::load()?;
    let (show, files): (Vec<_>, Vec<_>) = std::env::args().skip(1).partition(|it| it == "--wrong");
    let (mut all, mut read) = (Score::default(), Score::default());
    for file in files {
        let text = std::fs::read_to_string(&file).map_err(|error| format!("{file}: {error}"))?;
        let mut score = Score::default();
        for line in lines(&file, &text)? {
            let (scene, reader) = scenes.get(&line.scene)?;
            let asked = question(scene, &line.question);
            let mentions = reader.mentions(&line.text, asked);
            if !show.is_empty() {
                let labels = labels(&line, mentions.iter().map(|mention| &*mention.surface));
                for (mention, truth) in mentions.iter().zip(labels) {
                    if truth == Some(Polarity::Denied) && mention.wanted > 0.9 {
                        println!("{}: {} [{}]", line.scene, line.text, mention.surface);
                    }
                }
            }
            score.add(&line, &mentions);
            all.add(&line, &mentions);
            read.add(&line, &as_read(&reader.readings(&line.text, &[], asked), &mentions));
        }
        println!("{score}  {file}");
    }
    println!("{all}  all");
    println!("{read}  all, as the policy gets it");
    Ok(())
}
