//! The ROS 2 node.

use std::process::ExitCode;

fn main() -> ExitCode {
    ros2::node::run()
}
