//! The arm that the command line names: one of a robot's, from its description.

use std::borrow::Cow;
use std::path::Path;

use command_line::scene_file;
use diagnostics::TextFile;
use manipulation::Chain;
use nalgebra::Isometry3;
use robot_model::{Joint, Robot};
use service::exit::{Exit, Failure};

use crate::args::WhichArm;

/// An arm, and which of the robot's links it is about.
#[derive(Debug)]
pub struct DescribedArm {
    robot: Cow<'static, Robot>,
    tip: String,
    /// The place in the posture of each of the robot's joints, for those that move the arm.
    places: Vec<Option<usize>>,
    /// The links, by their indices, parents first.
    links: Vec<usize>,
}

impl DescribedArm {
    /// Returns an arm of the robot that a file describes, or of Baxter, which is built in.
    ///
    /// # Errors
    /// The file cannot be read, everything that is wrong with it, or why it has no such arm.
    pub fn load(robot: Option<&Path>, which: &WhichArm) -> Result<Self, Failure> {
        let robot = match robot {
            None => Cow::Borrowed(Robot::baxter()),
            Some(path) => Cow::Owned(read(path)?),
        };
        Self::of(robot, which).map_err(|reason| Failure::new(Exit::Usage, reason))
    }

    /// Name, and pose in the root's frame, of each link at a posture (radians, or metres for a
    /// sliding joint); quaternions have w ≥ 0.
    ///
    /// With `--limb` these are the links from the arm's mount on with all that hangs off them,
    /// fingers closed; with `--tip` those from the root to the tip.
    pub fn links(&self, q: &[f64]) -> impl Iterator<Item = (&str, Isometry3<f64>)> {
        let position = |joint: &Joint| self.places[joint.child - 1].map_or(0.0, |place| q[place]);
        let poses = self.robot.poses(position);
        self.links.iter().map(move |&link| (self.robot.links()[link].name.as_str(), poses[link]))
    }

    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.places.iter().flatten().count()
    }

    /// Returns the chain from the robot's root to its last link.
    ///
    /// # Errors
    /// The chain cannot be solved for a pose: some joint does not turn between limits.
    pub fn chain(&self) -> Result<Chain, Failure> {
        Chain::from_description(&self.robot, &self.tip)
            .map_err(|reason| Failure::new(Exit::Usage, reason.to_string()))
    }

    fn of(robot: Cow<'static, Robot>, which: &WhichArm) -> Result<Self, String> {
        let limb = which.limb.as_deref();
        let tip = match (&which.tip, limb) {
            (Some(tip), _) => tip.clone(),
            (None, Some(limb)) => format!("{limb}_gripper"),
            (None, None) => return Err("say --limb or --tip".to_owned()),
        };
        let chain = robot.chain(&tip).map_err(|error| {
            let names: Vec<&str> = robot.links().iter().map(|link| link.name.as_str()).collect();
            format!("{error}; it has {}", names.join(", "))
        })?;
        let movable: Vec<&Joint> = chain.movable().collect();
        if movable.is_empty() {
            let name = robot.name();
            return Err(format!(
                "no joint of robot {name:?} moves link {tip:?}; help: name the last link of an arm"
            ));
        }
        let mut places = vec![None; robot.joints().len()];
        for (place, joint) in movable.iter().enumerate() {
            places[joint.child - 1] = Some(place);
        }
        let links = match limb {
            Some(_) => subtree(&robot, movable[0].parent),
            None => std::iter::once(0).chain(chain.joints().map(|joint| joint.child)).collect(),
        };
        Ok(Self { places, links, tip, robot })
    }
}

/// Returns the link and its descendants, parents first.
fn subtree(robot: &Robot, first: usize) -> Vec<usize> {
    let mut links = vec![first];
    for joint in robot.joints() {
        if links.contains(&joint.parent) {
            links.push(joint.child);
        }
    }
    links
}

fn read(path: &Path) -> Result<Robot, Failure> {
    let text = scene_file::read_file(path)?;
    let urdf = TextFile::new(path.display().to_string(), text);
    Ok(Robot::read(&urdf, None)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use manipulation::Limb;

    fn arm(
        robot: Option<&Path>,
        limb: Option<Limb>,
        tip: Option<&str>,
    ) -> Result<DescribedArm, Failure> {
        DescribedArm::load(
            robot,
            &WhichArm {
                limb: limb.map(|limb| limb.name().to_owned()),
                tip: tip.map(str::to_owned),
            },
        )
    }

    fn fixture(name: &str) -> std::path::PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fixtures/robots").join(name)
    }

    #[test]
    fn limb_contains_its_mount_and_all_descendants() {
        let q = [0.3, -0.5, 0.2, 0.8, -0.1, 1.0, 0.4];
        for limb in Limb::BOTH {
            let arm = arm(None, Some(limb), None).unwrap();
            let found: Vec<_> = arm.links(&q).collect();
            assert_eq!((found.len(), found[0].0), (22, format!("{limb}_arm_mount").as_str()));
            let gripper =
                found.iter().find(|(name, _)| *name == format!("{limb}_gripper")).unwrap();
            let tip = arm.robot.chain(gripper.0).unwrap().forward(&q);
            assert!((gripper.1.translation.vector - tip.translation.vector).amax() < 1e-12);
        }
    }

    #[test]
    fn another_robots_arm_runs_from_its_root_to_the_tip() {
        let arm = arm(Some(&fixture("seven_joints.urdf")), None, Some("flange")).unwrap();
        let links: Vec<_> = arm.links(&[0.0; 7]).collect();
        assert_eq!((links.len(), links[0].0, links[9].0), (10, "world", "flange"));
        assert!((links[9].1.translation.z - 1.306).abs() < 1e-12);
    }

    #[test]
    fn rejected_arms_name_the_reason() {
        let seven = fixture("seven_joints.urdf");
        let error = |robot, limb, tip| arm(robot, limb, tip).unwrap_err().to_string();
        let short = arm(Some(&seven), None, Some("link_3")).unwrap();
        assert_eq!((short.joints(), short.links(&[0.0; 3]).count()), (3, 5));
        let refused = short.chain().unwrap_err().to_string();
        assert!(refused.contains("3 moving joints that are not five to seven"), "{refused}");
        assert!(
            error(None, None, Some("pedestal")).contains("no joint of robot \"baxter\" moves link")
        );
        let unknown = error(Some(&seven), Some(Limb::Left), None);
        assert!(
            unknown.contains("has no link \"left_gripper\"; it has world, link_0"),
            "{unknown}"
        );
        let nowhere = error(Some(Path::new("/nowhere.urdf")), None, Some("x"));
        assert!(nowhere.starts_with("/nowhere.urdf: "), "{nowhere}");
        let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml");
        let no_xml = error(Some(&manifest), None, Some("x"));
        assert!(no_xml.contains("Cargo.toml:1: document: malformed XML"), "{no_xml}");
    }
}
