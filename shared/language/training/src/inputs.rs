//! Hashes of the judges' training inputs.

use std::fs;
use std::path::{Path, PathBuf};

use scene::StableHash;

use crate::scenes::files;

/// Returns the hash of lines, templates, tables, scenes and features: it dates weights.
///
/// # Errors
/// A file that cannot be read.
pub fn trained_on() -> Result<u64, String> {
    hash_of(&inputs())
}

fn inputs() -> Vec<PathBuf> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths: Vec<_> = ["lines", "scenes", "../../../tests/fixtures/utterances"]
        .iter()
        .flat_map(|folder| files(&here.join(folder)))
        .collect();
    let sources = [
        "features.rs",
        "recurrent.rs",
        "sequence.rs",
        "token_class.rs",
        "vocabulary/word_groups.txt",
        "tests/cases.txt",
        "tests/conversation.txt",
    ];
    paths.extend(sources.map(|source| here.join("../src").join(source)));
    paths.extend(["templates.txt", "hard_templates.txt"].map(|templates| here.join(templates)));
    paths
}

/// Returns the hash of the same with the answers, their features and phrases: it dates the weights of answers.
///
/// # Errors
/// A file that cannot be read.
pub fn answers_trained_on() -> Result<u64, String> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = inputs();
    paths.extend(files(&here.join("answers")));
    let sources = ["answer_judge.rs", "vocabulary/phrases.txt"];
    paths.extend(sources.map(|source| here.join("../src").join(source)));
    hash_of(&paths)
}

fn hash_of(paths: &[PathBuf]) -> Result<u64, String> {
    let mut hash = StableHash::default();
    for path in paths {
        let bytes = fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
        hash.bytes(&bytes);
    }
    Ok(hash.value())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_of_these_lines() {
        let help = "help: cargo run --release -p reader_training --bin train -- --write";
        assert_eq!(language::trained_on(), trained_on().unwrap(), "{help}");
        let help = "help: cargo run --release -p reader_training --bin answers -- --write";
        assert_eq!(language::answers_trained_on(), answers_trained_on().unwrap(), "{help}");
    }
}
