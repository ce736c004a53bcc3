//! The history: the latest interactions, each with what was heard, the belief and the decision after
//! every step, and its end. Bounded.

use std::collections::VecDeque;

use messages::{ActKind, Outcome, PolicyView, Receipt, ReceiptStatus};
use scene::ObjectId;
use serde::{Deserialize, Serialize};

use super::Now;
use super::listed::{WHOLE_MAX, likeliest};

/// Most interactions.
pub(crate) const PAST_MAX: usize = 30;
/// Most steps of one; later ones replace the last.
const STEPS_MAX: usize = 40;
/// Objects of a large scene that a step adds.
const LIKELY_MAX: usize = 8;
/// Most utterances whose texts are remembered before the policy has applied them.
const HEARD_MAX: usize = 32;

/// An interaction, also one that is still open.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Past {
    pub interaction: u64,
    /// When its first step was seen, milliseconds since 1970.
    pub unix_ms: u64,
    /// Short descriptions of the objects: all of a small scene, of a large one those that were likely
    /// in some step.
    pub objects: Vec<String>,
    /// Their numbers in the scene.
    #[serde(default)]
    pub ids: Vec<u16>,
    pub steps: Vec<Step>,
    pub end: Option<End>,
}

/// What the robot made of one utterance or event.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// Time since the interaction's first step, milliseconds.
    pub after_ms: u64,
    /// The utterances since the previous step.
    pub heard: Vec<Heard>,
    /// By object; those that became likely later are missing at the end.
    pub belief: Vec<f64>,
    pub absent: f64,
    pub decision: ActKind,
    pub prompt: u64,
    /// The robot's line.
    pub text: String,
}

/// An utterance; its text is empty until its receipt has come.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Heard {
    pub seq: u64,
    pub text: String,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct End {
    pub outcome: Outcome,
    /// Short description of the object that was picked or tried.
    pub object: Option<String>,
    pub questions: u32,
    pub seconds: f64,
}

#[derive(Debug, Default)]
pub struct History {
    past: VecDeque<Past>,
    /// The latest utterances.
    heard: VecDeque<Heard>,
    /// Highest utterance applied so far.
    applied: u64,
    changed: Vec<u64>,
}

impl History {
    /// Continues the history of an earlier console.
    pub fn after(past: Vec<Past>) -> Self {
        let skipped = past.len().saturating_sub(PAST_MAX);
        let past: VecDeque<Past> = past.into_iter().skip(skipped).collect();
        let changed = past.iter().map(|past| past.interaction).collect();
        let heard = past.iter().flat_map(|past| &past.steps).flat_map(|step| &step.heard);
        let applied = heard.map(|heard| heard.seq).max().unwrap_or(0);
        Self { past, heard: VecDeque::new(), applied, changed }
    }

    pub fn past(&self) -> impl Iterator<Item = &Past> {
        self.past.iter()
    }

    /// Takes the interactions that are new or have changed since the last call.
    pub fn take_changed(&mut self) -> Vec<Past> {
        let changed = std::mem::take(&mut self.changed);
        self.past.iter().filter(|past| changed.contains(&past.interaction)).cloned().collect()
    }

    pub(super) fn on_receipt(&mut self, receipt: &Receipt) {
        let is_known = self.heard.iter().any(|heard| heard.seq == receipt.seq);
        if receipt.status != ReceiptStatus::Accepted || receipt.seq == 0 || is_known {
            return;
        }
        if self.heard.len() == HEARD_MAX {
            self.heard.pop_front();
        }
        let text = receipt.note.as_str().unwrap_or_default().to_owned();
        // Its step may be there already.
        let unheard = |past: &mut Past| {
            let heard = past.steps.iter_mut().flat_map(|step| &mut step.heard);
            let mut heard = heard.filter(|heard| heard.seq == receipt.seq && heard.text.is_empty());
            heard.next().map(|heard| heard.text.clone_from(&text)).is_some()
        };
        let late =
            self.past.iter_mut().rev().find_map(|past| unheard(past).then_some(past.interaction));
        self.changed.extend(late);
        self.heard.push_back(Heard { seq: receipt.seq, text });
    }

