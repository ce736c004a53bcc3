//! Robot descriptions that others publish, written as whichone reads them.
//!
//! [`import`] reads a URDF with meshes, finds base, arm and gripper by structure, encloses the links in capsules,
//! and proposes what a robot needs besides: collision pairs, a posture of rest, a table, a hand-over, and a scene.
//! What it chose or had to assume is in [`Findings`].
//!
//! | contents | file |
//! |---|---|
//! | reader of URDF, of xacro by its program, of a published SRDF | `read.rs`, `xacro.rs`, `published.rs` |
//! | vertices of meshes | `mesh/` |
//! | base, lift, arm, gripper | `structure.rs`, `gripper.rs` |
//! | hulls and their distances, capsules round them | `points.rs`, `capsule.rs`, `shapes.rs` |
//! | collision pairs by sampling | `pairs.rs` |
//! | table, posture of rest, hand-over, blocks | `place.rs`, `site.rs` |
//! | the files | `write.rs`, `configuration.rs` |
//!
//! Units are metres, radians and newtons. The same file gives the same result.

mod capsule;
mod configuration;
mod gripper;
mod mesh;
mod options;
mod pairs;
mod place;
mod points;
mod published;
mod read;
mod report;
mod shapes;
mod site;
mod source;
mod structure;
mod write;
mod xacro;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use diagnostics::{Diagnostic, Diagnostics};
use manipulation::Robot;
use nalgebra::{Isometry3, Translation3, Vector3};

pub use options::{Gripper, Options};
pub use report::{Finding, Findings, Fit, Kind, PairCounts};

use capsule::Capsule;
use pairs::{Pair, Random};
use place::{BLOCKS, CLEARANCES_M, Placed, Progress};
use points::Hull;
use shapes::Shape;
use site::Site;
use source::Source;
use write::Import;

/// Files of an imported robot, as text.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// `robots/NAME.urdf`.
    pub urdf: String,
    /// `robots/NAME.srdf`.
    pub srdf: String,
    /// `scenes/NAME-blocks.toml`.
    pub scene: String,
    /// `profiles/NAME.toml`.
    pub profile: String,
    /// What was found and assumed.
    pub findings: Findings,
}

/// A description that cannot be imported.
#[derive(Debug)]
pub struct Refused {
    /// Everything that is in the way.
    pub faults: Diagnostics,
    /// What was found until then.
    pub findings: Findings,
}

/// Positions of frame base behind the arm's base that are tried, metres: the table begins 0.4 m ahead of the frame, which
/// is too far for a small arm.
const BEHIND_M: [f64; 4] = [0.0, 0.12, 0.22, 0.32];

/// An arm whose base is no higher than this above the lowest part stands on the table, metres.
const ON_TABLE_M: f64 = 0.3;

/// Heights of a table that are tried, metres: below where the arm stands, and below the base of an arm on a body.
const STANDING_M: [f64; 3] = [0.0, -0.1, 0.08];
const MOUNTED_M: [f64; 4] = [-0.2, -0.3, -0.1, -0.4];

/// Seed of the postures in which pairs are looked at.
const SEED: u64 = 1;

/// Imports a description.
///
/// # Errors
/// Everything that is in the way, at once.
pub fn import(file: &Path, options: &Options) -> Result<Imported, Box<Refused>> {
    let mut findings = Findings::default();
    let imported = imported(file, options, &mut findings);
    match imported {
        Ok(files) => Ok(Imported { findings, ..files }),
        Err(faults) => Err(Box::new(Refused { faults, findings })),
    }
}

