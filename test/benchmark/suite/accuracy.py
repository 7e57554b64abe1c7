"""Run time against error: element types and families of meshes."""
import csv
import os
import xml.etree.ElementTree as ElementTree

from .paper import energy_norm_error
from .program import Failure, execute, find_python
from .table import Table

# Triangles are paired and what comes out is cut in four: cells of half the size that was asked for.
QUADRILATERALS = "Mesh.RecombineAll = 1;\nMesh.SubdivisionAlgorithm = 1;\n"
GRADING = {1: 0.4, 2: 0.8}  # by order: above 1 - 0.7 / order, for displacements like r^0.7
HERE = os.path.dirname(os.path.abspath(__file__))


def gmsh_deck(bench, deck, name, geometry):
    """Writes the deck with a mesh by gmsh from a geometry of its own; its path."""
    tree = ElementTree.parse(os.path.join(bench.program.input_folder, deck))
    mesh = tree.getroot().find("ParameterList[@name='Mesh']")
    mesh.clear()
    mesh.set("name", "Mesh")
    for parameter, value in (("Type", "gmsh"), ("File", name + ".geo")):
        ElementTree.SubElement(mesh, "Parameter", name=parameter, type="string", value=value)
    with open(os.path.join(bench.output, name + ".geo"), "w") as file:
        file.write(geometry)
    path = os.path.join(bench.output, name + ".xml")
    tree.write(path)
    return path


def geometry(path, element, prefix=""):
    with open(path) as file:
        return prefix + file.read() + (QUADRILATERALS if element[0] == "Q" else "")


def beam_runs(bench, xi):
    """(family, element, result) on uniform boxes and on meshes graded to the corners."""
    for element in ("P1", "Q1", "P2", "Q2"):
        for n in bench.sizes["accuracy"]["box"]:
            n //= int(element[1])  # as many nodes
            yield "box", element, bench.program.beam(n, xi, fresh=True, **{"Mesh->Element": element})
        for h in bench.sizes["accuracy"]["graded"][int(element[1]) - 1]:
            prefix = "h = %g;\ngrading = %g;\n" % (h if element[0] == "P" else 2 * h, GRADING[int(element[1])])
            text = geometry(os.path.join(HERE, "beam_graded.geo"), element, prefix)
            deck = gmsh_deck(bench, "beam.xml", "beam_%s_%g" % (element, h), text)
            yield "graded", element, bench.program.run(
                deck, fresh=True, **{"Contact->Yield Stress": xi, "Mesh->Order": element[1]})


def hertz_runs(bench, xi):
    path = os.path.join(bench.program.input_folder, "hertz.geo")
    for element in ("P1", "Q1", "P2", "Q2"):
        deck = gmsh_deck(bench, "hertz.xml", "hertz_" + element, geometry(path, element))
        for factor in bench.sizes["accuracy"]["hertz"]:
            yield "gmsh", element, bench.program.run(
                deck, fresh=True, **{"Contact->Yield Stress": xi, "Mesh->Order": element[1], "Mesh->Size Factor": factor})


def measurements(bench):
    """Rows of: scene, family, element, dofs, seconds, error, a further error or None."""
    for xi in ("2", "16"):
        exact = bench.beam_reference(xi)
        for family, element, r in beam_runs(bench, xi):
            require_element(r, element)
            yield "beam, xi = " + xi, family, element, r["dofs"], r["process"], energy_norm_error(r["energy_J"], exact), None
    for xi, force, pressure in bench.reference["hertz"]["rows"]:
        for family, element, r in hertz_runs(bench, xi):
            require_element(r, element)
            yield ("Hertz, xi = " + xi, family, element, r["dofs"], r["process"], abs(r["contact_force"][1] / force - 1),
                   abs(r["max_pressure"] / pressure - 1))


def require_element(result, element):
    if result["element"] != element:
        raise Failure("asked for %s, got %s" % (element, result["element"]))


def accuracy(bench):
    rows = list(measurements(bench))
    with open(os.path.join(bench.output, "accuracy.csv"), "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["scene", "mesh", "element", "dofs", "whole process [s]", "error", "error of max. pressure"])
        writer.writerows(rows)
    python = find_python("matplotlib")
    picture = "No picture: it takes matplotlib (python3-matplotlib)."
    if python:
        execute([python, os.path.join(HERE, "plot.py"), os.path.join(bench.output, "accuracy.csv")])
        picture = "![Error over time](accuracy.png)"
    table = Table("Run time against error",
                  "Whole process on one rank. Error: beam, sqrt(2 |J_h - J| / a(u,u)), where the reference's own tolerance "
                  "allows %.1e at xi = 2 Pa and %.1e at 16; Hertz, the contact force, and in the last column the largest pressure, "
                  "against a solution on a fine quadratic mesh (reference.json, which tells its tolerance). Meshes: uniform box; "
                  "graded to the corners, by gmsh; gmsh's of input/hertz.geo. %s"
                  % (*[energy_norm_error(sum(exact[:2]), exact) for exact in map(bench.beam_reference, ("2", "16"))], picture),
                  ["scene", "mesh", "element", "dofs", "time [s]", "error", "max. pressure"])
    for scene, family, element, dofs, seconds, error, further in rows:
        table.add(scene, family, element, dofs, "%.2f" % seconds, "%.2e" % error, "" if further is None else "%.1e" % further)
    return table
