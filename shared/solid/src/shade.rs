//! How light becomes colour.

use nalgebra::Vector3;

use crate::mesh::{Paint, Rgb};
use crate::shadow::Shadow;

/// The light: one sun with its shadows, a bright sky and a little light from the ground.
#[derive(Debug)]
pub(crate) struct Light {
    sun: Vector3<f64>,
    eye: Vector3<f64>,
    shadow: Shadow,
}

/// From where the sun shines.
pub(crate) const SUN: [f64; 3] = [0.45, 0.5, 1.25];

const SUNLIGHT: f64 = 0.72;
const SKY: f64 = 0.42;
const GROUND: f64 = 0.20;
/// Light that is left of the ground's own where the sun does not reach.
const GROUND_IN_SHADE: f64 = 0.80;

impl Light {
    pub(crate) fn new(eye: Vector3<f64>, shadow: Shadow) -> Self {
        Self { sun: Vector3::from(SUN).normalize(), eye, shadow }
    }

    /// The colour of a surface, as light and not as on a screen.
    pub(crate) fn colour(&self, place: &Vector3<f64>, normal: &Vector3<f64>, paint: &Paint) -> Rgb {
        let own = paint.rgb.map(to_light);
        if paint.glows {
            return own;
        }
        let view = (self.eye - place).normalize();
        // Both sides are seen: the surface faces whoever looks.
        let normal = if normal.dot(&view) < 0.0 { -normal } else { *normal };
        let facing = normal.dot(&self.sun).max(0.0);
        let lit = if facing > 0.0 { self.shadow.lit(&(place + 0.006 * normal)) } else { 0.0 };
        let up = 0.5 * (1.0 + normal.z);
        let fill = 0.12 * normal.dot(&view).max(0.0);
        let diffuse = SUNLIGHT * facing * lit + SKY * up + GROUND * (1.0 - up) + fill;
        let half = (self.sun + view).normalize();
        let sharp = 12.0 + 60.0 * paint.gloss;
        let glint = paint.gloss * (0.25 + 0.75 * lit) * normal.dot(&half).max(0.0).powf(sharp);
        // Surfaces seen at a slant reflect the sky.
        let slant = (1.0 - normal.dot(&view).clamp(0.0, 1.0)).powi(4);
        let sheen = 0.6 * glint + 0.25 * paint.gloss * slant * up;
        own.map(|own| own * diffuse + sheen)
    }

    /// The colour of the ground, on which nothing but shadows is seen.
    pub(crate) fn ground(&self, place: &Vector3<f64>, own: Rgb) -> Rgb {
        let lit = self.shadow.lit(place);
        own.map(|own| own * (GROUND_IN_SHADE + (1.0 - GROUND_IN_SHADE) * lit))
    }
}

/// From the screen's scale to light.
pub(crate) fn to_light(value: f64) -> f64 {
    value.clamp(0.0, 1.0).powf(2.2)
}

/// From light to the screen's scale, 0 to 255.
pub(crate) fn to_screen(light: f64) -> u8 {
    (255.0 * light.clamp(0.0, 1.0).powf(1.0 / 2.2)).round() as u8
}
