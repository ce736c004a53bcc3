//! A scene's words, read back: the plain phrases for each value, and for each pair of an object's
//! values, must have the scene's meaning.

use std::collections::{BTreeMap, BTreeSet};

use ::vocabulary::Language;
use scene::{AttributeId, Question, Scene, Value, ValueId, WordFindings, WordId, WordProblem};

use crate::Reader;
use crate::own_words::{is_own, own_words};

/// Most phrases of a scene that are read, so that a large one is checked in time too.
const PHRASES_MAX: usize = 2_000;
/// Most phrases for one name of a value.
const OF_NAME: usize = 8;

/// How a phrase is read.
enum Found {
    Right,
    Nothing,
    /// Another value, or the opposite; in words.
    Other(String),
}

/// Returns problems and warnings about the words of a scene: values that are read as others or
/// cannot be said at all are problems, phrases that are not understood are warnings.
pub fn word_findings(scene: &Scene) -> WordFindings {
    let (own, mut pairs) = (own_words(scene), WordFindings::default());
    let reading = ReadBack { scene, reader: Reader::new(scene, Language::Careful) };
    let named = scene.attributes().iter().enumerate().filter(|(_, it)| !it.by_place);
    let values: Vec<(usize, usize)> =
        named.flat_map(|(k, attribute)| (0..attribute.values.len()).map(move |v| (k, v))).collect();
    let names = |&(k, v): &(usize, usize)| 1 + scene.attributes()[k].values[v].synonyms.len();
    let phrases = values.iter().map(names).sum::<usize>() * OF_NAME;
    let stride = phrases.div_ceil(PHRASES_MAX).max(1);
    let mut found = WordFindings { warnings: own, ..WordFindings::default() };
    for &(k, v) in values.iter().step_by(stride) {
        reading.value(k, v, &mut found);
    }
    if found.problems.is_empty() {
        reading.pairs(&mut pairs);
    }
    found.problems.extend(pairs.problems);
    found.warnings.extend(pairs.warnings);
    found
}

struct ReadBack<'a> {
    scene: &'a Scene,
    reader: Reader,
}

