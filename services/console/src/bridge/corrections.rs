//! "Not that" and "start over" with one click: the utterances behind them.
//!
//! Pure. Both become words that a user could say too, so that they are in the transcript and in the
//! journal, and do nothing that a dialogue could not.

use messages::{ActKind, ArmStatus, PickPhase, PolicyView};
use scene::{ObjectId, Question, Scene};
use service::view::Latest;

/// Answers a question.
const NO: &str = "no";
/// Withdraws a request.
const NEVER_MIND: &str = "never mind";
/// Words that make the robot forget the request.
const START_OVER: &str = "start over";

/// Returns the words that deny the object in question or being fetched. A fetched object is named,
/// so that it is denied before the robot has announced it, too.
pub(super) fn not_that(scene: &Scene, latest: &Latest) -> Result<String, String> {
    let view = open(latest).ok_or(NOTHING)?;
    match (view.decision, view.question) {
        (ActKind::Pick, _) => {
            let object = ObjectId::from(fetched(view, latest.arm.as_ref()));
            let is_known = view.scene_key == scene.key() && object.index() < scene.objects().len();
            is_known
                .then(|| format!("no, not {}", scene::definite(&scene.describe(object))))
                .ok_or(NOTHING.into())
        }
        (ActKind::Ask, Question::Attribute(..) | Question::Point(_) | Question::Choice(..)) => {
            Ok(NO.to_owned())
        }
        (ActKind::Ask, _) => {
            Err("this is not a yes/no question; help: say which one it is".to_owned())
        }
        _ => Err(NOTHING.to_owned()),
    }
}

fn open(latest: &Latest) -> Option<&PolicyView> {
    latest.view.as_ref().filter(|view| view.interaction != 0)
}

/// Returns the object of the pick under way: the arm's, or the most likely one if the order may not
/// have reached the arm.
fn fetched(view: &PolicyView, arm: Option<&ArmStatus>) -> usize {
    let over = [PickPhase::Idle, PickPhase::Done];
    let arm =
        arm.filter(|arm| arm.interaction == view.interaction && !over.contains(&arm.phase.get()));
    let by_belief = |a: &usize, b: &usize| view.belief[*a].total_cmp(&view.belief[*b]);
    let likeliest = || (0..view.belief.len()).max_by(by_belief).unwrap_or(usize::MAX);
    arm.map_or_else(likeliest, |arm| arm.object as usize)
}

const NOTHING: &str = "the robot neither asks about an object nor fetches one";

/// Returns the words that make the robot forget the request, or withdraw a pick.
pub(super) fn start_over(latest: &Latest) -> Result<&'static str, String> {
    let view = open(latest).ok_or("no request is open; help: say what you want")?;
    let fetches = matches!(view.decision, ActKind::Pick | ActKind::Cancel);
    Ok(if fetches { NEVER_MIND } else { START_OVER })
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::{AttributeId, Options, ValueId};

    const BOWLS: &str = include_str!("../../../../config/scenes/bowls.toml");

    fn scene() -> Scene {
        Scene::from_toml("bowls.toml", BOWLS).unwrap()
    }

    fn latest(decision: ActKind, question: Question) -> Latest {
        let view = PolicyView {
            interaction: 3,
            decision,
            question,
            scene_key: scene().key(),
            belief: vec![0.1, 0.6, 0.3],
            ..PolicyView::default()
        };
        Latest { view: Some(view), ..Latest::default() }
    }

    fn with(latest: &Latest, change: impl FnMut(&mut PolicyView)) -> Latest {
        let mut latest = latest.clone();
        latest.view.as_mut().into_iter().for_each(change);
        latest
    }

    #[test]
    fn corrections_deny_the_question_or_the_fetched_object() {
        let value = Question::Attribute(AttributeId::from(0), ValueId::from(0));
        let options = Options::new(&[0, 1].map(ValueId)).unwrap();
        let choice = Question::Choice(AttributeId::from(0), options);
        let (picks, idle) = (latest(ActKind::Pick, Question::None), Latest::default());
        let moves = PickPhase::Moving.into();
        let arm = ArmStatus { interaction: 3, object: 5, phase: moves, ..ArmStatus::default() };
        let fetches = Latest { arm: Some(arm), ..picks.clone() };
        for (latest, expected) in [
            (latest(ActKind::Ask, value), Some("no")),
            (latest(ActKind::Ask, Question::Point(ObjectId::from(1))), Some("no")),
            (latest(ActKind::Ask, choice), Some("no")),
            (latest(ActKind::Ask, Question::Which(AttributeId::from(0))), None),
            (picks, Some("no, not the white bowl on the counter")),
            (fetches.clone(), Some("no, not the clear bowl")),
            (with(&fetches, |view| view.scene_key = 0), None),
            (with(&fetches, |view| view.interaction = 0), None),
            (idle, None),
        ] {
            assert_eq!(not_that(&scene(), &latest).ok().as_deref(), expected, "{latest:?}");
        }
    }

    #[test]
    fn corrections_start_over_or_withdraw_a_pick() {
        let asks = latest(ActKind::Ask, Question::Point(ObjectId::from(0)));
        assert_eq!(start_over(&asks).unwrap(), "start over");
        assert_eq!(start_over(&latest(ActKind::Pick, Question::None)).unwrap(), "never mind");
        assert!(start_over(&with(&asks, |view| view.interaction = 0)).is_err());
        assert!(start_over(&Latest::default()).is_err());
    }
}
