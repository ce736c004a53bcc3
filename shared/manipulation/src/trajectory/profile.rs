//! The shortest jerk-limited motion from one state to another.
//!
//! Every joint follows its own profile of at most seven constant jerks, all of them as long as the
//! slowest (Berscheid and Kröger, 2021). The profiles come from `rsruckig`; here they become one
//! path of cubics whose parameter is time.

use rsruckig::prelude::{
    DataArrayOrVec, InputParameter, Ruckig, RuckigResult, ThrowErrorHandler, Trajectory as Profiles,
};

use crate::kinematics::limb::Joints;
use crate::kinematics::limits::MotionLimits;
use crate::trajectory::joint_trajectory::TrajectoryError;
use crate::trajectory::path::{Path, Piece};
use crate::trajectory::timing::Knot;
use curve::Curve;

mod curve;
mod detour;

/// Position, velocity and acceleration of a limb.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Positions, radians.
    pub q: Joints,
    /// Velocities, rad/s.
    pub qd: Joints,
    /// Accelerations, rad/s².
    pub qdd: Joints,
}

impl State {
    /// Standing still at `q`.
    pub fn at_rest(q: &Joints) -> Self {
        Self { q: *q, qd: [0.0; 7], qdd: [0.0; 7] }
    }

    /// Refuses a state that `limits` forbid.
    fn check(&self, limits: &MotionLimits) -> Result<(), TrajectoryError> {
        crate::trajectory::joint_trajectory::refuse_outside(&limits.position, &self.q)?;
        for (what, values, most) in [
            ("velocity", &self.qd, &limits.velocity),
            ("acceleration", &self.qdd, &limits.acceleration),
        ] {
            let beyond = |j: &usize| values[*j].is_nan() || values[*j].abs() > most[*j];
            if let Some(joint) = (0..7).find(beyond) {
                let (value, limit) = (values[joint], most[joint]);
                return Err(TrajectoryError::TooFast { joint, what, value, limit });
            }
        }
        Ok(())
    }
}

/// A path whose parameter is time, and that time as knots.
pub(crate) type Timed = (Path, Vec<Knot>);

/// From `from` to `to` in the shortest time in which all joints can be there together. A joint
/// whose profile would leave its position limits stops first, sets out from there, and gains the
/// speed of a moving target last.
pub(crate) fn between(
    from: &State,
    to: &State,
    limits: &MotionLimits,
) -> Result<Timed, TrajectoryError> {
    from.check(limits)?;
    to.check(limits)?;
    let mut input = InputParameter::<7>::new(None);
    let all = DataArrayOrVec::Stack;
    (input.current_position, input.target_position) = (all(from.q), all(to.q));
    (input.current_velocity, input.target_velocity) = (all(from.qd), all(to.qd));
    (input.current_acceleration, input.target_acceleration) = (all(from.qdd), all(to.qdd));
    input.max_velocity = all(limits.velocity);
    input.max_acceleration = all(limits.acceleration);
    input.max_jerk = all(limits.jerk);
    let mut stopping = [false; 7];
    // Each round but the last makes another joint stop first, or gives all of them more time.
    for _ in 0..ROUNDS {
        let profiles = calculated(&input)?;
        let mut joints: [Curve; 7] = std::array::from_fn(|j| Curve::of(&profiles, j));
        let leaves = |j: usize| !joints[j].stays_within(limits.position.0[j]);
        let leaving: [bool; 7] = std::array::from_fn(|j| stopping[j] || leaves(j));
        for j in (0..7).filter(|&j| leaving[j]) {
            let [from, to] = [from, to].map(|state| [state.q[j], state.qd[j], state.qdd[j]]);
            let bounds = detour::Bounds::of(limits, j);
            joints[j] = detour::by_stopping(from, to, &bounds, profiles.duration)?;
        }
        let longest_s = joints.iter().map(|curve| curve.duration_s).fold(0.0, f64::max);
        if longest_s <= profiles.duration + INSTANT_S {
            return Ok(timed(&joints, profiles.duration, to.q));
        }
        stopping = leaving;
        input.minimum_duration = Some(longest_s);
    }
    Err(TrajectoryError::NoMotion)
}

/// More rounds than seven joints can need.
const ROUNDS: usize = 16;

/// From rest at `from` to rest at `to`, straight in joint space, in the shortest time: one profile
/// for all joints, limited by whichever joint has the least to spare.
pub(crate) fn straight(
    from: &Joints,
    to: &Joints,
    limits: &MotionLimits,
) -> Result<Timed, TrajectoryError> {
    let way: Joints = std::array::from_fn(|j| to[j] - from[j]);
    let most = |limit: &Joints| {
        let shares = (0..7).filter(|&j| way[j] != 0.0).map(|j| limit[j] / way[j].abs());
        DataArrayOrVec::Stack([shares.fold(f64::INFINITY, f64::min)])
    };
    let mut input = InputParameter::<1>::new(None);
    input.target_position = DataArrayOrVec::Stack([1.0]);
    input.max_velocity = most(&limits.velocity);
    input.max_acceleration = most(&limits.acceleration);
    input.max_jerk = most(&limits.jerk);
    let profiles = calculated(&input)?;
    let share = Curve::of(&profiles, 0);
    let joints = std::array::from_fn(|j| share.scaled(from[j], way[j]));
    Ok(timed(&joints, profiles.duration, *to))
}

fn calculated<const N: usize>(input: &InputParameter<N>) -> Result<Profiles<N>, TrajectoryError> {
    let mut profiles = Profiles::new(None);
    // The cycle time matters to sampling only, which is done here.
    match Ruckig::<N, ThrowErrorHandler>::new(None, 1e-3).calculate(input, &mut profiles) {
        Ok(RuckigResult::Working | RuckigResult::Finished) => Ok(profiles),
        Ok(_) | Err(_) => Err(TrajectoryError::NoMotion),
    }
}

/// Shortest section, seconds.
const INSTANT_S: f64 = 1e-12;

/// Joins the joints' profiles: a new piece wherever any of them changes its jerk.
fn timed(joints: &[Curve; 7], duration_s: f64, end: Joints) -> Timed {
    let mut times: Vec<f64> = joints.iter().flat_map(Curve::times).collect();
    times.extend([0.0, duration_s]);
    times.retain(|time| (0.0..=duration_s).contains(time));
    times.sort_by(f64::total_cmp);
    times.dedup_by(|later, earlier| *later - *earlier < INSTANT_S);
    let mut pieces = Vec::with_capacity(times.len());
    for ends in times.windows(2) {
        let (start, length) = (ends[0], ends[1] - ends[0]);
        let middle = start + 0.5 * length;
        let cubics = joints.each_ref().map(|curve| curve.cubic(middle, start));
        let coefficients = std::array::from_fn(|i| std::array::from_fn(|j| cubics[j][i]));
        pieces.push(Piece { start, length, coefficients });
    }
    if pieces.is_empty() {
        pieces.push(Piece {
            start: 0.0,
            length: 0.0,
            coefficients: [end, [0.0; 7], [0.0; 7], [0.0; 7]],
        });
    }
    let knot = |(piece, at): (usize, &Piece)| Knot {
        time: at.start,
        s: 0.0,
        speed: 1.0,
        acceleration: 0.0,
        piece,
    };
    let mut knots: Vec<Knot> = pieces.iter().enumerate().map(knot).collect();
    let (piece, last) = (pieces.len() - 1, pieces[pieces.len() - 1]);
    let time = last.start + last.length;
    knots.push(Knot { time, s: last.length, speed: 1.0, acceleration: 0.0, piece });
    (Path::of_pieces(pieces, end), knots)
}
