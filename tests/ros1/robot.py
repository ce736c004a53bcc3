"""A robot with the ROS 1 interface of a Baxter, for tests of the bridge: rospy and the standard library.

Joints follow their commands with a lag, grippers meet an object whenever they close, and the clock is an
hour ahead. One command a line on standard input; each is answered with one line of JSON.
"""

import json
import math
import sys
import threading
import time

import rospy
from baxter_core_msgs.msg import (
    AssemblyState,
    EndEffectorCommand,
    EndEffectorProperties,
    EndEffectorState,
    EndpointState,
    JointCommand,
)
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from trajectory_msgs.msg import JointTrajectoryPoint

CLOCK_AHEAD_S = 3600.0
PERIOD_S = 0.01
LAG_S = 0.03
COMMAND_TIMEOUT_S = 0.2
# The fastest that a joint is moved in the tests, and at least what it then makes up for; joint states that are older
# than this stop the arm.
FASTEST_RAD_S, CATCHES_UP_RAD_S, STALE_S = 0.5, 0.25, 1.0
# The joints advance by no more at once, however late this program is.
ADVANCE_MAX_S = 0.1
FINGERS_PERCENT_S = 100.0
OBJECT_PERCENT = 15.0
JOINTS = ["s0", "s1", "e0", "e1", "w0", "w1", "w2"]
NEUTRAL = [0.0, -0.55, 0.0, 0.75, 0.0, 1.26, 0.0]
LIMBS = ["left", "right"]


def stamp():
    return rospy.Time.from_sec(time.time() + CLOCK_AHEAD_S)


class Gripper:
    def __init__(self):
        self.position = 100.0
        self.goals = []
        self.calibrated = False
        self.gripping = self.missed = False
        self.handled = EndEffectorCommand()

    def command(self, message):
        if message.sequence == self.handled.sequence and message.sender == self.handled.sender:
            return
        if not self.calibrated and message.command != "calibrate":
            return
        self.handled = message
        self.missed = False
        if message.command == "calibrate":
            self.goals = [0.0, 100.0]
        elif message.command in ("grip", "release", "go"):
            ends = {"grip": 0.0, "release": 100.0}
            args = json.loads(message.args or "{}")
            self.goals = [ends.get(message.command, args.get("position", 100.0))]
        else:
            self.goals = []

    def advance(self, seconds):
        if not self.goals:
            return
        calibrates = self.handled.command == "calibrate"
        goal = self.goals[0] if calibrates else max(self.goals[0], OBJECT_PERCENT)
        travel = FINGERS_PERCENT_S * seconds
        self.position += max(-travel, min(travel, goal - self.position))
        if abs(goal - self.position) > 1e-6:
            return
        self.gripping = not calibrates and self.goals[0] < OBJECT_PERCENT
        self.calibrated = self.calibrated or calibrates and len(self.goals) == 1
        self.goals.pop(0)

    def state(self):
        moving = bool(self.goals)
        return EndEffectorState(
            timestamp=stamp(),
            id=65664,
            enabled=1,
            calibrated=self.calibrated,
            ready=self.calibrated and not moving,
            moving=moving,
            gripping=self.gripping,
            missed=self.missed,
            position=self.position,
            state="{}",
            command=self.handled.command,
            command_sender=self.handled.sender,
            command_sequence=self.handled.sequence,
        )


