//! What a bad description is told.

use robot_model::{Document, Robot};

fn urdf(text: &str) -> String {
    Robot::parse(text, None).unwrap_err().in_files("arm.urdf", "arm.srdf")
}

/// A robot of two links and one joint, with an SRDF.
fn srdf(text: &str) -> String {
    let urdf = r#"<robot name="arm"><link name="a"/><link name="b"/>
        <joint name="j" type="revolute"><parent link="a"/><child link="b"/>
        <limit lower="-1" upper="1" velocity="1" effort="1"/></joint></robot>"#;
    Robot::parse(urdf, Some(text)).unwrap_err().in_files("arm.urdf", "arm.srdf")
}

#[test]
fn every_fault_of_a_file_is_told_at_once() {
    let text = r#"<robot name="arm">
  <material name="red"><color rgba="1 0 0 2"/></material>
  <link name="a">
    <visual><geometry><sphere radius="0"/></geometry><material name="rde"/></visual>
    <collision><origin xyz="0 0"/><geometry><cone radius="1"/></geometry></collision>
    <collision/>
    <inertial><mass value="-1"/></inertial>
  </link>
  <link/>
  <link name="b"><collision><geometry><box/></geometry></collision></link>
  <joint name="j1" type="revolute">
    <parent link="a"/><child link="b"/>
    <axis xyz="0 0 0"/>
  </joint>
  <joint name="j2" type="revolvute">
    <parent/>
    <origin rpy="0 zero 0"/>
  </joint>
  <joint name="j3" type="prismatic">
    <parent link="a"/><child link="c"/>
    <limit lower="2" upper="1" velocity="inf" jerk="0"/>
    <mimic joint="j9" multiplier="NaN"/>
  </joint>
  <joint type="floating"><parent link="a"/><child link="b"/></joint>
  <joint name="j4" type="continuous">
    <parent link="b"/><child link="a"/><limit velocity="1" effort="-2"/>
  </joint>
  <joint name="j5" type="revolute">
    <parent link="b"/><child link="b"/><limit velocity="1" effort="1"/>
  </joint>
</robot>"#;
    assert_eq!(
        urdf(text),
        r#"arm.urdf:2: material "red": <color> has rgba="1 0 0 2"; each of its numbers must be 0 to 1
arm.urdf:4: link "a": <material> "rde" is not defined; did you mean "red"?
arm.urdf:4: link "a": <sphere> has radius="0"; it must be more than 0
arm.urdf:5: link "a": <origin> has xyz="0 0"; write 3 finite numbers with spaces between them
arm.urdf:5: link "a": <geometry> has the unknown shape <cone>; use <box>, <cylinder>, <capsule>, <sphere> or <mesh>
arm.urdf:6: link "a": it has no <geometry>; write what the <collision> is, e.g. <geometry><sphere radius="…"/></geometry>
arm.urdf:7: link "a": <mass> has value="-1"; it must be 0 or more
arm.urdf:7: link "a": it has no <inertia>; write <inertia ixx=… ixy=… ixz=… iyy=… iyz=… izz=…/>
arm.urdf:9: link: it has no name; write name="…"
arm.urdf:10: link "b": <box> has no size; write size="x y z" in metres
arm.urdf:11: joint "j1": it is revolute and has no <limit>; write <limit lower="…" upper="…" velocity="…" effort="…"/>
arm.urdf:13: joint "j1": <axis> has xyz="0 0 0"; write a vector of length 1
arm.urdf:15: joint "j2": its type "revolvute" is unknown; did you mean "revolute"?
arm.urdf:15: joint "j2": it has no <child>; write <child link="…"/>
arm.urdf:16: joint "j2": <parent> has no link; write link="…"
arm.urdf:17: joint "j2": <origin> has rpy="0 zero 0"; write 3 finite numbers with spaces between them
arm.urdf:19: joint "j3": its child "c" is not a link; describe <link name="c"/>, or correct the name
arm.urdf:19: joint "j3": it mimics "j9", which is not a joint; name a joint that moves by itself
arm.urdf:21: joint "j3": <limit> has lower=2 above upper=1; exchange them
arm.urdf:21: joint "j3": <limit> has velocity="inf"; write one finite number
arm.urdf:21: joint "j3": <limit> has no effort; write effort="a number"
arm.urdf:21: joint "j3": <limit> has jerk="0"; it must be more than 0
arm.urdf:22: joint "j3": <mimic> has multiplier="NaN"; write one finite number
arm.urdf:24: joint: it has no name; write name="…"
arm.urdf:24: joint: its type floating is not supported; write type="fixed", "revolute", "continuous" or "prismatic"
arm.urdf:24: joint: its child "b" already hangs on joint "j1"; a link has one parent: remove one joint
arm.urdf:26: joint "j4": <limit> has effort="-2"; it must be 0 or more
arm.urdf:28: joint "j5": its child "b" already hangs on joint; a link has one parent: remove one joint
arm.urdf:29: joint "j5": <limit> has neither lower nor upper; write both, or make the joint continuous or fixed"#
    );
}

