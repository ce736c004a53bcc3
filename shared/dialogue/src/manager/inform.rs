//! Content of an utterance about the wanted object.

use scene::{Question, Reading, Reference, Relation, Response, Role};
use vocabulary::Interpretation;
use vocabulary::time::Time;

use super::Manager;
use super::attribution::Heard;
use super::concede::likeliest;
use super::evidence::{Evidence, Mark};
use super::line::{AboutObjects, Preface, Remark};
use super::rules::{CONTENT, first};
use super::state::{Basis, Deferred, Interaction, Preference, State};
use super::turn::{Statement, Turn};
use super::utterance::Utterance;

impl Manager {
    /// Handles the words about the wanted object.
    pub(super) fn inform(&mut self, state: &mut State, turn: Turn<'_>) {
        let said = self.statement(state, turn);
        if let Some(rule) = first(CONTENT, state.stage(), |applies| applies(&said)) {
            self.rule = rule.name;
            (rule.apply)(self, state, said);
        }
    }

    /// Opens an interaction with the marks of its object: spoken of before, or refused.
    pub(super) fn begin(&mut self, state: &mut State, mut said: Statement<'_>) {
        // "and the other one" refuses nothing.
        let is_refused = said.refusal.is_some() && said.refers != Reference::Other;
        let refused = is_refused.then(|| Self::refuse_last(state, said.at)).flatten();
        let refused = refused.map(|it| Mark::Not(it.picked));
        self.open(state, said.utterance);
        let Some(open) = &mut state.open else { return };
        if said.spoken_of.is_some() {
            // The comparison is with the object handed over.
            let relations = said.heard.interpretations.iter_mut().map(|(.., it)| it);
            relations.filter(|it| is_comparison(it)).for_each(forget_relation);
        }
        for mark in said.spoken_of.take().into_iter().chain(refused) {
            self.take_in(open, Heard { mark: Some(mark), ..Heard::default() });
        }
        // The previous question is over.
        said.heard.interpretations.iter_mut().for_each(|(_, asked, _)| *asked = Question::None);
        let preface = if is_refused { Preface::Sorry } else { Preface::None };
        self.consider(state, said, preface);
    }

    /// Scores an utterance against the questions that it may answer, and decides again. The preface
    /// replaces a remark on the utterance.
    pub(super) fn consider(&mut self, state: &mut State, said: Statement<'_>, preface: Preface) {
        self.note_said(state, said.utterance);
        let (preference, mut remark) = self.note_concessions(state, &said.heard);
        let Statement { utterance, shares, mut heard, refers, at, .. } = said;
        let Some(open) = &mut state.open else { return };
        let held_back = open.held_back.take_if(|it| !it.is_kept());
        let held_back = held_back.and_then(|it| self.setup.scene.object_named(&it.name));
        let denial = held_back.and_then(|object| self.denial(object, &heard.interpretations));
        let relation = self.relation(&heard);
        if relation.is_some() {
            heard.unknown = heard.unknown.filter(|word| word.role != Role::Place);
        }
        self.take_in(open, heard);
        denial.into_iter().for_each(|denial| self.take_in(open, denial));
        let is_place = matches!(&remark, Preface::UnknownWord(word) if word.role == Role::Place);
        if self.relate(open, relation) && is_place {
            remark = Preface::None;
        }
        let preface = if preface == Preface::None { remark } else { preface };
        if let mark @ Some(_) = self.compared(open, refers) {
            self.take_in(open, Heard { mark, ..Heard::default() });
        }
        self.note_answer(state, utterance, &shares);
        self.defer(state, utterance, preference, preface, at);
        if !utterance.more {
            self.decide_deferred(state, at);
        }
    }

    /// Notes an utterance in the open interaction.
    pub(super) fn note_said(&self, state: &mut State, utterance: &Utterance) {
        let Some(open) = &mut state.open else { return };
        open.utterances.1 = utterance.seq;
        open.silences = 0;
    }

    /// Notes the concessions, further objects and retractions of an utterance. Returns the user's
    /// preference for the next decision, and the preface of the next question.
    pub(super) fn note_concessions(
        &self,
        state: &mut State,
        heard: &Heard<'_>,
    ) -> (Preference, Preface) {
        let Some(open) = &mut state.open else { return Default::default() };
        let preference = self.concede(open, &heard.interpretations);
        let preface = match self.enqueue(state, heard) {
            Preface::None => self.preface(heard),
            queued => queued,
        };
        self.retract(state, heard);
        (preference, preface)
    }

    /// Returns the object that the robot has just offered to fetch, if the user accepts the offer.
    pub(super) fn accepted(&self, state: &State, heard: &Heard<'_>) -> Option<Mark> {
        let offered = self.offered(state)?;
        let (_, question, reading) = heard.interpretations.first()?;
        let accepts = *question == Question::Point(offered) && reading.response == Response::Yes;
        (accepts && self.fits(reading, offered)).then(|| self.one_of(&[offered]))
    }

    /// Updates the interaction's posterior with an utterance, and remembers its content.
    pub(super) fn take_in(&self, open: &mut Interaction, heard: Heard) {
        let Heard { interpretations, unknown, gesture, mark } = heard;
        let model = self.learned(open.evidence.iter().filter(|it| it.counts()));
        let content = (&interpretations[..], gesture, mark.as_ref());
        self.update(&mut open.posterior, &model, content);
        if self.recall {
            let interpretations = interpretations
                .iter()
                .map(|(weight, question, reading)| self.named(*weight, *question, reading));
            let interpretations = interpretations.collect();
            let unknown = unknown.cloned();
            open.remember(Evidence { interpretations, unknown, gesture, mark });
        }
    }

