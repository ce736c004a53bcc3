//! The bridge as a service of the group.

use crate::address::Address;
use crate::node::{Node, Topics};
use crate::publication::Publication;
use crate::settings::Ros1;
use crate::subscription::{Sink, Subscription};
use crate::{convert, detectors, guarded, types as ros};
use ::ros::clock::StampClock;
use ::ros::wire::{Message, RosTime, Unreadable};
use baxter_driver::RobotSide;
use config::Settings;
use messages::robot::{Order, Report};
use messages::topics::{self, robot};
use messages::{Service, Sighting, Topic};
use serde::{Deserialize, Serialize};
use service::bus::{EncodedWriter, PortError};
use service::exit::{Exit, Failure};
use service::lifecycle::Environment;
use service::service_loop::{Context, Program, Shell};
use service::worker_channel::DeviceSender;
use service::{Effects, Event, Never, NodeError, Time};
use std::sync::{Arc, Mutex};

/// Reports that wait for the main loop: one of each kind and, of joint states, of each set of joints.
const WAITING_MAX: usize = 32;

/// Returns whether a reader of the newest reports has no use for `old` beside `new`.
fn replaces(new: &Report<'_>, old: &Report<'_>) -> bool {
    match (new, old) {
        // Limbs and fingers come in messages of their own.
        (Report::Joints(new), Report::Joints(old)) => (new.len, new.name) == (old.len, old.name),
        (Report::Assembly(_), Report::Assembly(_)) => true,
        (Report::Endpoint(new, _), Report::Endpoint(old, _))
        | (Report::Gripper(new, _), Report::Gripper(old, _))
        | (Report::Properties(new, _), Report::Properties(old, _)) => new == old,
        _ => false,
    }
}

/// Inputs of the bridge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum In {
    /// Something that is to be passed on.
    Pass(Out),
    /// A report waits.
    Arrived,
    /// Another node has taken our place at the master.
    Replaced,
}

