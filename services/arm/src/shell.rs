//! The arm's topics and configuration.

use crate::state::Record;
use crate::{ArmNode, Config, In, Out, inspection, journal_record, kinematic};
use arm_driver::{Driver, Drivers, Port};
use config::Settings;
use diagnostics::Diagnostics;
use messages::{ArmStatus, JointStates, RobotAct, TableView, TrajectoryView, WorldView, topics};
use messages::{MotionOrder, Service};
use planner::PlannerThread;
use preflight::ArmSetup;
use service::bus::{EncodedReader, EncodedWriter, PortError, Reader, Writer};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::inspection::{Part, SharedFacts};
use service::journal_record::JournalRecord;
use service::lifecycle::Environment;
use service::service_loop::{Context, Program, Shell};
use service::stop_socket::{Caller, KeptStop, StopListener};
use service::{Span, Time, clock};
use std::marker::PhantomData;
use std::os::fd::BorrowedFd;

mod planner;

/// A longer time between two passes: orders may have been lost meanwhile, because the socket's queue is short.
const STOOD_STILL: Span = Span::from_ms(100);

/// The arm as a program with these drivers, beside the built-in one.
#[derive(Debug)]
pub struct ArmProgram<D>(PhantomData<D>);

impl<D: Drivers> Program for ArmProgram<D> {
    const SERVICE: Service = Service::Arm;
    const RECORD: Option<&'static str> = Some("arm/4");
    const ABOUT: &'static str =
        "fetches objects, puts them back, points at them, and stops on request";
    type Node = ArmNode;
    type Shell = ArmShell<D>;

    fn config(_: &Environment, settings: &Settings) -> Result<Config, Failure> {
        let setup = ArmSetup::new(settings)?;
        Ok(Config {
            arm: settings.arm.clone(),
            driver: (driver::<D>(settings)?.configure)(settings, &setup.robot)?,
            setup,
            scene: settings.scene.clone(),
            perceives: settings.group.perception.enabled,
        })
    }

    fn recorded_at(record: &Record) -> Time {
        record.at
    }

    fn describe(settings: &[Settings], record: &Record) -> String {
        inspection::line(journal_record::scene(settings, record), record)
    }

    fn explain(settings: &[Settings], record: &Record) -> Option<JournalRecord> {
        let scene = journal_record::scene(settings, record);
        Some(JournalRecord::Arm(Box::new(journal_record::explain(scene, record))))
    }

    fn verify(_: &[Settings], parts: &[Part<Record>]) -> Result<Vec<String>, Failure> {
        inspection::verify(parts)
    }

    fn shared_facts(parts: &[Part<Record>]) -> SharedFacts {
        inspection::shared_facts(parts)
    }
}

/// The configured driver.
fn driver<D: Drivers>(settings: &Settings) -> Result<&'static Driver, Diagnostics> {
    let others = D::LIST.iter().copied();
    arm_driver::named(std::iter::once(&kinematic::DRIVER).chain(others), settings)
}

/// The way to the robot, if the driver moves one.
fn connected<D: Drivers>(
    context: &Context<'_, In<'static>>,
) -> Result<Option<Box<dyn Port>>, Failure> {
    let settings = context.settings;
    let Some(connect) = driver::<D>(settings)?.connect else { return Ok(None) };
    let setup = ArmSetup::new(settings)?;
    connect(context.bus, settings, &setup.robot).map(Some)
}

/// The arm's topics and its planner.
#[derive(Debug)]
pub struct ArmShell<D> {
    acts: Reader<RobotAct>,
    status: Writer<ArmStatus>,
    joints: Writer<JointStates>,
    world: EncodedWriter<WorldView>,
    trajectory: EncodedWriter<TrajectoryView>,
    stop: StopListener,
    /// A stop that was given while no arm listened.
    kept_stop: Option<KeptStop>,
    paths: GroupPaths,
    /// Time of the latest pass.
    passed: Time,
    planner: PlannerThread,
    /// The way to a real robot.
    robot: Option<Box<dyn Port>>,
    drivers: PhantomData<D>,
    /// Where the objects come from perception.
    table: Option<EncodedReader<TableView>>,
}

