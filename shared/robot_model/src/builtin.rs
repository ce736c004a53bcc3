//! The robot that is built in.

use std::sync::LazyLock;

use crate::model::Robot;

/// The text of `config/robots/baxter.urdf`.
pub const BAXTER_URDF: &str = include_str!("../../../config/robots/baxter.urdf");
/// The text of `config/robots/baxter.srdf`.
pub const BAXTER_SRDF: &str = include_str!("../../../config/robots/baxter.srdf");

impl Robot {
    /// Baxter with electric grippers, from `config/robots/baxter.urdf` and `baxter.srdf` as they
    /// were when this was compiled.
    ///
    /// Numbers from baxter_common 1.2.0, BSD-3-Clause, Copyright (c) 2013-2015 Rethink Robotics.
    pub fn baxter() -> &'static Self {
        static BAXTER: LazyLock<Robot> = LazyLock::new(|| {
            Robot::parse(BAXTER_URDF, Some(BAXTER_SRDF)).expect("the tests read these very texts")
        });
        &BAXTER
    }
}
