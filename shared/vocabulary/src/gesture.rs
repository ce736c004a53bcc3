//! Pointing gestures: directions, and the settings of their observation (`dialogue`).

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
}

/// A direction in space, in frame `base`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction([f64; 3]);

impl Direction {
    /// Returns the direction from one point to another (metres); `None` if they are less than a
    /// millimetre apart.
    pub fn between(from_m: [f64; 3], to_m: [f64; 3]) -> Option<Self> {
        let way = [to_m[0] - from_m[0], to_m[1] - from_m[1], to_m[2] - from_m[2]];
        let length = dot(way, way).sqrt();
        (length.is_finite() && length >= 1e-3).then(|| Self(way.map(|x| x / length)))
    }

    /// Returns the angle to another direction, radians from 0 to π. Exact at both ends, unlike the
    /// arc cosine.
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
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::Rng;

    /// Somewhere in a box of two metres round the origin.
    fn point(rng: &mut Rng) -> [f64; 3] {
        std::array::from_fn(|_| 4.0 * rng.uniform() - 2.0)
    }

    fn direction(rng: &mut Rng) -> Direction {
        loop {
            if let Some(direction) = Direction::between([0.0; 3], point(rng)) {
                return direction;
            }
        }
    }

    fn cases() -> impl Iterator<Item = (u64, Rng)> {
        (0..200).map(|seed| (seed, Rng::new(seed)))
    }

    #[test]
    fn angles_are_those_of_the_cosine_rule() {
        for (seed, mut rng) in cases() {
            let (a, b) = (direction(&mut rng), direction(&mut rng));
            let angle = a.angle(b);
            assert!((0.0..=PI).contains(&angle), "seed {seed}: {angle}");
            assert!((angle.cos() - dot(a.0, b.0)).abs() < 1e-12, "seed {seed}: {angle}");
            assert_eq!(angle, b.angle(a), "seed {seed}");
            assert!(a.angle(a) < 1e-7, "seed {seed}");
            let back = Direction(a.0.map(|x| -x));
            assert!((a.angle(back) - PI).abs() < 1e-7, "seed {seed}");
        }
    }

    #[test]
    fn what_has_no_direction_is_told() {
        assert_eq!(Direction::between([1.0; 3], [1.0; 3]), None);
        assert_eq!(Direction::between([0.0; 3], [f64::NAN, 0.0, 0.0]), None);
        let keys = |p_g, std_theta_rad, stray| -> Vec<_> {
            Gestures { p_g, std_theta_rad, stray }
                .check()
                .into_iter()
                .map(|fault| fault.0)
                .collect()
        };
        assert!(keys(0.1, 0.15, 0.05).is_empty());
        assert_eq!(keys(0.0, 1.5, 1.0), ["p_g", "std_theta_rad", "stray"]);
        assert_eq!(keys(f64::NAN, 0.0, f64::NAN), ["p_g", "std_theta_rad", "stray"]);
    }
}
