//! Durations of the arm's motions, from planned trajectories.

use manipulation::{
    Cuboid, Joints, Limb, ObjectPose, Phase, PlanError, PlanSettings, Robot, plan_pick, plan_point,
    plan_return,
};
use scene::{ObjectId, Scene};

/// Seconds of every motion of an interaction, from every posture in which it can begin: at rest, or
/// aiming at an object after a pointing question.
#[derive(Clone, Debug, PartialEq)]
pub struct Motions {
    /// Per object, seconds from the decision to its hand-over: from rest first, then from aiming
    /// at each object.
    picks: Vec<Vec<f64>>,
    /// Per object, seconds from the decision until the fingers close on it; in the same order.
    grips: Vec<Vec<f64>>,
    /// Per object, seconds until the arm aims at it; in the same order. Empty without pointing.
    points: Vec<Vec<f64>>,
}

/// The motions to plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Picks from rest.
    Picks,
    /// Picks and pointing from rest, for the durations of single actions.
    FromRest,
    /// Also from aiming at each object, for the duration of a whole interaction. Their number grows
    /// with the square of the number of objects.
    Pairs,
}

/// A motion that cannot be planned.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MotionError {
    /// The object has no place.
    #[error("object `{0}` has no place in the scene")]
    NoPlace(String),
    /// The arm cannot do it, even from rest.
    #[error("the arm cannot {what} object `{object}`: {error}")]
    Plan {
        /// The action.
        what: &'static str,
        /// The object.
        object: String,
        /// The reason.
        error: Refusal,
    },
}

/// Scenes larger than this are computed from rest alone; from elsewhere the arm is taken to go to
/// rest first. The number of motions grows with the square of that of the objects.
const OBJECTS_MAX: usize = 12;

/// A posture to begin in.
#[derive(Clone, Copy)]
struct Posture {
    arms: [Joints; 2],
    /// The limb that is away from rest.
    away: Option<Limb>,
}

struct Planner<'a> {
    robot: &'a Robot,
    places: Vec<ObjectPose>,
    limb: Option<Limb>,
    settings: &'a PlanSettings,
}

impl Motions {
    /// Plans motions as the arm's service does, at the scene's places. `limb` is the one to be
    /// used; `None`: the better one.
    ///
    /// # Errors
    /// The first object that has no place or cannot be reached from rest.
    pub fn plan(
        robot: &Robot,
        scene: &Scene,
        limb: Option<Limb>,
        settings: &PlanSettings,
        extent: Extent,
    ) -> Result<Self, MotionError> {
        let places = places(scene)?;
        let count = places.len();
        let planner = Planner { robot, places, limb, settings };
        let failed = |what: &'static str, i: usize| {
            let object = scene.object(i.into()).name.clone();
            move |error| MotionError::Plan { what, object, error }
        };
        let rest = Posture { arms: robot.neutral(), away: None };
        let from_rest = |i| planner.pick(&rest, i).map_err(failed("fetch", i));
        let rows = (0..count).map(from_rest).collect::<Result<Vec<_>, _>>()?;
        let (picks, grips) = rows.into_iter().unzip();
        let mut motions = Self { picks: vec![picks], grips: vec![grips], points: Vec::new() };
        if extent != Extent::Picks {
            let aim = |i| planner.aim(&rest, i).map_err(failed("point at", i));
            let aims = (0..count).map(aim).collect::<Result<Vec<_>, _>>()?;
            motions.points.push(aims.iter().map(|(seconds, ..)| *seconds).collect());
            if extent == Extent::Pairs {
                for (i, (_, limb, arms)) in aims.iter().enumerate() {
                    let aimed = Posture { arms: *arms, away: Some(*limb) };
                    motions.add_from(&planner, &aimed).map_err(failed("come back from", i))?;
                }
            }
        }
        Ok(motions)
    }

    /// Adds the durations from one posture of aiming. If the arm cannot continue from there, it
    /// goes to rest first.
    fn add_from(&mut self, planner: &Planner<'_>, aimed: &Posture) -> Result<(), Refusal> {
        let count = self.picks[0].len();
        let tried = count <= OBJECTS_MAX;
        let home_s = planner.home_s(aimed)?;
        let (picks, grips, points) = (&self.picks[0], &self.grips[0], &self.points[0]);
        let pick = |i| tried.then(|| planner.pick(aimed, i).ok()).flatten();
        let aim = |i| tried.then(|| planner.aim(aimed, i).ok()).flatten();
        let pick_s = |i: usize| pick(i).unwrap_or((home_s + picks[i], home_s + grips[i]));
        let aim_s = |i: usize| aim(i).map_or(home_s + points[i], |(seconds, ..)| seconds);
        let (picks, grips) = (0..count).map(pick_s).unzip();
        let points = (0..count).map(aim_s).collect();
        self.picks.push(picks);
        self.grips.push(grips);
        self.points.push(points);
        Ok(())
    }

    /// Seconds from the decision to pick `object` to its hand-over, from rest or from aiming at
    /// `aimed`.
    pub fn pick_s(&self, aimed: Option<ObjectId>, object: ObjectId) -> f64 {
        let row = aimed.map_or(0, |i| i.index() + 1);
        self.picks.get(row).unwrap_or(&self.picks[0])[object.index()]
    }

    /// Seconds from the decision to pick `object` until the fingers close on it: until then it can
    /// be called off. From rest or from aiming at `aimed`.
    pub fn grip_s(&self, aimed: Option<ObjectId>, object: ObjectId) -> f64 {
        let row = aimed.map_or(0, |i| i.index() + 1);
        self.grips.get(row).unwrap_or(&self.grips[0])[object.index()]
    }

    /// Seconds until the arm aims at `object`, from rest or from aiming at `aimed`; `None` if
    /// pointing was not planned.
    pub fn point_s(&self, aimed: Option<ObjectId>, object: ObjectId) -> Option<f64> {
        if aimed == Some(object) {
            return Some(0.0);
        }
        let row = aimed.map_or(0, |i| i.index() + 1);
        self.points.get(row).map(|row| row[object.index()])
    }
}

