//! From where a picture is seen.

use nalgebra::{Rotation3, Vector3};

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where it is, metres.
    pub eye: Vector3<f64>,
    /// What is in the middle of the picture, metres.
    pub target: Vector3<f64>,
    /// What points up in the picture; not along the line of sight.
    pub up: Vector3<f64>,
    /// Angle that the picture's height spans, radians.
    pub height_rad: f64,
}

/// A camera with the picture's size: from places to pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lens {
    eye: Vector3<f64>,
    turn: Rotation3<f64>,
    focal: f64,
    middle: (f64, f64),
}

/// What is nearer to the eye than this is not drawn, metres.
const NEAREST: f64 = 0.05;

impl Camera {
    /// Where a place is in a picture of that size: pixels to the right and down, and its distance
    /// along the line of sight, metres. None behind the camera.
    pub fn project(
        &self,
        place: &Vector3<f64>,
        (width, height): (usize, usize),
    ) -> Option<(f64, f64, f64)> {
        self.lens(width, height).project(place)
    }

    pub(crate) fn lens(&self, width: usize, height: usize) -> Lens {
        let forward = (self.target - self.eye).normalize();
        let right = forward.cross(&self.up).normalize();
        let turn = Rotation3::from_basis_unchecked(&[right, right.cross(&forward), forward]);
        let focal = 0.5 * height as f64 / (0.5 * self.height_rad).tan();
        let middle = (0.5 * width as f64, 0.5 * height as f64);
        Lens { eye: self.eye, turn: turn.inverse(), focal, middle }
    }
}

impl Lens {
    pub(crate) fn project(&self, place: &Vector3<f64>) -> Option<(f64, f64, f64)> {
        let seen = self.turn * (place - self.eye);
        let scale = self.focal / seen.z;
        let at = (self.middle.0 + scale * seen.x, self.middle.1 - scale * seen.y, seen.z);
        (seen.z > NEAREST).then_some(at)
    }
}
