//! Completion of command lines: the scripts for shells, and the words that they ask this program for.

use std::ffi::OsString;
use std::fs;
use std::path::Path;

use clap::{Arg, Command};
use clap_complete::CompleteEnv;
use clap_complete::engine::{ArgValueCandidates, ArgValueCompleter, CompletionCandidate};
use clap_complete::engine::{PathCompleter, ValueCompleter};
use clap_complete::env::Shells;
use config::Settings;
use messages::SUPERVISOR;
use scene::Scene;
use service::exit::{Exit, Failure};
use service::group::{GroupName, GroupPaths};

use super::paths;
use crate::Outcome;
use crate::cli::{Cli, ConfigArgs};
use crate::output::Output;

/// Variable by which a shell's script asks for words; its value is the name of the shell.
const VARIABLE: &str = "WHICHONE_COMPLETE";

/// Prints the script that completes command lines in a shell.
pub(super) fn completions(shell: &str, out: &mut Output<'_>) -> Outcome {
    let shells = Shells::builtins();
    let unknown = || Failure::new(Exit::Usage, format!("{shell}: no script for this shell"));
    let shell = shells.completer(shell).ok_or_else(unknown)?;
    let mut script = Vec::new();
    let written =
        shell.write_registration(VARIABLE, "whichone", "whichone", "whichone", &mut script);
    written.map_err(|error| Failure::new(Exit::Storage, error.to_string()))?;
    out.text(&String::from_utf8_lossy(&script))?;
    Ok(Exit::Ok)
}

/// Answers the script of a shell, which asks for the words that may follow `arguments`; `None` if none does.
pub(crate) fn answer(arguments: &[OsString]) -> Option<Exit> {
    std::env::var_os(VARIABLE)?;
    let line = Line::read(arguments);
    let completion =
        CompleteEnv::with_factory(move || with_words(Cli::definition(), "", line.clone()));
    let here = std::env::current_dir().ok();
    match completion.var(VARIABLE).try_complete(arguments.to_vec(), here.as_deref()) {
        Ok(true) => Some(Exit::Ok),
        Ok(false) => None,
        Err(error) => {
            // Nothing to do if standard error is closed.
            let _ = error.print();
            Some(Exit::Usage)
        }
    }
}

/// Gives every argument of a verb and of its actions the words that it may be.
fn with_words(command: Command, within: &str, line: Line) -> Command {
    let name = command.get_name().to_owned();
    let path = format!("{within} {name}");
    let own = line.clone();
    let of_verb = path.clone();
    let command = command.mut_args(move |argument| words_of(argument, &of_verb, &own));
    command.mut_subcommands(move |action| with_words(action, &path, line.clone()))
}

fn words_of(argument: Arg, verb: &str, line: &Line) -> Arg {
    let line = line.clone();
    match argument.get_id().as_str() {
        "group" => argument.add(words(groups)),
        "service" if argument.get_possible_values().is_empty() => {
            let and_supervisor = verb.ends_with(" logs").then(|| SUPERVISOR.to_owned());
            argument.add(words(move || {
                line.services().into_iter().chain(and_supervisor.clone()).collect()
            }))
        }
        "profile" => argument.add(words(move || line.files("profiles"))),
        "scene" => argument.add(scenes(line)),
        "file" if verb.ends_with(" scene check") || verb.ends_with(" scene place") => {
            argument.add(scenes(line))
        }
        "set" | "what_if" => argument.add(words(move || line.keys())),
        "answer_as" | "object" | "class" => argument.add(words(move || line.objects())),
        _ => argument,
    }
}

fn words(list: impl Fn() -> Vec<String> + Send + Sync + 'static) -> ArgValueCandidates {
    ArgValueCandidates::new(move || list().into_iter().map(CompletionCandidate::new).collect())
}

