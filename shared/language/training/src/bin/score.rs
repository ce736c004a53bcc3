//! `cargo run -p reader_training --bin score -- FILE…`: scores the reader on labelled lines.

#![allow(clippy::print_stdout, reason = "a program for the terminal")]

use std::process::ExitCode;

use language::{Mention, Polarity, Reader};
use scene::{Question, Reading};

use reader_training::{Scenes, Score, exit_code, lines, pairs, question};

fn main() -> ExitCode {
    exit_code(run())
}

fn run() -> Result<(), String> {
    let scenes = Scenes::load()?;
    let (show, files): (Vec<_>, Vec<_>) = std::env::args().skip(1).partition(|it| it == "--wrong");
    let (mut all, mut as_read) = (Score::default(), Score::default());
    for file in files {
        let text = std::fs::read_to_string(&file).map_err(|error| format!("{file}: {error}"))?;
        let mut score = Score::default();
        for line in lines(&file, &text)? {
            let (scene, reader) = scenes.get(&line.scene)?;
            let asked = question(scene, &line.question);
            let mentions = reader.mentions(&line.text, asked);
            if !show.is_empty() {
                for (mention, truth) in mentions.iter().zip(pairs(&line, &mentions)) {
                    if truth == Some(Polarity::Denied) && mention.wanted > 0.9 {
                        println!("{}: {} [{}]", line.scene, line.text, mention.surface);
                    }
                }
            }
            score.add(&line, &mentions);
            all.add(&line, &mentions);
            as_read.add(&line, &read(reader, &line.text, asked, &mentions));
        }
        println!("{score}  {file}");
    }
    println!("{all}  all");
    println!("{as_read}  all, as the policy gets it");
    Ok(())
}

/// What the weighted readings say of each value word.
fn read(reader: &Reader, text: &str, asked: Question, mentions: &[Mention]) -> Vec<Mention> {
    let readings = reader.readings(text, &[], asked);
    let weight = |holds: &dyn Fn(&Reading) -> bool| -> f64 {
        readings.iter().filter(|(_, reading)| holds(reading)).map(|(weight, _)| weight).sum()
    };
    let as_read = |mention: &Mention| {
        let wanted = weight(&|reading| reading.base.contains(&mention.word));
        let is_denied = |reading: &Reading| {
            reading.excluded.iter().any(|group| group.contains(&mention.word))
                && !reading.base.contains(&mention.word)
        };
        let denied = weight(&is_denied);
        Mention { wanted, denied, neither: (1.0 - wanted - denied).max(0.0), ..mention.clone() }
    };
    mentions.iter().map(as_read).collect()
}
