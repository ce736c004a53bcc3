//! Pictures of measurements, as SVG and PNG.
//!
//! A [`Drawing`] paints on any of plotters' areas; [`svg`] and [`png`] run it on the two. The PNG
//! has letters of its own ([`Canvas`]), so that no font has to be installed. [`Lines`] is the chart
//! of series over one axis.
//!
//! This crate is pure: no IO, no clock, no threads. The same drawing is the same bytes.

mod canvas;
mod lines;

pub use canvas::Canvas;
pub use lines::{Lines, Scale, Series};
pub use plotters;

use plotters::coord::Shift;
use plotters::prelude::{DrawingArea, DrawingBackend, IntoDrawingArea, SVGBackend};

/// A picture cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cannot draw: {0}")]
pub struct PlotError(pub String);

impl PlotError {
    /// Says why, in plotters' words.
    pub fn of(error: impl std::fmt::Display) -> Self {
        Self(error.to_string())
    }
}

/// Something that can be painted.
pub trait Drawing {
    /// Paints it.
    ///
    /// # Errors
    /// What is to be painted makes no picture.
    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Result<(), PlotError>;
}

/// The drawing as the text of an SVG file, that many pixels wide and high.
///
/// # Errors
/// As [`Drawing::draw`].
pub fn svg(drawing: &impl Drawing, size: (u32, u32)) -> Result<String, PlotError> {
    let mut text = String::new();
    let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
    drawing.draw(&area)?;
    area.present().map_err(PlotError::of)?;
    drop(area);
    Ok(text)
}

/// The drawing as the bytes of a PNG file, that many pixels wide and high.
///
/// # Errors
/// As [`Drawing::draw`].
pub fn png(drawing: &impl Drawing, size: (u32, u32)) -> Result<Vec<u8>, PlotError> {
    let mut canvas = Canvas::new(size);
    let area = (&mut canvas).into_drawing_area();
    drawing.draw(&area)?;
    area.present().map_err(PlotError::of)?;
    drop(area);
    canvas.encode()
}
