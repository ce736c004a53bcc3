//! Surfaces as triangles.

use nalgebra::{Isometry3, Point3, Vector3};

/// Red, green and blue as on a screen, each 0 to 1.
pub type Rgb = [f64; 3];

/// What a surface looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paint {
    /// Its colour.
    pub rgb: Rgb,
    /// How much it shines, 0 to 1.
    pub gloss: f64,
    /// Whether it glows: seen in its own colour wherever the light comes from.
    pub glows: bool,
}

/// A piece of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Its corners, metres.
    pub corners: [Vector3<f64>; 3],
    /// The surface's direction at each corner, of length 1. Both sides are seen.
    pub normals: [Vector3<f64>; 3],
    /// What it looks like.
    pub paint: Paint,
    /// Which body it belongs to: edges are drawn between bodies.
    pub part: u32,
}

/// Surfaces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Their pieces, in any order.
    pub triangles: Vec<Triangle>,
}

impl Paint {
    /// Of that colour, somewhat shiny.
    pub fn new(rgb: Rgb) -> Self {
        Self { rgb, gloss: 0.25, glows: false }
    }

    /// Of that colour, dull.
    pub fn dull(rgb: Rgb) -> Self {
        Self { gloss: 0.0, ..Self::new(rgb) }
    }

    /// Of that colour, as polished metal.
    pub fn shiny(rgb: Rgb) -> Self {
        Self { gloss: 0.9, ..Self::new(rgb) }
    }

    /// Of that colour whatever the light.
    pub fn glowing(rgb: Rgb) -> Self {
        Self { glows: true, ..Self::dull(rgb) }
    }
}

impl Mesh {
    /// Moved and turned.
    #[must_use]
    pub fn placed(mut self, pose: &Isometry3<f64>) -> Self {
        for triangle in &mut self.triangles {
            triangle.corners = triangle.corners.map(|p| (pose * Point3::from(p)).coords);
            triangle.normals = triangle.normals.map(|n| pose.rotation * n);
        }
        self
    }

    /// As one body with that number.
    #[must_use]
    pub fn part(mut self, part: u32) -> Self {
        self.triangles.iter_mut().for_each(|triangle| triangle.part = part);
        self
    }

    /// Adds other surfaces.
    pub fn add(&mut self, other: Self) {
        self.triangles.extend(other.triangles);
    }

    pub(crate) fn flat(&mut self, corners: [Vector3<f64>; 3], paint: Paint) {
        let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
        if let Some(normal) = normal.try_normalize(1e-12) {
            let normals = [normal; 3];
            self.triangles.push(Triangle { corners, normals, paint, part: 0 });
        }
    }
}
