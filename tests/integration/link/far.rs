//! A robot on another machine, behind a slow network that loses packets and breaks.

use config::Settings;
use messages::MotionOrder;
use serde_json::{Value, json};
use service::control::{Reply, Request, call};
use service::group::GroupPaths;
use service::status::ServiceState;
use service::{Span, stop_socket};
use std::fmt::Write;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use whichone_tests::console::{Page, Visitor};
use whichone_tests::link::{Mirror, Relay};
use whichone_tests::shortage::JointWatch;
use whichone_tests::slow_network::{Conditions, Network};
use whichone_tests::{Group, wait_for};

use super::check_accepted;
use crate::console_voice::{ALOUD, Stream, said};

/// Cuts while the dialogues go on, seconds.
const CUTS_S: [u64; 2] = [10, 25];
/// Time over which the cost of a link is measured.
const COST_OVER: Duration = Duration::from_secs(20);
/// Spoken requests here and there.
const SPOKEN: u32 = 12;
/// Level above which a sample is of a word.
const LOUD: u16 = 300;
/// Bar of a stop: two round trips and 50 ms.
const STOP_BAR_MS: f64 = 250.0;

fn conditions() -> Conditions {
    let delay = Duration::from_millis(50);
    // The queue holds what the line carries in 131 ms.
    Conditions { delay, loss: 0.01, rate: 2_000_000, queue: 32 << 10 }
}

/// A number from the environment, which `scripts/link namespaces` sets.
fn wanted(name: &str, usual: usize) -> usize {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// Lines of the table: what, and how much.
#[derive(Default)]
struct Table(Vec<(String, String)>);

impl Table {
    fn row(&mut self, what: &str, how_much: impl Into<String>) {
        self.0.push((what.to_owned(), how_much.into()));
    }

    fn text(&self) -> String {
        let width = self.0.iter().map(|(what, _)| what.chars().count()).max().unwrap_or(0);
        let mut text = String::new();
        for (what, how_much) in &self.0 {
            writeln!(text, "| {what:width$} | {how_much} |").unwrap();
        }
        text
    }
}

/// The value below which `share` of the samples lie.
fn percentile(samples: &[f64], share: f64) -> f64 {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = (share * sorted.len().saturating_sub(1) as f64).round() as usize;
    sorted.get(place).copied().unwrap_or(f64::NAN)
}

/// `50 / 60 / 70 ms of 100`: median, 99th percentile and greatest.
fn spread(samples: &[f64]) -> String {
    let [p50, p99, most] = [0.5, 0.99, 1.0].map(|share| percentile(samples, share));
    format!("{p50:.0} / {p99:.0} / {most:.0} ms of {}", samples.len())
}

#[test]
#[ignore = "needs root, TUN devices and whichone-link: scripts/link namespaces"]
fn dialogues_stops_and_speech_over_a_slow_network() {
    let network = Network::new(conditions());
    let mut table = Table::default();
    let Conditions { delay, loss, rate, queue } = conditions();
    table.row(
        "network",
        format!(
            "{} ms each way, {} % loss, {} Mbit/s, queue of {} KiB",
            delay.as_millis(),
            loss * 100.0,
            rate / 1_000_000,
            queue >> 10
        ),
    );
    network.operator.run(|| {
        let relay = Relay::at(network.operator.address, &["--robot", "r1", "--operator", "ann"]);
        let far = Far { network: &network, relay };
        println!("cost of the link, and dialogues");
        far.dialogues(&mut table);
        println!("{}stops", table.text());
        far.stops(&mut table);
        println!("{}speech", table.text());
        far.speech(&mut table);
    });
    println!("\n{}", table.text());
}

struct Far<'a> {
    network: &'a Network,
    relay: Relay,
}

