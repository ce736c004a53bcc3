//! Where the arm stands and works: height of the table, posture of rest, place of the hand-over, and blocks within reach.

use std::f64::consts::TAU;

use manipulation::{
    ArmShape, Chain, Cuboid, Gap, Joints, Limb, ObjectPose, PlanSettings, Robot, fetching_limb,
    plan_pick,
};
use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion, Vector3};

use crate::gripper::Gripper;
use crate::site::Site;

/// Clearances of the posture of rest that are tried, metres: the first is what it should have.
pub(crate) const CLEARANCES_M: [f64; 3] = [0.03, 0.02, 0.01];

/// Margin between the arm and itself in the configuration, metres.
const MARGIN_M: f64 = 0.01;

/// Length of the table that the planner assumes, and half of its width, metres.
const TABLE_FAR_M: f64 = 1.1;
const TABLE_Y_M: f64 = 1.2;

/// Size of the grid of places on the table.
const GRID_X: i32 = 14;
const GRID_Y: i32 = 8;

/// Places that are looked at for the blocks of one hand-over: an object that cannot be fetched takes a while.
const LOOKS_MAX: usize = 60;

/// Blocks in the scene.
pub(crate) const BLOCKS: usize = 6;

/// What fits the robot.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    pub(crate) site: &'static Site,
    pub(crate) table_z_m: f64,
    pub(crate) hand_over_m: [f64; 3],
    /// Named postures, the first is `neutral`.
    pub(crate) postures: Vec<(&'static str, Joints)>,
    /// Clearance of the posture of rest, metres.
    pub(crate) clearance_m: f64,
    /// Blocks, small and large in turn.
    pub(crate) blocks: Vec<ObjectPose>,
}

/// How far a search came, for the message of one that failed.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Progress {
    /// Blocks that were placed.
    pub(crate) blocks: usize,
    /// Whether the arm can rest above the table.
    pub(crate) rests: bool,
    /// Places on the table that the gripper reaches from above.
    pub(crate) places: usize,
    /// What was in the way then; empty where nothing is known.
    pub(crate) why: String,
}

/// Returns the table at a height.
fn table(site: &Site, z_m: f64) -> Cuboid {
    let (near, far) = (site.near_m, site.near_m.max(0.0) + TABLE_FAR_M);
    Cuboid {
        centre: [0.5 * (near + far), 0.0, z_m - 0.25],
        size: [far - near, 2.0 * TABLE_Y_M, 0.5],
        yaw: 0.0,
    }
}

/// Returns the gripper at a point, pointing down, with its fingers moving at `yaw`.
fn down([x, y, z]: [f64; 3], yaw: f64) -> Isometry3<f64> {
    let (sin, cos) = yaw.sin_cos();
    let (along, out) = (Vector3::new(cos, sin, 0.0), -Vector3::z());
    let turn = Rotation3::from_basis_unchecked(&[along.cross(&out), along, out]);
    let rotation = UnitQuaternion::from_rotation_matrix(&turn);
    Isometry3::from_parts(Translation3::new(x, y, z), rotation)
}

/// Directions of the fingers.
fn yaws(count: u32) -> impl Iterator<Item = f64> {
    (0..count).map(move |k| f64::from(k) * std::f64::consts::PI / f64::from(count) * 2.0)
}

/// Returns the least distance of the arm from itself, the body and the table, metres, at most 0.1.
fn clearance(robot: &Robot, q: &Joints, table: &Cuboid) -> f64 {
    gap(robot, q, table).distance_m
}

/// Returns what is least far apart of the arm, the body and the table, within 0.1 m.
fn gap(robot: &Robot, q: &Joints, table: &Cuboid) -> Gap {
    let shape = ArmShape::at(robot.arm(Limb::Only), q);
    let gap = shape.to_itself(0.1).min(shape.to_trunk(0.1));
    gap.min(shape.to_cuboid("table", table, gap.distance_m))
}

