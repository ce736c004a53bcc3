//! Words of a text: normalised, taken apart, and compared by their sounds.
//!
//! This crate is pure, and knows no meaning: `language` interprets the words.

mod confusion;
mod normalise;
mod phonetics;
mod tokens;

pub use confusion::confusion;
pub use normalise::{TEXT_CHARS_MAX, normalise};
pub use phonetics::skeleton;
pub use tokens::{Gap, Token, Tokens, contractions};
