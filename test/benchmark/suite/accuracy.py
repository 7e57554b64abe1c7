# SPDX-License-Identifier: BSD-3-Clause
"""Run time against error: element types, families of meshes, adaptive meshes, peers."""
import csv
import itertools
import os
import typing
import xml.etree.ElementTree as ElementTree

from . import peers
from .paper import energy_norm_error
from .program import Failure, picture
from .table import Table

ADAPTIVE = ("P2", "Q2")  # of the elements
BEAM, HERTZ = ("2", "16", "inf"), ("20", "100")  # xi [Pa]
GRADED = FINER = ("2", "16")  # of them with graded meshes, and with the finer Q1 meshes that adaptive.py compares with
PEERS = {"scikit-fem, MUMPS Schur complement": "skfem, MUMPS", "scikit-fem, PETSc hypre": "skfem, hypre"}  # names, here
LEVELS = (0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0005)
# Triangles are paired and what comes out is cut in four: cells of half the size that was asked for.
QUADRILATERALS = "Mesh.RecombineAll = 1;\nMesh.SubdivisionAlgorithm = 1;\n"
GRADING = {1: 0.4, 2: 0.8}  # by order: above 1 - 0.7 / order, for displacements like r^0.7
COARSEST_HERTZ = 8  # size factor that adaptive runs start from, as in input/hertz_adaptive.xml
HERE = os.path.dirname(os.path.abspath(__file__))


class Run(typing.NamedTuple):
    """One process on one rank. Errors are relative, the first in the energy norm, and None where there is no reference."""

    scene: str
    mesh: str
    element: str
    dofs: int
    seconds: float
    error: float
    allowed: float  # by the tolerance of the reference
    force: typing.Optional[float] = None
    pressure: typing.Optional[float] = None


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


def checked(result, element):
    """The result, if it is one with the element."""
    if result["element"] != element:
        raise Failure("asked for %s, got %s" % (element, result["element"]))
    return result