    /// Takes in a view of the scene whose objects have these labels.
    pub(super) fn on_view(
        &mut self,
        view: &PolicyView,
        label: impl Fn(ObjectId) -> String,
        now: Now,
    ) {
        if view.interaction != 0 {
            self.on_step(view, &label, now);
        }
        self.applied = self.applied.max(view.applied);
        self.on_end(view, &label);
    }

    fn on_step(&mut self, view: &PolicyView, label: &impl Fn(ObjectId) -> String, now: Now) {
        if self.past.back().is_none_or(|newest| newest.interaction < view.interaction) {
            if self.past.len() == PAST_MAX {
                self.past.pop_front();
            }
            self.past.push_back(Past {
                interaction: view.interaction,
                unix_ms: now.unix_ms,
                objects: Vec::new(),
                ids: Vec::new(),
                steps: Vec::new(),
                end: None,
            });
        }
        let heard = self.heard_by(view);
        let Some(past) = self.past.iter_mut().find(|past| past.interaction == view.interaction)
        else {
            return;
        };
        let after_ms = now.unix_ms.saturating_sub(past.unix_ms);
        past.list(view, label);
        let mut step = Step::of(view, &past.ids, heard, after_ms);
        let is_full = past.steps.len() == STEPS_MAX;
        match past.steps.last_mut() {
            Some(last) if last.is_repeated_by(&step) => return,
            Some(last) if is_full => {
                step.heard.splice(0..0, std::mem::take(&mut last.heard));
                step.heard.truncate(HEARD_MAX);
                *last = step;
            }
            _ => past.steps.push(step),
        }
        self.changed.push(view.interaction);
    }

    /// The utterances of the interaction that were applied since the previous view.
    fn heard_by(&self, view: &PolicyView) -> Vec<Heard> {
        let first = view.utterances.0.max(self.applied + 1).max(1);
        let first = first.max(view.applied.saturating_sub(HEARD_MAX as u64 - 1));
        let heard = |seq| {
            let known = self.heard.iter().find(|heard| heard.seq == seq).cloned();
            known.unwrap_or(Heard { seq, text: String::new() })
        };
        (first..=view.applied).map(heard).collect()
    }

    fn on_end(&mut self, view: &PolicyView, label: &impl Fn(ObjectId) -> String) {
        let Some(last) = &view.last else { return };
        let Some(past) = self.past.iter_mut().find(|past| past.interaction == last.interaction.0)
        else {
            return;
        };
        let label = last.object.map(label).filter(|label| !label.is_empty());
        let object = last.name.as_ref().map(|name| label.unwrap_or_else(|| name.clone()));
        let end =
            End { outcome: last.outcome, object, questions: last.questions, seconds: last.seconds };
        if past.end.as_ref().map(|end| end.outcome) != Some(end.outcome) {
            past.end = Some(end);
            self.changed.push(last.interaction.0);
        }
    }
}

impl Past {
    /// Adds the objects that the view is about.
    fn list(&mut self, view: &PolicyView, label: impl Fn(ObjectId) -> String) {
        if self.ids.is_empty() && !self.objects.is_empty() {
            // Of a console that listed them all.
            self.ids = (0..self.objects.len()).map(|i| ObjectId::from(i).0).collect();
        }
        let is_whole = view.belief.len() <= WHOLE_MAX;
        let most = if is_whole { WHOLE_MAX } else { LIKELY_MAX };
        let mut likely: Vec<ObjectId> = likeliest(&view.belief, most).collect();
        if is_whole {
            likely.sort_unstable();
        }
        for object in likely {
            if !self.ids.contains(&object.0) {
                self.ids.push(object.0);
                self.objects.push(label(object));
            }
        }
    }
}

impl Step {
    fn of(view: &PolicyView, ids: &[u16], heard: Vec<Heard>, after_ms: u64) -> Self {
        let digits = |share: f64| (share * 1e4).round() / 1e4;
        Self {
            after_ms,
            heard,
            belief: ids
                .iter()
                .map(|i| digits(view.belief.get(usize::from(*i)).copied().unwrap_or(0.0)))
                .collect(),
            absent: digits(view.absent),
            decision: view.decision,
            prompt: view.prompt,
            text: view.text.clone(),
        }
    }

