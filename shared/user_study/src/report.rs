//! Results of a study.

use crate::distinct;
use crate::{Interval, Mean, wilson};
use serde_json::{Map, Value as Json, json};

use crate::Verdict;
use crate::paired::{Paired, paired};
use crate::participant::{Participant, Status};
use crate::rows::items;
use crate::trial::{End, Trial};
use crate::{Item, Kind};

/// Interactions with one policy, or with all.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// The policy; `all` for all together.
    pub policy: String,
    /// People with at least one interaction.
    pub participants: u64,
    /// Interactions that count, by their end, in the order of [`Verdict::ALL`].
    pub verdicts: [u64; 7],
    /// Seconds from the first utterance to the end.
    pub seconds: Mean,
    /// Seconds from the first utterance to the decision.
    pub talk_seconds: Mean,
    /// Questions.
    pub questions: Mean,
}

/// The answers to an item.
#[derive(Clone, Debug, PartialEq)]
pub struct Answers {
    /// The item.
    pub item: Item,
    /// Mean of the numbers; empty for items that have none.
    pub mean: Mean,
    /// Count of each value or option, in order; empty for numbers and texts.
    pub counts: Vec<(String, u64)>,
    /// Number of answers.
    pub answered: u64,
}

/// A study's results.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The study's title.
    pub title: String,
    /// Number of participants by name of their status.
    pub participants: Vec<(&'static str, u64)>,
    /// Interactions that were spoilt and repeated.
    pub faults: u64,
    /// The scenes that were used, name and key; more than one means that it was changed.
    pub scenes: Vec<(String, String)>,
    /// All interactions together.
    pub all: Group,
    /// Groups by policy, in the protocol's order.
    pub policies: Vec<Group>,
    /// Comparisons of the same people with different policies.
    pub paired: Vec<Paired>,
    /// The questionnaire.
    pub questionnaire: Vec<Answers>,
}

impl Group {
    fn new(policy: &str, people: &[&Participant], is_in: impl Fn(&Trial) -> bool) -> Self {
        let mut group = Self {
            policy: policy.to_owned(),
            participants: 0,
            verdicts: [0; 7],
            seconds: Mean::default(),
            talk_seconds: Mean::default(),
            questions: Mean::default(),
        };
        for person in people {
            let mut any = false;
            for trial in person.counted().filter(|trial| is_in(trial)) {
                any = true;
                group.add(trial);
            }
            group.participants += u64::from(any);
        }
        group
    }

    fn add(&mut self, trial: &Trial) {
        for (count, (verdict, _)) in self.verdicts.iter_mut().zip(Verdict::ALL) {
            *count += u64::from(trial.verdict() == Some(verdict));
        }
        trial.seconds().into_iter().for_each(|seconds| self.seconds.add(seconds));
        trial.talk_seconds().into_iter().for_each(|seconds| self.talk_seconds.add(seconds));
        self.questions.add(f64::from(trial.questions()));
    }

    /// Interactions.
    pub fn interactions(&self) -> u64 {
        self.verdicts.iter().sum()
    }

    /// Interactions in which the desired object was handed over.
    pub fn right(&self) -> u64 {
        self.verdicts[0]
    }

    /// Their share; 0 of none.
    pub fn success(&self) -> f64 {
        let all = self.interactions();
        if all == 0 { 0.0 } else { self.right() as f64 / all as f64 }
    }

    /// Wilson's 95 % interval of it, every interaction taken as one of its own.
    pub fn success_interval(&self) -> Interval {
        wilson(self.right(), self.interactions())
    }

    fn to_json(&self) -> Json {
        let interval = self.success_interval();
        let verdicts = Verdict::ALL.iter().zip(self.verdicts);
        let verdicts: Map<String, Json> =
            verdicts.map(|((_, name), count)| ((*name).to_owned(), count.into())).collect();
        json!({
            "policy": self.policy,
            "participants": self.participants,
            "interactions": self.interactions(),
            "outcomes": verdicts,
            "success": self.success(),
            "success_low": interval.low,
            "success_high": interval.high,
            "seconds": mean_json(&self.seconds),
            "talk_seconds": mean_json(&self.talk_seconds),
            "questions": mean_json(&self.questions),
        })
    }
}