/// Outputs of the bridge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Out {
    /// To the group.
    Report(Report<'static>),
    /// To the robot, with the time when the arm sent it.
    Order(Order<'static>, Time),
    /// Objects, to the group.
    Sighting(Box<Sighting>),
}

/// The bridge as a reducer: everything is passed on, nothing is decided.
#[derive(Debug)]
pub struct Bridge;

impl service::Node for Bridge {
    type Config = ();
    type In<'a> = In;
    type Out = Out;
    type Record = Never;

    fn recover((): (), _: Vec<Never>) -> Result<Self, NodeError> {
        Ok(Self)
    }

    fn on(&mut self, event: Event<In>, _: Time, fx: &mut Effects<Out, Never>) {
        match event {
            Event::Message(In::Pass(out)) => fx.publish(out),
            Event::Message(In::Replaced) | Event::Shutdown => fx.exit(),
            Event::Message(In::Arrived) | Event::Started | Event::Tick | Event::SetAside(_) => {}
        }
    }

    fn deadline(&self) -> Option<Time> {
        None
    }
}

/// The bridge as a program.
#[derive(Debug)]
pub struct Ros1Program;

impl Program for Ros1Program {
    const SERVICE: Service = Service::Robot;
    const RECORD: Option<&'static str> = None;
    const RECORDS_FLIGHTS: bool = false;
    const ABOUT: &'static str =
        "whichone-ros1, the bridge to a Baxter's ROS 1 topics (docs/baxter.md)";
    type Node = Bridge;
    type Shell = BridgeShell;

    fn config(_: &Environment, _: &Settings) -> Result<(), Failure> {
        Ok(())
    }
}

/// Reports on their way from the connections to the main loop.
#[derive(Debug)]
struct Waiting {
    reports: Mutex<Vec<Report<'static>>>,
    sightings: Mutex<Vec<Sighting>>,
    wake: DeviceSender<In>,
}

impl Waiting {
    /// Hands over a report in place of the one before.
    fn put(&self, report: Report<'static>) -> Result<(), Unreadable> {
        let mut reports = guarded(&self.reports);
        if let Some(old) = reports.iter_mut().find(|old| replaces(&report, old)) {
            *old = report;
            return Ok(());
        }
        if reports.len() == WAITING_MAX {
            return Err(Unreadable("too many different reports wait".to_owned()));
        }
        reports.push(report);
        // Where the channel is full the loop has yet to look.
        let _ = self.wake.offer(In::Arrived);
        Ok(())
    }

    /// Hands over a sighting in place of the one before of its source.
    fn put_sighting(&self, sighting: Sighting) {
        let mut sightings = guarded(&self.sightings);
        match sightings.iter_mut().find(|old| old.source == sighting.source) {
            Some(old) => *old = sighting,
            None => sightings.push(sighting),
        }
        let _ = self.wake.offer(In::Arrived);
    }
}

/// The bridge's topics on both sides; pairs are left and right.
#[derive(Debug)]
pub struct BridgeShell {
    topics: RobotSide,
    sightings: EncodedWriter<Sighting>,
    waiting: Arc<Waiting>,
    robot: ToRobot,
    _node: Node,
}

/// The topics of the robot that the bridge publishes.
#[derive(Debug)]
struct ToRobot {
    joints: [Arc<Publication>; 2],
    feed_forward: [Arc<Publication>; 2],
    ratios: [Arc<Publication>; 2],
    fingers: [Arc<Publication>; 2],
}

impl ToRobot {
    fn new() -> Self {
        Self {
            joints: publications::<ros::JointCommand>(&robot::JOINT_COMMAND),
            feed_forward: publications::<ros::JointTrajectoryPoint>(
                &robot::INVERSE_DYNAMICS_COMMAND,
            ),
            ratios: publications::<ros::Float64>(&robot::SET_SPEED_RATIO),
            fingers: publications::<ros::EndEffectorCommand>(&robot::GRIPPER_COMMAND),
        }
    }

    fn all(&self) -> Vec<Arc<Publication>> {
        let Self { joints, feed_forward, ratios, fingers } = self;
        [joints, feed_forward, ratios, fingers].into_iter().flatten().cloned().collect()
    }

    fn send(&self, order: &Order<'_>, made: Time) -> Result<(), Unreadable> {
        match order {
            Order::Joints(limb, command) => {
                self.joints[*limb].publish(&convert::joint_command(command)?, made);
            }
            Order::FeedForward(limb, point) => {
                self.feed_forward[*limb].publish(&convert::trajectory_point(point), made);
            }
            Order::SpeedRatio(limb, ratio) => {
                self.ratios[*limb].publish(&convert::speed_ratio(ratio), made);
            }
            Order::Gripper(limb, command) => {
                self.fingers[*limb].publish(&convert::gripper_command(command)?, made);
            }
            // Of robots with messages of their own.
            Order::Own(_) => {}
        }
        Ok(())
    }
}

/// The robot's name of a topic of the group.
fn ros_name(topic: &Topic) -> String {
    format!("/{}", topic.name)
}

fn publications<M: Message>([left, right]: &[Topic; 2]) -> [Arc<Publication>; 2] {
    [left, right].map(|topic| Arc::new(Publication::new::<M>(&ros_name(topic))))
}

/// A subscription that hands over what `convert` makes of each message and the time when it was made.
fn subscription<M: Message + 'static>(
    topic: &Topic,
    waiting: &Arc<Waiting>,
    stamp: fn(&M) -> Option<RosTime>,
    convert: impl Fn(&M, Time) -> Result<Report<'static>, Unreadable> + Clone + Send + Sync + 'static,
) -> Arc<Subscription> {
    let waiting = Arc::clone(waiting);
    let sink = move || -> Sink {
        let (mut clock, waiting, convert) =
            (StampClock::default(), Arc::clone(&waiting), convert.clone());
        Box::new(move |bytes, arrival| {
            let message = M::from_bytes(bytes)?;
            let made = clock.map(stamp(&message).and_then(RosTime::ns), arrival);
            waiting.put(convert(&message, made)?)
        })
    };
    Arc::new(Subscription::new::<M>(&ros_name(topic), sink))
}

