"""A Baxter among the objects of a scene in MuJoCo, as its motors, brakes and buttons have it."""

import math
import random
import xml.etree.ElementTree as ET

import mujoco

from hand import Hand
from limb import JOINTS, Limb
from model import STEP_S, Model
from things import Things

LIMBS = ("left", "right")
# Interval of the servos' set-points, seconds, and the steps between two looks at the contacts.
BEAT_S, LOOK_STEPS = 0.01, 2
# What people and faults do to it: `DrillKind` of the messages.
ENABLE, DISABLE, RESET, PRESS_ESTOP, RELEASE_ESTOP, FAIL, SILENCE, MISS, OBSTRUCT = range(9)


class Assembly:
    """Motors, faults and the red button."""

    def __init__(self, enabled):
        self.enabled, self.stopped, self.error, self.pressed = enabled, False, False, False

    def drill(self, kind):
        if kind == ENABLE:
            # Stopped or with a fault, it has to be reset first.
            self.enabled |= not (self.stopped or self.error)
        elif kind == DISABLE:
            self.enabled = False
        elif kind == RESET and not self.pressed:
            self.stopped = self.error = False
        elif kind == PRESS_ESTOP:
            self.pressed, self.stopped, self.enabled = True, True, False
        elif kind == RELEASE_ESTOP:
            self.pressed = False
        elif kind == FAIL:
            self.error, self.enabled = True, False


def neutral(srdf, limb):
    """The neutral posture of a limb."""
    for state in ET.fromstring(srdf).findall("group_state"):
        if state.get("name") == "neutral" and state.get("group") == f"{limb}_arm":
            values = {joint.get("name"): float(joint.get("value")) for joint in state.findall("joint")}
            return [values[f"{limb}_{joint}"] for joint in JOINTS]
    raise ValueError(f"no group_state `neutral` of {limb}_arm")


def fastest(urdf, limb):
    """The greatest velocity of each joint of a limb, rad/s."""
    joints = {joint.get("name"): joint for joint in ET.fromstring(urdf).findall("joint")}
    return [float(joints[f"{limb}_{joint}"].find("limit").get("velocity")) for joint in JOINTS]


class World:
    """All of it, driven by `advance`. `settings` are those of `[arm]`; `report` takes a record of each
    pick's end. `conditions` are what the scene does not say: friction, mass, and objects displaced."""

    def __init__(self, urdf, srdf, objects, settings, report, conditions):
        simulated = settings["simulated"]
        chance = random.Random(simulated["seed"])
        error_m = settings["grasp_error_m"]
        displaced = {item["name"]: ([chance.gauss(0.0, error_m) for _ in range(2)], 0.0)
                     for item in objects}
        displaced |= conditions.displaced
        self.text = Model(urdf, objects, conditions.friction, conditions.mass_share, displaced).text()
        self.model = model = mujoco.MjModel.from_xml_string(self.text)
        self.data = data = mujoco.MjData(model)
        self.limbs = {limb: Limb(model, data, limb, fastest(urdf, limb)) for limb in LIMBS}
        self.hands = {limb: Hand(model, data, limb) for limb in LIMBS}
        postures = {limb: neutral(srdf, limb) for limb in LIMBS}
        for limb, hand in self.hands.items():
            data.qpos[self.limbs[limb].at] = postures[limb]
            data.qpos[hand.at], data.qpos[hand.other] = hand.open_travel, -hand.open_travel
            self.limbs[limb].brake()
        self.assembly = Assembly(simulated["enabled"])
        self.things = Things(model, data, objects, self.limbs, self.hands, postures,
                             (settings["restock"], error_m, chance), report)
        self.misses, self.obstructed_s, self.silent_s = 0, 0.0, 0.0
        self.missing = dict.fromkeys(LIMBS, False)
        self.hold_fast()
        mujoco.mj_forward(model, data)

    def drill(self, kind, amount):
        """What people and faults do; `amount` is seconds or a number of grasps."""
        if kind == SILENCE:
            self.silent_s = amount
        elif kind == OBSTRUCT:
            self.obstructed_s = amount
        elif kind == MISS:
            self.misses = int(amount)
        else:
            self.assembly.drill(kind)
            if not self.assembly.enabled:
                for part in (*self.limbs.values(), *self.hands.values()):
                    part.brake()
        self.hold_fast()

    def hold_fast(self):
        """Joints are held by their brakes while the motors are off, and by whoever obstructs them."""
        for limb in self.limbs.values():
            limb.hold_fast(not self.assembly.enabled or self.obstructed_s > 0.0)

    def advance(self):
        """The next `BEAT_S`."""
        if self.obstructed_s > 0.0:
            self.obstructed_s -= BEAT_S
            self.hold_fast()
        self.silent_s -= BEAT_S
        for limb, hand in self.hands.items():
            self.miss(limb, hand)
            hand.advance(BEAT_S)
            if self.assembly.enabled:
                self.limbs[limb].advance(BEAT_S)
        for _ in range(round(BEAT_S / STEP_S / LOOK_STEPS)):
            mujoco.mj_step(self.model, self.data, nstep=LOOK_STEPS)
            self.things.keep()
            self.things.look()
        self.things.advance(BEAT_S)

    def miss(self, limb, hand):
        """The grasps that are to miss go through the objects, until the fingers are open again."""
        closes = bool(hand.goals) and hand.closes
        if closes and not self.missing[limb] and self.misses > 0:
            self.misses -= 1
            self.pass_through(limb, hand, True)
        elif self.missing[limb] and not hand.goals and hand.percent() > 90.0:
            self.pass_through(limb, hand, False)

    def pass_through(self, limb, hand, passes):
        self.missing[limb] = passes
        self.model.geom_contype[hand.fingers] = 0 if passes else 1
        self.model.geom_conaffinity[hand.fingers] = 0 if passes else 2

    def is_sound(self):
        """Returns whether the simulation has not diverged."""
        return math.isfinite(self.data.qacc.sum()) and not self.data.warning[
            mujoco.mjtWarning.mjWARN_BADQACC].number

    def remembered(self):
        """What outlives the process."""
        assembly = vars(self.assembly)
        hands = {limb: hand.remembered() for limb, hand in self.hands.items()}
        return {"q": self.data.qpos.tolist(), "assembly": assembly, "hands": hands,
                "things": self.things.remembered()}

    def remember(self, remembered):
        self.data.qpos[:] = remembered["q"]
        vars(self.assembly).update(remembered["assembly"])
        mujoco.mj_forward(self.model, self.data)
        for limb in LIMBS:
            self.limbs[limb].brake()
            self.hands[limb].remember(remembered["hands"][limb])
        self.things.remember(remembered["things"])
        self.hold_fast()