impl Far<'_> {
    fn robot_up(&self, settings: &[&str]) -> Group {
        self.network.robot.run(|| self.relay.robot_up("r1", settings))
    }

    fn mirror(&self) -> Mirror {
        Mirror::start_with_console("r1", &self.relay.person("ann"))
    }

    /// What the link costs the robot, in this time: processor and bytes.
    fn cost(&self, robot: &Group, what: &str, table: &mut Table) {
        let pid = robot.pid("link").as_raw_nonzero().get();
        let (before, sent) = (cpu_s(pid), self.network.sent());
        std::thread::sleep(COST_OVER);
        let seconds = COST_OVER.as_secs_f64();
        let cpu = (cpu_s(pid) - before) / seconds;
        let [from, to] = [0, 1].map(|side| {
            let bytes = self.network.sent()[side] - sent[side];
            bytes as f64 * 8.0 / 1e3 / seconds
        });
        table.row(
            &format!("link of the robot, {what}"),
            format!(
                "{:.1} % of a core, {:.1} MiB, {from:.1} kbit/s from and {to:.1} kbit/s to the robot",
                cpu * 100.0,
                resident_mib(pid)
            ),
        );
    }

    fn dialogues(&self, table: &mut Table) {
        let count = wanted("WHICHONE_LINK_DIALOGUES", 100);
        let robot = self.robot_up(&[]);
        self.cost(&robot, "nobody watches", table);
        let mirror = self.mirror();
        self.cost(&robot, "a mirror watches, arm at rest", table);
        let paths = mirror.group.paths();
        let scene = Settings::load_snapshot(&paths.run()).unwrap().scene;
        let objects: Vec<&str> =
            scene.objects().iter().map(|object| object.name.as_str()).collect();
        let answers = Probe::of(&mirror.group);
        let (mut right, mut again, mut seconds) = (0, 0, Vec::new());
        let mut recoveries = Vec::new();
        std::thread::scope(|scope| {
            let mut cuts = Vec::new();
            for number in 0..count {
                let is_cut_now = |cut: usize| number == (cut + 1) * count / (CUTS_S.len() + 1);
                if let Some(cut) = (0..CUTS_S.len()).find(|cut| is_cut_now(*cut)) {
                    cuts.push(scope.spawn(move || self.cut(CUTS_S[cut], paths)));
                    // In the middle of the dialogue, not before it.
                    std::thread::sleep(Duration::from_millis(200));
                }
                let wanted = objects[number % objects.len()];
                let began = Instant::now();
                let (object, repeats) = fetch(&mirror.group, wanted);
                assert_eq!(object, wanted, "dialogue {number}");
                right += 1;
                again += repeats;
                seconds.push(began.elapsed().as_secs_f64() * 1e3);
            }
            recoveries.extend(cuts.into_iter().map(|cut| cut.join().unwrap()));
        });
        table.row("right picks", format!("{right} of {count}"));
        table.row("requests made again after a cut, as the robot had given up", again.to_string());
        for (cut, back) in CUTS_S.iter().zip(recoveries) {
            table.row(&format!("shown again after a cut of {cut} s"), format!("{back:.1} s"));
        }
        table.row("the page answers, meanwhile", answers.end());
        table.row("a dialogue (fast arm), p50 / p99 / most", spread(&seconds));
        let applied = wait_for("the same dialogue here and there", 20.0, || {
            let here = mirror.group.dialogue()["applied"].as_u64();
            (here == robot.dialogue()["applied"].as_u64()).then_some(here).flatten()
        });
        check_accepted(&robot, applied);
        table.row("utterances applied, each once", applied.to_string());
        robot.verify_journals();
        table.row("journals", "verified");
        mirror.down();
        robot.down();
    }

    /// Cuts the network; returns the seconds from its end until the mirror shows the robot again.
    fn cut(&self, seconds: u64, paths: &GroupPaths) -> f64 {
        self.network.cut(Duration::from_secs(seconds));
        let began = Instant::now();
        wait_for("a robot that is shown again", 60.0, || {
            let asked = call(&paths.control_socket(), &Request::Status, Duration::from_secs(2));
            let Ok(Reply::Status(status)) = asked else { return None };
            let is_link = |service: &&service::status::ServiceStatus| service.name == "link";
            let link = status.services.iter().find(is_link)?;
            (link.state == ServiceState::Ready).then_some(())
        });
        began.elapsed().as_secs_f64()
    }

    fn stops(&self, table: &mut Table) {
        let count = wanted("WHICHONE_LINK_STOPS", 100);
        let robot = self.robot_up(&["arm.time_scale=1"]);
        let mirror = self.mirror();
        let joints = JointWatch::open(&robot);
        let stops = Stops { robot: &robot, mirror: &mirror.group, joints, count };
        stops.measure("free", table);
        let load = self.network.fill();
        // Until the queues are full.
        std::thread::sleep(Duration::from_secs(3));
        let (received, began) = (load.received(), Instant::now());
        stops.measure("full", table);
        let bits = (load.received() - received) as f64 * 8.0 / 1e6;
        let rate = bits / began.elapsed().as_secs_f64();
        table.row("other connections meanwhile, both ways", format!("{rate:.1} Mbit/s"));
        drop(load);
        mirror.down();
        robot.down();
    }

    fn speech(&self, table: &mut Table) {
        let robot = self.robot_up(&ALOUD);
        let mirror = self.mirror();
        let words = said("get me the bowl", 0.0);
        let here = self.network.robot.run(|| replies(&robot, &words));
        let there = replies(&mirror.group, &words);
        let what = "end of speech to the first sound of the question";
        table.row(&format!("{what}, page of the robot"), spread(&here));
        table.row(&format!("{what}, page of the mirror"), spread(&there));
        mirror.down();
        robot.down();
    }
}

