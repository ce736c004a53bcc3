//! Latency of the robot's answers: from the end of an utterance to its text, to its meaning, to a
//! decision, to the first sound.

use std::collections::VecDeque;

use messages::{Observation, Presented, Receipt, RobotAct};
use serde::Serialize;
use service::bounded::push_bounded;

/// Answers over which the quantiles are taken.
const KEPT: usize = 500;
/// Utterances without an answer.
const OPEN_MAX: usize = 32;
/// Longest time from a meaning to the decision about it, nanoseconds: the robot defers a decision
/// for ten seconds at most. A question after a longer silence is not an answer.
const DECIDED_NS_MAX: u64 = 11_000_000_000;

/// Milliseconds of one answer: from the end of the utterance to its text, from there to its
/// meaning, to a decision, to the first sound; and all of it.
pub type Stages = [f64; 5];

/// Stages to a tenth of a millisecond.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
struct StagesView {
    heard_ms: f64,
    understood_ms: f64,
    decided_ms: f64,
    spoken_ms: f64,
    total_ms: f64,
}

impl From<Stages> for StagesView {
    fn from(stages: Stages) -> Self {
        let [heard_ms, understood_ms, decided_ms, spoken_ms, total_ms] =
            stages.map(|ms| (ms * 10.0).round() / 10.0);
        Self { heard_ms, understood_ms, decided_ms, spoken_ms, total_ms }
    }
}

/// The section `latency`: stages of the latest answer and their quantiles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct LatencySection {
    last: Option<StagesView>,
    p50: Option<StagesView>,
    p99: Option<StagesView>,
    count: u64,
}

/// The latest answers.
#[derive(Clone, Debug, Default)]
pub struct Latency {
    open: VecDeque<Open>,
    done: VecDeque<Stages>,
    count: u64,
    news: Vec<Stages>,
}

/// An utterance without an answer, nanoseconds; 0 for unknown.
#[derive(Clone, Copy, Debug, Default)]
struct Open {
    seq: u64,
    end: u64,
    accepted: u64,
    grounded: u64,
    prompt: u64,
    decided: u64,
}

impl Latency {
    pub(super) fn on_receipt(&mut self, receipt: &Receipt) {
        if receipt.seq > 0 && receipt.end_ns > 0 {
            self.open(receipt.seq).into_iter().for_each(|open| open.end = receipt.end_ns);
        }
    }

    pub(super) fn on_observation(&mut self, observation: &Observation) {
        if let Some(open) = self.open(observation.seq) {
            (open.accepted, open.grounded) = (observation.accepted_ns, observation.grounded_ns);
        }
    }

    pub(super) fn on_act(&mut self, act: &RobotAct) {
        let open = self.open.iter_mut().find(|open| open.seq == act.utterance);
        if let Some(open) = open.filter(|open| open.prompt == 0 && act.presentation == 1) {
            (open.prompt, open.decided) = (act.prompt, act.decided_ns);
        }
    }

    pub(super) fn on_presented(&mut self, presented: &Presented) {
        if presented.prompt == 0 || presented.presentation != 1 {
            return;
        }
        let prompt = presented.prompt;
        let Some(at) = self.open.iter().position(|open| open.prompt == prompt) else { return };
        let open = self.open.remove(at).unwrap_or_default();
        // Earlier utterances are not answered any more.
        self.open.retain(|other| other.seq > open.seq);
        self.finish(&open, presented.started_ns);
    }

    fn finish(&mut self, open: &Open, started: u64) {
        let marks = [open.end, open.accepted, open.grounded, open.decided, started];
        let is_late = open.decided.saturating_sub(open.grounded) > DECIDED_NS_MAX;
        if marks[0] == 0 || !marks.is_sorted() || is_late {
            return;
        }
        let ms = |from: usize| (marks[from + 1] - marks[from]) as f64 / 1e6;
        let total = (started - open.end) as f64 / 1e6;
        let stages = [ms(0), ms(1), ms(2), ms(3), total];
        push_bounded(&mut self.done, KEPT, stages);
        self.count += 1;
        self.news.push(stages);
    }

    /// Takes the answers since the last call.
    pub fn take_news(&mut self) -> Vec<Stages> {
        std::mem::take(&mut self.news)
    }

    /// Returns an utterance's entry, made if missing.
    fn open(&mut self, seq: u64) -> Option<&mut Open> {
        if let Some(at) = self.open.iter().position(|open| open.seq == seq) {
            return self.open.get_mut(at);
        }
        push_bounded(&mut self.open, OPEN_MAX, Open { seq, ..Open::default() });
        self.open.back_mut()
    }

    pub(super) fn section(&self) -> LatencySection {
        LatencySection {
            last: self.done.back().map(|stages| (*stages).into()),
            p50: self.quantile(0.5),
            p99: self.quantile(0.99),
            count: self.count,
        }
    }

    /// Returns the quantile of each stage.
    fn quantile(&self, q: f64) -> Option<StagesView> {
        let last = self.done.len().checked_sub(1)?;
        let at = (last as f64 * q).round() as usize;
        let of = |stage: usize| {
            let mut all: Vec<f64> = self.done.iter().map(|stages| stages[stage]).collect();
            all.sort_by(f64::total_cmp);
            all[at]
        };
        Some(StagesView::from(std::array::from_fn(of)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(latency: &mut Latency, seq: u64, ms: [u64; 5]) {
        let ns = ms.map(|ms| ms * 1_000_000);
        latency.on_receipt(&Receipt { seq, end_ns: ns[0], ..Receipt::default() });
        let (accepted_ns, grounded_ns) = (ns[1], ns[2]);
        let understood = Observation { seq, accepted_ns, grounded_ns, ..Observation::default() };
        latency.on_observation(&understood);
        let decided_ns = ns[3];
        let (prompt, presentation) = (seq + 100, 1);
        let act =
            RobotAct { utterance: seq, prompt, presentation, decided_ns, ..RobotAct::default() };
        latency.on_act(&act);
        let presented =
            Presented { prompt, presentation, started_ns: ns[4], ..Presented::default() };
        latency.on_presented(&presented);
        latency.on_presented(&presented);
    }

    #[test]
    fn latency_counts_each_answer_once() {
        let mut latency = Latency::default();
        answer(&mut latency, 1, [100, 700, 705, 725, 745]);
        assert_eq!(latency.take_news(), [[600.0, 5.0, 20.0, 20.0, 645.0]]);
        assert_eq!(latency.section().count, 1);
        assert_eq!(latency.section().p99.unwrap().total_ms, 645.0);
    }

    #[test]
    fn latency_ignores_inconsistent_times() {
        let mut latency = Latency::default();
        answer(&mut latency, 1, [100, 90, 705, 725, 745]);
        answer(&mut latency, 2, [0, 90, 705, 725, 745]);
        answer(&mut latency, 3, [100, 700, 705, 29_725, 29_745]);
        assert_eq!(latency.section().count, 0);
        assert_eq!(latency.section().last, None);
    }

    #[test]
    fn latency_quantiles_cover_the_latest_five_hundred() {
        let mut latency = Latency::default();
        (1..=1_000).for_each(|n| answer(&mut latency, n, [1, 2, 3, 4, 4 + n]));
        assert_eq!(latency.section().p50.unwrap().spoken_ms, 751.0);
        assert_eq!(latency.section().p99.unwrap().spoken_ms, 995.0);
        assert_eq!(latency.section().count, 1_000);
        (2_000..3_000)
            .for_each(|seq| latency.on_receipt(&Receipt { seq, end_ns: 1, ..Receipt::default() }));
        assert_eq!(latency.open.len(), OPEN_MAX);
    }
}
