//! Behaviour of the robot on its topics: pure, so that the arm can be tested without processes.

use crate::assembly::Assembly;
use crate::camera::Camera;
use crate::fingers::{Event, Fingers};
use crate::object_world::{HandedOver, ObjectWorld, Whereabouts};
use crate::servo::{Servo, Target};
use crate::{Config, In, publish};
use manipulation::gripper::Gripper;
use manipulation::{Joints, Limb};
use messages::robot::{
    Drill, DrillKind, JointCommand, JointMode, JointTrajectoryPoint, Order, Report,
};
use perception::Sighting;
use serde::{Deserialize, Serialize};
use service::{Span, Time};
use std::collections::VecDeque;
use vocabulary::Rng;

/// Maximum time step.
const STRETCH_MAX: Span = Span::from_ms(100);
/// Number of recent drills kept, so that a repeated one takes effect once.
const DRILLS_MAX: usize = 32;
/// Joint distance from the neutral posture within which people put back what they took, radians.
const AT_REST_RAD: f64 = 0.05;

/// Durable state of the simulated world: joints, fingers and objects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// Key of the scene that the objects belong to.
    pub scene_key: u64,
    /// Joint positions, left and right, radians.
    pub joints: [Joints; 2],
    /// Its grippers, left and right.
    pub fingers: [Fingers; 2],
    /// Motors, faults and the red button.
    pub assembly: Assembly,
    /// Locations of the objects, in the scene's order.
    pub objects: Vec<Whereabouts>,
    /// The one that was handed over last; none for the others.
    pub handed_over: Vec<Option<HandedOver>>,
    /// Number of closings of the fingers.
    pub closings: u64,
}

/// The robot and the objects around it.
#[derive(Clone, Debug)]
pub struct Robot {
    pub(crate) config: Config,
    pub(crate) servos: [Servo; 2],
    pub(crate) fingers: [Fingers; 2],
    pub(crate) assembly: Assembly,
    pub(crate) random: Rng,
    /// No joint states before.
    pub(crate) silent_until: Time,
    objects: ObjectWorld,
    camera: Option<Camera>,
    closings: u64,
    /// Number of coming grasps that fail.
    misses: u64,
    obstructed_until: Time,
    drilled: VecDeque<u64>,
    now: Option<Time>,
}

impl Robot {
    /// Returns a robot in the neutral posture, or as `body` says.
    pub fn new(config: Config, body: Option<Body>) -> Self {
        let scene_key = config.scene.key();
        let body = body.unwrap_or_else(|| Body {
            scene_key,
            joints: Limb::BOTH.map(|limb| config.robot.arm(limb).neutral),
            fingers: Limb::BOTH.map(|limb| Fingers::open(&config.robot.arm(limb).gripper)),
            assembly: Assembly::new(config.simulated.enabled),
            objects: ObjectWorld::new(&config.scene).now,
            handed_over: ObjectWorld::new(&config.scene).handed_over,
            closings: 0,
        });
        let mut objects = ObjectWorld::new(&config.scene);
        if body.scene_key == scene_key && body.objects.len() == objects.now.len() {
            (objects.now, objects.handed_over) = (body.objects, body.handed_over);
        }
        Self {
            servos: Limb::BOTH.map(|limb| {
                let limits = &config.robot.arm(limb).limits;
                Servo::at(body.joints[limb], limits, config.simulated.lag_s)
            }),
            fingers: body.fingers,
            assembly: body.assembly,
            random: Rng::new(config.simulated.seed),
            silent_until: Time(0),
            objects,
            camera: config.camera.map(Camera::new),
            closings: body.closings,
            misses: 0,
            obstructed_until: Time(0),
            drilled: VecDeque::new(),
            now: None,
            config,
        }
    }

    /// Durable state.
    pub fn body(&self) -> Body {
        Body {
            scene_key: self.config.scene.key(),
            joints: [self.servos[0].q, self.servos[1].q],
            fingers: self.fingers.clone(),
            assembly: self.assembly,
            objects: self.objects.now.clone(),
            handed_over: self.objects.handed_over.clone(),
            closings: self.closings,
        }
    }

    /// The objects around it.
    pub fn objects(&self) -> &ObjectWorld {
        &self.objects
    }

    /// Handles a message.
    pub fn on_message(&mut self, message: &In<'_>, now: Time) {
        self.advance(now);
        match message {
            In::Drill(drill) => self.drill(drill, now),
            // What is switched off obeys nothing, and hears nothing either.
            _ if !self.assembly.is_enabled() => {}
            In::Order(order) => self.obey(order),
        }
    }

    fn obey(&mut self, order: &Order<'_>) {
        match order {
            Order::Joints(limb, command) => self.command(Limb::BOTH[*limb], command),
            Order::FeedForward(limb, point) => self.feed_forward(Limb::BOTH[*limb], point),
            Order::SpeedRatio(limb, ratio) => self.servos[*limb].set_speed_ratio(ratio.data),
            Order::Gripper(limb, command) => {
                let limb = Limb::BOTH[*limb];
                let gripper = self.gripper(limb);
                let event = self.fingers[limb].command(command, &gripper);
                event.into_iter().for_each(|event| self.react(limb, event));
            }
            // Of robots with messages of their own.
            Order::Own(_) => {}
        }
    }

