//! Programs for a running group of whichone, from outside its repository: a grounder, a service of a new kind, a
//! client. Readiness, heartbeats, incarnations, wake-ups, the lifeline and receipts are handled inside.
//!
//! | to write | implement or call |
//! |---|---|
//! | the meaning of utterances | [`grounding::Grounder`], then [`grounding::run`] |
//! | a service of a new kind | [`service::Service`], then [`service::run`] |
//! | a program that talks to the robot or observes it | [`client::Client`] |
//!
//! A grounder that knows two words:
//!
//! ```no_run
//! use std::process::ExitCode;
//! use whichone_sdk::grounding::{self, Grounder, certain};
//! use whichone_sdk::{Hypothesis, Question, Reading, Response, Scene};
//!
//! struct YesOrNo;
//!
//! impl Grounder for YesOrNo {
//!     fn read(&mut self, heard: &Hypothesis, _: Question, _: &Scene) -> Vec<(f64, Reading)> {
//!         let response = match heard.text.as_str() {
//!             "yes" => Response::Yes,
//!             "no" => Response::No,
//!             _ => Response::None,
//!         };
//!         certain(Reading { response, ..Reading::default() })
//!     }
//! }
//!
//! fn main() -> ExitCode {
//!     grounding::run(YesOrNo)
//! }
//! ```
//!
//! Then `whichone swap grounding -- target/release/yes-or-no` puts it in place, also during a dialogue, and
//! `whichone conform grounding -- target/release/yes-or-no` tests it against the contract.

pub mod client;
pub mod grounding;
mod log;
pub mod service;
pub mod settings;

pub use log::init as init_log;
pub use messages::{self, Hypothesis, Topic, payloads, topics};
pub use runtime::bus::{self, EncodedReader, EncodedWriter, PortError, Reader, Writer};
pub use runtime::exit::{Exit, Failure};
pub use runtime::group::{GroupName, GroupPaths};
pub use runtime::{Span, Time, clock};
pub use scene::{
    AttributeId, Doubt, Intent, ObjectId, Question, Reading, Reference, Response, Role, Scene,
    UnknownWord, ValueId, WordId,
};
pub use vocabulary::Interpretation;
