"""Inverse kinematics by packages of PyPI: a question on standard input, one line of JSON back."""

import json
import os
import sys
import time

question = json.load(sys.stdin)
targets = question["targets"]
budget = question["budget_s"]
runs, left_out = [], []
# Some solvers print; the reply alone goes to where it is read.
reply_to = os.dup(1)
os.dup2(2, 1)


def clocks():
    """Processor time of all threads, and elapsed time, seconds."""
    return time.process_time(), time.perf_counter()


def run(name, solve, nearest=False, random_seed=False, count=None):
    """Answers and microseconds of one solver over the targets: of processor, and elapsed."""
    answers, micros = [], []
    for target in targets[:count]:
        seed = target["random" if random_seed else "middle"]
        start = clocks()
        answer = solve(target, seed)
        micros.append([(now - then) * 1e6 for now, then in zip(clocks(), start)])
        answers.append(None if answer is None else [float(x) for x in answer])
    runs.append(
        dict(name=name, nearest=nearest, random_seed=random_seed, answers=answers, micros=micros)
    )


def of_package(measure):
    """Left out where the package is not there."""
    try:
        measure()
    except ImportError as error:
        left_out.append(f"Without the Python package {error.name}: that row is left out.")


def optik_py():
    import numpy
    import optik

    # From the arm's mount: with the fixed joints before it in the chain its poses are off.
    robots = {
        limb: optik.Robot.from_urdf_file(question["urdf"], f"{limb}_arm_mount", f"{limb}_gripper")
        for limb in ("left", "right")
    }
    from_mount = {limb: numpy.linalg.inv(pose) for limb, pose in question["mounts"].items()}
    for target in targets:
        target["in_mount"] = (from_mount[target["limb"]] @ numpy.array(target["pose"])).tolist()

    def solver(mode):
        config = optik.SolverConfig(solution_mode=mode, max_time=budget, tol_f=1e-10)

        def solve(target, seed):
            found = robots[target["limb"]].ik(config, target["in_mount"], seed)
            return None if found is None else found[0]

        return solve

    for robot in robots.values():
        robot.set_parallelism(1)
    run("OptIK 0.5 (optik-py), one thread, 5 ms", solver("speed"))
    for random_seed in (False, True):
        name = "OptIK 0.5 Quality (optik-py), one thread, 5 ms"
        run(name, solver("quality"), nearest=True, random_seed=random_seed)


def trac_ik():
    import pytracik

    with open(question["urdf"], encoding="utf-8") as file:
        urdf = file.read()

    def solver(kind):
        robots = {
            limb: pytracik.TRAC_IK("base", f"{limb}_gripper", urdf, budget, 1e-5, kind)
            for limb in ("left", "right")
        }

        def solve(target, seed):
            found = pytracik.ik(robots[target["limb"]], seed, *target["xyz"], *target["xyzw"])
            # How it ended, then the joints.
            return found[1:] if len(found) == 8 and found[0] >= 0 else None

        return solve

    name = "TRAC-IK Speed (pytracik), two threads, 5 ms"
    run(name, solver(pytracik.SolveType.Speed))
    for random_seed in (False, True):
        name = "TRAC-IK Distance (pytracik), two threads, 5 ms"
        kind = solver(pytracik.SolveType.Distance)
        run(name, kind, nearest=True, random_seed=random_seed)


def ikpy():
    import numpy
    from ikpy.chain import Chain

    # Joints in turn with the links that they carry, from the base to the gripper.
    way = (
        "s0 upper_shoulder s1 lower_shoulder e0 upper_elbow e1 lower_elbow w0 upper_forearm "
        "w1 lower_forearm w2 wrist hand hand gripper_base gripper_base endpoint gripper"
    ).split()
    chains = {}
    for limb in ("left", "right"):
        elements = ["base", "torso_t0", "torso", f"{limb}_torso_arm_mount", f"{limb}_arm_mount"]
        elements += [f"{limb}_{element}" for element in way]
        found = Chain.from_urdf_file(question["urdf"], base_elements=elements)
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
    """Forward kinematics of the left arm, less the same calls for a robot without joints."""
    import numpy
    import pinocchio as pin

    whole = pin.buildModelFromUrdf(question["urdf"])
    names = [f"left_{joint}" for joint in ("s0", "s1", "e0", "e1", "w0", "w1", "w2")]
    others = [i for i in range(1, whole.njoints) if whole.names[i] not in names]
    arm = pin.buildReducedModel(whole, others, pin.neutral(whole))
    empty = pin.buildReducedModel(whole, list(range(1, whole.njoints)), pin.neutral(whole))
    postures = [numpy.array(q) for q in question["postures"]]

    def calls(model):
        data, tip = model.createData(), model.getFrameId("left_gripper")
        frame = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        return data, (
            lambda q: pin.framesForwardKinematics(model, data, q),
            lambda q: pin.computeFrameJacobian(model, data, q, tip, frame),
        )

    def nanos(call, postures):
        start = time.process_time()
        for q in postures:
            call(q)
        return (time.process_time() - start) * 1e9 / len(postures)

    (data, of_arm), (_, of_empty) = calls(arm), calls(empty)
    nothing = [numpy.zeros(0)] * len(postures)
    tip, places = arm.getFrameId("left_gripper"), []
    for q in postures:
        of_arm[0](q)
        places.append(data.oMf[tip].translation.tolist())
    samples = [
        [nanos(call, postures) - nanos(way, nothing) for _ in range(question["samples"])]
        for call, way in zip(of_arm, of_empty)
    ]
    forward.append(dict(pose_ns=samples[0], jacobian_ns=samples[1], places=places))


forward = []
for package in (optik_py, trac_ik, ikpy, pinocchio):
    of_package(package)
sys.stdout.flush()
with os.fdopen(reply_to, "w") as reply:
    reply.write("\n" + json.dumps(dict(runs=runs, left_out=left_out, forward=forward)) + "\n")
