//! The verb `objects`: lists the objects on the table, changes them by hand, and reports what detectors print.
//!
//! | file | holds |
//! |---|---|
//! | `args.rs` | arguments |
//! | `verb.rs` | list and changes by hand |
//! | `feed.rs` | looks on standard input: each line is read, placed, checked and reported |
//! | `printed.rs` | what Ultralytics, COCO, Transformers, `vision_msgs` and AprilTag print |
//! | `camera.rs` | pixels to places, by the `camera_info` of ROS |

pub mod args;
mod camera;
mod feed;
mod printed;
mod verb;

pub use camera::Camera;
pub use feed::Feed;
pub use verb::objects;
