//! Diagnostics of text files that people write, and the reader of TOML and JSON that produces them.
//!
//! A [`Diagnostic`] names the file, the line, the key, the value found and the fix. Readers collect
//! all of them in a [`Report`] instead of stopping at the first. Scenes, settings and robot
//! descriptions share these types, so that every error looks alike.
//!
//! This crate is pure: no IO, no clock, no threads.

mod diagnostic;
mod fields;
mod schema;
mod source;
mod spelling;
mod text;

pub use diagnostic::{Diagnostic, Diagnostics, Report};
pub use fields::Fields;
pub use schema::schema_of;
pub use source::{Node, Scalar, Source, Table, TextFile};
pub use spelling::{nearest, suggestion};
