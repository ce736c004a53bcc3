//! Robots whose arms are measured.

use manipulation::{Arm, Joints, Limb, Robot};
use robot_model::{Robot as Description, SerialChain};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use vocabulary::Rng;

/// A robot, and its description for solvers that read it themselves.
pub(super) struct Subject {
    pub(super) name: &'static str,
    pub(super) urdf: PathBuf,
    robot: Robot,
}

/// Two arms of seven joints.
pub(super) static BAXTER: LazyLock<Subject> = LazyLock::new(|| Subject {
    name: "Baxter",
    urdf: Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/baxter/baxter.urdf"),
    robot: Robot::baxter().clone(),
});

/// One arm of six joints.
pub(super) static UR5E: LazyLock<Subject> = LazyLock::new(|| shipped("UR5e"));

/// One arm of five joints.
pub(super) static SO101: LazyLock<Subject> = LazyLock::new(|| shipped("SO101"));

fn shipped(name: &'static str) -> Subject {
    let file = format!("../config/robots/{}.urdf", name.to_lowercase());
    let urdf = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let read = |path: &Path| {
        std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    };
    let description = Description::parse(&read(&urdf), Some(&read(&urdf.with_extension("srdf"))));
    let description = description.unwrap_or_else(|error| panic!("{}: {error}", urdf.display()));
    let robot = Robot::from_description(&description).unwrap_or_else(|error| panic!("{error}"));
    Subject { name, urdf, robot }
}

impl Subject {
    pub(super) fn limbs(&self) -> &'static [Limb] {
        self.robot.limbs()
    }

    pub(super) fn arm(&self, limb: Limb) -> &Arm {
        self.robot.arm(limb)
    }

    pub(super) fn description(&self) -> &Description {
        self.robot.description()
    }

    /// The link whose pose is asked for.
    pub(super) fn tip(&self, limb: Limb) -> String {
        format!("{}_gripper", self.arm(limb).name)
    }

    /// The chain by the description's own kinematics, of which no solver makes use.
    pub(super) fn chain(&self, limb: Limb) -> SerialChain<'_> {
        let chain = self.description().chain(&self.tip(limb));
        chain.unwrap_or_else(|error| panic!("{error}"))
    }

    /// The positions of the joints that the limb has.
    pub(super) fn moving<'q>(&self, limb: Limb, q: &'q Joints) -> &'q [f64] {
        &q[..self.arm(limb).chain.joints()]
    }

    /// The middle of the limits: a posture to begin from.
    pub(super) fn middle(&self, limb: Limb) -> Joints {
        self.arm(limb).limits.position.middle()
    }

    /// A posture uniform within the limits.
    pub(super) fn posture(&self, limb: Limb, rng: &mut Rng) -> Joints {
        self.arm(limb).limits.position.0.map(|ends| rng.between(ends))
    }

    /// Postures of one limb, the same every time.
    pub(super) fn postures(&self, limb: Limb, count: usize) -> Vec<Joints> {
        let mut rng = Rng::new(7);
        (0..count).map(|_| self.posture(limb, &mut rng)).collect()
    }
}

/// Returns six or seven positions as this project writes them; none for another number.
pub(super) fn joints_of(q: &[f64]) -> Option<Joints> {
    matches!(q.len(), 6 | 7).then(|| std::array::from_fn(|i| q.get(i).copied().unwrap_or(0.0)))
}
