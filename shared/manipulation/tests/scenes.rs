//! Every object of the scenes that ship can be fetched and pointed at, among the others.

use manipulation::{
    Cuboid, ObjectPose, PlanSettings, Robot, check_reachable, plan_pick, plan_point,
};
use toml::{Table, Value};

#[test]
fn objects_of_the_shipped_scenes_are_in_reach() {
    let robot = Robot::baxter();
    for scene in ["bowls", "markers", "tools"] {
        let objects = read(scene);
        let poses: Vec<ObjectPose> = objects.iter().map(|(_, pose)| *pose).collect();
        let settings = PlanSettings { speed_ratio: 0.6, ..PlanSettings::default() };
        for (checked, (name, _)) in
            check_reachable(robot, &poses, None, &settings).iter().zip(&objects)
        {
            assert!(checked.is_ok(), "{scene}: {name}: {checked:?}");
        }
        let cuboids: Vec<Cuboid> = poses.iter().map(ObjectPose::cuboid).collect();
        for (i, (name, pose)) in objects.iter().enumerate() {
            let mut others = cuboids.clone();
            others.remove(i);
            let pick = plan_pick(robot, pose, None, &robot.neutral(), &others, &settings)
                .unwrap_or_else(|error| panic!("{scene}: {name}: {error}"));
            let point = plan_point(robot, pose.xyz_m, None, &robot.neutral(), &cuboids, &settings)
                .unwrap_or_else(|error| panic!("{scene}: {name}: {error}"));
            println!(
                "{scene} {name}: {} arm fetches in {:.2} s, {} arm points in {:.2} s",
                pick.limb(),
                pick.duration_s(),
                point.limb(),
                point.duration_s()
            );
            assert!(pick.duration_s() < 14.0 && point.duration_s() < 8.0, "{scene}: {name}");
        }
    }
}

fn read(scene: &str) -> Vec<(String, ObjectPose)> {
    let path = format!("{}/../../config/scenes/{scene}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let table: Table = text.parse().expect("a scene is TOML");
    table["objects"].as_array().expect("a scene lists objects").iter().map(object).collect()
}

fn object(value: &Value) -> (String, ObjectPose) {
    let triple = |key: &str| -> [f64; 3] { value[key].clone().try_into().expect("three numbers") };
    let number = |key: &str| value.get(key).map(|n| n.as_float().expect("a number"));
    let pose = ObjectPose {
        xyz_m: triple("xyz"),
        yaw_rad: number("yaw").unwrap_or(0.0),
        size_m: triple("size"),
        grasp_width_m: number("grasp_width").expect("a grasp width"),
    };
    (value["name"].as_str().expect("a name").to_owned(), pose)
}
