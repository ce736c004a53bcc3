//! The built-in robot against frames that another program computed.

use robot_model::Robot;

use crate::samples::{difference, facts, fixture, numbers, pose};

#[test]
fn frames_match_the_reference() {
    let robot = Robot::baxter();
    for limb in ["left", "right"] {
        let text = fixture(&format!("baxter/fk_reference_{limb}.csv"));
        let mut lines = text.lines();
        // The file has two tools; the one of the description is the electric one.
        let columns: Vec<(usize, String)> = lines
            .next()
            .unwrap()
            .split(',')
            .enumerate()
            .filter_map(|(at, name)| Some((at, name.strip_suffix("_x")?)))
            .filter(|(_, link)| *link != "gripper_plain")
            .map(|(at, link)| (at, format!("{limb}_{}", link.replace("_electric", ""))))
            .collect();
        assert_eq!(columns.len(), 12, "{columns:?}");
        let arm = robot.chain(&format!("{limb}_gripper")).unwrap();
        for row in lines {
            let row: Vec<f64> = row.split(',').map(|number| number.parse().unwrap()).collect();
            let of_joint = |name: &str| arm.movable().position(|joint| joint.name == name);
            let poses = robot.poses(|joint| of_joint(&joint.name).map_or(0.0, |i| row[i]));
            for (at, link) in &columns {
                let expected = pose(&row[*at..at + 7]);
                let worst = difference(&poses[robot.link_index(link).unwrap()], &expected);
                assert!(worst < 1e-9, "{link}: {worst:e}");
            }
            let tip = poses[robot.link_index(&arm.tip().name).unwrap()];
            assert!(difference(&arm.forward(&row[..7]), &tip) < 1e-14);
        }
    }
}

#[test]
fn limits_match_the_reference() {
    let facts = facts();
    let robot = Robot::baxter();
    let mut arm_joints = 0;
    for fact in facts["joint"].as_array().unwrap() {
        let name = fact["name"].as_str().unwrap();
        let joint = robot.joint(name).unwrap_or_else(|| panic!("no joint {name}"));
        assert_eq!(joint.kind.name(), fact["type"].as_str().unwrap(), "{name}");
        let Some(limits) = joint.limits else {
            assert!(fact.get("lower").is_none(), "{name}");
            continue;
        };
        let of = |key: &str| fact[key].as_float().unwrap();
        assert_eq!((limits.lower, limits.upper), (of("lower"), of("upper")), "{name}");
        assert_eq!((limits.velocity, limits.effort), (of("velocity"), of("effort")), "{name}");
        let order = facts["joint_order"].as_array().unwrap();
        let suffix = name.split_once('_').unwrap().1;
        if let Some(i) = order.iter().position(|joint| joint.as_str() == Some(suffix)) {
            let stated = numbers(&facts["acceleration_limits"]["moveit"])[i];
            assert_eq!((limits.acceleration, limits.jerk), (Some(stated), Some(20.0)), "{name}");
            arm_joints += 1;
        }
    }
    assert_eq!(arm_joints, 14);
    assert_eq!(robot.joints().len(), facts["joint"].as_array().unwrap().len());
}