impl Answers {
    fn new(item: &Item, people: &[&Participant]) -> Self {
        let values: Vec<String> = match item.kind {
            Kind::Likert => (1..=item.points).map(|n| n.to_string()).collect(),
            Kind::Choice => item.options.clone(),
            Kind::Number | Kind::Text => Vec::new(),
        };
        let counts = values.into_iter().map(|value| (value, 0)).collect();
        let mut answers = Self { item: item.clone(), mean: Mean::default(), counts, answered: 0 };
        let given = people.iter().filter_map(|person| person.answers.get(&item.id));
        given.for_each(|answer| answers.add(answer));
        answers
    }

    fn add(&mut self, answer: &Json) {
        self.answered += 1;
        answer.as_f64().into_iter().for_each(|number| self.mean.add(number));
        let name = answer.as_str().map_or_else(|| answer.to_string(), str::to_owned);
        if let Some((_, count)) = self.counts.iter_mut().find(|(value, _)| *value == name) {
            *count += 1;
        }
    }

    fn to_json(&self) -> Json {
        let counts: Map<String, Json> =
            self.counts.iter().map(|(value, count)| (value.clone(), (*count).into())).collect();
        let numeric = matches!(self.item.kind, Kind::Likert | Kind::Number);
        json!({
            "id": self.item.id,
            "text": self.item.text,
            "kind": self.item.kind,
            "points": self.item.points,
            "low": self.item.low,
            "high": self.item.high,
            "answered": self.answered,
            "mean": numeric.then(|| mean_json(&self.mean)),
            "counts": counts,
        })
    }
}

impl Report {
    /// Returns the report as JSON.
    pub fn to_json(&self) -> Json {
        let people: Map<String, Json> =
            self.participants.iter().map(|(name, n)| ((*name).to_owned(), (*n).into())).collect();
        let scenes = self.scenes.iter().map(|(name, key)| json!({ "name": name, "key": key }));
        json!({
            "title": self.title,
            "participants": people,
            "faults": self.faults,
            "scenes": scenes.collect::<Vec<_>>(),
            "all": self.all.to_json(),
            "policies": self.policies.iter().map(Group::to_json).collect::<Vec<_>>(),
            "paired": self.paired.iter().map(Paired::to_json).collect::<Vec<_>>(),
            "questionnaire": self.questionnaire.iter().map(Answers::to_json).collect::<Vec<_>>(),
        })
    }
}

/// Returns a mean with its interval by Student's distribution; null if there are too few numbers.
pub(crate) fn mean_json(mean: &Mean) -> Json {
    let interval = mean.student_interval();
    json!({
        "n": mean.count(),
        "mean": (mean.count() > 0).then(|| mean.mean()),
        "low": interval.map(|interval| interval.low),
        "high": interval.map(|interval| interval.high),
        "deviation": (mean.count() > 1).then(|| mean.deviation()),
    })
}

/// Returns the results of these participants. Withdrawn data does not count; data of those
/// who left or are still taking part does.
pub fn report(people: &[Participant]) -> Report {
    let counting: Vec<&Participant> = people.iter().filter(|p| p.status().counts()).collect();
    let policies = policies(&counting);
    let groups: Vec<Group> = policies
        .iter()
        .map(|policy| Group::new(policy, &counting, |trial| trial.step.policy == *policy))
        .collect();
    let status = |status: Status| people.iter().filter(|p| p.status() == status).count() as u64;
    let all = [Status::Complete, Status::Running, Status::Left, Status::Withdrawn, Status::Deleted];
    let faulted = |person: &&Participant| {
        person.trials.iter().filter(|t| matches!(t.end, Some(End::Fault(..)))).count() as u64
    };
    Report {
        title: people.last().map_or(String::new(), |p| p.begun.protocol.title.clone()),
        participants: all.map(|s| (s.name(), status(s))).to_vec(),
        faults: counting.iter().map(faulted).sum(),
        scenes: scenes(&counting),
        all: Group::new("all", &counting, |_| true),
        paired: paired(&counting, &policies),
        policies: groups,
        questionnaire: items(people).iter().map(|item| Answers::new(item, &counting)).collect(),
    }
}

/// Returns the policies of all protocols, each once, in their order.
fn policies(people: &[&Participant]) -> Vec<String> {
    distinct(people.iter().flat_map(|person| person.begun.protocol.policies.clone()))
}

fn scenes(people: &[&Participant]) -> Vec<(String, String)> {
    let trials = people.iter().flat_map(|person| person.counted());
    distinct(trials.map(|trial| (trial.drawn.scene.clone(), trial.drawn.scene_key.clone())))
}
