//! An arm on a simulated bus of servos: the driver `feetech` with the real service, supervisor and serial port.

use std::cell::RefCell;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Duration;

use rustix::process::Signal;
use serde_json::{Value, json};
use tempfile::TempDir;
use whichone_tests::{Ended, Group, UR5E, program, run, wait_for};

/// Most steps per second of a servo at rest: 0.05 rad/s, as for the driver.
const STILL: f64 = 33.0;

/// A bus of seven servos behind a pseudo-terminal, a robot of six joints, and its calibration.
struct Bench {
    folder: TempDir,
    bus: Child,
    input: RefCell<ChildStdin>,
    output: RefCell<BufReader<ChildStdout>>,
    port: String,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let calibration = folder.path().join("arm.json");
        fs::write(&calibration, calibrated().to_string()).unwrap();
        describe(&folder.path().join("config"));
        let mut bus = Command::new(program("servo_bus"));
        bus.arg("--servos").arg("7").arg("--calibration").arg(&calibration);
        let mut bus = bus.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let input = RefCell::new(bus.stdin.take().unwrap());
        let mut output = BufReader::new(bus.stdout.take().unwrap());
        let mut port = String::new();
        output.read_line(&mut port).unwrap();
        Self { folder, bus, input, output: RefCell::new(output), port: port.trim().to_owned() }
    }

    fn config(&self) -> PathBuf {
        self.folder.path().join("config")
    }

    fn settings(&self) -> Vec<String> {
        let calibration = self.folder.path().join("arm.json");
        let own = [
            "arm.robot=six".to_owned(),
            "arm.driver=feetech".to_owned(),
            "arm.time_scale=1.0".to_owned(),
            "arm.speed_ratio=0.25".to_owned(),
            "arm.restock=true".to_owned(),
            format!("arm.feetech.port={}", self.port),
            format!("arm.feetech.calibration={}", calibration.display()),
        ];
        let of_scene =
            UR5E.into_iter().filter(|setting| !setting.starts_with("arm.robot")).map(str::to_owned);
        of_scene.chain(own).collect()
    }

    /// A group that moves the arm.
    fn group(&self) -> Group {
        let mut group = Group::with_config(self.config());
        let settings = self.settings();
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        let ended = group.start(&settings);
        assert_eq!(ended.code, Some(0), "{ended:?}\n{}", group.logs());
        group
    }

    fn tell(&self, line: &str) {
        writeln!(self.input.borrow_mut(), "{line}").unwrap();
    }

    /// The servos as they are.
    fn state(&self) -> Value {
        self.tell("state");
        let mut line = String::new();
        self.output.borrow_mut().read_line(&mut line).unwrap();
        serde_json::from_str(&line).unwrap()
    }

    /// The greatest speed of a servo, steps/s.
    fn speed(state: &Value) -> f64 {
        let servos = state["servos"].as_array().unwrap().iter();
        servos.map(|servo| servo["speed"].as_f64().unwrap().abs()).fold(0.0, f64::max)
    }

    /// The longest way of a servo between two states, steps.
    fn way(from: &Value, to: &Value) -> f64 {
        let position =
            |state: &Value, place: usize| state["servos"][place]["position"].as_f64().unwrap();
        (0..7).map(|place| (position(from, place) - position(to, place)).abs()).fold(0.0, f64::max)
    }

    /// The time at which every servo has come to rest.
    fn rested_s(&self) -> f64 {
        wait_for("rest", 5.0, || {
            let state = self.state();
            (Self::speed(&state) < STILL).then(|| state["moved_s"].as_f64().unwrap())
        })
    }

    fn wait_until_it_moves(&self) {
        wait_for("motion", 40.0, || (Self::speed(&self.state()) > 6.0 * STILL).then_some(()));
    }
}

impl Drop for Bench {
    fn drop(&mut self) {
        let _ = self.bus.kill();
        let _ = self.bus.wait();
    }
}

