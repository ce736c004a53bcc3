//! Charts of measurements, as SVG.
//!
//! A [`Chart`] is data: panels with axes and shapes, and a legend. [`svg`] draws it
//! with `plotters`.
//!
//! This module is pure: no IO, no clock, no threads. The same chart gives the same bytes.

mod axis;
mod chart;
mod draw;

pub use axis::Axis;
pub use chart::{Chart, Colour, Panel, Point, Shape, colour};
pub use draw::svg;

/// A chart that cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cannot draw: {0}")]
pub struct PlotError(pub String);

#[cfg(test)]
mod tests;
