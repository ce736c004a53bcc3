//! Solvers that are reached through Python, where it and their packages are there.
//!
//! Each call is timed in Python, so it holds a few microseconds of the way there and back.

use super::inverse::{Outcome, Seed};
use super::subject::{Subject, joints_of};
use super::targets::{Rule, Target};
use super::{BUDGET_S, Effort};
use manipulation::Limb;
use nalgebra::Isometry3;
use serde::Deserialize;
use serde_json::{Map, Value, json};
use std::io::Write;
use std::process::{Command, Stdio};

/// The program, and its arguments: one process each, so that none takes another with it.
const SCRIPT: &str = include_str!("peers.py");
const PEERS: [&str; 4] = ["optik", "trac_ik", "ikpy", "pinocchio"];
/// The interpreter that has their packages; `scripts/bench` installs them.
const VARIABLE: &str = "WHICHONE_PEERS_PYTHON";

/// The peers' answers.
#[derive(Debug, Default)]
pub(super) struct Measured {
    runs: Vec<Run>,
    /// Peers that were left out, with the reason.
    pub(super) left_out: Vec<String>,
    /// Forward kinematics by Pinocchio, if it is there.
    pub(super) forward: Vec<Forward>,
}

/// The answer of one peer.
#[derive(Debug, Deserialize)]
struct Reply {
    runs: Vec<Run>,
    forward: Vec<Forward>,
}

/// Forward kinematics of the first limb in [`Subject::postures`].
#[derive(Debug, Deserialize)]
pub(super) struct Forward {
    /// The pose of the gripper, nanoseconds.
    pub(super) pose_ns: Vec<f64>,
    /// The Jacobian of the gripper, with the kinematics that it needs, nanoseconds.
    pub(super) jacobian_ns: Vec<f64>,
    /// Where the gripper is in each posture, metres.
    pub(super) places: Vec<[f64; 3]>,
}

/// Samples of its forward kinematics.
const SAMPLES: usize = 20;

/// Which poses were asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Kind {
    Reachable,
    Anywhere,
}

#[derive(Debug, Deserialize)]
struct Run {
    name: String,
    kind: Kind,
    seed: Seed,
    /// True if it looked for the posture nearest to the seed.
    nearest: bool,
    answers: Vec<Option<Vec<f64>>>,
    /// Of processor, and elapsed.
    micros: Vec<[f64; 2]>,
}

impl Measured {
    /// The judged outcomes of one kind of search from one kind of seed.
    pub(super) fn outcomes(
        &self,
        subject: &Subject,
        targets: &[Target],
        kind: Kind,
        nearest: bool,
        seed: Seed,
    ) -> Vec<Outcome> {
        let asked = |run: &&Run| run.kind == kind && run.nearest == nearest && run.seed == seed;
        let outcome = |run: &Run| {
            let answers = run.answers.iter().map(|q| q.as_deref().and_then(joints_of));
            let answers = answers.zip(run.micros.iter().copied());
            Outcome::of(run.name.clone(), subject, targets, seed, answers, Rule::PEER)
        };
        self.runs.iter().filter(asked).map(outcome).collect()
    }
}

/// Has every peer answer the poses that are in reach and those of which some are not.
pub(super) fn measure(
    subject: &Subject,
    reachable: &[Target],
    anywhere: &[Target],
    effort: Effort,
) -> Measured {
    let python = std::env::var(VARIABLE).unwrap_or_else(|_| "python3".to_owned());
    let question = question(subject, reachable, anywhere, effort);
    let mut measured = Measured::default();
    for peer in PEERS {
        match call(&python, peer, &question) {
            Ok(reply) => {
                measured.runs.extend(reply.runs);
                measured.forward.extend(reply.forward);
            }
            Err(error) => measured.left_out.push(format!("Without {peer}: {error}.")),
        }
    }
    measured
}

fn question(
    subject: &Subject,
    reachable: &[Target],
    anywhere: &[Target],
    effort: Effort,
) -> String {
    let first = subject.limbs()[0];
    let postures = subject.postures(first, super::POSTURES);
    let postures: Vec<_> = postures.iter().map(|q| subject.moving(first, q)).collect();
    let asked = |targets: &[Target]| -> Vec<Value> {
        targets.iter().map(|target| asked(subject, target)).collect()
    };
    json!({
        "urdf": subject.urdf,
        "base": subject.description().root().name,
        "limbs": limbs(subject),
        "budget_s": BUDGET_S,
        "slow": effort.slow,
        "targets": { "reachable": asked(reachable), "anywhere": asked(anywhere) },
        "forward": { "limb": first.name(), "postures": postures, "samples": SAMPLES },
    })
    .to_string()
}

/// The links at the ends of each limb: where its first joint is mounted, what its last joint moves, and
/// the gripper; with their poses.
fn limbs(subject: &Subject) -> Map<String, Value> {
    let description = subject.description();
    let poses = description.poses(|_| 0.0);
    let ends = |limb: &Limb| {
        let chain = subject.chain(*limb);
        let (mut joints, tip) = (chain.movable(), subject.tip(*limb));
        let mount = joints.next().map_or(0, |joint| joint.parent);
        let last = joints.next_back().map_or(0, |joint| joint.child);
        let tool = description.link_index(&tip).map(|tip| poses[last].inv_mul(&poses[tip]));
        let ends = json!({
            "tip": tip,
            "mount": description.links()[mount].name,
            "mount_pose": matrix(&poses[mount]),
            "last": description.links()[last].name,
            "tip_on_last": tool.map(|pose| matrix(&pose)),
        });
        (limb.name().to_owned(), ends)
    };
    subject.limbs().iter().map(ends).collect()
}

fn asked(subject: &Subject, target: &Target) -> Value {
    let Target { limb, pose, seed } = target;
    json!({
        "limb": limb.name(),
        "pose": matrix(pose),
        "xyz": pose.translation.vector.as_slice(),
        "xyzw": pose.rotation.coords.as_slice(),
        "middle": subject.moving(*limb, &subject.middle(*limb)),
        "random": subject.moving(*limb, seed),
    })
}

fn matrix(pose: &Isometry3<f64>) -> Vec<Vec<f64>> {
    let matrix = pose.to_homogeneous();
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}

/// Runs one peer; an error is the last line that it wrote.
fn call(python: &str, peer: &str, question: &str) -> Result<Reply, String> {
    let mut child = Command::new(python)
        .args(["-c", SCRIPT, peer])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| format!("{python} does not start ({error})"))?;
    let written = child.stdin.take().map_or(Ok(()), |mut to| to.write_all(question.as_bytes()));
    let output = child.wait_with_output().map_err(|error| error.to_string())?;
    // Solvers write to standard output, too: the reply is the last line.
    let last = |bytes: &[u8]| {
        let text = String::from_utf8_lossy(bytes);
        text.lines().rfind(|line| !line.trim().is_empty()).unwrap_or_default().to_owned()
    };
    match (output.status.success(), written) {
        (true, Ok(())) => {
            serde_json::from_str(&last(&output.stdout)).map_err(|error| error.to_string())
        }
        _ => Err(format!("{} ({python}: {})", last(&output.stderr), output.status)),
    }
}