impl ReadBack<'_> {
    /// Reads the phrases for one value.
    fn value(&self, k: usize, v: usize, found: &mut WordFindings) {
        let attribute = &self.scene.attributes()[k];
        let value = &attribute.values[v];
        let problem = |what: String| {
            let key = format!("attributes[{k}].values[{v}]");
            let help = "choose another name, or another `spoken` or `role`".to_owned();
            WordProblem { key, what, help }
        };
        let names = std::iter::once(&value.name).chain(&value.synonyms);
        for name in names.filter(|name| !self.is_shared(value, name)) {
            let (mut understood, mut missed) = (false, None);
            let own = is_own(name);
            let requests = match own {
                true => vec![
                    format!("the {} {name}", attribute.name),
                    format!("{} {name}", attribute.name),
                ],
                false => self.scene.requests(value, name),
            };
            let said = self.scene.request_for(&[(k.into(), v.into())]);
            let robots = (*name == value.name && !requests.contains(&said)).then_some(said);
            let denials = if own { Vec::new() } else { self.scene.denials(value, name) };
            let phrases = requests.into_iter().chain(robots).map(|phrase| (phrase, false));
            for (phrase, denied) in phrases.chain(denials.into_iter().map(|phrase| (phrase, true)))
            {
                match self.read(&phrase, &[value.word], denied) {
                    Found::Right => understood |= !denied,
                    Found::Nothing => missed = missed.or(Some(phrase)),
                    Found::Other(other) => {
                        let meant = if denied { "no " } else { "" };
                        return found.problems.push(problem(format!(
                            "expected \"{phrase}\" to be read as {meant}`{}`, found {other}",
                            value.name
                        )));
                    }
                }
            }
            match missed {
                Some(_) if !understood => found.problems.push(problem(format!(
                    "expected a plain phrase for `{name}` that is understood, found none"
                ))),
                Some(phrase) if !own => found.warnings.push(format!(
                    "\"{phrase}\" is not understood as `{}` of `{}`; help: list a synonym",
                    value.name, attribute.name
                )),
                _ => {}
            }
        }
    }

    /// Reads the phrases for pairs of values of one object.
    fn pairs(&self, found: &mut WordFindings) {
        let mut seen = BTreeSet::new();
        for object in self.scene.objects() {
            let values = object.values.iter().enumerate();
            let values: Vec<(usize, ValueId)> =
                values.filter_map(|(k, v)| Some((k, (*v)?))).collect();
            for (at, one) in values.iter().enumerate() {
                for other in &values[at + 1..] {
                    if seen.len() < PHRASES_MAX && seen.insert((*one, *other)) {
                        self.pair([*one, *other], found);
                    }
                }
            }
        }
    }

    fn pair(&self, pair: [(usize, ValueId); 2], found: &mut WordFindings) {
        let values = pair.map(|(k, v)| &self.scene.attributes()[k].values[v.index()]);
        let are_two_nouns = values.iter().all(|value| value.role() == scene::Role::Kind);
        if are_two_nouns || values.iter().any(|value| is_own(&value.name)) {
            return;
        }
        let phrase = self.scene.request_for(&pair.map(|(k, v)| (AttributeId::from(k), v)));
        let names = format!("`{}` and `{}`", values[0].name, values[1].name);
        match self.read(&phrase, &values.map(|value| value.word), false) {
            Found::Right => {}
            Found::Nothing => found.warnings.push(format!(
                "\"{phrase}\" is not understood as {names}; help: choose another name for one of them"
            )),
            Found::Other(other) => found.problems.push(WordProblem {
                key: format!("attributes[{}].values[{}]", pair[0].0, pair[0].1.index()),
                what: format!("expected \"{phrase}\" to be read as {names}, found {other}"),
                help: "choose another name for one of them, or another `spoken` or `role`".to_owned(),
            }),
        }
    }

    /// Returns whether another value has the name too; `Scene::ambiguities` reports that.
    fn is_shared(&self, value: &Value, name: &str) -> bool {
        let others = self.scene.attributes().iter().flat_map(|attribute| &attribute.values);
        let mut others = others.filter(|other| other.word != value.word);
        let is_name = |other: &String| other.eq_ignore_ascii_case(name);
        others.any(|other| is_name(&other.name) || other.synonyms.iter().any(is_name))
    }

    fn read(&self, phrase: &str, meant: &[WordId], denied: bool) -> Found {
        let reading = self.reader.read(phrase, Question::None);
        let meant: BTreeSet<WordId> = meant.iter().copied().collect();
        // The noun may be a value as well.
        let noun = self.scene.word_named(self.scene.noun()).filter(|noun| !meant.contains(noun));
        let wanted = reading.base.iter().copied().filter(|word| Some(*word) != noun);
        let wanted: BTreeSet<WordId> = wanted.collect();
        let refused: BTreeSet<WordId> = reading.excluded.iter().flatten().copied().collect();
        let (right, wrong) = if denied { (&refused, &wanted) } else { (&wanted, &refused) };
        if wrong.is_empty() && *right == meant {
            return Found::Right;
        }
        if wrong.is_empty() && right.is_subset(&meant) {
            return Found::Nothing;
        }
        let said: BTreeMap<WordId, bool> = wanted
            .iter()
            .map(|word| (*word, true))
            .chain(refused.iter().map(|word| (*word, false)))
            .collect();
        let name = |(word, is_wanted): (&WordId, &bool)| {
            let no = if *is_wanted { "" } else { "no " };
            format!("{no}`{}`", self.scene.words()[word.index()])
        };
        Found::Other(said.iter().map(name).collect::<Vec<_>>().join(", "))
    }
}
