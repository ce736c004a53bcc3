//! Calibration files of lerobot: which servo moves which joint, and between which steps.

use std::collections::BTreeMap;
use std::env;
use std::f64::consts::TAU;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use diagnostics::Diagnostic;
use serde::Deserialize;

use crate::registers::STEPS;

/// Folders of lerobot's releases below that of calibrations, the newest first.
const RELEASES: [&str; 3] = ["so_follower", "so101_follower", "so100_follower"];
/// Most bytes of a calibration file; six servos take 800.
const BYTES_MAX: u64 = 64 * 1024;
/// The last step of a turn.
const STEP_MAX: u16 = 4095;
/// Greatest homing offset: its register has 11 bits and a sign.
const OFFSET_MAX: i32 = 2047;
/// Ids from here on have other meanings.
const ID_MAX: u8 = 253;

/// One servo of a calibration. `drive_mode` is not used, as lerobot does not use it for degrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub(crate) struct Calibrated {
    /// Its number on the bus.
    pub(crate) id: u8,
    /// Shown position = actual − offset, steps.
    pub(crate) homing_offset: i32,
    /// Least recorded position, steps.
    pub(crate) range_min: u16,
    /// Greatest recorded position, steps.
    pub(crate) range_max: u16,
}

/// A calibration file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Calibration {
    /// Where it was found.
    pub(crate) file: PathBuf,
    /// Servos by their joints' names.
    pub(crate) servos: BTreeMap<String, Calibrated>,
}

impl Calibrated {
    fn middle(&self) -> f64 {
        0.5 * (f64::from(self.range_min) + f64::from(self.range_max))
    }

    /// Angle of a position: zero is the middle of the recorded range, radians.
    pub(crate) fn radians(&self, steps: i32) -> f64 {
        (f64::from(steps) - self.middle()) * TAU / STEPS
    }

    /// Position of an angle, within the recorded range.
    pub(crate) fn steps(&self, radians: f64) -> u16 {
        self.within(self.middle() + radians * STEPS / TAU)
    }

    /// Share of the recorded range, percent.
    pub(crate) fn percent(&self, steps: i32) -> f64 {
        100.0 * (f64::from(steps) - f64::from(self.range_min)) / self.span()
    }

    /// Position of a share of the recorded range.
    pub(crate) fn steps_of_percent(&self, percent: f64) -> u16 {
        self.within(f64::from(self.range_min) + 0.01 * percent * self.span())
    }

    fn span(&self) -> f64 {
        f64::from(self.range_max) - f64::from(self.range_min)
    }

    fn within(&self, steps: f64) -> u16 {
        steps.round().clamp(f64::from(self.range_min), f64::from(self.range_max)) as u16
    }

    /// The greatest angle to either side of the middle, radians.
    pub(crate) fn reach_rad(&self) -> f64 {
        0.5 * self.span() * TAU / STEPS
    }

    /// What is wrong with it; `None` if nothing is.
    fn problem(&self) -> Option<String> {
        let Self { id, homing_offset, range_min, range_max } = self;
        if *id > ID_MAX {
            return Some(format!("expected an `id` of 0 to {ID_MAX}, found {id}"));
        }
        if *range_max > STEP_MAX || range_min >= range_max {
            return Some(format!(
                "expected `range_min` below `range_max`, both 0 to {STEP_MAX}, found {range_min} and {range_max}"
            ));
        }
        let is_wide = homing_offset.abs() > OFFSET_MAX;
        is_wide
            .then(|| format!("expected a `homing_offset` of -2047 to 2047, found {homing_offset}"))
    }
}

impl Calibration {
    /// Reads a file.
    ///
    /// # Errors
    /// It cannot be read, or has a servo that cannot be.
    pub(crate) fn read(file: &Path) -> Result<Self, Diagnostic> {
        let label = file.display().to_string();
        let wrong = |key: &str, what: String| {
            Diagnostic::new(
                &*label,
                key,
                what,
                "calibrate the arm again: `lerobot-calibrate --robot.type=so101_follower …`",
            )
        };
        let text = text_of(file).map_err(|error| wrong("", error.to_string()))?;
        let servos: BTreeMap<String, Calibrated> = serde_json::from_str(&text)
            .map_err(|error| wrong("", format!("not a calibration of lerobot: {error}")))?;
        let mut of_id = BTreeMap::new();
        for (joint, servo) in &servos {
            if let Some(problem) = servo.problem() {
                return Err(wrong(joint, problem));
            }
            if let Some(other) = of_id.insert(servo.id, joint) {
                return Err(wrong(joint, format!("has the id {} as {other} has", servo.id)));
            }
        }
        Ok(Self { file: file.to_owned(), servos })
    }
}

/// Reads a file of at most [`BYTES_MAX`], and not the rest of a longer one.
fn text_of(file: &Path) -> io::Result<String> {
    let open = safe_files::open_regular(file)?;
    let size = open.metadata()?.len();
    if size > BYTES_MAX {
        let what = format!("expected at most {BYTES_MAX} bytes, found {size}");
        return Err(io::Error::new(io::ErrorKind::InvalidData, what));
    }
    // It may grow meanwhile.
    io::read_to_string(open.take(BYTES_MAX))
}

