//! The kinematic model of a robot in a simulated world.

use arm_driver::{ArmDriver, Command, Configured, Driver, Fingers, Measured, Source, Start};
use manipulation::Limb;
use manipulation::gripper::{self, Gripper};

/// The driver that every arm has.
pub(crate) static DRIVER: Driver = Driver {
    about: &config::KINEMATIC,
    configure: |_, _| Ok(Configured::new(|start| Box::new(KinematicArm::at(start)))),
    connect: None,
    examine: None,
};

/// Distance of a joint from the neutral posture that still counts as rest, radians.
const ACCURACY_RAD: f64 = 1e-6;

/// The kinematic model: the joints follow commands exactly, the fingers move at their
/// speed, and a grip takes hold where [`gripper::catches`] says so.
#[derive(Clone, Debug)]
pub struct KinematicArm {
    measured: Measured,
    grippers: [Gripper; 2],
    /// Width at which each limb's closed fingers stop; none for open ones.
    grip: [Option<f64>; 2],
}

impl KinematicArm {
    /// Returns the arm as the journal left it.
    pub fn at(start: &Start<'_>) -> Self {
        let Start { robot, limb: _, posture, holding } = *start;
        let mut grip = [None; 2];
        if let Some(limb) = holding {
            grip[limb] = Some(posture.width_m[limb]);
        }
        let holding = grip.map(|grip| Some(grip.is_some()));
        let still = [[0.0; 7]; 2];
        let measured = Measured {
            posture,
            velocity: still,
            effort: still,
            holding,
            at: Source::Model,
            accuracy_rad: ACCURACY_RAD,
        };
        Self { measured, grippers: Limb::BOTH.map(|limb| robot.arm(limb).gripper), grip }
    }
}

impl ArmDriver for KinematicArm {
    fn checkpoint(&self) -> Option<Vec<u8>> {
        let Self { measured, grippers: _, grip } = self;
        postcard::to_stdvec(&(measured, grip)).ok()
    }

    fn resume(&mut self, checkpoint: &[u8]) -> Option<()> {
        (self.measured, self.grip) = postcard::from_bytes(checkpoint).ok()?;
        Some(())
    }

    fn measured(&self) -> Measured {
        self.measured
    }

    fn command(&mut self, command: &Command, seconds: f64) {
        let Self { measured, grippers, grip } = self;
        let i = command.limb;
        let own = &grippers[i];
        measured.posture.joints[i] = command.q;
        measured.velocity[i] = command.qd;
        let width_m = &mut measured.posture.width_m[i];
        let target_m = match command.fingers {
            Fingers::Stay => *width_m,
            Fingers::Open(target_m) => {
                grip[i] = None;
                target_m
            }
            // The object between the fingers is decided when they begin to close.
            Fingers::Grip(on) => *grip[i].get_or_insert_with(|| {
                let caught = gripper::catches(*width_m, on.object_m, on.offset_m);
                if caught { own.closed_on(on.object_m) } else { own.closed_m() }
            }),
        };
        let travel_m = gripper::SPEED_M_S * seconds;
        *width_m += (target_m - *width_m).clamp(-travel_m, travel_m);
        let closed = grip[i].is_some_and(|stop_m| *width_m <= stop_m + 1e-9);
        measured.holding[i] = Some(closed && own.holds(*width_m));
    }
}
