"""Picks of an arm whose gripper is one jaw that turns towards a finger that does not move."""

import xml.etree.ElementTree as ET

import mujoco
import numpy as np

from hand import named

# Frames at the tips: of the fixed finger, and of the jaw.
FINGER, JAW = "arm_gripper", "arm_jaw"
# Angles at which the opening of a jaw is measured.
LOOKS = 400


def is_jawed(robot):
    """Returns whether a description has one jaw."""
    return any(link.get("name") == JAW for link in robot.findall("link"))


def carriers(robot):
    """The links between each of the tips and the joint that moves it, whose shapes enclose more than the fingers."""
    parents = {joint.find("child").get("link"): joint.find("parent").get("link") for joint in robot.findall("joint")}
    return [parents[FINGER], parents[JAW]]


def exclude(built, target):
    """Lets the hand's wide shapes overlap what is gripped: the pads at the tips touch it."""
    for link in carriers(built.robot):
        ET.SubElement(built.contact, "exclude", body1=link, body2=target)


class JawHand:
    """The motor of the jaw, and the opening at each of its angles as the model itself has it."""

    def __init__(self, model, data):
        self.model, self.data = model, data
        body = model.body_parentid[named(model, mujoco.mjtObj.mjOBJ_BODY, JAW)]
        joint = model.body_jntadr[body]
        self.at = model.jnt_qposadr[joint]
        self.motor = next(a for a in range(model.nu) if model.actuator_trnid[a, 0] == joint)
        low, high = model.jnt_range[joint]
        self.angles = np.linspace(low, high, LOOKS)
        self.openings = np.array([self.opening(angle) for angle in self.angles])
        # Beyond its widest opening the tip only turns away.
        widest = int(np.argmax(self.openings))
        self.angles, self.openings = self.angles[:widest + 1], self.openings[:widest + 1]

    def opening(self, angle):
        """Distance of the jaw's tip from the face of the fixed finger, metres."""
        data = mujoco.MjData(self.model)
        data.qpos[:] = self.model.qpos0
        data.qpos[self.at] = angle
        mujoco.mj_kinematics(self.model, data)
        finger, jaw = (named(self.model, mujoco.mjtObj.mjOBJ_BODY, name) for name in (FINGER, JAW))
        turned = data.xmat[finger].reshape(3, 3)
        return float((turned.T @ (data.xpos[jaw] - data.xpos[finger]))[1])

    def angle(self, width):
        """Angle at an opening, radians."""
        return float(np.interp(width, self.openings, self.angles))

    def begin(self, width):
        """Opens it."""
        self.data.qpos[self.at] = self.data.ctrl[self.motor] = self.angle(width)

    def command(self, width, presses):
        """Drives it to an opening, or lets it press."""
        self.data.ctrl[self.motor] = self.angles[0] if presses else self.angle(width)

    def is_tip(self, owner):
        return owner in (FINGER, JAW)
