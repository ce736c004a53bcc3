//! `cargo run --release -p reader_training --bin train`: scores each author's lines with a judge
//! trained on the others. `--write` trains on all, and replaces `vocabulary/judge.bin`.

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
    let named: Vec<String> = std::env::args().skip(1).collect();
    if named != ["--write"] {
        return validate(&scenes, &sources, &named);
    }
    let bytes = Model::train(&sources, |_, _| true).bytes(trained_on()?);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../src/vocabulary/judge.bin");
    safe_files::write_output(&path, &bytes).map_err(|e| format!("{}: {e}", path.display()))
}

/// Prints how each source is read when it was not seen, and which temperature fits the authors.
fn validate(scenes: &Scenes, sources: &Sources, named: &[String]) -> Result<(), String> {
    let is_chosen = |name: &&str| named.is_empty() || named.iter().any(|it| it == name);
    let mut all = Unseen::default();
    for author in sources.authors.iter().map(String::as_str).filter(is_chosen) {
        let unseen = without_author(scenes, sources, author)?;
        println!("{author}, not seen:\n{unseen}");
        all.extend(unseen);
    }
    println!("all, not seen (factors {:.2?} fit):\n{all}", fitted(&all.sums));
    for part in sources.others().filter(is_chosen) {
        let unseen = without_fifths(scenes, sources, part)?;
        println!("{part}, each fifth not seen:\n{unseen}");
    }
    Ok(())
}
