//! What goes onto the wire comes off it unchanged, and what makes no sense is refused.

use proptest::prelude::*;
use protocol::{
    BASE_WORDS_MAX, EXCLUDED_GROUPS_MAX, EXCLUDED_WORDS_MAX, Fits, Observation, Utterance,
    WireQuestion, WireReading,
};
use scene::{AttributeId, Intent, ObjectId, Question, Reading, Response, ValueId, WordId};

const WORDS: usize = 40;

fn words(max: usize) -> impl Strategy<Value = Vec<WordId>> {
    prop::collection::vec((0..WORDS as u16).prop_map(WordId), 0..=max)
}

prop_compose! {
    fn readings()(
        base in words(BASE_WORDS_MAX),
        excluded in prop::collection::vec(words(EXCLUDED_WORDS_MAX), 0..=EXCLUDED_GROUPS_MAX),
        response in prop::sample::select(vec![Response::Yes, Response::No, Response::None]),
        intent in prop::sample::select(vec![
            Intent::Inform, Intent::None, Intent::Stop, Intent::Cancel, Intent::Repeat,
            Intent::StartOver, Intent::AskBack,
        ]),
    ) -> Reading {
        Reading { base, response, excluded, intent }
    }
}

proptest! {
    #[test]
    fn a_reading_survives_the_wire(reading in readings(), weight in 0.0..=1.0) {
        let (wire, fits) = WireReading::new(&reading, weight);
        prop_assert_eq!(fits, Fits::Whole);
        prop_assert_eq!(wire.reading(WORDS), Ok((weight, reading)));
    }

    #[test]
    fn any_bytes_are_read_or_refused_but_never_trusted(
        counts in any::<[u8; 2]>(), codes in any::<[u8; 2]>(), lens in any::<[u8; 8]>(),
        word in any::<u16>(),
    ) {
        let mut wire = WireReading { excluded_len: lens, ..WireReading::default() };
        (wire.base_count, wire.excluded_count) = (counts[0], counts[1]);
        (wire.response, wire.intent) = (codes[0], codes[1]);
        wire.base[0] = word;
        if let Ok((_, reading)) = wire.reading(WORDS) {
            prop_assert!(reading.base.iter().all(|w| w.index() < WORDS));
        }
    }

    #[test]
    fn hypotheses_survive_the_wire(texts in prop::collection::vec("\\PC{0,40}", 1..=5)) {
        let weighted: Vec<(String, f64)> =
            texts.iter().map(|text| (text.clone(), 2.0)).collect();
        let mut utterance = Utterance::default();
        utterance.set_hypotheses(&weighted).unwrap();
        let read: Vec<(&str, f64)> = utterance.hypotheses().unwrap();
        prop_assert_eq!(read.len(), texts.len());
        for ((text, weight), expected) in read.iter().zip(&texts) {
            prop_assert_eq!(*text, expected.as_str());
            prop_assert!((weight - 1.0 / texts.len() as f64).abs() < 1e-12);
        }
    }

    #[test]
    fn any_span_is_read_or_refused(start in any::<u32>(), len in any::<u32>(), count in any::<u8>()) {
        let mut utterance = Utterance::default();
        utterance.set_hypotheses(&[("größe".to_owned(), 1.0)]).unwrap();
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
        ] {
            prop_assert_eq!(Question::try_from(WireQuestion::from(question)), Ok(question));
        }
        let unknown = WireQuestion { kind: 4, ..WireQuestion::default() };
        prop_assert!(Question::try_from(unknown).is_err());
    }
}

#[test]
fn what_does_not_fit_is_cut_and_told() {
    let reading = Reading { base: vec![WordId(1); BASE_WORDS_MAX + 1], ..Reading::default() };
    let (wire, fits) = WireReading::new(&reading, 1.0);
    assert_eq!(fits, Fits::Cut);
    assert_eq!(wire.reading(WORDS).unwrap().1.base.len(), BASE_WORDS_MAX);
}

#[test]
fn an_observation_without_readings_is_refused() {
    assert!(Observation::default().readings(WORDS).is_err());
}

#[test]
fn weights_that_are_no_probabilities_are_refused() {
    for weight in [f64::NAN, -0.1, 1.5, f64::INFINITY] {
        let (wire, _) = WireReading::new(&Reading::default(), weight);
        assert!(wire.reading(WORDS).is_err(), "{weight}");
    }
}
