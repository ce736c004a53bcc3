//! `cargo run --release -p reader_training --bin train`: prints how each author's lines are read by a judge that was trained on
//! the others alone. With `--write` it trains on all of them, and replaces `vocabulary/judge.bin`.

#![allow(clippy::print_stdout, reason = "a program for the terminal")]

use std::path::Path;
use std::process::ExitCode;

use reader_training::{
    Model, Scenes, Sources, Unseen, exit_code, fitted, trained_on, without_author, without_fifths,
};

fn main() -> ExitCode {
    exit_code(run())
}

fn run() -> Result<(), String> {
    let scenes = Scenes::load()?;
    let sources = Sources::load(&scenes)?;
    if !std::env::args().any(|argument| argument == "--write") {
        return validate(&scenes, &sources);
    }
    let bytes = Model::train(&sources, |_, _| true).bytes(trained_on()?);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../src/vocabulary/judge.bin");
    safe_files::write_output(&path, &bytes).map_err(|e| format!("{}: {e}", path.display()))
}

/// Prints how each source is read when it was not seen, and which temperature fits the authors.
fn validate(scenes: &Scenes, sources: &Sources) -> Result<(), String> {
    let mut all = Unseen::default();
    for author in &sources.authors {
        let unseen = without_author(scenes, sources, author)?;
        println!("{author}, not seen:\n{unseen}");
        all.extend(unseen);
    }
    let fit = fitted(&all.sums);
    for shares in [fit, [fit[0], fit[1], 1.0], [0.35, 0.35, 1.0]] {
        let mut ag = 0;
        let mut agr = 0;
        let mut sc = reader_training::Score::default();
        for it in &all.sums {
            let [p, q] = it.parts;
            let f = if it.agree() {
                ag += 1;
                agr += usize::from(it.label == it.proposal);
                shares[2]
            } else {
                1.0
            };
            let v = [0, 1, 2].map(|n| f * (shares[0] * p[n] + shares[1] * q[n]));
            let m = v.iter().copied().fold(f64::MIN, f64::max);
            let e = v.map(|x| (x - m).exp());
            let t: f64 = e.iter().sum();
            let e = e.map(|x| 0.99 * x / t);
            sc.scored.push(reader_training::Scored {
                truth: [
                    language::Polarity::Wanted,
                    language::Polarity::Denied,
                    language::Polarity::Neither,
                ][it.label],
                stated: [e[0], e[1], e[2] + 0.01],
            });
        }
        println!("{shares:.2?} agreed {ag} right {agr} {sc}");
    }
    println!("all, not seen (factors {:.2?} fit):\n{all}", fitted(&all.sums));
    if std::env::var("AUTHORS").is_ok() {
        return Ok(());
    }
    for part in sources.others() {
        let unseen = without_fifths(scenes, sources, part)?;
        println!("{part}, each fifth not seen:\n{unseen}");
    }
    Ok(())
}
