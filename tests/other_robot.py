"""Makes another robot out of Atlas: other_robot.py ATLAS_FOLDER OUTPUT_FOLDER [--size S]
[--legs S] [--feet S] [--leg-mass S] [--torso-mass S]

--size scales the whole robot in all directions at the same density and stress: masses go with the
third power, inertias with the fifth, torque limits with the fourth. The others scale the lengths of
thighs and shanks, the soles and the masses alone.
"""
import argparse
import pathlib
import re
import xml.etree.ElementTree as ElementTree


def scale(element, attribute, factor):
    numbers = [float(x) * factor for x in element.get(attribute).split()]
    element.set(attribute, " ".join(f"{x:.10g}" for x in numbers))


def scale_link(link, size, mass):
    inertial = link.find("inertial")
    if inertial is None:
        return
    scale(inertial.find("mass"), "value", size**3 * mass)
    inertia = inertial.find("inertia")
    for attribute in list(inertia.attrib):
        scale(inertia, attribute, size**5 * mass)


def make_urdf(source, options):
    tree = ElementTree.parse(source)
    robot = tree.getroot()
    size = options.size
    for origin in robot.iter("origin"):
        if origin.get("xyz"):
            scale(origin, "xyz", size)
    for shape in ("box", "cylinder", "sphere"):
        for element in robot.iter(shape):
            for attribute in list(element.attrib):
                scale(element, attribute, size)
    for limit in robot.iter("limit"):
        scale(limit, "effort", size**4)
        scale(limit, "velocity", size**-0.5)
    for joint in robot.iter("joint"):
        if re.fullmatch(r"[lr]_leg_(kny|aky)", joint.get("name")):
            scale(joint.find("origin"), "xyz", options.legs)
    for link in robot.iter("link"):
        leg = re.search(r"leg|foot|talus", link.get("name"))
        torso = link.get("name") == "utorso"
        mass = options.leg_mass if leg else options.torso_mass if torso else 1.0
        scale_link(link, size, mass)
    return tree


def scale_numbers(text, factor):
    return re.sub(r"-?\d+(\.\d+)?", lambda m: f"{float(m.group()) * factor:.10g}", text)


def make_description(text, options):
    text = text.replace("name: atlas", "name: other").replace("atlas.urdf", "robot.urdf")
    text = re.sub(r"(?<=xyz: \[)[^]]*", lambda m: scale_numbers(m.group(), options.size), text)
    soles = options.size * options.feet
    return re.sub(r"(?<=outline: ).*", lambda m: scale_numbers(m.group(), soles), text)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("atlas", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    for name in ("--size", "--legs", "--feet", "--leg-mass", "--torso-mass"):
        parser.add_argument(name, type=float, default=1.0)
    options = parser.parse_args()
    options.output.mkdir(parents=True)
    make_urdf(options.atlas / "atlas.urdf", options).write(options.output / "robot.urdf")
    description = (options.atlas / "robot.yaml").read_text()
    (options.output / "robot.yaml").write_text(make_description(description, options))


main()
