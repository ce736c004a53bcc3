//! Wordings of choices.

use serde_json::json;

use super::{BOWLS, TOOLS, shipped};
use crate::{Scene, question_from_json};

#[test]
fn choices_are_worded_for_every_kind_of_value() {
    let (bowls, tools) = (shipped(BOWLS), shipped(TOOLS));
    let say = |scene: &Scene, k: &str, values: &[&str]| -> Vec<String> {
        let json = json!({"type": "choice", "attribute": k, "values": values});
        let question = question_from_json(scene, &json).expect("a question");
        (0..3).map(|n| scene.phrase_variant(question, n, 1, &[])).collect()
    };
    let colours = "white, metallic or clear?";
    assert_eq!(
        say(&bowls, "color", &["clear", "white", "metallic"]),
        [
            "White, metallic or clear?".to_owned(),
            format!("What colour is it: {colours}"),
            format!("Is it {colours}")
        ],
    );
    let places = "in the dishwasher, on the counter or neither?";
    assert_eq!(
        say(&bowls, "location", &["dishwasher", "counter"]),
        [format!("I{}", &places[1..]), format!("Where is it: {places}"), format!("Is it {places}")],
    );
    let kinds = "a marker, a pen, a wrench or none of them?";
    assert_eq!(
        say(&tools, "kind", &["marker", "pen", "wrench"]),
        [
            format!("A{}", &kinds[1..]),
            format!("What kind of tool is it: {kinds}"),
            format!("Is it {kinds}")
        ],
    );
    // "Is it small or big?" lists the values itself.
    let sizes = ["Small or big?", "Is it small or big?", "Small or big?"];
    assert_eq!(say(&bowls, "size", &["small", "big"]), sizes);
}
