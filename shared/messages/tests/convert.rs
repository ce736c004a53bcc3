//! Wire round trips are lossless, and invalid data is rejected.

use messages::{
    ASKED_MAX, AskedQuestion, BASE_WORDS_MAX, Code, EXCLUDED_GROUPS_MAX, EXCLUDED_WORDS_MAX,
    FURTHER_MAX, Fits, Hypothesis, Interpretation, Observation, Utterance, WireQuestion,
    WireReading,
};
use proptest::prelude::*;
use scene::{
    AttributeId, Doubt, Intent, Measure, ObjectId, Options, Question, Reading, Reference, Relation,
    Response, ValueId, WordId,
};

const WORDS: usize = 40;

fn words(max: usize) -> impl Strategy<Value = Vec<WordId>> {
    prop::collection::vec((0..WORDS as u16).prop_map(WordId), 0..=max)
}

/// Doubts as they are on the wire.
fn doubts(max: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec((1..=8_u8).prop_map(|eighths| f64::from(eighths) / 8.0), 0..=max)
}

prop_compose! {
    fn readings()(
        base_doubt in doubts(BASE_WORDS_MAX),
        excluded_doubt in doubts(EXCLUDED_GROUPS_MAX),
        response_doubt in 0..=8_u8,
        base in words(BASE_WORDS_MAX),
        excluded in prop::collection::vec(words(EXCLUDED_WORDS_MAX), 0..=EXCLUDED_GROUPS_MAX),
        response in prop::sample::select(vec![
            Response::Yes, Response::No, Response::None, Response::CannotTell,
            Response::DoesNotMatter,
        ]),
        intent in prop::sample::select(vec![
            Intent::Inform, Intent::None, Intent::Stop, Intent::Cancel, Intent::Repeat,
            Intent::StartOver, Intent::AskBack, Intent::AskCount, Intent::PutBack, Intent::StopAndCancel,
            Intent::GoOn,
        ]),
        refers in prop::sample::select(vec![Reference::None, Reference::Other, Reference::Relation(Relation::Beside),
            Reference::Relation(Relation::Nth(Measure::Right, 3))]),
        further in prop::collection::vec(words(EXCLUDED_WORDS_MAX), 0..=FURTHER_MAX),
    ) -> Reading {
        let first = |doubts: Vec<f64>, len: usize| doubts.into_iter().take(len).collect();
        let doubt = Doubt {
            base: first(base_doubt, base.len()),
            excluded: first(excluded_doubt, excluded.len()),
            response: f64::from(response_doubt) / 8.0,
        };
        Reading { base, response, excluded, intent, refers, further, doubt }
    }
}