/// Returns the places at which lerobot keeps the calibration of the robot with this id, the newest release first.
pub(crate) fn places(robot_id: &str) -> Vec<PathBuf> {
    let folder = calibrations(&|name| {
        env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from)
    });
    let file = format!("{robot_id}.json");
    RELEASES.map(|release| folder.join("robots").join(release).join(&file)).into()
}

/// Returns lerobot's folder of calibrations, by variables of the environment.
fn calibrations(variable: &dyn Fn(&str) -> Option<PathBuf>) -> PathBuf {
    if let Some(own) = variable("HF_LEROBOT_CALIBRATION") {
        return own;
    }
    let lerobot =
        variable("HF_LEROBOT_HOME").or_else(|| Some(variable("HF_HOME")?.join("lerobot")));
    let cache = || {
        let cache = variable("XDG_CACHE_HOME").or_else(|| Some(variable("HOME")?.join(".cache")));
        cache.unwrap_or_default().join("huggingface/lerobot")
    };
    lerobot.unwrap_or_else(cache).join("calibration")
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAN: Calibrated =
        Calibrated { id: 1, homing_offset: -57, range_min: 751, range_max: 3471 };

    fn read(text: &str) -> Result<Calibration, String> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("arm.json");
        std::fs::write(&file, text).unwrap();
        Calibration::read(&file).map_err(|problem| problem.to_string())
    }

    #[test]
    fn angles_and_shares_of_a_servo_round_trip_within_its_range() {
        for steps in 751..=3471 {
            assert_eq!(i32::from(PAN.steps(PAN.radians(steps))), steps);
            assert_eq!(i32::from(PAN.steps_of_percent(PAN.percent(steps))), steps);
        }
        assert!(PAN.radians(2111).abs() < 1e-12, "zero is the middle");
        assert_eq!((PAN.steps(9.0), PAN.steps(-9.0)), (3471, 751));
        assert!((PAN.reach_rad() - 2.0862).abs() < 1e-3);
    }

    #[test]
    fn calibration_of_lerobot_is_read_and_a_wrong_one_names_the_joint() {
        let one = r#"{"shoulder_pan":{"id": 1,"drive_mode":0,"homing_offset":-57,"range_min":751,"range_max":3471}"#;
        assert_eq!(read(&format!("{one}}}")).unwrap().servos["shoulder_pan"], PAN);
        let two = one.replacen('{', "", 1).replace("shoulder_pan", "elbow_flex");
        for (text, word) in [
            ("[]".to_owned(), "not a calibration"),
            (format!("{one}, {two}}}"), "has the id 1"),
            (format!("{one}}}").replace("751", "3471"), "below `range_max`"),
            (format!("{one}}}").replace("3471", "4096"), "4095"),
            (format!("{one}}}").replace("-57", "2048"), "homing_offset"),
            (format!("{one}}}").replace("\"id\": 1", "\"id\": 254"), "0 to 253"),
        ] {
            let problem = read(&text).unwrap_err();
            assert!(problem.contains(word) && problem.contains("arm.json"), "{problem}");
        }
    }

    /// 8 TB, of which no byte is on the disk.
    #[test]
    fn file_that_is_too_long_is_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("arm.json");
        std::fs::File::create(&file).unwrap().set_len(8 << 40).unwrap();
        let problem = Calibration::read(&file).unwrap_err().to_string();
        assert!(problem.contains("expected at most 65536 bytes, found 8796093022208"), "{problem}");
    }

    #[test]
    fn calibration_is_looked_for_where_each_release_keeps_it() {
        let with = |set: &[(&str, &str)]| {
            let set: Vec<(String, PathBuf)> =
                set.iter().map(|(k, v)| ((*k).to_owned(), v.into())).collect();
            calibrations(&move |name| {
                set.iter().find(|(key, _)| key == name).map(|(_, value)| value.clone())
            })
        };
        let home = ("HOME", "/h");
        assert_eq!(with(&[home]), Path::new("/h/.cache/huggingface/lerobot/calibration"));
        assert_eq!(with(&[home, ("HF_HOME", "/f")]), Path::new("/f/lerobot/calibration"));
        assert_eq!(
            with(&[home, ("HF_LEROBOT_HOME", "/l"), ("HF_HOME", "/f")]),
            Path::new("/l/calibration")
        );
        assert_eq!(
            with(&[("HF_LEROBOT_CALIBRATION", "/c"), ("HF_LEROBOT_HOME", "/l")]),
            Path::new("/c")
        );
        let places = places("mine");
        let ends =
            ["so_follower/mine.json", "so101_follower/mine.json", "so100_follower/mine.json"];
        assert!(
            places.iter().zip(ends).all(|(place, end)| place.ends_with(format!("robots/{end}"))),
            "{places:?}"
        );
    }
}
