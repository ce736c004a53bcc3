//! A robot that outlives the process that moves it, and detects forbidden commands.

use crate::state::ArmState;
use crate::{Config, KinematicArm};
use arm_driver::{ArmDriver, Command, Fingers, Measured, Posture};
use manipulation::{Arm, ArmShape, Cuboid, Joints, Limb};
use messages::PickPhase;
use messages::pick::Pick;
use scene::Placement;
use std::cell::RefCell;
use std::rc::Rc;

/// A handle to the robot; clones are the same robot.
#[derive(Clone)]
pub(super) struct Robot(Rc<RefCell<Body>>);

struct Body {
    arm: KinematicArm,
    limbs: [Arm; 2],
    velocity_is_zero: bool,
    /// The objects in their places.
    objects: Vec<Cuboid>,
    /// Latest pick in the journal.
    durable: Option<Pick>,
    /// True if nothing moves but for a pick.
    only_picks: bool,
    /// True if the gripper can feel.
    feels: bool,
    /// True if the joints are measured to move.
    coasts: bool,
    /// True if what was held is lost.
    dropped: bool,
    /// Number of coming grasps that fail.
    misses: u32,
    /// True if the fingers were commanded to close.
    closing: bool,
    grasps: u32,
    wrongs: Vec<String>,
}

impl Robot {
    pub(super) fn at(state: &ArmState, config: &Config) -> Self {
        let places = config.scene.objects().iter().filter_map(|object| object.placement);
        let cuboid = |p: Placement| Cuboid { centre: p.xyz, size: p.size, yaw: p.yaw };
        Self(Rc::new(RefCell::new(Body {
            arm: KinematicArm::at(&config.start(state)),
            limbs: Limb::BOTH.map(|limb| config.setup.robot.arm(limb).clone()),
            velocity_is_zero: true,
            objects: places.map(cuboid).collect(),
            durable: state.pick,
            only_picks: false,
            feels: true,
            coasts: false,
            dropped: false,
            misses: 0,
            closing: false,
            grasps: 0,
            wrongs: Vec::new(),
        })))
    }

    pub(super) fn set_durable(&self, pick: Option<Pick>) {
        self.0.borrow_mut().durable = pick;
    }

    /// From here on nothing may move but for a pick that is durably moving.
    pub(super) fn expect_only_picks(&self) {
        self.0.borrow_mut().only_picks = true;
    }

    /// From here on its joints are measured to move, whatever is commanded; or no longer.
    pub(super) fn coast(&self, coasts: bool) {
        self.0.borrow_mut().coasts = coasts;
    }

    pub(super) fn lose_feeling(&self) {
        self.0.borrow_mut().feels = false;
    }

    /// What the grippers hold falls out of them.
    pub(super) fn drop_object(&self) {
        self.0.borrow_mut().dropped = true;
    }

    /// The next grasps find nothing.
    pub(super) fn miss(&self, times: u32) {
        self.0.borrow_mut().misses = times;
    }

    /// The robot's own controller halts it when its commander falls silent.
    pub(super) fn stand_still(&self) {
        self.0.borrow_mut().velocity_is_zero = true;
    }

    /// Somebody moves a limb at rest: every joint by `angle_rad`, towards the middle of its range.
    pub(super) fn push(&self, limb: Limb, angle_rad: f64) {
        let body = self.0.borrow();
        let mut q = body.arm.measured().posture.joints[limb];
        for (q, (lower, upper)) in q.iter_mut().zip(body.limbs[limb].limits.position.0) {
            *q += angle_rad.copysign(0.5 * (lower + upper) - *q);
        }
        drop(body);
        self.place(limb, q);
    }

    /// Somebody moves a limb at rest to a posture.
    pub(super) fn place(&self, limb: Limb, q: Joints) {
        let mut body = self.0.borrow_mut();
        let still = [0.0; 7];
        let command = Command { limb, q, qd: still, qdd: still, t_s: 0.0, fingers: Fingers::Stay };
        body.arm.command(&command, 0.0);
    }

    pub(super) fn posture(&self) -> Posture {
        self.0.borrow().arm.measured().posture
    }

    /// Returns the number of successful grasps.
    pub(super) fn grasps(&self) -> u32 {
        self.0.borrow().grasps
    }

