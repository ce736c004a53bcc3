//! The scenes that ship, as the planner sees them.

use manipulation::ObjectPose;
use toml::{Table, Value};

/// Names and places of a scene's objects.
pub(crate) fn read(scene: &str) -> Vec<(String, ObjectPose)> {
    table(scene)["objects"].as_array().unwrap().iter().map(object).collect()
}

/// Returns the value of an attribute of each of a scene's objects.
pub(crate) fn attribute(scene: &str, key: &str) -> Vec<String> {
    let table = table(scene);
    let objects = table["objects"].as_array().unwrap();
    objects.iter().map(|o| o["attributes"][key].as_str().unwrap().to_owned()).collect()
}

/// Returns the scene with object `i` where object `k` stood, and the other way round; what they
/// stand on keeps its height.
pub(crate) fn swapped(objects: &[ObjectPose], i: usize, k: usize) -> Vec<ObjectPose> {
    let mut swapped = objects.to_vec();
    for (to, from) in [(i, k), (k, i)] {
        let place = &objects[from];
        let z = place.bottom_z_m() + 0.5 * objects[to].size_m[2];
        swapped[to].xyz_m = [place.xyz_m[0], place.xyz_m[1], z];
    }
    swapped
}

fn table(scene: &str) -> Table {
    let path = format!("{}/../../config/scenes/{scene}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    text.parse().unwrap()
}

fn object(value: &Value) -> (String, ObjectPose) {
    let triple = |key: &str| -> [f64; 3] { value[key].clone().try_into().unwrap() };
    let number = |key: &str| value.get(key).map(|n| n.as_float().unwrap());
    let pose = ObjectPose {
        xyz_m: triple("xyz"),
        yaw_rad: number("yaw").unwrap_or(0.0),
        size_m: triple("size"),
        grasp_width_m: number("grasp_width").unwrap(),
        mass_kg: number("mass_kg"),
        wall_rad: number("wall_deg").unwrap_or(0.0).to_radians(),
        hollow: value.get("form").is_some_and(|form| form.as_str() == Some("hollow")),
    };
    (value["name"].as_str().unwrap().to_owned(), pose)
}
