//! Users who take a value for another one, and say so each time.

use super::fixture::{Settings, answer, first, remark, reply, settings_of};
use crate::manager::{Manager, State};
use crate::{Model, rendering};
use scene::{AttributeId, ObjectId, Question, Reading, Response, ValueId};
use std::sync::LazyLock;
use vocabulary::ActKind;

const BOWLS: &str = include_str!("../../../../../config/scenes/bowls.toml");
const TOOLS: &str = include_str!("../../../../../config/scenes/tools.toml");

/// A user who wants an object and takes one attribute for another value.
struct User {
    wanted: ObjectId,
    mistaken: (AttributeId, ValueId),
}

impl User {
    /// The value that the user takes the object to have.
    fn perceived(&self, model: &Model, k: AttributeId) -> Option<ValueId> {
        if k == self.mistaken.0 { Some(self.mistaken.1) } else { model.value(self.wanted, k) }
    }

    fn answer(&self, settings: &Settings, manager: &Manager, question: Question) -> Reading {
        let perceived = |k| self.perceived(manager.model(), k);
        let holds = match question {
            Question::Point(object) => object == self.wanted,
            Question::Attribute(k, v) => perceived(k) == Some(v),
            Question::Choice(k, options) => {
                if let Some(value) = perceived(k).filter(|value| options.contains(*value)) {
                    let name = &settings.scene.attributes()[k.index()].values[value.index()].name;
                    let base = vec![settings.scene.word_named(name).expect("a word of a value")];
                    return Reading { base, ..Reading::default() };
                }
                false
            }
            other => panic!("{other:?}"),
        };
        answer(if holds { Response::Yes } else { Response::No })
    }
}

/// Every single misbelief about an object of the scene.
fn misbeliefs(settings: &Settings) -> Vec<User> {
    let manager = settings.manager();
    let model = manager.model();
    let mut all = Vec::new();
    for wanted in (0..model.objects()).map(ObjectId::from) {
        for k in (0..model.attributes()).map(AttributeId::from) {
            let others = (0..model.values(k)).map(ValueId::from);
            let others = others.filter(|v| model.value(wanted, k).is_some_and(|own| own != *v));
            all.extend(others.map(|v| User { wanted, mistaken: (k, v) }));
        }
    }
    all
}

fn asked(state: &State) -> Vec<Question> {
    state.open.as_ref().unwrap().prompts.iter().map(|prompt| prompt.question).collect()
}

/// Talks until the robot picks, and returns the last state.
fn talk(settings: &Settings, manager: &mut Manager, user: &User) -> State {
    let mut state = first(manager, Reading::default());
    while state.act.kind == ActKind::Ask {
        let said = user.answer(settings, manager, state.act.question);
        state = reply(manager, &state, said);
    }
    state
}

/// The dialogues of a scene's users, whom a single misbelief leads.
struct Talks {
    settings: Settings,
    ends: Vec<(User, State)>,
}

/// Conversations about the bowls and about the tools, by choices and by yes or no.
static TALKS: LazyLock<Vec<Talks>> = LazyLock::new(|| {
    let ways = [(true, 0.004), (true, 0.0125), (false, 0.0125)];
    let all = [BOWLS, TOOLS].into_iter().flat_map(|scene| ways.map(|way| (scene, way)));
    let talks = all.map(|(scene, (choices, misperception))| {
        let settings = Settings { choices, misperception, ..settings_of(scene) };
        let mut manager = settings.manager();
        let users = misbeliefs(&settings).into_iter();
        let ends = users.map(|user| {
            let end = talk(&settings, &mut manager, &user);
            (user, end)
        });
        Talks { ends: ends.collect(), settings }
    });
    talks.collect()
});

#[test]
fn no_misbelief_leads_round_in_circles() {
    for Talks { settings, ends } in &*TALKS {
        assert!(ends.len() >= 36);
        for (user, end) in ends {
            let asked = asked(end);
            let named = || settings.scene.object(user.wanted).name.clone();
            assert!(asked.len() <= 15, "{} {:?}: {asked:?}", named(), user.mistaken);
            // A choice asks about each of its values.
            let values = |question: &Question| match *question {
                Question::Choice(k, options) => {
                    options.values().iter().map(|v| Question::Attribute(k, *v)).collect()
                }
                other => vec![other],
            };
            let all: Vec<Question> = asked.iter().flat_map(values).collect();
            for question in &all {
                let times = all.iter().filter(|it| *it == question).count();
                assert!(times <= 2, "{} {:?}: {question:?}", named(), user.mistaken);
            }
        }
    }
}

