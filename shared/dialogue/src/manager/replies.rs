//! Answers to questions to the robot: from the scene, the state and the evidence.

use scene::{Intent, ObjectId, Reading, WordId};
use vocabulary::ActKind;

use super::Manager;
use super::hand_over::HandedOver;
use super::line::{AboutObjects, Content, Reason, Remark};
use super::state::{Interaction, State};
use super::utterance::Utterance;

/// Most objects that a reason names.
const RIVALS_MAX: usize = 3;

impl Manager {
    /// Returns the answer to an utterance that is not about the wanted object.
    pub(super) fn answer(&mut self, state: &State, said: &Utterance, intent: Intent) -> Remark {
        let is_about_objects = matches!(
            intent,
            Intent::AskBack
                | Intent::AskCount
                | Intent::AskWhich
                | Intent::AskWhether
                | Intent::AskWhere
        );
        if let Some(word) = said.unknown.as_ref().filter(|_| is_about_objects) {
            return Remark::Unknown(word.clone());
        }
        match intent {
            Intent::Greet => Remark::Greeting,
            Intent::Leave => Remark::Goodbye,
            Intent::Thank => Remark::Welcome,
            Intent::AskStatus if state.stop.motion.is_latched() => Remark::StillStopped,
            Intent::AskHelp => Remark::Help,
            Intent::AskBack => Remark::Inventory,
            Intent::AskCount => self.objects(said, intent, AboutObjects::Count),
            Intent::AskWhich => self.objects(said, intent, AboutObjects::Which),
            Intent::AskWhether => self.objects(said, intent, AboutObjects::Whether),
            Intent::AskWhere => self.objects(said, intent, AboutObjects::Where),
            Intent::AskWhy => Remark::Why(self.reason(state)),
            Intent::Chore => Remark::OnlyFetches(self.fetched_instead(state, said)),
            _ => self.status(state),
        }
    }

    /// Returns the robot's current activity.
    pub(super) fn status(&mut self, state: &State) -> Remark {
        // A pending question still needs an answer; anything else waits for the release.
        if state.stop.motion.is_latched()
            && (state.act.kind != ActKind::Ask || state.open.is_none())
        {
            return Remark::StillStopped;
        }
        if state.to_put_back().is_some() {
            return self.about_putting_back(state);
        }
        let picked = state.open.as_ref().and_then(|open| open.pick);
        match (state.act.kind, picked) {
            (ActKind::Cancel, Some((_, object))) => Remark::Leaving(self.description(object)),
            (_, Some((_, object))) => Remark::Fetching(self.description(object)),
            (ActKind::Ask, None) => Remark::AllRight,
            (_, None) if state.kept().is_some() => Remark::AllRight,
            (_, None) if state.handed_over.is_some() => Remark::AllRight,
            _ => Remark::Idle,
        }
    }

    /// Returns the name of the one object that is to be washed or the like: it can be fetched
    /// instead if nothing else is under way and the user does not have it.
    fn fetched_instead(&self, state: &State, said: &Utterance) -> Option<String> {
        if state.open.is_some() || state.ordered().is_some() {
            return None;
        }
        let reading = likeliest(said, Intent::Chore).filter(|it| !it.base.is_empty())?;
        let described: Vec<ObjectId> = self.described(reading).collect();
        let [object] = described[..] else { return None };
        let name = &self.setup.scene.object(object).name;
        let has_it = state.with_user.as_ref().is_some_and(|it| it.name == *name)
            || state.handed_over.as_ref().and_then(HandedOver::object) == Some(object);
        (!has_it).then(|| name.clone())
    }

    /// Returns the object that the standing line offers to fetch.
    pub fn offered(&self, state: &State) -> Option<ObjectId> {
        match &state.act.line.content {
            Content::Remark(Remark::OnlyFetches(Some(name))) => self.setup.scene.object_named(name),
            _ => None,
        }
    }

    /// Returns the objects that the likeliest reading with that intent describes.
    fn objects(&self, said: &Utterance, intent: Intent, asked: AboutObjects) -> Remark {
        let scene = &self.setup.scene;
        let Some(reading) = likeliest(said, intent) else { return Remark::Inventory };
        let described = self.described(reading);
        let objects: Vec<String> = described.map(|i| scene.object(i).name.clone()).collect();
        // "is the marker long or short"
        let values: Vec<WordId> = match asked {
            AboutObjects::Which => reading.further.iter().flatten().copied().collect(),
            _ => Vec::new(),
        };
        let (asked, words) = match (values.is_empty(), &objects[..]) {
            (false, [_, ..]) => (AboutObjects::Either, &values),
            _ => (asked, &reading.base),
        };
        let name = |word: &WordId| scene.words()[word.index()].clone();
        Remark::Objects { asked, words: words.iter().map(name).collect(), objects }
    }

    /// Returns the objects that the words of a reading describe.
    pub(super) fn described(&self, reading: &Reading) -> impl Iterator<Item = ObjectId> {
        self.setup.scene.ids().filter(move |object| self.fits(reading, *object))
    }

    /// Returns whether the words of a reading describe the object.
    pub(super) fn fits(&self, reading: &Reading, object: ObjectId) -> bool {
        let has = |word: &WordId| self.setup.model.has_word(object, *word);
        let is_excluded = |group: &Vec<WordId>| !group.is_empty() && group.iter().all(has);
        reading.base.iter().all(has) && !reading.excluded.iter().any(is_excluded)
    }

    /// Returns whether another of the words is a value of the same attribute.
    pub(super) fn is_rivalled(&self, word: WordId, words: &[WordId]) -> bool {
        let meanings = |word: WordId| self.setup.model.meanings(word).iter();
        let shares =
            |other: WordId| meanings(word).any(|(k, _)| meanings(other).any(|(l, _)| k == l));
        words.iter().any(|other| *other != word && shares(*other))
    }

    fn reason(&mut self, state: &State) -> Reason {
        let delivered = || state.handed_over.as_ref().map(|it| &it.interaction);
        let Some(open) = state.open.as_ref().or_else(delivered) else { return Reason::None };
        if open.pick.is_none() {
            let mut left = self.left_by_probability(&open.belief());
            left.truncate(RIVALS_MAX);
            return Reason::Between(left.into_iter().map(|i| self.description(i)).collect());
        }
        match said(open) {
            words if words.is_empty() => Reason::Likeliest,
            words => Reason::Said(words),
        }
    }
}

pub(super) fn likeliest(said: &Utterance, intent: Intent) -> Option<&Reading> {
    let fits = said.interpretations.iter().filter(|it| it.reading.intent == intent);
    let best = fits.reduce(|best, next| if next.weight > best.weight { next } else { best });
    best.map(|best| &best.reading)
}

/// Returns the scene's words that were said, each once.
pub(super) fn said(open: &Interaction) -> Vec<String> {
    let likeliest = open.counting().filter_map(|it| it.interpretations.first());
    let mut words: Vec<String> = Vec::new();
    for word in likeliest.flat_map(|(.., reading)| &reading.base) {
        if !words.contains(word) {
            words.push(word.clone());
        }
    }
    words
}
