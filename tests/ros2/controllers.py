"""Controllers of an arm and its gripper, as ros2_control has them, over rclpy: a simulated arm behind the actions.

The rules are those of joint_trajectory_controller and of the gripper controllers, read from their sources: goals are
accepted whole or not at all, a new one takes over at once, a cancelled one holds the arm where it is, tolerances abort,
nothing watches the client. Actions, messages and middleware are ROS 2's own.

    controllers.py DOMAIN [--joints a,b,…] [--distribution jazzy|humble] [--gripper-joint NAME] [--no-velocities]

Commands, one a line on standard input, each answered with one line of JSON:
    look              what the arm does, and what was asked of it
    now               the time of this machine's monotonic clock
    block 0|1         something holds the arm where it is
    freeze 0|1        joint states are not published
    refuse 0|1        the controller is inactive: goals are refused
    deaf 0|1          nothing is answered
    present 0|1       there is something between the fingers when they close
    foreign SECONDS   another client moves the first joint by 0.3 rad in this time
"""

import argparse
import json
import math
import os
import sys
import threading
import time

os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"

parser = argparse.ArgumentParser()
parser.add_argument("domain")
parser.add_argument("--joints", default="")
parser.add_argument("--start", default="")
parser.add_argument("--distribution", default="jazzy", choices=["jazzy", "humble"])
parser.add_argument("--gripper-joint", default="finger_joint")
parser.add_argument("--gripper", default="GripperCommand", choices=["GripperCommand", "ParallelGripperCommand"])
parser.add_argument("--open", type=float, default=0.025)
parser.add_argument("--grasp", type=float, default=0.012)
parser.add_argument("--no-velocities", action="store_true")
options = parser.parse_args()
os.environ["ROS_DOMAIN_ID"] = options.domain

import rclpy
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory, GripperCommand, ParallelGripperCommand
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.action.server import GoalEvent
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectoryPoint

JOINTS = options.joints.split(",")
PERIOD_S = 0.01
MONITOR_S = 0.05
STOPPED_RAD_S = 0.01
STALL_S = 0.3
FINGER_M_S = 0.1


def seconds(duration):
    return duration.sec + 1e-9 * duration.nanosec


def flaw(goal, active):
    """Returns why a controller refuses a goal; None if it accepts it."""
    names, points = goal.trajectory.joint_names, goal.trajectory.points
    if not active:
        return "inactive"
    if sorted(names) != sorted(JOINTS):
        return f"joints {names}"
    if not points:
        return "no points"
    times = [seconds(point.time_from_start) for point in points]
    if any(later <= earlier for earlier, later in zip(times, times[1:])):
        return f"times {times}"
    for point in points:
        if len(point.positions) != len(JOINTS) or len(point.velocities) not in (0, len(JOINTS)):
            return "lengths of a point"
        if len(point.accelerations) not in (0, len(JOINTS)) or point.effort:
            return "lengths of a point"
        if not all(map(math.isfinite, [*point.positions, *point.velocities])):
            return "not a number"
    if options.distribution != "humble" and any(abs(v) > 1e-6 for v in points[-1].velocities):
        return "velocity at the end"
    stamp = seconds(goal.trajectory.header.stamp)
    if stamp and stamp + times[-1] < time.time():
        return "ended in the past"
    return None


def cubic(from_, to, at):
    """State of one joint between two states (time, position, velocity)."""
    (t0, q0, v0), (t1, q1, v1) = from_, to
    h = t1 - t0
    u = (at - t0) / h
    a, b = 3 * (q1 - q0) / h - 2 * v0 - v1, v0 + v1 - 2 * (q1 - q0) / h
    return q0 + h * u * (v0 + u * (a + u * b)), v0 + u * (2 * a + 3 * u * b)


class Goal:
    """An accepted goal and how it ends."""

    def __init__(self, handle, q, v, now):
        self.handle, self.end, self.over = handle, None, Future()
        request = handle.request
        order = [request.trajectory.joint_names.index(name) for name in JOINTS]
        stamp = seconds(request.trajectory.header.stamp)
        begin = now + (stamp - time.time() if stamp else 0.0)
        self.states = [(now, list(q), list(v))]
        first = request.trajectory.points[0].time_from_start
        self.late_s = now - begin - seconds(first) if stamp else -1.0
        for point in request.trajectory.points:
            at = begin + seconds(point.time_from_start)
            velocities = point.velocities or [0.0] * len(JOINTS)
            state = (at, [point.positions[k] for k in order], [velocities[k] for k in order])
            if at > now + 1e-6:
                self.states.append(state)
            else:
                # What is past is passed over: the arm is where the trajectory is now.
                self.states = [(now, list(q), list(v))]
        if len(self.states) == 1:
            self.states.append((now + PERIOD_S, state[1], state[2]))
        self.tolerance = {t.name: t.position for t in request.path_tolerance}
        self.goal_tolerance = {t.name: t.position for t in request.goal_tolerance}
        self.goal_time = seconds(request.goal_time_tolerance)

    def desired(self, now):
        states = self.states
        if now >= states[-1][0]:
            return list(states[-1][1]), [0.0] * len(JOINTS)
        k = next(k for k in range(1, len(states)) if states[k][0] > now)
        (t0, q0, v0), (t1, q1, v1) = states[k - 1], states[k]
        each = [cubic((t0, q0[j], v0[j]), (t1, q1[j], v1[j]), max(now, t0)) for j in range(len(JOINTS))]
        return [q for q, _ in each], [v for _, v in each]


