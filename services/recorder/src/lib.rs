//! Recorder: writes every topic of the group into a ring of MCAP files.
//!
//! It is an observer: it writes no topic, no writer waits for it, and the group is whole without it. It looks
//! at all topics four to ten times a second, with buffers that hold what was sent meanwhile; what it misses all
//! the same shows as a gap of sequence numbers.

mod service;

pub use self::service::run;