proptest! {
    #[test]
    fn a_reading_survives_the_wire(
        reading in readings(), weight in 0.0..=1.0, question in prop::option::of(0..ASKED_MAX),
    ) {
        let interpretation = Interpretation { weight, answers: question, reading };
        let (wire, fits) = WireReading::new(&interpretation);
        prop_assert_eq!(fits, Fits::Whole);
        prop_assert_eq!(wire.interpretation(WORDS, ASKED_MAX), Ok(interpretation));
    }

    #[test]
    fn any_bytes_are_read_or_refused_but_never_trusted(
        counts in any::<[u8; 2]>(), codes in any::<[u8; 3]>(), lens in any::<[u8; 8]>(),
        word in any::<u16>(), doubt in any::<f32>(),
    ) {
        let mut wire = WireReading { excluded_len: lens, ..WireReading::default() };
        (wire.base_count, wire.excluded_count) = (counts[0], counts[1]);
        wire.response = Code::from_raw(codes[0]);
        wire.intent = Code::from_raw(codes[1]);
        wire.question = codes[2];
        (wire.base[0], wire.base_doubt[0]) = (word, doubt);
        if let Ok(Interpretation { answers, reading, .. }) = wire.interpretation(WORDS, 3) {
            prop_assert!(reading.base.iter().all(|w| w.index() < WORDS));
            prop_assert!(answers.is_none_or(|place| place < 3));
            prop_assert!((0.0..=1.0 + 1e-6).contains(&reading.doubt.of_word(0)));
        }
    }

    #[test]
    fn hypotheses_survive_the_wire(
        texts in prop::collection::vec("\\PC{0,40}", 1..=5),
        codes in prop::collection::vec(0..=254_u8, 0..=9),
    ) {
        let confidence: Vec<f32> = codes.iter().map(|code| f32::from(*code) / 255.0).collect();
        let heard: Vec<Hypothesis> = texts
            .iter()
            .map(|text| Hypothesis { weight: 2.0, word_confidence: confidence.clone(), ..Hypothesis::certain(text) })
            .collect();
        let mut utterance = Utterance::default();
        utterance.set_hypotheses(&heard).unwrap();
        let read = utterance.hypotheses().unwrap();
        prop_assert_eq!(read.len(), texts.len());
        for (read, expected) in read.iter().zip(&texts) {
            prop_assert_eq!(&read.text, expected);
            prop_assert_eq!(&read.word_confidence, &confidence);
            prop_assert!((read.weight - 1.0 / texts.len() as f64).abs() < 1e-12);
        }
    }

    #[test]
    fn questions_asked_survive_the_wire(count in 0..=2 * ASKED_MAX, claimed in any::<u8>()) {
        let asked: Vec<AskedQuestion> = (0..count as u64)
            .map(|n| AskedQuestion { prompt: n + 1, ..AskedQuestion::default() })
            .collect();
        let mut utterance = Utterance::default();
        utterance.set_asked(&asked);
        prop_assert_eq!(utterance.asked(), Ok(&asked[..count.min(ASKED_MAX)]));
        utterance.asked_count = claimed;
        prop_assert_eq!(utterance.asked().is_ok(), usize::from(claimed) <= ASKED_MAX);
    }

    #[test]
    fn any_span_is_read_or_refused(start in any::<u32>(), len in any::<u32>(), count in any::<u8>()) {
        let mut utterance = Utterance::default();
        utterance.set_hypotheses(&[Hypothesis::certain("größe")]).unwrap();
        (utterance.hypotheses[0].start, utterance.hypotheses[0].len) = (start, len);
        utterance.hypothesis_count = count;
        let _ = utterance.hypotheses();
    }

    #[test]
    fn questions_survive_the_wire(i in any::<u16>(), k in any::<u16>(), v in any::<u16>()) {
        for question in [
            Question::None,
            Question::Point(ObjectId(i)),
            Question::Attribute(AttributeId(k), ValueId(v)),
            Question::Which(AttributeId(k)),
            Question::Choice(AttributeId(k), Options::new(&[v % 252, v % 252 + 1, v % 252 + 2].map(ValueId)).unwrap()),
        ] {
            prop_assert_eq!(Question::try_from(WireQuestion::from(question)), Ok(question));
        }
        let unknown = WireQuestion { kind: 5, ..WireQuestion::default() };
        prop_assert!(Question::try_from(unknown).is_err());
    }
}

fn certainly(reading: Reading) -> Interpretation {
    Interpretation { weight: 1.0, answers: None, reading }
}

#[test]
fn conversion_truncates_and_reports_oversized_content() {
    let reading = Reading { base: vec![WordId(1); BASE_WORDS_MAX + 1], ..Reading::default() };
    let (wire, fits) = WireReading::new(&certainly(reading));
    assert_eq!(fits, Fits::Cut);
    assert_eq!(wire.interpretation(WORDS, 0).unwrap().reading.base.len(), BASE_WORDS_MAX);
}

#[test]
fn observation_without_readings_is_rejected() {
    assert!(Observation::default().interpretations(WORDS).is_err());
}

#[test]
fn observation_with_invalid_probabilities_is_rejected() {
    for wrong in [f64::NAN, -0.1, 1.5, f64::INFINITY] {
        let mut heavy = certainly(Reading::default());
        heavy.weight = wrong;
        let doubt = Doubt { response: wrong, ..Doubt::default() };
        let doubtful = certainly(Reading { doubt, ..Reading::default() });
        for interpretation in [heavy, doubtful] {
            let (wire, _) = WireReading::new(&interpretation);
            assert!(wire.interpretation(WORDS, 0).is_err(), "{wrong}");
        }
    }
}
