//! The wire layout is a contract with programs of other languages and builds: any change of it must
//! be seen. `WHICHONE_BLESS=1 cargo test -p protocol` writes the golden file anew.

use protocol::robot;
use protocol::schema::{Field, Schema};
use protocol::topics::{self, Topic};
use std::fmt::Write;

const GOLDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/wire_layout.txt");

fn describe<T: Schema>(text: &mut String) {
    let _ = writeln!(text, "{} size {} schema {}", T::NAME, T::size(), T::key());
    for Field { name, ty, offset, size } in T::fields() {
        let _ = writeln!(text, "  {offset:>6} +{size:<6} {name}: {ty}");
    }
    text.push('\n');
}

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

fn layout() -> String {
    let mut text = String::from("# Topics\n\n");
    topics::ALL.iter().for_each(|topic| describe_topic(topic, &mut text));
    topics::robot::ALL.iter().for_each(|topic| describe_topic(topic, &mut text));
    text.push_str("\n# Structs\n\n");
    describe::<protocol::Stamp>(&mut text);
    describe::<protocol::WireQuestion>(&mut text);
    describe::<protocol::WireGesture>(&mut text);
    describe::<protocol::AskedQuestion>(&mut text);
    describe::<protocol::WireHypothesis>(&mut text);
    describe::<protocol::WireReading>(&mut text);
    describe::<protocol::Utterance>(&mut text);
    describe::<protocol::Observation>(&mut text);
    describe::<protocol::AppliedMark>(&mut text);
    describe::<protocol::RobotAct>(&mut text);
    describe::<protocol::Presented>(&mut text);
    describe::<protocol::Activity>(&mut text);
    describe::<protocol::Hearing>(&mut text);
    describe::<protocol::Partial>(&mut text);
    describe::<protocol::AudioChunk>(&mut text);
    describe::<protocol::Receipt>(&mut text);
    describe::<protocol::ArmStatus>(&mut text);
    describe::<protocol::JointStates>(&mut text);
    describe::<protocol::MotionCommand>(&mut text);
    describe::<robot::JointCommand>(&mut text);
    describe::<robot::JointState>(&mut text);
    describe::<robot::JointTrajectoryPoint>(&mut text);
    describe::<robot::SpeedRatio>(&mut text);
    describe::<robot::EndpointState>(&mut text);
    describe::<robot::EndEffectorCommand>(&mut text);
    describe::<robot::EndEffectorState>(&mut text);
    describe::<robot::EndEffectorProperties>(&mut text);
    describe::<robot::AssemblyState>(&mut text);
    describe::<robot::Drill>(&mut text);
    text.push_str("# Encoded payloads\n\n");
    describe::<protocol::Injection>(&mut text);
    describe::<protocol::PolicyView>(&mut text);
    describe::<protocol::WorldView>(&mut text);
    describe::<protocol::TrajectoryView>(&mut text);
    text
}

#[test]
fn the_wire_layout_is_the_golden_one() {
    let layout = layout();
    if std::env::var_os("WHICHONE_BLESS").is_some() {
        std::fs::write(GOLDEN, &layout).unwrap();
    }
    let golden = std::fs::read_to_string(GOLDEN).unwrap_or_default();
    assert_eq!(layout, golden, "the wire layout has changed; see the head of this file");
}

fn assert_without_padding<T: Schema>() {
    let end = T::fields().iter().fold(0, |end, field| {
        assert_eq!(field.offset, end, "{}: a gap before {}", T::NAME, field.name);
        end + field.size
    });
    assert_eq!(end, T::size(), "{}: a gap at its end", T::NAME);
}

#[test]
fn no_struct_has_padding() {
    assert_without_padding::<protocol::Stamp>();
    assert_without_padding::<protocol::WireQuestion>();
    assert_without_padding::<protocol::WireGesture>();
    assert_without_padding::<protocol::AskedQuestion>();
    assert_without_padding::<protocol::WireHypothesis>();
    assert_without_padding::<protocol::WireReading>();
    assert_without_padding::<protocol::Utterance>();
    assert_without_padding::<protocol::Observation>();
    assert_without_padding::<protocol::AppliedMark>();
    assert_without_padding::<protocol::RobotAct>();
    assert_without_padding::<protocol::Presented>();
    assert_without_padding::<protocol::Activity>();
    assert_without_padding::<protocol::Hearing>();
    assert_without_padding::<protocol::Partial>();
    assert_without_padding::<protocol::AudioChunk>();
    assert_without_padding::<protocol::Receipt>();
    assert_without_padding::<protocol::ArmStatus>();
    assert_without_padding::<protocol::JointStates>();
    assert_without_padding::<protocol::MotionCommand>();
    assert_without_padding::<robot::JointCommand>();
    assert_without_padding::<robot::JointState>();
    assert_without_padding::<robot::JointTrajectoryPoint>();
    assert_without_padding::<robot::SpeedRatio>();
    assert_without_padding::<robot::EndpointState>();
    assert_without_padding::<robot::EndEffectorCommand>();
    assert_without_padding::<robot::EndEffectorState>();
    assert_without_padding::<robot::EndEffectorProperties>();
    assert_without_padding::<robot::AssemblyState>();
    assert_without_padding::<robot::Drill>();
}

#[test]
fn topics_have_names_of_their_own_and_bounds_that_hold() {
    let all: Vec<&Topic> = topics::ALL.iter().chain(&topics::robot::ALL).collect();
    for (i, topic) in all.iter().enumerate() {
        assert!(all[i + 1..].iter().all(|other| other.name != topic.name));
        assert!(topic.history <= topic.buffer, "{}: history would not fit", topic.name);
        assert_eq!(topic.writer.is_none(), topic.writers_max > 1, "{}: one writer", topic.name);
    }
}
