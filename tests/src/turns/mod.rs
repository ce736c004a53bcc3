//! Who speaks when: dialogues in simulated time through the real reducers of speech, grounding and
//! policy, with answers that come late, early, into the next question, and twice.
//!
//! Every dialogue is held with the same person under each rule of attribution
//! (`dialogue.turns.attribution`), and once more with the same person answering in good time: a
//! wrong pick that the second does not have was caused by timing.
//!
//! | file | holds |
//! |---|---|
//! | `person.rs` | when a person answers what |
//! | `world.rs` | the processes, the voice and the recogniser in simulated time |
//! | `study.rs` | many dialogues, counted |

mod person;
mod study;
mod world;

pub use person::{Channel, Timing};
pub use study::{Count, RULES, Study, study};
pub use world::{Credit, Ended, converse};
