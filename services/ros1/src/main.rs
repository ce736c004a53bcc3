//! The bridge to a Baxter's ROS 1 topics.

use service::exit::Exit;
use std::process::ExitCode;

fn main() -> ExitCode {
    let code = service::service_loop::run::<ros1::bridge::Ros1Program>();
    if ros1::was_replaced() { Exit::Config.code() } else { code }
}
