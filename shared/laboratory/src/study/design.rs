//! Design of a study: a row per policy and kind of people, and per rules of turn-taking.

use std::num::NonZeroU32;

use dialogue::registry;
use evaluation::simulation::UserKind;
use evaluation::simulation::turns::Rules;
use evaluation::simulation::users::TimedKind;
use service::exit::{Exit, Failure};

use crate::args::{ALL, StudyArgs};

/// One line of the table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    /// The policy's name.
    pub(super) policy: String,
    /// With whom.
    pub(super) people: People,
}

/// Whom a policy talks with.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum People {
    /// In turns.
    InTurns(UserKind),
    /// In turns, in the dialogue of that number with each person.
    Known {
        /// Answers of the person.
        kind: UserKind,
        /// From 1.
        dialogue: u32,
        /// What the person wants ([`evaluation::simulation::acquainted`]).
        zipf: f64,
    },
    /// In real time.
    RealTime {
        /// The rules of turn-taking.
        rules: Rules,
        /// Name of the simulated user.
        name: &'static str,
        /// Answers of the simulated user.
        kind: TimedKind,
    },
}

impl People {
    /// Their name.
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::InTurns(kind) | Self::Known { kind, .. } => kind.name(),
            Self::RealTime { name, .. } => name,
        }
    }

    /// Returns the number of the dialogue with each person, where they are known.
    pub(super) fn dialogue(&self) -> Option<u32> {
        match self {
            Self::Known { dialogue, .. } => Some(*dialogue),
            Self::InTurns(_) | Self::RealTime { .. } => None,
        }
    }

    /// Returns the name of the rules; empty for a dialogue in turns.
    pub(super) fn rules(&self) -> String {
        match self {
            Self::InTurns(_) | Self::Known { .. } => String::new(),
            Self::RealTime { rules, .. } => rules.to_string(),
        }
    }

    /// Returns whether they talk in real time.
    pub(super) fn in_real_time(&self) -> bool {
        matches!(self, Self::RealTime { .. })
    }
}

/// People in real time: as they usually are, and without fault.
const TIMED: [(&str, TimedKind); 2] =
    [("usual", TimedKind::USUAL), ("truthful", TimedKind::TRUTHFUL)];

/// Returns the rows that are asked for. In real time the policy is `planner` where it is among
/// those asked for, else the first of them.
pub(super) fn rows(args: &StudyArgs, planner: &str) -> Result<Vec<Row>, Failure> {
    let policies = listed(&args.policies, &registry::names());
    let kinds: Vec<UserKind> =
        listed(&args.users, &[]).iter().filter_map(|name| UserKind::named(name)).collect();
    let mut rows = Vec::new();
    for policy in &policies {
        let row = |people: People| Row { policy: policy.clone(), people };
        for kind in kinds.iter().copied() {
            let zipf = args.zipf;
            let known = |n: &NonZeroU32| row(People::Known { kind, dialogue: n.get(), zipf });
            rows.extend(args.dialogues.iter().map(known));
            rows.extend(args.dialogues.is_empty().then(|| row(People::InTurns(kind))));
        }
    }
    let timed = policies.iter().find(|name| *name == planner).or(policies.first());
    for name in listed(&args.turns, &Rules::ALL) {
        let rules = Rules::parse(&name)
            .map_err(|error| Failure::new(Exit::Usage, format!("--turns: {error}")))?;
        for (name, kind) in TIMED {
            let people = People::RealTime { rules, name, kind };
            rows.extend(timed.map(|policy| Row { policy: policy.clone(), people }));
        }
    }
    Ok(rows)
}

/// Returns the names in their order, each once, with `all` written out.
fn listed(names: &[String], all: &[&str]) -> Vec<String> {
    let mut list: Vec<String> = Vec::new();
    for name in names {
        let meant = if name == ALL { all } else { &[name.as_str()][..] };
        for name in meant {
            if !list.iter().any(|known| known == name) {
                list.push((*name).to_owned());
            }
        }
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        args: StudyArgs,
    }

    fn parsed(words: &[&str]) -> StudyArgs {
        Line::try_parse_from([&["study"], words].concat()).unwrap().args
    }

    fn args(words: &[&str]) -> StudyArgs {
        parsed(&[&["--scene", "x.toml"], words].concat())
    }

    #[test]
    fn every_policy_is_simulated_with_every_kind_of_user() {
        let all = rows(&args(&[]), "lookahead").unwrap();
        assert_eq!(all.len(), registry::names().len() * 3);
        let twice = args(&["--policies", "entropy,all,entropy", "--users", "human,human"]);
        let rows = rows(&twice, "lookahead").unwrap();
        assert_eq!(rows.len(), registry::names().len());
        assert_eq!((rows[0].policy.as_str(), rows[0].people.name()), ("entropy", "human"));
    }

    #[test]
    fn real_time_comes_in_rules_and_with_the_configured_policy() {
        let all = args(&["--policies", "entropy,lookahead", "--turns", "all"]);
        let timed: Vec<Row> = rows(&all, "lookahead").unwrap().split_off(6);
        assert_eq!(timed.len(), 2 * Rules::ALL.len());
        assert!(timed.iter().all(|row| row.policy == "lookahead"));
        assert_eq!(rows(&all, "never-ask").unwrap().pop().unwrap().policy, "entropy");
        let error = rows(&args(&["--turns", "naive,polite"]), "lookahead").unwrap_err();
        assert!(error.to_string().contains("polite"), "{error}");
    }

    #[test]
    fn preset_fills_in_missing_arguments() {
        let args = parsed(&["--preset", "paper-remote", "--users", "human"]);
        assert_eq!((args.interactions.get(), args.users.len(), args.scene), (45, 1, None));
        assert_eq!(args.turns, [ALL]);
    }
}
