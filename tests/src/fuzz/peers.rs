//! Forged messages between the services of a group at work: valid as messages, with any numbers.

use messages::{Injection, MessageRef, MotionOrder, WireField};
use speech::record::Record;

use super::bytes::Input;
use super::group::Group;
use super::payload::injections;
use super::wire::{Plain, bytes_of, message};

/// Things that happen in one input, and steps of the group, at most.
const EVENTS_MAX: usize = 24;
const STEPS_MAX: u32 = 500;
/// What users say.
const SAYINGS: [&str; 6] = ["the white bowl", "yes", "no", "stop", "not that one", "start over"];

pub(super) fn run(input: &[u8]) {
    let mut input = Input(input);
    let (mut group, mut steps) = (Group::new(), 0);
    for _ in 0..EVENTS_MAX {
        if input.is_empty() {
            break;
        }
        match input.byte() % 6 {
            0 => group.say(SAYINGS[usize::from(input.byte()) % SAYINGS.len()]),
            1 => {
                let more = u32::from(input.byte()).min(STEPS_MAX - steps);
                group.run(more);
                steps += more;
            }
            2 | 3 => forge(&mut group, &mut input),
            4 => inject(&mut group, &mut input),
            _ => restart(&mut group, input.byte()),
        }
    }
    group.run(20);
    (0..4).for_each(|which| restart(&mut group, which));
    group.run(10);
    numbered_without_gaps(&group);
}

/// A forged message takes the place of the latest true one.
fn forge(group: &mut Group, input: &mut Input<'_>) {
    let kind = input.byte() % 11;
    let latest = &group.latest;
    match kind {
        0 => {
            if let Some(it) = forged(&latest.utterance, input) {
                group.to_grounding.push(grounding::In::Utterance(it.into()));
            }
        }
        1 => {
            if let Some(it) = forged(&latest.observation, input) {
                group.to_policy.push(policy::In::Observation(MessageRef::from(it)));
            }
        }
        2 => {
            if let Some(it) = forged(&latest.presented, input) {
                group.to_policy.push(policy::In::Presented(it));
            }
        }
        3 => {
            if let Some(it) = forged(&latest.activity, input) {
                group.to_policy.push(policy::In::Activity(it));
            }
        }
        4 => {
            if let Some(it) = forged(&latest.status, input) {
                group.to_policy.push(policy::In::Arm(it));
            }
        }
        5 => {
            if let Some(it) = forged(&latest.status, input) {
                group.to_speech.push(speech::In::Arm(it));
            }
        }
        6 => {
            if let Some(it) = forged(&latest.mark, input) {
                group.to_speech.push(speech::In::Mark(it));
            }
        }
        7 => {
            if let Some(it) = forged(&latest.act, input) {
                group.to_speech.push(speech::In::Act(MessageRef::from(it)));
            }
        }
        8 => {
            if let Some(it) = forged(&latest.act, input) {
                group.to_arm.push(arm::In::Act(MessageRef::from(it)));
            }
        }
        _ => {
            let order = if input.byte().is_multiple_of(2) {
                MotionOrder::Stop
            } else {
                MotionOrder::Resume
            };
            group.order(order, u64::from_le_bytes(input.array()));
        }
    }
    group.run(2);
}

/// Another message where readers do not refuse it.
fn forged<T: Plain + WireField>(latest: &T, input: &mut Input<'_>) -> Option<T> {
    let mut bytes = bytes_of(latest);
    input.patch(&mut bytes);
    Some(message::<T>(&bytes)).filter(|forged| forged.check().is_ok())
}

fn inject(group: &mut Group, input: &mut Input<'_>) {
    let known = injections();
    let template = &known[usize::from(input.byte()) % known.len()];
    let mut bytes = postcard::to_stdvec(template).expect("it encodes");
    input.patch(&mut bytes);
    if let Ok(injection) = postcard::from_bytes::<Injection>(&bytes) {
        group.to_speech.push(speech::In::Injection(injection));
    }
    group.run(2);
}

fn restart(group: &mut Group, which: u8) {
    match which % 4 {
        0 => group.speech.kill(),
        1 => group.grounding.kill(),
        2 => group.policy.kill(),
        _ => group.arm.kill(),
    }
    group.start();
}

fn numbered_without_gaps(group: &Group) {
    let accepted = group.speech.journal.iter().filter_map(|record| match record {
        Record::Accepted(accepted) => Some(accepted.seq.0),
        _ => None,
    });
    let numbers: Vec<u64> = accepted.collect();
    assert!(numbers.windows(2).all(|pair| Some(pair[1]) == pair[0].checked_add(1)), "{numbers:?}");
    let applied = group.policy.journal.iter().map(|record| record.state.applied.0);
    let applied: Vec<u64> = applied.collect();
    assert!(applied.windows(2).all(|pair| pair[1] - pair[0] <= 1), "{applied:?}");
    for record in &group.arm.journal {
        let joints = record.state.posture.joints.iter().flatten();
        joints.for_each(|q| assert!(q.is_finite(), "a joint at {q}"));
    }
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    // What is said, time, and a forged number of each message in between.
    let begin = [0, 0, 1, 60, 0, 1, 1, 60];
    let forge = |kind: u8| {
        let patch = [[2, kind, 1, 0, 0, 8].as_slice(), &[0xff; 8], &[1, 30, 0, 0, 1, 50]].concat();
        [&begin[..], &patch].concat()
    };
    let mut seeds: Vec<_> = (0..10).map(forge).collect();
    seeds.extend((0..5).map(|kind| [&begin[..], &[4, kind, 0, 1, 30, 5, kind]].concat()));
    seeds
}
