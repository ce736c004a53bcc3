//! The seconds of every question and pick in a scene, on this robot.

use scene::{AttributeId, ObjectId, Question, Scene, ValueId};
use vocabulary::Durations;

use crate::{Motions, Pace, Voice};

/// Returns the duration of every single action for the user.
///
/// A question lasts from the decision until its answer is recognised: speaking, then the expected
/// reaction, one word, and the recogniser; a pointing question also the motion of the arm from
/// rest. A pick lasts until its hand-over. Without motions, or without those of pointing, these
/// lists are empty.
pub fn measure(scene: &Scene, voice: &Voice, pace: &Pace, motions: Option<&Motions>) -> Durations {
    let answer_s = pace.mean_answer_s();
    let asked_s = |question| voice.seconds(&scene.phrase(question)) + answer_s;
    let attributes = (0..scene.attributes().len()).map(AttributeId::from);
    let is = |k: AttributeId| {
        let values = 0..scene.attributes()[k.index()].values.len();
        values.map(|v| asked_s(Question::Attribute(k, ValueId::from(v)))).collect()
    };
    let objects = || (0..scene.objects().len()).map(ObjectId::from);
    let aim_s = |object| motions.and_then(|motions| motions.point_s(None, object));
    let point: Option<Vec<f64>> =
        objects().map(|i| Some(aim_s(i)? + asked_s(Question::Point(i)))).collect();
    let pick = motions.map(|motions| objects().map(|i| motions.pick_s(None, i)).collect());
    Durations {
        attribute: attributes.clone().map(is).collect(),
        which: attributes.map(|k| asked_s(Question::Which(k))).collect(),
        point: point.unwrap_or_default(),
        pick: pick.unwrap_or_default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Extent;
    use crate::testing::bowls;
    use manipulation::{PlanSettings, Robot};

    #[test]
    fn questions_take_the_seconds_of_their_words_and_of_the_answer() {
        let scene = bowls();
        let (voice, pace) = (Voice::default(), Pace::default());
        let durations = measure(&scene, &voice, &pace, None);
        assert_eq!(durations.check(&scene), vec![]);
        assert_eq!((durations.point.len(), durations.pick.len()), (0, 0));
        let is_it = |words: &str| voice.seconds(words) + pace.mean_answer_s();
        let all: Vec<f64> = durations.attribute.iter().flatten().copied().collect();
        assert!(all.contains(&is_it("Is it big?")), "{all:?}");
        let longest = all.iter().copied().fold(0.0, f64::max);
        assert_eq!(longest, is_it("Is it in the dishwasher?"));
        let slow = measure(&scene, &Voice { words_per_minute: 80.0 }, &pace, None);
        assert!(slow.which.iter().zip(&durations.which).all(|(slow, usual)| slow > usual));
    }

    #[test]
    fn pointing_and_picking_take_the_seconds_of_their_motions() {
        let scene = bowls();
        let (voice, pace, settings) = (Voice::default(), Pace::default(), PlanSettings::default());
        let motions =
            Motions::plan(Robot::baxter(), &scene, None, &settings, Extent::FromRest).unwrap();
        let durations = measure(&scene, &voice, &pace, Some(&motions));
        for i in (0..6).map(ObjectId::from) {
            assert_eq!(durations.pick_s(i), Some(motions.pick_s(None, i)));
            let said_s = voice.seconds(&scene.phrase(Question::Point(i))) + pace.mean_answer_s();
            let aimed_s = motions.point_s(None, i).unwrap();
            assert_eq!(durations.question_s(Question::Point(i)), Some(aimed_s + said_s));
        }
        assert!(durations.point.iter().any(|s| *s != durations.point[0]), "some stand farther");
    }
}
