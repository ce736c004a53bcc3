//! The demo as the page uses it: commands and answers.

#![allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use std::path::Path;

use config::Settings;
use serde_json::{Value, json};
use setup::DialogueSettings;

use demo::{Desk, scenes, settings};

/// A page: its desk, its sections and its clock.
struct Page {
    desk: Desk,
    sections: Value,
    at_ms: f64,
}

impl Page {
    fn open(scene: &str) -> Self {
        let mut page = Self { desk: Desk::default(), sections: json!({}), at_ms: 0.0 };
        page.command(json!({ "do": "open", "scene": scene }));
        page
    }

    /// Returns the error, if there is one.
    fn command(&mut self, command: Value) -> Option<String> {
        let answer: Value = serde_json::from_str(&self.desk.command(&command.to_string())).unwrap();
        for (name, section) in answer["sections"].as_object().into_iter().flatten() {
            self.sections[name] = section.clone();
        }
        answer["error"].as_str().map(str::to_owned)
    }

    fn pass(&mut self, seconds: f64) {
        self.at_ms += 1e3 * seconds;
        assert_eq!(self.command(json!({ "do": "look", "at_ms": self.at_ms })), None);
    }

    fn say(&mut self, text: &str) {
        let seen = &self.sections["dialogue"]["prompt"];
        let command = json!({ "do": "say", "text": text, "seen": seen, "at_ms": self.at_ms });
        assert_eq!(self.command(command), None);
    }

    fn give(&mut self, order: &str) -> Option<String> {
        self.command(json!({ "do": order, "at_ms": self.at_ms }))
    }

    fn until(&mut self, path: &str, value: &Value) {
        for _ in 0..600 {
            if self.sections.pointer(path) == Some(value) {
                return;
            }
            self.pass(0.1);
        }
        panic!("{path} is {:?} and not {value}", self.sections.pointer(path));
    }

    fn at(&self, path: &str) -> &Value {
        self.sections.pointer(path).unwrap_or(&Value::Null)
    }
}

/// The demo cannot read the files, so its numbers are those of the files.
#[test]
fn setup_is_that_of_the_shipped_configuration() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
    for name in scenes::names() {
        let over = [("group.scene".to_owned(), name.to_owned())];
        let shipped = Settings::load(&folder, None, &over).unwrap();
        assert_eq!(
            settings::setup(scenes::scene(name).unwrap()).unwrap(),
            shipped.manager_setup().unwrap()
        );
        assert_eq!(settings::LANGUAGE, shipped.dialogue.language);
        let manager = settings::manager(scenes::scene(name).unwrap()).unwrap();
        assert_eq!(manager.planner(), shipped.dialogue.planner);
    }
    let mut files: Vec<String> = std::fs::read_dir(folder.join("scenes"))
        .unwrap()
        .map(|entry| entry.unwrap().path().file_stem().unwrap().to_str().unwrap().to_owned())
        // Made for another robot than the default one.
        .filter(|name| !name.starts_with("so101"))
        .collect();
    files.sort();
    let mut names: Vec<&str> = scenes::names().collect();
    names.sort_unstable();
    assert_eq!(names, files);
}

#[test]
fn a_request_is_asked_about_answered_and_fetched() {
    let mut page = Page::open("bowls");
    assert_eq!(page.at("/turn/state"), "idle");
    page.say("get me the bowl");
    assert_eq!(page.at("/dialogue/decision"), "ask");
    page.until("/turn/state", &json!("asked"));
    for _ in 0..6 {
        if page.at("/dialogue/decision") != "ask" {
            break;
        }
        let question = page.at("/dialogue/question").clone();
        let has =
            |value: &Value| ["white", "plastic", "small", "counter"].iter().any(|own| value == own);
        let answer = match question["type"].as_str().unwrap() {
            "attr" => if has(&question["value"]) { "yes" } else { "no" }.to_owned(),
            _ => "the small white bowl on the counter".to_owned(),
        };
        page.say(&answer);
        page.pass(2.0);
    }
    assert_eq!(page.at("/dialogue/decision"), "pick");
    assert_eq!(page.at("/arm/object"), "white2");
    page.until("/arm/outcome", &json!("delivered"));
    assert_eq!(page.at("/dialogue/last/object"), "white2");
    assert_eq!(page.at("/dialogue/refusable/object"), "white2");
    assert_eq!(page.at("/world/objects/1"), &Value::Null, "the user has it");
}

#[test]
fn the_word_stop_halts_the_arm_and_a_release_has_to_wait() {
    let mut page = Page::open("bowls");
    page.say("the clear bowl");
    page.until("/arm/phase", &json!("moving"));
    page.pass(0.6);
    page.say("stop");
    page.pass(0.2);
    assert_eq!((page.at("/arm/stopped"), page.at("/arm/moving")), (&json!(true), &json!(false)));
    let gripper = page.at("/world/grippers/0").clone();
    assert!(page.give("resume").unwrap().contains("less than 2 s"));
    page.pass(3.0);
    assert_eq!(page.at("/world/grippers/0"), &gripper, "it stands still");
    assert_eq!(page.give("stop"), None);
    page.pass(1.9);
    assert!(page.give("resume").is_some(), "a stop given again counts");
    page.pass(0.2);
    assert_eq!(page.give("resume"), None);
    page.until("/arm/outcome", &json!("delivered"));
}