    pub(super) fn assert_well_behaved(&self) {
        let wrongs = &self.0.borrow().wrongs;
        assert!(wrongs.is_empty(), "{} wrongs, the first: {}", wrongs.len(), wrongs[0]);
    }
}

impl ArmDriver for Robot {
    fn measured(&self) -> Measured {
        let body = self.0.borrow();
        let mut measured = body.arm.measured();
        if body.velocity_is_zero {
            measured.velocity = [[0.0; 7]; 2];
        }
        for holding in &mut measured.holding {
            *holding = holding.filter(|_| body.feels).map(|holds| holds && !body.dropped);
        }
        measured
    }

    fn is_still(&self) -> bool {
        !self.0.borrow().coasts
    }

    fn command(&mut self, command: &Command, seconds: f64) {
        let mut body = self.0.borrow_mut();
        let i = command.limb;
        let before = body.arm.measured();
        body.check(command, &before, seconds);
        let closes = matches!(command.fingers, Fingers::Grip(_));
        let mut command = *command;
        if let Fingers::Grip(grip) = &mut command.fingers
            && body.misses > 0
        {
            grip.offset_m = 1.0;
        }
        let opens = body.closing && !closes;
        body.misses = body.misses.saturating_sub(opens.into());
        body.closing = closes;
        body.arm.command(&command, seconds);
        body.velocity_is_zero = false;
        let after = body.arm.measured();
        body.grasps += u32::from(after.holding[i] == Some(true) && before.holding[i] != Some(true));
    }
}

impl Body {
    /// Limits are kept, and no motion of a pick comes before its durable phase.
    fn check(&mut self, command: &Command, before: &Measured, seconds: f64) {
        let from = &before.posture.joints[command.limb];
        let mut moved = false;
        let limits = self.limbs[command.limb].limits;
        let outside = |q: &Joints| {
            let clamped = limits.position.clamp(q);
            q.iter().zip(clamped).map(|(q, limit)| (q - limit).abs()).fold(0.0, f64::max)
        };
        // A joint that a person moved outside its limits only returns.
        if outside(&command.q) > outside(from) {
            self.wrongs.push(format!("outside the limits: {:?}", command.q));
        }
        for (j, (start, fastest)) in from.iter().zip(limits.velocity).enumerate() {
            let way = command.q[j] - start;
            moved |= way != 0.0;
            if way.abs() > fastest * seconds * (1.0 + 1e-9) + 1e-9 {
                self.wrongs.push(format!("joint {j} moved {way} rad in {seconds} s"));
            }
            if command.qd[j].abs() > fastest * (1.0 + 1e-9) {
                self.wrongs.push(format!("joint {j} at {} rad/s", command.qd[j]));
            }
        }
        self.check_clear(command);
        let Some(pick) = self.durable.filter(|pick| pick.phase != PickPhase::Done) else {
            if matches!(command.fingers, Fingers::Grip(_)) {
                self.wrongs.push("the fingers close and no pick is open".to_owned());
            }
            return;
        };
        let needed = match command.fingers {
            Fingers::Grip(_) if moved => PickPhase::Holding,
            Fingers::Grip(_) => PickPhase::Closing,
            Fingers::Stay | Fingers::Open(_) if self.only_picks => PickPhase::Moving,
            Fingers::Stay | Fingers::Open(_) => PickPhase::Accepted,
        };
        if pick.phase < needed {
            self.wrongs.push(format!("{command:?} in phase {:?}", pick.phase));
        }
    }

    /// The arm touches no object but the one that it fetches.
    fn check_clear(&mut self, command: &Command) {
        let shape = ArmShape::at(&self.limbs[command.limb], &command.q);
        let fetched = self.durable.map(|pick| pick.object.index());
        for (i, object) in self.objects.iter().enumerate().filter(|(i, _)| Some(*i) != fetched) {
            let gap = shape.to_cuboid("object", object, -TOUCH_M);
            if gap.is_some() {
                self.wrongs.push(format!("{gap:?} to object {i}"));
            }
        }
    }
}

/// Tolerated penetration of an object's box by the arm's capsules, metres: motions are
/// checked at intervals.
const TOUCH_M: f64 = 0.003;