/// Servos in the names of the joints, which turn by half a turn to either side.
fn calibrated() -> Value {
    let joints = [
        "shoulder_pan_joint",
        "shoulder_lift_joint",
        "elbow_joint",
        "wrist_1_joint",
        "wrist_2_joint",
    ];
    let names = joints.into_iter().chain(["wrist_3_joint", "gripper"]).zip(1..);
    let of = |(name, id): (&str, u8)| {
        let range = if name == "gripper" { (2033, 3490) } else { (0, 4095) };
        let servo = json!({ "id": id, "drive_mode": 0, "homing_offset": 0, "range_min": range.0,
                            "range_max": range.1 });
        (name.to_owned(), servo)
    };
    Value::Object(names.map(of).collect())
}

/// The shipped configuration with a UR5e whose joints turn by half a turn to either side.
fn describe(config: &Path) {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../config");
    let copied = Command::new("cp").arg("-r").arg(&shipped).arg(config).status().unwrap();
    assert!(copied.success());
    let robots = config.join("robots");
    let urdf = fs::read_to_string(robots.join("ur5e.urdf")).unwrap();
    fs::write(robots.join("six.urdf"), urdf.replace("6.283185307179586", "3.14")).unwrap();
    fs::copy(robots.join("ur5e.srdf"), robots.join("six.srdf")).unwrap();
}

fn assert_delivered(group: &Group, outcome: &Value, object: &str) {
    let facts = (&outcome["outcome"], &outcome["object"]);
    assert_eq!(facts, (&"delivered".into(), &object.into()), "{outcome}\n{}", group.logs());
}

/// The bus has no watchdog. Whatever the servos were told last is near.
#[test]
fn servos_deliver_and_a_killed_arm_rests_within_the_lead_of_its_goals() {
    let bench = Bench::new();
    let group = bench.group();
    // Something that is 30 % of the jaw's range wide.
    bench.tell("jaw 7 2470");
    let outcome = group.fetch_while("the large red block", "red_large", || {
        bench.wait_until_it_moves();
        let before = group.incarnation("arm");
        let pid = group.pid("arm");
        bench.wait_until_it_moves();
        rustix::process::kill_process(pid, Signal::KILL).unwrap();
        // In the bus's own time, from the first look at it.
        let killed = bench.state();
        std::thread::sleep(Duration::from_millis(150));
        let rest_s = bench.rested_s() - killed["now_s"].as_f64().unwrap();
        let way = Bench::way(&killed, &bench.state());
        println!("killed in motion: at rest {rest_s:.3} s and {way:.0} steps later");
        // A tenth of a second of motion. The time is that of the servos' own position loop, and of a busy machine.
        assert!(way < 98.0 && rest_s < 0.3, "{rest_s} s, {way} steps");
        group.wait_for_restart("arm", before);
    });
    assert_delivered(&group, &outcome, "red_large");
    group.verify_journals();
    group.down();
    let state = bench.state();
    let holds = state["servos"].as_array().unwrap().iter().all(|servo| servo["torque"] == 1);
    assert!(holds, "nothing lets the arm fall: {state}");
}

#[test]
fn hot_servo_stops_the_others_names_its_joint_and_latches() {
    let bench = Bench::new();
    let group = bench.group();
    group.say("the large red block");
    bench.wait_until_it_moves();
    bench.tell("heat 3 75");
    let latched = |arm: &Value| arm["stopped"] == true && arm["hindrance"] == "error";
    wait_for("the latch", 5.0, || Some(group.arm()).filter(latched));
    bench.rested_s();
    let log = group.wait_for_log("arm", "elbow_joint: overheated");
    assert!(log.contains("75 °C"), "{log}");
    let state = bench.state();
    let holding =
        state["servos"].as_array().unwrap().iter().filter(|servo| servo["torque"] == 1).count();
    assert_eq!(holding, 6, "{state}");
    bench.tell("heat 3 40");
    wait_for("the elbow holds again", 10.0, || {
        Some(group.arm()).filter(|arm| arm["hindrance"] == "none")
    });
    assert_eq!(group.arm()["stopped"], true, "until somebody resumes");
    group.down();
}

