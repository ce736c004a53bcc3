//! Random tables, and what comes of picking everything on them.

use std::collections::BTreeMap;

use manipulation::{Cuboid, GraspError, ObjectPose, PlanError, PlanSettings, Robot, plan_pick};

use super::Random;
use super::checker::{Checker, broken_limit};

/// Six to twelve objects of all kinds on the table, that do not overlap: blocks, bars, bowls and
/// boxes that are held at the rim, and some that are too wide to be held.
pub(crate) fn random_table(random: &mut Random, bench: &Bench) -> Vec<ObjectPose> {
    let count = 6 + (random.unit() * 7.0) as usize;
    let mut objects: Vec<ObjectPose> = Vec::new();
    let mut misses = 0;
    while objects.len() < count {
        let object = random_object(random, bench);
        let apart_m = random.between(0.005, 0.08);
        let beside = |other: &ObjectPose| {
            let way = [0, 1].map(|i| other.xyz_m[i] - object.xyz_m[i]);
            way[0].hypot(way[1]) > radius(other) + radius(&object) + apart_m
        };
        if objects.iter().all(beside) {
            objects.push(object);
        } else {
            misses += 1;
            if misses > 500 {
                (objects, misses) = (Vec::new(), 0);
            }
        }
    }
    objects
}

fn radius(object: &ObjectPose) -> f64 {
    0.5 * object.size_m[0].hypot(object.size_m[1])
}

fn random_object(random: &mut Random, bench: &Bench) -> ObjectPose {
    let thin = random.between(0.012, 0.033);
    let wide = random.between(0.06, 0.18);
    let wall = random.between(0.003, 0.009);
    let (size, grasp_width_m) = match (random.unit() * 10.0) as usize {
        0..=2 => ([thin, thin, random.between(0.02, 0.12)], thin),
        3..=4 => ([wide, thin, random.between(0.012, 0.06)], thin),
        5..=7 => ([wide, wide, random.between(0.03, 0.09)], wall),
        8 => ([wide, random.between(0.05, 0.12), random.between(0.03, 0.08)], wall),
        _ => ([wide, wide, random.between(0.03, 0.10)], random.between(0.04, 0.1)),
    };
    let z = bench.settings.table_z_m + 0.5 * size[2];
    let (x, y) = (bench.x_m, bench.y_m);
    ObjectPose {
        xyz_m: [random.between(x.0, x.1), random.between(y.0, y.1), z],
        yaw_rad: random.between(-3.1, 3.1),
        size_m: size,
        grasp_width_m,
        mass_kg: None,
        wall_rad: 0.0,
        hollow: true,
    }
}

pub(crate) const TABLE_Z_M: f64 = -0.155;

/// Where a robot's random tables are, and the settings of its plans.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bench {
    x_m: (f64, f64),
    y_m: (f64, f64),
    pub(crate) settings: PlanSettings,
}

impl Bench {
    /// Baxter's.
    pub(crate) fn baxter() -> Self {
        Self { x_m: (0.50, 0.85), y_m: (-0.65, 0.65), settings: settings() }
    }

    /// The UR5e's, with the settings of its profile.
    pub(crate) fn ur5e() -> Self {
        let settings =
            PlanSettings { hand_over_xyz_m: [0.45, 0.42, 0.25], table_z_m: 0.0, ..settings() };
        Self { x_m: (0.44, 0.68), y_m: (-0.45, 0.45), settings }
    }

    /// Returns the settings with other heights above the grasp and other places of handing over.
    fn variants(&self) -> Vec<PlanSettings> {
        let mut variants = vec![self.settings];
        for hover_m in [0.05, 0.10, 0.20] {
            variants.push(PlanSettings { hover_m, ..self.settings });
        }
        let [x, y, z] = self.settings.hand_over_xyz_m;
        for aside in [[x - 0.05, y + 0.15, z + 0.08], [x - 0.2, y + 0.3, z + 0.03]] {
            let hand_over_xyz_m = aside;
            variants.push(PlanSettings { hand_over_xyz_m, ..self.settings });
            variants.push(PlanSettings { hand_over_xyz_m, hover_m: 0.10, ..self.settings });
        }
        variants
    }
}

/// Returns the settings of the configuration that ships.
pub(crate) fn settings() -> PlanSettings {
    PlanSettings { speed_ratio: 0.6, table_z_m: TABLE_Z_M, ..PlanSettings::default() }
}

pub(crate) fn all_but(objects: &[ObjectPose], i: usize) -> Vec<Cuboid> {
    let others = objects.iter().enumerate().filter(|(j, _)| *j != i);
    others.map(|(_, object)| object.cuboid()).collect()
}

