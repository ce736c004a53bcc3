//! Agreement of a group's journals. Each service makes received messages durable before it acts on
//! them, so at any moment, also after a crash, a receiver's journal holds nothing that its sender's
//! does not. If it does, one of them is older than the others: restored from a copy, or shortened.

use std::process::{Child, Stdio};

use messages::Service;

use super::JournalSet;
use crate::exit::{Exit, Failure};
use crate::group::GroupPaths;
use crate::inspection::{SharedFacts, Verdict};
use crate::launch;

/// A journal that lacks a basis of another one.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what}; help: `whichone journal set-aside {}`, with the group down", behind.name())]
pub struct Behind {
    what: String,
    /// The service whose journal is behind.
    pub behind: Service,
}

impl From<Behind> for Failure {
    fn from(behind: Behind) -> Self {
        Self::new(Exit::Storage, behind.to_string())
    }
}

/// Checks the journals of speech, policy and arm against one another; returns the facts in words.
///
/// # Errors
/// The first journal that is older than another.
pub fn agree(set: &JournalSet, [speech, policy, arm]: [SharedFacts; 3]) -> Result<String, Behind> {
    let accepted = speech.utterance.max(set.numbers_over);
    if policy.utterance > accepted {
        let applied = policy.utterance;
        let what = format!(
            "speech.journal is older than policy.journal: the policy has applied utterance {applied}, \
             speech accepted {accepted}"
        );
        return Err(Behind { what, behind: Service::Speech });
    }
    let is_listed = |(interaction, ..): &&(u64, u32, u16)| *interaction > policy.since;
    let known: Vec<_> = arm.picks.iter().filter(is_listed).collect();
    if let Some((interaction, attempt, object)) = known.iter().find(|it| !policy.picks.contains(it))
    {
        let what = format!(
            "policy.journal is older than arm.journal: the arm took on pick {interaction}.{attempt} of \
             object {object}, which the policy never ordered"
        );
        return Err(Behind { what, behind: Service::Policy });
    }
    let newest = arm.picks.last().map_or(0, |(interaction, ..)| *interaction);
    if policy.delivered > newest.max(set.numbers_over) {
        let what = format!(
            "arm.journal is older than policy.journal: the policy knows of a delivery in interaction {}, \
             for which the arm took on no pick",
            policy.delivered
        );
        return Err(Behind { what, behind: Service::Arm });
    }
    let picks = scene::count(known.len(), "pick");
    Ok(format!("nothing applied that was not accepted, {picks} as ordered, epoch {}", set.epoch))
}

/// Checks the journals of a group that is down, each read by its service's own program; all at
/// once, because a start waits for it. Services that are not ours say nothing about others.
///
/// # Errors
/// As [`agree`].
pub fn check_agreement(paths: &GroupPaths, set: &JournalSet) -> Result<(), Behind> {
    let started = Service::JOURNALED.map(|service| start_reading(paths, service));
    let facts = started.map(|child| child.and_then(facts));
    // Missing facts cannot contradict the others.
    let [Some(speech), Some(policy), Some(arm)] = facts else { return Ok(()) };
    agree(set, [speech, policy, arm]).map(drop)
}

/// Returns whether the arm of a group that is down may move, by its journal; `None` if its program
/// cannot tell.
pub(super) fn is_free(paths: &GroupPaths) -> Option<bool> {
    let facts = start_reading(paths, Service::Arm).and_then(facts)?;
    facts.stopped.map(|stopped| !stopped)
}

fn start_reading(paths: &GroupPaths, service: Service) -> Option<Child> {
    let mut command = launch::command(launch::program_of(service.name()));
    command.args(["journal", "--facts"]).arg(paths.journal_file(service.name()));
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null());
    command.spawn().ok()
}

fn facts(child: Child) -> Option<SharedFacts> {
    let output = child.wait_with_output().ok()?;
    serde_json::from_slice::<Verdict>(&output.stdout).ok()?.shared
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facts(utterance: u64, picks: &[(u64, u32, u16)], since: u64) -> SharedFacts {
        let picks = picks.iter().copied().collect();
        SharedFacts { utterance, picks, since, ..SharedFacts::default() }
    }

    fn behind(set: &JournalSet, facts: [SharedFacts; 3]) -> (Service, String) {
        let found = agree(set, facts).unwrap_err();
        (found.behind, found.to_string())
    }

    #[test]
    fn a_journal_that_is_older_than_another_is_found() {
        let set = JournalSet::new(7);
        let speech = || facts(5, &[], 0);
        let orders = [(1, 1, 2), (2, 1, 0)];
        assert!(agree(&set, [speech(), facts(5, &orders, 0), facts(0, &orders, 0)]).is_ok());
        assert!(agree(&set, [speech(), facts(4, &orders, 0), facts(0, &orders[..1], 0)]).is_ok());
        let (service, what) = behind(&set, [speech(), facts(6, &orders, 0), facts(0, &[], 0)]);
        assert!(service == Service::Speech && what.contains("utterance 6, speech accepted 5"));
        assert!(what.contains("`whichone journal set-aside speech`"), "{what}");
        let (service, what) =
            behind(&set, [speech(), facts(5, &orders, 0), facts(0, &[(2, 1, 1)], 0)]);
        assert!(service == Service::Policy && what.contains("pick 2.1 of object 1"), "{what}");
        // Facts that the policy no longer keeps cannot be compared.
        assert!(agree(&set, [speech(), facts(5, &orders[1..], 1), facts(0, &orders, 0)]).is_ok());
    }

    #[test]
    fn an_arm_that_forgot_a_pick_is_found_unless_it_was_set_aside() {
        let mut set = JournalSet::new(7);
        let orders = [(1, 1, 2), (2, 1, 0)];
        let policy = || SharedFacts { delivered: 2, ..facts(5, &orders, 0) };
        assert!(agree(&set, [facts(5, &[], 0), policy(), facts(0, &orders, 0)]).is_ok());
        let older = || [facts(5, &[], 0), policy(), facts(0, &orders[..1], 0)];
        let (service, what) = behind(&set, older());
        assert!(service == Service::Arm && what.contains("interaction 2"), "{what}");
        set.numbers_over = 1_000;
        assert!(agree(&set, older()).is_ok());
    }
}
