//! The Wyoming protocol, by which Home Assistant uses servers of speech (faster-whisper, Vosk,
//! Piper): a codec ([`Frame`], [`Event`]) and a blocking client ([`Client`]).
//!
//! Source: package `wyoming` 1.10.2 of PyPI. An event is a line of JSON, then as many bytes of
//! further JSON and of payload as the line announces.
//!
//! Invariant: lengths from the wire are bounded, memory grows only with bytes that have arrived,
//! and no call lasts longer than its time limits, whatever the server sends.

mod address;
mod client;
mod connection;
mod event;
mod frame;
mod settings;
pub mod stand_in;

pub use address::{Address, AddressError};
pub use client::{Client, ClientError, Kind, Sound, Voice};
pub use event::{AudioFormat, Event, EventError, Info, Program};
pub use frame::{Frame, FrameError, HEADER_MAX, PART_MAX};
pub use settings::{Settings, read_settings};
