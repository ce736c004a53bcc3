//! The shell: the only place that opens topics, reads clocks, takes signals and writes files for
//! the services. Parts for every process of a group, also one from outside, are in `runtime`, whose
//! modules are re-exported here.
//!
//! A service is a [`Node`], a reducer from events to effects. The main loop, [`service_loop`],
//! recovers it from its journal, feeds it and applies its effects. Clients are in [`client`].
//!
//! # Example
//!
//! A reducer that counts its inputs. Nothing is published before its record is durable.
//!
//! ```
//! use service::{Effects, Event, Node, NodeError, Time};
//!
//! struct Counter(u64);
//!
//! impl Node for Counter {
//!     type Config = ();
//!     type In<'a> = String;
//!     type Out = String;
//!     type Record = u64;
//!
//!     fn recover(_: (), records: Vec<u64>) -> Result<Self, NodeError> {
//!         Ok(Self(records.last().copied().unwrap_or(0)))
//!     }
//!
//!     fn on(&mut self, event: Event<String>, _: Time, fx: &mut Effects<String, u64>) {
//!         match event {
//!             Event::Message(words) => {
//!                 self.0 += 1;
//!                 fx.append(self.0);
//!                 fx.publish(format!("{words} is number {}", self.0));
//!             }
//!             Event::Shutdown => fx.exit(),
//!             _ => {}
//!         }
//!     }
//!
//!     fn deadline(&self) -> Option<Time> {
//!         None
//!     }
//! }
//!
//! let mut effects = Effects::default();
//! let mut counter = Counter::recover((), vec![1, 2])?;
//! counter.on(Event::Message("hello".to_owned()), Time(0), &mut effects);
//! assert_eq!(effects.records(), [3]);
//! assert_eq!(effects.take_outputs(), ["hello is number 3"]);
//! # Ok::<(), NodeError>(())
//! ```

pub mod audio;
pub mod bounded;
mod commit;
pub mod console_link;
pub mod control;
pub mod exit;
pub mod flight;
pub mod inspection;
mod journal_clock;
pub mod journal_record;
pub mod journal_set;
pub mod json_schema;
pub mod kept_settings;
pub mod launch;
pub mod log_file;
pub mod logging;
pub mod printable;
pub mod program;
mod reducer;
pub mod service_loop;
pub mod status;
pub mod storage;
pub mod view;
pub mod worker_channel;

pub use reducer::{Effects, Event, Never, Node, NodeError, SetAside};
pub use runtime::{Span, Time};
pub use runtime::{
    bus, client, clock, epoch, folders, group, lifecycle, notify, shm_cleanup, stop_socket,
    submission, wakes,
};
pub use vocabulary::wall_time;