/// Asks for the object until it is brought: a robot that has heard nothing for long has given up. Returns what was brought,
/// and how often the request was made again.
fn fetch(mirror: &Group, wanted: &str) -> (String, usize) {
    for repeats in 0..5 {
        mirror.must(&["say", "get me the bowl", "--timeout", "50"]);
        let outcome = mirror.await_pick(Some(wanted));
        if let Some(object) = outcome["object"].as_str() {
            assert_eq!(outcome["outcome"], "delivered", "{outcome}");
            return (object.to_owned(), repeats);
        }
    }
    panic!("{wanted} is not brought");
}

/// Stops at the mirror of a moving arm.
struct Stops<'a> {
    robot: &'a Group,
    mirror: &'a Group,
    joints: JointWatch,
    count: usize,
}

impl Stops<'_> {
    fn measure(&self, network: &str, table: &mut Table) {
        let (mut rest_ms, mut confirmed_ms) = (Vec::new(), Vec::new());
        while rest_ms.len() < self.count {
            self.start_pick();
            while rest_ms.len() < self.count && self.is_moving() {
                let order = || {
                    let began = Instant::now();
                    let patience = Span::from_ms(10_000);
                    let paths = self.mirror.paths();
                    let given =
                        stop_socket::give(paths, MotionOrder::Stop, patience, &mut |_| true);
                    given.unwrap_or_else(|error| panic!("{error}\n{}", self.robot.logs()));
                    confirmed_ms.push(began.elapsed().as_secs_f64() * 1e3);
                };
                rest_ms.extend(self.joints.stop_by(order));
                self.robot.wait_shown(true);
                self.release();
                // Stops come at other moments of the motion, too.
                std::thread::sleep(Duration::from_millis(20 * (rest_ms.len() as u64 % 7)));
            }
            self.release();
            self.mirror.await_pick(None);
        }
        let late = rest_ms.iter().filter(|ms| **ms > STOP_BAR_MS).count();
        let what = format!("stop at the mirror, {network} network");
        let note = format!("{}; {late} later than {STOP_BAR_MS:.0} ms", spread(&rest_ms));
        table.row(&format!("{what}: arm at rest"), note);
        table.row(&format!("{what}: confirmed there"), spread(&confirmed_ms));
    }

    fn start_pick(&self) {
        self.mirror.must(&["say", "get me the clear bowl", "--timeout", "50"]);
        self.joints.wait_moving();
    }

    /// Returns whether the arm moves, or will.
    fn is_moving(&self) -> bool {
        wait_for("an arm that moves, or has brought the object", 30.0, || {
            let is_moving = self.joints.is_moving();
            let is_over = !is_moving && self.robot.dialogue()["interaction"] == 0;
            (is_moving || is_over).then_some(is_moving)
        })
    }

    fn release(&self) {
        wait_for("a release from the mirror", 20.0, || {
            (self.mirror.call(&["resume-motion"]).code == Some(0)).then_some(())
        });
    }
}