#[test]
fn slips_of_the_fingers_are_recognised() {
    let text = r#"<robot name="arm">
  <link name="base"/>
  <link name="upper_arm"><colision/><sensor/></link>
  <joint name="shoulder" type="revolute">
    <orgin xyz="0 0 1"/>
    <parent link="bse"/><child link="upperarm"/>
    <axis xzy="0 0 1" verbose="yes"/>
    <limit lower="-1" uper="1" velocity="1" effort="1"/>
    <mimic joint="elbw"/>
  </joint>
  <joint name="elbow" type="fixed"><parent link="base"/><child link="hand"/></joint>
</robot>"#;
    assert_eq!(
        urdf(text),
        r#"arm.urdf:3: link "upper_arm": <link> has <colision>; did you mean <collision>?
arm.urdf:4: joint "shoulder": its parent "bse" is not a link; did you mean "base"?
arm.urdf:4: joint "shoulder": its child "upperarm" is not a link; did you mean "upper_arm"?
arm.urdf:4: joint "shoulder": it mimics "elbw", which is not a joint; did you mean "elbow"?
arm.urdf:5: joint "shoulder": <joint> has <orgin>; did you mean <origin>?
arm.urdf:7: joint "shoulder": <axis> has xzy; did you mean xyz?
arm.urdf:7: joint "shoulder": <axis> has no xyz; write xyz="x y z"
arm.urdf:8: joint "shoulder": <limit> has uper; did you mean upper?
arm.urdf:11: joint "elbow": its child "hand" is not a link; describe <link name="hand"/>, or correct the name"#
    );
    assert_eq!(
        srdf(
            "<robot name=\"arm\"><group_state name=\"x\" group=\"g\"><joint name=\"J\" value=\"0\"/></group_state></robot>"
        ),
        r#"arm.srdf:1: group_state "x": the robot has no joint "J"; did you mean "j"?"#
    );
}

#[test]
fn a_file_that_is_no_description_is_told_so() {
    for (text, expected) in [
        (
            "",
            r#"arm.urdf:1: document: it is not well-formed XML: the document does not have a root node; correct the markup there"#,
        ),
        (
            "no xml",
            r#"arm.urdf:1: document: it is not well-formed XML: unknown token at 1:1; correct the markup there"#,
        ),
        (
            "<robot name=\"arm\">\n<link name=\"a\">\n</robot>",
            r#"arm.urdf:3: document: it is not well-formed XML: expected 'link' tag, not 'robot' at 3:1; correct the markup there"#,
        ),
        (
            "<sdf/>",
            r#"arm.urdf:1: document: it begins with <sdf>; its first element must be <robot name="…">"#,
        ),
        (
            "<robot/>",
            r#"arm.urdf:1: robot: it has no name; write name="…"
arm.urdf:1: robot: it has no <link>; describe its links and joints"#,
        ),
        (
            "<robot name=\"arm\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n<xacro:arm/></robot>",
            r#"arm.urdf:2: robot: it still contains xacro macros; expand them first: xacro FILE.urdf.xacro > FILE.urdf"#,
        ),
    ] {
        assert_eq!(urdf(text), expected, "{text}");
    }
}

#[test]
fn links_must_form_one_tree() {
    let links = r#"<robot name="arm"><link name="a"/><link name="b"/><link name="c"/>"#;
    let joint = |name: &str, parent: &str, child: &str| {
        format!(
            "\n<joint name=\"{name}\" type=\"fixed\"><parent link=\"{parent}\"/>\
             <child link=\"{child}\"/></joint>"
        )
    };
    let robot = |joints: &[(&str, &str, &str)]| -> String {
        let joints: String = joints.iter().map(|(n, p, c)| joint(n, p, c)).collect();
        format!("{links}{joints}</robot>")
    };
    for (joints, expected) in [
        (
            &[("j", "a", "b")][..],
            r#"arm.urdf:1: link "c": nothing carries it, as nothing carries "a"; a robot has one root: join this link to another with a <joint>"#,
        ),
        (
            &[("j", "a", "b"), ("k", "c", "b")],
            r#"arm.urdf:3: joint "k": its child "b" already hangs on joint "j"; a link has one parent: remove one joint"#,
        ),
        (
            &[("j", "a", "b"), ("k", "b", "c"), ("l", "c", "a")],
            r#"arm.urdf:4: joint "l": the joints j, k, l lead round in a circle; links form a tree: give it another parent"#,
        ),
        (
            &[("j", "b", "c"), ("k", "c", "b")],
            r#"arm.urdf:3: joint "k": the joints j, k lead round in a circle; links form a tree: give it another parent"#,
        ),
        (
            &[("j", "a", "b"), ("k", "c", "c")],
            r#"arm.urdf:3: joint "k": it joins "c" to itself; links form a tree: give it another parent"#,
        ),
        (
            &[("j", "a", "b"), ("j", "a", "c")],
            r#"arm.urdf:3: joint "j": there is another one of this name; rename one of them"#,
        ),
    ] {
        assert_eq!(urdf(&robot(joints)), expected, "{joints:?}");
    }
    let twice = links.replace("name=\"c\"", "name=\"a\"");
    assert_eq!(
        urdf(&format!("{twice}{}</robot>", joint("j", "a", "b"))),
        r#"arm.urdf:1: link "a": there is another one of this name; rename one of them"#
    );
}

