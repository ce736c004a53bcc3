//! Words that are certain.

use super::fixture::{first, manager, settings_with, words};
use super::reconfigure::bowls;
use crate::rendering;
use scene::{Doubt, Reading};
use vocabulary::ActKind;

/// A bowl without a place.
const STORED: &str = r#"
[[objects]]
name = "stored"
attributes = { color = "clear", material = "metal", size = "big", shape = "round", location = "cabinet" }
"#;

#[test]
fn an_object_without_a_place_is_named_and_not_promised() {
    let settings = bowls(&[], STORED);
    let mut manager = settings.manager();
    let state = first(&mut manager, words(&["clear", "metal", "big", "cabinet"].repeat(4)));
    let (_, object) = state.act.pick.expect("a pick");
    assert_eq!(settings.scene.object(object).name, "stored");
    let text = rendering::text(&settings.scene, &state.act);
    assert!(text.starts_with("You mean the ") && text.contains("clear"), "{text}");
}

/// A recogniser that is not sure is asked back as ever, and so is everyone in the paper's language.
#[test]
fn words_that_may_have_been_others_ask() {
    let doubted = |doubt: f64| {
        let doubt = Doubt { base: vec![doubt], ..Doubt::default() };
        Reading { doubt, ..words(&["clear"]) }
    };
    assert_eq!(first(&mut manager(), doubted(0.1)).act.kind, ActKind::Ask);
    assert_eq!(first(&mut manager(), doubted(0.005)).act.kind, ActKind::Pick);
    let mut paper = settings_with(|it| it.certain_alpha = None).manager();
    assert_eq!(first(&mut paper, words(&["clear"])).act.kind, ActKind::Ask);
}
