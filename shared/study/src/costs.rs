//! Durations as costs: what the decision problem's seconds are on this robot, in this scene.

use dialogue::{Actions, Costs, Mode, Model};
use scene::{Question, Scene};

use crate::{Motions, Pace, Voice};

/// `base` with the costs of the questions in seconds of the robot's own voice and arm.
///
/// A question costs what passes from deciding on it to its answer recognised: the mean over the
/// scene's questions of that kind of saying it, then reacting, one word, and the recogniser; a
/// pointing question also the way of the arm there from rest, without which it keeps `base`'s cost.
/// What a pick is worth and waiting costs stays.
pub fn measured_costs(
    scene: &Scene,
    model: &Model,
    voice: &Voice,
    pace: &Pace,
    motions: Option<&Motions>,
    base: Costs,
) -> Costs {
    let said = |question: Question| voice.seconds(&scene.phrase(question));
    let all = Actions { mode: Mode::Present, attribute: true, which: true }.questions(model);
    let answer_s = pace.mean_answer_s();
    let mean = |seconds: Vec<f64>| {
        (!seconds.is_empty()).then(|| seconds.iter().sum::<f64>() / seconds.len() as f64 + answer_s)
    };
    let of = |wanted: fn(&Question) -> bool| {
        mean(all.iter().copied().filter(wanted).map(said).collect())
    };
    let point = motions.and_then(|motions| {
        let aims = (0..model.objects()).filter_map(|i| {
            let aim_s = motions.point_s(None, i.into())?;
            Some(aim_s + said(Question::Point(i.into())))
        });
        mean(aims.collect())
    });
    Costs {
        attribute_s: of(|q| matches!(q, Question::Attribute(..))).unwrap_or(base.attribute_s),
        which_s: of(|q| matches!(q, Question::Which(_))).unwrap_or(base.which_s),
        point_s: point.unwrap_or(base.point_s),
        ..base
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::bowls;
    use dialogue::Params;

    #[test]
    fn questions_cost_their_seconds() {
        let scene = bowls();
        let model = Model::new(&scene, Params::default());
        let (voice, pace) = (Voice::default(), Pace::default());
        let base = Costs::SECONDS;
        let costs = measured_costs(&scene, &model, &voice, &pace, None, base);
        assert!(costs.check().is_empty());
        let shortest = voice.seconds("Is it big?") + pace.mean_answer_s();
        let longest = voice.seconds("Is it in the dishwasher?") + pace.mean_answer_s();
        assert!(shortest < costs.attribute_s && costs.attribute_s < longest, "{costs:?}");
        assert_eq!((costs.point_s, costs.wait_s), (base.point_s, base.wait_s));
        assert_eq!((costs.correct, costs.discount), (base.correct, base.discount));
        let slow =
            measured_costs(&scene, &model, &Voice { words_per_minute: 80.0 }, &pace, None, base);
        assert!(slow.attribute_s > costs.attribute_s && slow.which_s > costs.which_s);
    }
}
