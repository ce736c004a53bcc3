"""An electric gripper of a Baxter: one motor for both fingers, and what the gripper says of itself."""

import json
import math

import mujoco
import numpy as np

# Travel of one finger per second at the SDK's default velocity, m/s.
SPEED_M_S = 0.020833
# Share of the range below which closed fingers hold nothing: the SDK's dead zone.
DEAD_ZONE = 0.05
# Force of the motor at 100 per cent, newtons a finger, and the holding force of a gripper that nobody has
# configured, per cent.
STRONGEST_N, DEFAULT_PERCENT = 35.0, 30.0
# Fingers slower than this for so long have stopped, m/s and seconds.
STILL_M_S, STILL_S = 0.0008, 0.06
# Fingers that stopped this far before their goal were stopped by something, metres.
SHORT_M = 0.0006


def named(model, kind, name):
    """The number of what has this name."""
    return mujoco.mj_name2id(model, kind, name)


class Hand:
    """The gripper of one limb."""

    def __init__(self, model, data, limb):
        self.model, self.data, self.limb = model, data, limb
        name = f"{limb[0]}_gripper_l_finger_joint"
        joint = named(model, mujoco.mjtObj.mjOBJ_JOINT, name)
        other = named(model, mujoco.mjtObj.mjOBJ_JOINT, f"{limb[0]}_gripper_r_finger_joint")
        self.motor = named(model, mujoco.mjtObj.mjOBJ_ACTUATOR, name)
        self.at, self.dof = model.jnt_qposadr[joint], model.jnt_dofadr[joint]
        self.other = model.jnt_qposadr[other]
        self.open_travel = float(model.jnt_range[joint, 1])
        # The motor's force moves both fingers.
        self.strongest = float(model.actuator_forcerange[self.motor, 1]) / 2
        self.tips = self.shapes("_finger_tip#")
        self.fingers = self.shapes("_finger#") + self.tips
        self.stop_m = self.gap() - 2.0 * self.open_travel
        self.closed_m = max(self.stop_m, 0.0)
        self.open_m = self.width(self.open_travel)
        # Position that the motor is driven to, and where it will end: travel of a finger, metres.
        self.reference = self.open_travel
        self.goals = []
        self.still_s = 0.0
        self.calibrated = self.calibrating = self.gripping = self.missed = False
        self.closes = False
        self.handled = ("", "", 0)
        self.configure(DEFAULT_PERCENT)

    def shapes(self, part):
        """The shapes of the hand's links whose names have this in them."""
        names = ((g, mujoco.mj_id2name(self.model, mujoco.mjtObj.mjOBJ_GEOM, g) or "")
                 for g in range(self.model.ngeom))
        return [g for g, name in names if name.startswith(f"{self.limb[0]}_gripper_") and part in name]

    def gap(self):
        """Distance between the shapes of the open fingertips, metres, as the description has them."""
        data = mujoco.MjData(self.model)
        data.qpos[:] = self.model.qpos0
        data.qpos[self.at], data.qpos[self.other] = self.open_travel, -self.open_travel
        mujoco.mj_kinematics(self.model, data)
        name = lambda g: mujoco.mj_id2name(self.model, mujoco.mjtObj.mjOBJ_GEOM, g)
        left, right = ([g for g in self.tips if f"_gripper_{side}_" in name(g)] for side in "lr")
        points = np.zeros(6)
        return min(mujoco.mj_geomDistance(self.model, data, a, b, 1.0, points)
                   for a in left for b in right)

    def width(self, travel):
        """Distance of the fingertips, metres, with the fingers at this travel."""
        return self.stop_m + 2.0 * travel

    def travel_at(self, percent):
        """Travel of a finger at a position in per cent of the range."""
        width = self.closed_m + (self.open_m - self.closed_m) * min(max(percent, 0.0), 100.0) / 100.0
        return min(max((width - self.stop_m) / 2.0, 0.0), self.open_travel)

    @property
    def travel(self):
        return float(self.data.qpos[self.at])

    def percent(self):
        """Position of the fingers, per cent of their range."""
        share = (self.width(self.travel) - self.closed_m) / (self.open_m - self.closed_m)
        return 100.0 * min(max(share, 0.0), 1.0)

    def has_between(self):
        """Returns whether the fingers stand apart by more than the dead zone."""
        return self.percent() > 100.0 * DEAD_ZONE

    def force(self):
        """Force of a finger, newtons."""
        return abs(float(self.data.actuator_force[self.motor])) / 2.0

    def configure(self, percent):
        """Sets the holding force."""
        newtons = min(self.strongest, STRONGEST_N * min(max(percent, 0.0), 100.0) / 100.0)
        self.model.actuator_forcerange[self.motor] = (-2.0 * newtons, 2.0 * newtons)

    def command(self, word, args, sender, sequence):
        """Handles a command and returns whether it is new; one that needs a calibration that is missing
        changes nothing. Raises ValueError for one that makes no sense."""
        handled = (word, sender, sequence)
        if handled == self.handled or not self.calibrated and word != "calibrate":
            return False
        # Fingers that close press on each other, or on what is between them.
        goals = {"calibrate": [self.open_travel, 0.0, self.open_travel], "grip": [0.0],
                 "release": [self.open_travel]}
        if word == "configure":
            self.configure(number(args, "holding_force"))
        elif word == "stop":
            self.goals, self.reference = [], self.travel
        elif word == "go":
            percent = number(args, "position")
            self.go([self.travel_at(percent) if percent > 0.0 else 0.0])
        elif word in goals:
            self.go(goals[word])
        else:
            raise ValueError(f"unknown gripper command `{word}`")
        if word == "calibrate":
            self.calibrated, self.calibrating = False, True
        self.handled = handled
        return True

    def go(self, goals):
        """Drives the fingers to positions, one after the other."""
        closes = goals[-1] < self.travel - DEAD_ZONE * self.open_travel
        if self.gripping and closes:
            return
        self.goals, self.closes, self.still_s = goals, closes, 0.0
        self.gripping = self.missed = False
        self.reference = self.travel

    def advance(self, seconds):
        """Drives the motor for the next `seconds`, and notices that the fingers have stopped. Fingers that
        stopped before the end of their way grip, and go on pressing."""
        if self.gripping and not self.has_between():
            # What they held is gone.
            self.gripping, self.missed = False, True
        if self.goals:
            goal, step = self.goals[0], SPEED_M_S * seconds
            self.reference += min(max(goal - self.reference, -step), step)
            speed = abs(float(self.data.qvel[self.dof]))
            at_end = abs(goal - self.reference) < 1e-9
            self.still_s = self.still_s + seconds if at_end and speed < STILL_M_S else 0.0
            if self.still_s >= STILL_S:
                self.arrive(goal)
        self.data.ctrl[self.motor] = self.reference

    def arrive(self, goal):
        self.goals.pop(0)
        self.still_s = 0.0
        if self.goals:
            return
        if self.calibrating:
            self.calibrating, self.calibrated = False, True
        elif self.closes:
            self.gripping = self.travel - goal > SHORT_M and self.has_between()
            self.missed = not self.gripping

    def brake(self):
        """The motor keeps its position, and presses on what it holds, but moves nowhere."""
        self.goals, self.calibrating = [], False
        if not self.gripping:
            self.reference = self.travel

    def remembered(self):
        """What outlives the process."""
        force = float(self.model.actuator_forcerange[self.motor, 1]) / 2.0
        return [self.reference, self.calibrated, self.gripping, self.missed, list(self.handled), force]

    def remember(self, remembered):
        self.reference, self.calibrated, self.gripping, self.missed, handled, force = remembered
        self.handled = tuple(handled)
        self.model.actuator_forcerange[self.motor] = (-2.0 * force, 2.0 * force)
        self.data.ctrl[self.motor] = self.reference


def number(args, key):
    """The number under `key` in a command's arguments, which are JSON."""
    value = float(json.loads(args)[key])
    if not math.isfinite(value):
        raise ValueError(f"{key} is {value}")
    return value
