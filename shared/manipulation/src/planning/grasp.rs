//! Poses of objects, and grasps from above.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion, Vector2, Vector3};

use crate::collision::Cuboid;
use crate::gripper::Gripper;
use crate::kinematics::chain::positive;

#[cfg(test)]
mod tests;

/// An object that stands upright in frame `base`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectPose {
    /// Centre, metres.
    pub xyz_m: [f64; 3],
    /// Rotation about the vertical, radians.
    pub yaw_rad: f64,
    /// Extents along its own x, y and z, metres.
    pub size_m: [f64; 3],
    /// Width that the gripper closes on, metres: its thickness, or that of its rim.
    pub grasp_width_m: f64,
    /// Mass, kilograms, where it is known.
    pub mass_kg: Option<f64>,
    /// Slope of the wall below the rim, radians from the vertical, outwards: what is gripped at its rim
    /// is gripped along the wall, so that the fingers do not turn it.
    pub wall_rad: f64,
    /// Whether it has a rim with room inside for a finger: a bowl, a cup, a box without a lid.
    pub hollow: bool,
}

/// A grasp of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grasp {
    /// Pose of `<limb>_gripper` in `base` as the fingers close: its z axis straight down, or down
    /// along a sloped wall, the fingers moving along its y axis.
    pub gripper: Isometry3<f64>,
    /// Width between the fingers once closed, metres.
    pub width_m: f64,
}

/// An object without a possible grasp.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum GraspError {
    /// The fingers do not open that wide.
    #[error(
        "the gripper would close on {:.0} mm but opens {:.0} mm at most",
        width_m * 1e3,
        open_m * 1e3
    )]
    TooWide {
        /// The object's grasp width, metres.
        width_m: f64,
        /// Opening of the gripper, metres.
        open_m: f64,
    },
    /// The fingers do not close that far, or cannot tell the object from nothing.
    #[error(
        "the gripper would close on {:.1} mm but holds {:.1} mm at least",
        width_m * 1e3,
        least_m * 1e3
    )]
    TooThin {
        /// The object's grasp width, metres.
        width_m: f64,
        /// Least width that the gripper holds and detects, metres.
        least_m: f64,
    },
    /// It is wider than the fingers open, and has no rim that they could take instead.
    #[error(
        "it is solid and {:.0} mm wide between the fingers, which open {:.0} mm at most",
        extent_m * 1e3,
        open_m * 1e3
    )]
    NoRim {
        /// The smaller one of its horizontal extents, metres.
        extent_m: f64,
        /// Opening of the gripper, metres.
        open_m: f64,
    },
    /// The fingers do not press hard enough.
    #[error(
        "it weighs {mass_kg:.2} kg, and fingers that press with {force_n:.0} N hold {most_kg:.2} kg at most there"
    )]
    TooHeavy {
        /// The object's mass, kilograms.
        mass_kg: f64,
        /// Greatest mass that is held so, kilograms.
        most_kg: f64,
        /// Force of each finger, newtons.
        force_n: f64,
    },
    /// A number that no object has.
    #[error("{what} must be a finite number{}", if *positive { " above zero" } else { "" })]
    Malformed {
        /// Name.
        what: &'static str,
        /// `true` if it must also be positive.
        positive: bool,
    },
}

/// Depth of the fingertips below the top of a tall enough object, metres.
const DEPTH_M: f64 = 0.02;

/// Fingertips stay this far above what the object stands on, metres.
const TIP_CLEAR_M: f64 = 0.001;

/// Friction between fingertips and objects at least: plastic on dry plastic.
const FRICTION: f64 = 0.4;

const GRAVITY_M_S2: f64 = 9.81;

/// Directions in which a round rim is gripped: every 30°.
const RIM_DIRECTIONS: usize = 12;

/// Extents that differ by less than this share make a footprint count as round.
const ROUND: f64 = 0.05;

impl ObjectPose {
    /// Returns the object's own frame in `base`.
    pub fn isometry(&self) -> Isometry3<f64> {
        Isometry3::from_parts(
            Translation3::from(Vector3::from(self.xyz_m)),
            positive(UnitQuaternion::from_axis_angle(&Vector3::z_axis(), self.yaw_rad)),
        )
    }