impl<D> ArmShell<D> {
    /// Takes a stop that was kept while this service did not listen, before anything else moves the arm.
    fn look_for_kept_stop(&mut self, take: &mut dyn FnMut(In<'_>)) {
        match KeptStop::find(&self.paths) {
            Ok(Some(kept)) => {
                take(In::StopOrder(kept.order(), Caller::named(b"kept")));
                self.kept_stop = Some(kept);
            }
            Ok(None) => {}
            Err(error) => tracing::error!(%error, "kept stop not looked for"),
        }
    }
}

impl<D: Drivers> Shell<ArmNode> for ArmShell<D> {
    fn open(context: &Context<'_, In<'static>>) -> Result<Self, Failure> {
        let robot = connected::<D>(context)?;
        let (bus, paths) = (context.bus, &context.environment.paths);
        let perceives = context.settings.group.perception.enabled;
        let table = perceives.then(|| bus.encoded_reader(&topics::OBJECTS));
        let stop_failure = |error| Failure::file(&paths.stop_socket(), &error);
        Ok(Self {
            acts: bus.reader(&topics::ACT)?,
            status: bus.writer(&topics::STATUS)?,
            joints: bus.writer(&topics::JOINTS)?,
            world: bus.encoded_writer(&topics::WORLD)?,
            trajectory: bus.encoded_writer(&topics::TRAJECTORY)?,
            stop: StopListener::bind(paths).map_err(stop_failure)?,
            kept_stop: None,
            paths: paths.clone(),
            passed: Time(0),
            planner: PlannerThread::start(context.devices.clone())
                .map_err(|error| Failure::new(Exit::NotReached, error.to_string()))?,
            robot,
            drivers: PhantomData,
            table: table.transpose()?,
        })
    }

    fn drain_urgent(
        &mut self,
        is_readable: bool,
        take: &mut dyn FnMut(In<'_>),
    ) -> Result<(), PortError> {
        let now = clock::now();
        let (mut orders, stood_still) = (Vec::new(), now.since(self.passed) >= STOOD_STILL);
        self.passed = now;
        if is_readable {
            self.stop.drain(|order, caller| orders.push((order, caller)));
        }
        let releases = orders
            .iter()
            .any(|(order, _)| order.order == MotionOrder::Resume && order.given_ns > 0);
        if stood_still || releases {
            self.look_for_kept_stop(take);
        }
        orders.into_iter().for_each(|(order, caller)| take(In::StopOrder(order, caller)));
        Ok(())
    }

    fn urgent_fd(&self) -> Option<BorrowedFd<'_>> {
        Some(self.stop.fd())
    }

    fn drain(&mut self, take: &mut dyn FnMut(In<'_>)) -> Result<(), PortError> {
        self.kept_stop.take_if(KeptStop::pass);
        if let Some(table) = &mut self.table
            && let Some(view) = table.latest()?
        {
            take(In::Table(Box::new(view)));
        }
        self.acts.drain(|message| take(In::Act(message.into())))?;
        let mut robot = self.robot.iter_mut();
        robot.try_for_each(|robot| robot.drain(&mut |report| take(In::Robot(report))))
    }

    fn publish(&mut self, output: Out) -> Result<(), PortError> {
        match output {
            Out::Status(status) => self.status.send(&status),
            Out::Joints(joints) => self.joints.send(&joints),
            Out::World(world) => self.world.send(&world),
            Out::Trajectory(trajectory) => self.trajectory.send(&trajectory),
            Out::StopState(caller, state) => {
                self.stop.answer(&caller, &state);
                Ok(())
            }
            Out::Plan(request) => {
                self.planner.submit(request);
                Ok(())
            }
            Out::Robot(order) => self.robot.iter_mut().try_for_each(|robot| robot.send(&order)),
        }
    }
}
