"""Kinematics by a package of PyPI: `peers.py PEER`, a question on standard input, one line of JSON back."""

import json
import os
import sys
import time
from tempfile import NamedTemporaryFile
from xml.etree import ElementTree

question = json.load(sys.stdin)
limbs, targets, budget = question["limbs"], question["targets"], question["budget_s"]
runs, forward = [], []
# Some solvers print; the reply alone goes to where it is read.
reply_to = os.dup(1)
os.dup2(2, 1)


def run(name, solve, kind="reachable", seed="middle", nearest=False, count=None):
    """Answers and microseconds of one solver over targets: of processor of all threads, and elapsed."""
    answers, micros = [], []
    for target in targets[kind][:count]:
        start = time.process_time(), time.perf_counter()
        answer = solve(target, target[seed])
        ends = time.process_time(), time.perf_counter()
        micros.append([(end - begin) * 1e6 for end, begin in zip(ends, start)])
        answers.append(None if answer is None else [float(x) for x in answer])
    runs.append(dict(name=name, kind=kind, seed=seed, nearest=nearest, answers=answers, micros=micros))


def run_all(name, modes, solver):
    """Any answer, the nearest one, and answers where some poses are out of reach; `name` takes the mode."""
    first, nearest = (solver(kind) for kind in modes.values())
    any_name, nearest_name = (name.format(mode) for mode in modes)
    run(any_name, first)
    for seed in ("middle", "random"):
        run(nearest_name, nearest, seed=seed, nearest=True)
    run(any_name, first, kind="anywhere")


def description(limb):
    """The shipped description without all that is not on the way to the limb's gripper, without shapes, and
    with a name of its own for each joint, for some packages mix up joints and links of one name."""
    whole = ElementTree.parse(question["urdf"]).getroot()
    carriers = {joint.find("child").get("link"): joint for joint in whole.iter("joint")}
    alone, link = ElementTree.Element("robot", name=limb), limbs[limb]["tip"]
    ElementTree.SubElement(alone, "link", name=link)
    while link in carriers:
        joint = carriers[link]
        joint.set("name", "to_" + link)
        alone.append(joint)
        link = joint.find("parent").get("link")
        ElementTree.SubElement(alone, "link", name=link)
    return ElementTree.tostring(alone, encoding="unicode")


def in_file(text):
    with NamedTemporaryFile("w", suffix=".urdf", delete=False) as file:
        file.write(text)
    return file.name


def optik():
    import numpy
    import optik

    # From the first joint to what the last one moves: it puts fixed joints together in the wrong order.
    robots, from_mount, from_tip = {}, {}, {}
    for limb, ends in limbs.items():
        file = in_file(description(limb))
        robots[limb] = optik.Robot.from_urdf_file(file, ends["mount"], ends["last"])
        robots[limb].set_parallelism(1)
        os.unlink(file)
        from_mount[limb] = numpy.linalg.inv(ends["mount_pose"])
        from_tip[limb] = numpy.linalg.inv(ends["tip_on_last"])
    for target in targets["reachable"] + targets["anywhere"]:
        limb = target["limb"]
        pose = from_mount[limb] @ numpy.array(target["pose"]) @ from_tip[limb]
        target["of_last"] = pose.tolist()

    def solver(mode):
        config = optik.SolverConfig(solution_mode=mode, max_time=budget, tol_f=1e-10)

        def solve(target, seed):
            found = robots[target["limb"]].ik(config, target["of_last"], seed)
            return None if found is None else found[0]

        return solve

    modes = {"": "speed", " Quality": "quality"}
    run_all("OptIK 0.5{} (optik-py), one thread, 5 ms", modes, solver)


def trac_ik():
    import pytracik

    def solver(kind):
        robots = {
            limb: pytracik.TRAC_IK(question["base"], ends["tip"], description(limb), budget, 1e-5, kind)
            for limb, ends in limbs.items()
        }

        def solve(target, seed):
            found = pytracik.ik(robots[target["limb"]], seed, *target["xyz"], *target["xyzw"])
            # How it ended, then the joints.
            return found[1:] if len(found) == 1 + len(seed) and found[0] >= 0 else None

        return solve

    modes = {"Speed": pytracik.SolveType.Speed, "Distance": pytracik.SolveType.Distance}
    run_all("TRAC-IK {} (pytracik), two threads, 5 ms", modes, solver)


def ikpy():
    import warnings

    import numpy
    from ikpy.chain import Chain

    warnings.simplefilter("ignore")
    chains = {}
    for limb in limbs:
        file = in_file(description(limb))
        found = Chain.from_urdf_file(file, base_elements=[question["base"]])
        os.unlink(file)
        places = [i for i, link in enumerate(found.links) if link.joint_type == "revolute"]
        mask = [i in places for i in range(len(found.links))]
        chains[limb] = (Chain(found.links, active_links_mask=mask), places)

    def solve(target, seed):
        chain, places = chains[target["limb"]]
        start = numpy.zeros(len(chain.links))
        start[places] = seed
        pose = numpy.array(target["pose"])
        return chain.inverse_kinematics_frame(pose, start, orientation_mode="all")[places]

    run("ikpy 4.2, one call", solve, count=question["slow"])


def pinocchio():
    """Forward kinematics of a limb, less the same calls for a robot without joints."""
    import numpy
    import pinocchio as pin

    asked = question["forward"]
    limb, postures = asked["limb"], [numpy.array(q) for q in asked["postures"]]

    def calls(model, tip):
        data, axes = model.createData(), pin.ReferenceFrame.LOCAL_WORLD_ALIGNED

        def pose(q):
            pin.forwardKinematics(model, data, q)
            return pin.updateFramePlacement(model, data, tip)

        return pose, lambda q: pin.computeFrameJacobian(model, data, q, tip, axes)

    def nanos(call, postures):
        start = time.process_time()
        for q in postures:
            call(q)
        return (time.process_time() - start) * 1e9 / len(postures)

    arm = pin.buildModelFromXML(description(limb))
    of_arm = calls(arm, arm.getFrameId(limbs[limb]["tip"], pin.FrameType.BODY))
    of_empty = calls(pin.Model(), 0)
    nothing = [numpy.zeros(0)] * len(postures)
    samples = [
        [nanos(call, postures) - nanos(way, nothing) for _ in range(asked["samples"])]
        for call, way in zip(of_arm, of_empty)
    ]
    places = [of_arm[0](q).translation.tolist() for q in postures]
    forward.append(dict(pose_ns=samples[0], jacobian_ns=samples[1], places=places))


dict(optik=optik, trac_ik=trac_ik, ikpy=ikpy, pinocchio=pinocchio)[sys.argv[1]]()
sys.stdout.flush()
with os.fdopen(reply_to, "w") as reply:
    reply.write("\n" + json.dumps(dict(runs=runs, forward=forward)) + "\n")
