//! The question that an utterance answers, as far as words go.

use scene::{AttributeId, Options, Question, Role, Scene, ValueId, WordId};

use crate::lexicon::ValueSense;
use crate::morphology::inflected;

/// A question, in words of the scene.
#[derive(Clone, Copy, Debug)]
pub(crate) enum QuestionWords<'a> {
    /// Nothing.
    Nothing,
    /// "This one?": the words of the object pointed at.
    Object(&'a [WordId]),
    /// Question about an object from perception, which the scene file does not have: only a yes or
    /// no answers it.
    PerceivedObject,
    /// "Is it white?"
    Value(AttributeId, WordId),
    /// "What colour is it?"
    Attribute,
    /// "White, metallic or clear?", in the order said.
    Choice([Option<WordId>; Options::MAX]),
}

impl QuestionWords<'_> {
    /// Returns whether nothing was asked.
    pub(crate) fn is_nothing(self) -> bool {
        matches!(self, Self::Nothing)
    }

    /// Returns whether ruling out `group` answers the question, because the value asked about is in
    /// it.
    pub(crate) fn is_denied_by(self, group: &[WordId]) -> bool {
        match self {
            Self::Value(_, asked) => group.iter().all(|word| *word == asked),
            Self::Object(words) => group.iter().all(|word| words.contains(word)),
            Self::Nothing | Self::PerceivedObject | Self::Attribute | Self::Choice(_) => false,
        }
    }
}

/// The scene's part of [`QuestionWords`], without the scene.
#[derive(Clone, Debug)]
pub(crate) struct SceneQuestions {
    objects: Vec<Box<[WordId]>>,
    attributes: Vec<Box<[WordId]>>,
    /// The names of each attribute, as one word each.
    names: Vec<Box<[String]>>,
    /// Kinds that are named in plural, as "scissors" are.
    plurals: Vec<WordId>,
}

impl SceneQuestions {
    pub(crate) fn new(scene: &Scene) -> Self {
        let objects = (0..scene.objects().len()).map(scene::ObjectId::from);
        let words =
            |attribute: &scene::Attribute| attribute.values.iter().map(|v| v.word).collect();
        let values = scene.attributes().iter().flat_map(|attribute| &attribute.values);
        let is_plural = |value: &&scene::Value| {
            let name = &value.name;
            value.role() == Role::Kind && name.ends_with('s') && !name.ends_with("ss")
        };
        let names = |attribute: &scene::Attribute| {
            let all = std::iter::once(&attribute.name).chain(&attribute.synonyms);
            all.map(|name| name.to_lowercase()).collect()
        };
        Self {
            objects: objects.map(|i| scene.vocabulary(i).collect()).collect(),
            attributes: scene.attributes().iter().map(words).collect(),
            names: scene.attributes().iter().map(names).collect(),
            plurals: values.filter(is_plural).map(|value| value.word).collect(),
        }
    }

    /// The values of the attribute that a word names, in any of its forms.
    pub(crate) fn values(&self, word: &str) -> &[WordId] {
        let is_named = |names: &[String]| {
            names
                .iter()
                .any(|name| name == word || inflected(name, false).iter().any(|it| it == word))
        };
        let found = self.names.iter().position(|names| is_named(names));
        found.map_or(&[], |k| &self.attributes[k])
    }

    /// The values of the attribute that has a value.
    pub(crate) fn values_beside(&self, value: &ValueSense) -> &[WordId] {
        value.attributes.first().map_or(&[], |k| self.of(*k))
    }

    /// "a pair of scissors" is one thing, if the scene calls it so.
    pub(crate) fn is_plural(&self, word: WordId) -> bool {
        self.plurals.contains(&word)
    }

    /// The number of objects that have all of the words, and of no excluded group all.
    pub(crate) fn suited(&self, words: &[WordId], excluded: &[Vec<WordId>]) -> usize {
        let suits = |object: &[WordId]| {
            let has_all = |words: &[WordId]| words.iter().all(|word| object.contains(word));
            has_all(words) && !excluded.iter().any(|group| has_all(group))
        };
        self.objects.iter().filter(|object| suits(object)).count()
    }

    /// The values of an attribute; none of one that the scene does not have.
    pub(crate) fn of(&self, k: AttributeId) -> &[WordId] {
        self.attributes.get(k.index()).map_or(&[], |values| values)
    }

    /// The question in words; one about a value that the scene does not have asks nothing.
    pub(crate) fn asked(&self, question: Question) -> QuestionWords<'_> {
        match question {
            Question::None => QuestionWords::Nothing,
            Question::Which(_) => QuestionWords::Attribute,
            Question::Choice(k, options) => {
                let word = |v: &ValueId| self.of(k).get(v.index()).copied();
                let mut words = [None; Options::MAX];
                words.iter_mut().zip(options.values()).for_each(|(slot, v)| *slot = word(v));
                QuestionWords::Choice(words)
            }
            Question::Point(i) => self
                .objects
                .get(i.index())
                .map_or(QuestionWords::PerceivedObject, |words| QuestionWords::Object(words)),
            Question::Attribute(k, v) => {
                let word = self.of(k).get(v.index());
                word.map_or(QuestionWords::Nothing, |word| QuestionWords::Value(k, *word))
            }
        }
    }
}
