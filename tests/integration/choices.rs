//! Choices are asked, and answered by value, by order, and by "none of them".

use crate::config::edited;
use serde_json::Value as Json;
use whichone_tests::Group;

const COLOURS: [&str; 6] = ["red", "blue", "green", "black", "white", "yellow"];

/// Mugs of so many colours that no choice names them all.
fn mugs() -> String {
    let object = |(n, colour): (usize, &&str)| {
        let y = 0.13 * n as f64 - 0.33;
        format!(
            "[[objects]]\nname = \"{colour}\"\nattributes = {{ colour = \"{colour}\" }}\n\
             xyz = [0.65, {y:.2}, 0.0]\nsize = [0.08, 0.08, 0.1]\ngrasp_width = 0.004\n\
             form = \"hollow\"\n"
        )
    };
    let objects: String = COLOURS.iter().enumerate().map(object).collect();
    format!(
        "name = \"markers\"\nnoun = \"mug\"\n[[attributes]]\nname = \"colour\"\n\
         ask_yes_no = \"Is it {{value}}?\"\nvalues = {COLOURS:?}\n{objects}"
    )
}

/// Asks for a mug, answers each choice as `answer` says and every other question truthfully, and returns the
/// outcome and the options of the choices.
fn fetch(
    group: &Group,
    wanted: &str,
    answer: impl Fn(&[String]) -> String,
) -> (Json, Vec<Vec<String>>) {
    let mut offered = Vec::new();
    let mut answered = group.dialogue()["prompt"].as_u64().unwrap_or(0);
    let mut says = "get me a mug".to_owned();
    loop {
        let say = || group.say(&says);
        let seen = group.follow_from("a question or a pick", 20.0, say, |state| {
            let dialogue = state["dialogue"].take();
            let is_new = dialogue["prompt"].as_u64()? > answered;
            // What is said before a question has been put does not answer it.
            let is_turn = dialogue["decision"] == "pick" || dialogue["expects_answer"] == true;
            (is_new && is_turn).then_some(dialogue)
        });
        answered = seen["prompt"].as_u64().unwrap();
        if seen["decision"] == "pick" {
            return (group.await_pick(None), offered);
        }
        let question = &seen["question"];
        if question["type"] == "choice" {
            let options: Vec<String> = serde_json::from_value(question["values"].clone()).unwrap();
            let text = seen["text"].as_str().unwrap();
            assert!(text.ends_with("or none of them?") || text.ends_with("or neither?"), "{text}");
            says = answer(&options);
            offered.push(options);
        } else {
            assert_eq!(question["type"], "attr", "{seen}");
            says = if question["value"] == wanted { "yes" } else { "no" }.to_owned();
        }
    }
}

#[test]
fn choices_are_answered_by_value_by_order_and_by_none_of_them() {
    let folder = edited("scenes/markers.toml", |_| mugs());
    let mut group = Group::with_config(folder.path().to_owned());
    let ended = group.start(&["group.scene=markers", "dialogue.choice_questions=true"]);
    assert_eq!(ended.code, Some(0), "{ended:?}\n{}", group.logs());
    let places = ["the first one", "the second one", "the third one", "number four"];
    for (n, wanted) in COLOURS.into_iter().enumerate() {
        let (outcome, offered) = fetch(&group, wanted, |options| {
            match options.iter().position(|option| option == wanted) {
                None => "none of them".to_owned(),
                Some(_) if n % 2 == 0 => format!("the {wanted} one"),
                Some(place) => places[place].to_owned(),
            }
        });
        assert_eq!(
            (&outcome["outcome"], &outcome["object"]),
            (&"delivered".into(), &wanted.into())
        );
        assert!(!offered.is_empty() && offered[0].len() == 4, "{wanted}: {offered:?}");
        let is_offered = offered[0].iter().any(|option| option == wanted);
        assert_eq!(is_offered, n < 4, "the first four of equal probability: {offered:?}");
    }
    group.verify_journals();
    group.down();
}