impl Planner<'_> {
    fn others(&self, except: Option<usize>) -> Vec<Cuboid> {
        let standing = self.places.iter().enumerate().filter(|(i, _)| Some(*i) != except);
        standing.map(|(_, place)| place.cuboid()).collect()
    }

    /// Seconds to the end of the release, and until the fingers close.
    fn pick(&self, from: &Posture, i: usize) -> Result<(f64, f64), Refusal> {
        let others = self.others(Some(i));
        let plan =
            plan_pick(self.robot, &self.places[i], self.limb, &from.arms, &others, self.settings)?;
        from.refuse_other(plan.limb())?;
        let (_, released_s) = plan.span_s(Phase::Release).unwrap_or_default();
        let (closing_s, _) = plan.span_s(Phase::Close).unwrap_or_default();
        Ok((released_s, closing_s))
    }

    /// Seconds until the arm aims, the limb, and the final postures of both.
    fn aim(&self, from: &Posture, i: usize) -> Result<(f64, Limb, [Joints; 2]), Refusal> {
        let (others, at) = (self.others(None), self.places[i].xyz_m);
        let plan = plan_point(self.robot, at, self.limb, &from.arms, &others, self.settings)?;
        from.refuse_other(plan.limb())?;
        let (_, aimed_s) = plan.span_s(Phase::Aim).unwrap_or_default();
        let mut arms = self.robot.neutral();
        arms[plan.limb()] = plan.at(aimed_s).q;
        Ok((aimed_s, plan.limb(), arms))
    }

    /// Seconds back to rest.
    fn home_s(&self, from: &Posture) -> Result<f64, Refusal> {
        let Some(limb) = from.away else { return Ok(0.0) };
        Ok(plan_return(self.robot, limb, &from.arms, &self.others(None), self.settings)?
            .duration_s())
    }
}

/// Reason for which a motion is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// No motion is found.
    #[error(transparent)]
    Plan(Box<PlanError>),
    /// The other limb would have to move, and this one is away from rest.
    #[error("the other limb is away from rest")]
    OtherLimb,
}

impl From<PlanError> for Refusal {
    fn from(error: PlanError) -> Self {
        Self::Plan(Box::new(error))
    }
}

impl Posture {
    fn refuse_other(&self, limb: Limb) -> Result<(), Refusal> {
        match self.away {
            Some(away) if away != limb => Err(Refusal::OtherLimb),
            _ => Ok(()),
        }
    }
}

pub(crate) fn places(scene: &Scene) -> Result<Vec<ObjectPose>, MotionError> {
    let place = |object: &scene::Object| {
        let placement =
            object.placement.ok_or_else(|| MotionError::NoPlace(object.name.clone()))?;
        Ok(crate::reach::pose(&placement))
    };
    scene.objects().iter().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::bowls;

    #[test]
    fn motions_take_the_duration_of_their_trajectories() {
        let (robot, scene, settings) = (Robot::baxter(), bowls(), PlanSettings::default());
        let motions = Motions::plan(robot, &scene, None, &settings, Extent::Pairs).unwrap();
        let places = places(&scene).unwrap();
        let all: Vec<Cuboid> = places.iter().map(ObjectPose::cuboid).collect();
        let rest = &robot.neutral();
        for (i, place) in places.iter().enumerate() {
            let mut others = all.clone();
            others.remove(i);
            let pick = plan_pick(robot, place, None, rest, &others, &settings).unwrap();
            let (_, released_s) = pick.span_s(Phase::Release).unwrap();
            assert_eq!(motions.pick_s(None, i.into()), released_s);
            let (_, approached_s) = pick.span_s(Phase::Approach).unwrap();
            assert_eq!(motions.grip_s(None, i.into()), approached_s);
            assert!(released_s < pick.duration_s(), "going home is not waited for");
            let point = plan_point(robot, place.xyz_m, None, rest, &all, &settings).unwrap();
            let (_, aimed_s) = point.span_s(Phase::Aim).unwrap();
            assert_eq!(motions.point_s(None, i.into()), Some(aimed_s));
            assert_eq!(motions.point_s(Some(i.into()), i.into()), Some(0.0));
            for j in 0..6 {
                assert!((1.0..25.0).contains(&motions.pick_s(Some(i.into()), j.into())));
            }
        }
    }

    #[test]
    fn pointing_is_planned_where_it_is_asked_for() {
        let motions =
            Motions::plan(Robot::baxter(), &bowls(), None, &PlanSettings::default(), Extent::Picks)
                .unwrap();
        assert_eq!(motions.point_s(None, ObjectId(0)), None);
        let (rest, aimed) = (None, Some(ObjectId(1)));
        assert_eq!(motions.pick_s(aimed, ObjectId(0)), motions.pick_s(rest, ObjectId(0)));
    }

    #[test]
    fn an_object_without_a_place_is_named() {
        let json = serde_json::json!({"objects": [{"name": "cup", "attributes": {"a": "b"}}]});
        let scene = Scene::from_json("s", &json).unwrap();
        let error =
            Motions::plan(Robot::baxter(), &scene, None, &PlanSettings::default(), Extent::Pairs)
                .unwrap_err();
        assert_eq!(error, MotionError::NoPlace("cup".to_owned()));
    }
}
