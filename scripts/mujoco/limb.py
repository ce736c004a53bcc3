"""The joints of one limb: position servos with velocity feed-forward behind Baxter's joint commands."""

import mujoco
import numpy as np

from hand import named

JOINTS = ("s0", "s1", "e0", "e1", "w0", "w1", "w2")
POSITION, VELOCITY = 1, 2
# Seconds without a command after which a limb holds the position that it has: `joint_command_timeout`.
COMMAND_TIMEOUT_S = 0.2
# Seconds after which a velocity no longer belongs to the motion that is commanded now.
FEED_TIMEOUT_S = 0.03
# Initial share of its velocity that a limb may use.
SPEED_RATIO = 0.3
# Friction of a joint that is held by its brake, or by somebody, N m.
BRAKE_NM = 300.0


class Limb:
    """Seven joints."""

    def __init__(self, model, data, limb, velocity):
        self.model, self.data = model, data
        self.names = [f"{limb}_{joint}" for joint in JOINTS]
        self.motors = np.array([named(model, mujoco.mjtObj.mjOBJ_ACTUATOR, n) for n in self.names])
        joints = np.array([named(model, mujoco.mjtObj.mjOBJ_JOINT, n) for n in self.names])
        self.at, self.dofs = model.jnt_qposadr[joints], model.jnt_dofadr[joints]
        self.velocity, self.range = np.array(velocity), model.jnt_range[joints]
        bias = model.actuator_biasprm[self.motors]
        # Seconds by which a servo with this damping lags behind a steady motion.
        self.lag_s = bias[:, 2] / bias[:, 1]
        self.friction = model.dof_frictionloss[self.dofs].copy()
        self.speed_ratio = SPEED_RATIO
        self.brake()

    @property
    def q(self):
        return self.data.qpos[self.at]

    @property
    def qd(self):
        return self.data.qvel[self.dofs]

    @property
    def effort(self):
        return self.data.actuator_force[self.motors]

    def command(self, mode, joints):
        """Takes a command: names and values of joints. Others keep what they do. Raises ValueError for a
        mode that no robot should be used in."""
        if mode not in (POSITION, VELOCITY):
            raise ValueError(f"joint command mode {mode}")
        values = self.reference.copy() if mode == POSITION else np.zeros(len(JOINTS))
        for name, value in joints:
            if name in self.names and np.isfinite(value):
                values[self.names.index(name)] = value
        self.target, self.silent_s = (mode, values), 0.0

    def feed_forward(self, velocity):
        """Takes the velocity of the commanded motion, rad/s."""
        if np.isfinite(velocity).all():
            self.fed, self.fed_s = np.array(velocity), 0.0

    def set_speed_ratio(self, ratio):
        """Takes the share of its velocity that it may use."""
        if np.isfinite(ratio):
            self.speed_ratio = min(max(ratio, 0.0), 1.0)

    def brake(self):
        """Holds the position that it has, and drops its command."""
        self.reference = self.q.copy()
        self.target, self.silent_s = None, 0.0
        self.fed, self.fed_s = np.zeros(len(JOINTS)), 0.0
        self.data.ctrl[self.motors] = self.reference

    def hold_fast(self, is_held):
        """Lets the joints' brakes, or somebody, keep them from moving; or ends that."""
        self.model.dof_frictionloss[self.dofs] = BRAKE_NM if is_held else self.friction

    def advance(self, seconds):
        """Sets the servos for the next `seconds`."""
        self.silent_s += seconds
        self.fed_s += seconds
        if self.target is not None and self.silent_s > COMMAND_TIMEOUT_S:
            self.brake()
        if self.fed_s > FEED_TIMEOUT_S:
            self.fed = np.zeros(len(JOINTS))
        fastest = self.speed_ratio * self.velocity
        mode, values = self.target or (POSITION, self.reference)
        if mode == VELOCITY:
            goal, velocity = self.reference + values * seconds, values
        else:
            goal, velocity = values, self.fed if self.target else np.zeros(len(JOINTS))
        step = np.clip(goal - self.reference, -fastest * seconds, fastest * seconds)
        self.reference = np.clip(self.reference + step, self.range[:, 0], self.range[:, 1])
        velocity = np.clip(velocity, -fastest, fastest)
        self.data.ctrl[self.motors] = self.reference + self.lag_s * velocity
