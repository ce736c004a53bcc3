//! Arguments of the verbs.

mod arm;
mod batch;
mod conform;
mod export;
mod record;
mod replay;
mod robot;
mod scene;
mod study;

pub use arm::{ArmPlotArgs, ArmVerb};
pub use batch::{ArmArgs, GroundArgs, InputArgs, PlanArgs, ProblemArgs, WhichArm};
pub use conform::ConformArgs;
pub use export::{ExportVerb, McapArgs, PomdpArgs, TraceArgs};
pub use record::{OpenArgs, RecordVerb, RecorderArgs};
pub use replay::ReplayArgs;
pub use robot::{ImportArgs, RobotVerb, ServosArgs};
pub use scene::{
    CheckArgs, SceneCheckArgs, SceneNewArgs, ScenePlaceArgs, SceneShowArgs, SceneVerb,
};
pub use study::{ALL, Preset, ReportArgs, StudyArgs, StudyVerb};
