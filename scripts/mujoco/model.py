"""The robot of a URDF among the objects of a scene as a MuJoCo model.

Joints, masses and limits are those of the description. Arms collide with their capsules; hands and
fingers with the shapes they are drawn with, since the capsules of the hands enclose the fingers too.
Gravity on the robot is compensated, as a Baxter's springs and firmware do.
"""

import math
import tomllib
import xml.etree.ElementTree as ET

import numpy as np

# Stiffness (N m/rad) and damping (N m s/rad) of the joints' servos by their torque limit.
SERVO = {True: (4000.0, 160.0), False: (500.0, 8.0)}
SERVO_STRONG_NM = 20.0
# Step of the simulation, seconds.
STEP_S = 0.001
# Height of the floor in frame `base`, metres.
FLOOR_M = -0.93
# Forms of bowls: a vertical wall, an ellipse over a foot, or one as sloped as the scene says.
WALLS = ("straight", "round", "cone")
# Sectors of a bowl's wall, and segments from its rim to its foot if it is round.
SECTORS, SEGMENTS = 36, 4
# Share of the height of a round bowl at which its ellipse would close: below is a flat foot.
FOOT = 0.7


def numbers(text, count=3):
    return [float(word) for word in text.split()] if text else [0.0] * count


def words(values):
    return " ".join(f"{value:.9g}" for value in values)


def quaternion(rpy):
    """MuJoCo's w x y z of a URDF's rpy."""
    (sr, cr), (sp, cp), (sy, cy) = ((math.sin(a / 2), math.cos(a / 2)) for a in rpy)
    return [cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy]


def about_z(yaw):
    return [math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)]


def placed(scene):
    """The objects of a scene file's text that have a place, with the defaults of what they leave out."""
    objects = [item for item in tomllib.loads(scene)["objects"] if "xyz" in item]
    for item in objects:
        item.setdefault("yaw", 0.0)
        item.setdefault("wall_deg", 0.0)
        item.setdefault("form", "solid")
        # Objects without a stated mass: plastic and metal things of that size.
        item.setdefault("mass_kg", 0.15)
        item.setdefault("wall", "straight")
    return objects


