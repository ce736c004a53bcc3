use scene::{Doubt, Options, ValueId};
use vocabulary::{Params, Reliability, Rng};

use super::*;
use crate::testing::random_scene;

/// Expected errors given the object, compared with the sum over all possible perceptions of the
/// person, and over right and slip of every word and answer.
#[test]
fn expected_errors_are_those_of_all_that_may_have_been() {
    let seed = 5;
    let mut rng = Rng::new(seed);
    for case in 0..40 {
        let scene = random_scene(&mut rng, 5, &[3, 2, 4], 3);
        let params = Params {
            epsilon: 0.04,
            open: Some(Reliability { p_l: 0.9, epsilon: 0.08 }),
            choice: Some(Reliability { p_l: 0.9, epsilon: 0.05 }),
            ..Params::default()
        };
        let rate = if case % 4 == 0 { 0.0 } else { 0.03 };
        let rates = vec![rate; scene.attributes().len()];
        let model =
            Model::new(&scene, params).with_certain_words(0.002).with_misperceptions(&rates);
        let object = ObjectId::from(rng.below(model.objects()));
        let heard: Vec<_> = (0..6).map(|_| random_reading(&mut rng, &model)).collect();
        let utterances = heard.iter().map(std::slice::from_ref);
        let lesson = Lesson::new(&model, object, utterances);
        let expected = by_hand(&model, object, rate, &heard);
        let close = |a: &Count, b: &Count| {
            (a.wrong - b.wrong).abs() < 1e-9 && (a.right - b.right).abs() < 1e-9
        };
        let all = lesson.channels.iter().zip(&expected.channels);
        for (got, expected) in all.chain(lesson.attributes.iter().zip(&expected.attributes)) {
            assert!(close(got, expected), "seed {seed}, case {case}: {got:?}, {expected:?}");
        }
    }
}

/// A word, a denial, or an answer to a question of any kind.
fn random_reading(rng: &mut Rng, model: &Model) -> (f64, Question, Reading) {
    let k = AttributeId::from(rng.below(model.attributes()));
    let v = ValueId::from(rng.below(model.values(k)));
    let own = || vec![model.word(k, v)];
    let response = [Response::Yes, Response::No][rng.below(2)];
    let (question, reading) = match rng.below(6) {
        0 => (Question::None, Reading { base: own(), ..Reading::default() }),
        1 => (Question::None, Reading { excluded: vec![own()], ..Reading::default() }),
        2 => (Question::Which(k), Reading { base: own(), ..Reading::default() }),
        3 => {
            let options = Options::new(&[ValueId(0), ValueId(1)]).unwrap();
            let names = options.contains(v);
            let reading = if names {
                Reading { base: own(), ..Reading::default() }
            } else {
                Reading { response: Response::No, ..Reading::default() }
            };
            (Question::Choice(k, options), reading)
        }
        4 => {
            let asked = ObjectId::from(rng.below(model.objects()));
            (Question::Point(asked), Reading { response, ..Reading::default() })
        }
        _ => (Question::Attribute(k, v), Reading { response, ..Reading::default() }),
    };
    (1.0, question, reading)
}

/// One thing said: its channel, and the likelihood with and without a slip if attribute `k` is
/// taken for `m`; `None` if the truth is unknown.
fn chances(
    model: &Model,
    object: ObjectId,
    (_, question, reading): &(f64, Question, Reading),
    taken: &[Option<usize>],
) -> Option<(Channel, [f64; 2])> {
    let params = model.params().of(*question);
    let truth = |is_true: bool, others: f64| {
        if is_true { [1.0 - params.epsilon, 0.0] } else { [0.0, params.epsilon / others] }
    };
    let about = |k: AttributeId| taken[k.index()];
    let word = |word: WordId| model.meanings(word)[0];
    match (*question, reading.response) {
        (Question::Point(asked), response) => {
            let is_true = (asked == object) == (response == Response::Yes);
            Some((Channel::YesNo, truth(is_true, 1.0)))
        }
        (Question::Attribute(k, v), response) => {
            let is_true = (about(k) == Some(v.index())) == (response == Response::Yes);
            Some((Channel::YesNo, truth(is_true, 1.0)))
        }
        (Question::Which(k), _) => {
            let others = model.values(k) as f64 - 1.0;
            let (_, v) = word(reading.base[0]);
            match about(k) {
                Some(m) => Some((Channel::Open, truth(m == v.index(), others))),
                None => {
                    let each = 1.0 / (others + 1.0);
                    Some((Channel::Open, [each * (1.0 - params.epsilon), each * params.epsilon]))
                }
            }
        }
        (Question::Choice(k, options), response) => {
            let law = Naming::of(model, *question).unwrap();
            if law.answers < 2 || response == Response::No && !law.neither {
                return None;
            }
            let named = reading.base.first().map(|named| word(*named).1);
            let is_option = about(k).is_some_and(|m| options.contains(ValueId::from(m)));
            let is_true = match named {
                Some(v) => about(k) == Some(v.index()),
                None => !is_option,
            };
            Some((Channel::Choice, truth(is_true, law.answers as f64 - 1.0)))
        }
        (Question::None, _) if !reading.excluded.is_empty() => {
            let (k, v) = word(reading.excluded[0][0]);
            Some((Channel::YesNo, truth(about(k) != Some(v.index()), 1.0)))
        }
        (Question::None, _) => {
            let (k, v) = word(reading.base[0]);
            let own = f64::from(u8::from(about(k) == Some(v.index())));
            Some((Channel::Words, [own, model.smoothing(true)]))
        }
    }
}