/// A place on the table, and the posture above it.
type Place = ([f64; 2], Joints);

/// Searches the places that the gripper reaches from above. Neighbours are reached in neighbouring postures, which are
/// found quickly; only the first place is searched for.
struct Places<'a> {
    robot: &'a Robot,
    site: &'a Site,
    table_z_m: f64,
    table: Cuboid,
}

impl Places<'_> {
    /// Returns the places, the nearest to their middle first.
    fn all(&self) -> Vec<[f64; 2]> {
        let cell = |(x, y): (i32, i32)| {
            [self.site.from_m + f64::from(x) * self.site.grid_m, f64::from(y) * self.site.grid_m]
        };
        let Some((first, posture)) = STARTS.iter().find_map(|at| {
            let mut found = yaws(4).filter_map(|yaw| self.searched(cell(*at), yaw));
            Some((*at, found.next()?))
        }) else {
            return Vec::new();
        };
        let (mut seen, mut waiting) = (vec![first], vec![(first, posture)]);
        let mut found: Vec<Place> = Vec::new();
        while let Some((at, posture)) = waiting.pop() {
            found.push((cell(at), posture));
            for (dx, dy) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
                let next = (at.0 + dx, at.1 + dy);
                let is_on_grid =
                    (0..GRID_X).contains(&next.0) && (-GRID_Y..=GRID_Y).contains(&next.1);
                if !is_on_grid || seen.contains(&next) {
                    continue;
                }
                if let Some(posture) = self.followed(cell(next), &posture) {
                    seen.push(next);
                    waiting.push((next, posture));
                }
            }
        }
        let count = found.len().max(1) as f64;
        let sum = found.iter().fold([0.0, 0.0], |sum, (at, _)| [sum[0] + at[0], sum[1] + at[1]]);
        let middle = sum.map(|sum| sum / count);
        let mut all: Vec<[f64; 2]> = found.into_iter().map(|(at, _)| at).collect();
        let from_middle = |at: &[f64; 2]| (at[0] - middle[0]).hypot(at[1] - middle[1]);
        // Equal distances keep an order of their own.
        all.sort_by(|a, b| from_middle(a).total_cmp(&from_middle(b)).then(b[1].total_cmp(&a[1])));
        all
    }

    fn hover_m(&self) -> f64 {
        self.table_z_m + self.site.grasp_m + self.site.hover_m
    }

    /// Returns a clear posture above a place from which the gripper reaches down to it.
    fn searched(&self, [x, y]: [f64; 2], yaw: f64) -> Option<Joints> {
        let chain = &self.robot.arm(Limb::Only).chain;
        let hover = down([x, y, self.hover_m()], yaw);
        chain.inverse(&hover, None).ok()?;
        distinct(chain, &hover).into_iter().take(LOOKED_AT).find(|q| self.descends(q))
    }

    /// Does the same in a posture near one that is given.
    fn followed(&self, [x, y]: [f64; 2], q: &Joints) -> Option<Joints> {
        let chain = &self.robot.arm(Limb::Only).chain;
        let mut hover = chain.forward(q);
        hover.translation = Translation3::new(x, y, self.hover_m());
        let near = chain.track(&hover, q).ok()?.q;
        self.descends(&near).then_some(near)
    }

    fn descends(&self, q: &Joints) -> bool {
        let chain = &self.robot.arm(Limb::Only).chain;
        let mut grasp = chain.forward(q);
        grasp.translation.z = self.table_z_m + self.site.grasp_m;
        let is_clear = |q: &Joints| clearance(self.robot, q, &self.table) > 0.0;
        is_clear(q) && chain.line(q, &grasp).is_ok_and(|way| way.iter().all(is_clear))
    }
}

