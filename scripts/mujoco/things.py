"""The objects around the robot, the people who take and give them, and a record of every pick."""

import math

import mujoco
import numpy as np

from hand import named

ROBOT, OBJECT, BOARD = range(3)
# An object that is let go higher than this above its place is taken by a person, metres.
HANDED_OVER_M = 0.05
# A gripper that waits with open fingers this near to where it handed something over is given it back,
# metres, radians and seconds.
BACK_M, BACK_RAD, BACK_S = 0.05, 0.2, 1.0
# An object this far from its place is put back there by people, metres.
ASTRAY_M = 0.03
# Fingers that touch an object no longer have let go of it; after the longest time a person pulls it out.
LOOSE_S, LET_GO_S = 0.02, 2.0
# A limb this near to the neutral posture is at rest, radians and rad/s.
AT_REST_RAD, STILL_RAD_S = 0.05, 0.02


class Thing:
    """One object and its free joint."""

    def __init__(self, model, name):
        self.name = name
        self.body = named(model, mujoco.mjtObj.mjOBJ_BODY, f"object/{name}")
        joint = named(model, mujoco.mjtObj.mjOBJ_JOINT, f"object/{name}")
        at, dof = model.jnt_qposadr[joint], model.jnt_dofadr[joint]
        self.at, self.dofs = slice(at, at + 7), slice(dof, dof + 6)
        self.home = model.qpos0[self.at].copy()


class Pick:
    """What one limb does with one object, from closed fingers to open ones."""

    def __init__(self, thing, before, xyz):
        self.thing, self.before, self.start = thing, before, xyz
        self.lifted_m = 0.0
        # Object in the gripper when the fingers began to open, and how long ago.
        self.at_release, self.opening_s, self.loose_s = None, 0.0, 0.0


