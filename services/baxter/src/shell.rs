//! The simulated robot's topics and configuration.

use crate::settings::Simulated;
use crate::{BaxterNode, Config, In, Out};
use baxter_driver::RobotSide;
use config::Settings;
use messages::robot::Drill;
use messages::topics::{self, robot};
use messages::{Service, Sighting};
use preflight::ArmSetup;
use service::bus::{EncodedWriter, PortError, Reader};
use service::exit::Failure;
use service::lifecycle::Environment;
use service::service_loop::{Context, Program, Shell};

/// The simulated robot as a program.
#[derive(Debug)]
pub struct BaxterProgram;

impl Program for BaxterProgram {
    const SERVICE: Service = Service::Robot;
    const RECORD: Option<&'static str> = Some("baxter/3");
    const ABOUT: &'static str = "a simulated Baxter behind the robot's own topics\n\n\
         whichone baxter DRILL has something happen to the one of the group:\n  \
         enable, disable, reset, press-estop, release-estop, fail,\n  \
         silence SECONDS, miss GRASPS, obstruct SECONDS,\n  \
         put OBJECT X Y [Z [YAW]] (a person puts an object there, metres and radians; on the table without Z),\n  \
         take OBJECT (a person takes it away)";
    type Node = BaxterNode;
    type Shell = BaxterShell;

    fn config(_: &Environment, settings: &Settings) -> Result<Config, Failure> {
        let setup = ArmSetup::new(settings)?;
        let (arm, simulated) = (&settings.arm, settings.part::<Simulated>()?);
        Ok(Config {
            robot: setup.robot,
            simulated,
            grasp_error_m: arm.grasp.error_m,
            restock: arm.restock,
            camera: simulated.camera,
            scene: settings.scene.clone(),
        })
    }
}

/// The robot's side of its topics.
#[derive(Debug)]
pub struct BaxterShell {
    topics: RobotSide,
    drills: Reader<Drill>,
    /// Where there is a camera.
    sightings: Option<EncodedWriter<Sighting>>,
}

impl Shell<BaxterNode> for BaxterShell {
    fn open(context: &Context<'_, In<'static>>) -> Result<Self, Failure> {
        let bus = context.bus;
        let camera = context.settings.part::<Simulated>()?.camera;
        let sightings = camera.map(|_| bus.encoded_writer(&topics::SIGHTING)).transpose()?;
        Ok(Self { topics: RobotSide::open(bus)?, drills: bus.reader(&robot::DRILL)?, sightings })
    }

    fn drain(&mut self, take: &mut dyn FnMut(In<'_>)) -> Result<(), PortError> {
        self.drills.drain(|drill| take(In::Drill(*drill)))?;
        self.topics.drain(|order| take(In::Order(order)))
    }

    fn publish(&mut self, output: Out) -> Result<(), PortError> {
        match output {
            Out::Report(report) => self.topics.send(&report),
            Out::Sighting(look) => self.sightings.as_ref().map_or(Ok(()), |it| it.send(&look)),
        }
    }
}
