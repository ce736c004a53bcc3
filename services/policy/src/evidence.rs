//! What was said in the open interaction, in words in place of numbers: it outlives a change of the
//! scene, under which every object, attribute, value and word may get another number.

use crate::state::Interaction;
use scene::{AttributeId, Doubt, Question, Reading, Response, Scene, WordId};
use serde::{Deserialize, Serialize};

/// Names and words that the evidence of one interaction may hold, all utterances together. Beyond
/// it the oldest utterance is forgotten: the belief keeps what it said, but a change of the scene
/// scores the objects without it. A dialogue of the usual length needs a tenth of it.
pub const NAMES_MAX: usize = 1024;
/// What an utterance costs besides its names.
const ENTRY: usize = 4;

/// A question in words.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Asked {
    /// Nothing was asked.
    #[default]
    Nothing,
    /// "This one?"; the object's name.
    Point(String),
    /// "Is its k v?"; the names of k and v.
    Attribute(String, String),
    /// "What is its k?"; the name of k.
    Which(String),
}

impl Asked {
    /// The question's names.
    ///
    /// # Panics
    /// If the question is not of this scene.
    pub fn new(scene: &Scene, question: Question) -> Self {
        let attribute = |k: AttributeId| &scene.attributes()[k.index()];
        match question {
            Question::None => Self::Nothing,
            Question::Point(object) => Self::Point(scene.object(object).name.clone()),
            Question::Attribute(k, v) => {
                let value = attribute(k).values[v.index()].name.clone();
                Self::Attribute(attribute(k).name.clone(), value)
            }
            Question::Which(k) => Self::Which(attribute(k).name.clone()),
        }
    }

    /// The question in a scene. One about something that the scene does not have asks nothing: its
    /// answer is the same whatever is wanted.
    pub fn question(&self, scene: &Scene) -> Question {
        let found = match self {
            Self::Nothing => None,
            Self::Point(name) => scene.object_named(name).map(Question::Point),
            Self::Attribute(k, v) => scene.attribute_named(k).and_then(|k| {
                let value = scene.value_named(k, v)?;
                Some(Question::Attribute(k, value))
            }),
            Self::Which(k) => scene.attribute_named(k).map(Question::Which),
        };
        found.unwrap_or_default()
    }

    fn names(&self) -> usize {
        match self {
            Self::Nothing => 0,
            Self::Point(_) | Self::Which(_) => 1,
            Self::Attribute(..) => 2,
        }
    }
}

/// What one utterance said about the wanted object.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Evidence {
    /// What it may mean and which question it answers then, with weights; the likeliest first.
    pub meant: Vec<(f64, Asked, Said)>,
    /// A word that the scene did not have; may be empty. Another one may.
    pub unknown: String,
    /// The point that the person pointed at, metres, frame `base`.
    pub gesture: Option<[f64; 3]>,
}

/// A [`Reading`] in words.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Said {
    /// The scene's words as they were said.
    pub base: Vec<String>,
    /// The answer.
    pub response: Response,
    /// Groups of words that rule out what has all of them.
    pub excluded: Vec<Vec<String>>,
    /// How doubtful its parts are.
    pub doubt: Doubt,
}

impl Said {
    /// A reading in words.
    ///
    /// # Panics
    /// If it is not of this scene.
    pub fn new(scene: &Scene, reading: &Reading) -> Self {
        let names = |words: &[WordId]| -> Vec<String> {
            words.iter().map(|word| scene.words()[word.index()].clone()).collect()
        };
        Self {
            base: names(&reading.base),
            response: reading.response,
            excluded: reading.excluded.iter().map(|group| names(group)).collect(),
            doubt: reading.doubt.clone(),
        }
    }

    /// In a scene. A word that it does not have is true of no object, and so is a group with one.
    fn reading(&self, scene: &Scene) -> Reading {
        let word = |name: &String| scene.word_named(name);
        let base = self.base.iter().enumerate();
        let base = base.filter_map(|(at, name)| Some((word(name)?, self.doubt.of_word(at))));
        let groups = self.excluded.iter().enumerate();
        let groups = groups.filter_map(|(at, group)| {
            let words: Option<Vec<WordId>> = group.iter().map(word).collect();
            Some((words?, self.doubt.of_group(at)))
        });
        let (base, base_doubt) = base.unzip();
        let (excluded, excluded_doubt) = groups.unzip();
        let doubt =
            Doubt { base: base_doubt, excluded: excluded_doubt, response: self.doubt.response };
        Reading { base, response: self.response, excluded, doubt, ..Reading::default() }
    }

    fn names(&self) -> usize {
        self.base.len() + self.excluded.iter().map(Vec::len).sum::<usize>()
    }
}

impl Evidence {
    /// What it says in a scene, each reading as the answer to its question.
    pub fn in_scene(&self, scene: &Scene) -> Vec<(f64, Question, Reading)> {
        let meant = self.meant.iter();
        let mut heard: Vec<(f64, Question, Reading)> = meant
            .map(|(weight, asked, said)| (*weight, asked.question(scene), said.reading(scene)))
            .collect();
        // The unknown word is of the best reading. Whether it was denied is not known, so it counts
        // only where nothing was.
        if let (Some((_, _, best)), Some(word)) =
            (heard.first_mut(), scene.word_named(&self.unknown))
            && best.response != Response::No
            && best.excluded.is_empty()
        {
            best.base.push(word);
        }
        heard
    }

    fn names(&self) -> usize {
        let of = |(_, asked, said): &(f64, Asked, Said)| asked.names() + said.names();
        ENTRY + self.meant.iter().map(of).sum::<usize>()
    }
}

impl Interaction {
    /// Keeps what an utterance said; beyond [`NAMES_MAX`] what was said first is forgotten.
    pub fn keep(&mut self, evidence: Evidence) {
        self.evidence.push(evidence);
        let mut names: usize = self.evidence.iter().map(Evidence::names).sum();
        while names > NAMES_MAX {
            names -= self.evidence.remove(0).names();
            self.forgotten += 1;
        }
    }
}