fn imported(
    file: &Path,
    options: &Options,
    findings: &mut Findings,
) -> Result<Imported, Diagnostics> {
    let label = file.display().to_string();
    let source = read_source(file, &label, findings)?;
    let arm = structure::find(&source, options, findings).map_err(|mut fault| {
        if fault.file.is_empty() {
            fault.file.clone_from(&label);
        }
        Diagnostics::from(fault)
    })?;
    let (mut hulls, is_missing) = shapes::hulls(&source, file, findings);
    let is_guessed = shapes::guess(&source, &arm, &mut hulls, &is_missing, findings);
    let gripper = gripper::find(&source, &arm, &hulls, options.open_m, findings);
    let published = published_pairs(file, options, &source, &hulls, findings);
    let mut still = gripper.open.clone();
    arm.lift.iter().for_each(|joint| still[*joint] = structure::middle(&source, *joint));
    arm.joints.iter().for_each(|joint| still[*joint] = source.joints[*joint].zero());
    let pairs = pairs::sample(&source, &arm, &hulls, &still, SEED);
    findings.pairs = pairs.counts(&published);
    let bounds = arm.joints.iter().map(|joint| write::bounds(&source.joints[*joint], findings));
    let bounds: Vec<write::Bounds> = bounds.collect();
    let mut at_rest = still.clone();
    arm.joints.iter().for_each(|joint| at_rest[*joint] = 0.0);
    let rest = source.poses(&at_rest);
    let mut import = Import {
        name: &options.name,
        file: file.file_name().and_then(|name| name.to_str()).unwrap_or_default(),
        source: &source,
        arm: &arm,
        gripper: &gripper,
        names: write::Names::default(),
        bounds,
        shapes: Vec::new(),
        mount: Isometry3::from_parts(
            rest[arm.base].translation,
            site::ahead(&source, &arm, &gripper, &rest),
        ),
        rest,
        pairs,
        fat: Vec::new(),
    };
    import.names = write::Names::new(&import, findings);
    import.shapes = import.fitted(&hulls, &is_guessed, findings);
    import.fat = import.overlapping(&hulls, &still);
    let name = |link: usize| source.links[link].name.clone();
    findings.pairs.fat = import.fat.iter().map(|(a, b)| (name(*a), name(*b))).collect();
    let placed = import.placed(&hulls, &label, findings)?;
    Ok(import.files(&placed))
}

fn read_source(file: &Path, label: &str, findings: &mut Findings) -> Result<Source, Diagnostics> {
    let unreadable = |error: std::io::Error| {
        Diagnostic::new(label, "", error.to_string(), "name a URDF or a xacro")
    };
    let bytes = fs::read(file).map_err(unreadable)?;
    let mut text = String::from_utf8_lossy(&bytes).into_owned();
    if xacro::is(file, &text) {
        text = xacro::expanded(file)?;
        findings.chosen("the file is xacro: it was expanded");
    }
    read::read(label, &text, findings)
}

/// Returns the pairs of the SRDF that is named, or that lies beside the file, of links with shapes.
fn published_pairs(
    file: &Path,
    options: &Options,
    source: &Source,
    hulls: &[Vec<Hull>],
    findings: &mut Findings,
) -> BTreeSet<Pair> {
    let srdf = options.srdf.clone().unwrap_or_else(|| file.with_extension("srdf"));
    let Ok(text) = fs::read_to_string(&srdf) else { return BTreeSet::new() };
    let all = published::pairs(&text, source, findings);
    all.into_iter().filter(|(a, b)| !hulls[*a].is_empty() && !hulls[*b].is_empty()).collect()
}

/// Distance that plans keep between the shapes of an arm, and a little more, metres.
const KEPT_M: f64 = 0.012;

/// Postures in which shapes are compared with hulls.
const COMPARED: usize = 300;

