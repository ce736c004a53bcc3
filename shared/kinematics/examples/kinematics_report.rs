//! Figures of the inverse and forward kinematics on this machine: solved share, time per call and
//! distance to the seed. `cargo run --release -p kinematics --example kinematics_report [COUNT]`.
#![expect(clippy::print_stdout, reason = "printing figures is what this example is for")]

use std::time::Instant;

use kinematics::{Arm, Joints, Limb, PositionLimits, Robot};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

fn main() {
    let count = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(20_000);
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    for limb in Limb::BOTH {
        reachable(limb, count, &mut random);
        anywhere(limb, count, &mut random);
        nearest(limb, count / 10, &mut random, |_| limits().middle(), "the middle of the limits");
        nearest(limb, count / 10, &mut random, Random::posture, "a random posture");
    }
    forward(&mut random);
}

fn arm(limb: Limb) -> &'static Arm {
    Robot::baxter().arm(limb)
}

fn limits() -> PositionLimits {
    arm(Limb::Left).limits.position
}

/// Targets that are forward kinematics of random postures: every one has a solution.
fn reachable(limb: Limb, count: usize, random: &mut Random) {
    let mut micros = Vec::with_capacity(count);
    let mut lost = 0;
    for _ in 0..count {
        let target = arm(limb).chain.forward(&random.posture());
        let (answer, took) = timed(|| arm(limb).chain.inverse(&target, None));
        micros.push(took);
        lost += usize::from(answer.is_err());
    }
    println!("{limb} reachable: {lost} of {count} lost; {}", summary(&mut micros));
}

/// Poses uniform in a box round the arm: most have none.
fn anywhere(limb: Limb, count: usize, random: &mut Random) {
    let (mut solved, mut refused) = (Vec::new(), Vec::new());
    for _ in 0..count {
        let target = random.pose(limb);
        let (answer, micros) = timed(|| arm(limb).chain.inverse(&target, None));
        if answer.is_ok() { solved.push(micros) } else { refused.push(micros) }
    }
    println!("{limb} anywhere: {} solved; {}", solved.len(), summary(&mut solved));
    println!("{limb} anywhere: {} refused; {}", refused.len(), summary(&mut refused));
}

/// The answer and its microseconds: the least of three calls, so that what else the machine does
/// counts less.
fn timed<T>(mut call: impl FnMut() -> T) -> (T, f64) {
    let mut once = || {
        let start = Instant::now();
        let answer = call();
        (answer, start.elapsed().as_secs_f64() * 1e6)
    };
    let (first, again) = (once(), [once().1, once().1]);
    (first.0, again.into_iter().fold(first.1, f64::min))
}

fn nearest(
    limb: Limb,
    count: usize,
    random: &mut Random,
    mut seed: impl FnMut(&mut Random) -> Joints,
    seeds: &str,
) {
    let mut micros = Vec::with_capacity(count);
    let mut sum = 0.0;
    for _ in 0..count {
        let (target, seed) = (arm(limb).chain.forward(&random.posture()), seed(random));
        let (answer, took) = timed(|| arm(limb).chain.inverse(&target, Some(&seed)));
        micros.push(took);
        let q = answer.map_or_else(|missed| missed.nearest, |answer| answer.q);
        sum += q.iter().zip(&seed).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    }
    let distance = sum / count as f64;
    println!("{limb} nearest to {seeds}: distance {distance:.4} rad; {}", summary(&mut micros));
}

fn forward(random: &mut Random) {
    let chain = &arm(Limb::Left).chain;
    let postures: Vec<Joints> = (0..1000).map(|_| random.posture()).collect();
    best(&postures, "tool frame", |q| chain.tool_frame(q).origin.x);
    best(&postures, "tool frame and Jacobian", |q| {
        let (tool, jacobian) = chain.tool_and_jacobian(q);
        std::hint::black_box(&jacobian);
        tool.origin.x
    });
    best(&postures, "pose with quaternion", |q| chain.forward(q).rotation.w);
}

/// The least mean time of many short runs: what an undisturbed core does.
fn best(postures: &[Joints], what: &str, mut f: impl FnMut(&Joints) -> f64) {
    let nanos = (0..400)
        .map(|_| {
            let start = Instant::now();
            for q in postures {
                std::hint::black_box(f(std::hint::black_box(q)));
            }
            start.elapsed().as_secs_f64() * 1e9 / postures.len() as f64
        })
        .fold(f64::INFINITY, f64::min);
    println!("{what}: {nanos:.0} ns");
}

fn summary(micros: &mut [f64]) -> String {
    micros.sort_by(f64::total_cmp);
    let mean = micros.iter().sum::<f64>() / micros.len().max(1) as f64;
    let at = |share: f64| micros.get((micros.len() as f64 * share) as usize).copied();
    let (median, p99) = (at(0.5).unwrap_or(0.0), at(0.99).unwrap_or(0.0));
    format!("mean {mean:.2} us, median {median:.2} us, p99 {p99:.2} us")
}

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn posture(&mut self) -> Joints {
        limits().0.map(|(lower, upper)| lower + (upper - lower) * self.unit())
    }

    /// Uniform in the box that the left tool reaches, mirrored for the right; uniform rotation.
    fn pose(&mut self, limb: Limb) -> Isometry3<f64> {
        let y = limb.side() * (-0.83 + 2.28 * self.unit());
        let place = Translation3::new(-1.01 + 2.26 * self.unit(), y, -0.70 + 2.23 * self.unit());
        let [a, b, c] = [self.unit(), self.unit(), self.unit()].map(|x| x * std::f64::consts::TAU);
        let (u, v) = ((a / std::f64::consts::TAU).sqrt(), (1.0 - a / std::f64::consts::TAU).sqrt());
        let rotation = Quaternion::new(u * b.cos(), v * c.sin(), v * c.cos(), u * b.sin());
        Isometry3::from_parts(place, UnitQuaternion::new_normalize(rotation))
    }
}
