//! Objects that the arm cannot bring, and whose fault that is.

use super::{Folder, ONE_BOWL};

#[test]
fn an_object_that_the_arm_cannot_fetch() {
    let complaints = |scene: &str, overrides: &[(&str, &str)]| {
        let found = Folder::new(&[("scenes/bowls.toml", scene)]).complaints(None, overrides);
        assert_eq!(found.len(), 1, "{found:?}");
        found.into_iter().next().unwrap()
    };
    let far = complaints(&bowl_with("xyz", "xyz = [2.0, 0.2, -0.125]"), &[]);
    let expected = "scenes/bowls.toml: objects[0].xyz: `red_one` is out of reach of both limbs: ";
    assert!(far.starts_with(expected), "{far}");
    let left = complaints(&bowl_with("xyz", "xyz = [0.7, -0.8, -0.125]"), &[("arm.limb", "left")]);
    assert!(left.contains("`red_one` is out of reach of the left limb: "), "{left}");
    let wide = complaints(&bowl_with("grasp_width", "grasp_width = 0.09"), &[]);
    let expected = "scenes/bowls.toml: objects[0].grasp_width: `red_one` cannot be grasped: ";
    assert!(wide.starts_with(expected), "{wide}");
    let thin = complaints(&bowl_with("grasp_width", "grasp_width = 0.002"), &[]);
    assert!(thin.contains("`red_one` is too thin to be told from nothing: 2.1 mm"), "{thin}");
    let narrow = [("arm.grip_open_percent", "30.0")];
    let narrow = complaints(&bowl_with("grasp_width", "grasp_width = 0.02"), &narrow);
    assert!(narrow.contains("`red_one` is wider than the fingers open: 12.5 mm"), "{narrow}");
}

#[test]
fn a_hand_over_that_is_out_of_reach_is_blamed_itself() {
    let second = ONE_BOWL.split("[[objects]]").nth(1).unwrap();
    let second = second.replace("red_one", "other").replace("0.2,", "-0.2,");
    let two = format!("{ONE_BOWL}\n[[objects]]{second}");
    let folder = Folder::new(&[("scenes/bowls.toml", &two)]);
    let complaints = folder.complaints(None, &[("arm.hand_over_xyz", "[3.0, 0.0, 0.2]")]);
    assert_eq!(complaints.len(), 1, "{complaints:?}");
    let expected = "--set: arm.hand_over_xyz: objects cannot be brought: ";
    assert!(complaints[0].starts_with(expected), "{complaints:?}");
}

#[test]
fn a_scene_without_places_cannot_be_worked_in() {
    let text = "name = 's'\nnoun = 'cup'\n[[attributes]]\nname = 'color'\nvalues = ['red']\n\
                [[objects]]\nname = 'one'\nattributes = { color = 'red' }\n";
    let complaints = Folder::new(&[("scenes/bowls.toml", text)]).complaints(None, &[]);
    assert_eq!(
        complaints,
        [
            "scenes/bowls.toml: objects[0].xyz: `one` has no place, so it cannot be fetched (add `xyz`, `size` and `grasp_width`)"
        ]
    );
}

#[test]
fn nobody_points_from_where_an_object_stands() {
    let inside = "[gesture]\nenabled = true\nperson_xyz = [0.7, 0.2, -0.125]";
    let complaints = Folder::new(&[("dialogue.toml", inside)]).complaints(None, &[]);
    assert_eq!(
        complaints,
        [
            "dialogue.toml: gesture.person_xyz: the person stands where `red_one` does (use a place from which people see the objects, e.g. [1.6, 0.0, 0.45])"
        ]
    );
    let off = inside.replace("true", "false");
    assert!(Folder::new(&[("dialogue.toml", &off)]).load(None, &[]).is_ok());
}

/// `ONE_BOWL` with another line in place of the one that starts with `key`.
fn bowl_with(key: &str, line: &str) -> String {
    let lines = ONE_BOWL.lines().map(|old| if old.starts_with(key) { line } else { old });
    lines.collect::<Vec<_>>().join("\n")
}
