"""A Baxter in the physics engine MuJoCo behind the robot's own topics: the service `baxter` of the profile
`mujoco`. docs/physics.md describes it.

It runs in real time. Where the machine is too slow for that, the stamps of its joint states show it: they
are the time up to which it was simulated, so the arm halts as it does when a robot falls silent.
"""

import argparse
import hashlib
import json
import os
import random
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "shared/sdk/python")]

import mujoco
import numpy as np

from hand import named
from limb import JOINTS
from model import WALLS, placed
from whichone import messages as m
from whichone.service import Service
from world import BEAT_S, LIMBS, World

BEAT_NS = round(BEAT_S * 1e9)
# Simulated time that may be missing before it is left out, nanoseconds.
BEHIND_MAX_NS = 500_000_000
# Most beats between two reports of the joints.
BEATS_MAX = 20
# Reports between two states of a gripper, and between two of its properties.
GRIPPER_EVERY, PROPERTIES_EVERY = 2, 100
# Time between two records of the world, seconds: of the clock, as a machine that stands still makes few reports.
REMEMBER_EVERY_S = 0.2
# Deviation of measured velocities over that of positions, 1/s: they come from differences.
VELOCITY_NOISE = 25.0
UNPRESSED, PRESSED, _, RELEASED = range(4)
ELECTRIC, GRIPPER_ID = 2, 65664
BROKEN, CONFIG = 70, 78


def log(text):
    print(text, file=sys.stderr, flush=True)


