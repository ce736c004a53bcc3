//! The simulated robot's topics and configuration.

use crate::{BaxterNode, Config, In};
use config::Settings;
use messages::Service;
use messages::robot::{Drill, Report};
use messages::topics::robot;
use preflight::ArmSetup;
use service::bus::{PortError, Reader};
use service::exit::{Exit, Failure};
use service::lifecycle::Environment;
use service::robot_topics::RobotSide;
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

/// The robot's side of its topics.
#[derive(Debug)]
pub struct BaxterShell {
    topics: RobotSide,
    drills: Reader<Drill>,
}

impl Shell<BaxterNode> for BaxterShell {
    fn open(context: &Context<'_, In<'static>>) -> Result<Self, Failure> {
        let bus = context.bus;
        Ok(Self { topics: RobotSide::open(bus)?, drills: bus.reader(&robot::DRILL)? })
    }

    fn drain(&mut self, take: &mut dyn FnMut(In<'_>)) -> Result<(), PortError> {
        self.drills.drain(|drill| take(In::Drill(*drill)))?;
        self.topics.drain(|order| take(In::Order(order)))
    }

    fn publish(&mut self, output: Report<'static>) -> Result<(), PortError> {
        self.topics.send(&output)
    }
}
