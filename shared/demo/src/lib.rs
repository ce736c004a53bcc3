//! A demo without installation: the robot's reader, dialogue manager and planner in a static page.
//!
//! The crates that understand and decide are those of the robot. What is simulated here is what surrounds them: the
//! arm, and the voice, whose lines are shown. Time is the page's: this crate reads no clock and starts no thread.
//!
//! | file | contents |
//! |---|---|
//! | `abi.rs` | the functions that the page calls: texts in linear memory |
//! | `desk.rs` | commands of the page and their answers, JSON |
//! | `session.rs`, `turns.rs` | one dialogue: utterances, causes, time; what time alone brings about |
//! | `voice.rs` | presentations of the robot's lines |
//! | `arm.rs`, `motion.rs` | the simulated arm: orders and the motion stop; its movements |
//! | `sections.rs`, `transcript.rs` | the state in the form of the console's page |
//! | `settings.rs`, `scenes.rs` | the shipped configuration and scenes |
//!
//! # Example
//!
//! ```
//! let mut desk = demo::Desk::default();
//! desk.command(r#"{"do":"open","scene":"bowls"}"#);
//! let answer = desk.command(r#"{"do":"say","text":"get me the bowl","at_ms":10}"#);
//! assert!(answer.contains("\"decision\":\"ask\""), "{answer}");
//! ```

pub mod abi;
mod arm;
mod desk;
mod motion;
pub mod scenes;
mod sections;
mod session;
pub mod settings;
mod transcript;
mod turns;
mod voice;

pub use desk::Desk;
pub use session::Session;
pub use settings::SetupError;
