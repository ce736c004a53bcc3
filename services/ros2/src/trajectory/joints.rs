//! Joint states as measurements of the arm's joints.

use ros::clock::StampClock;
use service::Time;
use trajectory_driver::JointMeasurement;

use crate::types::{JointState, Time as RosTime};

/// Reads joint states, which have the joints by name and in any order.
#[derive(Debug)]
pub struct JointReader {
    joints: Vec<String>,
    fingers: String,
    clock: StampClock,
    latest: Option<JointMeasurement>,
    /// The latest position of the fingers, which may come in messages of their own.
    finger_position: Option<f64>,
}

impl JointReader {
    /// Returns a reader of these joints, shoulder first, and of the joint of the fingers.
    pub fn new(joints: Vec<String>, fingers: String) -> Self {
        let clock = StampClock::default();
        Self { joints, fingers, clock, latest: None, finger_position: None }
    }

    /// Takes in a message. Returns whether it is a measurement of the arm: it has every joint, and finite positions.
    pub fn read(&mut self, message: &JointState, arrival: Time) -> bool {
        let place = |name: &str| message.name.iter().position(|own| own == name);
        let value = |values: &[f64], at: usize| values.get(at).copied().filter(|it| it.is_finite());
        let fingers = place(&self.fingers).and_then(|at| value(&message.position, at));
        self.finger_position = fingers.or(self.finger_position);
        let places: Option<Vec<usize>> = self.joints.iter().map(|name| place(name)).collect();
        let Some(places) = places else { return false };
        let q: Option<Vec<f64>> = places.iter().map(|at| value(&message.position, *at)).collect();
        let Some(q) = q else { return false };
        let at_ns = self.clock.map(nanoseconds(message.header.stamp), arrival).ns();
        let all = |values: &[f64]| -> Option<Vec<f64>> {
            places.iter().map(|at| value(values, *at)).collect()
        };
        let qd = all(&message.velocity).unwrap_or_else(|| self.differences(&q, at_ns));
        let effort = all(&message.effort).unwrap_or_else(|| vec![0.0; q.len()]);
        let fingers = self.finger_position;
        self.latest = Some(JointMeasurement { at_ns, q, qd, effort, fingers });
        true
    }

    /// Velocities of joints whose states have none.
    fn differences(&self, q: &[f64], at_ns: u64) -> Vec<f64> {
        let Some(before) = &self.latest else { return vec![0.0; q.len()] };
        let passed_s = at_ns.saturating_sub(before.at_ns) as f64 * 1e-9;
        if passed_s < 1e-4 {
            return before.qd.clone();
        }
        q.iter().zip(&before.q).map(|(now, then)| (now - then) / passed_s).collect()
    }

    /// Returns the latest measurement.
    pub fn latest(&self) -> Option<&JointMeasurement> {
        self.latest.as_ref()
    }

    /// Returns the controller's time for a time of this machine: its clock is the one that stamps joint states, and may be
    /// another one, or simulated. `None` before the first stamp.
    pub fn stamp(&self, at: Time) -> Option<RosTime> {
        let ns = u64::try_from(self.clock.stamp(at)?).ok()?;
        Some(RosTime::new(std::time::Duration::from_nanos(ns)))
    }
}

/// A stamp, ns; `None` if it is not set.
fn nanoseconds(stamp: RosTime) -> Option<i64> {
    let ns = i64::from(stamp.sec) * 1_000_000_000 + i64::from(stamp.nanosec);
    (stamp != RosTime::default()).then_some(ns)
}
