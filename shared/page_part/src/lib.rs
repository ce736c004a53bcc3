//! Interface of optional parts of the console's page: their commands, section, and files.
//!
//! The console knows a [`Part`] by this trait alone. It lives on the main thread, which it may not
//! keep waiting; its [`Files`] are read on threads of the web server.

use std::fmt::Debug;

use axum::response::Response;
use messages::{ArmStatus, PolicyView, Receipt};
use scene::Scene;
use serde_json::{Map, Value as Json};
use service::Time;

/// A moment on both clocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Now {
    /// Time on the monotonic clock.
    pub at: Time,
    /// Milliseconds since 1970.
    pub unix_ms: u64,
}

/// The robot at one moment.
#[derive(Clone, Copy, Debug)]
pub struct Robot<'a> {
    /// The moment.
    pub now: Now,
    /// The scene of the dialogue.
    pub scene: &'a Scene,
    /// State of the dialogue; `None` until the policy has published one.
    pub view: Option<&'a PolicyView>,
    /// State of the arm; `None` if unknown.
    pub arm: Option<&'a ArmStatus>,
    /// A service that the dialogue needs and that is not ready.
    pub missing: Option<&'a str>,
}

/// An event of the dialogue; reported once.
#[derive(Clone, Debug, PartialEq)]
pub enum DialogueEvent {
    /// A question of the robot has begun.
    Asked {
        /// Number of the prompt.
        prompt: u64,
        /// Number of times the prompt has been presented.
        presentation: u32,
        /// Words of the prompt.
        words: String,
    },
    /// An utterance was accepted.
    Heard(Box<Receipt>),
}

/// Fields of an answer, in addition to the console's.
pub type Fields = Map<String, Json>;

/// An optional part of the page.
pub trait Part: Debug {
    /// Carries out a page's command, without the part's prefix; returns the answer's fields.
    ///
    /// # Errors
    /// The words that the page shows.
    fn command(
        &mut self,
        verb: &str,
        arguments: &Json,
        robot: &Robot<'_>,
    ) -> Result<Fields, String>;

    /// Handles an event of the dialogue.
    fn on_event(&mut self, event: &DialogueEvent, robot: &Robot<'_>);

    /// Takes the robot's state, in each pass of the main loop; returns words to say to the robot.
    fn pass(&mut self, robot: &Robot<'_>) -> Option<String>;

    /// Returns the text of the part's section.
    fn section(&self, robot: &Robot<'_>) -> Option<String>;
}

/// Files of a part, below its own address. They are there also while the part is not enabled.
pub trait Files: Debug + Send + Sync {
    /// Reads a file; may block.
    fn read(&self, name: &str) -> Response;
}