/// Returns the postures that reach a pose, each joint turned as near to zero as its limits let it: whole turns make no
/// other posture.
fn distinct(chain: &Chain, target: &Isometry3<f64>) -> Vec<Joints> {
    let mut all: Vec<Joints> = Vec::new();
    for mut q in chain.solutions(target) {
        for (at, (low, high)) in q.iter_mut().zip(chain.limits().0) {
            let near = *at - (*at / TAU).round() * TAU;
            if (low..=high).contains(&near) {
                *at = near;
            }
        }
        let is_same = |other: &Joints| other.iter().zip(&q).all(|(a, b)| (a - b).abs() < SAME_RAD);
        if !all.iter().any(is_same) {
            all.push(q);
        }
    }
    all
}

/// Postures that differ by less in each joint are the same, radians.
const SAME_RAD: f64 = 1e-3;

/// Steps of the grid at which the search begins.
const STARTS: [(i32, i32); 6] = [(2, 0), (4, 0), (0, 0), (2, 3), (2, -3), (6, 0)];

/// Postures of one place that are looked at.
const LOOKED_AT: usize = 40;

/// Comfort of a posture of rest that ends the search.
const COMFORTABLE: f64 = 0.1;

/// Returns the best posture above the table, and its clearance: the gripper points down, and the joints are far from
/// their limits.
///
/// # Errors
/// What is in the way in the posture with the greatest clearance.
fn rest(
    robot: &Robot,
    at: [f64; 2],
    (site, table_z_m): (&Site, f64),
) -> Result<(Joints, f64), String> {
    let (chain, table) = (&robot.arm(Limb::Only).chain, table(site, table_z_m));
    let ranges = &chain.limits().0[..chain.joints()];
    let comfort = |q: &Joints| {
        let shares = ranges.iter().zip(q).map(|((low, high), at)| {
            let half = 0.5 * (high - low).min(TAU);
            ((at - low).min(high - at) / half.max(1e-6)).min(1.0)
        });
        let turned: f64 = q.iter().take(chain.joints()).map(|at| at.abs()).sum();
        shares.fold(f64::INFINITY, f64::min) - 0.02 * turned
    };
    // The best of each clearance, the greatest first.
    let mut best: [Option<(f64, Joints)>; CLEARANCES_M.len()] = [None; CLEARANCES_M.len()];
    let mut widest = Gap::none(f64::NEG_INFINITY);
    for height_m in site.rest_m {
        let targets = yaws(4).map(|yaw| down([at[0], at[1], table_z_m + height_m], yaw));
        for q in targets.flat_map(|target| distinct(chain, &target)) {
            let (comfort, gap) = (comfort(&q), gap(robot, &q, &table));
            if gap.distance_m > widest.distance_m {
                widest = gap;
            }
            let level = CLEARANCES_M.iter().position(|least_m| gap.distance_m >= *least_m);
            let Some(level) = level else { continue };
            if best[level].is_none_or(|(most, _)| comfort > most) {
                best[level] = Some((comfort, q));
            }
        }
        if best[0].is_some_and(|(comfort, _)| comfort > COMFORTABLE) {
            break;
        }
    }
    let found = best.iter().zip(CLEARANCES_M).find_map(|(it, least_m)| Some(((*it)?.1, least_m)));
    found.ok_or_else(|| {
        let (link, other, mm) = (widest.link, widest.other, widest.distance_m * 1e3);
        if widest.is_some() {
            format!("its {link} is {mm:.0} mm from {other} at best")
        } else {
            "the gripper does not come high enough".to_owned()
        }
    })
}

/// Returns the posture of rest with the greatest clearance of some places, and the clearance.
///
/// # Errors
/// What is in the way.
fn rest_near(robot: &Robot, middle: [f64; 2], site: (&Site, f64)) -> Result<(Joints, f64), String> {
    let mut found: Result<(Joints, f64), String> = Err(String::new());
    let step_m = site.0.grid_m;
    for x in [-step_m, 0.0, -2.0 * step_m, step_m].map(|by| middle[0] + by) {
        let next = rest(robot, [x, 0.0], site);
        let is_better = match (&next, &found) {
            (Ok(next), Ok(found)) => next.1 > found.1,
            (_, Err(_)) => true,
            (Err(_), Ok(_)) => false,
        };
        if is_better {
            found = next;
        }
        if found.as_ref().is_ok_and(|(_, clearance_m)| *clearance_m >= CLEARANCES_M[0]) {
            break;
        }
    }
    found
}