def uniform_beam(bench, xi, element, n):
    """On a box with as many nodes as Q1 has with 1/h = n."""
    return checked(bench.program.beam(n // int(element[1]), xi, **{"Mesh->Element": element}), element)


def graded_beam(bench, xi, element, h):
    """On a mesh graded to the corners, by gmsh."""
    prefix = "h = %g;\ngrading = %g;\n" % (h if element[0] == "P" else 2 * h, GRADING[int(element[1])])
    text = geometry(os.path.join(HERE, "beam_graded.geo"), element, prefix)
    deck = gmsh_deck(bench, "beam.xml", "beam_%s_%g" % (element, h), text)
    return checked(bench.program.run(deck, **{"Contact->Yield Stress": xi, "Mesh->Order": element[1]}), element)


def adaptive_beam(bench, xi, element, target, fresh=False):
    return checked(bench.program.run("beam_adaptive.xml", fresh=fresh, **{
        "Contact->Yield Stress": xi, "Mesh->Element": element, "Adapt->Target Relative Error": target}), element)


def hertz(bench, xi, element, factor, deck="hertz.xml", fresh=False, **parameters):
    """On gmsh's mesh with a size factor."""
    text = geometry(os.path.join(bench.program.input_folder, "hertz.geo"), element)
    path = gmsh_deck(bench, deck, os.path.splitext(deck)[0] + "_" + element, text)
    return checked(bench.program.run(path, fresh=fresh, **{
        "Contact->Yield Stress": xi, "Mesh->Order": element[1], "Mesh->Size Factor": factor, **parameters}), element)


def adaptive_hertz(bench, xi, element, target, fresh=False):
    return hertz(bench, xi, element, COARSEST_HERTZ, "hertz_adaptive.xml", fresh,
                 **{"Adapt->Target Relative Error": target})


def beam_results(bench, xi):
    """(mesh, element, result) of rpc."""
    sizes = bench.sizes["accuracy"]
    for element in sizes["elements"]:
        for n in sizes["box"] + (sizes["finer Q1"] if element == "Q1" and xi in FINER else []):
            yield "uniform", element, uniform_beam(bench, xi, element, n)
        for h in sizes["graded"][int(element[1]) - 1] if xi in GRADED else []:
            yield "graded", element, graded_beam(bench, xi, element, h)
    for element in [element for element in ADAPTIVE if element in sizes["elements"]]:
        for target in sizes["targets"]:
            yield "adaptive", element, adaptive_beam(bench, xi, element, target)


def peer_results(bench, xi):
    """(name, element, result) of peers on uniform boxes, and why there are no others."""
    found, reasons = [], []
    for peer in peers.PEERS:
        if peer.name not in PEERS:
            continue
        reason = bench.python.lacks(peer.modules)
        try:
            found += [(PEERS[peer.name], "Q1", bench.python.run(peer.command, "beam", n, xi, 1))
                      for n in bench.sizes["accuracy"]["peers"] if not reason]
        except Failure as failure:
            reason = str(failure).strip().splitlines()[-1]
        if reason:
            reasons.append("%s: %s" % (peer.name, reason))
    return found, reasons


def hertz_results(bench, xi):
    """(mesh, element, result)."""
    sizes = bench.sizes["accuracy"]
    for element in sizes["elements"]:
        for factor in sizes["hertz"]:
            yield "gmsh", element, hertz(bench, xi, element, factor)
    for element in [element for element in ADAPTIVE if element in sizes["elements"]]:
        for target in sizes["targets"]:
            yield "adaptive", element, adaptive_hertz(bench, xi, element, target)


def beam_run(bench, xi, mesh, element, result):
    """Of rpc, or of a peer."""
    exact = bench.energy_reference("beam", xi)
    energy = result["energy_J"] if "energy_J" in result else result["J"]
    return Run("beam, xi = " + xi, mesh, element, result["dofs"], result["process"], energy_norm_error(energy, exact),
               energy_norm_error(sum(exact[:2]), exact))


def hertz_run(bench, xi, mesh, element, result):
    exact = bench.energy_reference("hertz", xi)
    force, pressure = bench.row("hertz", xi)[4:6]
    return Run("Hertz, xi = " + xi, mesh, element, result["dofs"], result["process"],
               energy_norm_error(result["energy_J"], exact), energy_norm_error(sum(exact[:2]), exact),
               abs(result["contact_force"][1] / force - 1), abs(result["max_pressure"] / pressure - 1))


def all_runs(bench):
    """Of all scenes, and why some peers have none."""
    runs, reasons = [], []
    for xi in BEAM:
        runs += [beam_run(bench, xi, *result) for result in beam_results(bench, xi)]
        found, missing = peer_results(bench, xi)
        runs += [beam_run(bench, xi, *result) for result in found]
        reasons += missing
    for xi in HERTZ:
        runs += [hertz_run(bench, xi, *result) for result in hertz_results(bench, xi)]
    return runs, list(dict.fromkeys(reasons))


def fastest(runs, error):
    """Of runs from coarse to fine, the fastest from which on none has more than the error; None if there is none.

    With the contact law at points, J_h need not fall from mesh to mesh: an error that is small by chance does not count.
    """
    return min(itertools.takewhile(lambda run: run.error <= error, reversed(runs)), key=lambda run: run.seconds, default=None)


def write(runs, folder):
    """accuracy.csv and, if there is matplotlib, accuracy.png; what the page says of the picture."""
    path = os.path.join(folder, "accuracy.csv")
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["scene", "mesh", "element", "dofs", "whole process [s]", "error", "error allowed by the reference",
                         "error of contact force", "error of max. pressure"])
        writer.writerows([["%.6g" % cell if isinstance(cell, float) else cell for cell in run] for run in runs])
    return picture(os.path.join(HERE, "plot.py"), path, "Error over time")


def accuracy(bench):
    runs, reasons = all_runs(bench)
    plotted = write(runs, bench.output)
    table = Table("Run time against error",
                  "Seconds of the fastest run whose error in the energy norm, sqrt(2 |J_h - J| / a(u,u)), is at most that of the "
                  "column, as are those of all finer runs of the line (J_h need not fall); and the run with the least error. Whole "
                  "processes on one rank, with all meshes and solves of an adaptive run. All runs, for Hertz with errors of "
                  "force and pressure: [accuracy.csv](accuracy.csv). J and its tolerance, which makes the grey part of the "
                  "picture: reference.json. Meshes: uniform boxes; graded to the corners, by gmsh; gmsh's of input/hertz.geo; "
                  "adaptive, for targets of %g to %g. Peers: on uniform boxes, one thread.%s\n\n%s"
                  % (max(bench.sizes["accuracy"]["targets"]), min(bench.sizes["accuracy"]["targets"]),
                     " Skipped: %s." % "; ".join(reasons) if reasons else "", plotted),
                  ["scene", "mesh", "element"] + ["%g %%" % (100 * level) for level in LEVELS] + ["least", "dofs", "time [s]"])
    for scene, mesh, element in dict.fromkeys(run[:3] for run in runs):
        line = [run for run in runs if run[:3] == (scene, mesh, element)]
        best = min(line, key=lambda run: run.error)
        reached = [fastest(line, level) for level in LEVELS]
        table.add(scene, mesh, element, *["%.2f" % run.seconds if run else "" for run in reached],
                  "%.3f %%" % (100 * best.error), best.dofs, "%.2f" % best.seconds)
    return table