#[test]
fn what_is_called_off_goes_back_to_its_place() {
    let mut page = Page::open("bowls");
    let place = page.at("/world/objects/5").clone();
    page.say("the clear bowl");
    page.until("/arm/phase", &json!("holding"));
    page.pass(0.5);
    assert_ne!(page.at("/world/objects/5"), &place);
    page.say("no, not that one");
    page.until("/arm/phase", &json!("returning"));
    page.until("/arm/outcome", &json!("cancelled"));
    assert_eq!(page.at("/world/objects/5"), &place);
}

#[test]
fn what_was_handed_over_is_put_back() {
    let mut page = Page::open("markers");
    page.say("the red marker");
    page.until("/arm/phase", &json!("moving"));
    let object = page.at("/arm/object").clone();
    page.until("/arm/outcome", &json!("delivered"));
    page.pass(1.0);
    page.say("put it back");
    page.until("/arm/task", &json!("put_back"));
    page.until("/arm/outcome", &json!("put_back"));
    assert_eq!(page.at("/arm/object"), &object);
    let all = page.at("/world/objects").as_array().unwrap();
    assert!(all.iter().all(|place| !place.is_null()), "{all:?}");
}

#[test]
fn silence_repeats_the_question_and_then_gives_up() {
    let mut page = Page::open("markers");
    page.say("a marker");
    let prompt = page.at("/dialogue/prompt").clone();
    page.pass(20.0);
    assert_eq!(page.at("/dialogue/prompt"), &prompt);
    assert_eq!(page.at("/speaking/presentation"), 2);
    page.pass(60.0);
    assert_eq!(page.at("/dialogue/last/outcome"), "abandoned");
}

#[test]
fn wrong_commands_are_answered_with_what_is_expected() {
    let mut desk = Desk::default();
    for (command, expected) in [
        ("", "command: EOF"),
        (r#"{"do":"dance"}"#, "unknown variant `dance`"),
        (r#"{"do":"look","at_ms":1}"#, "open a scene first"),
        (r#"{"do":"open","scene":"moon"}"#, "expected one of bowls, blocks, tools, markers"),
        (r#"{"do":"say","text":"a","when":1,"at_ms":1}"#, "unknown field `when`"),
    ] {
        let answer = desk.command(command);
        assert!(answer.contains("error") && answer.contains(expected), "{command}: {answer}");
    }
    desk.command(r#"{"do":"open","scene":"bowls"}"#);
    for at_ms in ["-1", "1e300"] {
        let answer = desk.command(&format!(r#"{{"do":"look","at_ms":{at_ms}}}"#));
        assert!(answer.contains("at_ms: expected"), "{answer}");
    }
}

/// As the page calls it: through the module's memory.
#[test]
#[allow(unsafe_code, reason = "reads and writes at the addresses that the functions return")]
fn functions_take_a_command_and_return_its_answer() {
    use demo::abi::{whichone_command, whichone_input, whichone_output};
    let call = |command: &str| -> Value {
        let (place, bytes) = (whichone_input(command.len()), command.as_bytes());
        // SAFETY: the function has made room for that many bytes, which no other code uses.
        unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr(), place, bytes.len()) };
        let length = whichone_command();
        // SAFETY: the answer has that length and stays until the next command.
        let answer = unsafe { std::slice::from_raw_parts(whichone_output(), length) };
        serde_json::from_slice(answer).unwrap()
    };
    assert_eq!(call(r#"{"do":"scenes"}"#)["scenes"][0], "bowls");
    call(r#"{"do":"open","scene":"markers"}"#);
    let answer = call(r#"{"do":"say","text":"the red one","at_ms":5}"#);
    assert_eq!(answer["sections"]["dialogue"]["decision"], "pick", "{answer}");
    assert!(whichone_input(64 * 1024 + 1).is_null());
    assert!(call(r#"{"do":"look"}"#)["error"].as_str().unwrap().contains("at_ms"));
}

/// The console's views show these sections, so their keys are the console's.
#[test]
fn sections_have_the_keys_of_the_console() {
    let page = Page::open("bowls");
    let golden = |file: &str| -> Value {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/golden");
        serde_json::from_str(&std::fs::read_to_string(folder.join(file)).unwrap()).unwrap()
    };
    let (view, page_sections) = (golden("view.json"), golden("page_sections.json"));
    for (section, known) in [
        ("dialogue", &view["dialogue"]),
        ("arm", &view["arm"]),
        ("scene", &page_sections["scene"]),
        ("world", &page_sections["world"]),
        ("speaking", &page_sections["speaking"]),
        ("turn", &page_sections["turn"]),
    ] {
        for key in page.sections[section].as_object().map(|it| it.keys()).into_iter().flatten() {
            assert!(known.get(key).is_some(), "{section}.{key} is no key of the console's");
        }
    }
}

#[test]
fn any_text_is_answered() {
    let mut page = Page::open("blocks");
    let mut rng = vocabulary::Rng::new(7);
    let words = [
        "red",
        "no",
        "the",
        "block",
        "stop",
        "\u{1F600}",
        "large",
        "put it back",
        "why",
        "yes",
        "",
    ];
    for _ in 0..200 {
        let text: Vec<&str> = (0..rng.below(6)).map(|_| words[rng.below(words.len())]).collect();
        page.say(&text.join(" "));
        page.pass(0.7);
        if rng.below(5) == 0 {
            page.give("resume");
        }
    }
    assert_eq!(page.at("/dialogue/applied"), 200);
}
