//! The jaw: closed with a limit of torque, and held with less than that, so that the servo's protection against
//! overload does not let go.

use arm_driver::Fingers;
use manipulation::gripper::Gripper;
use serde::{Deserialize, Serialize};
use service::{Span, Time};

use crate::settings::{Feetech, Opening, Torques};
use crate::traffic::Servo;

/// Speed of a commanded jaw, percent per second.
const SPEED: f64 = 60.0;
/// How far a goal may lie ahead of the jaw, percent.
const LEAD: f64 = 8.0;
/// How far the goal of a held object lies below it, percent.
const SQUEEZE: f64 = 2.5;
/// Speed below which the jaw stands, percent per second.
const STILL: f64 = 4.0;
/// Load from which the jaw presses on something, share of the greatest.
const PRESSES: f64 = 0.08;
/// Position below which closed fingers hold nothing, percent.
const CLOSED: f64 = 3.0;
/// Difference from a commanded position that counts as there, percent.
const THERE: f64 = 3.0;
/// A held object has slipped or given way if the jaw closes by more, percent: it nearly reaches its goal.
const SLIPPED: f64 = 1.8;
/// Parts of the curve of a jaw that turns: its width is 0.1 mm off between them.
const ARC_PARTS: i32 = 8;
/// Time for which it must stand, before its position means something.
const STEADY: Span = Span::from_ms(150);
/// Time after which a jaw that stands elsewhere will not go on.
const STUCK: Span = Span::from_ms(600);

/// The jaw and its latest order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Jaw {
    /// Percent and width, metres, ascending.
    curve: Vec<(f64, f64)>,
    /// Limits of torque, 0.1 %: closing or moving, holding.
    permille: [u16; 2],
    percent: Option<f64>,
    load: f64,
    steady_since: Option<Time>,
    aim: Aim,
    goal: Option<f64>,
    advanced: Time,
}

/// What the jaw does.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Aim {
    /// Nothing since this program has started: it may hold something.
    Unknown,
    /// It stays.
    Stay,
    /// It goes to a position, percent; since then.
    Go(f64, Time),
    /// It closes; since then.
    Grip(Time),
    /// It holds something at this position, percent.
    Holds(f64),
    /// It has closed on nothing.
    Closed,
}

impl Jaw {
    /// A jaw before its first reading; `holds` if it was left holding something.
    pub(crate) fn new(settings: &Feetech, gripper: &Gripper) -> Self {
        let Torques { grip_percent, hold_percent, .. } = settings.torque;
        let point = |Opening { percent, width_m }: &Opening| (*percent, *width_m);
        let curve = match settings.openings.is_empty() {
            true => arc(gripper)
                .unwrap_or_else(|| vec![(0.0, gripper.closed_m()), (100.0, gripper.open_m)]),
            false => settings.openings.iter().map(point).collect(),
        };
        Self {
            curve,
            permille: [grip_percent, hold_percent].map(|percent| (10.0 * percent) as u16),
            percent: None,
            load: 0.0,
            steady_since: None,
            aim: Aim::Unknown,
            goal: None,
            advanced: Time(0),
        }
    }

    pub(crate) fn on_servo(&mut self, servo: &Servo, now: Time) {
        (self.percent, self.load) = (Some(servo.value), servo.load);
        let stands = servo.speed.abs() < STILL;
        self.steady_since = if stands { self.steady_since.or(Some(now)) } else { None };
    }

    /// Width between the fingers, metres.
    pub(crate) fn width_m(&self) -> Option<f64> {
        self.percent.map(|percent| along(&self.curve, percent))
    }

    /// Takes a command to the fingers.
    pub(crate) fn want(&mut self, fingers: Fingers, now: Time) {
        let is_new = |aim: &Aim, to: f64| !matches!(aim, Aim::Go(goal, _) if *goal == to);
        match fingers {
            Fingers::Stay if matches!(self.aim, Aim::Go(..) | Aim::Grip(_)) => self.hold_here(),
            Fingers::Stay => {}
            Fingers::Open(width_m) => {
                let reversed: Vec<(f64, f64)> =
                    self.curve.iter().map(|(percent, width)| (*width, *percent)).collect();
                let to = along(&reversed, width_m);
                if is_new(&self.aim, to) {
                    (self.aim, self.steady_since) = (Aim::Go(to, now), None);
                }
            }
            Fingers::Grip(_) if matches!(self.aim, Aim::Grip(_) | Aim::Holds(_) | Aim::Closed) => {}
            Fingers::Grip(_) => (self.aim, self.steady_since) = (Aim::Grip(now), None),
        }
    }

