//! The wire layout is a contract with programs of other languages and builds: any change of it must
//! be seen. `WHICHONE_BLESS=1 cargo test -p protocol` writes the golden file anew.

use messages::robot;
use messages::schema::{Field, Schema};
use messages::topics::{self, Topic};
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
    describe::<messages::Stamp>(&mut text);
    describe::<messages::WireQuestion>(&mut text);
    describe::<messages::WireGesture>(&mut text);
    describe::<messages::AskedQuestion>(&mut text);
    describe::<messages::WireHypothesis>(&mut text);
    describe::<messages::WireReading>(&mut text);
    describe::<messages::Utterance>(&mut text);
    describe::<messages::Observation>(&mut text);
    describe::<messages::AppliedMark>(&mut text);
    describe::<messages::RobotAct>(&mut text);
    describe::<messages::Presented>(&mut text);
    describe::<messages::Activity>(&mut text);
    describe::<messages::Hearing>(&mut text);
    describe::<messages::Partial>(&mut text);
    describe::<messages::AudioChunk>(&mut text);
    describe::<messages::Receipt>(&mut text);
    describe::<messages::ArmStatus>(&mut text);
    describe::<messages::JointStates>(&mut text);
    describe::<messages::MotionCommand>(&mut text);
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
    describe::<messages::Injection>(&mut text);
    describe::<messages::PolicyView>(&mut text);
    describe::<messages::WorldView>(&mut text);
    describe::<messages::TrajectoryView>(&mut text);
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
    assert_without_padding::<messages::Stamp>();
    assert_without_padding::<messages::WireQuestion>();
    assert_without_padding::<messages::WireGesture>();
    assert_without_padding::<messages::AskedQuestion>();
    assert_without_padding::<messages::WireHypothesis>();
    assert_without_padding::<messages::WireReading>();
    assert_without_padding::<messages::Utterance>();
    assert_without_padding::<messages::Observation>();
    assert_without_padding::<messages::AppliedMark>();
    assert_without_padding::<messages::RobotAct>();
    assert_without_padding::<messages::Presented>();
    assert_without_padding::<messages::Activity>();
    assert_without_padding::<messages::Hearing>();
    assert_without_padding::<messages::Partial>();
    assert_without_padding::<messages::AudioChunk>();
    assert_without_padding::<messages::Receipt>();
    assert_without_padding::<messages::ArmStatus>();
    assert_without_padding::<messages::JointStates>();
    assert_without_padding::<messages::MotionCommand>();
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
