//! The simulated robot's topics and configuration.

use crate::{BaxterNode, Config, In, Out};
use config::Settings;
use manipulation::Limb;
use messages::Service;
use messages::Topic;
use messages::robot::{
    AssemblyState, Drill, EndEffectorCommand, EndEffectorProperties, EndEffectorState,
    EndpointState, JointCommand, JointState, JointTrajectoryPoint, SpeedRatio,
};
use messages::topics::robot;
use preflight::ArmSetup;
use service::bus::{Bus, BusError, PortError, Reader, WireMessage, Writer};
use service::exit::{Exit, Failure};
use service::lifecycle::Environment;
use service::service_loop::{Context, Program, Shell};

/// The simulated robot as a program.
#[derive(Debug)]
pub struct BaxterProgram;

impl Program for BaxterProgram {
    const SERVICE: Service = Service::Robot;
    const RECORD: Option<&'static str> = Some("baxter/2");
    const ABOUT: &'static str = "a simulated Baxter behind the robot's own topics\n\n\
         whichone-baxter DRILL [AMOUNT] has something happen to the one in $WHICHONE_GROUP:\n  \
         enable, disable, reset, press-estop, release-estop, fail,\n  \
         silence SECONDS, miss GRASPS, obstruct SECONDS";
    type Node = BaxterNode;
    type Shell = BaxterShell;

    fn config(_: &Environment, settings: &Settings) -> Result<Config, Failure> {
        let setup = ArmSetup::new(settings)
            .map_err(|problems| Failure::new(Exit::Config, problems.to_string()))?;
        let arm = &settings.arm;
        Ok(Config {
            robot: setup.robot,
            simulated: arm.simulated,
            grasp_error_m: arm.grasp.error_m,
            restock: arm.restock,
            scene: settings.scene.clone(),
        })
    }
}

/// The robot's side of its topics; pairs are left and right.
#[derive(Debug)]
pub struct BaxterShell {
    commands: [Reader<JointCommand>; 2],
    feed_forward: [Reader<JointTrajectoryPoint>; 2],
    ratios: [Reader<SpeedRatio>; 2],
    fingers: [Reader<EndEffectorCommand>; 2],
    drills: Reader<Drill>,
    joints: Writer<JointState>,
    assembly: Writer<AssemblyState>,
    endpoints: [Writer<EndpointState>; 2],
    grippers: [Writer<EndEffectorState>; 2],
    properties: [Writer<EndEffectorProperties>; 2],
}

impl Shell<BaxterNode> for BaxterShell {
    fn open(context: &Context<'_, In>) -> Result<Self, Failure> {
        let bus = context.bus;
        Ok(Self {
            commands: readers(bus, &robot::JOINT_COMMAND)?,
            feed_forward: readers(bus, &robot::INVERSE_DYNAMICS_COMMAND)?,
            ratios: readers(bus, &robot::SET_SPEED_RATIO)?,
            fingers: readers(bus, &robot::GRIPPER_COMMAND)?,
            drills: bus.reader(&robot::DRILL)?,
            joints: bus.writer(&robot::JOINT_STATES)?,
            assembly: bus.writer(&robot::STATE)?,
            endpoints: writers(bus, &robot::ENDPOINT_STATE)?,
            grippers: writers(bus, &robot::GRIPPER_STATE)?,
            properties: writers(bus, &robot::GRIPPER_PROPERTIES)?,
        })
    }

    fn drain(&mut self, take: &mut dyn FnMut(In)) -> Result<(), PortError> {
        self.drills.drain(|drill| take(In::Drill(*drill)))?;
        for limb in Limb::BOTH {
            self.ratios[limb].drain(|ratio| take(In::SpeedRatio(limb, *ratio)))?;
            self.commands[limb].drain(|command| take(In::Joints(limb, Box::new(*command))))?;
            self.feed_forward[limb].drain(|point| take(In::FeedForward(limb, Box::new(*point))))?;
            self.fingers[limb].drain(|command| take(In::Gripper(limb, Box::new(*command))))?;
        }
        Ok(())
    }

    fn publish(&mut self, output: Out) -> Result<(), PortError> {
        match output {
            Out::Joints(state) => self.joints.send(&state),
            Out::Assembly(state) => self.assembly.send(&state),
            Out::Endpoint(limb, state) => self.endpoints[limb].send(&state),
            Out::Gripper(limb, state) => self.grippers[limb].send(&state),
            Out::Properties(limb, own) => self.properties[limb].send(&own),
        }
    }
}

fn readers<T: WireMessage>(bus: &Bus, [l, r]: &[Topic; 2]) -> Result<[Reader<T>; 2], BusError> {
    Ok([bus.reader(l)?, bus.reader(r)?])
}

fn writers<T: WireMessage>(bus: &Bus, [l, r]: &[Topic; 2]) -> Result<[Writer<T>; 2], BusError> {
    Ok([bus.writer(l)?, bus.writer(r)?])
}
