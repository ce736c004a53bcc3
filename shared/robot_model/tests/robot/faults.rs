//! Diagnostics of invalid descriptions: `invalid.txt` holds each text and what it leads to.
//! `UPDATE_EXPECT=1 cargo test -p robot_model` rewrites the latter.

use diagnostics::TextFile;
use expect_test::expect_file;
use robot_model::Robot;

/// A robot for the SRDFs.
const TWO_LINKS: &str = r#"<robot name="arm"><link name="a"/><link name="b"/>
    <joint name="j" type="revolute"><parent link="a"/><child link="b"/>
    <limit lower="-1" upper="1" velocity="1" effort="1"/></joint></robot>"#;

#[test]
fn invalid_descriptions_get_every_diagnostic_with_line_and_help() {
    let mut found = String::new();
    for case in include_str!("invalid.txt").split("--- ").skip(1) {
        let (head, rest) = case.split_once('\n').unwrap();
        let text = rest.split_once("\n+++\n").unwrap().0;
        let file = |kind: &str, text| TextFile::new(format!("arm.{kind}"), text);
        let read = match head.split_once(':').unwrap().0 {
            "srdf" => Robot::read(&file("urdf", TWO_LINKS), Some(&file("srdf", text))),
            kind => Robot::read(&file(kind, text), None),
        };
        found += &format!("--- {head}\n{text}\n+++\n{}\n", read.unwrap_err());
    }
    expect_file!["invalid.txt"].assert_eq(&found);
}
