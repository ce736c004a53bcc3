//! Figures of whole plans on this machine: every bowl at every place of its scene, time to plan and to
//! execute picks and pointing, and the outcomes on random tables.
//! `cargo run --release -p manipulation --example tables [--robot baxter|ur5e] [TABLES] [SEED]`;
//! without `--robot` all of it for both.
#![expect(clippy::print_stdout, reason = "printing figures is what this example is for")]

#[path = "../tests/plans/support/mod.rs"]
mod support;

use std::process::ExitCode;
use std::time::Instant;

use manipulation::{Cuboid, ObjectPose, Robot, plan_pick, plan_point};
use support::checker::Checker;
use support::scenes;
use support::tables::{Bench, Tally, all_but, settings, try_table};

/// Robots whose random tables are asked for, number of tables, and their seed.
struct Request {
    baxter: bool,
    ur5e: bool,
    tables: u64,
    seed: u64,
}

impl Request {
    fn read(mut arguments: impl Iterator<Item = String>) -> Option<Self> {
        let mut request = Self { baxter: true, ur5e: true, tables: 1000, seed: 1 };
        let mut numbers = Vec::new();
        while let Some(argument) = arguments.next() {
            if argument != "--robot" {
                numbers.push(argument.parse().ok()?);
                continue;
            }
            let name = arguments.next()?;
            (request.baxter, request.ur5e) = (name == "baxter", name == "ur5e");
            (request.baxter || request.ur5e).then_some(())?;
        }
        match numbers[..] {
            [] => {}
            [tables] => request.tables = tables,
            [tables, seed] => (request.tables, request.seed) = (tables, seed),
            _ => return None,
        }
        Some(request)
    }
}

fn main() -> ExitCode {
    let Some(request) = Request::read(std::env::args().skip(1)) else {
        println!("expected [--robot baxter|ur5e] [TABLES] [SEED]");
        return ExitCode::from(64);
    };
    let Request { baxter, ur5e, tables, seed } = request;
    if baxter && ur5e {
        println!("scene object: pick (planned in), pointing (planned in)");
        ["bowls", "markers", "tools"].into_iter().for_each(scene);
        println!("\nbowl: seconds of its pick at the places of");
        bowls_at_places();
    }
    if baxter {
        random_tables(Robot::baxter(), &Bench::baxter(), tables, seed);
    }
    if ur5e {
        random_tables(&support::ur5e(), &Bench::ur5e(), tables, seed);
    }
    ExitCode::SUCCESS
}

fn scene(scene: &str) {
    let robot = Robot::baxter();
    let (names, poses): (Vec<String>, Vec<ObjectPose>) = scenes::read(scene).into_iter().unzip();
    let all: Vec<Cuboid> = poses.iter().map(ObjectPose::cuboid).collect();
    let neutral = robot.neutral();
    for (i, name) in names.iter().enumerate() {
        let others = all_but(&poses, i);
        let pick = || plan_pick(robot, &poses[i], None, &neutral, &others, &settings()).ok();
        let point = || plan_point(robot, poses[i].xyz_m, None, &neutral, &all, &settings()).ok();
        let (Some(picked), Some(pointed)) = (pick(), point()) else {
            println!("{scene} {name}: rejected");
            continue;
        };
        let aim_s = pointed.stages()[0].motion.duration_s();
        println!(
            "{scene} {name}: {} {:.2} s ({:.1} ms), {} {aim_s:.2} s ({:.1} ms)",
            picked.limb(),
            picked.duration_s(),
            best_ms(&pick),
            pointed.limb(),
            best_ms(&point)
        );
    }
}

/// Returns the least of ten runs, milliseconds: the time on an undisturbed core.
fn best_ms<R>(run: &dyn Fn() -> R) -> f64 {
    let ms = || {
        let clock = Instant::now();
        std::hint::black_box(run());
        clock.elapsed().as_secs_f64() * 1e3
    };
    (0..10).map(|_| ms()).fold(f64::INFINITY, f64::min)
}

fn bowls_at_places() {
    let robot = Robot::baxter();
    let (names, poses): (Vec<String>, Vec<ObjectPose>) = scenes::read("bowls").into_iter().unzip();
    let places = scenes::attribute("bowls", "location");
    let heads: Vec<String> = names.iter().zip(&places).map(|(n, p)| format!("{n} ({p})")).collect();
    println!("| | {} |", heads.join(" | "));
    for (i, name) in names.iter().enumerate() {
        let seconds = |k: usize| {
            let objects = scenes::swapped(&poses, i, k);
            let others = all_but(&objects, i);
            plan_pick(robot, &objects[i], None, &robot.neutral(), &others, &settings()).map_or_else(
                |error| error.to_string(),
                |plan| format!("{} {:.2}", plan.limb(), plan.duration_s()),
            )
        };
        let row: Vec<String> = (0..poses.len()).map(seconds).collect();
        println!("| {name} | {} |", row.join(" | "));
    }
}

fn random_tables(robot: &Robot, bench: &Bench, count: u64, seed: u64) {
    println!("\n{}: {count} random tables, seed {seed}", robot.description().name());
    let threads = std::thread::available_parallelism().map_or(1, usize::from) as u64;
    let mut tally = Tally::default();
    std::thread::scope(|scope| {
        let share = |k: u64| {
            move || {
                let checker = match robot.limbs() {
                    [_] => Checker::described(robot),
                    _ => Checker::new(robot),
                };
                let mut tally = Tally::default();
                for table in (k..count).step_by(threads as usize) {
                    tally.add(try_table(robot, bench, &checker, seed * 1_000_000 + table));
                }
                tally
            }
        };
        let workers: Vec<_> = (0..threads).map(|k| scope.spawn(share(k))).collect();
        for worker in workers {
            tally.add(worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
    });
    print(&mut tally, robot.limbs().len());
}

fn print(tally: &mut Tally, arms: usize) {
    let Tally { objects, picked, too_wide, refused_alone, refused_among, .. } = &tally;
    println!("{objects} objects: {picked} picked, {} refused:", objects - picked);
    println!("  {too_wide} cannot be grasped, {refused_alone} even alone on the table,");
    println!("  {refused_among} among the others, {} possible otherwise", tally.possible_otherwise);
    let reasons: Vec<String> =
        tally.reasons.iter().map(|(reason, count)| format!("{count} {reason}")).collect();
    println!("  for: {}", reasons.join(", "));
    if arms == 2 {
        println!("{} of the picks by the arm of the object's side", tally.by_the_nearer_arm);
    }
    println!("planned in, ms: {}", spread(&mut tally.plan_ms));
    println!("refused in, ms: {}", spread(&mut tally.refuse_ms));
    println!("a pick takes, s: {}", spread(&mut tally.duration_s));
    println!("violations: {}", tally.violations.len());
    tally.violations.iter().for_each(|what| println!("  {what}"));
}

fn spread(values: &mut [f64]) -> String {
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values.get((values.len() as f64 * share) as usize).copied();
    let [median, p99] = [0.5, 0.99].map(|share| at(share).unwrap_or(0.0));
    let most = values.last().copied().unwrap_or(0.0);
    format!("median {median:.1}, 99 % {p99:.1}, most {most:.1}")
}
