//! "Any", in several readings; the rest is in `conversations.txt`.

use super::fixture::{at, manager, text, typed, words};
use crate::manager::Cause;
use scene::{Reading, Response};
use vocabulary::ids::PromptId;
use vocabulary::{ActKind, Interpretation};

/// "The white one or the clear one, I don't mind."
#[test]
fn readings_that_concede_the_same_concede_it_together() {
    let mut manager = manager();
    let mut said = typed(1, PromptId(0), Reading::default());
    let any = |word| Reading { response: Response::DoesNotMatter, ..words(&[word]) };
    let as_likely = |word| Interpretation { weight: 0.5, answers: None, reading: any(word) };
    said.interpretations = ["white", "clear"].map(as_likely).to_vec();
    let state = manager.next(&manager.first(), &Cause::Utterance(said), at(1));
    assert_eq!(state.act.kind, ActKind::Pick, "{}", text(&state));
}
