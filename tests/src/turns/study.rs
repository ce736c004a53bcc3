//! The rules of attribution side by side.

use serde::Serialize;

use super::person::{Channel, Timing};
use super::world::{Ended, converse};
use crate::settings;

/// The rules that are compared, by their names in the settings.
pub const RULES: [&str; 3] = ["mixture", "onset", "naive"];

/// What came of many dialogues under one rule, with one way for words to reach the robot.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Count {
    /// Name of the rule.
    pub rule: String,
    /// Whether words reached the robot live; else afterwards.
    pub live: bool,
    /// Dialogues.
    pub dialogues: u64,
    /// Those in which the wrong object was picked, or none.
    pub wrong: u64,
    /// Those of them in which the same person with good timing gets the right one.
    pub wrong_by_timing: u64,
    /// Answers that were taken in.
    pub answers: u64,
    /// The probability given to the question that was answered, summed over the answers.
    pub credited: f64,
    /// The probability given to other questions, summed over the answers.
    pub miscredited: f64,
    /// Questions asked, in all.
    pub questions: u64,
    /// Seconds to the decision, in all.
    pub seconds: f64,
    /// Stories of the dialogues that timing turned wrong.
    pub stories: Vec<String>,
}

/// Every rule and way.
#[derive(Clone, Debug, Serialize)]
pub struct Study {
    /// The counts, rule by rule.
    pub counts: Vec<Count>,
}

/// Silence after which a question is repeated, seconds: short, so that answers come into what the
/// robot says next.
const WINDOW: &str = "2.5";

/// Holds `dialogues` dialogues under each rule, half of them live.
///
/// # Panics
/// If the settings do not know a rule.
pub fn study(dialogues: u64, seed: u64) -> Study {
    let counts = RULES.iter().flat_map(|rule| {
        [Channel::Live, Channel::Afterwards].map(|channel| count(rule, channel, dialogues, seed))
    });
    Study { counts: counts.collect() }
}

fn count(rule: &str, channel: Channel, dialogues: u64, seed: u64) -> Count {
    let settings = settings(&[
        ("dialogue.turns.attribution", rule),
        ("dialogue.turns.response_window_s", WINDOW),
    ]);
    let live = channel == Channel::Live;
    let mut count = Count { rule: rule.to_owned(), live, ..Count::default() };
    let numbers = (0..dialogues).filter(|number| (number % 2 == 0) == live);
    for number in numbers {
        let seed = seed.wrapping_mul(1_000_003).wrapping_add(number);
        let ended = converse(&settings, channel, Timing::Bad, seed);
        let by_timing =
            !ended.is_right() && converse(&settings, channel, Timing::Good, seed).is_right();
        count.add(&ended, by_timing, seed);
    }
    count
}

impl Count {
    fn add(&mut self, ended: &Ended, by_timing: bool, seed: u64) {
        self.dialogues += 1;
        self.wrong += u64::from(!ended.is_right());
        self.wrong_by_timing += u64::from(by_timing);
        self.answers += ended.credits.len() as u64;
        self.credited += ended.credits.iter().map(|credit| credit.right).sum::<f64>();
        self.miscredited += ended.credits.iter().map(|credit| credit.wrong).sum::<f64>();
        self.questions += u64::from(ended.questions);
        self.seconds += ended.seconds;
        if by_timing {
            let story = ended.story.join("\n");
            let (wanted, picked) = (ended.wanted, ended.picked);
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