    /// Returns its pose in a gripper that closes on it with its frame at `at`.
    pub fn in_gripper(&self, at: &Isometry3<f64>, gripper: &Gripper) -> Isometry3<f64> {
        let mut pose = at.inverse() * self.isometry();
        pose.translation.y += gripper.push_m(self.grasp_width_m, pose.translation.y);
        pose
    }

    /// Height of its top in `base`, metres.
    pub fn top_z_m(&self) -> f64 {
        self.xyz_m[2] + 0.5 * self.size_m[2]
    }

    /// Height of what it stands on in `base`, metres.
    pub fn bottom_z_m(&self) -> f64 {
        self.xyz_m[2] - 0.5 * self.size_m[2]
    }

    /// Returns the upright box around it.
    pub fn cuboid(&self) -> Cuboid {
        Cuboid { centre: self.xyz_m, size: self.size_m, yaw: self.yaw_rad }
    }

    /// Returns the upright box around it where it stands at `pose` instead.
    pub fn cuboid_at(&self, pose: &Isometry3<f64>) -> Cuboid {
        let (along, at) = (pose.rotation * Vector3::x(), pose.translation);
        Cuboid { centre: [at.x, at.y, at.z], size: self.size_m, yaw: along.y.atan2(along.x) }
    }

    /// Every grasp from straight above: across each side that the fingers span, or, where a hollow
    /// object is wider than the gripper, on its rim.
    ///
    /// # Errors
    /// [`GraspError`] for a width that the gripper does not hold, or numbers that make no object.
    pub fn grasps(&self, gripper: &Gripper) -> Result<Vec<Grasp>, GraspError> {
        self.refuse_malformed()?;
        let width_m = self.grasp_width_m;
        if width_m > gripper.open_m {
            return Err(GraspError::TooWide { width_m, open_m: gripper.open_m });
        }
        if !gripper.holds(width_m) {
            return Err(GraspError::TooThin { width_m, least_m: gripper.least_m() });
        }
        let across = self.across(gripper);
        if across.is_empty() && !self.hollow {
            let extent_m = self.size_m[0].min(self.size_m[1]);
            return Err(GraspError::NoRim { extent_m, open_m: gripper.open_m });
        }
        let (grasps, most_kg) = if across.is_empty() {
            (self.on_rim(gripper), self.most_on_rim_kg(gripper))
        } else {
            (across, 2.0 * FRICTION * gripper.force_n / GRAVITY_M_S2)
        };
        match self.mass_kg {
            Some(mass_kg) if mass_kg > most_kg => {
                Err(GraspError::TooHeavy { mass_kg, most_kg, force_n: gripper.force_n })
            }
            _ if gripper.jaw.is_none() => Ok(grasps),
            _ => {
                let aside = Translation3::new(0.0, -gripper.aside_m(width_m), 0.0);
                Ok(grasps
                    .into_iter()
                    .map(|it| Grasp { gripper: it.gripper * aside, ..it })
                    .collect())
            }
        }
    }

    /// Greatest mass that a rim hold carries level, kilograms. The weight acts at the centre and turns
    /// the object in the fingers; they resist with their force over the depth of the contact.
    fn most_on_rim_kg(&self, gripper: &Gripper) -> f64 {
        let [x, y, _] = self.size_m;
        let arm_m = 0.5 * (x.max(y) - self.grasp_width_m);
        let depth_m = self.top_z_m() - self.tip_z(self.xyz_m[2], gripper) + gripper.beyond_m;
        let tilt = gripper.force_n * depth_m / (GRAVITY_M_S2 * arm_m);
        tilt.min(2.0 * FRICTION * gripper.force_n / GRAVITY_M_S2)
    }

    fn refuse_malformed(&self) -> Result<(), GraspError> {
        let finite = [("xyz", &self.xyz_m[..]), ("yaw", std::slice::from_ref(&self.yaw_rad))];
        for (what, numbers) in finite {
            if numbers.iter().any(|n| !n.is_finite()) {
                return Err(GraspError::Malformed { what, positive: false });
            }
        }
        if !(0.0..FRAC_PI_2).contains(&self.wall_rad) {
            return Err(GraspError::Malformed { what: "wall_deg", positive: false });
        }
        let width = std::slice::from_ref(&self.grasp_width_m);
        for (what, numbers) in [("size", &self.size_m[..]), ("grasp_width", width)] {
            if numbers.iter().any(|n| !(n.is_finite() && *n > 0.0)) {
                return Err(GraspError::Malformed { what, positive: true });
            }
        }
        Ok(())
    }

