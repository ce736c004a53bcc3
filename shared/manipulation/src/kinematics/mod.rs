//! Kinematics of one limb: its chain of joints, their limits, and inverse kinematics.

pub(crate) mod chain;
pub(crate) mod inverse;
pub(crate) mod limb;
pub(crate) mod limits;
