"""Carries out planned picks in MuJoCo, and random trials with misplaced objects.

    scripts/physics accept                   # every object of the shipped scenes
    scripts/physics trials --count 480       # random trials; the seed is printed
"""

import argparse
import json
import math
import os
import random
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import mujoco
import numpy as np

from hand import Hand, named
from jaw import JawHand, exclude, is_jawed
from limb import JOINTS
from model import Model, placed

ROOT = Path(__file__).resolve().parents[2]
# The scenes of each robot.
SCENES = {"baxter": ("bowls", "markers", "tools"), "so101": ("so101-blocks",)}
# Interval of the commands, as the driver sends them, and steps of the simulation in between.
HZ, STEPS = 100, 10
# Limits of the acceptance.
ERROR_RAD, TORQUE_SHARE = 0.01, 0.8
PLACE_M = 0.002
# A jaw pushes the object to the fixed finger, and presses from one side.
JAW_PLACE_M = 0.004
# A trial with misplaced objects may end this far from the plan; it is held and handed over then.
TRIAL_M = 0.02
# Slope that a scene states for each form of bowls: a round wall's chord over the depth of the fingers.
WALL_DEG = {"straight": 0.0, "round": 7.0, "cone": 25.0}


def scene(name):
    return placed((ROOT / f"config/scenes/{name}.toml").read_text(encoding="utf-8"))


def is_bowl(item):
    return item["form"] == "hollow"


def with_walls(name, wall_deg, folder):
    """A copy of the scene whose bowls have walls of this slope."""
    text = (ROOT / f"config/scenes/{name}.toml").read_text(encoding="utf-8")
    path = Path(folder) / f"{name}_{wall_deg:g}.toml"
    path.write_text(text.replace("\nmass_kg", f"\nwall_deg = {wall_deg}\nmass_kg"), encoding="utf-8")
    return str(path)


def plan(whichone, name, target, robot="baxter"):
    words = [whichone, "arm", "plot", "--json", "--samples-hz", str(HZ), "--scene", name,
             "--object", target]
    # The profile of another robot has its name.
    words += [] if robot == "baxter" else ["--profile", robot]
    ended = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
    if ended.returncode:
        raise SystemExit(f"{name}/{target}: {ended.stderr.strip()}")
    return json.loads(ended.stdout)


def pose(data, body):
    return data.xpos[body].copy(), data.xmat[body].reshape(3, 3).copy()