    /// Over the centre, fingers closing along the narrow extents.
    fn across(&self, gripper: &Gripper) -> Vec<Grasp> {
        let z = self.tip_z(self.xyz_m[2], gripper);
        [1, 0]
            .into_iter()
            .filter(|&axis| self.size_m[axis] <= gripper.open_m)
            // A fixed finger comes down beside the width that is gripped, which is the narrow one.
            .filter(|&axis| gripper.jaw.is_none() || self.size_m[axis] <= self.size_m[1 - axis])
            .flat_map(|axis| {
                let along = self.yaw_rad + if axis == 1 { FRAC_PI_2 } else { 0.0 };
                self.both_ways(self.xyz_m[0], self.xyz_m[1], z, along)
            })
            .collect()
    }

    /// On the wall of a bowl or box, one finger inside and one outside.
    fn on_rim(&self, gripper: &Gripper) -> Vec<Grasp> {
        let [x, y, _] = self.size_m;
        let round = (x - y).abs() <= ROUND * x.max(y);
        let count = if round { RIM_DIRECTIONS } else { 4 };
        let z = self.tip_z(self.xyz_m[2], gripper);
        (0..count)
            .flat_map(|k| {
                let turned = 2.0 * PI * k as f64 / count as f64;
                // The extent that this direction crosses; a round footprint has only one.
                let extent = if round || k % 2 == 0 { x } else { y };
                // Middle of the wall at the depth of the fingertips.
                let inwards = (self.top_z_m() - z) * self.wall_rad.tan();
                let radius =
                    0.5 * extent - inwards - 0.5 * self.grasp_width_m / self.wall_rad.cos();
                let along = self.yaw_rad + turned;
                let centre =
                    [self.xyz_m[0] + radius * along.cos(), self.xyz_m[1] + radius * along.sin()];
                let level = self.both_ways(centre[0], centre[1], z, along);
                // About the tangent of the rim, the gripper's side away from the tips outwards.
                let tangent = Vector3::new(-along.sin(), along.cos(), 0.0);
                let lean = UnitQuaternion::new(tangent * self.wall_rad);
                level.map(|grasp| Grasp { gripper: leaning(&lean, &grasp.gripper), ..grasp })
            })
            .collect()
    }

    /// Height of the fingertips: a little below the top, not below `lowest` and never on what the
    /// object stands on.
    fn tip_z(&self, lowest: f64, gripper: &Gripper) -> f64 {
        let clear_m = gripper.beyond_m + TIP_CLEAR_M;
        (self.top_z_m() - DEPTH_M).max(lowest).max(self.bottom_z_m() + clear_m)
    }

    /// Returns the gripper at a point with its fingers moving along `along`; either finger may
    /// lead.
    fn both_ways(&self, x: f64, y: f64, z: f64, along: f64) -> [Grasp; 2] {
        [0.0, PI].map(|turned| Grasp {
            gripper: downward([x, y, z], along + turned),
            width_m: self.grasp_width_m,
        })
    }
}

impl Grasp {
    /// Returns the gripper `height_m` above the grasp, back along the fingers: straight above it but
    /// for a sloped wall, which the fingers enclose only along the slope.
    pub fn raised(&self, height_m: f64) -> Isometry3<f64> {
        let back = -(self.gripper.rotation * Vector3::z());
        let aside = back.xy() * (height_m / back.z);
        let aside = if aside.norm() < 1e-9 { Vector2::zeros() } else { aside };
        Translation3::new(aside.x, aside.y, height_m) * self.gripper
    }
}

fn leaning(lean: &UnitQuaternion<f64>, gripper: &Isometry3<f64>) -> Isometry3<f64> {
    Isometry3::from_parts(gripper.translation, positive(lean * gripper.rotation))
}

/// Returns a gripper at `xyz` that points straight down, its y axis at `along` from the x axis of
/// `base`.
pub(crate) fn downward(xyz: [f64; 3], along: f64) -> Isometry3<f64> {
    let (s, c) = along.sin_cos();
    let y = Vector3::new(c, s, 0.0);
    let z = -Vector3::z();
    let rotation = Rotation3::from_basis_unchecked(&[y.cross(&z), y, z]);
    Isometry3::from_parts(
        Translation3::from(Vector3::from(xyz)),
        positive(UnitQuaternion::from_rotation_matrix(&rotation)),
    )
}