class Model:
    """Builds the MJCF text. Names of shapes begin with what they belong to: a link of the robot,
    `object/NAME`, or `board/NAME` below that object.

    `urdf` is the text of the description. All `objects` are free to move; bodies that rest sleep, and
    cost nothing until something touches them. `displaced` is the offset (x, y) in metres and the turn in
    radians of one object by its name."""

    def __init__(self, urdf, objects, friction=0.7, mass_share=1.0, displaced=None):
        self.robot = ET.fromstring(urdf)
        self.links = {link.get("name"): link for link in self.robot.findall("link")}
        self.children = {}
        for joint in self.robot.findall("joint"):
            self.children.setdefault(joint.find("parent").get("link"), []).append(joint)
        self.friction, self.mass_share = friction, mass_share
        self.count = 0
        self.root = ET.Element("mujoco", model=self.robot.get("name"))
        option = ET.SubElement(self.root, "option", timestep=str(STEP_S), integrator="implicitfast",
                               cone="elliptic", impratio="20")
        ET.SubElement(option, "flag", sleep="enable")
        ET.SubElement(self.root, "compiler", angle="radian", autolimits="true")
        self.world = ET.SubElement(self.root, "worldbody")
        self.contact = ET.SubElement(self.root, "contact")
        self.equality = ET.SubElement(self.root, "equality")
        self.actuators = ET.SubElement(self.root, "actuator")
        self.sensors = ET.SubElement(self.root, "sensor")
        roots = set(self.links) - {j.find("child").get("link") for j in self.robot.findall("joint")}
        self.link(self.world, roots.pop(), [0.0] * 3, [1.0, 0.0, 0.0, 0.0], None)
        self.floor()
        for item in objects:
            self.object(item, *(displaced or {}).get(item["name"], ((0.0, 0.0), 0.0)))

    def text(self):
        return ET.tostring(self.root, encoding="unicode")

    def name(self, owner):
        self.count += 1
        return f"{owner}#{self.count}"

    def link(self, parent, name, pos, quat, joint):
        body = ET.SubElement(parent, "body", name=name, pos=words(pos), quat=words(quat), gravcomp="1")
        link = self.links[name]
        inertial = link.find("inertial")
        if inertial is not None:
            origin, inertia = inertial.find("origin"), inertial.find("inertia")
            at = numbers(origin.get("xyz") if origin is not None else "")
            full = [float(inertia.get(key)) for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")]
            ET.SubElement(body, "inertial", pos=words(at), mass=inertial.find("mass").get("value"),
                          fullinertia=words(full))
        elif joint is not None and joint.get("type") != "fixed":
            ET.SubElement(body, "inertial", pos="0 0 0", mass="0.001", diaginertia="1e-6 1e-6 1e-6")
        if joint is not None and joint.get("type") != "fixed":
            self.joint(body, joint)
        hand = "gripper" in name or name.endswith(("_hand", "_jaw"))
        for shape in link.findall("visual" if hand else "collision"):
            self.shape(body, name, shape)
        for child in self.children.get(name, []):
            origin = child.find("origin")
            at = numbers(origin.get("xyz") if origin is not None else "")
            rpy = numbers(origin.get("rpy") if origin is not None else "")
            self.link(body, child.find("child").get("link"), at, quaternion(rpy), child)

    def joint(self, body, joint):
        name, limit = joint.get("name"), joint.find("limit")
        slides = joint.get("type") == "prismatic"
        effort = float(limit.get("effort"))
        ET.SubElement(body, "joint", name=name, type="slide" if slides else "hinge",
                      axis=joint.find("axis").get("xyz"), armature="0.05" if slides else "0.1",
                      range=f"{limit.get('lower')} {limit.get('upper')}",
                      damping="2" if slides else "0.5", frictionloss="0" if slides else "0.2")
        mimic = joint.find("mimic")
        if mimic is not None:
            ET.SubElement(self.equality, "joint", joint1=name, joint2=mimic.get("joint"),
                          polycoef=f"0 {mimic.get('multiplier')} 0 0 0", solref="0.002 1")
        elif slides:
            # One motor drives both fingers.
            ET.SubElement(self.actuators, "position", name=name, joint=name, kp="20000", kv="200",
                          forcerange=f"{-2 * effort} {2 * effort}")
        elif effort < 1e3:
            stiffness, damping = SERVO[effort > SERVO_STRONG_NM]
            ET.SubElement(self.actuators, "position", name=name, joint=name, kp=str(stiffness),
                          kv=str(damping), forcerange=f"{-effort} {effort}")

    def shape(self, body, owner, shape):
        origin, geometry = shape.find("origin"), shape.find("geometry")[0]
        at = numbers(origin.get("xyz") if origin is not None else "")
        rpy = numbers(origin.get("rpy") if origin is not None else "")
        size = {"box": lambda g: [s / 2 for s in numbers(g.get("size"))],
                "sphere": lambda g: [float(g.get("radius"))],
                "cylinder": lambda g: [float(g.get("radius")), float(g.get("length")) / 2],
                "capsule": lambda g: [float(g.get("radius")), float(g.get("length")) / 2]}
        # Parts of the robot do not meet each other here: the planner's margins are checked elsewhere.
        ET.SubElement(body, "geom", name=self.name(owner), type=geometry.tag, pos=words(at),
                      quat=words(quaternion(rpy)), size=words(size[geometry.tag](geometry)),
                      contype="1", conaffinity="2", mass="0", condim="4",
                      friction=f"{self.friction} 0.005 0.0001", solref="0.004 1")

    def floor(self):
        """Catches what falls. The robot, bolted to it, does not meet it."""
        ET.SubElement(self.world, "geom", name=self.name("board/floor"), type="plane", size="0 0 1",
                      pos=f"0 0 {FLOOR_M}", contype="1", conaffinity="0")

    def object(self, item, offset, turn):
        name, size = item["name"], item["size"]
        x, y, z = item["xyz"]
        bottom = z - size[2] / 2
        board = [size[0] / 2 + 0.03, size[1] / 2 + 0.03, 0.005]
        self.solid(self.world, f"board/{name}", "box", board, [x, y, bottom - 0.005],
                   about_z(item["yaw"]), 0.0)
        pos = [x + offset[0], y + offset[1], z + 0.0005]
        body = ET.SubElement(self.world, "body", name=f"object/{name}", pos=words(pos),
                             quat=words(about_z(item["yaw"] + turn)))
        ET.SubElement(body, "freejoint", name=f"object/{name}")
        parts = self.bowl(item) if item["form"] == "hollow" else self.tool(item)
        volume = sum(part[3] for part in parts)
        for kind, half, (at, quat), share in parts:
            mass = item["mass_kg"] * self.mass_share * share / volume
            self.solid(body, f"object/{name}", kind, half, at, quat, mass)

    def solid(self, body, owner, kind, half, at, quat, mass):
        ET.SubElement(body, "geom", name=self.name(owner), type=kind, size=words(half), pos=words(at),
                      quat=words(quat), contype="2", conaffinity="3", mass=f"{mass:.9g}",
                      # Friction against rolling, as by the clip of a pen.
                      condim="6" if kind == "cylinder" else "4",
                      friction=f"{self.friction} 0.005 0.0005", solref="0.004 1")

    def tool(self, item):
        """A round rod, a bar, or a bar with wider ends, as the grasp width and the size say."""
        (x, y, z), width = item["size"], item["grasp_width"]
        still = ([0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0])
        if abs(y - z) < 1e-6 and abs(width - y) < 1e-6:
            along = [math.sqrt(0.5), 0.0, math.sqrt(0.5), 0.0]
            return [("cylinder", [y / 2, x / 2], (still[0], along), 1.0)]
        bar = ("box", [x / 2, min(width, y) / 2, z / 2], still, x * width * z)
        if y - width < 1e-4:
            return [bar]
        ends = [("box", [0.1 * x, y / 2, z / 2], ([side * 0.4 * x, 0.0, 0.0], still[1]), 0.2 * x * y * z)
                for side in (-1, 1)]
        return [bar, *ends]

    def bowl(self, item):
        """A wall of boxes round a bottom: straight, or rounded over a foot."""
        (x, _, z), width = item["size"], item["grasp_width"]
        radius = x / 2
        if item["wall"] == "round":
            # An ellipse; its upper part is steep, and a foot cuts off its lower end.
            heights = np.linspace(z / 2, -z / 2 + width, SEGMENTS + 1)
            share = (z / 2 - heights) / z * FOOT
            radii = radius * np.sqrt(1.0 - share ** 2)
        else:
            slope = math.tan(math.radians(item["wall_deg"]))
            heights = np.array([z / 2, -z / 2])
            radii = np.array([radius, radius - slope * z])
        parts = []
        for high, low, out, below in zip(heights, heights[1:], radii, radii[1:]):
            slope = math.atan2(out - below, high - low)
            length = math.hypot(out - below, high - low)
            middle = (out + below) / 2 - width / 2 / math.cos(slope)
            side = middle * math.tan(math.pi / SECTORS) + 0.0005
            for n in range(SECTORS):
                turn = 2 * math.pi * n / SECTORS
                tilt = np.array([math.cos(slope / 2), 0.0, math.sin(slope / 2), 0.0])
                quat = multiply(about_z(turn), tilt)
                at = [middle * math.cos(turn), middle * math.sin(turn), (high + low) / 2]
                parts.append(("box", [width / 2, side, length / 2], (at, quat), width * side * length))
        foot = float(radii[-1]) - width / 2
        at = ([0.0, 0.0, -z / 2 + width / 2], [1.0, 0.0, 0.0, 0.0])
        parts.append(("cylinder", [foot, width / 2], at, math.pi * foot ** 2 * width / 2))
        return parts


def multiply(a, b):
    (aw, ax, ay, az), (bw, bx, by, bz) = a, b
    return [aw * bw - ax * bx - ay * by - az * bz, aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw]