fn subscriptions(waiting: &Arc<Waiting>) -> Vec<Arc<Subscription>> {
    let mut all = vec![
        subscription::<ros::JointState>(
            &robot::JOINT_STATES,
            waiting,
            |state| Some(state.header.stamp),
            |state, made| Ok(Report::Joints(convert::joint_state(state, made)?.into())),
        ),
        subscription::<ros::AssemblyState>(
            &robot::STATE,
            waiting,
            |_| None,
            |state, _| Ok(Report::Assembly(convert::assembly_state(state))),
        ),
    ];
    for limb in [0, 1] {
        all.push(subscription::<ros::EndpointState>(
            &robot::ENDPOINT_STATE[limb],
            waiting,
            |state| Some(state.header.stamp),
            move |s, made| Ok(Report::Endpoint(limb, convert::endpoint_state(s, made).into())),
        ));
        all.push(subscription::<ros::EndEffectorState>(
            &robot::GRIPPER_STATE[limb],
            waiting,
            |state| Some(state.timestamp),
            move |s, made| Ok(Report::Gripper(limb, convert::gripper_state(s, made).into())),
        ));
        all.push(subscription::<ros::EndEffectorProperties>(
            &robot::GRIPPER_PROPERTIES[limb],
            waiting,
            |_| None,
            move |own, _| Ok(Report::Properties(limb, convert::gripper_properties(own).into())),
        ));
    }
    all
}

impl Shell<Bridge> for BridgeShell {
    fn open(context: &Context<'_, In>) -> Result<Self, Failure> {
        let settings: Ros1 = context.settings.part()?;
        let address = Address::new(&settings, |name| std::env::var(name).ok());
        let address = address.map_err(|error| Failure::new(Exit::Config, error))?;
        let wake = context.devices.clone();
        let (reports, sightings) = (Mutex::default(), Mutex::default());
        let waiting = Arc::new(Waiting { reports, sightings, wake: wake.clone() });
        let seen = Arc::clone(&waiting);
        let take: detectors::Take = Arc::new(move |sighting| seen.put_sighting(sighting));
        let mut subscribed = subscriptions(&waiting);
        subscribed.extend(detectors::subscriptions(&settings.objects, context.settings, &take));
        let to_robot = ToRobot::new();
        let topics = Topics { published: to_robot.all(), subscribed };
        Ok(Self {
            topics: RobotSide::open(context.bus)?,
            sightings: context.bus.encoded_writer(&topics::SIGHTING)?,
            waiting,
            robot: to_robot,
            _node: Node::start(address, topics, move |reason| {
                crate::replaced(reason);
                wake.send(In::Replaced);
            }),
        })
    }

    fn drain(&mut self, take: &mut dyn FnMut(In)) -> Result<(), PortError> {
        let reports = std::mem::take(&mut *guarded(&self.waiting.reports));
        reports.into_iter().for_each(|report| take(In::Pass(Out::Report(report))));
        let sightings = std::mem::take(&mut *guarded(&self.waiting.sightings));
        sightings.into_iter().for_each(|it| take(In::Pass(Out::Sighting(Box::new(it)))));
        self.topics.newest(|order, made| take(In::Pass(Out::Order(order, made))))
    }

    fn publish(&mut self, output: Out) -> Result<(), PortError> {
        match output {
            Out::Report(report) => self.topics.send(&report),
            Out::Sighting(sighting) => {
                // The next look replaces it; the robot must not suffer from it.
                if let Err(error) = self.sightings.send(&sighting) {
                    tracing::debug!(%error, "a sighting is dropped");
                }
                Ok(())
            }
            Out::Order(order, made) => {
                if let Err(error) = self.robot.send(&order, made) {
                    tracing::error!(%error, "a command is not sent to the robot");
                }
                Ok(())
            }
        }
    }
}
