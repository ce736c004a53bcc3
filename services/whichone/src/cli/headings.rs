//! The verbs of the help, under headings.

use std::fmt::Write;

use clap::Command;

/// Headings of the help with their verbs, those that a newcomer needs first.
const HEADINGS: [(&str, &[&str]); 6] = [
    ("Start here", &["up", "chat", "status", "stop-motion", "down"]),
    (
        "Talk to the robot",
        &["say", "talk", "listen", "point", "await", "watch", "console", "resume-motion", "people"],
    ),
    (
        "Run services",
        &[
            "start", "stop", "restart", "hold", "release", "reload", "swap", "logs", "doctor",
            "report",
        ],
    ),
    (
        "Set up and connect",
        &[
            "init",
            "check",
            "scene",
            "objects",
            "robot",
            "token",
            "link",
            "fleet",
            "gateway",
            "baxter",
            "completions",
        ],
    ),
    ("Look back", &["record", "replay", "journal", "export"]),
    (
        "Develop and evaluate",
        &["conform", "study", "belief", "ground", "plan", "arm", "fk", "ik", "licences", "help"],
    ),
];

/// What `help` says of itself: clap adds that verb later.
const HELP: &str = "Print this message, or the help of a verb";

/// Lists the verbs of a command under the headings.
pub(super) fn with_headings(command: Command) -> Command {
    let about = |name: &str| {
        let Some(verb) = command.find_subcommand(name) else { return HELP.to_owned() };
        let about = verb.get_about().map(ToString::to_string).unwrap_or_default();
        let aliases: Vec<&str> = verb.get_visible_aliases().collect();
        if aliases.is_empty() { about } else { format!("{about} [alias: {}]", aliases.join(", ")) }
    };
    let (header, literal) = (command.get_styles().get_header(), command.get_styles().get_literal());
    let mut verbs = String::new();
    for (heading, names) in HEADINGS {
        let _ = writeln!(verbs, "{header}{heading}:{header:#}");
        for name in names {
            let _ = writeln!(verbs, "  {literal}{name:<13}{literal:#}  {}", about(name));
        }
        verbs.push('\n');
    }
    let template = format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{verbs}\
         {header}Options:{header:#}\n{{options}}{{after-help}}"
    );
    command.help_template(template)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::Cli;

    #[test]
    fn each_verb_stands_under_one_heading() {
        let definition = Cli::definition();
        let shown = definition.get_subcommands().filter(|verb| !verb.is_hide_set());
        let mut verbs: Vec<&str> = shown.map(Command::get_name).chain(["help"]).collect();
        let mut listed: Vec<&str> =
            HEADINGS.iter().flat_map(|(_, names)| *names).copied().collect();
        verbs.sort_unstable();
        listed.sort_unstable();
        assert_eq!(listed, verbs);
    }
}
