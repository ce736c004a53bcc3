//! Answers that come late, early, into the next question, and twice, under each rule of attribution.
//!
//! Every dialogue is held with the same user under each rule (`dialogue.turns.attribution`). A wrong
//! pick is caused by timing where the same user with good timing gets the right object.

use config::Settings;
use dialogue::Model;
use dialogue::manager::{Cause, Record};
use evaluation::simulation::users::{Domain, Habits};
use scene::ObjectId;
use vocabulary::NamedQuestion;

use super::{Channel, GroupUser, SimulatedGroup};
use crate::settings;

/// The rules that are compared, by their names in the settings.
const RULES: [&str; 3] = ["mixture", "onset", "naive"];
/// Turn-taking errors of the users.
const HABITS: Habits = Habits { late: 0.15, early: 0.12, overlapping: 0.12, doubled: 0.12 };
/// Silence after which a question is repeated, seconds: short, so that answers come into what the
/// robot says next.
const WINDOW: &str = "2.5";

/// Results of many dialogues under one rule and one input channel.
#[derive(Clone, Debug, Default)]
pub struct Count {
    /// Name of the rule.
    pub rule: String,
    /// True if the robot heard utterances live; else after their end.
    pub live: bool,
    /// Dialogues.
    pub dialogues: u64,
    /// Those in which the wrong object was picked, or none.
    pub wrong: u64,
    /// Those of them in which the same user with good timing gets the right one.
    pub wrong_by_timing: u64,
    /// Answers that were applied.
    pub answers: u64,
    /// The probability given to the question that was answered, summed over the answers.
    pub credited: f64,
    /// The probability given to other questions, summed over the answers.
    pub miscredited: f64,
    /// Questions asked, in all.
    pub questions: u64,
    /// Seconds to the decision, in all.
    pub seconds: f64,
    /// Logs of the dialogues that failed because of timing.
    pub stories: Vec<String>,
}

/// Holds `dialogues` dialogues under each rule, half of them live; counts them by rule and channel.
///
/// # Panics
/// If a rule is not in the settings.
pub fn study(dialogues: u64, seed: u64) -> Vec<Count> {
    let counts = RULES.iter().flat_map(|rule| {
        [Channel::Live, Channel::Afterwards].map(|channel| count(rule, channel, dialogues, seed))
    });
    counts.collect()
}

fn count(rule: &str, channel: Channel, dialogues: u64, seed: u64) -> Count {
    let settings = settings(&[
        ("dialogue.turns.attribution", rule),
        ("dialogue.turns.response_window_s", WINDOW),
        // The answer to a choice names what it answers; a yes does not.
        ("dialogue.choice_questions", "false"),
    ]);
    let live = channel == Channel::Live;
    let mut count = Count { rule: rule.to_owned(), live, ..Count::default() };
    for number in (0..dialogues).filter(|number| (number % 2 == 0) == live) {
        let seed = seed.wrapping_mul(1_000_003).wrapping_add(number);
        let group = converse(&settings, channel, Some(HABITS), seed);
        let by_timing = !is_right(&group) && is_right(&converse(&settings, channel, None, seed));
        count.add(&group, by_timing, seed);
    }
    count
}

fn converse(
    settings: &Settings,
    channel: Channel,
    habits: Option<Habits>,
    seed: u64,
) -> SimulatedGroup {
    let model = Model::new(&settings.scene, settings.dialogue.params);
    let domain = Domain { scene: &settings.scene, model: &model };
    let window_s = settings.dialogue.turns.response_window_s;
    let user = GroupUser::speaking(domain, channel, habits, window_s, seed);
    let mut group = SimulatedGroup::talking(settings.clone(), user, seed ^ 0x5eed);
    group.run();
    group
}

fn is_right(group: &SimulatedGroup) -> bool {
    group.picked.is_some() && group.picked == group.user.wanted()
}

impl Count {
    fn add(&mut self, group: &SimulatedGroup, by_timing: bool, seed: u64) {
        let last = group.policy.journal().last();
        let open = last.and_then(|record| record.state.open.as_ref());
        self.dialogues += 1;
        self.wrong += u64::from(!is_right(group));
        self.wrong_by_timing += u64::from(by_timing);
        for (right, wrong) in credits(group) {
            self.answers += 1;
            self.credited += right;
            self.miscredited += wrong;
        }
        self.questions += u64::from(open.map_or(0, |open| open.questions));
        self.seconds += group.seconds();
        if by_timing {
            let (wanted, picked): (_, Option<ObjectId>) = (group.user.wanted(), group.picked);
            let story = group.story();
            self.stories.push(format!("seed {seed}: {wanted:?}, picked {picked:?}\n{story}"));
        }
    }

    /// Share of the answers' probability that went to the question that was answered.
    pub fn share(&self) -> f64 {
        self.credited / self.answers.max(1) as f64
    }

    /// Share that went to other questions.
    pub fn share_wrong(&self) -> f64 {
        self.miscredited / self.answers.max(1) as f64
    }
}

/// The probabilities that each answer was credited to its own question and to others, from the
/// policy's journal.
fn credits(group: &SimulatedGroup) -> Vec<(f64, f64)> {
    let credit = |record: &Record| {
        let Cause::Utterance(heard) = &record.cause else { return None };
        let utterance = group.user.utterance(heard.seq.0)?;
        let evidence = record.state.open.as_ref()?.evidence.last()?;
        let truth = NamedQuestion::new(group.scene(), utterance.question);
        if truth == NamedQuestion::None {
            return None;
        }
        let weight = |is: &dyn Fn(&NamedQuestion) -> bool| -> f64 {
            evidence.interpretations.iter().filter(|(_, asked, _)| is(asked)).map(|(w, ..)| w).sum()
        };
        let all = weight(&|_| true);
        let right = weight(&|asked| *asked == truth) / all;
        let wrong = weight(&|asked| *asked != truth && *asked != NamedQuestion::None) / all;
        Some((right, wrong))
    };
    group.policy.journal().iter().filter_map(credit).collect()
}
