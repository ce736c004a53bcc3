use super::*;
use crate::simulation::testing::House;
use preflight::Pace;
use scene::AttributeId;
use vocabulary::{Actions, Mode};

/// Every question that can be asked.
fn questions(house: &House) -> Vec<Question> {
    let actions = Actions { mode: Mode::Present, attribute: true, which: true, choice: false };
    house.model.questions(actions)
}

/// The probability of the wanted object after a turn, from a uniform belief.
fn believed(house: &House, question: Question, user: &SimulatedUser, turn: &Turn) -> Option<f64> {
    let Reply::Words(words) = &turn.reply else { return None };
    let mut belief = dialogue::Belief::uniform(6);
    let heard: Vec<_> = (words.iter())
        .map(|(text, weight)| (*weight, question, house.reader.read(text, question)))
        .collect();
    belief.update_mixture(&house.model, &heard);
    Some(belief.probability(user.wanted()?))
}

#[test]
fn user_kinds_are_found_by_name() {
    for (name, kind) in UserKind::ALL {
        assert_eq!((UserKind::named(name), kind.name()), (Some(kind), name));
    }
    assert_eq!(UserKind::named("robot"), None);
}

#[test]
fn user_number_fixes_the_wanted_object_and_the_replies() {
    let house = House::new();
    for number in 0..50 {
        let question = Question::Which(AttributeId(0));
        let talk = |kind: UserKind| {
            let mut user = kind.user(house.domain(), 3, number);
            (user.wanted(), user.request(house.domain()), user.answer(house.domain(), question))
        };
        for (_, kind) in UserKind::ALL {
            assert_eq!(talk(kind), talk(kind));
            assert_eq!(talk(kind).0, talk(UserKind::Model).0);
        }
    }
}

/// Over all users and questions, the reading must favour the wanted object about as often as the
/// kind of user is right; a grounding that misread the wording would show here.
#[test]
fn replies_are_read_in_favour_of_the_wanted_object() {
    let house = House::new();
    let all_questions = questions(&house);
    for (kind, least) in
        [(UserKind::Truthful, 1.0), (UserKind::Noisy, 0.80), (UserKind::Human, 0.93)]
    {
        let (mut for_it, mut all, mut silent) = (0, 0, 0);
        for number in 0..400 {
            let mut user = kind.user(house.domain(), 17, number);
            for question in &all_questions {
                let turn = user.answer(house.domain(), *question);
                let Some(p) = believed(&house, *question, &user, &turn) else {
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
fn requests_name_values_of_the_wanted_object() {
    let house = House::new();
    for kind in [UserKind::Noisy, UserKind::Human] {
        let (mut with, mut against) = (0, 0);
        for number in 0..500 {
            let mut user = kind.user(house.domain(), 5, number);
            let turn = user.request(house.domain());
            let Some(p) = believed(&house, Question::None, &user, &turn) else { continue };
            with += u32::from(p > 1.0 / 6.0 + 1e-9);
            against += u32::from(p < 1.0 / 6.0 - 1e-9);
        }
        assert!(with > 150 && against < 25, "{}: {with} {against}", kind.name());
    }
}

#[test]
fn user_slip_gives_another_answer_if_one_exists() {
    let house = House::new();
    let mut rng = Rng::new(1);
    let shape = house.scene.attribute_named("shape").unwrap();
    for question in questions(&house) {
        for wanted in (0..6).map(ObjectId::from) {
            let truth = Answer::truthful(&house.model, question, wanted);
            let wrong = answer_or_slip(&house.model, question, wanted, 1.0, &mut rng);
            assert_eq!(wrong == truth, question == Question::Which(shape), "{question:?}");
        }
    }
}

#[test]
fn user_denies_an_absent_object_and_never_describes_it() {
    let house = House::new();
    let mut user = SimulatedUser::truthful(None);
    for question in questions(&house) {
        let reply = user.answer(house.domain(), question).reply;
        let denied = matches!(question, Question::Point(_) | Question::Attribute(..));
        assert_eq!(reply.text(), denied.then_some("no"), "{question:?}");
    }
}

/// The times of the answers to two questions, each of two seconds, with a pause of five between: a
/// late answer begins before the next question does.
fn answers(habits: Habits, seed: u64) -> Vec<(u64, f64, bool)> {
    let house = House::new();
    let policy = Policy::Truthful { by_value: 0.0 };
    let user = SimulatedUser::new(policy, ObjectId(0), Rng::new(seed));
    let timing = Timing {
        reaction_s: (0.35, 2.2),
        window_s: 2.5,
        habits,
        pace: Pace::default(),
        ..Timing::default()
    };
    let mut user = TimedUser::new(user, timing);
    let mut said = Vec::new();
    for (prompt, began_s) in [(1, 10.0), (2, 17.0)] {
        let asked = (prompt, Question::Point(ObjectId(0)));
        user.question_began(house.domain(), asked, (began_s, began_s + 2.0));
        let take = |user: &mut TimedUser, until_s| {
            let begun = std::iter::from_fn(|| user.begins(until_s));
            begun.map(|one| (one.prompt, one.onset_s - began_s - 2.0, one.again)).collect()
        };
        let early: Vec<_> = take(&mut user, began_s + 2.0);
        user.question_ended(house.domain(), asked, began_s + 2.0);
        said.extend([early, take(&mut user, began_s + 7.0)].concat());
    }
    said
}

#[test]
fn timed_user_answers_when_its_habits_say() {
    for seed in 0..200 {
        let of = |habits| answers(habits, seed);
        let in_time = |(_, at_s, again): &(u64, f64, bool)| {
            *at_s >= 0.35 - 1e-9 && *at_s < 2.2 + 1e-9 && !again
        };
        let usual = of(Habits::default());
        assert!(usual.len() == 2 && usual.iter().all(in_time), "seed {seed}: {usual:?}");
        let early = of(Habits { early: 1.0, ..Habits::default() });
        assert!(early.iter().all(|(_, at_s, _)| *at_s < 0.0), "seed {seed}: {early:?}");
        let late = of(Habits { late: 1.0, ..Habits::default() });
        assert!(late.iter().all(|(_, at_s, _)| *at_s >= 2.2 - 1e-9), "seed {seed}: {late:?}");
        let doubled = of(Habits { doubled: 1.0, ..Habits::default() });
        let repeats = doubled.iter().filter(|(.., again)| *again).count();
        assert!(repeats >= 1, "seed {seed}: {doubled:?}");
        let overlapping = of(Habits { overlapping: 1.0, ..Habits::default() });
        let into_next =
            |(prompt, at_s, again): &&(u64, f64, bool)| *prompt == 1 && *again && *at_s < 0.0;
        assert_eq!(overlapping.iter().filter(into_next).count(), 1, "seed {seed}: {overlapping:?}");
    }
}
