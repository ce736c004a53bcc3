use super::*;
use crate::baxter::tool;
use crate::kinematics::limb::Limb;
use crate::samples::{
    Random, arm, difference, fixture, full, joints, neutral, numbers, pose, table, with_tool,
};

#[test]
fn gripper_poses_equal_the_reference() {
    for limb in Limb::BOTH {
        let (names, rows) = table(&format!("fk_reference_{limb}.csv"));
        for (column, tool_m) in [
            ("hand_x", tool::NONE_M),
            ("gripper_plain_x", tool::PLAIN_M),
            ("gripper_electric_x", tool::ELECTRIC_EXTENDED_M),
        ] {
            let at = names.iter().position(|name| name == column).unwrap();
            assert_eq!(rows.len(), 100);
            for row in &rows {
                let row = numbers(row);
                let found = with_tool(limb, tool_m).forward(&joints(&row[..7]));
                let worst = difference(&found, &pose(&row[at..at + 7]));
                assert!(worst < 1e-9, "{limb} {column}: {worst:e}");
            }
        }
    }
}

#[test]
fn jacobians_equal_the_reference() {
    let reference: serde_json::Value =
        serde_json::from_str(&fixture("jacobian_reference.json")).unwrap();
    let samples = reference["samples"].as_array().unwrap();
    assert_eq!(samples.len(), 40);
    for sample in samples {
        let limb = Limb::named(sample["side"].as_str().unwrap()).unwrap();
        let q: Joints = serde_json::from_value(sample["q"].clone()).unwrap();
        let rows: [[f64; 7]; 6] =
            serde_json::from_value(sample["jacobian_rows_vxyz_wxyz"].clone()).unwrap();
        let jacobian = arm(limb).chain.jacobian(&q);
        for (i, row) in rows.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                assert!((jacobian[(i, j)] - entry).abs() < 1e-9, "{limb} {q:?} row {i} column {j}");
            }
        }
    }
}

#[test]
fn jacobians_agree_with_finite_differences() {
    let seed = 1;
    let mut random = Random::seeded(seed);
    for _ in 0..500 {
        let chain = with_tool(random.limb(), random.between(0.0, 0.3));
        let q = random.posture();
        let jacobian = chain.jacobian(&q);
        for j in 0..7 {
            let step = 1e-6;
            let moved = |by: f64| {
                let mut q = q;
                q[j] += by;
                chain.forward(&q)
            };
            let (before, after) = (moved(-step), moved(step));
            let linear = (after.translation.vector - before.translation.vector) / (2.0 * step);
            let turn = (after.rotation * before.rotation.inverse()).scaled_axis() / (2.0 * step);
            for i in 0..3 {
                assert!((jacobian[(i, j)] - linear[i]).abs() < 1e-8, "seed {seed}: {q:?}");
                assert!((jacobian[(i + 3, j)] - turn[i]).abs() < 1e-8, "seed {seed}: {q:?}");
            }
        }
    }
}

#[test]
fn right_limb_mirrors_the_left() {
    let mut random = Random::seeded(2);
    for _ in 0..200 {
        let q = random.posture();
        let left = arm(Limb::Left).chain.tool_frame(&q);
        let right = arm(Limb::Right).chain.tool_frame(&Limb::mirror(&q));
        let mirrored = |v: Vector3<f64>| Vector3::new(v.x, -v.y, v.z);
        assert!((mirrored(left.origin) - right.origin).amax() < 1e-10);
        assert!((mirrored(left.z) - right.z).amax() < 1e-10);
        // A reflection turns a right-handed frame into a left-handed one: one axis flips.
        assert!((mirrored(left.y) + right.y).amax() < 1e-10);
    }
}

#[test]
fn quaternions_have_no_negative_w() {
    let mut random = Random::seeded(3);
    for _ in 0..500 {
        assert!(arm(random.limb()).chain.forward(&random.posture()).rotation.w >= 0.0);
    }
}

#[test]
fn a_straight_wrist_and_elbow_lose_a_direction() {
    let stretched = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let bent = neutral();
    let chain = arm(Limb::Left).chain;
    assert!(chain.manipulability(&stretched) < 0.1 * chain.manipulability(&bent));
    assert!(full().position.within(&stretched));
}