class Arm(Node):
    def __init__(self):
        super().__init__("controllers")
        self.q = [float(q) for q in options.start.split(",")] if options.start else [0.0] * len(JOINTS)
        self.v, self.goal, self.lock = [0.0] * len(JOINTS), None, threading.RLock()
        self.waiting = []
        self.blocked = self.frozen = self.deaf = False
        self.active = self.present = True
        self.counts = {"accepted": 0, "refused": 0, "replaced": 0, "cancelled": 0, "aborted": 0, "succeeded": 0}
        self.latest_s = -1.0
        self.refusals, self.fastest, self.moved_at, self.jump = [], 0.0, time.monotonic(), 0.0
        self.finger, self.finger_goal = options.open, None
        self.server = ActionServer(
            self,
            FollowJointTrajectory,
            "/arm_controller/follow_joint_trajectory",
            execute_callback=self.execute,
            goal_callback=self.judge,
            cancel_callback=self.cancel,
            handle_accepted_callback=self.accept,
        )
        self.gripper = ActionServer(
            self,
            {"GripperCommand": GripperCommand, "ParallelGripperCommand": ParallelGripperCommand}[options.gripper],
            "/gripper_controller/gripper_cmd",
            execute_callback=self.grip,
            cancel_callback=self.cancel_grip,
        )
        self.states = self.create_publisher(JointState, "/joint_states", 10)
        self.create_timer(MONITOR_S, self.monitor)
        self.create_timer(0.5 * MONITOR_S, self.move_fingers)
        threading.Thread(target=self.run, daemon=True).start()

    def judge(self, goal):
        why = flaw(goal, self.active)
        self.counts["refused" if why else "accepted"] += 1
        if why:
            self.refusals = [*self.refusals, why][-5:]
        return GoalResponse.REJECT if why else GoalResponse.ACCEPT

    def accept(self, handle):
        with self.lock:
            before = self.goal
            self.goal = Goal(handle, self.q, self.v, time.monotonic())
            self.latest_s = max(self.latest_s, self.goal.late_s)
            if before is not None and before.end is None:
                before.end = ("replaced", -1, "Current goal preempted by new incoming action.")
            self.waiting.append(self.goal)
        handle.execute()

    def cancel(self, handle):
        """The command jumps to where the arm is."""
        with self.lock:
            if self.goal is not None and self.goal.handle.goal_id == handle.goal_id:
                self.goal, self.v = None, [0.0] * len(JOINTS)
        return CancelResponse.ACCEPT

    async def execute(self, handle):
        own = next(goal for goal in self.waiting if goal.handle.goal_id == handle.goal_id)
        await own.over
        self.waiting.remove(own)
        kind, code, text = own.end
        self.counts[kind] += 1
        result = FollowJointTrajectory.Result(error_code=code, error_string=text)
        if kind == "succeeded":
            handle.succeed()
        elif kind == "cancelled":
            handle.canceled()
        elif kind == "replaced" and options.distribution == "humble":
            if not handle.is_cancel_requested:
                handle._update_state(GoalEvent.CANCEL_GOAL)
            handle.canceled()
        else:
            handle.abort()
        return result

    def monitor(self):
        """Ends are told twenty times a second."""
        with self.lock:
            for goal in self.waiting:
                if goal.handle.is_cancel_requested and goal.end is None:
                    goal.end = ("cancelled", 0, "")
            done = [goal for goal in self.waiting if goal.end and not goal.over.done()]
        for goal in done:
            goal.over.set_result(True)

    def run(self):
        while True:
            began = time.monotonic()
            with self.lock:
                self.step(began)
                message = self.message()
            if not self.frozen:
                self.states.publish(message)
            time.sleep(max(0.0, PERIOD_S - (time.monotonic() - began)))

    def step(self, now):
        goal, before = self.goal, list(self.q)
        if goal is None:
            self.v = [0.0] * len(JOINTS)
        else:
            q, v = goal.desired(now)
            self.q, self.v = (self.q, [0.0] * len(JOINTS)) if self.blocked else (q, v)
            off = [abs(a - b) for a, b in zip(q, self.q)]
            self.check(goal, off, now)
        if any(abs(a - b) > 1e-9 for a, b in zip(before, self.q)):
            self.moved_at = now
            self.fastest = max(self.fastest, *map(abs, self.v))

    def check(self, goal, off, now):
        limits = [goal.tolerance.get(name, 0.0) for name in JOINTS]
        if goal.end is None and any(0 < limit < error for limit, error in zip(limits, off)):
            goal.end = ("aborted", -4, "path tolerance")
            self.goal = None
        end = goal.states[-1][0]
        if goal.end is not None or now < end:
            return
        limits = [goal.goal_tolerance.get(name, 0.0) for name in JOINTS]
        still = all(abs(v) < STOPPED_RAD_S for v in self.v)
        if still and all(limit == 0 or error <= limit for limit, error in zip(limits, off)):
            goal.end = ("succeeded", 0, "Goal successfully reached!")
        elif goal.goal_time and now > end + goal.goal_time:
            goal.end = ("aborted", -5, "goal time tolerance")
            self.goal = None

    def message(self):
        message = JointState()
        message.header.stamp = self.get_clock().now().to_msg()
        message.name = [options.gripper_joint, *reversed(JOINTS)]
        message.position = [self.finger, *reversed(self.q)]
        if not options.no_velocities:
            message.velocity = [0.0, *reversed(self.v)]
        return message

    def cancel_grip(self, _handle):
        return CancelResponse.ACCEPT

    async def grip(self, handle):
        command = handle.request.command
        goal = command.position if options.gripper == "GripperCommand" else command.position[0]
        done = Future()
        self.finger_goal = (goal, done, handle, None)
        stalled = await done
        parallel = options.gripper == "ParallelGripperCommand"
        result = ParallelGripperCommand.Result() if parallel else GripperCommand.Result()
        if not parallel:
            result.position = self.finger
        result.stalled, result.reached_goal = bool(stalled), stalled is False
        if handle.is_cancel_requested:
            handle.canceled()
        elif parallel and stalled:
            # allow_stalling is off by default: a grasp ends as aborted.
            handle.abort()
        else:
            handle.succeed()
        return result

    def move_fingers(self):
        if self.finger_goal is None:
            return
        goal, done, handle, stalled_since = self.finger_goal
        if handle.is_cancel_requested:
            self.finger_goal = None
            return done.set_result(None)
        stop = max(goal, options.grasp) if self.present else goal
        step = 0.5 * MONITOR_S * FINGER_M_S
        self.finger += min(step, max(-step, stop - self.finger))
        if abs(self.finger - goal) < 1e-6:
            self.finger_goal = None
            done.set_result(False)
        elif abs(self.finger - stop) < 1e-6:
            since = stalled_since or time.monotonic()
            self.finger_goal = (goal, done, handle, since)
            if time.monotonic() - since > STALL_S:
                self.finger_goal = None
                done.set_result(True)

    def look(self):
        with self.lock:
            now = time.monotonic()
            return {
                **self.counts,
                "refusals": self.refusals,
                "q": self.q,
                "speed": max(map(abs, self.v)),
                "fastest": self.fastest,
                "latest_s": self.latest_s,
                "moved_at": self.moved_at,
                "now": now,
                "executing": self.goal is not None and self.goal.end is None,
                "finger": self.finger,
            }