class Things:
    """All objects. `report` takes a record of each pick's end; `limbs` and `hands` are by limb."""

    def __init__(self, model, data, objects, limbs, hands, neutral, settings, report):
        self.model, self.data, self.limbs, self.hands = model, data, limbs, hands
        self.neutral, self.report = neutral, report
        self.restock, self.error_m, self.random = settings
        self.all = {item["name"]: Thing(model, item["name"]) for item in objects}
        self.frame = {limb: named(model, mujoco.mjtObj.mjOBJ_BODY, f"{limb}_gripper") for limb in limbs}
        names = [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_GEOM, g) or "" for g in range(model.ngeom)]
        self.owner = [name.split("#")[0] for name in names]
        kinds = {"object": OBJECT, "board": BOARD}
        self.kind = np.array([kinds.get(owner.split("/")[0], ROBOT) for owner in self.owner])
        self.picks = {limb: None for limb in limbs}
        # Objects in each gripper's frame as its fingers began to close.
        self.closing = {limb: None for limb in limbs}
        # The side of each gripper whose tip touches an object now, and forbidden touches since the last
        # record: the greatest force of each pair, newtons.
        self.tips = {limb: {} for limb in limbs}
        self.touches = {}
        # What a person took last: name, limb, the object in the gripper, the gripper; and for how long the
        # gripper has been waiting there.
        self.handed_over, self.waiting_s = None, 0.0
        # What a person holds out: the object and where.
        self.offered = None
        self.with_people = set()
        self.forces = np.zeros(6)

    def pose(self, body):
        return self.data.xpos[body].copy(), self.data.xmat[body].reshape(3, 3).copy()

    def in_gripper(self, limb, thing):
        """Position and quaternion x y z w of an object in a gripper's frame."""
        at, turned = self.pose(self.frame[limb])
        place, own = self.pose(thing.body)
        quat = np.zeros(4)
        mujoco.mju_mat2Quat(quat, (turned.T @ own).flatten())
        return [*(turned.T @ (place - at)), *quat[1:], quat[0]]

    def look(self):
        """Notes the contacts of this moment: called after every few steps."""
        self.tips = {limb: {} for limb in self.limbs}
        contacts = self.data.contact
        pairs = contacts.geom[:self.data.ncon]
        if len(pairs) == 0:
            return
        kinds = self.kind[pairs]
        held = {pick.thing.name for pick in self.picks.values() if pick}
        seen = range(len(pairs)) if held else np.nonzero((kinds == ROBOT).any(axis=1))[0]
        for n in seen:
            a, b = (self.owner[g] for g in pairs[n])
            if kinds[n][0] > kinds[n][1]:
                a, b = b, a
            robot = min(kinds[n]) == ROBOT
            mujoco.mj_contactForce(self.model, self.data, n, self.forces)
            if self.forces[0] <= 0.0:
                continue
            if robot and a.endswith("_finger_tip") and b.startswith("object/"):
                limb = "left" if a[0] == "l" else "right"
                self.tips[limb].setdefault(b.removeprefix("object/"), set()).add(a)
            elif not robot:
                # What is held may brush what it stands on; sleeping and falling things do not matter.
                owners = [o.removeprefix("object/") for o in (a, b) if o.startswith("object/")]
                if len(owners) < 2 or not held.intersection(owners):
                    continue
            pair = f"{a} - {b}"
            self.touches[pair] = max(self.touches.get(pair, 0.0), float(self.forces[0]))

    def keep(self):
        """People hold still what they hold out: called after every few steps."""
        if self.offered:
            thing, place = self.offered
            self.data.qpos[thing.at], self.data.qvel[thing.dofs] = place, 0.0

    def put(self, thing, place):
        self.data.qpos[thing.at], self.data.qvel[thing.dofs] = place, 0.0
        self.data.qpos[thing.at.start + 2] += 0.0005
        # What rests sleeps; a push wakes it.
        self.data.qvel[thing.dofs.start + 2] = -1e-3

    def advance(self, seconds):
        """What changes in `seconds`: grasps, releases, and people."""
        for limb, hand in self.hands.items():
            pick, closes = self.picks[limb], bool(hand.goals) and hand.closes
            if closes and self.closing[limb] is None:
                self.closing[limb] = {t.name: self.in_gripper(limb, t) for t in self.all.values()}
            if pick is not None:
                self.follow(limb, pick, seconds)
            elif hand.gripping:
                self.grasped(limb)
            elif self.closing[limb] and not closes and hand.missed:
                self.report({"event": "missed", "limb": limb, "touches": self.touched()})
            if not closes:
                self.closing[limb] = None
        self.offer(seconds)
        if self.restock and not any(self.picks.values()) and all(map(self.rests, self.limbs)):
            self.put_all_back()

    def grasped(self, limb):
        """The fingers have stopped on something: the object that both tips touch."""
        both = [name for name, sides in self.tips[limb].items() if len(sides) == 2]
        if not both:
            return
        thing = self.all[both[0]]
        before = (self.closing[limb] or {}).get(thing.name) or self.in_gripper(limb, thing)
        self.picks[limb] = Pick(thing, before, self.pose(thing.body)[0])
        self.with_people.discard(thing.name)
        self.offered = None

    def follow(self, limb, pick, seconds):
        hand, xyz = self.hands[limb], self.pose(pick.thing.body)[0]
        pick.lifted_m = max(pick.lifted_m, float(xyz[2] - pick.start[2]))
        if hand.gripping:
            return
        opens = bool(hand.goals) and not hand.closes
        if pick.at_release is None and not opens and hand.missed:
            return self.end(limb, pick, "dropped", True)
        if pick.at_release is None and opens:
            pick.at_release = self.in_gripper(limb, pick.thing)
            pick.xyz, pick.gripper = xyz, self.pose(self.frame[limb])
        if pick.at_release is not None:
            pick.opening_s += seconds
            touched = pick.thing.name in self.tips[limb]
            pick.loose_s = 0.0 if touched else pick.loose_s + seconds
            if pick.loose_s >= LOOSE_S or pick.opening_s >= LET_GO_S:
                self.end(limb, pick, "released", not touched)

    def end(self, limb, pick, event, is_loose):
        """Records what was done with an object, and hands over what is held up."""
        self.picks[limb] = None
        name, z = pick.thing.name, pick.thing.home[2]
        record = {"event": event, "object": name, "limb": limb, "before": pick.before,
                  "lifted_m": pick.lifted_m, "released": is_loose, "touches": self.touched(name)}
        if event == "released":
            carried = math.dist(pick.start[:2], pick.xyz[:2])
            from_home = math.dist(pick.thing.home[:3], pick.xyz)
            record |= {"in_gripper": pick.at_release, "carried_m": carried, "from_home_m": from_home,
                       "gripper_xyz": list(pick.gripper[0])}
            if pick.xyz[2] > z + HANDED_OVER_M:
                self.handed_over = (name, limb, pick.at_release, pick.gripper)
                self.take_away(pick.thing)
        self.report(record)

    def touched(self, target=None):
        """Forbidden touches since the last record, newtons: all but those of the target by fingertips."""
        allowed = f"_finger_tip - object/{target}"
        found = {pair: round(n, 1) for pair, n in self.touches.items() if not pair.endswith(allowed)}
        self.touches = {}
        return found

    def take_away(self, thing):
        """A person takes an object, and puts it on the floor behind the robot."""
        self.with_people.add(thing.name)
        place = list(self.all).index(thing.name)
        self.put(thing, [-2.0, 0.4 * place, -0.5, *thing.home[3:]])

    def offer(self, seconds):
        """A person holds out what was handed over last, where the gripper waits for it."""
        if self.handed_over is None:
            return
        name, limb, in_gripper, (at, turned) = self.handed_over
        place, own = self.pose(self.frame[limb])
        turn = math.acos(max(-1.0, min(1.0, (np.trace(turned.T @ own) - 1.0) / 2.0)))
        is_there = np.linalg.norm(place - at) < BACK_M and turn < BACK_RAD
        if self.offered:
            if not is_there:
                thing, self.offered = self.offered[0], None
                self.take_away(thing)
            return
        hand, is_still = self.hands[limb], np.abs(self.limbs[limb].qd).max() < STILL_RAD_S
        is_open = hand.percent() > 90.0 and not hand.goals and not any(self.picks.values())
        self.waiting_s = self.waiting_s + seconds if is_there and is_still and is_open else 0.0
        if self.waiting_s >= BACK_S:
            self.hold_out(self.all[name], in_gripper, place, own)

    def hold_out(self, thing, in_gripper, at, turned):
        quat, own = np.zeros(4), np.zeros(9)
        mujoco.mju_quat2Mat(own, np.array([in_gripper[6], *in_gripper[3:6]]))
        mujoco.mju_mat2Quat(quat, (turned @ own.reshape(3, 3)).flatten())
        self.offered = (thing, np.array([*(at + turned @ np.array(in_gripper[:3])), *quat]))
        self.keep()

    def rests(self, limb):
        joints = self.limbs[limb]
        near = np.abs(joints.q - self.neutral[limb]).max() < AT_REST_RAD
        return near and np.abs(joints.qd).max() < STILL_RAD_S

    def put_all_back(self):
        """People put back what they were handed, and what fell or was moved."""
        for thing in self.all.values():
            if math.dist(self.data.qpos[thing.at][:3], thing.home[:3]) > ASTRAY_M:
                place = thing.home.copy()
                place[:2] += [self.random.gauss(0.0, self.error_m) for _ in range(2)]
                self.put(thing, place)
                self.with_people.discard(thing.name)

    def remembered(self):
        """What outlives the process, beside the joints."""
        held = {limb: [p.thing.name, p.before, list(p.start), p.lifted_m]
                for limb, p in self.picks.items() if p}
        over = self.handed_over and [*self.handed_over[:3], [x.tolist() for x in self.handed_over[3]]]
        return [held, over, sorted(self.with_people)]

    def remember(self, remembered):
        held, over, with_people = remembered
        for limb, (name, before, start, lifted_m) in held.items():
            pick = self.picks[limb] = Pick(self.all[name], before, np.array(start))
            pick.lifted_m = lifted_m
        if over:
            self.handed_over = (*over[:3], tuple(np.array(x) for x in over[3]))
        self.with_people = set(with_people)
