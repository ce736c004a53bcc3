//! One joint's position over time, in stretches of constant jerk.

use rsruckig::prelude::{Profile, Trajectory as Profiles};

/// A stretch of constant jerk.
#[derive(Clone, Copy, Debug)]
struct Segment {
    /// Seconds since the start.
    time: f64,
    /// Position, velocity, half the acceleration and a sixth of the jerk as it begins.
    coefficients: [f64; 4],
}

/// One joint's motion.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    segments: Vec<Segment>,
    pub(super) duration_s: f64,
}

/// Excess over a joint's limits that counts as rounding, radians.
const ROUNDING_RAD: f64 = 1e-9;

impl Curve {
    /// Joint `j`'s profile; a joint that is there early waits.
    pub(super) fn of<const N: usize>(profiles: &Profiles<N>, j: usize) -> Self {
        let profile: &Profile = &profiles.profiles[0][j];
        let brake = &profile.brake;
        let mut segments = Vec::with_capacity(10);
        let mut time = 0.0;
        let mut add = |seconds: f64, p: f64, v: f64, a: f64, jerk: f64| {
            segments.push(Segment { time, coefficients: [p, v, a / 2.0, jerk / 6.0] });
            time += seconds;
        };
        for i in 0..2 {
            add(brake.t[i], brake.p[i], brake.v[i], brake.a[i], brake.j[i]);
        }
        for i in 0..7 {
            add(profile.t[i], profile.p[i], profile.v[i], profile.a[i], profile.j[i]);
        }
        add(0.0, profile.p[7], profile.v[7], profile.a[7], 0.0);
        Self { segments, duration_s: profiles.duration }
    }

    /// `from` and `way` times what this one does.
    pub(super) fn scaled(&self, from: f64, way: f64) -> Self {
        let scaled = |segment: &Segment| {
            let [c0, c1, c2, c3] = segment.coefficients.map(|c| c * way);
            Segment { time: segment.time, coefficients: [from + c0, c1, c2, c3] }
        };
        Self { segments: self.segments.iter().map(scaled).collect(), ..*self }
    }

    /// This one and then `next`.
    pub(super) fn then(mut self, next: &Self) -> Self {
        let begin_s = self.duration_s;
        self.segments.retain(|segment| segment.time < begin_s);
        let later = |segment: &Segment| Segment { time: segment.time + begin_s, ..*segment };
        self.segments.extend(next.segments.iter().map(later));
        self.duration_s += next.duration_s;
        self
    }

    /// Returns the same backwards.
    pub(super) fn reversed(&self) -> Self {
        let reversed = |(segment, seconds): (&Segment, f64)| {
            let [c0, c1, c2, c3] = segment.later(seconds);
            let time = self.duration_s - segment.time - seconds;
            Segment { time, coefficients: [c0, -c1, c2, -c3] }
        };
        let mut segments: Vec<Segment> = self.stretches().map(reversed).collect();
        segments.reverse();
        Self { segments, ..*self }
    }

    /// Returns the end position.
    pub(super) fn end(&self) -> f64 {
        self.cubic(self.duration_s, self.duration_s)[0]
    }

    /// Start times of its sections, seconds.
    pub(super) fn times(&self) -> impl Iterator<Item = f64> {
        self.segments.iter().map(|segment| segment.time)
    }

    /// Returns the cubic that holds at `within_s`, by the time since `start_s`.
    pub(super) fn cubic(&self, within_s: f64, start_s: f64) -> [f64; 4] {
        let after = self.segments.partition_point(|segment| segment.time <= within_s);
        let segment = &self.segments[after.saturating_sub(1)];
        segment.later(start_s - segment.time)
    }

    /// Returns whether it never leaves `lower..=upper`.
    pub(super) fn stays_within(&self, (lower, upper): (f64, f64)) -> bool {
        let within = |q: f64| (lower - ROUNDING_RAD..=upper + ROUNDING_RAD).contains(&q);
        self.stretches().all(|(segment, seconds)| {
            let turns = segment.turns().into_iter().filter(|dt| (0.0..=seconds).contains(dt));
            turns.chain([0.0, seconds]).all(|dt| within(segment.later(dt)[0]))
        })
    }

    /// Returns the stretches, each with how long it lasts, seconds.
    fn stretches(&self) -> impl Iterator<Item = (&Segment, f64)> {
        let ends = self.times().skip(1).chain([self.duration_s]);
        let lasting = self.segments.iter().zip(ends).map(|(s, end)| (s, end - s.time));
        lasting.filter(|(_, seconds)| *seconds > 0.0)
    }
}

impl Segment {
    /// Returns the same cubic from `dt` later on.
    fn later(&self, dt: f64) -> [f64; 4] {
        let [c0, c1, c2, c3] = self.coefficients;
        [
            c0 + dt * (c1 + dt * (c2 + dt * c3)),
            c1 + dt * (2.0 * c2 + dt * 3.0 * c3),
            c2 + 3.0 * dt * c3,
            c3,
        ]
    }

    /// Returns the time of zero velocity, seconds after the start; not a number if there is none.
    fn turns(&self) -> [f64; 2] {
        let [_, c1, c2, c3] = self.coefficients;
        if c3 == 0.0 {
            return [-c1 / (2.0 * c2), f64::NAN];
        }
        let root = (c2 * c2 - 3.0 * c1 * c3).sqrt();
        [(-c2 - root) / (3.0 * c3), (-c2 + root) / (3.0 * c3)]
    }
}
