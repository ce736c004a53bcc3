//! The bridge to a Baxter's ROS 1 topics.

fn main() -> std::process::ExitCode {
    ros1::run()
}
