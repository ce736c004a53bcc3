//! The speech service's journal records for programs.

use config::Settings;
use service::journal_record::{AcceptedRecord, PresentationRecord, SpeechRecord};
use service::view::QuestionView;
use vocabulary::Presentation;

use crate::record::{Accepted, Record};

/// Translates a record; questions of an unknown scene are left out.
pub(crate) fn explain(settings: &[Settings], record: &Record) -> SpeechRecord {
    match record {
        Record::Accepted(accepted) => SpeechRecord::Accepted(accepted_record(settings, accepted)),
        Record::Presented(put) => SpeechRecord::Presented(presentation(settings, put)),
        Record::StopOrdered(given) => SpeechRecord::StopOrdered { given_ns: given.ns() },
        Record::StopSettled(given) => SpeechRecord::StopSettled { given_ns: given.ns() },
    }
}

fn accepted_record(settings: &[Settings], accepted: &Accepted) -> AcceptedRecord {
    let best = accepted.hypotheses.first();
    let total: f64 = accepted.hypotheses.iter().map(|one| one.weight).sum();
    AcceptedRecord {
        utterance: accepted.seq.0,
        text: best.map(|best| best.text.clone()).unwrap_or_default(),
        confidence: best.map_or(1.0, |best| best.weight / total),
        hypotheses: accepted.hypotheses.clone(),
        source: accepted.origin.source,
        from: Some(accepted.origin.from.to_string()).filter(|from| !from.is_empty()),
        gesture_m: accepted.gesture,
        asked: accepted.asked.iter().map(|put| presentation(settings, put)).collect(),
        onset_ns: accepted.onset.ns(),
        end_ns: accepted.end.ns(),
        snr_db: Some(accepted.snr_db).filter(|snr_db| *snr_db != 0.0),
        segment: accepted.segment.0,
        segments: accepted.segment.1,
        key: accepted.key.0.iter().map(|byte| format!("{byte:02x}")).collect(),
    }
}

fn presentation(settings: &[Settings], put: &Presentation) -> PresentationRecord {
    let mut scenes = settings.iter().map(|settings| &settings.scene);
    let scene = scenes.find(|scene| scene.key() == put.scene);
    PresentationRecord {
        prompt: put.prompt.0,
        presentation: put.number,
        question: scene.and_then(|scene| QuestionView::new(scene, put.question)),
        began_ns: put.began.ns(),
        ended_ns: put.ended.map(|ended| ended.ns()),
        complete: put.complete,
    }
}

#[cfg(test)]
mod tests {
    use messages::{Hypothesis, PromptId, RequestKey, Service, Source, UtteranceSeq};
    use scene::{AttributeId, Question, ValueId};
    use service::Time;
    use service::journal_record::{JournalRecord, golden};

    use super::*;
    use crate::inspection;
    use crate::record::Origin;
    use vocabulary::PersonId;

    fn settings() -> Settings {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config");
        Settings::load(folder.as_ref(), None, &[]).unwrap()
    }

    fn records(scene: u64) -> Vec<Record> {
        let second = 1_000_000_000;
        let typed = Accepted {
            seq: UtteranceSeq(1),
            key: RequestKey([0xab; 16]),
            segment: (0, 1),
            hypotheses: vec![Hypothesis::certain("get me the white bowl")],
            gesture: None,
            origin: Source::Text.into(),
            asked: Vec::new(),
            onset: Time(second),
            end: Time(second),
            snr_db: 0.0,
            accepted: Time(second),
        };
        let put = Presentation {
            prompt: PromptId(1),
            number: 1,
            question: Question::Attribute(AttributeId(0), ValueId(0)),
            scene,
            began: Time(2 * second),
            ended: Some(Time(3 * second)),
            complete: true,
        };
        let word = |text: &str, weight| Hypothesis {
            text: text.to_owned(),
            weight,
            word_confidence: vec![0.5],
        };
        let spoken = Accepted {
            seq: UtteranceSeq(2),
            hypotheses: vec![word("yes", 3.0), word("yet", 1.0)],
            origin: Source::Microphone.into(),
            asked: vec![put],
            onset: Time(3 * second + second / 2),
            end: Time(4 * second),
            snr_db: 18.5,
            accepted: Time(4 * second),
            ..typed.clone()
        };
        let pointed = Accepted {
            seq: UtteranceSeq(3),
            hypotheses: Vec::new(),
            origin: Origin { source: Source::Gesture, from: PersonId::new("Ann").unwrap() },
            gesture: Some([0.5, 0.25, 0.0]),
            ..typed.clone()
        };
        let cut_short = Presentation { prompt: PromptId(2), complete: false, ..put };
        vec![
            Record::Accepted(typed),
            Record::Presented(put),
            Record::Accepted(spoken),
            Record::Presented(cut_short),
            Record::Accepted(pointed),
            Record::StopOrdered(Time(5 * second)),
            Record::StopSettled(Time(5 * second)),
        ]
    }

    /// Records are read by programs. `WHICHONE_BLESS=1` rewrites the golden file.
    #[test]
    fn records_for_programs_match_the_golden_file() {
        let settings = [settings()];
        let described = |record: Record| {
            let explained = JournalRecord::Speech(Box::new(explain(&settings, &record)));
            (inspection::recorded_at(&record), inspection::line(&record), explained)
        };
        let found = golden::lines(records(settings[0].scene.key()).into_iter().map(described));
        golden::check(Service::Speech, &found);
    }

    #[test]
    fn question_of_an_unknown_scene_is_left_out() {
        let explained = explain(&[], &records(7)[1]);
        assert!(matches!(explained, SpeechRecord::Presented(put) if put.question.is_none()));
    }
}
