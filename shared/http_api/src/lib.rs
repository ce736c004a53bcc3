//! The console's interface for programs: `/api/v1` (docs/http.md), beside the page's operator lease.
//!
//! Two halves that never wait for each other, as in the console itself. The [`Feed`] lives on the main thread: it hands words
//! to the speech service and publishes the robot's state. The [`routes`] are served by the web server: they know programs by
//! their tokens, wait for replies, and stream events. Orders to the motion stop take neither: they go from the web server to
//! the arm's own socket, so that they need no owner, no queue and no main loop.
//!
//! | contents | file |
//! |---|---|
//! | tokens, their rights, their last use, the verb `whichone token` | `tokens.rs`, `uses.rs`, `verb.rs` |
//! | addresses, who may use them, the audit | `routes.rs`, `api.rs` |
//! | words under a key, replies, whose dialogue it is | `say.rs`, `feed.rs`, `conversations.rs` |
//! | the state and its events | `state.rs`, `events.rs`, `stream.rs` |
//! | the announcement in the local network | `api.rs`, crate `discovery` |
//! | the motion stop | `motion.rs` |
//! | refusals, limits | `problem.rs`, `limits.rs` |
//! | the description that is served and tested | `openapi.json` |

mod api;
mod conversations;
mod events;
mod feed;
mod limits;
mod motion;
mod problem;
mod routes;
mod say;
mod state;
mod stream;
mod tokens;
mod uses;
pub mod verb;

pub use api::{Api, Rules, open};
pub use feed::{Feed, request_key};
pub use routes::routes;
pub use state::Robot;
pub use tokens::{Right, Token, Tokens, tokens_file};
