//! The interaction that `await pick` waits for.

use messages::Ended;

use service::view::Latest;

/// Consecutive polls that must find everything applied before an old outcome is reported. The
/// services publish their parts of one step within microseconds, but not at once.
const LOOKS: u32 = 3;

/// Waits for the end of one interaction: the one that is open, or that words already accepted will
/// open; else the latest that was not reported yet; else the next.
#[derive(Debug)]
pub struct Waiting {
    reported: u64,
    goal: Option<u64>,
    settled: u32,
}

impl Waiting {
    /// Waits for an interaction after `reported`, the latest that was reported; 0 for none.
    pub fn new(reported: u64) -> Self {
        Self { reported, goal: None, settled: 0 }
    }

    /// Returns the awaited outcome, if the interaction has ended.
    pub fn look(&mut self, seen: &Latest) -> Option<Ended> {
        let view = seen.view.as_ref()?;
        if let Some(goal) = self.goal {
            return view.last.clone().filter(|last| last.interaction.0 >= goal);
        }
        if !seen.is_settled() {
            self.settled = 0;
            return None;
        }
        if view.interaction != 0 {
            self.goal = Some(view.interaction);
            return None;
        }
        self.settled += 1;
        let last = view.last.clone().filter(|last| last.interaction.0 > self.reported);
        last.filter(|_| self.settled >= LOOKS)
    }

    /// Returns whether words after utterance `reported`, the latest one of which the outcome was reported, have
    /// opened no interaction, and none is awaited: what they asked for is not there, or they asked for nothing.
    pub fn is_in_vain(&self, seen: &Latest, reported: u64) -> bool {
        let Some(view) = seen.view.as_ref().filter(|_| self.goal.is_none()) else { return false };
        let led_somewhere = reported.max(view.utterances.1);
        seen.is_settled() && self.settled >= LOOKS && view.applied > led_somewhere
    }
}

#[cfg(test)]
mod tests {
    use scene::Question;

    use super::super::super::conversation::example::{asked, ended, listening, unapplied};
    use super::*;

    /// Returns the interaction whose end is reported after these polls, and the poll that reports it.
    fn reported(before: u64, looks: &[Latest]) -> Option<(usize, u64)> {
        let mut waiting = Waiting::new(before);
        let ends = looks.iter().map(|seen| waiting.look(seen)).enumerate();
        ends.into_iter().find_map(|(n, ended)| Some((n, ended?.interaction.0)))
    }

    #[test]
    fn await_reports_the_latest_outcome_once() {
        let looks = [ended(7), ended(7), ended(7), ended(7)];
        assert_eq!(reported(0, &looks), Some((2, 7)));
        assert_eq!(reported(6, &looks), Some((2, 7)));
        assert_eq!(reported(7, &looks), None);
        assert_eq!(
            reported(7, &[looks.to_vec(), vec![asked(Question::None), ended(8)]].concat()),
            Some((5, 8))
        );
    }

    #[test]
    fn await_puts_pending_words_first() {
        for pending in [unapplied(ended(6)), listening(ended(6))] {
            let looks = [vec![pending; 5], vec![asked(Question::None), ended(7)]].concat();
            assert_eq!(reported(0, &looks), Some((6, 7)));
        }
        // They may also lead to nothing.
        let looks = [unapplied(ended(6)), ended(6), ended(6), ended(6)];
        assert_eq!(reported(0, &looks), Some((3, 6)));
    }

    #[test]
    fn await_finds_the_end_of_an_open_interaction_even_if_the_next_follows_at_once() {
        let mut next = ended(7);
        if let Some(view) = &mut next.view {
            view.interaction = 8;
        }
        assert_eq!(
            reported(0, &[asked(Question::None), asked(Question::None), next]),
            Some((2, 7))
        );
    }

    #[test]
    fn await_ends_with_words_that_lead_to_no_interaction() {
        // Utterances 1 to 3 belong to interaction 7, which was reported.
        let with = |mut seen: Latest, applied: u64| {
            if let Some(view) = &mut seen.view {
                (view.applied, view.utterances) = (applied, (1, 3));
            }
            Latest { accepted: applied, ..seen }
        };
        let in_vain = |looks: &[Latest], reported: u64| {
            let mut waiting = Waiting::new(7);
            let look = |seen| waiting.look(seen).is_none() && waiting.is_in_vain(seen, reported);
            looks.iter().position(look)
        };
        let answered = with(ended(7), 4);
        assert_eq!(in_vain(&vec![with(ended(7), 3); 9], 0), None, "of the interaction");
        assert_eq!(in_vain(&vec![answered.clone(); 9], 0), Some(2));
        assert_eq!(in_vain(&vec![answered.clone(); 9], 4), None, "reported before");
        assert_eq!(in_vain(&vec![unapplied(answered.clone()); 9], 0), None);
        let opens = with(asked(Question::None), 4);
        assert_eq!(in_vain(&[answered.clone(), opens.clone(), answered, opens], 0), None);
    }

    #[test]
    fn await_reports_nothing_before_the_first_view() {
        assert_eq!(reported(0, &[Latest::default(), Latest::default(), Latest::default()]), None);
    }
}
