//! Everything that a report holds, in the order of collection: texts that name files of keys come before texts to scrub.

use std::fs;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use command_line::configuration;
use messages::Service;
use safe_files::open_regular;
use service::flight;
use service::group::GroupPaths;

use crate::bundle::Bundle;
use crate::secrets::Scrubber;
use crate::words::without_words;
use crate::{ReportArgs, machine, own_program};

/// Most bytes from the end of a log.
const LOG_BYTES_MAX: u64 = 1 << 20;
/// Most bytes of a file of the configuration, and most of these files.
const CONFIG_BYTES_MAX: u64 = 1 << 20;
const CONFIG_FILES_MAX: usize = 200;
/// Most bytes of a journal or a flight.
const RAW_BYTES_MAX: u64 = 64 << 20;

/// Folders of the configuration with text that people write.
const CONFIG_FOLDERS: [&str; 3] = ["", "profiles", "scenes"];

/// The reason for which journals and flights are left out.
const WORDS: &str = "it holds what people said; add it with --with-words";

/// Signs of a line of a log that holds people's words: a message, and the field `text` in both formats.
const WORDS_IN_LOGS: [&str; 3] = ["not in the audit", " text=", "\"text\":"];

/// Verbs whose output is a file of the report.
const VERBS: [(&str, &[&str]); 4] = [
    ("version.json", &["--version", "--json"]),
    ("status.json", &["status", "--json"]),
    ("recordings.jsonl", &["record", "list", "--json"]),
    ("doctor.jsonl", &["doctor", "--json"]),
];

/// Collects a report.
pub(crate) fn collect(paths: &GroupPaths, args: &ReportArgs) -> Bundle {
    let mut collection = Collection {
        paths,
        with_words: args.with_words,
        bundle: Bundle::default(),
        scrubber: Scrubber::of(paths),
        texts: Vec::new(),
    };
    collection.texts.push(("machine.txt".to_owned(), machine::text()));
    for (name, words) in VERBS {
        collection.output(name, words);
    }
    collection.configuration(args);
    collection.learn_secrets();
    collection.logs();
    collection.journals();
    collection.flights();
    collection.finish()
}

/// A report that is being collected.
struct Collection<'a> {
    paths: &'a GroupPaths,
    with_words: bool,
    bundle: Bundle,
    scrubber: Scrubber,
    /// Texts that are not scrubbed yet.
    texts: Vec<(String, String)>,
}

