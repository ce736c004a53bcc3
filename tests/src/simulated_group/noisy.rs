//! A detector whose errors are independent from look to look, unlike those of the simulated camera.

use baxter::camera::Standing;
use messages::Sighting;
use perception::{Change, Detection, Look};
use scene::Scene;
use service::{Span, Time};
use vocabulary::Rng;

/// Time between two looks.
const EVERY: Span = Span::from_ms(100);
/// Share of the objects that a look misses.
const MISSES: f64 = 0.15;
/// Share of the detections with the class of another object.
const WRONG_CLASS: f64 = 0.05;
/// Share of the detections with a random colour.
const RANDOM_COLOR: f64 = 0.20;
/// Least and greatest score.
const SCORES: (f64, f64) = (0.35, 0.95);
/// Standard deviation of each coordinate, metres.
const NOISE_M: f64 = 0.005;
/// Horizontal distance from a gripper within which it sees nothing, metres.
const HIDDEN_M: f64 = 0.15;

/// A detector of classes and colours with independent errors and scores that say little.
#[derive(Clone, Debug)]
pub struct NoisyDetector {
    rng: Rng,
    next: Time,
}

impl NoisyDetector {
    /// Returns a detector that has not looked yet.
    pub fn new(seed: u64) -> Self {
        Self { rng: Rng::new(seed), next: Time(0) }
    }

    /// Looks at the objects if a look is due.
    pub(super) fn look(
        &mut self,
        file: &Scene,
        standing: &[Standing],
        grippers: &[[f64; 3]],
        now: Time,
    ) -> Vec<Sighting> {
        if now < self.next {
            return Vec::new();
        }
        self.next = now + EVERY;
        let is_visible = |it: &&Standing| {
            let off = |gripper: &[f64; 3]| {
                (0..2).map(|axis| (gripper[axis] - it.xyz[axis]).powi(2)).sum::<f64>().sqrt()
            };
            grippers.iter().all(|gripper| off(gripper) >= HIDDEN_M)
        };
        let mut seen = Vec::new();
        for it in standing.iter().filter(is_visible) {
            if self.rng.uniform() >= MISSES {
                seen.push(self.detect(file, it));
            }
        }
        let change = Change::Look(Look { at_ns: now.ns(), whole: true, seen });
        let (source, frame) = ("noisy detector".to_owned(), "base".to_owned());
        vec![Sighting { key: now.ns(), source, frame, change }]
    }

    fn detect(&mut self, file: &Scene, it: &Standing) -> Detection {
        let class = match self.rng.uniform() < WRONG_CLASS {
            true => {
                (it.object + 1 + self.rng.below(file.objects().len() - 1)) % file.objects().len()
            }
            false => it.object,
        };
        let k = file.attribute_named("color").expect("colours");
        let colors = &file.attributes()[k.index()].values;
        let color = match self.rng.uniform() < RANDOM_COLOR {
            true => self.rng.below(colors.len()),
            false => file.objects()[it.object].values[k.index()].expect("a colour").index(),
        };
        let noise = [(); 3].map(|()| NOISE_M * self.rng.normal());
        Detection {
            classes: vec![(file.objects()[class].name.clone(), self.score())],
            attributes: vec![(
                "color".to_owned(),
                vec![(colors[color].name.clone(), self.score())],
            )],
            xyz: std::array::from_fn(|axis| it.xyz[axis] + noise[axis]),
            yaw: it.yaw,
            ..Detection::default()
        }
    }

    fn score(&mut self) -> f64 {
        SCORES.0 + (SCORES.1 - SCORES.0) * self.rng.uniform()
    }
}