/// Speaks the words into the group's page, with the talk button held; returns the milliseconds from the last loud sample to
/// the page's first sound of the reply. The words end with some quiet, in which the robot may begin.
fn replies(group: &Group, words: &[i16]) -> Vec<f64> {
    let mut page = group.page(&Visitor::operator(1));
    page.until_part("hearing", |hearing| hearing["recogniser"] == "ready");
    page.until_part("turn", |turn| turn["state"] != "down");
    let held = 2;
    let last = words.iter().rposition(|sample| sample.unsigned_abs() > LOUD).expect("words");
    (1..=SPOKEN)
        .map(|number| {
            let before = spoken_last(&page);
            let mut stream = Stream::begin(&mut page, number);
            stream.send(&mut page, held, words, |ms| ms);
            stream.end(&mut page, held);
            let ended = stream.at(last);
            page.until("the sound of a question", |page| {
                let is_speaking = page.parts.get("speaking")?["state"] == "speaking";
                (is_speaking && spoken_last(page) != before).then_some(())
            });
            let ms = ended.elapsed().as_secs_f64() * 1e3;
            let asked = spoken_last(&page);
            page.ask("say", &json!({ "text": "never mind" }));
            page.until_part("dialogue", |dialogue| dialogue["interaction"] == 0);
            // The answer to that is no question of the next round.
            page.until("the end of the robot's answer", |page| {
                let is_over = page.parts.get("speaking")?["state"] != "speaking";
                (is_over && spoken_last(page) != asked).then_some(())
            });
            ms
        })
        .collect()
}

/// The presentation that the page shows.
fn spoken_last(page: &Page) -> Option<(Value, Value)> {
    let speaking = page.parts.get("speaking")?;
    Some((speaking["prompt"].clone(), speaking["presentation"].clone()))
}

/// Measures how soon a console's page is answered, in a thread of its own.
struct Probe {
    is_over: std::sync::Arc<AtomicBool>,
    thread: std::thread::JoinHandle<Vec<f64>>,
}

impl Probe {
    fn of(group: &Group) -> Self {
        let mut page = group.page(&Visitor { role: "viewer", ..Visitor::operator(9) });
        let is_over = std::sync::Arc::new(AtomicBool::new(false));
        let over = std::sync::Arc::clone(&is_over);
        let ask = move || {
            let mut answers_ms = Vec::new();
            while !over.load(Ordering::Relaxed) {
                let (began, at) = (Instant::now(), answers_ms.len() as u64);
                page.send(&json!({ "t": "ping", "at": at }));
                page.until("an answer of the page", |page| {
                    let is_it = |message: &Value| message["t"] == "pong" && message["at"] == at;
                    page.messages.iter().any(is_it).then_some(())
                });
                answers_ms.push(began.elapsed().as_secs_f64() * 1e3);
                page.messages.clear();
                page.lines.clear();
                std::thread::sleep(Duration::from_millis(100));
            }
            answers_ms
        };
        Self { is_over, thread: std::thread::spawn(ask) }
    }

    fn end(self) -> String {
        self.is_over.store(true, Ordering::Relaxed);
        format!("{}, none missing", spread(&self.thread.join().unwrap()))
    }
}

/// Processor time of a process so far, seconds.
fn cpu_s(pid: i32) -> f64 {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap();
    // The name, in parentheses, may hold spaces.
    let fields = stat.rsplit_once(')').unwrap().1.split_whitespace().collect::<Vec<_>>();
    let ticks: f64 =
        [11, 12].map(|place: usize| fields[place].parse::<f64>().unwrap()).iter().sum();
    ticks / 100.0
}

fn resident_mib(pid: i32) -> f64 {
    let status = std::fs::read_to_string(format!("/proc/{pid}/status")).unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
    line.trim().trim_end_matches(" kB").parse::<f64>().unwrap() / 1024.0
}
