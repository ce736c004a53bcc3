//! A simulated camera over simulated objects: with noise, misses, delay, and values that it
//! mistakes. Both the simulated Baxter and the simulation of the whole group have this one.

use std::collections::VecDeque;

use perception::{Change, Detection, Look, Sighting};
use scene::{Role, Scene, StableHash};
use vocabulary::Rng;
use vocabulary::time::{Span, Time};

/// Name under which the camera reports.
const SOURCE: &str = "simulated camera";

/// Settings of a simulated camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraSettings {
    /// Looks a second.
    pub rate_hz: f64,
    /// Standard deviation of each coordinate, metres.
    pub noise_m: f64,
    /// Share of the objects that a look does not show.
    pub misses: f64,
    /// Time from the exposure until the report.
    pub delay: Span,
    /// How sure it is of a quality, at least and at most: as often it is right.
    pub sure: (f64, f64),
    /// Distance from a gripper within which it sees no object, metres.
    pub hidden_m: f64,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// An object in front of a simulated camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// Index of the object in the scene file.
    pub object: usize,
    /// Centre, metres.
    pub xyz: [f64; 3],
    /// Rotation about the vertical, radians.
    pub yaw: f64,
}

/// Values by attribute, each with its probability.
type Values = Vec<(String, Vec<(String, f64)>)>;

/// A simulated camera.
#[derive(Clone, Debug)]
pub struct Camera {
    settings: CameraSettings,
    rng: Rng,
    next: Time,
    pending: VecDeque<(Time, Sighting)>,
}

impl Camera {
    /// Returns a camera that has not looked yet.
    pub fn new(settings: CameraSettings) -> Self {
        Self { rng: Rng::new(settings.seed), settings, next: Time(0), pending: VecDeque::new() }
    }

    /// Looks at the objects if a look is due, and returns the reports that are ready.
    pub fn look(
        &mut self,
        file: &Scene,
        standing: &[Standing],
        grippers: &[[f64; 3]],
        now: Time,
    ) -> Vec<Sighting> {
        if now >= self.next {
            self.next = now + Span::from_s(1.0 / self.settings.rate_hz);
            let sighting = self.expose(file, standing, grippers, now);
            self.pending.push_back((now + self.settings.delay, sighting));
        }
        let ready = self.pending.iter().take_while(|(at, _)| *at <= now).count();
        self.pending.drain(..ready).map(|(_, sighting)| sighting).collect()
    }

    fn expose(
        &mut self,
        file: &Scene,
        standing: &[Standing],
        grippers: &[[f64; 3]],
        now: Time,
    ) -> Sighting {
        let mut seen = Vec::new();
        for it in standing {
            let attributes = self.taken_for(file, it.object);
            let noise = [(); 3].map(|()| self.settings.noise_m * self.rng.normal());
            let is_missed = self.rng.uniform() < self.settings.misses;
            let is_hidden = grippers.iter().any(|gripper| {
                let off = (0..2).map(|axis| (gripper[axis] - it.xyz[axis]).powi(2)).sum::<f64>();
                off.sqrt() < self.settings.hidden_m
            });
            if is_missed || is_hidden {
                continue;
            }
            let name = &file.objects()[it.object].name;
            let variance = self.settings.noise_m * self.settings.noise_m;
            seen.push(Detection {
                track: String::new(),
                classes: vec![(name.clone(), 1.0)],
                attributes,
                xyz: std::array::from_fn(|axis| it.xyz[axis] + noise[axis]),
                yaw: it.yaw,
                variances: [variance, variance, variance, 0.0],
            });
        }
        let look = Look { at_ns: now.ns(), whole: true, seen };
        Sighting {
            key: now.ns(),
            source: SOURCE.to_owned(),
            frame: "base".to_owned(),
            change: Change::Look(look),
        }
    }

    /// The qualities of an object as the camera sees them: each with a probability with which it is
    /// the true one. It errs alike whenever it sees the object, also after a restart.
    fn taken_for(&self, file: &Scene, object: usize) -> Values {
        let object = &file.objects()[object];
        let mut seed = StableHash::default();
        seed.text(&object.name);
        let mut rng = Rng::new(self.settings.seed ^ seed.value());
        let (least, most) = self.settings.sure;
        let own = file.attributes().iter().zip(&object.values);
        own.filter_map(|(attribute, value)| {
            let truth = value.map(|v| v.index())?;
            let names = &attribute.values;
            if names.len() < 2 || names[truth].role() != Role::Quality {
                return None;
            }
            let sure = least + (most - least) * rng.uniform();
            let other = (truth + 1 + rng.below(names.len() - 1)) % names.len();
            let shown = if rng.uniform() < sure { truth } else { other };
            let rest = (1.0 - sure) / (names.len() - 1) as f64;
            let chance = |v: usize| if v == shown { sure } else { rest };
            let values = names.iter().enumerate().map(|(v, it)| (it.name.clone(), chance(v)));
            Some((attribute.name.clone(), values.collect()))
        })
        .collect()
    }
}
