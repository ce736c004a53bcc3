//! A user's understanding of the robot's questions.

use language::Reader;
use scene::{AttributeId, Question, Scene, ValueId};

/// Wordings of one question that users know.
const WORDINGS: u64 = 4;

/// Returns the question that the robot's words ask; [`Question::None`] where they ask for any
/// description.
pub(super) fn understand(scene: &Scene, reader: &Reader, words: &str) -> Question {
    let mut parts = words.split_inclusive(['.', '?', '!']).map(str::trim);
    let question = parts.rfind(|part| part.ends_with('?')).unwrap_or(words);
    let value = |word: &String| {
        let mut attributes = scene.attributes().iter().enumerate();
        attributes.find_map(|(k, attribute)| {
            let v = attribute.values.iter().position(|value| value.name == *word)?;
            Some((AttributeId::from(k), ValueId::from(v)))
        })
    };
    let named = reader.mentions(question, Question::None);
    let words = named.iter().map(|mention| &scene.words()[mention.word.index()]);
    let values: Vec<_> = words.filter_map(value).collect();
    match values.as_slice() {
        [(k, v)] => Question::Attribute(*k, *v),
        [(k, _), rest @ ..] if rest.iter().all(|(other, _)| other == k) => Question::Which(*k),
        _ => asked_about(scene, question),
    }
}

/// An open question names its attribute, or is worded as the scene words it.
fn asked_about(scene: &Scene, question: &str) -> Question {
    let lower = question.to_lowercase();
    let is_about = |(k, attribute): (usize, &scene::Attribute)| {
        let asked = Question::Which(AttributeId::from(k));
        let wordings = (0..WORDINGS).map(|n| scene.phrase_variant(asked, n, 1, &[]));
        let names = std::iter::once(&attribute.name).chain(&attribute.synonyms).cloned();
        let mut all = wordings.chain(names);
        all.any(|text| lower.contains(&text.to_lowercase())).then_some(asked)
    };
    scene.attributes().iter().enumerate().find_map(is_about).unwrap_or(Question::None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use dialogue::{Belief, Model};
    use evaluation::simulation::SimulatedUser;
    use evaluation::simulation::users::{Domain, Manners, Policy};
    use scene::ObjectId;
    use vocabulary::{Language, Params, Rng};

    #[test]
    fn every_question_of_the_scene_is_understood_from_its_words() {
        let scene = crate::settings(&[]).scene;
        let reader = Reader::new(&scene, Language::Careful);
        let asked = |words: &str| understand(&scene, &reader, words);
        for (k, attribute) in scene.attributes().iter().enumerate() {
            let k = AttributeId::from(k);
            for v in (0..attribute.values.len()).map(ValueId::from) {
                let question = Question::Attribute(k, v);
                for (n, presentation) in (0..WORDINGS).flat_map(|n| (1..5).map(move |p| (n, p))) {
                    let words = scene.phrase_variant(question, n, presentation, &[]);
                    assert_eq!(asked(&words), question, "{words}");
                }
                let words = format!("I do not know \"red\" here. {}", scene.phrase(question));
                assert_eq!(asked(&words), question, "{words}");
            }
            for n in 0..WORDINGS {
                let words = scene.phrase_variant(Question::Which(k), n, 1, &[]);
                assert_eq!(asked(&words), Question::Which(k), "{words}");
            }
        }
        assert_eq!(asked("Which bowl would you like?"), Question::None);
    }

    /// An attentive user never rules out the wanted object.
    #[test]
    fn attentive_users_answer_truthfully() {
        let scene = crate::settings(&[]).scene;
        let reader = Reader::new(&scene, Language::Careful);
        let model = Model::new(&scene, Params::default());
        let domain = Domain { scene: &scene, model: &model };
        for seed in 0..600 {
            let wanted = ObjectId::from((seed % 6) as usize);
            let policy = Policy::Talkative(&Manners::ATTENTIVE);
            let mut user = SimulatedUser::new(policy, wanted, Rng::new(seed));
            let k = AttributeId::from((seed / 6 % 5) as usize);
            let values = scene.attributes()[k.index()].values.len();
            let v = ValueId::from(user.rng().below(values));
            for question in [Question::Attribute(k, v), Question::Which(k), Question::None] {
                let reply = user.answer(domain, question).reply;
                let said = reply.text().expect("an attentive user answers");
                let mut belief = Belief::uniform(6);
                belief.update(&model, question, &reader.read(said, question));
                let best = belief.probabilities().iter().copied().fold(0.0, f64::max);
                let own = belief.probabilities()[wanted.index()];
                assert!(own > 0.9 * best, "seed {seed}: {question:?} of {wanted:?}: {said}");
            }
        }
    }
}