impl Collection<'_> {
    /// Adds the output of a verb of this program.
    fn output(&mut self, name: &str, words: &[&str]) -> Option<String> {
        match own_program::output(self.paths, words) {
            Ok(text) => {
                self.texts.push((name.to_owned(), text.clone()));
                Some(text)
            }
            Err(error) => {
                self.bundle.leave_out(name, format!("whichone {}: {error}", words.join(" ")));
                None
            }
        }
    }

    /// Adds the values with their origins, and the files.
    fn configuration(&mut self, args: &ReportArgs) {
        let running = self.texts.iter().find(|(name, _)| name == "status.json");
        let status =
            running.and_then(|(_, text)| serde_json::from_str::<serde_json::Value>(text).ok());
        let status = status.filter(|_| !args.config.is_given()).unwrap_or_default();
        let running = status["config"].as_str().map(PathBuf::from);
        let folder = match running.map_or_else(|| configuration::folder(&args.config), Ok) {
            Ok(folder) => folder,
            Err(error) => return self.bundle.leave_out("config", error.to_string()),
        };
        let place = folder.display().to_string();
        let mut words = vec!["check", "--json", "--values", "--config", &place];
        let profile = args.config.profile.as_deref().or(status["profile"].as_str());
        words.extend(profile.into_iter().flat_map(|profile| ["--profile", profile]));
        let in_force: Vec<(String, String)> =
            serde_json::from_value(status["set"].clone()).unwrap_or_default();
        let set = if args.config.is_given() { &args.config.set } else { &in_force };
        let set: Vec<String> = set.iter().map(|(key, value)| format!("{key}={value}")).collect();
        words.extend(set.iter().flat_map(|set| ["--set", set]));
        self.output("check.json", &words);
        self.texts.push(("config/FOLDER.txt".to_owned(), format!("{place}\n")));
        let mut files = 0;
        for below in CONFIG_FOLDERS {
            for path in listed(&folder.join(below), "toml") {
                files += 1;
                let name =
                    format!("config/{}", path.strip_prefix(&folder).unwrap_or(&path).display());
                match end_of(&path, CONFIG_BYTES_MAX) {
                    Ok((text, true)) if files <= CONFIG_FILES_MAX => self.texts.push((name, text)),
                    Ok(_) => {
                        self.bundle.leave_out(name, "it is too large, or one of too many files")
                    }
                    Err(error) => self.bundle.leave_out(name, error.to_string()),
                }
            }
        }
    }

    /// Adds the ends of the logs.
    fn logs(&mut self) {
        for path in listed(&self.paths.log(), "log") {
            let name = format!("log/{}", file_name(&path));
            match end_of(&path, LOG_BYTES_MAX) {
                Ok((text, _)) => self.texts.push((name, self.log(&text))),
                Err(error) => self.bundle.leave_out(name, error.to_string()),
            }
        }
    }

    /// The log without lines that hold people's words.
    fn log(&self, text: &str) -> String {
        let is_kept = |line: &&str| self.with_words || !holds_words(line);
        text.lines().filter(is_kept).flat_map(|line| [line, "\n"]).collect()
    }

    /// Adds the journals: as lines without words, or whole and as they are.
    fn journals(&mut self) {
        for service in Service::JOURNALED {
            let file = self.paths.journal_file(service.name());
            if !file.is_file() {
                continue;
            }
            let name = format!("journal/{}.jsonl", service.name());
            let printed = own_program::output(self.paths, &["journal", service.name(), "--json"]);
            match printed {
                Ok(lines) if self.with_words => self.texts.push((name, lines)),
                Ok(lines) => {
                    let (clean, words) = without_words(&lines);
                    if service == Service::Speech {
                        self.scrubber.learn_words(words);
                    }
                    self.texts.push((name, clean));
                }
                Err(error) => {
                    self.bundle.leave_out(name, error);
                    if service == Service::Speech && !self.with_words {
                        self.leave_out_logs();
                    }
                }
            }
            self.raw(&file, &format!("journal/{}", file_name(&file)));
        }
    }

    /// Removes the logs: without the journal it is not known what people said.
    fn leave_out_logs(&mut self) {
        for (name, _) in self.texts.extract_if(.., |(name, _)| name.starts_with("log/")) {
            self.bundle.leave_out(
                name,
                "the journal of speech, which tells people's words, cannot be read",
            );
        }
    }

    /// Adds the last flight of each service, for a replay.
    fn flights(&mut self) {
        let flights = flight::list(&self.paths.flights()).unwrap_or_default();
        let of = |path: &Path| {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            stem.rsplit_once('-').map_or(stem.clone(), |(service, _)| service.to_owned())
        };
        // Sorted by service, and then by time.
        let is_last =
            |at: usize| flights.get(at + 1).is_none_or(|next| of(next) != of(&flights[at]));
        for at in (0..flights.len()).filter(|at| is_last(*at)) {
            self.raw(&flights[at], &format!("flight/{}", file_name(&flights[at])));
        }
    }

    /// Adds a file that cannot be scrubbed, if that may be.
    fn raw(&mut self, path: &Path, name: &str) {
        if !self.with_words {
            return self.bundle.leave_out(name, WORDS);
        }
        match whole(path) {
            Ok(bytes) if self.scrubber.is_in(&bytes) => {
                self.bundle.leave_out(name, "it holds a secret")
            }
            Ok(bytes) => self.bundle.add(name, bytes),
            Err(error) => self.bundle.leave_out(name, error.to_string()),
        }
    }

    /// Learns the secrets of the configuration and of the files that it names, before anything else is judged.
    fn learn_secrets(&mut self) {
        for (_, text) in &self.texts {
            self.scrubber.learn(text);
        }
    }

    /// Scrubs the texts.
    fn finish(mut self) -> Bundle {
        for (name, text) in std::mem::take(&mut self.texts) {
            self.bundle.add(name, self.scrubber.clean(&text));
        }
        self.bundle
    }
}

/// Whether a line of a log holds people's words: an order that found no room in an audit, or a text, such as speech that
/// was not meant for the robot and is in no journal.
pub(crate) fn holds_words(line: &str) -> bool {
    WORDS_IN_LOGS.iter().any(|sign| line.contains(sign))
}

/// Regular files of a folder with this ending, sorted.
fn listed(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let has_ending =
        |path: &PathBuf| path.extension().is_some_and(|it| it == ending) && path.is_file();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(has_ending).collect();
    paths.sort();
    paths
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// The end of a file from the beginning of a line on, and whether that is all of it.
fn end_of(path: &Path, bytes_max: u64) -> std::io::Result<(String, bool)> {
    let mut file = open_regular(path)?;
    let start = file.metadata()?.len().saturating_sub(bytes_max);
    file.seek(SeekFrom::Start(start))?;
    let mut bytes = Vec::new();
    file.take(bytes_max).read_to_end(&mut bytes)?;
    let text = String::from_utf8_lossy(&bytes).into_owned();
    if start == 0 {
        return Ok((text, true));
    }
    let rest = text.split_once('\n').map_or("", |(_, rest)| rest);
    Ok((format!("(the first {start} bytes are left out)\n{rest}"), false))
}

fn whole(path: &Path) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_regular(path)?.take(RAW_BYTES_MAX + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > RAW_BYTES_MAX {
        return Err(std::io::Error::other(format!("more than {} MiB", RAW_BYTES_MAX >> 20)));
    }
    Ok(bytes)
}
