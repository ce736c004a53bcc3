//! The reader: runs the pipeline on an utterance.

use std::sync::Arc;

use ::vocabulary::Language;
use scene::{Intent, Question, Reading, Reference, Response, Role, Scene, UnknownWord, WordId};
use words::{Tokens, normalise};

use crate::answer::response;
use crate::answer_judge::{AnswerJudge, features};
use crate::clauses::{Clause, Topic, clauses};
use crate::content::Content;
use crate::disambiguate::resolve_after_question;
use crate::extractor::extract;
use crate::fates::{Fates, fates};
use crate::halting::asks_to_go_on;
use crate::hedges::hedge;
use crate::indifference::{indifference, is_of_attribute};
use crate::intent::{intent, is_remark, is_side_talk};
use crate::judge::Judge;
use crate::lexicon::Lexicon;
use crate::ordinals::name_options;
use crate::paper::WordSpotter;
use crate::parsed::{ParsedUtterance, READINGS_MAX};
use crate::question_words::{QuestionWords, SceneQuestions};
use crate::questions::{fetches_it, question};
use crate::references::reference;
use crate::related::related;
use crate::tagger::{Tag, answers_alone, tag};
use crate::token_class::Class;
use crate::unknown::unknown_words;

/// Reads utterances about one scene. Holds all that it needs of the scene.
#[derive(Clone, Debug)]
pub struct Reader {
    language: Language,
    spotter: WordSpotter,
    lexicon: Lexicon,
    questions: SceneQuestions,
    /// Other judges than the built-in ones.
    judge: Option<Arc<Judge>>,
    answer_judge: Option<Arc<AnswerJudge>>,
    /// Whether the scene knows the places of objects.
    placed: bool,
}

impl Reader {
    /// Prepares for a scene.
    pub fn new(scene: &Scene, language: Language) -> Self {
        Self {
            language,
            spotter: WordSpotter::new(scene),
            lexicon: Lexicon::new(scene),
            questions: SceneQuestions::new(scene),
            judge: None,
            answer_judge: None,
            placed: scene.objects().iter().filter(|it| it.placement.is_some()).count() > 1,
        }
    }

    /// Replaces the judge; used in training.
    pub fn with_judge(self, judge: Arc<Judge>) -> Self {
        Self { judge: Some(judge), ..self }
    }

    /// Replaces the judge of answers; used in training.
    pub fn with_answer_judge(self, judge: Arc<AnswerJudge>) -> Self {
        Self { answer_judge: Some(judge), ..self }
    }

    pub(crate) fn judge(&self) -> &Judge {
        self.judge.as_deref().unwrap_or_else(|| Judge::built_in())
    }

    /// Returns the features of an answer for its judge, and what the rules propose; `None` if it is not judged.
    pub fn answer_features(
        &self,
        text: &str,
        last_question: Question,
    ) -> Option<(Vec<u32>, Response)> {
        let text = normalise(text);
        let tokens = Tokens::of(&text);
        let parsed = self.best_parse(&tokens, &self.hear(&tokens, last_question));
        features(&parsed, &parsed.reading()).map(|rows| (rows, parsed.reading().response))
    }

    /// Returns the reader's language.
    pub fn language(&self) -> Language {
        self.language
    }

    /// Returns the scene's part of the questions.
    pub(crate) fn questions(&self) -> &SceneQuestions {
        &self.questions
    }

    /// Returns the known words.
    pub(crate) fn lexicon(&self) -> &Lexicon {
        &self.lexicon
    }

    /// Returns the most probable reading of an utterance that followed `last_question`. Any text is
    /// an utterance; only its first [`TEXT_CHARS_MAX`](crate::TEXT_CHARS_MAX) characters are read.
    pub fn read(&self, text: &str, last_question: Question) -> Reading {
        match self.language {
            Language::Paper => self.spotter.read(text),
            Language::Careful => {
                let text = normalise(text);
                self.weighed(&Tokens::of(&text), last_question).swap_remove(0).1
            }
        }
    }