class Robot:
    def __init__(self):
        self.lock = threading.Lock()
        self.joints = {"head_nod": 0.0, "head_pan": 0.0, "torso_t0": 0.0}
        self.velocity = {}
        self.target = {limb: None for limb in LIMBS}
        self.grippers = {limb: Gripper() for limb in LIMBS}
        self.stopped = False
        # What the tests judge.
        self.seen = {"commands": 0, "points": 0, "ratios": 0, "largest_error_rad": 0.0, "silence_s": 0.0}
        self.last_command = None
        # How far a command may lead because this robot, or the bridge, has paused.
        self.lead = 0.0
        # When joint states were published that no command has answered yet, and how long the answers took.
        self.unanswered = None
        self.latencies_ms = []
        for limb in LIMBS:
            mirrored = 1.0 if limb == "left" else -1.0
            for i, (joint, angle) in enumerate(zip(JOINTS, NEUTRAL)):
                self.joints[f"{limb}_{joint}"] = angle * (mirrored if i % 2 == 0 else 1.0)
        self.open_topics()

    def open_topics(self):
        def publisher(name, kind):
            return rospy.Publisher(name, kind, queue_size=1, tcp_nodelay=True)

        def subscriber(name, kind, take, limb):
            rospy.Subscriber(name, kind, take, callback_args=limb, queue_size=1, tcp_nodelay=True)

        self.to_joints = publisher("/robot/joint_states", JointState)
        self.to_state = publisher("/robot/state", AssemblyState)
        self.to_endpoint, self.to_gripper, self.to_properties = {}, {}, {}
        for limb in LIMBS:
            own, hand = f"/robot/limb/{limb}", f"/robot/end_effector/{limb}_gripper"
            self.to_endpoint[limb] = publisher(f"{own}/endpoint_state", EndpointState)
            self.to_gripper[limb] = publisher(f"{hand}/state", EndEffectorState)
            self.to_properties[limb] = publisher(f"{hand}/properties", EndEffectorProperties)
            subscriber(f"{own}/joint_command", JointCommand, self.on_command, limb)
            subscriber(f"{own}/inverse_dynamics_command", JointTrajectoryPoint, self.on_point, limb)
            subscriber(f"{own}/set_speed_ratio", Float64, self.on_ratio, limb)
            subscriber(f"{hand}/command", EndEffectorCommand, self.on_gripper, limb)

    def on_command(self, message, limb):
        now = time.monotonic()
        with self.lock:
            if self.unanswered is not None:
                self.latencies_ms.append(1000.0 * (now - self.unanswered))
                self.unanswered = None
            if message.mode != JointCommand.POSITION_MODE:
                raise ValueError(message.mode)
            target = dict(zip(message.names, message.command))
            error = max(abs(angle - self.joints[name]) for name, angle in target.items())
            seen = self.seen
            seen["commands"] += 1
            if self.last_command is not None:
                gap = now - self.last_command
                seen["silence_s"] = max(seen["silence_s"], gap)
                # A moving arm goes on until joint states are stale; the robot catches up with it afterwards.
                self.lead = max(self.lead - gap * CATCHES_UP_RAD_S, gap * FASTEST_RAD_S if gap < STALE_S else 0.0)
            seen["largest_error_rad"] = max(seen["largest_error_rad"], error - self.lead)
            self.last_command = now
            self.target[limb] = (target, now)

    def on_point(self, _, __):
        self.seen["points"] += 1

    def on_ratio(self, message, _):
        if message.data == 1.0:
            self.seen["ratios"] += 1

    def on_gripper(self, message, limb):
        with self.lock:
            self.grippers[limb].command(message)

    def advance(self, seconds):
        now, share = time.monotonic(), 1.0 - math.exp(-seconds / LAG_S)
        for limb in LIMBS:
            target, at = self.target[limb] or ({}, 0.0)
            for joint in JOINTS:
                name = f"{limb}_{joint}"
                goal = target.get(name, self.joints[name])
                if now - at > COMMAND_TIMEOUT_S or self.stopped:
                    goal = self.joints[name]
                step = share * (goal - self.joints[name])
                self.joints[name] += step
                self.velocity[name] = step / seconds
            self.grippers[limb].advance(seconds)

    def report(self, beat):
        names = sorted(self.joints)
        state = JointState(name=names, position=[self.joints[name] for name in names])
        state.velocity = [self.velocity.get(name, 0.0) for name in names]
        state.effort = [0.0] * len(names)
        state.header.stamp = stamp()
        self.unanswered = time.monotonic()
        self.to_joints.publish(state)
        for limb in LIMBS:
            finger = JointState(name=[f"{limb[0]}_gripper_l_finger_joint"], position=[0.01])
            finger.header.stamp = state.header.stamp
            self.to_joints.publish(finger)
            endpoint = EndpointState()
            endpoint.header.stamp = state.header.stamp
            self.to_endpoint[limb].publish(endpoint)
            if beat % 5 == 0:
                self.to_gripper[limb].publish(self.grippers[limb].state())
            if beat % 100 == 0:
                self.to_properties[limb].publish(properties(limb))
        enabled = not self.stopped
        self.to_state.publish(AssemblyState(ready=enabled, enabled=enabled, stopped=self.stopped))

    def run(self):
        beat, last = 0, time.monotonic()
        while not rospy.is_shutdown():
            with self.lock:
                now = time.monotonic()
                late = min(now - last, STALE_S)
                if late > ADVANCE_MAX_S:
                    self.lead = max(self.lead, late * FASTEST_RAD_S)
                self.advance(min(late, ADVANCE_MAX_S) or PERIOD_S)
                last = now
                self.report(beat)
            beat += 1
            time.sleep(max(0.0, PERIOD_S - (time.monotonic() - now)))

    def answer(self, word):
        with self.lock:
            if word == "reset":
                self.seen.update(commands=0, points=0, largest_error_rad=0.0, silence_s=0.0)
                self.last_command, self.lead = None, 0.0
            elif word in ("stop", "go"):
                self.stopped = word == "stop"
            elif word == "latencies":
                taken, self.latencies_ms = self.latencies_ms, []
                return {"ms": taken}
            fastest = max((abs(v) for v in self.velocity.values()), default=0.0)
            return dict(self.seen, fastest_rad_s=fastest, joints=self.joints)


def properties(limb):
    return EndEffectorProperties(
        id=65664,
        ui_type=EndEffectorProperties.ELECTRIC_GRIPPER,
        manufacturer="tests",
        product="a gripper with a long name, longer than what the group's message has room for",
        serial_number=limb,
        has_calibration=True,
        controls_grip=True,
        senses_grip=True,
        controls_force=True,
        senses_force=True,
        controls_position=True,
        senses_position=True,
    )


def main():
    rospy.init_node("robot", disable_signals=True)
    robot = Robot()
    threading.Thread(target=robot.run, daemon=True).start()
    for line in sys.stdin:
        print(json.dumps(robot.answer(line.strip())), flush=True)


if __name__ == "__main__":
    main()
