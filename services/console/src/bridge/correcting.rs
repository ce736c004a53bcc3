//! "Not that" and "start over" with one click: what has to be said for it in each situation.
//!
//! Pure. Whatever is done is said in words that a person could say too, so that it stands in the
//! transcript and in the journal, and does nothing that a dialogue could not.

use protocol::{ArmStatus, Outcome, PickPhase, PolicyView};
use scene::{ObjectId, Question, Scene};

/// What to say now, and what to say once the pick under way has been given up.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Correction {
    pub(super) now: &'static str,
    pub(super) then: Option<Then>,
}

/// Words for the time after an interaction was withdrawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Then {
    /// The interaction that has to end first.
    pub(super) interaction: u64,
    pub(super) words: String,
}

/// Answers a question.
const NO: &str = "no";
/// Withdraws a request.
const NEVER_MIND: &str = "never mind";
/// Forgets what was said.
const START_OVER: &str = "start over";

/// What denies what the robot asks about, or is about to fetch.
///
/// # Errors
/// There is nothing to be denied.
pub(super) fn not_that(
    scene: &Scene,
    view: Option<&PolicyView>,
    arm: Option<&ArmStatus>,
) -> Result<Correction, String> {
    let view = view.filter(|view| view.interaction != 0).ok_or(NOTHING)?;
    if let Some(object) = fetched(view, arm) {
        let object = ObjectId::from(object);
        let known = object.index() < scene.objects().len() && view.scene_key == scene.key();
        let words =
            known.then(|| format!("another {}, not the {}", scene.noun(), scene.describe(object)));
        let then = words.map(|words| Then { interaction: view.interaction, words });
        return Ok(Correction { now: NEVER_MIND, then });
    }
    match (view.decision.as_str(), view.question) {
        ("ask", Question::Attribute(..) | Question::Point(_)) => {
            Ok(Correction { now: NO, then: None })
        }
        ("ask", _) => Err("this question is not answered by yes or no; say which it is".to_owned()),
        _ => Err(NOTHING.to_owned()),
    }
}

const NOTHING: &str = "the robot asks nothing and fetches nothing that could be meant";

/// What makes the robot forget what it was told.
///
/// # Errors
/// There is nothing to forget.
pub(super) fn start_over(view: Option<&PolicyView>) -> Result<Correction, String> {
    let view = view.filter(|view| view.interaction != 0);
    let view = view.ok_or("nothing was asked for yet; just say what you want")?;
    // A pick is not forgotten but withdrawn.
    let fetches = matches!(view.decision.as_str(), "pick" | "cancel");
    Ok(Correction { now: if fetches { NEVER_MIND } else { START_OVER }, then: None })
}

/// The object of the pick under way.
fn fetched(view: &PolicyView, arm: Option<&ArmStatus>) -> Option<usize> {
    if view.decision != "pick" {
        return None;
    }
    let over = [PickPhase::Idle.code(), PickPhase::Done.code()];
    let arm = arm.filter(|arm| arm.interaction == view.interaction && !over.contains(&arm.phase));
    // The order may not have reached the arm: the likeliest object is the one that is fetched.
    let likeliest =
        || (0..view.belief.len()).max_by(|a, b| view.belief[*a].total_cmp(&view.belief[*b]));
    arm.map(|arm| arm.object as usize).or_else(likeliest)
}

impl Then {
    /// Whether it is time for the words: some, once the interaction was withdrawn; none where it
    /// ended otherwise. Nothing while it goes on.
    pub(super) fn due(&self, view: &PolicyView) -> Option<Option<String>> {
        let ended = view.last.as_ref().filter(|last| last.interaction >= self.interaction)?;
        let withdrawn =
            ended.interaction == self.interaction && ended.outcome == Outcome::Cancelled;
        Some(withdrawn.then(|| self.words.clone()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::Ended;
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
            let said = not_that(&scene, Some(&view(&scene, "ask", question)), None).unwrap();
            assert_eq!(said, Correction { now: "no", then: None });
        }
        let open = Question::Which(AttributeId::from(0));
        assert!(not_that(&scene, Some(&view(&scene, "ask", open)), None).is_err());
    }

    #[test]
    fn a_pick_is_withdrawn_and_another_object_asked_for() {
        let scene = scene();
        let picks = view(&scene, "pick", Question::None);
        let said = not_that(&scene, Some(&picks), None).unwrap();
        let then = said.then.unwrap();
        assert_eq!(
            (said.now, then.words.as_str()),
            ("never mind", "another bowl, not the white bowl on the counter")
        );
        let arm = ArmStatus {
            interaction: 3,
            object: 5,
            phase: PickPhase::Moving.code(),
            ..ArmStatus::default()
        };
        let said = not_that(&scene, Some(&picks), Some(&arm)).unwrap();
        assert_eq!(said.then.unwrap().words, "another bowl, not the clear bowl");
        assert_eq!(then.due(&picks), None);
        let ended = |outcome| PolicyView {
            interaction: 0,
            last: Some(Ended {
                interaction: 3,
                object: Some(1),
                name: None,
                outcome,
                questions: 0,
                seconds: 1.0,
                utterances: (1, 2),
            }),
            ..picks.clone()
        };
        assert_eq!(then.due(&ended(Outcome::Cancelled)), Some(Some(then.words.clone())));
        assert_eq!(then.due(&ended(Outcome::Delivered)), Some(None));
    }

    #[test]
    fn without_a_request_there_is_nothing_to_correct() {
        let scene = scene();
        let idle = PolicyView { interaction: 0, ..view(&scene, "wait", Question::None) };
        assert!(not_that(&scene, Some(&idle), None).is_err() && start_over(Some(&idle)).is_err());
        assert!(not_that(&scene, None, None).is_err() && start_over(None).is_err());
        let asks = view(&scene, "ask", Question::Point(ObjectId::from(0)));
        assert_eq!(start_over(Some(&asks)).unwrap().now, "start over");
        let picks = view(&scene, "pick", Question::None);
        assert_eq!(start_over(Some(&picks)).unwrap().now, "never mind");
    }
}
