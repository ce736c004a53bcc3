//! The wire layout is a contract with programs of other languages and builds: any change of it must
//! be seen. `WHICHONE_BLESS=1 cargo test -p messages` rewrites the golden file.

use layouts::{Layout, payloads, structs};
use messages::schema::Field;
use messages::topics::{self, Topic};
use messages::*;
use std::fmt::Write;

mod layouts;

const GOLDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/wire_layout.txt");

fn describe_topic(topic: &Topic, text: &mut String) {
    let writer = topic.writer.map_or("clients", |service| service.name());
    let readers: Vec<&str> = topic.readers.iter().map(|service| service.name()).collect();
    let _ = writeln!(
        text,
        "{} {} from {writer} (at most {}) waking [{}] buffer {} history {}",
        topic.name,
        topic.payload,
        topic.writers_max,
        readers.join(" "),
        topic.buffer,
        topic.history
    );
}

fn describe(layout: &Layout, text: &mut String) {
    let Layout { name, size, key, fields, .. } = layout;
    let _ = writeln!(text, "{name} size {size} schema {key}");
    for Field { name, ty, offset, size, .. } in fields {
        let _ = writeln!(text, "  {offset:>6} +{size:<6} {name}: {ty}");
    }
    text.push('\n');
}

/// The codes of every enum in the structs, by the type of its field.
fn codes(structs: &[Layout]) -> Vec<String> {
    let fields = structs.iter().flat_map(|layout| &layout.fields);
    let coded = fields.filter(|field| field.ty.starts_with("Code<"));
    let mut codes: Vec<String> =
        coded.map(|field| format!("{}: {}\n", field.ty, field.detail.trim_end())).collect();
    codes.sort();
    codes.dedup();
    codes
}

fn golden_text() -> String {
    let mut text = String::from("# Topics\n\n");
    let topics = topics::ALL.iter().chain(&topics::robot::ALL);
    topics.for_each(|topic| describe_topic(topic, &mut text));
    text.push_str("\n# Structs\n\n");
    structs().iter().for_each(|layout| describe(layout, &mut text));
    text.push_str("# Codes\n\n");
    text.extend(codes(&structs()));
    text.push_str("\n# Postcard payloads\n\n");
    payloads().iter().for_each(|layout| describe(layout, &mut text));
    text
}

#[test]
fn wire_layout_matches_the_golden_file() {
    let text = golden_text();
    if std::env::var_os("WHICHONE_BLESS").is_some() {
        std::fs::write(GOLDEN, &text).unwrap();
    }
    let golden = std::fs::read_to_string(GOLDEN).unwrap_or_default();
    assert_eq!(text, golden, "the wire layout has changed; see the head of this file");
}

/// The keys of payloads are derived from their types, so that no edit of a type goes unnoticed.
#[test]
fn payload_schemas_hold_every_type_and_variant() {
    let fields: Vec<Field> = payloads().into_iter().flat_map(|layout| layout.fields).collect();
    let ty = |name: &str| {
        let field = fields.iter().find(|field| field.name == name);
        field.unwrap_or_else(|| panic!("no type {name} in the payloads")).ty.as_ref()
    };
    assert!(ty("Injection").contains(r#"{"sound":{"TYPENAME":"Sound"}}"#), "{}", ty("Injection"));
    for variant in ["Text", "Wav", "Point", "Talk", "Transcript", "target_m", "longest_s"] {
        assert!(ty("Sound").contains(variant), "{variant}");
    }
    for variant in ["delivered", "failed", "cancelled", "abandoned", "scene_changed", "not_here"] {
        assert!(ty("Outcome").contains(variant), "{variant}");
    }
    assert!(fields.iter().all(|field| field.name != "error"), "{fields:?}");
}

#[test]
fn messages_with_invalid_codes_are_rejected_wherever_the_code_is() {
    let act = RobotAct { kind: Code::from_raw(9), ..RobotAct::default() };
    assert_eq!(act.check(), Err(WireError::new("ActKind", 9)));
    let mut observation = Observation::default();
    assert_eq!(observation.check(), Ok(()));
    observation.readings[READINGS_MAX - 1].intent = Code::from_raw(200);
    assert_eq!(observation.check(), Err(WireError::new("Intent", 200)));
}

#[test]
fn topics_have_unique_names_and_consistent_bounds() {
    let all: Vec<&Topic> = topics::ALL.iter().chain(&topics::robot::ALL).collect();
    for (i, topic) in all.iter().enumerate() {
        assert!(all[i + 1..].iter().all(|other| other.name != topic.name));
        assert!(topic.history <= topic.buffer, "{}: history would not fit", topic.name);
        assert_eq!(topic.writer.is_none(), topic.writers_max > 1, "{}: one writer", topic.name);
    }
}
