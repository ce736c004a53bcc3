//! The serial port, and robots that ship.

use std::fs::{File, OpenOptions};
use std::os::unix::fs::OpenOptionsExt;
use std::process::{Child, Command as Program, Stdio};

use rustix::fs::OFlags;
use servo_bus::Terminal;

use super::*;
use crate::line::{SerialLine, problem_of};

/// A program that has opened the port before.
struct Earlier(Child);

impl Earlier {
    fn on(port: &str) -> Self {
        // The first of a session to open a terminal without this flag ends with it, by SIGHUP.
        let flags = OFlags::NOCTTY.bits().cast_signed();
        let port = OpenOptions::new().read(true).write(true).custom_flags(flags).open(port);
        let port = port.unwrap();
        Self(Program::new("sleep").arg("60").stdin(Stdio::from(port)).spawn().unwrap())
    }
}

impl Drop for Earlier {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn port_that_another_program_has_opened_before_is_refused_until_that_ends() {
    let terminal = Terminal::open().unwrap();
    let port = PathBuf::from(terminal.path());
    let open = || SerialLine::open(&port, 1_000_000);
    let earlier = Earlier::on(terminal.path());
    let problem = open().unwrap_err().to_string();
    let named = format!("another program uses it: sleep (process {})", earlier.0.id());
    assert!(problem.starts_with(&named), "{problem}");
    drop(earlier);
    drop(open().unwrap());
    drop(open().expect("the bus outlives those that use it"));
}

#[test]
fn file_that_is_no_device_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("ttyACM0");
    File::create(&file).unwrap();
    for (port, words) in [
        (file.as_path(), "not a serial port; help:"),
        (folder.path(), "not a serial port; help:"),
        (&folder.path().join("none"), "no such device; help:"),
    ] {
        let problem = problem_of(port).map(|problem| problem.to_string()).unwrap_or_default();
        assert!(problem.starts_with(words), "{}: {problem}", port.display());
    }
    let terminal = Terminal::open().unwrap();
    assert!(problem_of(terminal.path().as_ref()).is_none());
}

/// By `arm.speed_ratio` and `arm.feetech.speed_max_rad_s` of the shipped arm.toml.
#[test]
fn so101_that_ships_is_planned_no_faster_than_its_servos_move() {
    let shipped = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/arm.toml");
    let text = std::fs::read_to_string(shipped).unwrap();
    let after = |key: &str, section: &str| -> f64 {
        let text = &text[text.find(section).unwrap()..];
        let line = text.lines().find(|line| line.starts_with(key)).unwrap();
        line[key.len()..].split(&['=', '#'][..]).nth(1).unwrap().trim().parse().unwrap()
    };
    let ratio = after("speed_ratio", "robot = ");
    let servo_rad_s = after("speed_max_rad_s", "[feetech]");
    let robot = robot_of("so101", &|text| text);
    let arm = robot.arm(Limb::Only);
    for (joint, fastest) in arm.joint_names.iter().zip(arm.limits.velocity) {
        assert!(ratio * fastest <= servo_rad_s, "{joint}: {fastest} rad/s");
    }
}
