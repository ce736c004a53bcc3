//! Learning who speaks: from deliveries that are not refused, and only of named people.

use scene::ObjectId;
use vocabulary::PersonId;
use vocabulary::time::Time;

use super::Manager;
use super::evidence::{Evidence, Mark};
use super::people::{KnownPerson, People};
use super::state::{Interaction, State};
use crate::{Lesson, Speaker};

impl State {
    /// Returns the people who are known.
    pub fn people(&self) -> &People {
        &self.users.people
    }
}

impl Interaction {
    /// Returns the speaker of the utterance.
    pub fn from(&self) -> PersonId {
        self.posterior.speaker().map(|speaker| speaker.from.clone()).unwrap_or_default()
    }
}

impl Manager {
    /// Returns the person as one who speaks; `None` if the speaker is unnamed.
    pub(super) fn speaker(&self, state: &State, from: &PersonId) -> Option<Speaker> {
        if from.is_nobody() || !self.setup.people.learns {
            return None;
        }
        let unknown = || KnownPerson { id: from.clone(), ..KnownPerson::default() };
        let known = state.people().get(from).cloned().unwrap_or_else(unknown);
        Some(known.speaker(&self.setup.scene, &self.setup.model))
    }

    /// Returns the person, if the prior over objects is theirs.
    pub(super) fn regular<'a>(&self, state: &'a State, from: &PersonId) -> Option<&'a KnownPerson> {
        let known = state.people().get(from).filter(|_| self.setup.people.learns)?;
        (known.deliveries >= self.setup.people.prior_from).then_some(known)
    }

    /// Learns from the delivery with which an interaction has ended.
    pub(super) fn learn(&self, state: &mut State, interaction: &Interaction, object: ObjectId) {
        let Some(speaker) = interaction.posterior.speaker() else { return };
        let scene = &self.setup.scene;
        let model = speaker.model(&self.setup.model);
        // The refusal of an object is announced along with the answer.
        let counts = |it: &&Evidence| !matches!(it.mark, Some(Mark::Not(_)));
        let heard: Vec<_> =
            interaction.evidence.iter().filter(counts).map(|it| it.in_scene(scene)).collect();
        let lesson = Lesson::new(&model, object, heard.iter().map(Vec::as_slice));
        state.users.people.learn(&speaker.from, interaction.id, |person| {
            person.take_in(scene, &lesson, &interaction.picked);
        });
    }

    /// Forgets a person. Their open interaction continues as an unnamed user's.
    pub(super) fn forget_person(&mut self, state: &mut State, id: &PersonId, at: Time) {
        state.users.people.forget(id);
        let is_theirs = |open: &Interaction| open.from() == *id;
        let before = state.handed_over.as_mut().map(|it| &mut it.interaction);
        if let Some(before) = before.filter(|it| is_theirs(it)) {
            before.posterior = before.posterior.clone().of_anybody();
        }
        if state.open.as_ref().is_some_and(is_theirs) {
            if let Some(open) = &mut state.open {
                open.posterior = open.posterior.clone().of_anybody();
            }
            self.reconfigure(state, at);
        }
    }
}