    /// Returns the attribute and object words in an utterance that followed `last_question` and that the scene
    /// lacks, for the robot's reply; none in the paper's language.
    pub fn unknown_words(&self, text: &str, last_question: Question) -> Vec<UnknownWord> {
        match self.language {
            Language::Paper => Vec::new(),
            Language::Careful => {
                let text = normalise(text);
                let tokens = Tokens::of(&text);
                let parsed = self.best_parse(&tokens, &self.hear(&tokens, last_question));
                let (tags, clauses) = (&parsed.tags, &parsed.clauses);
                let related = related(&tokens, tags, clauses, self.placed);
                unknown_words(&tokens, tags, clauses, &related)
            }
        }
    }

    /// Returns the one of these words about which the robot says that the scene lacks it: a kind of thing rather
    /// than a quality.
    pub fn unknown_word(&self, text: &str, last_question: Question) -> Option<UnknownWord> {
        let mut words = self.unknown_words(text, last_question);
        let kind = words.iter().position(|word| word.role == Role::Kind);
        (!words.is_empty()).then(|| words.swap_remove(kind.unwrap_or(0)))
    }

    /// Returns the alternative readings of an utterance that followed `last_question`, each with
    /// its weight, best first; the weights sum to 1 and there are at most
    /// [`READINGS_MAX`](crate::READINGS_MAX). The first equals that of [`Self::read`] except for
    /// its doubts.
    ///
    /// `confidence` holds the probability of each blank-separated word of the text, 0 to 1; words
    /// beyond its end are certain. It becomes the doubt of the scene words, groups and answers that
    /// were read from them. The paper's language has one reading without doubt.
    pub fn readings(
        &self,
        text: &str,
        confidence: &[f32],
        last_question: Question,
    ) -> Vec<(f64, Reading)> {
        match self.language {
            Language::Paper => vec![(1.0, self.spotter.read(text))],
            Language::Careful => {
                let text = normalise(text);
                let tokens = Tokens::heard(&text, confidence);
                self.weighed(&tokens, last_question)
            }
        }
    }

    pub(crate) fn hear<'a>(&'a self, tokens: &Tokens<'a>, last_question: Question) -> Heard<'a> {
        let asked = self.questions.asked(last_question);
        let mut tags = tag(&self.lexicon, tokens);
        let is_yes_no = matches!(last_question, Question::Attribute(..) | Question::Point(_));
        if is_yes_no && self.lexicon.may_answer() && answers_alone(tokens, &tags, asked) {
            tags = tag(Lexicon::own(), tokens);
        }
        if matches!(asked, QuestionWords::Value(..)) {
            resolve_after_question(&mut tags);
        }
        if let QuestionWords::Choice(options) = asked {
            let options: Vec<WordId> = options.into_iter().flatten().collect();
            name_options(&mut tags, &options, &self.lexicon);
        }
        Heard { tags, asked }
    }

    /// Every reading of an utterance with its weight, best first.
    fn weighed(&self, tokens: &Tokens<'_>, last_question: Question) -> Vec<(f64, Reading)> {
        let heard = self.hear(tokens, last_question);
        let judge = self.answer_judge.as_deref().unwrap_or_else(|| AnswerJudge::built_in());
        let mut readings: Vec<(f64, Reading)> = Vec::new();
        for (weight, fates) in fates(self.judge(), &heard.tags, heard.asked) {
            let parsed = self.parse(tokens, &heard, &fates);
            let judged = parsed.readings().into_iter().flat_map(|(share, reading)| {
                let judged = judge.judged(&parsed, reading).into_iter();
                judged.map(move |(part, reading)| (share * part, reading))
            });
            for (share, reading) in judged {
                // Doubts say how well words were heard: they do not distinguish readings.
                match readings.iter_mut().find(|(_, known)| known.says_the_same(&reading)) {
                    Some((known, _)) => *known += weight * share,
                    None => readings.push((weight * share, reading)),
                }
            }
        }
        readings.sort_by(|a, b| b.0.total_cmp(&a.0));
        readings.truncate(READINGS_MAX);
        let all: f64 = readings.iter().map(|(weight, _)| weight).sum();
        readings.iter_mut().for_each(|(weight, _)| *weight /= all);
        readings
    }