/// If the description fits no object, none is fetched without asking.
#[test]
fn what_fits_nothing_is_offered_before_it_is_fetched() {
    for Talks { settings, ends } in &*TALKS {
        let manager = settings.manager();
        let model = manager.model();
        let perceived = |user: &User, k: AttributeId| user.perceived(model, k);
        let fits = |user: &User, i: ObjectId| {
            let mut attributes = (0..model.attributes()).map(AttributeId::from);
            attributes.all(|k| model.value(i, k) == perceived(user, k))
        };
        let mut wrong = 0;
        for (user, end) in ends {
            if (0..model.objects()).any(|i| fits(user, i.into())) {
                continue;
            }
            let picked = end.act.pick.expect("a pick").1;
            // An attribute that was not asked about is not a misfit.
            let denies = asked(end).iter().any(|question| match question {
                Question::Attribute(k, v) => {
                    (perceived(user, *k) == Some(*v)) != model.has(picked, *k, *v)
                }
                Question::Choice(k, options) => {
                    let named = |value: Option<ValueId>| value.filter(|it| options.contains(*it));
                    named(perceived(user, *k)) != named(model.value(picked, *k))
                }
                _ => false,
            });
            let is_offered = asked(end).contains(&Question::Point(picked));
            assert!(!denies || is_offered, "{:?}: {:?}", user.mistaken, asked(end));
            wrong += usize::from(denies && picked != user.wanted);
        }
        assert_eq!(wrong, 0, "what is offered can be declined");
    }
}

/// No clear bowl is in the cabinet: an answer leaves the place as it was said, and nothing fits; who describes
/// another bowl unasked takes the place back.
#[test]
fn answer_takes_back_nothing_that_was_said_about_another_attribute() {
    let settings = Settings { choices: true, ..settings_of(BOWLS) };
    let mut manager = settings.manager();
    let said = |word| {
        let base = vec![settings.scene.word_named(word).expect("a word of the bowls")];
        Reading { base, ..Reading::default() }
    };
    let asked = first(&mut manager, said("cabinet"));
    let color = settings.scene.attribute_named("color");
    assert_eq!(asked.act.question.attribute(), color, "{:?}", asked.act.question);
    let answered = reply(&mut manager, &asked, said("clear"));
    assert!(matches!(answered.act.question, Question::Point(_)), "{:?}", answered.act);
    let line = rendering::text(&settings.scene, &answered.act);
    assert!(line.starts_with("There "), "{line}");

    let described = remark(&mut manager, &asked, said("clear"));
    let belief = described.open.as_ref().expect("an interaction").belief();
    let clear = |i: &ObjectId| manager.model().has_word(*i, said("clear").base[0]);
    let share: f64 = settings.scene.ids().filter(clear).map(|i| belief.probability(i)).sum();
    assert!(share > 0.9, "{share}");
}

#[test]
fn the_user_is_told_what_there_is_not_and_what_there_is() {
    let settings = settings_of(TOOLS);
    let mut manager = settings.manager();
    let base = ["red", "pen"].map(|word| settings.scene.word_named(word).unwrap()).to_vec();
    let mut state = first(&mut manager, Reading { base, ..Reading::default() });
    let line = rendering::text(&settings.scene, &state.act);
    assert!(line.starts_with("There are no red pens here."), "{line}");
    for _ in 0..8 {
        let Question::Point(_) = state.act.question else {
            let said = match state.act.question {
                Question::Attribute(k, v) => {
                    let name = &settings.scene.attributes()[k.index()].values[v.index()].name;
                    if ["red", "pen"].contains(&name.as_str()) {
                        Response::Yes
                    } else {
                        Response::No
                    }
                }
                other => panic!("{other:?}"),
            };
            state = reply(&mut manager, &state, answer(said));
            continue;
        };
        let line = rendering::text(&settings.scene, &state.act);
        assert!(line.contains("Do you want the "), "{line}");
        return;
    }
    panic!("nothing is offered: {:?}", asked(&state));
}