/// Returns the posture of rest and others to either side of it that are within the limits.
fn around(robot: &Robot, neutral: Joints) -> Vec<(&'static str, Joints)> {
    let chain = &robot.arm(Limb::Only).chain;
    let (low, high) = chain.limits().0[0];
    let turned = [("left", 0.8), ("right", -0.8)].map(|(name, by)| {
        let mut q = neutral;
        q[0] += by;
        (name, q)
    });
    let fits = |(_, q): &(&str, Joints)| (low..=high).contains(&q[0]);
    [("neutral", neutral)].into_iter().chain(turned.into_iter().filter(fits)).collect()
}

/// Widths of a small and of a large block, metres.
fn widths(gripper: &Gripper, site: &Site) -> [f64; 2] {
    let range = gripper.open_m - gripper.closed_m;
    let at = |share: f64| gripper.closed_m + share * range;
    let rounded = |m: f64| (m * 1e3).floor() / 1e3;
    let small = rounded(at(0.45).min(site.widths_m[0]).max(at(0.2)));
    let large = rounded(at(0.7).min(site.widths_m[1]).max(small + 0.004).min(at(0.9)));
    [small, large]
}

fn block(
    number: usize,
    [x, y]: [f64; 2],
    (site, table_z_m): (&Site, f64),
    widths: &[f64; 2],
) -> ObjectPose {
    let width = widths[number % 2];
    let size_m =
        if number.is_multiple_of(2) { [width; 3] } else { [1.5 * width, width, 1.5 * width] };
    let size_m = size_m.map(|edge| (edge * 1e3).round() / 1e3);
    ObjectPose {
        xyz_m: [x, y, table_z_m + 0.5 * size_m[2]].map(|m| (m * 1e4).round() / 1e4),
        yaw_rad: 0.0,
        size_m,
        grasp_width_m: size_m[1],
        mass_kg: Some(site.masses_kg[number % 2]),
        wall_rad: 0.0,
        hollow: false,
    }
}

/// Settings of plans as they will be in the profile; the others are those of `arm.toml`.
fn settings((site, table_z_m): (&Site, f64), hand_over_xyz_m: [f64; 3]) -> PlanSettings {
    PlanSettings {
        speed_ratio: 0.6,
        hover_m: site.hover_m,
        standoff_m: site.standoff_m,
        table_near_m: site.near_m,
        hand_over_xyz_m,
        table_z_m,
        margin_m: MARGIN_M,
        ..PlanSettings::default()
    }
}

