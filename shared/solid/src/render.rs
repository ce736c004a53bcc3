//! From layers to pixels.

use nalgebra::Vector3;

use crate::camera::{Camera, Lens};
use crate::image::Image;
use crate::mesh::{Mesh, Rgb, Triangle};
use crate::shade::{Light, SUN, to_light, to_screen};
use crate::shadow::{Shadow, for_pixels};

/// Surfaces that are seen through alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// The surfaces. Within a layer the nearer hides the farther.
    pub mesh: Mesh,
    /// 1: solid, and throws shadows. Below: laid over the solid layers where it is not hidden by
    /// them, in the order of the list.
    pub opacity: f64,
}

/// What a picture is drawn on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet {
    /// Width and height, pixels.
    pub size: (usize, usize),
    /// Samples along either side of a pixel.
    pub samples: usize,
    /// The colour behind everything.
    pub ground: Rgb,
    /// Height of the ground that shadows fall on, metres.
    pub ground_z: f64,
}

/// Samples of what is seen.
struct Buffer {
    width: usize,
    height: usize,
    /// 1 / distance along the line of sight; 0 where nothing is.
    nearness: Vec<f32>,
    part: Vec<u32>,
    light: Vec<[f32; 3]>,
}

/// Number of what is not there among the parts.
const NOTHING: u32 = 0;
/// Number of the ground.
const GROUND: u32 = u32::MAX;
/// Half the side of the ground, metres.
const GROUND_SPAN: f64 = 6.0;
/// Relative difference of distance from which on an edge is drawn between parts.
const STEP: f32 = 0.004;
/// Light that is left on an edge.
const EDGE: f32 = 0.45;

/// Draws the layers as the camera sees them.
///
/// # Panics
/// If the sheet has no pixel or no sample.
pub fn render(layers: &[Layer], camera: &Camera, sheet: &Sheet) -> Image {
    let (width, height) = sheet.size;
    assert!(width > 0 && height > 0 && sheet.samples > 0, "{sheet:?} has no sample");
    let (wide, high) = (width * sheet.samples, height * sheet.samples);
    let lens = camera.lens(wide, high);
    let solid = || layers.iter().filter(|layer| layer.opacity >= 1.0);
    let triangles = || solid().flat_map(|layer| &layer.mesh.triangles);
    let casters = triangles().filter(|triangle| !triangle.paint.glows);
    let light = Light::new(camera.eye, Shadow::new(&Vector3::from(SUN), casters));
    let own = sheet.ground.map(to_light);
    let mut scene = Buffer::new(wide, high, own);
    scene.ground(sheet.ground_z, &lens, &light, own);
    triangles().for_each(|triangle| scene.draw(triangle, &lens, &light));
    scene.edges();
    for layer in layers.iter().filter(|layer| layer.opacity < 1.0) {
        let mut over = Buffer::new(wide, high, own);
        layer.mesh.triangles.iter().for_each(|triangle| over.draw(triangle, &lens, &light));
        over.edges();
        scene.lay_over(&over, layer.opacity as f32);
    }
    scene.image(sheet.samples)
}

impl Buffer {
    fn new(width: usize, height: usize, own: Rgb) -> Self {
        let count = width * height;
        let light = vec![own.map(|own| own as f32); count];
        Self { width, height, nearness: vec![0.0; count], part: vec![NOTHING; count], light }
    }

    fn draw(&mut self, triangle: &Triangle, lens: &Lens, light: &Light) {
        let Triangle { normals, paint, part, .. } = triangle;
        self.fill(&triangle.corners, lens, |place, weights, buffer, index| {
            let normal = blend(normals, weights).normalize();
            buffer.part[index] = *part;
            buffer.light[index] = light.colour(place, &normal, paint).map(|value| value as f32);
        });
    }