class Stranger:
    """Another client of the same controller, in a node of its own."""

    def __init__(self, arm):
        self.arm, self.node = arm, rclpy.create_node("stranger")
        self.client = ActionClient(self.node, FollowJointTrajectory, "/arm_controller/follow_joint_trajectory")
        threading.Thread(target=rclpy.spin, args=(self.node, SingleThreadedExecutor()), daemon=True).start()

    def move(self, duration):
        goal = FollowJointTrajectory.Goal()
        goal.trajectory.joint_names = JOINTS
        point = JointTrajectoryPoint()
        point.positions = [self.arm.q[0] + 0.3, *self.arm.q[1:]]
        point.time_from_start = Duration(sec=int(duration), nanosec=int(duration % 1 * 1e9))
        goal.trajectory.points = [point]
        self.client.wait_for_server(10)
        self.client.send_goal_async(goal)


def main():
    rclpy.init()
    try:
        # Controllers have real-time priority.
        os.nice(-10)
    except PermissionError:
        pass
    arm, executor = Arm(), SingleThreadedExecutor()
    executor.add_node(arm)

    def spin():
        while True:
            if arm.deaf:
                time.sleep(0.01)
            else:
                executor.spin_once(timeout_sec=0.05)

    threading.Thread(target=spin, daemon=True).start()
    stranger = None
    for line in sys.stdin:
        word, *rest = line.split()
        value = float(rest[0]) if rest else 1.0
        answer = {}
        if word == "look":
            answer = arm.look()
        elif word == "now":
            answer = {"now": time.monotonic()}
        elif word == "foreign":
            stranger = stranger or Stranger(arm)
            stranger.move(value)
        elif word == "refuse":
            arm.active = not value
        else:
            setattr(arm, {"block": "blocked", "freeze": "frozen", "deaf": "deaf", "present": "present"}[word], bool(value))
        print(json.dumps(answer), flush=True)
    os._exit(0)


if __name__ == "__main__":
    main()