/// Names of scenes, and files.
fn scenes(line: Line) -> ArgValueCompleter {
    ArgValueCompleter::new(move |current: &std::ffi::OsStr| {
        let start = current.to_string_lossy();
        let names = line.files("scenes").into_iter().filter(|name| name.starts_with(&*start));
        let names = names.map(CompletionCandidate::new);
        names.chain(PathCompleter::file().complete(current)).collect()
    })
}

/// Groups that have a folder.
fn groups() -> Vec<String> {
    let Ok(paths) = default_group() else { return Vec::new() };
    let entries = fs::read_dir(paths.home()).into_iter().flatten().flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
    sorted(names.filter(|name| GroupName::new(name).is_ok()))
}

fn default_group() -> Result<GroupPaths, Failure> {
    Ok(GroupPaths::resolve(&GroupName::new(GroupName::DEFAULT)?)?)
}

fn sorted(names: impl Iterator<Item = String>) -> Vec<String> {
    let mut names: Vec<String> = names.collect();
    names.sort();
    names.dedup();
    names
}

/// The part of a command line on which words depend.
#[derive(Clone, Default)]
struct Line {
    group: Option<String>,
    config: ConfigArgs,
}

impl Line {
    /// Reads the line that follows the first `--`.
    fn read(arguments: &[OsString]) -> Self {
        let mut line = Self::default();
        let words = arguments.iter().map(|word| word.to_string_lossy().into_owned());
        let words: Vec<String> = words.skip_while(|word| word != "--").skip(1).collect();
        for (at, word) in words.iter().enumerate() {
            let (option, value) = match word.split_once('=') {
                Some((option, value)) => (option, Some(value.to_owned())),
                None => (word.as_str(), words.get(at + 1).cloned()),
            };
            match (option, value) {
                ("--group", group) => line.group = group,
                ("--config", folder) => line.config.config = folder.map(Into::into),
                ("--profile", profile) => line.config.profile = profile,
                ("--scene", Some(scene)) if !scene.contains(['/', '.']) => {
                    line.config.set.push(("group.scene".to_owned(), scene));
                }
                _ => {}
            }
        }
        if line.config.config.is_none() {
            line.config.config = std::env::var_os("WHICHONE_CONFIG").map(Into::into);
        }
        line
    }

    /// Settings of the running group, unless the line names others, else of the configuration.
    fn settings(&self) -> Option<Settings> {
        if !self.config.is_given()
            && let Some(running) = self.running()
        {
            return Some(running);
        }
        let folder = paths::config_folder(&self.config).ok()?;
        let profile = self.config.profile.as_deref();
        Settings::examine(&folder, profile, &self.config.set, None).settings
    }

    fn running(&self) -> Option<Settings> {
        let named = self.group.clone().or_else(|| std::env::var(service::group::ENV_GROUP).ok());
        let name = GroupName::new(named.as_deref().unwrap_or(GroupName::DEFAULT)).ok()?;
        Settings::load_snapshot(&GroupPaths::resolve(&name).ok()?.run()).ok()
    }

    fn services(&self) -> Vec<String> {
        let services = self.settings().map(|settings| settings.group.services);
        services.into_iter().flatten().map(|service| service.name).collect()
    }

    /// Names of the TOML files in a folder of the configuration.
    fn files(&self, folder: &str) -> Vec<String> {
        let Ok(config) = paths::config_folder(&self.config) else { return Vec::new() };
        let entries = fs::read_dir(config.join(folder)).into_iter().flatten().flatten();
        let name = |file: fs::DirEntry| {
            Some(Path::new(&file.file_name()).to_str()?.strip_suffix(".toml")?.to_owned())
        };
        sorted(entries.filter_map(name))
    }

    fn keys(&self) -> Vec<String> {
        let origins = self.settings().map(|settings| settings.origins());
        sorted(origins.into_iter().flatten().map(|origin| format!("{}=", origin.key)))
    }

    fn objects(&self) -> Vec<String> {
        let names = |scene: &Scene| scene.objects().iter().map(|it| it.name.clone()).collect();
        self.settings().map_or_else(Vec::new, |settings| names(&settings.scene))
    }
}