    /// The ground under everything.
    fn ground(&mut self, z: f64, lens: &Lens, light: &Light, own: Rgb) {
        // Small squares, so that those behind the camera can be left out.
        const SQUARES: i32 = 48;
        let at = |k: i32| GROUND_SPAN * f64::from(2 * k - SQUARES) / f64::from(SQUARES);
        for (i, j) in (0..SQUARES).flat_map(|i| (0..SQUARES).map(move |j| (i, j))) {
            let corner = |i, j| Vector3::new(at(i), at(j), z);
            let [a, b, c, d] =
                [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            for corners in [[a, b, c], [a, c, d]] {
                self.fill(&corners, lens, |place, _, buffer, index| {
                    buffer.part[index] = GROUND;
                    buffer.light[index] = light.ground(place, own).map(|value| value as f32);
                });
            }
        }
    }

    /// Calls for every sample at which the triangle is the nearest so far, with the place and the
    /// weights of the corners there.
    fn fill(
        &mut self,
        corners: &[Vector3<f64>; 3],
        lens: &Lens,
        mut paint: impl FnMut(&Vector3<f64>, &[f64; 3], &mut Self, usize),
    ) {
        let seen = corners.map(|corner| lens.project(&corner));
        let [Some(a), Some(b), Some(c)] = seen else { return };
        let near = [1.0 / a.2, 1.0 / b.2, 1.0 / c.2];
        let flat = [(a.0, a.1), (b.0, b.1), (c.0, c.1)];
        for_pixels(&flat, (self.width, self.height), |index, weights| {
            // Nearness is linear on the screen, places are not.
            let shares: [f64; 3] = std::array::from_fn(|n| weights[n] * near[n]);
            let nearness: f64 = shares.iter().sum();
            if nearness as f32 > self.nearness[index] {
                self.nearness[index] = nearness as f32;
                let weights = shares.map(|share| share / nearness);
                paint(&blend(corners, &weights), &weights, self, index);
            }
        });
    }

    /// Darkens the edges between bodies.
    fn edges(&mut self) {
        let differ = |a: usize, b: usize| {
            let (near, far) = (self.nearness[a], self.nearness[b]);
            // Where the ground ends nothing does.
            let bodies = [a, b].iter().any(|n| ![NOTHING, GROUND].contains(&self.part[*n]));
            bodies && self.part[a] != self.part[b] && (near - far).abs() > STEP * near.max(far)
        };
        let mut dark = vec![false; self.part.len()];
        for y in 0..self.height - 1 {
            for x in 0..self.width - 1 {
                let here = y * self.width + x;
                for next in [here + 1, here + self.width] {
                    if differ(here, next) {
                        let nearer = self.nearness[here] >= self.nearness[next];
                        dark[if nearer { here } else { next }] = true;
                    }
                }
            }
        }
        for (light, _) in self.light.iter_mut().zip(&dark).filter(|(_, dark)| **dark) {
            *light = light.map(|value| EDGE * value);
        }
    }

    /// Lays what another buffer shows over this one, where it is nearer.
    fn lay_over(&mut self, over: &Self, opacity: f32) {
        for index in 0..self.light.len() {
            if over.nearness[index] > self.nearness[index] {
                let (under, over) = (self.light[index], over.light[index]);
                self.light[index] =
                    std::array::from_fn(|n| under[n] + opacity * (over[n] - under[n]));
            }
        }
    }

    /// The mean of the samples of every pixel.
    fn image(&self, samples: usize) -> Image {
        let (width, height) = (self.width / samples, self.height / samples);
        let count = (samples * samples) as f32;
        let pixel = |n: usize| {
            let (x, y) = (n % width * samples, n / width * samples);
            let mut sum = [0.0_f32; 3];
            for row in y..y + samples {
                for light in &self.light[row * self.width + x..][..samples] {
                    sum = std::array::from_fn(|n| sum[n] + light[n]);
                }
            }
            sum.map(|sum| to_screen(f64::from(sum / count)))
        };
        Image { width, height, pixels: (0..width * height).map(pixel).collect() }
    }
}

fn blend(corners: &[Vector3<f64>; 3], weights: &[f64; 3]) -> Vector3<f64> {
    corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2]
}
