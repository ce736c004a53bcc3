//! Pictures of measurements, as SVG and PNG.
//!
//! A picture is a list of shapes on a [`Canvas`]; [`svg`] and [`png`] write it down. The PNG has
//! letters of its own, so that no font has to be installed. [`Lines`] is the chart of series over
//! one axis; other charts are drawn by those who need them, with the axes of this crate.
//!
//! This crate is pure: no IO, no clock, no threads. The same picture is the same bytes.

mod axis;
mod canvas;
mod lines;
mod png;
mod raster;
mod svg;

pub use axis::{Linear, Logarithmic, Missing};
pub use canvas::{
    Align, BLACK, Canvas, FAINT, GREY, Ink, LETTER_WIDTH, Place, Shape, Size, colour,
};
pub use lines::{Lines, Scale, Series};
pub use png::png;
pub use raster::Raster;
pub use svg::svg;

/// A picture cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cannot draw: {0}")]
pub struct PlotError(pub String);
