//! The shipped configuration, as it was when this was compiled: every file of `config/`.

use command_line::shipped::Files;

macro_rules! file {
    ($path:literal) => {
        ($path, include_str!(concat!("../../../config/", $path)))
    };
}

/// The files, by their path in the folder of the configuration.
pub(crate) const FILES: Files = &[
    file!("arm.toml"),
    file!("console.toml"),
    file!("dialogue.toml"),
    file!("group.toml"),
    file!("link.toml"),
    file!("profiles/baxter-ros.toml"),
    file!("profiles/baxter.toml"),
    file!("profiles/camera.toml"),
    file!("profiles/ci.toml"),
    file!("profiles/lab.toml"),
    file!("profiles/link.toml"),
    file!("profiles/mujoco.toml"),
    file!("profiles/paper.toml"),
    file!("profiles/ros2.toml"),
    file!("profiles/trajectory.toml"),
    file!("profiles/so101.toml"),
    file!("profiles/ur5e.toml"),
    file!("robots/baxter.srdf"),
    file!("robots/baxter.urdf"),
    file!("robots/so101.srdf"),
    file!("robots/so101.urdf"),
    file!("robots/ur5e.srdf"),
    file!("robots/ur5e.urdf"),
    file!("ros2.toml"),
    file!("scenes/blocks.toml"),
    file!("scenes/bowls.toml"),
    file!("scenes/markers.toml"),
    file!("scenes/so101-blocks.toml"),
    file!("scenes/tools.toml"),
    file!("schemas/arm.json"),
    file!("schemas/console.json"),
    file!("schemas/dialogue.json"),
    file!("schemas/group.json"),
    file!("schemas/link.json"),
    file!("schemas/profile.json"),
    file!("schemas/ros2.json"),
    file!("schemas/scene.json"),
    file!("schemas/speech.json"),
    file!("schemas/study.json"),
    file!("speech.toml"),
    file!("study.toml"),
];