    /// Stops in place; keeps hold of an object.
    pub(crate) fn hold_here(&mut self) {
        if !matches!(self.aim, Aim::Holds(_) | Aim::Unknown) {
            (self.aim, self.goal) =
                if self.grasps() { (Aim::Unknown, None) } else { (Aim::Stay, self.percent) };
        }
    }

    /// Forgets everything: its servo has let go.
    pub(crate) fn let_go(&mut self) {
        (self.aim, self.goal) = (Aim::Unknown, None);
    }

    /// Moves on to a time. Returns the goal, percent, and the limit of torque, 0.1 %; `None` before the first reading.
    pub(crate) fn advance(&mut self, now: Time) -> Option<(f64, u16)> {
        let percent = self.percent?;
        let seconds = now.since(self.advanced).s().min(0.05);
        self.advanced = now;
        self.judge(percent, now);
        let [moving, holding] = self.permille;
        let before = self.goal.unwrap_or(percent);
        let towards = |to: f64| {
            let next = before + (to - before).clamp(-SPEED * seconds, SPEED * seconds);
            next.clamp(percent - LEAD, percent + LEAD).clamp(0.0, 100.0)
        };
        let (goal, permille) = match self.aim {
            Aim::Unknown if self.presses() => ((percent - SQUEEZE).max(0.0), holding),
            Aim::Unknown | Aim::Stay | Aim::Closed => (before, moving),
            Aim::Go(to, _) => (towards(to), moving),
            Aim::Grip(_) => (towards(0.0), moving),
            Aim::Holds(at) => ((at - SQUEEZE).max(0.0), holding),
        };
        // A jaw that is still unknown keeps no goal of its own: its first command begins where it is.
        self.goal = Some(goal);
        Some((goal, permille))
    }

    fn judge(&mut self, percent: f64, now: Time) {
        let is_steady = self.stands_for(STEADY, now);
        match self.aim {
            Aim::Unknown if is_steady && self.presses() => self.aim = Aim::Holds(percent),
            Aim::Grip(_) if is_steady && percent <= CLOSED => self.aim = Aim::Closed,
            Aim::Grip(_) if is_steady && self.presses() => self.aim = Aim::Holds(percent),
            Aim::Grip(since) if self.stands_for(STUCK, now) && now.since(since) > STUCK => {
                self.aim = Aim::Closed
            }
            Aim::Holds(at) if percent < at - SLIPPED => self.aim = Aim::Grip(now),
            _ => {}
        }
    }

    /// It presses on something that keeps it open.
    fn presses(&self) -> bool {
        self.percent.is_some_and(|percent| percent > CLOSED) && self.load.abs() >= PRESSES
    }

    /// It presses, and stands: the load of a jaw that moves is that of its motion.
    fn grasps(&self) -> bool {
        self.presses() && self.steady_since.is_some()
    }

    fn stands_for(&self, span: Span, now: Time) -> bool {
        self.steady_since.is_some_and(|since| now.since(since) >= span)
    }

    /// Returns whether something is between the fingers; `None` while that is not known.
    pub(crate) fn holding(&self) -> Option<bool> {
        match self.aim {
            _ if self.percent.is_none() => None,
            Aim::Unknown => Some(self.presses()),
            Aim::Holds(_) => Some(true),
            Aim::Grip(_) => None,
            Aim::Stay | Aim::Go(..) | Aim::Closed => Some(false),
        }
    }

    /// Returns whether the jaw has completed its command.
    pub(crate) fn has_settled(&self, now: Time) -> bool {
        match (self.aim, self.percent) {
            (_, None) | (Aim::Grip(_), _) => false,
            (Aim::Go(to, _), Some(percent)) if (percent - to).abs() <= THERE => true,
            (Aim::Go(_, since), _) => self.stands_for(STUCK, now) && now.since(since) > STUCK,
            _ => true,
        }
    }

