//! "Not that" and "start over" with one click: what has to be said for it in each situation.
//!
//! Pure. Whatever is done is said in words that a person could say too, so that it stands in the
//! transcript and in the journal, and does nothing that a dialogue could not.

use messages::WireCode;
use messages::{ArmStatus, PickPhase, PolicyView};
use scene::{ObjectId, Question, Scene};

/// Answers a question.
const NO: &str = "no";
/// Withdraws a request.
const NEVER_MIND: &str = "never mind";
/// Forgets what was said.
const START_OVER: &str = "start over";

/// What denies what the robot asks about, or is fetching. That is named: it is meant whether the
/// robot has told already what it fetches or is about to.
///
/// # Errors
/// There is nothing to be denied.
pub(super) fn not_that(
    scene: &Scene,
    view: Option<&PolicyView>,
    arm: Option<&ArmStatus>,
) -> Result<String, String> {
    let view = view.filter(|view| view.interaction != 0).ok_or(NOTHING)?;
    match (view.decision.as_str(), view.question) {
        ("pick", _) => {
            let object = ObjectId::from(fetched(view, arm));
            let is_known = view.scene_key == scene.key() && object.index() < scene.objects().len();
            is_known
                .then(|| format!("no, not the {}", scene.describe(object)))
                .ok_or(NOTHING.into())
        }
        ("ask", Question::Attribute(..) | Question::Point(_)) => Ok(NO.to_owned()),
        ("ask", _) => Err("this question is not answered by yes or no; say which it is".to_owned()),
        _ => Err(NOTHING.to_owned()),
    }
}

/// The object of the pick under way: the arm's, or where the order may not have reached it, the
/// likeliest one.
fn fetched(view: &PolicyView, arm: Option<&ArmStatus>) -> usize {
    let over = [PickPhase::Idle.code(), PickPhase::Done.code()];
    let arm = arm.filter(|arm| arm.interaction == view.interaction && !over.contains(&arm.phase));
    let likelier = |a: &usize, b: &usize| view.belief[*a].total_cmp(&view.belief[*b]);
    let likeliest = || (0..view.belief.len()).max_by(likelier).unwrap_or(usize::MAX);
    arm.map_or_else(likeliest, |arm| arm.object as usize)
}

const NOTHING: &str = "the robot asks nothing and fetches nothing that could be meant";

/// What makes the robot forget what it was told.
///
/// # Errors
/// There is nothing to forget.
pub(super) fn start_over(view: Option<&PolicyView>) -> Result<&'static str, String> {
    let view = view.filter(|view| view.interaction != 0);
    let view = view.ok_or("nothing was asked for yet; just say what you want")?;
    // A pick is not forgotten but withdrawn.
    let fetches = matches!(view.decision.as_str(), "pick" | "cancel");
    Ok(if fetches { NEVER_MIND } else { START_OVER })
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::{AttributeId, ValueId};

    const BOWLS: &str = include_str!("../../../../config/scenes/bowls.toml");

    fn scene() -> Scene {
        Scene::from_toml("bowls.toml", BOWLS).unwrap()
    }

    fn view(scene: &Scene, decision: &str, question: Question) -> PolicyView {
        PolicyView {
            interaction: 3,
            decision: decision.to_owned(),
            question,
            scene_key: scene.key(),
            belief: vec![0.1, 0.6, 0.3],
            ..PolicyView::default()
        }
    }

    #[test]
    fn a_question_about_one_thing_is_answered_with_no() {
        let scene = scene();
        let value = Question::Attribute(AttributeId::from(0), ValueId::from(0));
        for question in [value, Question::Point(ObjectId::from(1))] {
            assert_eq!(not_that(&scene, Some(&view(&scene, "ask", question)), None).unwrap(), "no");
        }
        let open = Question::Which(AttributeId::from(0));
        assert!(not_that(&scene, Some(&view(&scene, "ask", open)), None).is_err());
    }

    #[test]
    fn what_is_fetched_is_denied_by_its_name() {
        let scene = scene();
        let picks = view(&scene, "pick", Question::None);
        let said = not_that(&scene, Some(&picks), None).unwrap();
        assert_eq!(said, "no, not the white bowl on the counter");
        let arm = ArmStatus {
            interaction: 3,
            object: 5,
            phase: PickPhase::Moving.code(),
            ..ArmStatus::default()
        };
        assert_eq!(not_that(&scene, Some(&picks), Some(&arm)).unwrap(), "no, not the clear bowl");
        let elsewhere = PolicyView { scene_key: 0, ..picks };
        assert!(not_that(&scene, Some(&elsewhere), Some(&arm)).is_err());
    }

    #[test]
    fn without_a_request_there_is_nothing_to_correct() {
        let scene = scene();
        let idle = PolicyView { interaction: 0, ..view(&scene, "wait", Question::None) };
        assert!(not_that(&scene, Some(&idle), None).is_err() && start_over(Some(&idle)).is_err());
        assert!(not_that(&scene, None, None).is_err() && start_over(None).is_err());
        let asks = view(&scene, "ask", Question::Point(ObjectId::from(0)));
        assert_eq!(start_over(Some(&asks)).unwrap(), "start over");
        let picks = view(&scene, "pick", Question::None);
        assert_eq!(start_over(Some(&picks)).unwrap(), "never mind");
    }
}