/// Results on many tables.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    pub(crate) objects: usize,
    pub(crate) picked: usize,
    pub(crate) by_the_nearer_arm: usize,
    /// Refused because the gripper cannot hold them: too wide or too thin.
    pub(crate) too_wide: usize,
    /// Refused, and refused also where nothing else stands on the table.
    pub(crate) refused_alone: usize,
    /// Refused among the others, and whatever else was tried.
    pub(crate) refused_among: usize,
    /// Refused, but possible from another height, or to another place of handing over.
    pub(crate) possible_otherwise: usize,
    /// Number of refusals for each reason.
    pub(crate) reasons: BTreeMap<&'static str, usize>,
    pub(crate) plan_ms: Vec<f64>,
    pub(crate) refuse_ms: Vec<f64>,
    pub(crate) duration_s: Vec<f64>,
    /// Everything that went wrong: the seed's table and what.
    pub(crate) violations: Vec<String>,
}

impl Tally {
    pub(crate) fn add(&mut self, other: Self) {
        self.objects += other.objects;
        self.picked += other.picked;
        self.by_the_nearer_arm += other.by_the_nearer_arm;
        self.too_wide += other.too_wide;
        self.refused_alone += other.refused_alone;
        self.refused_among += other.refused_among;
        self.possible_otherwise += other.possible_otherwise;
        for (reason, count) in other.reasons {
            *self.reasons.entry(reason).or_default() += count;
        }
        self.plan_ms.extend(other.plan_ms);
        self.refuse_ms.extend(other.refuse_ms);
        self.duration_s.extend(other.duration_s);
        self.violations.extend(other.violations);
    }
}

/// Plans a pick of every object of one random table, and carries out every plan.
pub(crate) fn try_table(robot: &Robot, bench: &Bench, checker: &Checker<'_>, seed: u64) -> Tally {
    let objects = random_table(&mut Random::seeded(seed), bench);
    let settings = bench.settings;
    let mut tally = Tally { objects: objects.len(), ..Tally::default() };
    for (i, object) in objects.iter().enumerate() {
        let others = all_but(&objects, i);
        let clock = std::time::Instant::now();
        let plan = plan_pick(robot, object, None, &robot.neutral(), &others, &settings);
        let ms = clock.elapsed().as_secs_f64() * 1e3;
        match plan {
            Ok(plan) => {
                tally.picked += 1;
                tally.plan_ms.push(ms);
                tally.duration_s.push(plan.duration_s());
                tally.by_the_nearer_arm += usize::from(plan.limb().side() * object.xyz_m[1] >= 0.0);
                let limits = robot.arm(plan.limb()).limits.at_speed_ratio(settings.speed_ratio);
                let wrong = broken_limit(&plan, &limits)
                    .or_else(|| checker.violation(&plan, object, &others, settings.table_z_m));
                if let Some(wrong) = wrong {
                    let (t_s, what) = (wrong.t_s, wrong.what);
                    tally.violations.push(format!("table {seed} object {i}, {t_s:.2} s: {what}"));
                }
            }
            Err(error) => {
                *tally.reasons.entry(reason(&error)).or_default() += 1;
                if let PlanError::Grasp(_) = error {
                    tally.too_wide += 1;
                } else {
                    tally.refuse_ms.push(ms);
                    refused(robot, bench, object, &others, &mut tally);
                }
            }
        }
    }
    tally
}

/// Returns the reason of a refusal, as the planner gives it.
fn reason(error: &PlanError) -> &'static str {
    match error {
        PlanError::Grasp(GraspError::TooWide { .. }) => "too wide for the gripper",
        PlanError::Grasp(_) => "not to be grasped otherwise",
        PlanError::Start(_) => "a start outside the limits",
        PlanError::Unreachable { .. } => "out of reach",
        PlanError::Approach { .. } => "not from above",
        PlanError::Line { .. } => "no straight line to the grasp",
        PlanError::Blocked { .. } => "no room for the arm",
        PlanError::Stuck { .. } => "a start in collision",
        PlanError::NoPath { .. } => "no path",
    }
}

/// Kind of refusal.
fn refused(
    robot: &Robot,
    bench: &Bench,
    object: &ObjectPose,
    others: &[Cuboid],
    tally: &mut Tally,
) {
    let neutral = robot.neutral();
    let possible = |others: &[Cuboid], settings: &PlanSettings| {
        let mut limbs = robot.limbs().iter().copied();
        limbs.any(|limb| plan_pick(robot, object, Some(limb), &neutral, others, settings).is_ok())
    };
    if !possible(&[], &bench.settings) {
        tally.refused_alone += 1;
    } else if bench.variants().iter().any(|settings| possible(others, settings)) {
        tally.possible_otherwise += 1;
    } else {
        tally.refused_among += 1;
    }
}