    /// Advances the time to `now`.
    pub fn advance(&mut self, now: Time) {
        let before = self.now.replace(now).unwrap_or(now);
        let seconds = now.since(before).min(STRETCH_MAX).s();
        if seconds <= 0.0 {
            return;
        }
        let moves = self.assembly.is_enabled();
        for limb in Limb::BOTH {
            let servo = &mut self.servos[limb];
            if moves && now >= self.obstructed_until {
                servo.advance(seconds);
            } else {
                servo.brake();
            }
            let gripper = self.gripper(limb);
            if moves && let Some(event) = self.fingers[limb].advance(seconds, &gripper) {
                self.react(limb, event);
            }
        }
        if self.config.restock && self.config.robot.limbs().iter().all(|limb| self.rests(*limb)) {
            self.objects.restock();
        }
    }

    /// Returns the reports of cycle number `beat`, at a hundred a second.
    pub fn reports(&mut self, beat: u64, now: Time) -> Vec<Report<'static>> {
        publish::all(self, beat, now)
    }

    fn command(&mut self, limb: Limb, command: &JointCommand) {
        let target = JointMode::from_code(command.mode).and_then(|mode| {
            let joints = &self.config.robot.arm(limb).joint_names;
            let mut values = match mode {
                JointMode::Position => self.servos[limb].q,
                JointMode::Velocity => [0.0; 7],
            };
            for (name, value) in command.joints()? {
                let joint = joints.iter().position(|own| own == name).filter(|_| value.is_finite());
                if let Some(joint) = joint {
                    values[joint] = value;
                }
            }
            Ok(match mode {
                JointMode::Position => Target::Position(values),
                JointMode::Velocity => Target::Velocity(values),
            })
        });
        match target {
            Ok(target) => self.servos[limb].command(target),
            Err(error) => tracing::warn!(%error, "a joint command that makes no sense is ignored"),
        }
    }

    fn feed_forward(&mut self, limb: Limb, point: &JointTrajectoryPoint) {
        if point.velocities.iter().all(|v| v.is_finite()) {
            self.servos[limb].feed_forward(&point.velocities);
        }
    }

    fn react(&mut self, limb: Limb, event: Event) {
        // Topics know a left and a right limb; the only one has the left one's.
        let limb = self.config.robot.arm(limb).limb;
        let tip = self.config.robot.arm(limb).chain.forward(&self.servos[limb].q);
        let gripper = self.gripper(limb);
        match event {
            Event::Closes => {
                self.closings += 1;
                let missed = self.misses > 0;
                self.misses = self.misses.saturating_sub(1);
                let offset_m = self.placement_error_m();
                let opening_m = self.fingers[limb].width_m;
                let found =
                    self.objects.between(&tip, &gripper, opening_m, offset_m).filter(|_| !missed);
                self.fingers[limb].meet(found.map(|(_, width_m)| width_m));
            }
            Event::Holds => {
                if let Some((object, _)) = self.objects.between(&tip, &gripper, gripper.open_m, 0.0)
                {
                    self.objects.take(object, limb, &tip);
                }
            }
            Event::LetsGo => self.objects.let_go(limb, &tip),
        }
    }

    /// Returns the offset of the object from its place at this closing, metres.
    fn placement_error_m(&self) -> f64 {
        let mut random = Rng::new(self.config.simulated.seed ^ (self.closings << 32));
        self.config.grasp_error_m * random.normal()
    }

    fn drill(&mut self, drill: &Drill, now: Time) {
        let kind = drill.kind.get();
        if self.drilled.contains(&drill.key) {
            return;
        }
        if self.drilled.len() == DRILLS_MAX {
            self.drilled.pop_front();
        }
        self.drilled.push_back(drill.key);
        tracing::info!(?kind, amount = drill.amount, "drill");
        let until = now + Span::from_s(drill.amount);
        match kind {
            DrillKind::Silence => self.silent_until = until,
            DrillKind::Obstruct => self.obstructed_until = until,
            DrillKind::Miss => self.misses = drill.amount.max(0.0) as u64,
            DrillKind::Put | DrillKind::Take => self.change_by_hand(drill),
            _ => self.assembly.drill(kind),
        }
    }

    /// A person puts an object somewhere, or takes it away.
    fn change_by_hand(&mut self, drill: &Drill) {
        let object = usize::from(drill.object);
        let changed = match drill.kind.get() {
            _ if drill.scene_key != self.config.scene.key() => Err("it is of another scene"),
            DrillKind::Put => self.objects.put(object, drill.place),
            _ => self.objects.remove(object),
        };
        if let Err(why) = changed {
            tracing::warn!(object, why, "the object stays where it is");
        }
    }

    /// Returns what the camera reports at this moment, if there is a camera.
    pub fn look(&mut self, now: Time) -> Vec<Sighting> {
        let Some(camera) = &mut self.camera else { return Vec::new() };
        let tip = |limb: &Limb| {
            let chain = &self.config.robot.arm(*limb).chain;
            chain.forward(&self.servos[*limb].q).translation.vector.into()
        };
        let grippers: Vec<[f64; 3]> = self.config.robot.limbs().iter().map(tip).collect();
        camera.look(&self.config.scene, &self.objects.standing(), &grippers, now)
    }

    pub(crate) fn gripper(&self, limb: Limb) -> Gripper {
        self.config.robot.arm(limb).gripper
    }

    fn rests(&self, limb: Limb) -> bool {
        let q = &self.servos[limb].q;
        q.iter()
            .zip(&self.config.robot.arm(limb).neutral)
            .all(|(q, rest)| (q - rest).abs() < AT_REST_RAD)
    }
}
