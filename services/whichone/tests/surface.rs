//! The command surface as people see it. It is a contract: scripts rest on it, so a change shows
//! here. `WHICHONE_BLESS=1` writes the new text.

use std::path::Path;

use clap::FromArgMatches;
use clap::error::ErrorKind;
use whichone::cli::Cli;

/// The help of every verb, one below the other.
fn surface() -> String {
    let mut command = Cli::definition().color(clap::ColorChoice::Never);
    command.build();
    let mut text = format!("$ whichone --help\n{}", command.clone().render_long_help());
    for verb in command.get_subcommands_mut() {
        let help = verb.render_long_help();
        text += &format!("\n$ whichone {} --help\n{help}", verb.get_name());
    }
    let lines = text.lines().map(str::trim_end);
    lines.flat_map(|line| [line, "\n"]).collect()
}

#[test]
fn command_surface_matches_the_golden_file() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/surface.txt");
    let found = surface();
    if std::env::var_os("WHICHONE_BLESS").is_some() {
        std::fs::write(&path, &found).unwrap();
    }
    let agreed = std::fs::read_to_string(&path).unwrap_or_default();
    let differs = agreed.lines().zip(found.lines()).position(|(a, b)| a != b);
    let line = differs.unwrap_or(agreed.lines().count().min(found.lines().count())) + 1;
    assert!(
        agreed == found,
        "{} differs from line {line} on; if that is meant, run the test with WHICHONE_BLESS=1",
        path.display()
    );
}

#[test]
fn every_verb_and_every_argument_has_help() {
    let mut command = Cli::definition();
    command.build();
    for verb in command.get_subcommands() {
        assert!(verb.get_about().is_some(), "{}", verb.get_name());
        for argument in verb.get_arguments() {
            let (verb, argument) = (verb.get_name(), argument.get_id());
            let help = command.find_subcommand(verb).unwrap().get_arguments();
            let mut help = help.filter(|a| a.get_id() == argument);
            assert!(help.any(|a| a.get_help().is_some()), "{verb} {argument}");
        }
    }
}

#[test]
fn group_is_listed_where_it_means_something_and_accepted_everywhere() {
    let help = |words: &[&str]| {
        let mut command = Cli::definition();
        command.build();
        let verb = words.iter().fold(&mut command, |command, word| {
            command.find_subcommand_mut(word).unwrap_or_else(|| panic!("{words:?}"))
        });
        verb.render_long_help().to_string()
    };
    for (words, is_listed) in [
        (&["say"][..], true),
        (&["study", "report"], true),
        (&["study"], false),
        (&["export", "pomdp"], false),
        (&["export", "mcap"], true),
        (&["ground"], false),
        (&["arm", "plot"], false),
    ] {
        assert_eq!(help(words).contains("--group"), is_listed, "{words:?}");
    }
    for line in
        ["study report --group lab", "ground --scene x --group lab", "--group lab ground --scene x"]
    {
        let line = ["whichone"].into_iter().chain(line.split(' ')).map(Into::into);
        assert_eq!(Cli::parse_line(line).unwrap().common.group.as_str(), "lab");
    }
}

/// Verbs whose time is felt are parsed by a definition of their own.
#[test]
fn quick_verbs_are_parsed_as_the_whole_program_would() {
    let parsed = |line: &str| Cli::parse_line(line.split(' ').map(Into::into));
    for line in [
        "whichone say the clear bowl --timeout 3 --json --group lab",
        "whichone --group lab --json say --timeout 5 --timeout 3 the clear bowl",
        "whichone --group lab status --json",
        "whichone stop-motion --json --group lab",
        "whichone --json resume-motion --group lab --timeout 3",
    ] {
        let quick = parsed(line).unwrap();
        let whole = Cli::definition().try_get_matches_from(line.split(' ')).unwrap();
        let whole = Cli::from_arg_matches(&whole).unwrap();
        assert_eq!(format!("{quick:?}"), format!("{whole:?}"), "{line}");
        assert_eq!((quick.common.group.as_str(), quick.common.json), ("lab", true), "{line}");
    }
    for (line, kind) in [
        ("whichone say --help", ErrorKind::DisplayHelp),
        ("whichone --version", ErrorKind::DisplayVersion),
        ("whichone status now", ErrorKind::UnknownArgument),
    ] {
        assert_eq!(parsed(line).unwrap_err().kind(), kind, "{line}");
    }
}

#[test]
fn clap_definition_is_consistent() {
    Cli::definition().debug_assert();
}

/// Scripts give options of their own before those of their users.
#[test]
fn option_given_twice_has_its_last_value() {
    let words = "whichone up --detach --wait ready --detach --timeout 5 --timeout 7";
    let matches = Cli::definition().try_get_matches_from(words.split(' ')).unwrap();
    let up = matches.subcommand_matches("up").unwrap();
    assert_eq!(up.get_one::<std::time::Duration>("timeout").unwrap().as_secs(), 7);
}