impl Import<'_> {
    /// Whether a link moves with the arm.
    fn is_of_arm(&self, link: usize) -> bool {
        self.source.is_below(link, self.source.joints[self.arm.joints[0]].child)
    }

    /// Returns the shapes of each link, and reports how they fit.
    fn fitted(
        &self,
        hulls: &[Vec<Hull>],
        is_guessed: &[bool],
        findings: &mut Findings,
    ) -> Vec<Vec<Shape>> {
        let source = self.source;
        let tips = self.rest[self.arm.last] * self.gripper.frame;
        let mut all = Vec::new();
        for (link, own) in hulls.iter().enumerate() {
            let is_hand = source.is_below(link, self.arm.last);
            // A jaw that closes reaches further out than an open one.
            let closed = self
                .gripper
                .jaw
                .as_ref()
                .map(|jaw| source.poses(&jaw.closed))
                .map(|poses| poses[link].inverse() * poses[self.arm.last] * self.gripper.frame);
            let open = self.rest[link].inverse() * tips;
            let tips =
                if is_hand { std::iter::once(open).chain(closed).collect() } else { Vec::new() };
            let shapes = if self.is_of_arm(link) {
                shapes::of_arm(own, &tips)
            } else {
                shapes::of_body(own, &self.rest[link])
            };
            if !own.is_empty() {
                findings.fits.push(shapes::fit(
                    &source.links[link].name,
                    own,
                    &shapes,
                    is_guessed[link],
                ));
            }
            all.push(shapes);
        }
        if self.gripper.is_drawn || self.has_bare_fingers(hulls) {
            let drawn = shapes::drawn(self.gripper).into_iter();
            all[self.arm.last].extend(drawn.map(|shape| shape.at(&self.gripper.frame)));
        }
        all
    }

    /// Whether the description shows no fingers.
    fn has_bare_fingers(&self, hulls: &[Vec<Hull>]) -> bool {
        let fingers = self.arm.fingers.iter().map(|joint| self.source.joints[*joint].child);
        let mut below = fingers.flat_map(|finger| {
            (0..hulls.len()).filter(move |link| self.source.is_below(*link, finger))
        });
        !self.arm.fingers.is_empty() && below.all(|link| hulls[link].is_empty())
    }

    /// Returns the pairs whose shapes overlap in most postures in which the links themselves are apart.
    fn overlapping(&self, hulls: &[Vec<Hull>], still: &[f64]) -> Vec<Pair> {
        let excused: BTreeSet<Pair> = self.pairs.excused().map(|(pair, _)| pair).collect();
        let solid: Vec<usize> =
            (0..hulls.len()).filter(|link| !self.shapes[*link].is_empty()).collect();
        let all =
            solid.iter().enumerate().flat_map(|(at, a)| solid[at + 1..].iter().map(|b| (*a, *b)));
        let all: Vec<Pair> = all
            .filter(|pair| {
                !excused.contains(pair) && (self.is_of_arm(pair.0) || self.is_of_arm(pair.1))
            })
            .collect();
        let mut random = Random::new(SEED + 1);
        let mut counts = vec![(0usize, 0usize); all.len()];
        for _ in 0..COMPARED {
            let mut q = still.to_vec();
            for joint in &self.arm.joints {
                let (low, high) = self.source.joints[*joint].span();
                q[*joint] = low + (high - low) * random.unit();
            }
            let poses = self.source.poses(&q);
            for (pair, (apart, overlap)) in all.iter().zip(&mut counts) {
                if self.are_apart(hulls, &poses, *pair) {
                    *apart += 1;
                    *overlap += usize::from(self.do_overlap(&poses, *pair));
                }
            }
        }
        let often = |(_, (apart, overlap)): &(&Pair, &(usize, usize))| 2 * overlap > *apart;
        all.iter().zip(&counts).filter(often).map(|(pair, _)| *pair).collect()
    }

    fn are_apart(&self, hulls: &[Vec<Hull>], poses: &[Isometry3<f64>], (a, b): Pair) -> bool {
        let placed = |link: usize| hulls[link].iter().map(move |hull| hull.at(&poses[link]));
        let theirs: Vec<Hull> = placed(b).collect();
        placed(a).all(|own| theirs.iter().all(|it| own.distance(it, 0.0) > 0.0))
    }

    fn do_overlap(&self, poses: &[Isometry3<f64>], (a, b): Pair) -> bool {
        let placed = |link: usize| {
            self.shapes[link].iter().filter_map(move |shape| match shape {
                Shape::Capsule(capsule) => Some(capsule.at(&poses[link])),
                Shape::Box { .. } => None,
            })
        };
        let theirs: Vec<Capsule> = placed(b).collect();
        placed(a).any(|own| theirs.iter().any(|it| own.to(it) < KEPT_M))
    }

    /// Returns the text of every file.
    fn files(&self, placed: &Placed) -> Imported {
        Imported {
            urdf: write::urdf(self),
            srdf: write::srdf(self, &self.postures(&placed.postures)),
            scene: configuration::scene(self.name, placed),
            profile: configuration::profile(self.name, placed),
            findings: Findings::default(),
        }
    }

    fn postures(&self, postures: &[(&'static str, manipulation::Joints)]) -> Vec<write::Posture> {
        let count = self.arm.joints.len();
        let rounded = |at: &f64| (at * 1e4).round() / 1e4;
        let inside = |(joint, at): (usize, f64)| {
            let (low, high) = self.bounds[joint].range;
            at.clamp(low, high)
        };
        let own = |(name, q): &(&'static str, manipulation::Joints)| {
            let at = q[..count].iter().map(rounded).enumerate().map(inside);
            (*name, at.collect())
        };
        postures.iter().map(own).collect()
    }

    /// Returns the robot as the planner reads it.
    fn robot(&self, postures: &[write::Posture]) -> Result<Robot, String> {
        let (urdf, srdf) = (write::urdf(self), write::srdf(self, postures));
        let read = robot_model::Robot::parse(&urdf, Some(&srdf));
        let description = read.map_err(|faults| faults.to_string())?;
        Robot::from_description(&description).map_err(|fault| fault.to_string())
    }

    /// Tries mounts and tables until rest, hand-over and blocks fit.
    fn placed(
        &mut self,
        hulls: &[Vec<Hull>],
        label: &str,
        findings: &mut Findings,
    ) -> Result<Placed, Diagnostics> {
        let (base, site) = (self.mount, site::of(self, self.floor_m(hulls) > -ON_TABLE_M));
        let middle =
            self.bounds.iter().map(|bounds| 0.5 * (bounds.range.0 + bounds.range.1)).collect();
        let placeholder = [("neutral", middle)];
        let mut best = Progress::default();
        for behind_m in if site.is_small() { &BEHIND_M[..1] } else { &BEHIND_M } {
            self.mount = base * Translation3::new(-*behind_m, 0.0, 0.0);
            let robot = self.robot(&placeholder).map_err(|what| {
                Diagnostic::new(
                    label,
                    "robot",
                    what,
                    "report it: the files that import writes must be readable",
                )
            })?;
            for table_z_m in self.tables(hulls, site) {
                let with_rest = |postures: &[(&'static str, manipulation::Joints)]| {
                    self.robot(&self.postures(postures)).ok()
                };
                match place::on_table(&robot, self.gripper, (site, table_z_m), with_rest) {
                    Ok(placed) => {
                        self.tell(*behind_m, &placed, findings);
                        return Ok(placed);
                    }
                    Err(progress) => best = best.max(progress),
                }
            }
        }
        Err(unplaced(label, &best).into())
    }

    /// Heights of the table, metres in frame base.
    fn tables(&self, hulls: &[Vec<Hull>], site: &Site) -> Vec<f64> {
        let floor = self.floor_m(hulls);
        let round = |m: f64| (m * 1e3).round() / 1e3 + 0.0;
        if site.is_small() {
            vec![round(floor)]
        } else if floor > -ON_TABLE_M {
            STANDING_M.iter().map(|step| round(floor + step)).collect()
        } else {
            MOUNTED_M.to_vec()
        }
    }

    /// Height of the lowest part of what does not move with the arm, metres in frame base.
    fn floor_m(&self, hulls: &[Vec<Hull>]) -> f64 {
        let body = (0..hulls.len()).filter(|link| !self.is_of_arm(*link));
        let lowest = |link: usize| {
            let origin = self.rest[link].translation.z;
            let placed = hulls[link].iter().map(|hull| hull.at(&self.rest[link]));
            placed.map(|hull| hull.extent(&Vector3::z()).0).fold(origin, f64::min)
        };
        body.map(lowest).fold(self.mount.translation.z, f64::min) - self.mount.translation.z
    }

    fn tell(&self, behind_m: f64, placed: &Placed, findings: &mut Findings) {
        let base = &self.source.links[self.arm.base].name;
        let behind = match behind_m {
            0.0 => String::new(),
            m => format!(", {:.0} mm behind it, so that the table begins within reach", m * 1e3),
        };
        let x =
            if self.mount.rotation.angle() > 1e-6 { "ahead of the arm" } else { "as in the file" };
        findings.chosen(format!("frame base: at {base}, upright, x {x}{behind}"));
        let table = placed.table_z_m * 1e3;
        let edge = match placed.site.is_small() {
            true => "all around it, since the arm is small and stands there".to_owned(),
            false => format!("from {:.0} mm ahead of it", placed.site.near_m * 1e3),
        };
        findings.assumed(format!("table: {table:.0} mm from frame base in height, {edge}"));
        let [x, y, z] = placed.hand_over_m;
        findings.chosen(format!("hand-over: at {x} {y} {z} m"));
        let (asked, kept) = (CLEARANCES_M[0] * 1e3, placed.clearance_m * 1e3);
        if kept < asked {
            findings.assumed(format!(
                "posture of rest: {kept:.0} mm of clearance, {asked:.0} mm were not found"
            ));
        } else {
            findings.chosen(format!("posture of rest: the gripper points down above the table, {kept:.0} mm clear of everything"));
        }
        findings.missing(
            "acceleration and jerk of the joints: 2 rad/s² and 20 rad/s³ are assumed".to_owned(),
        );
        findings.missing("a driver of the real arm: arm.driver is the kinematic model".to_owned());
    }
}

fn unplaced(label: &str, best: &Progress) -> Diagnostic {
    let what = if best.places < BLOCKS {
        format!(
            "the gripper reaches {} places on a table from above, {BLOCKS} are needed: the arm is too short, or its gripper \
             does not point down",
            best.places
        )
    } else if !best.rests {
        format!("no posture above the table is clear of the arm itself and its body: {}", best.why)
    } else {
        let (count, why) = (best.blocks, &best.why);
        format!(
            "{count} of {BLOCKS} blocks can be fetched and handed over, wherever they stand: {why}"
        )
    };
    let help = "check --tip and --gripper, or the size of the shapes that import lists";
    Diagnostic::new(label, "robot", what, help)
}

impl Shape {
    /// The same at a pose.
    fn at(&self, pose: &Isometry3<f64>) -> Self {
        match self {
            Self::Capsule(capsule) => Self::Capsule(capsule.at(pose)),
            Self::Box { pose: own, size } => Self::Box { pose: pose * own, size: *size },
        }
    }
}
