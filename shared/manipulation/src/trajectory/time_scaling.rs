//! Slowing a motion down to rest without leaving its curve: its own time `τ` passes more and more
//! slowly. With `x = τ̇²` and `u = τ̈`, a joint accelerates by `q″ x + q′ u`.

use crate::kinematics::limb::Joints;
use crate::trajectory::smoothed_trajectory::SmoothedTrajectory;

/// From here to the next tick the smoothed trajectory's time is slowed evenly.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tick {
    /// Seconds since the stop began.
    time: f64,
    /// Time of the smoothed trajectory, seconds.
    at: f64,
    /// Seconds of the smoothed trajectory per second.
    rate: f64,
    /// Change of the rate, 1/s.
    slowing: f64,
}

/// Time scaling of a smoothed trajectory that is being stopped.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TimeScaling {
    ticks: Vec<Tick>,
}

/// Steps of the smoothed trajectory's time in an even stop.
const STEPS: usize = 64;

/// Steps after which a stop that the limits all but forbid is made an even one.
const STEPS_MAX: usize = 16 * STEPS;

/// Seconds that count as no time.
const INSTANT_S: f64 = 1e-6;

impl TimeScaling {
    /// Stops `smoothed` at its time `at_s` as soon as the limits' stop decelerations allow; none if
    /// it stands there already.
    pub(crate) fn stopping(smoothed: &SmoothedTrajectory, at_s: f64) -> Option<Self> {
        let even_s = even_stop_s(smoothed, at_s);
        if even_s < INSTANT_S {
            return None;
        }
        let step = 0.5 * even_s / STEPS as f64;
        let mut now = Tick { time: 0.0, at: at_s, rate: 1.0, slowing: 0.0 };
        let mut ticks = Vec::with_capacity(2 * STEPS);
        let mut motion = smoothed.at(now.at);
        while ticks.len() < STEPS_MAX {
            let next = smoothed.at(now.at + step);
            let Some(slowing) = slowest(smoothed, &motion, &next, now.rate * now.rate, step) else {
                // No joint moves any more.
                ticks.push(Tick { rate: 0.0, ..now });
                return Some(Self { ticks });
            };
            now.slowing = slowing;
            ticks.push(now);
            let squared = now.rate * now.rate + 2.0 * now.slowing * step;
            if squared <= 0.0 {
                let seconds = now.rate / -now.slowing;
                let at = now.at + 0.5 * now.rate * seconds;
                ticks.push(Tick { time: now.time + seconds, at, rate: 0.0, slowing: 0.0 });
                return Some(Self { ticks });
            }
            let rate = squared.sqrt();
            let time = now.time + 2.0 * step / (now.rate + rate);
            now = Tick { time, at: now.at + step, rate, slowing: 0.0 };
            motion = next;
        }
        Some(Self::even(at_s, even_s))
    }

    /// Returns the same rate of slowing all the way.
    fn even(at_s: f64, seconds: f64) -> Self {
        let start = Tick { time: 0.0, at: at_s, rate: 1.0, slowing: -1.0 / seconds };
        let end = Tick { time: seconds, at: at_s + 0.5 * seconds, rate: 0.0, slowing: 0.0 };
        Self { ticks: vec![start, end] }
    }

    /// Seconds until it stands still.
    pub(crate) fn duration_s(&self) -> f64 {
        self.ticks.last().map_or(0.0, |tick| tick.time)
    }

    /// `q`, `q̇` and `q̈` of the stopping smoothed trajectory, `t_s` seconds after the stop began.
    pub(crate) fn at(&self, smoothed: &SmoothedTrajectory, t_s: f64) -> [Joints; 3] {
        let next = self.ticks.partition_point(|tick| tick.time <= t_s);
        let tick = self.ticks[next.saturating_sub(1)];
        let dt = (t_s - tick.time).max(0.0);
        let rate = (tick.rate + tick.slowing * dt).max(0.0);
        let at = tick.at + dt * (tick.rate + 0.5 * tick.slowing * dt);
        let [q, qd, qdd] = smoothed.at(if rate > 0.0 { at } else { tick.at });
        [
            q,
            qd.map(|v| v * rate),
            std::array::from_fn(|j| qdd[j] * rate * rate + qd[j] * tick.slowing),
        ]
    }
}

/// Seconds of an even stop that takes no joint beyond its stop deceleration, at constant speed.
fn even_stop_s(smoothed: &SmoothedTrajectory, at_s: f64) -> f64 {
    let qd = smoothed.at(at_s)[1];
    (0..7).map(|j| qd[j].abs() / stop_of(smoothed, j)).fold(0.0, f64::max)
}

/// Returns a joint's stop deceleration; never so little that its planned acceleration uses most of
/// it up.
fn stop_of(smoothed: &SmoothedTrajectory, j: usize) -> f64 {
    smoothed.limits().stop[j].max(2.0 * smoothed.limits().acceleration[j])
}

/// The least `u` at which no joint accelerates beyond its stop deceleration, neither as the step
/// begins at `x = squared` nor as it ends at `x + 2 u step`; none if no joint moves.
fn slowest(
    smoothed: &SmoothedTrajectory,
    [_, qd, qdd]: &[Joints; 3],
    [_, qd_end, qdd_end]: &[Joints; 3],
    squared: f64,
    step: f64,
) -> Option<f64> {
    let mut least = f64::NEG_INFINITY;
    for j in 0..7 {
        let limit = stop_of(smoothed, j);
        for (of_u, of_x) in [(qd[j], qdd[j]), (qd_end[j] + 2.0 * step * qdd_end[j], qdd_end[j])] {
            if of_u.abs() > 1e-9 {
                least = least.max((-limit - of_u.signum() * of_x * squared) / of_u.abs());
            }
        }
    }
    least.is_finite().then_some(least.min(0.0))
}
