//! Secrets: those that are known by their value, and those that a name or a form gives away.

use std::collections::BTreeSet;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use safe_files::open_regular;
use service::console_link;
use service::group::GroupPaths;

use crate::secret_names::{LEFT_OUT, without_secrets};

/// Shortest text that is looked for everywhere: shorter ones are in too many words.
const LEN_MIN: usize = 6;
/// Most bytes of a file of keys.
const KEYS_BYTES_MAX: u64 = 64 << 10;
/// Most files of a folder of keys, in it and below it.
const KEY_FILES_MAX: usize = 64;

/// Removes secrets, and what people said, from texts.
#[derive(Debug, Default)]
pub(crate) struct Scrubber {
    /// Values of secrets.
    secrets: BTreeSet<String>,
    /// What people said, and who they are.
    words: BTreeSet<String>,
}

impl Scrubber {
    /// Knows the tokens of a group.
    pub(crate) fn of(paths: &GroupPaths) -> Self {
        let mut scrubber = Self::default();
        scrubber.secrets.extend(console_link::token(paths).filter(|it| it.len() >= LEN_MIN));
        scrubber.learn_file(&console_link::sessions_file(paths));
        scrubber
    }

    /// Learns the secrets that a text shows, and those in files that it names under a key such as `key_file` or `keys`.
    pub(crate) fn learn(&mut self, text: &str) {
        let mut found = Vec::new();
        without_secrets(text, &mut found);
        self.secrets
            .extend(found.into_iter().filter(|it| it.len() >= LEN_MIN && !it.contains(LEFT_OUT)));
        for path in named_files(text) {
            self.learn_path(&path, &mut 0);
        }
    }

    fn learn_path(&mut self, path: &Path, files: &mut usize) {
        *files += 1;
        if *files > KEY_FILES_MAX {
            return;
        }
        match fs::read_dir(path) {
            Ok(entries) => {
                entries.flatten().for_each(|entry| self.learn_path(&entry.path(), files))
            }
            Err(_) => self.learn_file(path),
        }
    }

    fn learn_file(&mut self, path: &Path) {
        let Ok(file) = open_regular(path) else { return };
        let mut text = String::new();
        // A file that is no text has no secret that a text could show.
        if file.take(KEYS_BYTES_MAX).read_to_string(&mut text).is_err() {
            return;
        }
        let lines = text.lines().map(str::trim);
        let quoted = lines.clone().flat_map(|line| line.split('"').skip(1).step_by(2));
        let found = lines.filter(|line| !line.starts_with("-----")).chain(quoted);
        self.secrets.extend(found.filter(|it| it.len() >= LEN_MIN).map(str::to_owned));
    }

    /// Learns people's words, to find them in every other text.
    pub(crate) fn learn_words(&mut self, words: impl IntoIterator<Item = String>) {
        self.words.extend(words);
    }

    /// Returns the text without secrets and words.
    pub(crate) fn clean(&self, text: &str) -> String {
        let mut clean = text.to_owned();
        // The longest first: one may be a part of another.
        for secret in longest_first(&self.secrets) {
            if clean.contains(secret) {
                clean = clean.replace(secret, LEFT_OUT);
            }
        }
        for words in longest_first(&self.words) {
            clean = without_phrase(&clean, words);
        }
        without_secrets(&clean, &mut Vec::new())
    }

    /// Returns true if bytes hold a known secret.
    pub(crate) fn is_in(&self, bytes: &[u8]) -> bool {
        let text = String::from_utf8_lossy(bytes);
        self.secrets.iter().any(|secret| text.contains(secret.as_str()))
    }
}

fn longest_first(texts: &BTreeSet<String>) -> Vec<&str> {
    let mut texts: Vec<&str> = texts.iter().map(String::as_str).collect();
    texts.sort_unstable_by_key(|it| std::cmp::Reverse(it.len()));
    texts
}

/// Replaces a phrase unless it is a part of other words.
fn without_phrase(text: &str, phrase: &str) -> String {
    let mut clean = String::new();
    let mut from = 0;
    for (at, _) in text.match_indices(phrase) {
        let end = at + phrase.len();
        let touches = [text[..at].chars().next_back(), text[end..].chars().next()];
        if touches.into_iter().flatten().any(char::is_alphanumeric) {
            continue;
        }
        clean.push_str(&text[from..at]);
        clean.push_str(LEFT_OUT);
        from = end;
    }
    clean + &text[from..]
}

/// Names of settings whose value is a file, or a folder, of secrets.
const FILE_NAMES: [&str; 7] =
    ["key_file", "keys", "keyfile", "key_path", "password_file", "token_file", "credentials_file"];

/// Absolute paths behind such names: in TOML, in the pairs of a status, and in the values of `check --json`.
fn named_files(text: &str) -> BTreeSet<PathBuf> {
    let after_gap = |text: &'_ str| -> usize {
        let is_between = |it: char| [' ', '"', '\'', '\\', '=', ':', ','].contains(&it);
        text.len() - text.trim_start_matches(is_between).len()
    };
    let mut found = BTreeSet::new();
    for (at, name) in FILE_NAMES.iter().flat_map(|name| text.match_indices(name)) {
        let rest = &text[at + name.len()..];
        let rest = &rest[after_gap(rest)..];
        let rest = rest.strip_prefix("value").map_or(rest, |rest| &rest[after_gap(rest)..]);
        if rest.starts_with('/') {
            let end = rest.find(['"', '\'', '\\', '\n']).unwrap_or(rest.len());
            found.insert(PathBuf::from(&rest[..end]));
        }
    }
    found
}
