//! One limb's joints and the controller behind them.

use manipulation::{Joints, MotionLimits};

/// Seconds without a command after which a limb holds the position that it has:
/// `joint_command_timeout`.
pub const COMMAND_TIMEOUT_S: f64 = 0.2;
/// Initial share of its velocity that a limb may use.
pub const SPEED_RATIO: f64 = 0.3;
/// Maximum acceleration of a joint by its motor, rad/s².
const ACCELERATION_RAD_S2: f64 = 40.0;
/// Time step of the integration, seconds: the controller's own.
const STEP_S: f64 = 1e-3;

/// Latest command to a limb.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// Joint positions, radians.
    Position(Joints),
    /// Joint velocities, rad/s.
    Velocity(Joints),
}

/// A limb: seven joints that follow their command as critically damped second-order systems with
/// bounded velocity and acceleration. A command that moves steadily is followed `lag_s` late; one
/// whose velocity is fed forward without delay.
#[derive(Clone, Debug)]
pub struct Servo {
    /// Joint positions, radians.
    pub q: Joints,
    /// Joint velocities, rad/s.
    pub qd: Joints,
    limits: MotionLimits,
    lag_s: f64,
    speed_ratio: f64,
    hold: Joints,
    target: Option<Target>,
    /// Velocity of the commanded motion, rad/s.
    feed_forward: Joints,
    silent_s: f64,
    feed_silent_s: f64,
}

impl Servo {
    /// Returns a limb that stands at `q`, keeps `limits`, and follows with time constant `lag_s`.
    pub fn at(q: Joints, limits: &MotionLimits, lag_s: f64) -> Self {
        let still = [0.0; 7];
        Self {
            q,
            qd: still,
            limits: *limits,
            lag_s,
            speed_ratio: SPEED_RATIO,
            hold: q,
            target: None,
            feed_forward: still,
            silent_s: 0.0,
            feed_silent_s: 0.0,
        }
    }

    /// Handles a command.
    pub fn command(&mut self, target: Target) {
        (self.target, self.silent_s) = (Some(target), 0.0);
    }

    /// Takes the velocity of the commanded motion, rad/s.
    pub fn feed_forward(&mut self, velocity: &Joints) {
        (self.feed_forward, self.feed_silent_s) = (*velocity, 0.0);
    }

    /// Takes the share of its velocity that it may use, 0 to 1.
    pub fn set_speed_ratio(&mut self, ratio: f64) {
        if ratio.is_finite() {
            self.speed_ratio = ratio.clamp(0.0, 1.0);
        }
    }

    /// Brakes: stands still and drops its command.
    pub fn brake(&mut self) {
        (self.hold, self.qd, self.target) = (self.q, [0.0; 7], None);
        self.feed_forward = [0.0; 7];
    }

    /// Advances the time.
    pub fn advance(&mut self, seconds: f64) {
        let steps = (seconds / STEP_S).ceil().max(1.0);
        for _ in 0..steps as u32 {
            self.step(seconds / steps);
        }
    }

    fn step(&mut self, dt: f64) {
        self.silent_s += dt;
        self.feed_silent_s += dt;
        if self.silent_s > COMMAND_TIMEOUT_S && self.target.take().is_some() {
            self.hold = self.q;
        }
        // Velocities belong to the motion that is commanded now.
        if self.feed_silent_s > 0.03 {
            self.feed_forward = [0.0; 7];
        }
        let (goal, velocity) = match self.target {
            None => (self.hold, [0.0; 7]),
            Some(Target::Position(q)) => (q, self.feed_forward),
            Some(Target::Velocity(qd)) => {
                self.hold = std::array::from_fn(|j| self.hold[j] + qd[j] * dt);
                (self.hold, qd)
            }
        };
        if let Some(Target::Position(q)) = self.target {
            self.hold = q;
        }
        let omega = 2.0 / self.lag_s;
        for j in 0..7 {
            let fastest = self.speed_ratio * self.limits.velocity[j];
            let pull = omega * omega * (goal[j] - self.q[j]);
            let damp = 2.0 * omega * (velocity[j] - self.qd[j]);
            let a = (pull + damp).clamp(-ACCELERATION_RAD_S2, ACCELERATION_RAD_S2);
            self.qd[j] = (self.qd[j] + a * dt).clamp(-fastest, fastest);
            self.q[j] += self.qd[j] * dt;
        }
        let within = self.limits.position.clamp(&self.q);
        for (j, limit) in within.into_iter().enumerate() {
            if limit != self.q[j] {
                (self.q[j], self.qd[j]) = (limit, 0.0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use manipulation::{Limb, Robot};

    /// Returns a limb at rest, and where that is.
    fn resting(lag_s: f64) -> (Servo, Joints) {
        let arm = Robot::baxter().arm(Limb::Left);
        (Servo::at(arm.neutral, &arm.limits, lag_s), arm.neutral)
    }

    /// Follows a ramp of 0.5 rad/s for a second, and the error at its end.
    fn error_on_a_ramp(lag_s: f64, feed: bool) -> f64 {
        let (mut servo, mut goal) = resting(lag_s);
        servo.set_speed_ratio(1.0);
        for _ in 0..100 {
            goal[0] += 0.005;
            servo.command(Target::Position(goal));
            if feed {
                servo.feed_forward(&[0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
            }
            servo.advance(0.01);
        }
        goal[0] - servo.q[0]
    }

    #[test]
    fn ramp_is_tracked_with_lag_and_without_lag_by_feed_forward() {
        let late = error_on_a_ramp(0.08, false);
        assert!((late - 0.5 * 0.08).abs() < 0.004, "{late} rad");
        assert!(error_on_a_ramp(0.08, true).abs() < 0.01);
    }

    #[test]
    fn servo_holds_its_position_without_commands() {
        let (mut servo, mut goal) = resting(0.1);
        goal[3] += 1.0;
        servo.command(Target::Position(goal));
        servo.advance(0.19);
        let moving = servo.qd[3];
        servo.advance(0.3);
        let there = servo.q[3];
        servo.advance(1.0);
        assert!(moving > 0.3 && servo.qd[3].abs() < 1e-3);
        assert!((servo.q[3] - there).abs() < 0.02 && goal[3] - there > 0.5);
    }

    #[test]
    fn speed_ratio_bounds_the_velocity() {
        let (mut servo, mut goal) = resting(0.05);
        goal[0] = 1.5;
        for _ in 0..50 {
            servo.command(Target::Position(goal));
            servo.advance(0.01);
            assert!(servo.qd[0] <= 0.3 * 1.5 + 1e-12);
        }
        assert!(servo.qd[0] > 0.44);
    }

    #[test]
    fn servo_follows_commanded_velocity_and_stops_at_limits() {
        let (mut servo, _) = resting(0.05);
        servo.set_speed_ratio(1.0);
        for _ in 0..400 {
            servo.command(Target::Velocity([0.5; 7]));
            servo.advance(0.01);
        }
        assert!(servo.limits.position.within(&servo.q) && servo.q[0] > 1.69);
        servo.brake();
        let q = servo.q;
        servo.advance(0.5);
        assert!(q.iter().zip(&servo.q).all(|(a, b)| (a - b).abs() < 1e-9));
    }
}