#[test]
fn joints_that_follow_must_follow_one_that_moves() {
    let joint = |name: &str, child: &str, kind: &str, mimic: &str| {
        format!(
            "\n<joint name=\"{name}\" type=\"{kind}\"><parent link=\"a\"/>\
             <child link=\"{child}\"/>{mimic}</joint>"
        )
    };
    let links = r#"<robot name="arm"><link name="a"/><link name="b"/><link name="c"/>"#;
    for (j, k, kind, expected) in [
        (
            "<mimic joint=\"k\"/>",
            "<mimic joint=\"j\"/>",
            "continuous",
            r#"arm.urdf:2: joint "j": the joints that it mimics lead back to it; name a joint that moves by itself
arm.urdf:3: joint "k": the joints that it mimics lead back to it; name a joint that moves by itself"#,
        ),
        (
            "<mimic joint=\"j\"/>",
            "",
            "continuous",
            r#"arm.urdf:2: joint "j": the joints that it mimics lead back to it; name a joint that moves by itself"#,
        ),
        (
            "<mimic joint=\"k\"/>",
            "",
            "fixed",
            r#"arm.urdf:2: joint "j": it mimics "k", which does not move; name a joint that moves by itself"#,
        ),
        (
            "<mimic/>",
            "",
            "continuous",
            r#"arm.urdf:2: joint "j": <mimic> has no joint; write joint="…""#,
        ),
    ] {
        let joints = joint("j", "b", "continuous", j) + &joint("k", "c", kind, k);
        assert_eq!(urdf(&format!("{links}{joints}</robot>")), expected);
    }
}

#[test]
fn an_srdf_must_fit_its_robot() {
    let text = r#"<robot name="leg">
  <group name="whatever"><chain base_link="x" tip_link="y"/></group>
  <group_state name="home" group="all">
    <joint name="j" value="1.5"/>
    <joint name="j" value="0"/>
    <joint name="k" value="0"/>
    <joint value="0"/>
  </group_state>
  <group_state name="home" group="all"><joint name="j" value="x"/></group_state>
  <group_state group="all"/>
  <group_state name="far"/>
  <disable_collisions link1="a" link2="z"/>
  <disable_collisions link1="a"/>
</robot>"#;
    assert_eq!(
        srdf(text),
        r#"arm.srdf:1: robot: it is about "leg", the URDF about "arm"; use the files of one robot
arm.srdf:4: group_state "home": joint "j" is at 1.5, outside its limits; write a value from -1 to 1
arm.srdf:5: group_state "home": it sets joint "j" twice; remove one of them
arm.srdf:6: group_state "home": the robot has no joint "k"; correct the name, or remove it
arm.srdf:7: group_state "home": it has no name; write name="…"
arm.srdf:9: group_state "home": <joint> has value="x"; write one finite number
arm.srdf:9: group_state "home": group "all" has it twice; rename one of them
arm.srdf:10: group_state: it has no name; write name="…"
arm.srdf:11: group_state "far": <group_state> has no group; write group="…"
arm.srdf:12: disable_collisions: the robot has no link "z"; correct the name, or remove the pair
arm.srdf:13: disable_collisions: <disable_collisions> has no link2; write link2="…""#
    );
    assert_eq!(
        srdf("<robot"),
        r#"arm.srdf:1: document: it is not well-formed XML: the document does not have a root node; correct the markup there"#
    );
}

#[test]
fn a_fault_can_be_taken_apart() {
    let faults = Robot::parse("<robot name=\"arm\"/>", None).unwrap_err();
    let [fault] = faults.all() else { panic!("{faults}") };
    assert_eq!((fault.document, fault.line, fault.element.as_str()), (Document::Urdf, 1, "robot"));
    assert_eq!(
        faults.to_string(),
        r#"URDF:1: robot: it has no <link>; describe its links and joints"#
    );
}
