//! Requests for several objects: one after the other.

use scene::{ObjectId, Question, Reading, Reference, WordId};
use vocabulary::time::Time;

use super::Manager;
use super::attribution::Heard;
use super::evidence::Mark;
use super::line::{AboutObjects, Preface, Remark};
use super::state::{Basis, Interaction, Preference, State};
use super::utterance::Utterance;

/// Most objects that wait for their turn.
const QUEUE_MAX: usize = 8;

impl Manager {
    /// Puts the further objects of a request in the queue, and returns the remark about them.
    pub(super) fn enqueue(&self, state: &mut State, heard: &Heard<'_>) -> Preface {
        let Some((.., reading)) = heard.interpretations.first() else { return Preface::None };
        if matches!(reading.refers, Reference::Relation(_)) {
            return Preface::None;
        }
        let words = self.setup.scene.words();
        let names = |group: &[WordId]| -> Vec<String> {
            group.iter().map(|word| words[word.index()].clone()).collect()
        };
        let room = QUEUE_MAX.saturating_sub(state.queue.len());
        let further: Vec<_> = reading.further.iter().take(room).map(|it| names(it)).collect();
        if further.is_empty() {
            return Preface::None;
        }
        let first = names(&reading.base);
        let fitting: Vec<ObjectId> = self.described(reading).collect();
        let is_alike = further.iter().all(|words| *words == first);
        if is_alike && (1..=further.len()).contains(&fitting.len()) {
            // "two red mugs", of which there is one.
            state.queue.extend(further.into_iter().skip(1).take(fitting.len() - 1));
            let objects =
                fitting.iter().map(|i| self.setup.scene.object(*i).name.clone()).collect();
            let asked = AboutObjects::Count;
            return Preface::Remark(Remark::Objects { asked, words: first, objects });
        }
        state.queue.extend(further.iter().cloned());
        Preface::InTurn([vec![first], further].concat())
    }

    /// Turns to the next object of the queue once a pick has ended, if the arm is available.
    pub(super) fn serve_queue(&mut self, state: &mut State, preface: Preface, at: Time) {
        let words = state.queue.remove(0);
        let before = state.handed_over.take().map(|it| it.interaction);
        let from = before.as_ref().map(Interaction::from).unwrap_or_default();
        let before = before.filter(|before| is_described(before, &words));
        let (seq, accepted) = (state.applied, at);
        self.open(state, &Utterance { seq, accepted, from, ..Utterance::default() });
        let base = words.iter().filter_map(|word| self.setup.scene.word_named(word)).collect();
        let reading = Reading { base, ..Reading::default() };
        let interpretations = vec![(1.0, Question::None, reading)];
        if let Some(open) = &mut state.open {
            self.take_in(open, Heard { interpretations, ..Heard::default() });
            // "both mugs": another one, whichever.
            for mark in before.iter().flat_map(|before| self.fetched(before)) {
                self.take_in(open, Heard { mark: Some(mark), ..Heard::default() });
            }
        }
        let preference = if before.is_some() { Preference::Any } else { Preference::Best };
        self.decide(state, Basis { preface, utterance: seq, preference, ..Basis::default() }, at);
    }

    /// Returns the objects that are no longer meant by the words of an interaction: the one fetched
    /// in it, and those before.
    fn fetched(&self, before: &Interaction) -> Vec<Mark> {
        let earlier = before.counting().filter_map(|evidence| evidence.mark.clone());
        earlier.chain([Mark::Not(before.picked.clone())]).collect()
    }
}

/// Returns whether these words described the object of an interaction.
fn is_described(interaction: &Interaction, words: &[String]) -> bool {
    let likeliest = interaction.counting().filter_map(|it| it.interpretations.first());
    likeliest.into_iter().any(|(.., reading)| reading.base == words)
}
