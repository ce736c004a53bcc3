use super::*;
use crate::kinematics::limb::Limb;
use crate::samples::{arm, difference, fixture, joints, numbers, pose, table};

#[test]
fn gripper_poses_equal_the_reference() {
    for limb in Limb::BOTH {
        let (names, rows) = table(&format!("fk_reference_{limb}.csv"));
        let at = names.iter().position(|name| name == "gripper_electric_x").unwrap();
        assert_eq!(rows.len(), 100);
        for row in rows {
            let row = numbers(&row);
            let found = arm(limb).chain.forward(&joints(&row[..7]));
            // Quaternions are compared as they are: w is never negative.
            let worst = difference(&found, &pose(&row[at..at + 7]));
            assert!(worst < 1e-9, "{limb}: {worst:e}");
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
        let jacobian = arm(limb).chain.tool_and_jacobian(&q).1;
        for (i, row) in rows.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                assert!((jacobian[(i, j)] - entry).abs() < 1e-9, "{limb} {q:?} row {i} column {j}");
            }
        }
    }
}