    /// Records the basis of the next decision, which waits while the user is still speaking.
    pub(super) fn defer(
        &self,
        state: &mut State,
        utterance: &Utterance,
        preference: Preference,
        preface: Preface,
        at: Time,
    ) {
        let Some(open) = &mut state.open else { return };
        let before = open.deferred.take();
        let since = before.as_ref().map_or(at, |before| before.since);
        let Basis { preface: preface_before, preference: preference_before, .. } =
            before.map(|before| before.basis).unwrap_or_default();
        let preface = if preface == Preface::None { preface_before } else { preface };
        let preference =
            if preference == Preference::Best { preference_before } else { preference };
        let basis =
            Basis { heard: utterance.heard(), preface, utterance: utterance.seq, preference };
        open.deferred = Some(Deferred { basis, since });
    }

    /// Makes the deferred decision, if there is one, unless the arm puts an object back first.
    pub(super) fn decide_deferred(&mut self, state: &mut State, at: Time) {
        if state.to_put_back().is_some() {
            return;
        }
        let deferred = state.open.as_mut().and_then(|open| open.deferred.take());
        if let Some(Deferred { basis, .. }) = deferred {
            self.decide(state, basis, at);
        }
    }

    pub(super) fn open(&mut self, state: &mut State, utterance: &Utterance) {
        state.handed_over = None;
        state.last_interaction = state.last_interaction.next();
        let posterior = self.beginning(state, &utterance.from);
        let id = state.last_interaction;
        let mut open = Interaction::new(id, utterance.accepted, posterior, utterance.seq);
        open.objects = self.known_objects();
        state.open = Some(open);
    }

    /// Returns whether the user points at something that counts.
    pub(super) fn is_pointing(&self, utterance: &Utterance) -> bool {
        utterance.gesture.is_some() && self.pointing.is_some()
    }

    /// Returns whether the utterance can open an interaction: a mere answer means nothing without a
    /// question, and neither does a gesture that does not count.
    pub(super) fn is_request(&self, utterance: &Utterance) -> bool {
        let all = utterance.interpretations.iter().map(|it| &it.reading);
        let only_gesture =
            utterance.gesture.is_some() && all.clone().all(|it| *it == Reading::default());
        // "just any book", but not "I don't care" out of the blue.
        let takes_any = utterance
            .interpretations
            .iter()
            .any(|it| it.answers.is_none() && it.reading.refers == Reference::Any);
        // An utterance that is not taken for an answer has no content as one.
        let is_empty = |it: &Reading| *it == Reading::default();
        let is_answer = all.clone().all(|it| is_mere_answer(it) || is_empty(it));
        let is_answer = is_answer && is_mostly_answer(&utterance.interpretations);
        takes_any || self.is_pointing(utterance) || !(is_answer || only_gesture)
    }

    /// Returns the preface of the next question after an utterance with unknown words or no
    /// description. If it only repeats the kind ("the bowl"), the question is repeated.
    fn preface(&self, heard: &Heard<'_>) -> Preface {
        match heard.unknown {
            Some(word) => Preface::UnknownWord(word.clone()),
            None => self.nothing_described(heard).map_or(Preface::None, Preface::Remark),
        }
    }

    /// "There are no blue cups here.": each word is the scene's, but no object has all of them.
    fn nothing_described(&self, heard: &Heard<'_>) -> Option<Remark> {
        let (_, reading) = likeliest(&heard.interpretations)?;
        let base = &reading.base;
        let is_consistent = !base.iter().any(|word| self.is_rivalled(*word, base));
        let is_described = self.described(reading).next().is_some();
        let words = self.setup.scene.words();
        (base.len() > 1 && is_consistent && !is_described).then(|| Remark::Objects {
            asked: AboutObjects::Which,
            words: base.iter().map(|word| words[word.index()].clone()).collect(),
            objects: Vec::new(),
        })
    }
}

/// Returns whether a reading compares: "a bigger one".
fn is_comparison(reading: &Reading) -> bool {
    matches!(reading.refers, Reference::Relation(Relation::More(_)))
}

fn forget_relation(reading: &mut Reading) {
    reading.refers = Reference::None;
    reading.further.clear();
}

/// Returns whether no reading has a content.
pub(super) fn says_nothing(heard: &Heard) -> bool {
    heard.interpretations.iter().all(|(.., it)| *it == Reading::default())
}

/// Returns whether an utterance that may be an answer is more likely one than without content.
fn is_mostly_answer(interpretations: &[Interpretation]) -> bool {
    let weight = |answers: Option<usize>, is_answer: bool| -> f64 {
        let of_question = interpretations.iter().filter(|it| it.answers == answers);
        let alike = of_question.filter(|it| is_mere_answer(&it.reading) == is_answer);
        alike.map(|it| it.weight).sum()
    };
    let mut answers = interpretations.iter().filter(|it| is_mere_answer(&it.reading));
    answers.any(|it| weight(it.answers, true) > weight(it.answers, false))
}

fn is_mere_answer(reading: &Reading) -> bool {
    let Reading { response, base, excluded, further, .. } = reading;
    let describes = !(base.is_empty() && excluded.is_empty() && further.is_empty());
    *response != Response::None && !describes
}