class Run:
    """One pick."""

    def __init__(self, plan, objects, robot="baxter", **conditions):
        self.plan, self.limb = plan, plan["limb"]
        target = plan["object"]
        urdf = ROOT / f"config/robots/{robot}.urdf"
        built = Model(urdf.read_text(encoding="utf-8"), objects, **conditions)
        self.is_jawed = is_jawed(built.robot)
        if self.is_jawed:
            exclude(built, f"object/{target}")
        self.model = mujoco.MjModel.from_xml_string(built.text())
        self.data = mujoco.MjData(self.model)
        self.target = f"object/{target}"
        self.arm = [named(self.model, mujoco.mjtObj.mjOBJ_ACTUATOR, name) for name in plan["joints"]]
        self.joints = [self.model.jnt_qposadr[self.model.actuator_trnid[a, 0]] for a in self.arm]
        if self.is_jawed:
            self.hand = JawHand(self.model, self.data)
        else:
            self.hands = {limb: Hand(self.model, self.data, limb) for limb in ("left", "right")}
            self.hand = self.hands[self.limb]
            # As the arm sets it before the fingers first move.
            self.hand.configure(100.0)
        self.body = named(self.model, mujoco.mjtObj.mjOBJ_BODY, self.target)
        self.gripper = named(self.model, mujoco.mjtObj.mjOBJ_BODY, f"{self.limb}_gripper")
        self.ratio = [self.model.actuator_biasprm[a, 2] / self.model.actuator_biasprm[a, 1]
                      for a in self.arm]
        names = [mujoco.mj_id2name(self.model, mujoco.mjtObj.mjOBJ_GEOM, g) or ""
                 for g in range(self.model.ngeom)]
        self.owner = [name.split("#")[0] for name in names]
        self.stray, self.error, self.torque, self.is_released = {}, 0.0, 0.0, False
        self.forces = np.zeros(6)

    def begin(self):
        model, data = self.model, self.data
        first = self.plan["samples"][0]
        if self.is_jawed:
            data.qpos[self.joints] = data.ctrl[self.arm] = first["q"]
            self.hand.begin(first["width_m"])
            return mujoco.mj_forward(model, data)
        # The other arm rests with the joints of this one.
        for side, hand in self.hands.items():
            for joint, q in zip(JOINTS, first["q"]):
                actuator = named(model, mujoco.mjtObj.mjOBJ_ACTUATOR, f"{side}_{joint}")
                at = model.jnt_qposadr[model.actuator_trnid[actuator, 0]]
                data.qpos[at] = data.ctrl[actuator] = q
            data.qpos[hand.at], data.qpos[hand.other] = hand.open_travel, -hand.open_travel
            data.ctrl[hand.motor] = hand.open_travel
        mujoco.mj_forward(model, data)

    def command(self, sample, closing):
        # Once closed on the object, the fingers press.
        if self.is_jawed:
            self.hand.command(sample["width_m"], closing)
        else:
            self.command_fingers(sample, closing)
        for actuator, q, qd, ratio in zip(self.arm, sample["q"], sample["qd"], self.ratio):
            self.data.ctrl[actuator] = q + ratio * qd

    def command_fingers(self, sample, closing):
        travel = 0.0 if closing else (sample["width_m"] - self.hand.stop_m) / 2
        self.data.ctrl[self.hand.motor] = min(max(travel, 0.0), self.hand.open_travel)

    def step(self):
        for _ in range(STEPS):
            mujoco.mj_step(self.model, self.data)
            limits = self.model.actuator_forcerange[self.arm, 1]
            share = np.abs(self.data.actuator_force[self.arm]) / limits
            self.torque = max(self.torque, float(share.max()))
            self.touches()

    def touches(self):
        """Notes contacts of the robot, and of the object with others, that no pick should have."""
        for n, contact in enumerate(self.data.contact[:self.data.ncon]):
            a, b = (self.owner[g] for g in contact.geom)
            if a.startswith(("object/", "board/")):
                a, b = b, a
            kinds = {owner.split("/")[0] for owner in (a, b)}
            has_target = self.target in (a, b)
            if kinds <= {"board", "object"} and (kinds != {"object"} or not has_target):
                continue
            is_tip = self.hand.is_tip(a) if self.is_jawed else "finger_tip" in a
            if is_tip and b == self.target:
                continue
            # What is let go falls, here without a person who takes it.
            if kinds == {"object"} and self.is_released:
                continue
            mujoco.mj_contactForce(self.model, self.data, n, self.forces)
            if self.forces[0] > 0.0:
                key = f"{a} - {b}"
                self.stray[key] = max(self.stray.get(key, 0.0), float(self.forces[0]))

    def run(self):
        self.begin()
        stages = {stage["phase"]: stage for stage in self.plan["stages"]}
        closes, closed = stages["close"]["begin_s"], stages["close"]["end_s"]
        releases = stages["release"]["begin_s"]
        planned = self.plan["object_in_gripper"]
        off_m, tilt = math.inf, 0.0
        for sample in self.plan["samples"]:
            t = sample["t_s"]
            if t >= releases and off_m == math.inf:
                off_m, tilt = self.deviation(planned)
                height, self.is_released = self.data.xpos[self.body][2], True
            self.command(sample, closes <= t < releases and t >= closed - 0.15 or sample["held"])
            q = self.data.qpos[self.joints]
            self.error = max(self.error, float(np.abs(q - np.array(sample["q"])).max()))
            self.step()
        fell_m = height - self.data.xpos[self.body][2]
        return {"object": self.plan["object"], "limb": self.limb, "seconds": self.plan["seconds"],
                "error_rad": self.error, "torque": self.torque, "off_mm": 1e3 * off_m,
                "tilt_deg": math.degrees(tilt), "released": bool(fell_m > 0.05), "stray": self.stray}

    def deviation(self, planned):
        """Distance of the object from its planned place in the gripper, and its tilt."""
        at, turned = pose(self.data, self.gripper)
        place, upright = pose(self.data, self.body)
        expected = at + turned @ np.array(planned[:3])
        rotation = np.zeros(9)
        mujoco.mju_quat2Mat(rotation, np.array([planned[6], *planned[3:6]]))
        up = (turned @ rotation.reshape(3, 3))[:, 2]
        return float(np.linalg.norm(place - expected)), float(
            math.acos(max(-1.0, min(1.0, up @ upright[:, 2]))))


def problems(result, place_m):
    """What of a pick is not as it has to be."""
    found = [f"{pair} ({force:.1f} N)" for pair, force in result["stray"].items()]
    if result["error_rad"] > ERROR_RAD:
        found.append(f"tracking error {result['error_rad']:.4f} rad")
    if result["torque"] > TORQUE_SHARE:
        found.append(f"torque {100 * result['torque']:.0f} %")
    if result["off_mm"] > 1e3 * place_m:
        found.append(f"{result['off_mm']:.1f} mm off its planned place")
    if not result["released"]:
        found.append("not released")
    return found