/// Runs a verb with the configuration of the arm.
fn call(bench: &Bench, group: &Group, words: &[&str], settings: &[String]) -> Ended {
    let config = bench.config().display().to_string();
    let set = settings.iter().flat_map(|setting| ["--set", setting.as_str()]);
    let words = words.iter().copied().chain(["--config", &config]).chain(set);
    group.call(&words.collect::<Vec<_>>())
}

#[test]
fn missing_port_and_calibration_are_named() {
    let bench = Bench::new();
    let (group, settings) = (Group::with_config(bench.config()), bench.settings());
    let right = call(&bench, &group, &["check"], &settings);
    assert_eq!(right.code, Some(0), "{right:?}");
    let wrong = settings.iter().map(|setting| match setting.split_once('=') {
        Some(("arm.feetech.port", _)) => "arm.feetech.port=/dev/no-such-port".to_owned(),
        Some(("arm.feetech.calibration", file)) => format!("arm.feetech.calibration={file}x"),
        _ => setting.clone(),
    });
    let wrong = call(&bench, &group, &["check"], &wrong.collect::<Vec<_>>());
    assert_eq!(wrong.code, Some(78), "{wrong:?}");
    for part in
        ["arm.feetech.port: /dev/no-such-port: no such device; help:", "arm.jsonx", "2 problems"]
    {
        assert!(wrong.stderr.contains(part), "{part}: {wrong:?}");
    }
}

#[test]
fn calibration_is_written_and_every_servo_released_while_no_group_uses_them() {
    let bench = Bench::new();
    let (mut group, settings) = (Group::with_config(bench.config()), bench.settings());
    bench.tell("byte 3 11 0");
    let servos = call(&bench, &group, &["robot", "servos"], &settings);
    assert_eq!(servos.code, Some(1), "{servos:?}");
    assert!(servos.stdout.contains("elbow_joint") && servos.stdout.contains("7.4 V"), "{servos:?}");
    assert!(
        servos.stderr.contains("servo 3 (elbow_joint) has range_max 3840, the file 4095"),
        "{servos:?}"
    );
    let written = call(&bench, &group, &["robot", "servos", "--write-calibration"], &settings);
    assert_eq!(written.code, Some(0), "{written:?}");
    bench.tell("dip");
    let state = bench.state();
    let servo = &state["servos"][2];
    assert_eq!((&servo["range"], &servo["lock"]), (&json!([0, 4095]), &json!(1)), "{state}");
    let started: Vec<&str> = settings.iter().map(String::as_str).collect();
    assert_eq!(group.start(&started).code, Some(0), "{}", group.logs());
    wait_for("the servos hold", 10.0, || {
        Some(group.arm()).filter(|arm| arm["hindrance"] == "none")
    });
    let second = call(&bench, &group, &["robot", "servos"], &settings);
    assert!(
        second.code == Some(78) && second.stderr.contains("another program uses it"),
        "{second:?}"
    );
    group.down();
    let group = Group::with_config(bench.config());
    let holding = call(&bench, &group, &["robot", "servos", "--write-calibration"], &settings);
    let refused = holding.stderr.contains("expected servos without torque");
    assert!(holding.code == Some(1) && refused, "{holding:?}");
    bench.tell("dead 2");
    let released = call(&bench, &group, &["robot", "servos", "--release"], &settings);
    assert_eq!(released.code, Some(1), "{released:?}");
    let lines = released.stdout.lines().filter(|line| line.ends_with("released")).count();
    assert_eq!(lines, 6, "every other one: {released:?}");
}

/// What the driver is tested with is no invention of this project: the maker's own library moves it.
#[test]
#[ignore = "needs python3 with feetech-servo-sdk"]
fn simulated_servos_obey_the_makers_library() {
    let bench = Bench::new();
    let python = std::env::var("WHICHONE_SERVOS").unwrap_or_else(|_| "python3".to_owned());
    let mut peer = Command::new(python);
    peer.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("servo_bus/peer.py"))
        .arg(&bench.port)
        .arg("7");
    let ended = run(&mut peer, "", 60.0);
    assert_eq!((ended.code, ended.stdout.trim()), (Some(0), "ok"), "{ended:?}");
}
