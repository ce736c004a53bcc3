//! Two policies compared within the people who met both.

use crate::Mean;
use serde_json::{Value as Json, json};

use crate::Verdict;
use crate::participant::Participant;
use crate::report::mean_json;
use crate::trial::Trial;

/// The differences of one policy from another: of each participant the mean with the one less the
/// mean with the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Paired {
    /// Policy.
    pub policy: String,
    /// Policy of the comparison.
    pub with: String,
    /// Share of successes.
    pub success: Mean,
    /// Seconds.
    pub seconds: Mean,
    /// Questions.
    pub questions: Mean,
}

impl Paired {
    /// Returns the comparison as JSON.
    pub fn to_json(&self) -> Json {
        json!({
            "policy": self.policy,
            "with": self.with,
            "participants": self.success.count(),
            "success": mean_json(&self.success),
            "seconds": mean_json(&self.seconds),
            "questions": mean_json(&self.questions),
        })
    }
}

/// Every policy but the first against the first, over those who have finished with both.
pub fn paired(people: &[&Participant], policies: &[String]) -> Vec<Paired> {
    let Some((with, others)) = policies.split_first() else { return Vec::new() };
    let compared = others.iter().map(|policy| compare(people, policy, with));
    compared.filter(|paired| paired.success.count() > 0).collect()
}

fn compare(people: &[&Participant], policy: &str, with: &str) -> Paired {
    let mut paired = Paired {
        policy: policy.to_owned(),
        with: with.to_owned(),
        success: Mean::default(),
        seconds: Mean::default(),
        questions: Mean::default(),
    };
    for person in people.iter().filter(|person| has_all(person, policy) && has_all(person, with)) {
        let mean = |name: &str, value: fn(&Trial) -> Option<f64>| {
            let mut mean = Mean::default();
            let trials = person.counted().filter(|trial| trial.step.policy == name);
            trials.filter_map(value).for_each(|value| mean.add(value));
            (mean.count() > 0).then(|| mean.mean())
        };
        let difference = |value| Some(mean(policy, value)? - mean(with, value)?);
        let right = |trial: &Trial| Some(f64::from(trial.verdict() == Some(Verdict::Right)));
        difference(right).into_iter().for_each(|d| paired.success.add(d));
        difference(Trial::seconds).into_iter().for_each(|d| paired.seconds.add(d));
        let questions = |trial: &Trial| Some(f64::from(trial.questions()));
        difference(questions).into_iter().for_each(|d| paired.questions.add(d));
    }
    paired
}

/// Returns whether the participant's plan has the policy, and all of it is done.
fn has_all(person: &Participant, policy: &str) -> bool {
    let is = |name: &str, practice: bool| name == policy && !practice;
    let planned = person.begun.plan.iter().filter(|step| is(&step.policy, step.practice)).count();
    let done = person.counted().filter(|trial| trial.step.policy == policy).count();
    planned > 0 && done == planned
}
