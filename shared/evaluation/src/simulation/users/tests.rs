use super::*;
use crate::simulation::Patience;
use crate::simulation::testing::bowls;
use dialogue::{Actions, Costs, DecisionProblem, Mode, Params};
use language::{Language, Reader};
use preflight::{Pace, Voice};
use scene::{AttributeId, Scene};

/// A room with every question allowed, and what lives in it.
struct House {
    scene: Scene,
    reader: Reader,
    model: dialogue::Model,
    pace: Pace,
}

impl House {
    fn new() -> Self {
        let scene = bowls();
        let reader = Reader::new(&scene, Language::Careful);
        let model = dialogue::Model::new(&scene, Params::default());
        Self { scene, reader, model, pace: Pace::default() }
    }

    fn room(&self) -> Room<'_> {
        let actions = Actions { mode: Mode::Present, attribute: true, which: true };
        Room {
            scene: &self.scene,
            reader: &self.reader,
            problem: DecisionProblem::new(&self.model, Costs::SECONDS, actions),
            patience: Patience::default(),
            voice: Voice::default(),
            pace: &self.pace,
            motions: None,
            request: true,
        }
    }
}

/// What the most probable hypothesis does to a uniform belief: the probability of what is wanted.
fn believed(house: &House, question: Question, user: &dyn User, turn: &Turn) -> Option<f64> {
    let Said::Words(words) = &turn.said else { return None };
    let mut belief = dialogue::Belief::uniform(6);
    let heard: Vec<_> = (words.iter())
        .map(|(text, weight)| (*weight, question, house.reader.read(text, question).reading))
        .collect();
    belief.update_mixture(&house.model, &heard);
    Some(belief.probability(user.wanted()))
}

#[test]
fn kinds_are_found_by_name() {
    for (name, kind) in UserKind::ALL {
        assert_eq!((UserKind::named(name), kind.name()), (Some(kind), name));
    }
    assert_eq!(UserKind::named("robot"), None);
}

#[test]
fn the_same_number_is_the_same_person_and_wants_the_same_of_every_kind() {
    let house = House::new();
    let room = house.room();
    for number in 0..50 {
        let question = Question::Which(AttributeId(0));
        let talk = |kind: UserKind| {
            let mut user = kind.person(&room, 3, number);
            (user.wanted(), user.request(), user.answer(question))
        };
        for (_, kind) in UserKind::ALL {
            assert_eq!(talk(kind), talk(kind));
            assert_eq!(talk(kind).0, talk(UserKind::Model).0);
        }
    }
}

/// Over all people and questions, what is understood must speak for the wanted object about as
/// often as the kind of people is right; a grounding that misread the wording would show here.
#[test]
fn what_people_say_is_understood() {
    let house = House::new();
    let room = house.room();
    let questions = room.problem.actions.questions(&house.model);
    for (kind, least) in
        [(UserKind::Truthful, 1.0), (UserKind::Noisy, 0.80), (UserKind::Human, 0.93)]
    {
        let (mut for_it, mut all, mut silent) = (0, 0, 0);
        for number in 0..400 {
            let mut user = kind.person(&room, 17, number);
            for question in &questions {
                let turn = user.answer(*question);
                let Some(p) = believed(&house, *question, &*user, &turn) else {
                    silent += 1;
                    continue;
                };
                all += 1;
                for_it += u32::from(p >= 1.0 / 6.0 - 1e-9);
            }
        }
        let share = f64::from(for_it) / f64::from(all);
        assert!(share >= least, "{}: {share} of {all}", kind.name());
        let silence = f64::from(silent) / f64::from(all + silent);
        match kind {
            UserKind::Truthful => assert_eq!(silent, 0),
            UserKind::Noisy => assert!((0.22..0.36).contains(&silence), "{silence}"),
            _ => assert!((0.03..0.09).contains(&silence), "{silence}"),
        }
    }
}

#[test]
fn requests_name_values_that_the_object_has() {
    let house = House::new();
    let room = house.room();
    for kind in [UserKind::Noisy, UserKind::Human] {
        let (mut told, mut against) = (0, 0);
        for number in 0..500 {
            let mut user = kind.person(&room, 5, number);
            let turn = user.request();
            let Some(p) = believed(&house, Question::None, &*user, &turn) else { continue };
            told += u32::from(p > 1.0 / 6.0 + 1e-9);
            against += u32::from(p < 1.0 / 6.0 - 1e-9);
        }
        assert!(told > 150 && against < 25, "{}: {told} {against}", kind.name());
    }
}

#[test]
fn a_wrong_answer_is_another_one_where_there_is_one() {
    let house = House::new();
    let mut rng = Rng::new(1);
    let shape = house.scene.attribute_named("shape").unwrap();
    for question in house.room().problem.actions.questions(&house.model) {
        for wanted in (0..6).map(ObjectId::from) {
            let truth = Answer::truthful(&house.model, question, wanted);
            let wrong = wrong_answer(&house.model, question, wanted, &mut rng);
            assert_eq!(wrong == truth, question == Question::Which(shape), "{question:?}");
        }
    }
}
