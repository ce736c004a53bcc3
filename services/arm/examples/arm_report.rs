//! Figures of the arm on this machine: what a pick of each object takes, how long its planning
//! holds up the main loop, and what an idle tick costs.
//! `cargo run --release -p arm --example arm_report [CONFIG_DIR [SCENE]]`.
#![expect(clippy::print_stdout, reason = "printing figures is what this example is for")]

use arm::shell::ArmProgram;
use arm::{ArmNode, In};
use config::Settings;
use messages::WireCode;
use messages::{ActKind, PickPhase, RobotAct};
use service::lifecycle::Environment;
use service::service_loop::Program;
use service::{Effects, Event, Node, Span, Time};
use std::path::Path;
use std::time::Instant;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().unwrap_or_else(|| "config".to_owned());
    let scene = arguments.next().map(|scene| ("group.scene".to_owned(), scene));
    let scene: Vec<_> = scene.into_iter().collect();
    let settings =
        Settings::load(Path::new(&folder), None, &scene).unwrap_or_else(|e| panic!("{e}"));
    for (i, object) in settings.scene.objects().iter().enumerate() {
        let (seconds, longest_ms) = fetch(&settings, i as u32);
        let phases: Vec<String> =
            seconds.iter().map(|(phase, s)| format!("{phase:?} {s:.2}")).collect();
        println!("{:8} {}; longest pass {longest_ms:.1} ms", object.name, phases.join(", "));
    }
    println!("idle tick {:.2} µs", idle(&settings));
}

fn start(settings: &Settings) -> ArmNode {
    let config = ArmProgram::config(&Environment::nowhere(), settings);
    let config = config.unwrap_or_else(|e| panic!("{e}"));
    let mut node = ArmNode::recover(config, Vec::new()).unwrap_or_else(|e| panic!("{e}"));
    node.on(Event::Started, Time(1), &mut Effects::default());
    node
}

/// When each phase of a pick began and when the arm was at rest again, simulated seconds, and the
/// longest pass of the main loop.
fn fetch(settings: &Settings, object: u32) -> (Vec<(PickPhase, f64)>, f64) {
    let mut node = start(settings);
    let kind = ActKind::Pick.code();
    let scene_key = settings.scene.key();
    let act = RobotAct {
        act: 1,
        interaction: 1,
        attempt: 1,
        scene_key,
        kind,
        object,
        ..RobotAct::default()
    };
    let mut effects = Effects::default();
    node.on(Event::Message(In::Act(Box::new(act))), Time(1), &mut effects);
    let (mut phases, mut longest_ms) = (Vec::new(), 0.0_f64);
    for tick in 0..6_000_u64 {
        let now = Time(1) + Span::from_ms(tick * 10);
        let begun = Instant::now();
        node.on(Event::Tick, now, &mut effects);
        longest_ms = longest_ms.max(begun.elapsed().as_secs_f64() * 1e3);
        effects.take_outputs();
        let phase = node.state().pick.map_or(PickPhase::Idle, |pick| pick.phase);
        if phases.last().is_none_or(|(last, _)| *last != phase) {
            phases.push((phase, tick as f64 * 0.01));
        }
        if effects.take_records().iter().any(|r| r.cause == arm::state::Cause::Rested) {
            phases.push((PickPhase::Idle, tick as f64 * 0.01));
            break;
        }
    }
    (phases, longest_ms)
}

/// Microseconds of a tick while nothing is to be done.
fn idle(settings: &Settings) -> f64 {
    let mut node = start(settings);
    let mut effects = Effects::default();
    let ticks = 100_000_u64;
    let begun = Instant::now();
    for tick in 1..=ticks {
        node.on(Event::Tick, Time(1) + Span::from_ms(tick * 10), &mut effects);
        effects.take_outputs();
    }
    begun.elapsed().as_secs_f64() * 1e6 / ticks as f64
}