fn by_hand(
    model: &Model,
    object: ObjectId,
    rate: f64,
    heard: &[(f64, Question, Reading)],
) -> Lesson {
    let own: Vec<Option<usize>> = (0..model.attributes())
        .map(|k| model.value(object, k.into()).map(ValueId::index))
        .collect();
    let sizes: Vec<usize> = (0..model.attributes()).map(|k| model.values(k.into())).collect();
    let mut sum = 0.0;
    let mut lesson =
        Lesson { attributes: vec![Count::default(); sizes.len()], ..Lesson::default() };
    let mut spoken_of = vec![false; sizes.len()];
    for (_, question, reading) in heard {
        let words = reading.base.iter().chain(reading.excluded.iter().flatten());
        let of_words = words.map(|word| model.meanings(*word)[0].0);
        let counts = |question: Question| {
            Naming::of(model, question)
                .is_none_or(|law| law.answers > 1 && (law.neither || !reading.base.is_empty()))
        };
        let asked = question.attribute().filter(|_| reading.response != Response::None);
        for k in of_words.chain(asked).filter(|_| counts(*question)) {
            spoken_of[k.index()] = true;
        }
    }
    let worlds: usize = sizes.iter().product();
    for mut world in 0..worlds {
        let mut prior = 1.0;
        let taken: Vec<Option<usize>> = (sizes.iter().zip(&own))
            .map(|(size, own)| {
                let m = world % size;
                world /= size;
                prior *= match own {
                    None => 1.0 / *size as f64,
                    Some(_) if *size < 2 => 1.0,
                    Some(own) if *own == m => 1.0 - rate,
                    Some(_) => rate / (*size - 1) as f64,
                };
                own.map(|_| m)
            })
            .collect();
        let said: Vec<_> =
            heard.iter().filter_map(|one| chances(model, object, one, &taken)).collect();
        for slips in 0..1_usize << said.len() {
            let has_slipped = |j: usize| slips >> j & 1;
            let each = said.iter().enumerate().map(|(j, (_, both))| both[has_slipped(j)]);
            let p = prior * each.product::<f64>();
            sum += p;
            for (j, (channel, _)) in said.iter().enumerate() {
                lesson.channels[*channel as usize].see(p, has_slipped(j) as f64);
            }
            for k in 0..sizes.len() {
                if rate > 0.0 && sizes[k] > 1 && spoken_of[k] && own[k].is_some() {
                    let wrong = f64::from(u8::from(taken[k] != own[k]));
                    lesson.attributes[k].see(p, wrong);
                }
            }
        }
    }
    for count in lesson.channels.iter_mut().chain(&mut lesson.attributes) {
        (count.wrong, count.right) = (count.wrong / sum, count.right / sum);
    }
    lesson
}

/// Uncertain observations teach less.
#[test]
fn doubts_count_less() {
    let mut rng = Rng::new(3);
    let scene = random_scene(&mut rng, 4, &[2, 3], 2);
    let model = Model::new(&scene, Params::default());
    let (object, k) = (ObjectId(0), AttributeId(0));
    let v = ValueId::from(0);
    let question = Question::Attribute(k, v);
    let wrong = if model.has(object, k, v) { Response::No } else { Response::Yes };
    let lesson = |doubt: f64| {
        let doubt = Doubt { response: doubt, ..Doubt::default() };
        let heard = [(1.0, question, Reading { response: wrong, doubt, ..Reading::default() })];
        Lesson::new(&model, object, [&heard[..]].into_iter()).channels[Channel::YesNo as usize]
    };
    assert_eq!(lesson(0.0), Count { wrong: 1.0, right: 0.0 });
    let doubtful = lesson(0.5);
    assert!(doubtful.wrong < 0.05 && (doubtful.all() - 0.5).abs() < 1e-12, "{doubtful:?}");
    assert!(lesson(1.0).all() == 0.0);
}
