//! "Not that" and "start over" with one click: what has to be said for it in each situation.
//!
//! Pure. Whatever is done is said in words that a person could say too, so that it stands in the
//! transcript and in the journal, and does nothing that a dialogue could not.

use protocol::PolicyView;
use scene::Question;

/// Answers a question.
const NO: &str = "no";
/// Denies what the robot fetches.
const NOT_THAT: &str = "no, not that one";
/// Withdraws a request.
const NEVER_MIND: &str = "never mind";
/// Forgets what was said.
const START_OVER: &str = "start over";

/// What denies what the robot asks about, or is fetching.
///
/// # Errors
/// There is nothing to be denied.
pub(super) fn not_that(view: Option<&PolicyView>) -> Result<&'static str, String> {
    let view = view.filter(|view| view.interaction != 0).ok_or(NOTHING)?;
    match (view.decision.as_str(), view.question) {
        ("pick", _) => Ok(NOT_THAT),
        ("ask", Question::Attribute(..) | Question::Point(_)) => Ok(NO),
        ("ask", _) => Err("this question is not answered by yes or no; say which it is".to_owned()),
        _ => Err(NOTHING.to_owned()),
    }
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
    use scene::{AttributeId, ObjectId, ValueId};

    fn view(decision: &str, question: Question) -> PolicyView {
        let decision = decision.to_owned();
        PolicyView { interaction: 3, decision, question, ..PolicyView::default() }
    }

    #[test]
    fn a_question_about_one_thing_is_answered_with_no() {
        let value = Question::Attribute(AttributeId::from(0), ValueId::from(0));
        for question in [value, Question::Point(ObjectId::from(1))] {
            assert_eq!(not_that(Some(&view("ask", question))).unwrap(), "no");
        }
        let open = Question::Which(AttributeId::from(0));
        assert!(not_that(Some(&view("ask", open))).is_err());
    }

    #[test]
    fn what_is_fetched_is_denied_and_starting_over_withdraws_it() {
        let picks = view("pick", Question::None);
        assert_eq!(not_that(Some(&picks)).unwrap(), "no, not that one");
        assert_eq!(start_over(Some(&picks)).unwrap(), "never mind");
        let asks = view("ask", Question::Point(ObjectId::from(0)));
        assert_eq!(start_over(Some(&asks)).unwrap(), "start over");
    }

    #[test]
    fn without_a_request_there_is_nothing_to_correct() {
        let idle = PolicyView { interaction: 0, ..view("wait", Question::None) };
        assert!(not_that(Some(&idle)).is_err() && start_over(Some(&idle)).is_err());
        assert!(not_that(None).is_err() && start_over(None).is_err());
    }
}
