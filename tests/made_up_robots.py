"""Makes humanoids as different as published ones are: made_up_robots.py FOLDER [NAME...]

Sizes of 0.3 to 1.2 of a human of 1.8 m, hips of every order and tilted, soles of boxes, spheres,
cylinders and meshes (STL in both forms, OBJ, COLLADA, in collisions or only in visuals), IMUs in
pelvis and chest or nowhere, and the oddities of descriptions on the net: joints that mimic, drives
without effort, a floating world, a pelvis that looks elsewhere, links with axes of their own, toes,
inertias that no body has, names that say nothing, a root that is the chest, joints without limits,
feet without shapes.
"""
import argparse
import math
import pathlib
import struct


def multiply(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def transpose(a):
    return [list(row) for row in zip(*a)]


def turn(a, v):
    return [sum(a[i][k] * v[k] for k in range(3)) for i in range(3)]


def from_rpy(roll, pitch, yaw):
    c, s = math.cos, math.sin
    x = [[1, 0, 0], [0, c(roll), -s(roll)], [0, s(roll), c(roll)]]
    y = [[c(pitch), 0, s(pitch)], [0, 1, 0], [-s(pitch), 0, c(pitch)]]
    z = [[c(yaw), -s(yaw), 0], [s(yaw), c(yaw), 0], [0, 0, 1]]
    return multiply(z, multiply(y, x))


def to_rpy(r):
    return [math.atan2(r[2][1], r[2][2]), math.atan2(-r[2][0], math.hypot(r[0][0], r[1][0])),
            math.atan2(r[1][0], r[0][0])]


def text(numbers):
    return " ".join(f"{x:.9g}" for x in numbers)


ONE = from_rpy(0, 0, 0)
AXES = {"x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, 1]}


class Robot:
    """Links are placed with all axes parallel; `axes` of a link may then be turned."""

    def __init__(self, name, size=1.0, seen=None, limits=True):
        self.name, self.size, self.seen, self.limits = name, size, seen or {}, limits
        self.parts = []
        self.axes = {}

    def frame(self, link, xyz, rotation=ONE):
        own = transpose(self.axes.get(link, ONE))
        return f'<origin xyz="{text(turn(own, xyz))}" rpy="{text(to_rpy(multiply(own, rotation)))}"/>'

    def link(self, name, mass, com, box, shapes="", axes=ONE, inertia=None):
        self.axes[name] = axes
        s = self.size
        mass *= s**3
        com = [s * x for x in com]
        x, y, z = (s * e for e in box)
        moments = inertia or [mass / 12 * (y * y + z * z), mass / 12 * (x * x + z * z),
                              mass / 12 * (x * x + y * y)]
        self.parts.append(
            f'<link name="{name}"><inertial>{self.frame(name, com)}<mass value="{mass:.6g}"/>'
            f'<inertia ixx="{moments[0]:.6g}" ixy="0" ixz="0" iyy="{moments[1]:.6g}" iyz="0" '
            f'izz="{moments[2]:.6g}"/></inertial>{shapes}</link>')

    def empty(self, name, axes=ONE):
        self.axes[name] = axes
        self.parts.append(f'<link name="{name}"/>')

    def joint(self, name, parent, child, xyz, axis="y", limits=(-1, 1), effort=100.0, kind="revolute",
              tilt=ONE, more=""):
        """`tilt` turns the axis; a child of the joint keeps its axes."""
        s = self.size
        direction = turn(transpose(self.axes[child]), turn(tilt, [a for a in AXES[axis[-1]]]))
        if axis[0] == "-":
            direction = [-a for a in direction]
        limit = f'<limit lower="{limits[0]}" upper="{limits[1]}"'
        if not self.limits:
            limit = "<limit"
        elif effort is not None:
            limit += f' effort="{effort * s**4:.6g}" velocity="{12 / math.sqrt(s):.5g}"'
        moves = f'<axis xyz="{text(direction)}"/>{limit}/>{more}' if kind == "revolute" else ""
        rotation = self.axes[child]
        self.parts.append(
            f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
            f"{self.frame(parent, [s * x for x in xyz], rotation)}{moves}</joint>")

    def write(self, folder):
        folder.mkdir(parents=True, exist_ok=True)
        body = "\n  ".join(self.parts)
        (folder / f"{self.name}.urdf").write_text(
            f'<?xml version="1.0"?>\n<robot name="{self.name}">\n  {body}\n</robot>\n')


HIP_LIMITS = {"z": (-0.8, 0.8), "x": (-0.6, 0.6), "y": (-1.8, 0.9)}
HIP_EFFORTS = {"z": 200.0, "x": 350.0, "y": 400.0}


def leg(robot, side, hips="zxy", ankles="yx", names=None, pelvis="pelvis", knee="y", sole=None,
        tilts=None, axes=ONE, toes=False, hip_y=0.1, foot_mass=2.0, middle=0.0, bend=0.0):
    """From the pelvis down: hips and ankles are the order of the axes, the knee sits 0.4 lower.

    `bend`: rad, of the knee where all joints are at zero.
    """
    ahead, down = 0.4 * math.sin(0.5 * bend), -0.4 * math.cos(0.5 * bend)
    y = 1 if side == "left" else -1
    names = names or (lambda what: f"{side}_{what}")
    tilts = tilts or {}
    parent, at = pelvis, [0, middle + y * hip_y, -0.05]
    for i, axis in enumerate(hips):
        last = i == 2
        child = names("thigh" if last else f"hip_{axis}_link")
        robot.link(child, 8.0 if last else 1.5,
                   [0.42 * ahead, 0, 0.42 * down] if last else [0, 0, 0],
                   [0.14, 0.14, 0.36] if last else [0.1, 0.1, 0.1], axes=axes)
        lower, upper = HIP_LIMITS[axis]
        if axis == "y":
            lower, upper = lower + 0.5 * bend, upper + 0.5 * bend
        if axis == "x" and y < 0:
            lower, upper = -upper, -lower
        tilt = tilts.get(axis, ONE)
        if y < 0:
            tilt = [[tilt[i][j] * (-1 if (i == 1) != (j == 1) else 1) for j in range(3)]
                    for i in range(3)]
        robot.joint(names(f"hip_{axis}"), parent, child, at, axis, (lower, upper),
                    HIP_EFFORTS[axis], tilt=tilt)
        parent, at = child, [0, 0, 0]
    robot.link(names("shank"), 4.5, [-0.45 * ahead, 0, 0.45 * down], [0.11, 0.11, 0.36], axes=axes)
    limits = (-0.05 - bend, 2.3 - bend) if knee == "y" else (-2.3 + bend, 0.05 + bend)
    robot.joint(names("knee"), parent, names("shank"), [ahead, 0, down], knee, limits, 450.0)
    parent, at = names("shank"), [-ahead, 0, down]
    for i, axis in enumerate(ankles):
        last = i == len(ankles) - 1
        child = names("foot" if last else "ankle")
        shapes = sole(child, y) if last else ""
        robot.link(child, foot_mass if last else 0.6, [0.03, 0, -0.05] if last else [0, 0, 0],
                   [0.24, 0.1, 0.06] if last else [0.08, 0.08, 0.08], shapes, axes=axes)
        limits = (-1.0 + 0.5 * bend, 0.8 + 0.5 * bend) if axis == "y" else (-0.5, 0.5)
        robot.joint(names(f"ankle_{axis}"), parent, child, at, axis, limits, 250.0)
        parent, at = child, [0, 0, 0]
    if toes:
        robot.link(names("toe"), 0.2, [0.02, 0, 0], [0.05, 0.09, 0.02])
        robot.joint(names("toe"), parent, names("toe"), [0.17, 0, -0.07], "y", (-0.6, 0.6), 20.0)


def arm(robot, side, names=None, chest="chest", fingers=False, height=0.42, middle=0.0):
    y = 1 if side == "left" else -1
    names = names or (lambda what: f"{side}_{what}")
    robot.link(names("shoulder"), 1.5, [0, 0, 0], [0.1, 0.1, 0.1])
    robot.joint(names("shoulder_y"), chest, names("shoulder"), [0, middle + y * 0.22, height], "y", (-2.5, 1.5))
    robot.link(names("upper_arm"), 2.2, [0, 0, -0.14], [0.09, 0.09, 0.28])
    robot.joint(names("shoulder_x"), names("shoulder"), names("upper_arm"), [0, 0, 0], "x",
                (-0.1, 2.0) if y > 0 else (-2.0, 0.1))
    robot.link(names("forearm"), 1.6, [0, 0, -0.13], [0.08, 0.08, 0.28])
    robot.joint(names("elbow"), names("upper_arm"), names("forearm"), [0, 0, -0.3], "y", (-2.2, 0.0), 60.0)
    if not fingers:
        return
    for i in (1, 2):
        robot.link(names(f"finger{i}"), 0.05, [0, 0, -0.02], [0.02, 0.02, 0.05])
        robot.joint(names(f"finger_{i}_joint"), names("forearm"), names(f"finger{i}"),
                    [0.02 * i, 0, -0.28], "y", (0.0, 1.0), None if i == 1 else 0.0,
                    more="" if i == 1 else f'<mimic joint="{names("finger_1_joint")}"/>')


def torso(robot, pelvis="pelvis", chest="chest", waist="zy", mass=30.0, axes=ONE, beside=0.0):
    """`beside`: m, of the origins of its joints from the middle of the body."""
    parent, at = pelvis, [0, beside, 0.08]
    for i, axis in enumerate(waist):
        last = i == len(waist) - 1
        child = chest if last else f"waist_{axis}_link"
        robot.link(child, mass if last else 1.5,
                   [0, -beside, 0.25] if last else [0, -beside, 0.02],
                   [0.25, 0.36, 0.5] if last else [0.12, 0.16, 0.08], axes=axes)
        robot.joint(f"waist_{axis}", parent, child, at, axis, (-0.6, 0.6), 250.0)
        parent, at = child, [0, 0, 0.06]


# ------------------------------------------------------------------------------------------ soles

FRONT, BACK, HALF, DEPTH = 0.17, -0.07, 0.06, -0.09  # m, at size 1, from the ankle


def shape(robot, link, xyz, geometry, tag="collision", rotation=ONE):
    s = robot.size
    return (f"<{tag}>{robot.frame(link, [s * x for x in xyz], rotation)}<geometry>{geometry}"
            f"</geometry></{tag}>")


def bar_sole(width):
    """A box of this width, m at size 1."""
    def make(robot, link, y, axes=ONE):
        robot.axes[link] = axes
        size = [robot.size * x for x in (FRONT - BACK, width, 0.03)]
        return shape(robot, link, [(FRONT + BACK) / 2, 0, DEPTH + 0.015],
                     f'<box size="{text(size)}"/>')
    return make


box_sole = bar_sole(2 * HALF)


def sphere_sole(robot, link, y, axes=ONE):
    robot.axes[link] = axes
    r = 0.008
    return "".join(
        shape(robot, link, [x, w * HALF, DEPTH + r], f'<sphere radius="{r * robot.size:.6g}"/>')
        for x in (BACK, FRONT) for w in ((-0.8, 0.8) if x < 0 else (-1, 1)))


def capsule_sole(robot, link, y, axes=ONE):
    robot.axes[link] = axes
    r, s, out = 0.015, robot.size, ""
    for w in (-1, 0, 1):
        along = from_rpy(0, math.pi / 2, 0)
        out += shape(robot, link, [(FRONT + BACK) / 2, 0.045 * w, DEPTH + r],
                     f'<cylinder radius="{r * s:.6g}" length="{(FRONT - BACK) * s:.6g}"/>',
                     rotation=along)
    return out


def foot_corners(size, corners=24):
    """A rounded foot with a flat bottom, as a closed surface of triangles."""
    ring = []
    for i in range(corners):
        a = 2 * math.pi * i / corners
        c, sn = math.cos(a), math.sin(a)
        ring.append(((FRONT + BACK) / 2 + (FRONT - BACK) / 2 * math.copysign(abs(c) ** 0.5, c),
                     HALF * math.copysign(abs(sn) ** 0.5, sn)))
    low = [(x * size, y * size, DEPTH * size) for x, y in ring]
    high = [(0.7 * x * size, 0.7 * y * size, (DEPTH + 0.05) * size) for x, y in ring]
    triangles = []
    for i in range(corners):
        j = (i + 1) % corners
        triangles += [(low[i], low[j], high[j]), (low[i], high[j], high[i])]
        triangles += [(low[0], low[j], low[i]), (high[0], high[i], high[j])]
    return triangles


def tapered_corners(size):
    """A foot that is narrower at the heel, its edges in pieces."""
    outline = [(BACK, -0.6 * HALF), (FRONT, -HALF), (FRONT, HALF), (BACK, 0.6 * HALF)]
    ring = []
    for i, (x, y) in enumerate(outline):
        u, v = outline[(i + 1) % 4]
        ring += [(x + k / 3 * (u - x), y + k / 3 * (v - y)) for k in range(3)]
    low = [(x * size, y * size, DEPTH * size) for x, y in ring]
    high = [(0.7 * x * size, 0.7 * y * size, (DEPTH + 0.05) * size) for x, y in ring]
    return [t for i in range(len(ring)) for t in (
        (low[i], low[i - 1], high[i]), (low[0], low[i], low[i - 1]), (high[0], high[i - 1], high[i]))]


def write_mesh(path, triangles):
    path.parent.mkdir(parents=True, exist_ok=True)
    corners = [corner for triangle in triangles for corner in triangle]
    if path.name.endswith(".ascii.stl"):
        facets = "".join("facet normal 0 0 0\nouter loop\n" +
                         "".join(f"  vertex {text(c)}\n" for c in t) + "endloop\nendfacet\n"
                         for t in triangles)
        path.write_text(f"solid foot\n{facets}endsolid foot\n")
    elif path.suffix == ".stl":
        path.write_bytes(b"foot".ljust(80) + struct.pack("<I", len(triangles)) + b"".join(
            struct.pack("<12fH", 0, 0, 0, *[x for c in t for x in c], 0) for t in triangles))
    elif path.suffix == ".obj":
        path.write_text("".join(f"v {text(c)}\n" for c in corners) +
                        "".join(f"f {i + 1} {i + 2} {i + 3}\n" for i in range(0, len(corners), 3)))
    else:  # in mm, with a node that moves it
        numbers = " ".join(text([1000 * x for x in c]) for c in corners)
        path.write_text(
            '<?xml version="1.0"?>\n<COLLADA version="1.4.1"><asset><unit meter="0.001"/></asset>'
            '<library_geometries><geometry id="foot"><mesh><source id="p"><float_array id="a" '
            f'count="{3 * len(corners)}">{numbers}</float_array></source><vertices id="v"><input '
            'semantic="POSITION" source="#p"/></vertices></mesh></geometry></library_geometries>'
            '<library_visual_scenes><visual_scene id="s"><node><translate>0 0 0</translate>'
            '<rotate>0 0 1 0</rotate><instance_geometry url="#foot"/></node></visual_scene>'
            "</library_visual_scenes></COLLADA>\n")


def mesh_sole(robot, name, tag="collision", scale=1.0, axes=ONE):
    def sole(link, y):
        robot.axes[link] = axes
        return shape(robot, link, [0, 0, 0],
                     f'<mesh filename="{name}" scale="{text([scale] * 3)}"/>', tag)
    return sole


def sole_of(robot, maker, axes=ONE):
    return lambda link, y: maker(robot, link, y, axes)


# ----------------------------------------------------------------------------------------- robots

def pelvis(robot, name="pelvis", mass=12.0, axes=ONE):
    robot.link(name, mass, [0, 0, 0.02], [0.2, 0.26, 0.14], axes=axes)


def imu(robot, parent, xyz, name="imu_link", rotation=ONE):
    robot.empty(name, rotation)
    robot.joint(name + "_joint", parent, name, xyz, kind="fixed")


def tiny(folder):
    """0.3 of a human, boxes under the feet, nothing odd."""
    r = Robot("tiny", 0.3)
    pelvis(r)
    imu(r, "pelvis", [0, 0, 0.05])
    torso(r, waist="z")
    for side in ("left", "right"):
        leg(r, side, "zxy", sole=sole_of(r, box_sole))
        arm(r, side)
    r.write(folder)


def spheres(folder):
    """Hips of pitch, a tilted roll and yaw; soles of four spheres; IMU in the chest; grippers."""
    r = Robot("spheres", 0.6)
    pelvis(r)
    torso(r)
    r.parts.append('<gazebo reference="chest"><sensor name="torso_imu" type="imu"/></gazebo>')
    for side in ("left", "right"):
        leg(r, side, "yxz", sole=sole_of(r, sphere_sole), tilts={"x": from_rpy(0, -0.17, 0)})
        arm(r, side, fingers=True)
    r.write(folder)


def sideways(folder):
    """The pelvis looks along its y axis and floats in a world; STL soles of a package."""
    r = Robot("sideways", 0.8)
    r.empty("world")
    quarter = from_rpy(0, 0, -math.pi / 2)
    pelvis(r, axes=quarter)
    r.parts.append('<joint name="free" type="floating"><parent link="world"/><child link="pelvis"/>'
                   "</joint>")
    imu(r, "pelvis", [0.05, 0, 0], rotation=from_rpy(math.pi, 0, 0))
    torso(r, waist="zyx")
    write_mesh(folder / "meshes" / "foot.stl", foot_corners(r.size))
    for side in ("left", "right"):
        leg(r, side, "xzy", sole=mesh_sole(r, f"package://{folder.name}/meshes/foot.stl"))
        arm(r, side)
    r.write(folder)


def tilted(folder):
    """Yaw and roll of the hips tilted by 20 degrees, only visuals (OBJ in mm), force sensors."""
    r = Robot("tilted", 1.0)
    pelvis(r)
    torso(r)
    write_mesh(folder / "foot.obj", foot_corners(1000 * r.size))
    for side in ("left", "right"):
        leg(r, side, "zxy", sole=mesh_sole(r, "foot.obj", "visual", 0.001),
            tilts={"z": from_rpy(0.35, 0, 0), "x": from_rpy(0, 0.2, 0)})
        arm(r, side)
        r.parts.append(f'<gazebo reference="{side}_ankle_x"><sensor name="{side}_ft" '
                       'type="force_torque"/></gazebo>')
    r.write(folder)


def toes(folder):
    """1.2 of a human with toes, a neck without effort, a rounded inertia, COLLADA soles."""
    r = Robot("toes", 1.2)
    pelvis(r)
    imu(r, "pelvis", [0, 0, 0], "pelvis_imu")
    torso(r)
    r.link("head", 3.0, [0, 0, 0.08], [0.15, 0.15, 0.2], inertia=[0.01, 0.01, 0.0205])
    r.joint("neck", "chest", "head", [0, 0, 0.5], "z", (-1, 1), None)
    write_mesh(folder / "foot.dae", foot_corners(r.size))
    for side in ("left", "right"):
        leg(r, side, "zxy", sole=mesh_sole(r, "foot.dae"), toes=True)
        arm(r, side)
    r.write(folder)


def backwards(folder):
    """Ankles roll before they pitch, knees count the other way; a pelvis that looks backwards."""
    r = Robot("backwards", 0.5)
    half = from_rpy(0, 0, math.pi)
    pelvis(r, axes=half)
    imu(r, "pelvis", [0, 0, 0])
    torso(r, waist="y")
    write_mesh(folder / "foot.ascii.stl", foot_corners(r.size, 40))
    for side in ("left", "right"):
        leg(r, side, "xzy", "xy", knee="-y", sole=mesh_sole(r, "foot.ascii.stl"))
        arm(r, side)
    r.write(folder)


def nameless(folder):
    """Names that say nothing, no waist, no IMU; arms on the pelvis."""
    r = Robot("nameless", 0.7)
    pelvis(r, "b0", mass=45.0)
    count = {}

    def names_of(offset):
        def name(what):
            return f"b{count.setdefault((offset, what), 1 + len(count))}"
        return name
    for i, side in enumerate(("left", "right")):
        leg(r, side, "yxz", names=names_of(i), pelvis="b0", sole=sole_of(r, box_sole))
        arm(r, side, names=names_of(2 + i), chest="b0")
    r.write(folder)


def twisted(folder):
    """Every link of the legs has axes of its own, the base is a footprint; rounded bars as soles."""
    r = Robot("twisted", 1.0)
    axes = from_rpy(0, math.pi / 2, 0.0)
    r.empty("base_footprint")
    pelvis(r)
    r.joint("base", "base_footprint", "pelvis", [0, 0, 0.95], kind="fixed")
    imu(r, "pelvis", [0, 0, 0.03], rotation=from_rpy(0, 0, math.pi / 2))
    torso(r)
    for side in ("left", "right"):
        leg(r, side, "xyz", sole=sole_of(r, capsule_sole, axes), axes=axes)
        arm(r, side, fingers=True)
    r.write(folder)


def crouched(folder):
    """Zero is a crouch, its knees bent by 0.8 rad."""
    r = Robot("crouched", 0.9)
    pelvis(r)
    imu(r, "pelvis", [0, 0, 0.03])
    torso(r, waist="z")
    for side in ("left", "right"):
        leg(r, side, "xzy", sole=sole_of(r, box_sole), bend=0.8)
        arm(r, side)
    r.write(folder)


def skewed(folder):
    """The pelvis looks 30 degrees aside, hip yaws are tilted by 40 and come first, the waist has its
    origin beside the body, feet taper, and there is what is broken but not needed: a camera without
    a range, a tip without mass, an inertia without a mass."""
    r = Robot("skewed", 0.75)
    pelvis(r, axes=from_rpy(0, 0, 0.52))
    imu(r, "pelvis", [0, 0, 0])
    torso(r, waist="y", beside=0.08)
    write_mesh(folder / "foot.stl", tapered_corners(r.size))
    for side in ("left", "right"):
        leg(r, side, "zxy", sole=mesh_sole(r, "foot.stl"), tilts={"z": from_rpy(0.7, 0, 0)})
        arm(r, side, middle=-0.08)
    r.link("camera", 0.1, [0, 0, 0], [0.05, 0.05, 0.05])
    r.joint("camera_joint", "chest", "camera", [0.1, -0.08, 0.5], "y", (0, 0), 1.0)
    r.empty("tip")
    r.joint("tip_joint", "left_forearm", "tip", [0, 0, -0.28], "y", (-0.1, 0.1), 1.0)
    r.link("marker", 0.0, [0, 0, 0], [0, 0, 0], inertia=[1e-6, 1e-6, 1e-6])
    r.joint("marker_joint", "chest", "marker", [0, 0, 0.1], kind="fixed")
    r.write(folder)


def rooted(folder):
    """The chest is the root; the pelvis hangs on the waist, by a link without mass."""
    r = Robot("rooted", 0.65)
    r.link("chest", 26.0, [0, 0, 0.2], [0.25, 0.36, 0.5])
    imu(r, "chest", [0, 0, 0.1])
    r.empty("waist_cross")
    r.joint("waist_yaw", "chest", "waist_cross", [0, 0, -0.1], "z", (-0.6, 0.6), 250.0)
    pelvis(r)
    r.joint("waist_pitch", "waist_cross", "pelvis", [0, 0, -0.06], "y", (-0.6, 0.6), 250.0)
    for side in ("left", "right"):
        leg(r, side, "yxz", sole=sole_of(r, box_sole))
        arm(r, side)
    r.write(folder)


def bare(folder):
    """No joint has limits, no foot a shape, and an inertia is one that no body has."""
    r = Robot("bare", 0.45, limits=False)
    pelvis(r)
    torso(r, waist="z")
    r.link("head", 3.0, [0, 0, 0.08], [0.15, 0.15, 0.2], inertia=[0.0003, 0.0004, 0.0014])
    r.joint("neck", "chest", "head", [0, 0, 0.5], "z")
    for side in ("left", "right"):
        leg(r, side, "zxy", sole=lambda link, y: "")
        arm(r, side)
    r.write(folder)


def five_joints(name, width):
    """Legs of five joints: nothing rolls the feet, which are bars."""
    def make(folder):
        r = Robot(name, 0.85)
        pelvis(r)
        imu(r, "pelvis", [0, 0, 0.03])
        torso(r, waist="z")
        for side in ("left", "right"):
            leg(r, side, "zxy", "y", sole=sole_of(r, bar_sole(width)))
            arm(r, side)
        r.write(folder)
    make.__name__ = name
    return make


ROBOTS = [tiny, spheres, sideways, tilted, toes, backwards, nameless, twisted, crouched,
          skewed, rooted, bare, five_joints("narrow", 0.047), five_joints("wide", 0.12)]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("names", nargs="*")
    options = parser.parse_args()
    for make in ROBOTS:
        if not options.names or make.__name__ in options.names:
            make(options.folder / make.__name__)


main()
