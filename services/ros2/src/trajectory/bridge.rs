//! The bridge as a service of the group: one loop, in which nothing waits.

use std::ops::ControlFlow;
use std::process::ExitCode;

use config::Settings;
use messages::Service;
use scene::StableHash;
use service::bus::{EncodedReader, EncodedWriter, WakeListener};
use service::client::Client;
use service::exit::{Exit, Failure};
use service::lifecycle::{Cycle, Environment, Health, Lifecycle, Ready, Sources, drive};
use service::{Span, Time, clock, service_loop};
use trajectory_driver::{
    ArmOrder, BRIDGE, Condition, ControllerReport, Controllers, ORDERS, REPORTS,
};

use super::actions::Identity;
use super::controller::{Controller, Facts};
use super::dds::{Domain, Losses};
use super::fingers::FingerController;
use super::joints::JointReader;
use super::types::Tolerances;
use crate::dds::opening::Opening;
use crate::process::{ThreadWatch, limit_memory};
use crate::settings::Ros2;

/// Longest sleep. Joint states and orders wake the bridge; answers of the controllers do not.
const LOOK_EVERY: Span = Span::from_ms(10);
/// Shortest interval of two reports.
const REPORT_EVERY: Span = Span::from_ms(5);
/// Longest interval of two reports.
const REPEAT_EVERY: Span = Span::from_ms(100);
/// Time for which the end of this process waits for arm and fingers to come to rest.
const END_WITHIN: Span = Span::from_ms(1_000);

/// Runs the service until it is shut down.
pub fn run() -> ExitCode {
    let about = "carries the arm's trajectories to controllers of ros2_control (docs/robots.md)";
    service_loop::program(BRIDGE, about, serve)
}

fn serve(arguments: Vec<String>) -> Result<(), Failure> {
    let environment = Environment::read(arguments)?;
    limit_memory()?;
    // Before the DDS implementation starts threads, which a signal would end.
    let lifecycle = Lifecycle::begin(&environment.paths)?;
    let settings = Settings::load_snapshot(&environment.paths.run())?;
    let mut bridge = Bridge::open(&environment, &settings)?;
    drive(lifecycle, &mut bridge)
}

struct Bridge {
    domain: Domain,
    client: Client,
    wake_listener: WakeListener,
    orders: EncodedReader<ArmOrder>,
    reports: EncodedWriter<ControllerReport>,
    order: Option<ArmOrder>,
    joints: JointReader,
    controller: Controller,
    fingers: FingerController,
    losses: Losses,
    report: ControllerReport,
    reported: Time,
    threads: ThreadWatch,
    condition: Option<Condition>,
    /// Since when this process is to end.
    ending: Option<Time>,
}

impl Bridge {
    fn open(environment: &Environment, settings: &Settings) -> Result<Self, Failure> {
        let (ros2, own): (Ros2, Controllers) = (settings.part()?, settings.part()?);
        let names = trajectory_driver::joint_names(settings, &own)?;
        let client = Client::of_service(environment, BRIDGE)?;
        let bus = client.bus();
        let failed = |error: String| Failure::new(Exit::NotReached, error);
        let opening = Opening::join(&ros2, &format!("{}_arm", ros2.node)).map_err(failed)?;
        let domain = Domain::open(opening, &own).map_err(failed)?;
        let began = clock::now();
        let mut group = StableHash::default();
        group.bytes(environment.paths.name().as_str().as_bytes());
        let identity = Identity::new(group.value(), began);
        let tolerances = Tolerances {
            path_rad: own.path_tolerance_rad,
            goal_rad: own.goal_tolerance_rad,
            goal_time_s: own.goal_time_s,
        };
        tracing::info!(domain_id = ros2.domain_id, action = own.action, "joined the DDS domain");
        Ok(Self {
            domain,
            wake_listener: bus.wake_listener(Service::Other(BRIDGE))?,
            orders: bus.encoded_reader(&ORDERS)?,
            reports: bus.encoded_writer(&REPORTS)?,
            client,
            order: None,
            joints: JointReader::new(names.clone(), own.gripper.joint.clone()),
            controller: Controller::new(names, tolerances, own.still_rad_s, identity.clone()),
            fingers: FingerController::new(identity),
            losses: Losses::default(),
            report: ControllerReport::default(),
            reported: Time(0),
            threads: ThreadWatch::begin(began),
            condition: None,
            ending: None,
        })
    }

    /// Takes in orders, joint states and answers.
    fn take_in(&mut self) -> Result<(), Failure> {
        self.domain.arrivals.clear();
        if let Some(order) = self.orders.latest()? {
            self.order = Some(order);
        }
        let now = clock::now();
        let Self { domain, joints, losses, .. } = self;
        domain.joint_states.drain(&mut losses.unreadable, |message, _| {
            joints.read(&message, now);
        });
        for answer in domain.arm.answers(losses) {
            self.controller.on_answer(answer, now);
        }
        for answer in domain.gripper.answers(losses) {
            self.fingers.on_answer(answer, now);
        }
        Ok(())
    }

    /// Decides, and sends what was decided.
    fn act(&mut self, now: Time) {
        let facts = Facts {
            order: self.order.as_ref(),
            joints: self.joints.latest(),
            is_ending: self.ending.is_some(),
            now,
        };
        for request in self.controller.decide(&facts, |at| self.joints.stamp(at)) {
            self.domain.arm.send(request, &mut self.losses);
        }
        let order = self.order.as_ref().and_then(|order| order.fingers);
        let stops = self.controller.stops_fingers(&facts);
        for request in self.fingers.decide(order, stops, now) {
            self.domain.gripper.send(request, &mut self.losses);
        }
    }

    fn condition(&mut self, now: Time) -> Condition {
        let condition = match self.controller.condition(now) {
            Condition::Ready if !self.fingers.is_ready(now) => Condition::NoGripper,
            condition => condition,
        };
        if self.condition.replace(condition) != Some(condition) {
            tracing::info!(?condition, losses = ?self.losses, "controllers");
        }
        condition
    }

    fn report(&mut self, now: Time) -> Result<(), Failure> {
        let (accepted, ended, stopped) = self.controller.facts();
        let report = ControllerReport {
            joints: self.joints.latest().cloned(),
            condition: self.condition(now),
            accepted,
            ended,
            stopped,
            fingers: self.fingers.end(),
        };
        let age = now.since(self.reported);
        if age < REPORT_EVERY || report == self.report && age < REPEAT_EVERY {
            return Ok(());
        }
        (self.report, self.reported) = (report, now);
        Ok(self.reports.send(&self.report)?)
    }
}

impl Cycle for Bridge {
    fn listener(&self) -> &WakeListener {
        &self.wake_listener
    }

    fn wake(&self, now: Time) -> (Sources<'_>, Time) {
        ([Some(self.domain.arrivals.fd()), None, None], now + LOOK_EVERY)
    }

    fn shut_down(&mut self) {
        self.ending = Some(clock::now());
    }

    fn pass(&mut self, ready: Ready) -> Result<ControlFlow<()>, Failure> {
        if ready.by_wake
            && let Some(joined) = self.wake_listener.take()
        {
            self.client.bus().connect(joined);
        }
        self.take_in()?;
        let now = clock::now();
        self.act(now);
        self.report(now)?;
        self.threads.count(now)?;
        let is_stopping = self.controller.is_stopping() || self.fingers.is_stopping();
        let ends = self.ending.is_some_and(|since| !is_stopping || now.since(since) > END_WITHIN);
        Ok(if ends { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }

    fn health(&mut self, _now: Time) -> Health {
        Health::Working(None)
    }
}