class Robot(Service):
    """The service: topics on one side, the world on the other."""

    name = "baxter"

    def __init__(self, conditions):
        super().__init__()
        settings, bus = self.settings, self.bus
        self.arm = settings["arm"]
        self.records = open(self.group.folder / "log" / "physics.jsonl", "a", encoding="utf-8")
        if "robot_srdf" not in settings:
            raise ValueError("the robot has no .srdf beside its .urdf; help: it names the groups and the "
                             "neutral posture")
        urdf, srdf = (settings[key]["text"] for key in ("robot_urdf", "robot_srdf"))
        objects = placed(settings["scene"]["text"])
        unknown = conditions.displaced.keys() - {item["name"] for item in objects}
        if unknown:
            raise ValueError(f"--displace: the scene has no {', '.join(sorted(unknown))} with a place")
        for item in objects:
            item["wall"] = conditions.walls
        self.world = World(urdf, srdf, objects, self.arm, self.report_pick, conditions)
        self.file = self.group.folder / "physics.json"
        # The world goes on where it was if it is the same one.
        key = hashlib.sha256(self.world.text.encode()).hexdigest()
        self.key = [bus.epoch, key]
        self.remember()
        self.chance = random.Random(self.arm["simulated"]["seed"] + bus.incarnation)
        self.frame = {limb: named(self.world.model, mujoco.mjtObj.mjOBJ_BODY, f"{limb}_gripper")
                      for limb in LIMBS}
        # Joint states with the names of their joints, by these.
        self.named = {}
        self.drilled, self.warned, self.recorded = [], 0.0, 0.0
        self.open()

    def open(self):
        self.drills = self.reader("robot/drill")
        self.joints, self.state = self.writer("robot/joint_states"), self.writer("robot/state")
        self.commands, self.feeds, self.ratios, self.fingers = {}, {}, {}, {}
        self.endpoints, self.grippers, self.properties = {}, {}, {}
        for limb in LIMBS:
            own, hand = f"robot/limb/{limb}", f"robot/end_effector/{limb}_gripper"
            self.commands[limb] = self.reader(f"{own}/joint_command")
            self.feeds[limb] = self.reader(f"{own}/inverse_dynamics_command")
            self.ratios[limb] = self.reader(f"{own}/set_speed_ratio")
            self.fingers[limb] = self.reader(f"{hand}/command")
            self.endpoints[limb] = self.writer(f"{own}/endpoint_state")
            self.grippers[limb] = self.writer(f"{hand}/state")
            self.properties[limb] = self.writer(f"{hand}/properties")

    def remember(self):
        try:
            key, remembered = json.loads(self.file.read_text(encoding="utf-8"))
        except FileNotFoundError:
            return
        except ValueError as error:
            return log(f"{self.file}: {error}; the world begins as the scene has it")
        if key == self.key:
            self.world.remember(remembered)
            log("the world goes on where it was")

    def record(self):
        """Keeps the world for the process that comes after this one."""
        part = self.file.with_suffix(".part")
        part.write_text(json.dumps([self.key, self.world.remembered()]), encoding="utf-8")
        os.replace(part, self.file)
        self.recorded = time.monotonic()

    def report_pick(self, record):
        """Writes the record of a pick for whoever judges it."""
        text = json.dumps(record | {"t_ns": time.monotonic_ns()})
        print(text, file=self.records, flush=True)
        log(text)

    def drain(self):
        """Takes the messages that have arrived."""
        for drill in self.drills:
            if drill.key not in self.drilled:
                self.drilled = [*self.drilled[-31:], drill.key]
                log(f"drill {drill.kind}, amount {drill.amount:g}")
                self.world.drill(drill.kind, drill.amount)
        # What is switched off obeys nothing.
        obeys = self.world.assembly.enabled
        for limb in LIMBS:
            joints, hand = self.world.limbs[limb], self.world.hands[limb]
            for ratio in self.ratios[limb]:
                if obeys:
                    joints.set_speed_ratio(ratio.data)
            for message in self.commands[limb]:
                if obeys:
                    names = map(str, message.names[:message.len])
                    self.attempt(joints.command, message.mode, list(zip(names, message.command)))
            for point in self.feeds[limb]:
                if obeys:
                    joints.feed_forward(point.velocities)
            for message in self.fingers[limb]:
                if obeys:
                    words = (str(message.command), str(message.args), str(message.sender))
                    self.attempt(hand.command, *words, message.sequence)

    @staticmethod
    def attempt(command, *arguments):
        try:
            command(*arguments)
        except (ValueError, KeyError, TypeError) as error:
            log(f"a command that makes no sense is ignored: {error!r}")

    def publish(self, count, stamp):
        """Everything that is due in report number `count`; `stamp` is the time up to which the robot was
        simulated."""
        self.state.send(self.assembly())
        simulated = self.arm["simulated"]
        if self.world.silent_s <= 0.0 and self.chance.random() >= simulated["loss"]:
            for state in self.joint_states(stamp, simulated["noise_rad"]):
                self.joints.send(state, wake=False)
            self.joints.wake()
        for limb in LIMBS:
            self.endpoints[limb].send(self.endpoint(limb, stamp))
            if count % GRIPPER_EVERY == 0:
                self.grippers[limb].send(self.gripper(limb, stamp))
            if count % PROPERTIES_EVERY == 0:
                self.properties[limb].send(self.properties_of(limb))
        if time.monotonic() - self.recorded >= REMEMBER_EVERY_S:
            self.record()

    def assembly(self):
        own = self.world.assembly
        button = PRESSED if own.pressed else RELEASED if own.stopped else UNPRESSED
        return m.AssemblyState(
            ready=own.enabled, enabled=own.enabled, stopped=own.stopped, error=own.error,
            estop_button=button, estop_source=own.stopped)

    def joint_states(self, stamp, noise):
        """The 17 joints, and the joint of one finger of each gripper in a message of its own."""
        measured = dict.fromkeys(("head_nod", "head_pan", "torso_t0"), (0.0, 0.0, 0.0))
        normal = lambda: noise and self.chance.gauss(0.0, noise)
        for joints in self.world.limbs.values():
            for name, q, qd, effort in zip(joints.names, joints.q, joints.qd, joints.effort):
                measured[name] = (q + normal(), qd + VELOCITY_NOISE * normal(), effort)
        yield self.joint_state(stamp, dict(sorted(measured.items())))
        for limb, hand in self.world.hands.items():
            finger = f"{limb[0]}_gripper_l_finger_joint"
            yield self.joint_state(stamp, {finger: (hand.travel, 0.0, hand.force())})

    def joint_state(self, stamp, measured):
        names = tuple(measured)
        if names not in self.named:
            self.named[names] = state = m.JointState(len=len(names))
            for n, name in enumerate(names):
                state.name[n].set(name)
        state, count = self.named[names], len(names)
        state.stamp_ns = stamp
        state.position[:count], state.velocity[:count], state.effort[:count] = zip(*measured.values())
        return state

    def endpoint(self, limb, stamp):
        """Pose and velocity of the gripper's tip; forces are not measured."""
        data, body = self.world.data, self.frame[limb]
        state = m.EndpointState(stamp_ns=stamp)
        w, *xyz = data.xquat[body]
        state.pose[:] = [*data.xpos[body], *xyz, w]
        twist = np.zeros(6)
        mujoco.mj_objectVelocity(self.world.model, data, mujoco.mjtObj.mjOBJ_XBODY, body, twist, 0)
        state.twist[:] = [*twist[3:], *twist[:3]]
        return state

    def gripper(self, limb, stamp):
        hand = self.world.hands[limb]
        word, sender, sequence = hand.handled
        moving = bool(hand.goals)
        state = m.EndEffectorState(
            timestamp_ns=stamp, id=GRIPPER_ID, enabled=self.world.assembly.enabled,
            calibrated=hand.calibrated, ready=hand.calibrated and not moving, moving=moving,
            gripping=hand.gripping, missed=hand.missed, position=hand.percent(),
            force=100.0 * hand.force() / hand.strongest, command_sequence=sequence)
        state.command.set(word)
        state.command_sender.set(sender)
        return state

    def properties_of(self, limb):
        properties = m.EndEffectorProperties(
            id=GRIPPER_ID, ui_type=ELECTRIC, has_calibration=1, controls_grip=1, senses_grip=1,
            controls_force=1, senses_force=1, controls_position=1, senses_position=1)
        properties.manufacturer.set("whichone")
        properties.product.set("electric gripper in MuJoCo")
        properties.serial_number.set(limb)
        return properties

    def catch_up(self, at):
        """Simulates from the time `at` towards now, and returns how far it came. What is further behind
        than half a second is left out: the robot stood still meanwhile."""
        now = time.monotonic_ns()
        behind = now - at - BEHIND_MAX_NS
        if behind > 0:
            at += behind
            if time.monotonic() - self.warned > 5.0:
                self.warned = time.monotonic()
                log(f"this machine is too slow for the physics: {behind / 1e9:.2f} s were left out, "
                    "and the arm halts; help: close other programs")
        for _ in range(min((now - at) // BEAT_NS, BEATS_MAX)):
            self.drain()
            self.world.advance()
            at += BEAT_NS
        return at

    def serve(self):
        """Runs until it is asked to shut down; returns the exit code."""
        at, count = time.monotonic_ns(), 0
        self.supervised.say("READY=1")
        while not self.ends:
            before, at = at, self.catch_up(at)
            if not self.world.is_sound():
                log("the simulation has diverged; it starts again from its last record")
                return BROKEN
            if at > before:
                self.publish(count, at)
                count += 1
            self.beat()
            time.sleep(max(0.0, (at + BEAT_NS - time.monotonic_ns()) / 1e9))
        self.record()
        self.supervised.say("STOPPING=1")
        return 0


class Displaced(argparse.Action):
    """Collects `--displace NAME X Y`."""

    def __call__(self, _, namespace, values, __=None):
        name, x, y = values
        namespace.displaced[name] = ([float(x), float(y)], 0.0)


def conditions():
    """What differs from the scene's description, for tests of grasps that fail."""
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--friction", type=float, default=0.7, help="of everything on everything: 0.7")
    parser.add_argument("--mass-share", type=float, default=1.0, metavar="SHARE",
                        help="mass of the objects as a multiple of what the scene says")
    parser.add_argument("--walls", choices=WALLS, default=WALLS[0], help="of bowls: straight")
    parser.add_argument("--displace", nargs=3, action=Displaced, metavar=("NAME", "X", "Y"),
                        help="an object stands so many metres beside its place; may be repeated")
    parser.set_defaults(displaced={})
    return parser.parse_args()


def main():
    chosen = conditions()
    try:
        robot = Robot(chosen)
    except (ValueError, KeyError) as error:
        log(f"the robot or the scene cannot be simulated: {error}")
        return CONFIG
    return robot.serve()


if __name__ == "__main__":
    sys.exit(main())
