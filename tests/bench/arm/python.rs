//! Solvers that are reached through Python, where it and their packages are there.
//!
//! Each call is timed in Python, so it holds a few microseconds of the way there and back.

use super::inverse::{Outcome, Seed};
use super::targets::{Rule, Target, middle, postures};
use super::{BUDGET_S, Effort};
use manipulation::{Joints, Limb};
use serde::Deserialize;
use serde_json::json;
use std::io::Write;
use std::process::{Command, Stdio};

/// The program; its packages are installed by `scripts/bench`.
const SCRIPT: &str = include_str!("peers.py");
/// The interpreter that has them.
const VARIABLE: &str = "WHICHONE_PEERS_PYTHON";

/// The peers' answer.
#[derive(Debug, Deserialize)]
pub(super) struct Measured {
    runs: Vec<Run>,
    /// Peers that were left out, with the reason.
    pub(super) left_out: Vec<String>,
    /// Forward kinematics by Pinocchio, if it is there.
    pub(super) forward: Vec<Forward>,
}

/// Forward kinematics of the left arm in [`postures`].
#[derive(Debug, Deserialize)]
pub(super) struct Forward {
    /// Poses of all frames, nanoseconds.
    pub(super) pose_ns: Vec<f64>,
    /// The Jacobian of the gripper, with the kinematics that it needs, nanoseconds.
    pub(super) jacobian_ns: Vec<f64>,
    /// Where the gripper is in each posture, metres.
    pub(super) places: Vec<[f64; 3]>,
}

/// Postures of its forward kinematics, and samples.
const POSTURES: usize = 1000;
const SAMPLES: usize = 20;

#[derive(Debug, Deserialize)]
struct Run {
    name: String,
    /// True if it looked for the posture nearest to the seed.
    nearest: bool,
    random_seed: bool,
    answers: Vec<Option<Joints>>,
    /// Of processor, and elapsed.
    micros: Vec<[f64; 2]>,
}

impl Measured {
    /// The judged outcomes of one kind of search from one kind of seed.
    pub(super) fn outcomes(&self, targets: &[Target], nearest: bool, seed: Seed) -> Vec<Outcome> {
        let asked =
            |run: &&Run| run.nearest == nearest && run.random_seed == (seed == Seed::Random);
        self.runs
            .iter()
            .filter(asked)
            .map(|run| {
                let answers = run.answers.iter().copied().zip(run.micros.iter().copied());
                Outcome::of(run.name.clone(), targets, seed, answers, Rule::PEER)
            })
            .collect()
    }
}

pub(super) fn measure(targets: &[Target], effort: Effort) -> Measured {
    let python = std::env::var(VARIABLE).unwrap_or_else(|_| "python3".to_owned());
    call(&python, &question(&targets[..effort.peers], effort)).unwrap_or_else(|error| Measured {
        runs: Vec::new(),
        forward: Vec::new(),
        left_out: vec![format!("Solvers in Python are left out: {error}.")],
    })
}

fn question(targets: &[Target], effort: Effort) -> String {
    let matrix = |pose: &nalgebra::Isometry3<f64>| -> Vec<Vec<f64>> {
        let matrix = pose.to_homogeneous();
        matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
    };
    let robot = robot_model::Robot::baxter();
    let poses = robot.poses(|_| 0.0);
    let mount = |limb: Limb| {
        robot.link_index(&format!("{limb}_arm_mount")).map(|link| matrix(&poses[link]))
    };
    let all: Vec<_> = targets
        .iter()
        .map(|target| {
            json!({
                "limb": target.limb.name(),
                "pose": matrix(&target.pose),
                "xyz": target.pose.translation.vector.as_slice(),
                "xyzw": target.pose.rotation.coords.as_slice(),
                "middle": middle(target.limb),
                "random": target.seed,
            })
        })
        .collect();
    json!({
        "urdf": format!("{}/fixtures/baxter/baxter.urdf", env!("CARGO_MANIFEST_DIR")),
        "mounts": { "left": mount(Limb::Left), "right": mount(Limb::Right) },
        "budget_s": BUDGET_S,
        "slow": effort.slow,
        "targets": all,
        "postures": postures(Limb::Left, POSTURES),
        "samples": SAMPLES,
    })
    .to_string()
}

fn call(python: &str, question: &str) -> Result<Measured, String> {
    let mut child = Command::new(python)
        .args(["-c", SCRIPT])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .map_err(|error| format!("{python} does not start ({error})"))?;
    if let Some(mut stdin) = child.stdin.take() {
        stdin.write_all(question.as_bytes()).map_err(|error| error.to_string())?;
    }
    let output = child.wait_with_output().map_err(|error| error.to_string())?;
    // Solvers write to standard output, too: the reply is the last line.
    let text = String::from_utf8_lossy(&output.stdout);
    let last = text.lines().last().unwrap_or_default();
    serde_json::from_str(last).map_err(|_| format!("{python} ended with {}", output.status))
}