/// Searches rest, hand-over and blocks for a table of this height. `with_rest` makes the robot with a posture of rest.
///
/// # Errors
/// How far it came.
pub(crate) fn on_table(
    robot: &Robot,
    gripper: &Gripper,
    (site, table_z_m): (&'static Site, f64),
    with_rest: impl Fn(&[(&'static str, Joints)]) -> Option<Robot>,
) -> Result<Placed, Progress> {
    let places = Places { robot, site, table_z_m, table: table(site, table_z_m) }.all();
    let mut progress = Progress { places: places.len(), ..Progress::default() };
    let Some(&middle) = places.first().filter(|_| places.len() >= BLOCKS) else {
        return Err(progress);
    };
    let (neutral, clearance_m) = match rest_near(robot, middle, (site, table_z_m)) {
        Ok(found) => found,
        Err(why) => return Err(Progress { why, ..progress }),
    };
    progress.rests = true;
    let postures = around(robot, neutral);
    let Some(robot) = with_rest(&postures) else { return Err(progress) };
    let widths = widths(gripper, site);
    for hand_over_m in hand_overs(&places, middle, (site, table_z_m)) {
        let plan = settings((site, table_z_m), hand_over_m);
        let (blocks, mut why) = blocks(&robot, (&places, site), hand_over_m, &widths, &plan);
        if let Some(error) = unplanned(&robot, &blocks, &plan) {
            why = error;
        } else if blocks.len() == BLOCKS {
            return Ok(Placed { site, table_z_m, hand_over_m, postures, clearance_m, blocks });
        }
        if blocks.len() > progress.blocks || progress.blocks == 0 {
            (progress.blocks, progress.why) = (blocks.len(), why);
        }
    }
    Err(progress)
}

/// Returns why the whole motion for one of the blocks cannot be planned; `None` if all can.
fn unplanned(robot: &Robot, blocks: &[ObjectPose], plan: &PlanSettings) -> Option<String> {
    let rest = robot.neutral();
    blocks.iter().enumerate().find_map(|(i, block)| {
        let others = blocks.iter().enumerate().filter(|(j, _)| *j != i);
        let others: Vec<Cuboid> = others.map(|(_, it)| it.cuboid()).collect();
        let planned = plan_pick(robot, block, None, &rest, &others, plan);
        planned.err().map(|error| error.to_string())
    })
}

/// Places of the hand-over that are tried: to the left of what the arm reaches, then nearer and to the right.
fn hand_overs(
    places: &[[f64; 2]],
    middle: [f64; 2],
    (site, table_z_m): (&Site, f64),
) -> Vec<[f64; 3]> {
    let left = places.iter().map(|at| at[1]).fold(0.0, f64::max);
    let right = places.iter().map(|at| at[1]).fold(0.0, f64::min);
    let mut all = Vec::new();
    for share in [0.9, 0.75, 0.6] {
        let back_m = if site.is_small() { 0.02 } else { 0.05 };
        let [high, low] = site.hand_over_m;
        for x in [middle[0] - back_m, middle[0] - 2.0 * back_m, middle[0]] {
            for (side, z) in [(left, high), (right, high), (left, low), (right, low)] {
                let round = |m: f64| (m * 100.0).round() / 100.0;
                all.push([round(x), round(share * side), round(table_z_m + z)]);
            }
        }
    }
    all
}

/// Returns as many blocks as can be fetched, each with all others in place, and why the last one that was tried cannot.
fn blocks(
    robot: &Robot,
    (places, site): (&[[f64; 2]], &Site),
    hand_over_m: [f64; 3],
    widths: &[f64; 2],
    plan: &PlanSettings,
) -> (Vec<ObjectPose>, String) {
    let (mut placed, mut why) = (Vec::<ObjectPose>::new(), String::new());
    let is_far = |at: &[f64; 2], x: f64, y: f64| (at[0] - x).hypot(at[1] - y) >= site.apart_m;
    let fetches = |placed: &[ObjectPose], i: usize| {
        let others = placed.iter().enumerate().filter(|(j, _)| *j != i);
        let others: Vec<Cuboid> = others.map(|(_, it)| it.cuboid()).collect();
        fetching_limb(robot, &placed[i], None, &others, plan)
    };
    for at in places.iter().take(LOOKS_MAX) {
        if !is_far(at, hand_over_m[0], hand_over_m[1])
            || !placed.iter().all(|it| is_far(at, it.xyz_m[0], it.xyz_m[1]))
        {
            continue;
        }
        placed.push(block(placed.len(), *at, (site, plan.table_z_m), widths));
        let last = placed.len() - 1;
        let mut all = (0..=last).rev().map(|i| fetches(&placed, i));
        if let Some(error) = all.find_map(Result::err) {
            why = error.to_string();
            placed.pop();
            // The first place is the best one: where it fails, so does the hand-over.
            if placed.is_empty() {
                break;
            }
        }
        if placed.len() == BLOCKS {
            break;
        }
    }
    (placed, why)
}