    /// Returns whether a later view says nothing new.
    fn is_repeated_by(&self, later: &Self) -> bool {
        later.heard.is_empty()
            && (self.decision, self.prompt) == (later.decision, later.prompt)
            && (&self.text, &self.belief) == (&later.text, &later.belief)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::{Ended, FixedText, InteractionId, UtteranceSeq};

    fn now(ms: u64) -> Now {
        Now { unix_ms: 1_000 + ms, ..Now::default() }
    }

    fn view(interaction: u64, applied: u64, belief: &[f64]) -> PolicyView {
        PolicyView {
            interaction,
            applied,
            belief: belief.to_vec(),
            prompt: applied,
            text: format!("line {applied}"),
            ..PolicyView::default()
        }
    }

    fn receipt(seq: u64, text: &str) -> Receipt {
        let status = ReceiptStatus::Accepted.into();
        Receipt { seq, status, note: FixedText::truncated(text), ..Receipt::default() }
    }

    fn ended(interaction: u64, outcome: Outcome) -> PolicyView {
        let last = Ended {
            interaction: InteractionId(interaction),
            object: Some(1.into()),
            name: Some("b".to_owned()),
            outcome,
            questions: 2,
            seconds: 3.5,
            utterances: (UtteranceSeq(1), UtteranceSeq(2)),
        };
        PolicyView { last: Some(last), ..view(0, 2, &[0.5, 0.5]) }
    }

    fn label(object: ObjectId) -> String {
        ["big cup", "small cup"][object.index()].to_owned()
    }

    #[test]
    fn history_keeps_each_step_once_and_the_end() {
        let mut history = History::default();
        for n in 0..3 {
            history.on_receipt(&receipt(1, "the cup"));
            history.on_view(&view(4, 1, &[0.5, 0.5]), label, now(n));
        }
        // The receipt of the second utterance is late.
        history.on_view(&view(4, 2, &[0.1, 0.9]), label, now(700));
        history.on_receipt(&receipt(2, "no"));
        history.on_view(&ended(4, Outcome::Delivered), label, now(900));
        let past: Vec<&Past> = history.past().collect();
        let [past] = past[..] else { panic!("{past:?}") };
        let heard = |step: &Step| step.heard.iter().map(|h| h.text.clone()).collect::<Vec<_>>();
        let steps: Vec<_> =
            past.steps.iter().map(|s| (heard(s), s.after_ms, s.belief[1])).collect();
        assert_eq!(steps, [(vec!["the cup".into()], 0, 0.5), (vec!["no".into()], 700, 0.9)]);
        let end = past.end.as_ref().unwrap();
        assert_eq!((end.outcome, end.object.as_deref()), (Outcome::Delivered, Some("small cup")));
        assert_eq!(history.take_changed().len(), 1);
        assert!(history.take_changed().is_empty());
        // The object is refused after all.
        history.on_view(&ended(4, Outcome::Refused), label, now(999));
        assert_eq!(history.take_changed()[0].end.as_ref().unwrap().outcome, Outcome::Refused);
    }

    #[test]
    fn history_is_bounded() {
        let mut history = History::default();
        for interaction in 1..=100 {
            for step in 0..100 {
                let seen = view(interaction, 100 * interaction + step, &[0.5, 0.5]);
                history.on_view(&seen, label, now(step));
            }
        }
        assert_eq!(history.past().count(), PAST_MAX);
        let bounded = |past: &Past| {
            past.steps.len() <= STEPS_MAX
                && past.steps.iter().all(|step| step.heard.len() <= HEARD_MAX)
        };
        assert!(history.past().all(bounded));
    }

    #[test]
    fn history_continues_its_predecessor() {
        let mut history = History::default();
        history.on_view(&view(4, 1, &[0.5, 0.5]), label, now(0));
        let kept: Vec<Past> = history.past().cloned().collect();
        let text = serde_json::to_string(&kept).unwrap();
        let mut next = History::after(serde_json::from_str(&text).unwrap());
        assert_eq!(next.take_changed(), kept);
        next.on_view(&view(4, 1, &[0.5, 0.5]), label, now(50));
        assert!(next.take_changed().is_empty(), "what is known is not repeated");
        next.on_view(&view(4, 2, &[0.0, 1.0]), label, now(60));
        assert_eq!(next.past().next().unwrap().steps.len(), 2);
    }
}