    /// Returns whether the jaw moves, or is not known yet to hold something or nothing.
    pub(crate) fn is_moving(&self) -> bool {
        self.percent.is_some() && (self.steady_since.is_none() || matches!(self.aim, Aim::Grip(_)))
    }
}

/// The curve of a jaw that turns: percent and width, metres, from closed to open. The recorded range of its servo is
/// the range of its joint in the robot's file, of which the open gripper uses a part. `None` for two fingers.
fn arc(gripper: &Gripper) -> Option<Vec<(f64, f64)>> {
    let jaw = gripper.jaw?;
    let ((closed_rad, end_rad), met_rad) = (jaw.range_rad, jaw.angle_rad(gripper.closed_m()));
    let percent = |angle: f64| 100.0 * (angle - closed_rad) / (end_rad - closed_rad);
    let mut curve: Vec<(f64, f64)> = Vec::new();
    for k in 0..=ARC_PARTS {
        let angle = met_rad + (jaw.open_rad() - met_rad) * f64::from(k) / f64::from(ARC_PARTS);
        let width_m = jaw.opening_m(angle);
        if curve.last().is_none_or(|(_, before)| *before < width_m) {
            curve.push((percent(angle), width_m));
        }
    }
    Some(curve)
}

/// The value at `x` of a curve through ascending points.
fn along(points: &[(f64, f64)], x: f64) -> f64 {
    let after = points.iter().position(|(at, _)| *at >= x);
    match after {
        Some(0) => points[0].1,
        None => points[points.len() - 1].1,
        Some(n) => {
            let ((x0, y0), (x1, y1)) = (points[n - 1], points[n]);
            y0 + (y1 - y0) * (x - x0) / (x1 - x0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{robot_of, settings};

    /// Moves to a width, and returns where the jaw's goal comes to rest, percent.
    fn goal_of(jaw: &mut Jaw, width_m: f64) -> f64 {
        let servo = |value| Servo { value, holds: true, ..Servo::default() };
        let mut goal = 0.0;
        for pass in 1..1000 {
            let now = Time(pass * 10_000_000);
            jaw.on_servo(&servo(goal), now);
            jaw.want(Fingers::Open(width_m), now);
            (goal, _) = jaw.advance(now).unwrap();
        }
        goal
    }

    #[test]
    fn jaw_that_turns_opens_to_its_angle_and_no_further() {
        let robot = robot_of("so101", &|text| text);
        let gripper = robot.arm(manipulation::Limb::Only).gripper;
        let turns = gripper.jaw.expect("a jaw");
        let mut jaw = Jaw::new(&settings(), &gripper);
        // The limits of the joint in the file.
        let percent = |angle: f64| 100.0 * (angle + 0.174533) / (1.74533 + 0.174533);
        let open = goal_of(&mut jaw, gripper.open_m);
        assert!((open - percent(turns.open_rad())).abs() < 1e-6 && open < 60.0, "{open} %");
        for width_m in [0.01, 0.02, 0.04] {
            let goal = goal_of(&mut jaw, width_m);
            let width = turns.opening_m(-0.174533 + 0.01 * goal * (1.74533 + 0.174533));
            assert!((width - width_m).abs() < 2e-4, "{width_m} m: {goal} %, {width} m");
            let shown_m = jaw.width_m().unwrap();
            assert!((shown_m - width_m).abs() < 2e-4, "{width_m} m: shown {shown_m} m");
        }
    }

    #[test]
    fn curve_of_the_jaw_is_followed_between_its_points_and_kept_at_its_ends() {
        let curve = [(0.0, 0.002), (10.0, 0.018), (50.0, 0.078)];
        for (percent, width_m) in
            [(-3.0, 0.002), (0.0, 0.002), (5.0, 0.010), (30.0, 0.048), (90.0, 0.078)]
        {
            assert!((along(&curve, percent) - width_m).abs() < 1e-12, "{percent} %");
        }
    }
}
