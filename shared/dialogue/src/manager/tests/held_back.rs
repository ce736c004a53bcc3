//! "Go on" where nothing is stopped; the motion stop is in `conversations.txt`.

use super::fixture::{first, manager, reply, words};
use scene::{Intent, Reading, Response};

#[test]
fn words_to_go_on_mean_what_they_did_where_nothing_is_stopped() {
    let mut manager = manager();
    let fetching = first(&mut manager, words(&["clear"]));
    for response in [Response::None, Response::Yes, Response::No] {
        let go_on = Reading { intent: Intent::GoOn, response, ..Reading::default() };
        let intent = if response == Response::None { Intent::None } else { Intent::Inform };
        let as_before = reply(&mut manager, &fetching, Reading { intent, ..go_on.clone() });
        let after = reply(&mut manager, &fetching, go_on);
        assert_eq!((after.act, after.open), (as_before.act, as_before.open), "{response:?}");
    }
}
