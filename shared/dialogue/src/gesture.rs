//! The observation of a pointing gesture: the angular model of FETCH-POMDP (Whitney et al., 2017),
//! with a floor.
//!
//! A person who wants `D` points with probability `p_g`; the angle `θ` between the pointing ray and
//! the direction to `D`, both from where the person stands, is normal with standard deviation `σ`
//! and mean 0 (it has no sign, so the density is the half of it twice). Taken alone that model would
//! rule objects out for ever: at `σ = 0.15` a gesture one radian off weighs `e^-22`, which no
//! dialogue ever makes up for. But people wave, and trackers fail. So with probability `λ` a gesture
//! is *stray* and says nothing about `D`, its angle uniform on `[0, π]`:
//!
//! `P(g | D) = p_g · ((1 − λ) · 2/(σ√(2π)) · e^(−θ²/2σ²) + λ/π)`
//!
//! The largest weight of a gesture for one object against another is then
//! `1 + (1 − λ)/λ · √(2π)/σ`: 318 with the defaults, some more than one answer (99) and far less
//! than two (9801). `p_g` is the same for every object and moves no belief; it makes the factor a
//! probability.

use scene::Scene;

use crate::Fault;

/// The parameters of the observation of gestures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gestures {
    /// Probability `p_g` that a person points with an utterance; strictly between 0 and 1.
    pub p_g: f64,
    /// Standard deviation `σ` of the angle between pointing ray and object, radians; above 0, at
    /// most [`Gestures::STD_THETA_MAX`].
    pub std_theta_rad: f64,
    /// Probability `λ` that a gesture is stray; strictly between 0 and 1.
    pub stray: f64,
}

impl Default for Gestures {
    /// The predecessor's configuration; `λ` is of this design.
    fn default() -> Self {
        Self { p_g: 0.1, std_theta_rad: 0.15, stray: 0.05 }
    }
}

impl Gestures {
    /// Largest `σ`, radians. Up to it less than 0.2 % of the density lies beyond `π`, and a wider
    /// gesture would say nothing.
    pub const STD_THETA_MAX: f64 = 1.0;

    /// Every parameter that is out of range.
    pub fn check(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        let between = |p: f64| p > 0.0 && p < 1.0;
        if !between(self.p_g) {
            let what = format!("{} is not a probability", self.p_g);
            faults.push(("p_g", what, "use a number above 0 and below 1, e.g. 0.1"));
        }
        if !(self.std_theta_rad > 0.0 && self.std_theta_rad <= Self::STD_THETA_MAX) {
            let what = format!("{} is not a spread of pointing", self.std_theta_rad);
            faults.push(("std_theta_rad", what, "use radians above 0 and at most 1, e.g. 0.15"));
        }
        if !between(self.stray) {
            let what = format!("{} is not a share of stray gestures", self.stray);
            faults.push(("stray", what, "use a number above 0 and below 1, e.g. 0.05"));
        }
        faults
    }

    /// `ln P(g | D)` for every object, where `objects` are the directions to them from where the
    /// person stands. `ray` is the pointing ray; none: no gesture was seen, which has probability
    /// `1 − p_g` whatever is wanted.
    ///
    /// An object without a direction (it has no place, or is not here at all) is pointed at in any
    /// direction alike: angle uniform on `[0, π]`.
    pub fn log_likelihood(
        &self,
        ray: Option<Direction>,
        objects: &[Option<Direction>],
    ) -> Vec<f64> {
        let Some(ray) = ray else { return vec![(1.0 - self.p_g).ln(); objects.len()] };
        objects
            .iter()
            .map(|object| {
                let density = object.map_or(UNIFORM, |object| self.density(ray.angle(object)));
                (self.p_g * density).ln()
            })
            .collect()
    }

    /// Density of the angle between ray and wanted object, per radian.
    fn density(&self, theta: f64) -> f64 {
        let sigmas = theta / self.std_theta_rad;
        let peak = (2.0 / std::f64::consts::PI).sqrt() / self.std_theta_rad;
        (1.0 - self.stray) * peak * (-0.5 * sigmas * sigmas).exp() + self.stray * UNIFORM
    }
}

/// Density of an angle that is uniform on `[0, π]`, per radian.
const UNIFORM: f64 = std::f64::consts::FRAC_1_PI;

/// A direction in space, in frame `base`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction([f64; 3]);

impl Direction {
    /// From one point to another, metres; none where they are nearer to each other than a
    /// millimetre.
    pub fn between(from_m: [f64; 3], to_m: [f64; 3]) -> Option<Self> {
        let way = [to_m[0] - from_m[0], to_m[1] - from_m[1], to_m[2] - from_m[2]];
        let length = dot(way, way).sqrt();
        (length.is_finite() && length >= 1e-3).then(|| Self(way.map(|x| x / length)))
    }

    /// The angle to another direction, radians from 0 to π. Exact at both ends, where the cosine
    /// alone is flat.
    pub fn angle(self, other: Self) -> f64 {
        let ([a, b, c], [d, e, f]) = (self.0, other.0);
        let cross = [b * f - c * e, c * d - a * f, a * e - b * d];
        dot(cross, cross).sqrt().atan2(dot(self.0, other.0))
    }

    /// The directions from a place, metres, to every object of the scene that has one.
    pub fn to_objects(from_m: [f64; 3], scene: &Scene) -> Vec<Option<Self>> {
        let places = scene.objects().iter().map(|object| object.placement);
        places.map(|place| Self::between(from_m, place?.xyz)).collect()
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests;
