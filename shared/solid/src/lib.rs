//! Pictures of solid bodies: triangles with a depth buffer, so that what is behind is hidden
//! wherever things cross, one soft light with shadows, and many samples a pixel.
//!
//! A picture is a list of [`Layer`]s seen by a [`Camera`]; [`render`] makes an [`Image`] of it.
//! Lengths are metres, z is up.
//!
//! This crate is pure: no IO, no clock, no threads. The same picture is the same bytes.

mod camera;
mod image;
mod mesh;
mod render;
mod shade;
mod shadow;
mod shapes;
#[cfg(test)]
mod tests;

pub use camera::Camera;
pub use image::Image;
pub use mesh::{Mesh, Paint, Rgb, Triangle};
pub use render::{Layer, Sheet, render};