    /// The most probable parse.
    fn best_parse<'a>(&'a self, tokens: &Tokens<'a>, heard: &Heard<'a>) -> ParsedUtterance<'a> {
        let fates = fates(self.judge(), &heard.tags, heard.asked);
        let best = fates.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
        let (_, fates) = best.expect("there is a way to read anything");
        self.parse(tokens, heard, &fates)
    }

    /// Parses the utterance, given the fates of its values.
    fn parse<'a>(
        &'a self,
        tokens: &Tokens<'a>,
        heard: &Heard<'a>,
        fates: &Fates,
    ) -> ParsedUtterance<'a> {
        let (mut tags, asked) = (heard.tags.clone(), heard.asked);
        let clauses = clauses(&tags, fates, tokens.code);
        hedge(&mut tags, &clauses);
        let new = asked.is_nothing();
        let relations = related(tokens, &tags, &clauses, self.placed);
        let mut content = extract(&tags, &clauses, fates, asked);
        let (refers, to) = reference(&tags, &clauses, asked, relations);
        let says_nothing = content.base.is_empty() && content.excluded.is_empty();
        let is_remark = new && refers == Reference::None && is_remark(&tags, fates);
        let is_aside = is_remark || says_nothing && is_side_talk(&tags, &clauses);
        if is_aside {
            content = Content::default();
        }
        let careless = indifference(&tags, &clauses, fates, asked);
        let response = response(&content, &tags, asked, careless);
        let refers = match (refers, response.0, careless) {
            (Reference::None, Response::DoesNotMatter, Some(at))
                if !is_of_attribute(&tags, at)
                    && (!new || clauses.iter().any(|clause| clause.requests)) =>
            {
                Reference::Any
            }
            (refers, ..) => refers,
        };
        let mut intent = match intent(&tags, &clauses, &content, asked, tokens.code) {
            Intent::None | Intent::Inform if says_nothing && asks_to_go_on(tokens) => Intent::GoOn,
            Intent::Inform if is_aside => Intent::None,
            Intent::None if response.0 == Response::DoesNotMatter => Intent::Inform,
            Intent::None if refers != Reference::None => Intent::Inform,
            // "the same again"
            Intent::Repeat if refers == Reference::Same => Intent::Inform,
            intent => intent,
        };
        match intent {
            Intent::AskBack => {
                (intent, content) = question(&tags, &clauses, &self.lexicon, &self.questions);
                if intent != Intent::AskHelp && fetches_it(&tags, &clauses) {
                    intent = Intent::Inform;
                }
            }
            // "put that vitamin back, mummy wants her cream"
            Intent::PutBack | Intent::Chore if fates.are_wishes() => intent = Intent::Inform,
            Intent::PutBack | Intent::Chore => {
                content = extract(&tags, &all_on(&clauses), &Fates::named_things(&tags), asked);
            }
            _ => {}
        }
        let questions = &self.questions;
        let code = tokens.code || tags.iter().any(|tag| tag.is(Class::Injection));
        ParsedUtterance {
            content,
            response,
            intent,
            refers,
            to,
            asked,
            tags,
            clauses,
            questions,
            code,
        }
    }
}

/// An utterance with the meanings of its words.
pub(crate) struct Heard<'a> {
    pub(crate) tags: Vec<Tag<'a>>,
    /// The question before the utterance.
    pub(crate) asked: QuestionWords<'a>,
}

/// Returns the clauses as those of an order, whose things are not wishes.
fn all_on(clauses: &[Clause]) -> Vec<Clause> {
    clauses.iter().map(|clause| Clause { topic: Topic::On, ..clause.clone() }).collect()
}
