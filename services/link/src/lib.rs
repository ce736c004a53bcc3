//! A group over the internet: a robot's group seen and commanded from another machine.
//!
//! The crate is what travels and the rules by which it does: [`frame`] and [`mirrored`] (state), [`line`] (the robot's
//! voice), [`say`] (words), [`motion`] (orders to the motion stop), [`offset`] (time), [`names`] and [`identity`], all of which neither
//! know the transport nor do any IO beyond reading a folder of keys. The link itself comes with the feature `zenoh`:
//! `robot` and `mirror` are its two ends, `router` lies between them, `keyring` makes their keys.

pub mod frame;
pub mod identity;
pub mod line;
pub mod mirrored;
pub mod motion;
pub mod names;
pub mod offset;
pub mod presence;
pub mod say;
pub mod trouble;

#[cfg(feature = "zenoh")]
pub mod cli;
#[cfg(feature = "zenoh")]
pub mod fleet;
#[cfg(feature = "zenoh")]
pub mod keyring;
#[cfg(feature = "zenoh")]
pub mod mirror;
#[cfg(feature = "zenoh")]
pub mod robot;
#[cfg(feature = "zenoh")]
pub mod router;
#[cfg(feature = "zenoh")]
pub mod session;
#[cfg(feature = "zenoh")]
pub mod simulated;
#[cfg(feature = "zenoh")]
pub mod watch;
