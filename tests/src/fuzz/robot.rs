//! Robot descriptions: URDF and, after a zero byte, SRDF.

use diagnostics::TextFile;
use robot_model::{BAXTER_SRDF, BAXTER_URDF, Robot};

use super::bytes::project_file;

pub(super) fn run(input: &[u8]) {
    let text = String::from_utf8_lossy(input);
    let (urdf, srdf) = match text.split_once('\0') {
        Some((urdf, srdf)) => (urdf, Some(TextFile::new("fuzz.srdf", srdf))),
        None => (&*text, None),
    };
    match Robot::read(&TextFile::new("fuzz.urdf", urdf), srdf.as_ref()) {
        Ok(robot) => use_it(&robot),
        Err(problems) => {
            assert!(problems.iter().count() > 0);
            for problem in problems.iter() {
                assert!(problem.file.starts_with("fuzz.") && !problem.what.is_empty());
                assert!(problem.line > Some(0) && !problem.help.is_empty(), "{problem}");
            }
        }
    }
}

fn use_it(robot: &Robot) {
    assert_eq!(robot.links().len(), robot.joints().len() + 1);
    for (n, joint) in robot.joints().iter().enumerate() {
        assert!(joint.child == n + 1 && joint.parent <= n);
        assert!((joint.axis.norm() - 1.0).abs() < 1e-9);
        assert!(joint.limits.is_none_or(|limits| limits.lower <= limits.upper));
    }
    assert_eq!(robot.poses(|_| 0.3).len(), robot.links().len());
    for link in robot.links() {
        let chain = robot.chain(&link.name).expect("its own link");
        chain.forward(&vec![0.3; chain.movable().len()]);
    }
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let small = project_file("tests/fixtures/robots/seven_joints.urdf");
    let srdf =
        br#"<robot name="r"><group_state name="rest" group="arm"><joint name="j1" value="0.5"/>
        </group_state><disable_collisions link1="a" link2="b" reason="Adjacent"/></robot>"#;
    let whole = [BAXTER_URDF.as_bytes(), b"\0", BAXTER_SRDF.as_bytes()].concat();
    vec![small.clone(), [&small[..], b"\0", srdf].concat(), whole]
}
