//! The robot's latest lines, by prompt.

use std::collections::VecDeque;

use messages::{ActKind, Presented, RobotAct};
use scene::Question;
use service::bounded::push_bounded;

const PROMPTS_MAX: usize = 32;

#[derive(Clone, Debug, Default)]
pub(super) struct Prompts(VecDeque<Prompt>);

/// A line of the robot's.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Prompt {
    pub(super) id: u64,
    pub(super) presentation: u32,
    /// Whether the prompt is a question.
    pub(super) asks: bool,
    pub(super) text: String,
}

impl Prompts {
    pub(super) fn remember(&mut self, act: &RobotAct) {
        let text = act.text.as_str().unwrap_or_default();
        let known = self.0.iter().any(|p| (p.id, p.presentation) == (act.prompt, act.presentation));
        if act.prompt == 0 || text.is_empty() || known {
            return;
        }
        let question = Question::try_from(act.question).unwrap_or_default();
        let prompt = Prompt {
            id: act.prompt,
            presentation: act.presentation,
            asks: act.kind == ActKind::Ask && question != Question::None,
            text: text.to_owned(),
        };
        push_bounded(&mut self.0, PROMPTS_MAX, prompt);
    }

    /// Returns the line that is being presented or was presented last.
    pub(super) fn of(&self, presented: &Presented) -> Option<&Prompt> {
        self.find(presented.prompt, presented.presentation)
    }

    /// Returns one presentation of a prompt, or another one if that was not seen.
    pub(super) fn find(&self, id: u64, presentation: u32) -> Option<&Prompt> {
        let of_prompt = || self.0.iter().filter(move |prompt| prompt.id == id);
        of_prompt().find(|prompt| prompt.presentation == presentation).or(of_prompt().next_back())
    }
}
