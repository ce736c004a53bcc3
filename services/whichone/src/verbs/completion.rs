//! Completion of command lines: the scripts for shells, and the names that they ask this program for.

use std::fs;
use std::path::Path;

use clap_complete::{Shell, generate};
use command_line::Outcome;
use command_line::configuration;
use command_line::output::Output;
use config::Settings;
use messages::SUPERVISOR;
use service::exit::{Exit, Failure};
use service::group::{ENV_GROUP, GroupName, GroupPaths};

use crate::cli::{Cli, ConfigArgs};

/// Start of the function that completes in bash and zsh; the names are asked for first.
const FUNCTION: &str = "_whichone() {\n";

const BASH: &str = r#"    mapfile -t COMPREPLY < <(whichone complete -- "${COMP_WORDS[@]:0:COMP_CWORD+1}" 2>/dev/null)
    if ((${#COMPREPLY[@]})); then
        [[ ${COMPREPLY[0]} != *= ]] || compopt -o nospace
        return 0
    fi
"#;

const ZSH: &str = r#"    local -a names
    names=(${(f)"$(whichone complete -- "${(@)words[1,CURRENT]}" 2>/dev/null)"})
    if (( $#names )); then
        compadd -S '' -a names
        return
    fi
"#;

const FISH: &str = "complete -c whichone -f -a '(whichone complete -- (commandline -opc) (commandline -ct) 2>/dev/null)'\n";

/// Prints the script that completes command lines in a shell.
pub(super) fn completions(shell: Shell, out: &mut Output<'_>) -> Outcome {
    let mut script = Vec::new();
    generate(shell, &mut Cli::definition(), "whichone", &mut script);
    let script = String::from_utf8_lossy(&script);
    let script = match shell {
        Shell::Bash => script.replacen(FUNCTION, &format!("{FUNCTION}{BASH}"), 1),
        Shell::Zsh => script.replacen(FUNCTION, &format!("{FUNCTION}{ZSH}"), 1),
        Shell::Fish => format!("{script}{FISH}"),
        _ => script.into_owned(),
    };
    out.text(&script)?;
    Ok(Exit::Ok)
}

/// Prints the names that the last word of a line may be, one per line; none where it is no name, and the
/// shell's own script knows what it may be.
pub(super) fn complete(line: &[String], out: &mut Output<'_>) -> Outcome {
    let Some((word, before)) = line.split_last() else { return Ok(Exit::Ok) };
    // Bash makes two words of `--group=lab`, and a third of the sign.
    let word = if word == "=" { "" } else { word.as_str() };
    let names = Line::read(before).names();
    for name in names.iter().filter(|name| name.starts_with(word)) {
        out.queue_line(name)?;
    }
    Ok(Exit::Ok)
}

/// A line before the word that is completed.
struct Line {
    /// Words that are neither options nor their values: the verb, its action, …
    verbs: Vec<String>,
    /// The option whose value the word is.
    option: Option<String>,
    group: Option<String>,
    config: ConfigArgs,
}

impl Line {
    fn read(before: &[String]) -> Self {
        let mut line =
            Self { verbs: Vec::new(), option: None, group: None, config: ConfigArgs::default() };
        line.config.config = std::env::var_os("WHICHONE_CONFIG").map(Into::into);
        let words = before.iter().skip(1).filter(|word| *word != "=");
        for word in words.flat_map(|word| match word.split_once('=') {
            Some((option, value)) if word.starts_with("--") => vec![option, value],
            _ => vec![word.as_str()],
        }) {
            match line.option.take() {
                _ if word.starts_with('-') => line.option = takes_value(word),
                Some(option) => line.note(&option, word),
                None => line.verbs.push(word.to_owned()),
            }
        }
        line
    }

    fn note(&mut self, option: &str, value: &str) {
        match option {
            "--group" => self.group = Some(value.to_owned()),
            "--config" => self.config.config = Some(value.into()),
            "--profile" => self.config.profile = Some(value.to_owned()),
            "--scene" if !value.contains(['/', '.']) => {
                self.config.set.push(("group.scene".to_owned(), value.to_owned()));
            }
            _ => {}
        }
    }

    fn names(&self) -> Vec<String> {
        let verbs: Vec<&str> = self.verbs.iter().map(String::as_str).collect();
        match (self.option.as_deref(), verbs.as_slice()) {
            (Some("--group"), _) => groups(),
            (Some("--profile"), _) => self.files("profiles"),
            (Some("--scene"), _) => self.files("scenes"),
            (Some("--set" | "--what-if"), _) => self.keys(),
            (Some("--answer-as" | "--object"), _) => self.objects(),
            (Some("--service"), _) => self.services(),
            (Some(_), _) => Vec::new(),
            (None, ["start" | "stop" | "restart" | "hold" | "release" | "swap"]) => self.services(),
            (None, ["logs"]) => {
                self.services().into_iter().chain([SUPERVISOR.to_owned()]).collect()
            }
            (None, ["scene", "show" | "check" | "place"] | ["export", "pomdp"]) => {
                self.files("scenes")
            }
            (None, ["objects", "add" | "move" | "remove"]) => self.objects(),
            (None, _) => Vec::new(),
        }
    }

    /// Settings of the running group, unless the line names others, else of the configuration.
    fn settings(&self) -> Option<Settings> {
        let running = (!self.config.is_given()).then(|| self.running()).flatten();
        running.or_else(|| {
            let folder = configuration::folder(&self.config).ok()?;
            let profile = self.config.profile.as_deref();
            Settings::examine(&folder, profile, &self.config.set, None).settings
        })
    }

    fn running(&self) -> Option<Settings> {
        let named = self.group.clone().or_else(|| std::env::var(ENV_GROUP).ok());
        let name = GroupName::new(named.as_deref().unwrap_or(GroupName::DEFAULT)).ok()?;
        Settings::load_snapshot(&GroupPaths::resolve(&name).ok()?.run()).ok()
    }

    fn services(&self) -> Vec<String> {
        let services = self.settings().map(|settings| settings.group.services);
        services.into_iter().flatten().map(|service| service.name).collect()
    }

    /// Names of the TOML files in a folder of the configuration.
    fn files(&self, folder: &str) -> Vec<String> {
        let Ok(config) = configuration::folder(&self.config) else { return Vec::new() };
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
        let Some(settings) = self.settings() else { return Vec::new() };
        settings.scene.objects().iter().map(|object| object.name.clone()).collect()
    }
}

/// Returns the option that a word is, if the next word is its value.
fn takes_value(word: &str) -> Option<String> {
    let definition = Cli::definition();
    let mut commands = vec![&definition];
    while let Some(command) = commands.pop() {
        let named = |argument: &&clap::Arg| {
            argument.get_long().map(|long| format!("--{long}")).as_deref() == Some(word)
        };
        if let Some(argument) = command.get_arguments().find(named) {
            return argument.get_action().takes_values().then(|| word.to_owned());
        }
        commands.extend(command.get_subcommands());
    }
    None
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
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shipped configuration, and what a line's last word may be.
    fn offered(line: &str) -> Vec<String> {
        let config = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config");
        let line = format!("whichone --config {config} {line}");
        let words: Vec<String> = line.split(' ').map(str::to_owned).collect();
        let mut bytes = Vec::new();
        complete(&words, &mut Output::to(&mut bytes, false)).unwrap();
        String::from_utf8(bytes).unwrap().lines().map(str::to_owned).collect()
    }

    #[test]
    fn names_are_those_of_the_configuration() {
        for (line, names) in [
            ("restart g", &["grounding"][..]),
            ("restart --timeout 3 g", &["grounding"]),
            ("logs sup", &["supervisor"]),
            ("up --profile pap", &["paper"]),
            ("up --profile=pap", &[]),
            ("up --profile = pap", &["paper"]),
            ("ground --scene ma", &["markers"]),
            ("scene check bo", &["bowls"]),
            ("export pomdp to", &["tools"]),
            ("check --set group.sc", &["group.scene="]),
            ("await pick --answer-as white", &["white", "white2", "white3"]),
            ("arm plot --scene markers --object b", &["blue"]),
            ("say bo", &[]),
            ("restart grounding ", &[]),
        ] {
            let mut found = offered(line);
            found.sort();
            assert_eq!(found, names, "{line}");
        }
    }

    #[test]
    fn scripts_ask_for_names() {
        for shell in [Shell::Bash, Shell::Zsh, Shell::Fish] {
            let mut bytes = Vec::new();
            completions(shell, &mut Output::to(&mut bytes, false)).unwrap();
            let script = String::from_utf8(bytes).unwrap();
            assert!(script.contains("whichone complete --"), "{shell}");
            assert!(script.contains("stop-motion"), "{shell}");
        }
    }
}