def line(result, found):
    verdict = "ok" if not found else "FAILED: " + "; ".join(found)
    return (f"{result['object']:10} {result['limb']:5} {result['seconds']:5.1f} s  "
            f"error {result['error_rad']:.4f} rad  torque {100 * result['torque']:3.0f} %  "
            f"off {result['off_mm']:5.2f} mm  tilt {result['tilt_deg']:4.1f} deg  {verdict}")


def accept(arguments):
    """Every object of the shipped scenes, undisturbed."""
    good = total = 0
    robot = arguments.robot
    for name in SCENES[robot]:
        objects = scene(name)
        for item in objects:
            if arguments.object not in (None, item["name"]):
                continue
            planned = plan(arguments.whichone, name, item["name"], robot)
            result = Run(planned, objects, robot).run()
            found = problems(result, JAW_PLACE_M if robot == "so101" else PLACE_M)
            print(line(result, found), flush=True)
            good, total = good + (not found), total + 1
    print(f"{good} of {total} picks as planned")
    return good == total


def trial(job):
    """One pick under random conditions."""
    plan, objects, form, seed = job
    draw = random.Random(seed)
    slope = WALL_DEG[form]
    objects = [dict(item, wall=form, wall_deg=slope) if is_bowl(item) else item for item in objects]
    item = next(item for item in objects if item["name"] == plan["object"])
    distance, angle = draw.uniform(0.0, 0.01), draw.uniform(-math.pi, math.pi)
    offset = (distance * math.cos(angle), distance * math.sin(angle))
    yaw = draw.uniform(-math.pi, math.pi) if is_bowl(item) else math.radians(draw.uniform(-10, 10))
    friction, mass = draw.uniform(0.4, 1.0), draw.uniform(0.5, 1.5)
    displaced = {item["name"]: (offset, yaw)}
    run = Run(plan, objects, friction=friction, mass_share=mass, displaced=displaced)
    result = run.run()
    held = result["off_mm"] < 1e3 * TRIAL_M and result["released"]
    stray = [pair for pair in result["stray"] if not pair.startswith("object/")]
    return form if is_bowl(item) else "tool", held, result, stray


def trials(arguments):
    """Random placement errors, friction and mass."""
    print(f"seed {arguments.seed}")
    kinds = []
    with tempfile.TemporaryDirectory() as folder:
        for name in SCENES["baxter"]:
            objects = scene(name)
            for item in objects:
                for form in arguments.walls if is_bowl(item) else ["straight"]:
                    file = with_walls(name, WALL_DEG[form], folder) if is_bowl(item) else name
                    kinds.append((plan(arguments.whichone, file, item["name"]), objects, form))
    jobs = [(*kinds[n % len(kinds)], arguments.seed * 1_000_003 + n) for n in range(arguments.count)]
    tally = {}
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        for kind, held, result, stray in pool.map(trial, jobs):
            good, total, worst = tally.get(kind, (0, 0, 0.0))
            worst = max(worst, result["off_mm"]) if held else worst
            tally[kind] = (good + held, total + 1, worst)
            if not held:
                print(f"{kind} {result['object']}: off {result['off_mm']:.1f} mm, "
                      f"released {result['released']}, {stray}", flush=True)
    for kind, (good, total, worst) in sorted(tally.items()):
        print(f"{kind:9} {good} of {total} delivered, at most {worst:.1f} mm off")
    good, total = (sum(column) for column in list(zip(*tally.values()))[:2])
    print(f"{good} of {total} delivered")
    return good >= 0.979 * total


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--whichone", default=str(ROOT / "target/release/whichone"))
    verbs = parser.add_subparsers(dest="verb", required=True)
    shipped = verbs.add_parser("accept", help=accept.__doc__)
    shipped.add_argument("--object", metavar="NAME", help="this one alone")
    shipped.add_argument("--robot", choices=SCENES, default="baxter")
    random_trials = verbs.add_parser("trials", help=trials.__doc__)
    random_trials.add_argument("--count", type=int, default=480)
    random_trials.add_argument("--seed", type=int, default=1)
    random_trials.add_argument("--walls", nargs="+", choices=WALL_DEG, default=["straight", "round"])
    arguments = parser.parse_args()
    passed = {"accept": accept, "trials": trials}[arguments.verb](arguments)
    sys.exit(0 if passed else 1)


if __name__ == "__main__":
    main()
