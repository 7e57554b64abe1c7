# SPDX-License-Identifier: BSD-3-Clause
"""Small scenes to start mutations from: a deck, with the mesh or geometry that it names."""

import dataclasses
import pathlib
import re

from plane import Body
from solid import Bricks
from space import cap

# One deck with a bit of everything that a deck may hold.
FULL = """<ParameterList name="full">
  <ParameterList name="Mesh">
    <Parameter name="Type" type="string" value="gmsh"/>
    <Parameter name="File" type="string" value="layers.geo"/>
    <Parameter name="Size Factor" type="double" value="2"/>
    <Parameter name="Order" type="int" value="1"/>
  </ParameterList>
  <ParameterList name="Material">
    <Parameter name="Young's Modulus" type="double" value="2000"/>
    <Parameter name="Poisson's Ratio" type="double" value="0.3"/>
    <ParameterList name="Blocks">
      <ParameterList name="stiff"><Parameter name="Young's Modulus" type="double" value="2e4"/>
      <Parameter name="Poisson's Ratio" type="double" value="0.3"/></ParameterList>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Dirichlet">
    <ParameterList name="press">
      <Parameter name="Side" type="string" value="top"/>
      <Parameter name="X" type="int" value="0"/>
      <Parameter name="Y" type="string" value="-0.01*(1 + x^2)"/>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Body Force">
    <Parameter name="Y" type="string" value="x &lt; 0.5 ? -3 : sin(x*y)"/>
  </ParameterList>
  <ParameterList name="Contact">
    <Parameter name="Side" type="string" value="bottom"/>
    <Parameter name="Yield Stress" type="string" value="10 + x"/>
    <Parameter name="Normal" type="string" value="0, -1"/>
    <Parameter name="Penalty" type="double" value="1e7"/>
    <ParameterList name="Obstacle">
      <Parameter name="Type" type="string" value="circle"/>
      <Parameter name="Centre" type="Array(double)" value="{0.5, -3}"/>
      <Parameter name="Radius" type="double" value="3"/>
      <Parameter name="Encloses Body" type="bool" value="false"/>
    </ParameterList>
    <ParameterList name="Sides">
      <ParameterList name="wall">
        <Parameter name="Side" type="string" value="right"/>
        <Parameter name="Gap" type="string" value="0.001*y"/>
        <Parameter name="Yield Stress" type="string" value="inf"/>
      </ParameterList>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Uzawa">
    <Parameter name="Tolerance" type="double" value="1e-6"/>
    <Parameter name="Stopping Test" type="string" value="optimality"/>
  </ParameterList>
  <ParameterList name="NOX">
    <Parameter name="Step Tolerance" type="double" value="1e-9"/>
    <ParameterList name="Line Search"><Parameter name="Method" type="string" value="Backtrack"/></ParameterList>
  </ParameterList>
  <ParameterList name="Linear Solver">
    <Parameter name="Method" type="string" value="Block CG"/>
    <Parameter name="Reuse" type="string" value="none"/>
    <ParameterList name="Belos"><Parameter name="Block Size" type="int" value="1"/></ParameterList>
    <ParameterList name="MueLu">
      <Parameter name="coarse: max size" type="int" value="20"/>
      <Parameter name="smoother: type" type="string" value="CHEBYSHEV"/>
      <ParameterList name="smoother: params"><Parameter name="chebyshev: degree" type="int" value="2"/></ParameterList>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Output"><Parameter name="Timers" type="bool" value="true"/></ParameterList>
</ParameterList>
"""

SECTOR = """<ParameterList name="sector">
  <ParameterList name="Mesh">
    <Parameter name="Type" type="string" value="gmsh"/>
    <Parameter name="File" type="string" value="MESH"/>
  </ParameterList>
  <ParameterList name="Material">
    <Parameter name="Young's Modulus" type="double" value="1"/>
    <Parameter name="Poisson's Ratio" type="double" value="0.3"/>
  </ParameterList>
  <ParameterList name="Dirichlet">
    <ParameterList name="straight">
      <Parameter name="X" type="double" value="0"/>
      <Parameter name="Y" type="double" value="0"/>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Body Force"><Parameter name="Y" type="double" value="0.01"/></ParameterList>
  <ParameterList name="Contact">
    <Parameter name="Side" type="string" value="arc"/>
    <Parameter name="Yield Stress" type="double" value="0.02"/>
  </ParameterList>
</ParameterList>
"""


# A body in space, pushed along z.
SOLID = """<ParameterList name="solid">
  <ParameterList name="Mesh">
    <Parameter name="Type" type="string" value="gmsh"/>
    <Parameter name="File" type="string" value="MESH"/>
  </ParameterList>
  <ParameterList name="Material">
    <Parameter name="Young's Modulus" type="double" value="1"/>
    <Parameter name="Poisson's Ratio" type="double" value="0.3"/>
  </ParameterList>
  <ParameterList name="Dirichlet">
    <ParameterList name="HELD">
      <Parameter name="X" type="double" value="0"/>
      <Parameter name="Y" type="double" value="0"/>
      <Parameter name="Z" type="double" value="0"/>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Body Force"><Parameter name="Z" type="double" value="0.01"/></ParameterList>
  <ParameterList name="Contact">
    <Parameter name="Side" type="string" value="CONTACT"/>
    <Parameter name="Yield Stress" type="double" value="0.006"/>
  </ParameterList>
</ParameterList>
"""


# What only bodies in space may hold: curved cells, a ball and a rod as obstacles.
CURVED = """<ParameterList name="curved">
  <ParameterList name="Mesh">
    <Parameter name="Type" type="string" value="gmsh"/>
    <Parameter name="File" type="string" value="MESH"/>
  </ParameterList>
  <ParameterList name="Material">
    <Parameter name="Young's Modulus" type="double" value="1000"/>
    <Parameter name="Poisson's Ratio" type="double" value="0.45"/>
    <ParameterList name="Blocks">
      <ParameterList name="body">
        <Parameter name="Young's Modulus" type="double" value="1"/>
        <Parameter name="Poisson's Ratio" type="double" value="0.3"/>
        <Parameter name="Dilatation" type="string" value="projected"/>
      </ParameterList>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Dirichlet">
    <ParameterList name="top">
      <Parameter name="X" type="double" value="0"/>
      <Parameter name="Y" type="string" value="-0.02 - 0.001*x*z"/>
      <Parameter name="Z" type="double" value="0"/>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Traction">
    <ParameterList name="front"><Parameter name="Z" type="string" value="-y"/></ParameterList>
  </ParameterList>
  <ParameterList name="Contact">
    <Parameter name="Side" type="string" value="bottom"/>
    <Parameter name="Yield Stress" type="string" value="60 + 10*z"/>
    <ParameterList name="Obstacle">
      <Parameter name="Type" type="string" value="sphere"/>
      <Parameter name="Centre" type="Array(double)" value="{0.5, 5, 0.5}"/>
      <Parameter name="Radius" type="double" value="5"/>
      <Parameter name="Encloses Body" type="bool" value="true"/>
    </ParameterList>
    <ParameterList name="Sides">
      <ParameterList name="right">
        <Parameter name="Normal" type="string" value="1, 0, 0"/>
        <ParameterList name="Obstacle">
          <Parameter name="Type" type="string" value="cylinder"/>
          <Parameter name="Point" type="Array(double)" value="{3, 0.5, 0}"/>
          <Parameter name="Axis" type="Array(double)" value="{0, 0.1, 1}"/>
          <Parameter name="Radius" type="double" value="1.99"/>
        </ParameterList>
      </ParameterList>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Adapt"><Parameter name="Estimate Error" type="bool" value="true"/></ParameterList>
</ParameterList>
"""

TUBE = """<ParameterList name="tube">
  <Parameter name="Kinematics" type="string" value="axisymmetric"/>
  <ParameterList name="Mesh">
    <Parameter name="Lower" type="Array(double)" value="{1, 0}"/>
    <Parameter name="Upper" type="Array(double)" value="{2, 1}"/>
    <Parameter name="Cells" type="Array(int)" value="{6, 4}"/>
    <Parameter name="Element" type="string" value="Q2"/>
  </ParameterList>
  <ParameterList name="Material">
    <Parameter name="Young's Modulus" type="double" value="1"/>
    <Parameter name="Poisson's Ratio" type="double" value="0.3"/>
  </ParameterList>
  <ParameterList name="Dirichlet">
    <ParameterList name="bottom"><Parameter name="Y" type="double" value="0"/></ParameterList>
  </ParameterList>
  <ParameterList name="Traction">
    <ParameterList name="left"><Parameter name="X" type="string" value="0.01*(1 + y)"/></ParameterList>
  </ParameterList>
  <ParameterList name="Contact">
    <Parameter name="Side" type="string" value="right"/>
    <Parameter name="Gap" type="string" value="0.001*y"/>
    <Parameter name="Yield Stress" type="double" value="0.005"/>
    <ParameterList name="Sides">
      <ParameterList name="top">
        <ParameterList name="Obstacle">
          <Parameter name="Type" type="string" value="plane"/>
          <Parameter name="Point" type="Array(double)" value="{0, 1}"/>
          <Parameter name="Normal" type="Array(double)" value="{0.01, -1}"/>
        </ParameterList>
      </ParameterList>
    </ParameterList>
  </ParameterList>
</ParameterList>
"""


@dataclasses.dataclass(frozen=True)
class Scene:
    deck: str
    files: dict  # name -> bytes, the deck among them


# Of the square: the name of the mesh, and more of the list of the mesh.
SQUARE = """square:
  Mesh: {Type: gmsh, File: MESHMORE}
  Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.3}
  Dirichlet:
    top: {X: 0.0, Y: -0.01}
  Contact: {Side: bottom}
"""
PLANES = ', Sides: {bottom: {Plane: "y = 0"}, top: {Plane: "y = 1"}}'
SQUARES = SQUARE.replace("top: ", "right: ").replace("Side: bottom", "Side: floor")
BRICK = SQUARE.replace("Y: -0.01", "Y: 0.0, Z: -0.01")
BOX = BRICK.replace("MORE", ', Order: 1, Size: 0.7, Sides: {bottom: {Plane: "z = 0"}, top: {Near: [0.5, 0.5, 1.0]}}')
PIN = BRICK.replace("MORE", ", Order: 1, Size: 6, Sides: {bottom: {Surfaces: [2]}, top: {Surfaces: [3]}}")


def stl_of_box():
    """The surface of the unit cube in 12 triangles."""
    corner = [(k & 1, k >> 1 & 1, k >> 2) for k in range(8)]
    text = "solid box\n"
    for a, b, c, d in [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]:
        for triangle in ((a, b, c), (a, c, d)):
            text += "facet normal 0 0 0\nouter loop\n" + "".join("vertex %g %g %g\n" % corner[k] for k in triangle) + "endloop\nendfacet\n"
    return text + "endsolid box\n"


def replaced(text, *changes):
    """The text after (pattern, replacement) pairs, each of which must fit."""
    for pattern, replacement in changes:
        text, count = re.subn(pattern, replacement, text)
        assert count, pattern
    return text


def scenes(source):
    """All scenes by name, out of the source tree."""
    source = pathlib.Path(source)
    beam = (source / "input/beam.xml").read_text()
    manufactured = (source / "input/manufactured.xml").read_text()
    hertz = (source / "input/hertz.xml").read_text()
    decks = source / "test/verification/decks"
    layers = (decks / "layers.xml").read_text()
    data = source / "packages/mesh/test/data"
    coarse = r'\g<0>\n    <Parameter name="Size Factor" type="double" value="12"/>'

    beam = replaced(beam, (r"\{160, 32\}", "{10, 2}"))
    cube = replaced(beam, (r"\{0, 0\}", "{0, 0, 0}"), (r"\{5, 1\}", "{5, 1, 1}"), (r"\{10, 2\}", "{5, 2, 2}"))
    sparse = r'\g<0>\n    <Parameter name="Size Factor" type="double" value="25"/>'
    solid = replaced((source / "input/block.xml").read_text(), (r"\{12, 12, 6\}", "{2, 3, 2}"))
    ball, revolved = ((source / f"input/{name}.xml").read_text() for name in ("ball", "ball_axisymmetric"))
    mesh_decks = {"sector": SECTOR, "octant": replaced(SOLID, ("HELD", "flat"), ("CONTACT", "sphere")),
                  "bricks": replaced(SOLID, ("HELD", "held"), ("CONTACT", "contact")), "mixed": replaced(SOLID, ("HELD", "top"), ("CONTACT", "bottom"))}
    texts = {
        "beam.xml": [beam],
        "triangles.xml": [replaced(beam, ("Q1", "P2"))],
        "cube.xml": [cube],
        "manufactured.xml": [replaced(manufactured, (r"\{48, 16\}", "{6, 2}"))],
        "block.xml": [(decks / "block.xml").read_text()],
        "beam.yaml": [replaced((source / "test/regression/decks/beam.yaml").read_text(), (r"160, 32", "10, 2"))],
        "hertz.xml": [replaced(hertz, (r"<Parameter name=\"File\".*/>", coarse)), source / "input/hertz.geo"],
        "layers.xml": [layers, decks / "layers.geo"],
        "quads.xml": [replaced(layers, (r"layers\.geo", "layers_quads.geo")), decks / "layers_quads.geo"],
        "full.xml": [FULL, decks / "layers.geo"],
        "solid_block.xml": [solid],
        "tetrahedra.xml": [replaced(solid, ("Q2", "P2"))],
        "ball.xml": [replaced(ball, (r"<Parameter name=\"File\".*/>", sparse)), source / "input/ball.geo"],
        "ball_cut.xml": [replaced(ball, (r"<Parameter name=\"File\".*/>", sparse), (r"ball\.geo", "ball_cut.geo")),
                         ("ball_cut.geo", (source / "input/ball.geo").read_text() + "Mesh.SubdivisionAlgorithm = 2;\nMesh.ElementOrder = 1;\n")],
        "ball_axisymmetric.xml": [replaced(revolved, (r"<Parameter name=\"File\".*/>", sparse)), source / "input/ball_axisymmetric.geo"],
        "tube.xml": [TUBE],
        "sheet.xml": [replaced(beam, (r"<ParameterList name=\"Mesh\">", r'<Parameter name="Kinematics" type="string" value="plane stress"/>\n\g<0>'))],
    }
    for element in ("P1", "Q1", "P2", "Q2"):
        name = f"curved_{element}.msh"
        body = Body(Bricks((2, 2, 2) if element[1] == "2" else (3, 2, 3), element, cap(1.2, 1.0, 1.0)))
        texts[f"curved_{element}.xml"] = [CURVED.replace("MESH", name), (name, body.msh(1.0))]
    for mesh, deck, more in (("square_41.msh", SQUARE, ""), ("square_partitioned_41.msh", SQUARE, ""), ("square.unv", SQUARE, ""),
                             ("square.inp", SQUARE, ""), ("square.vtu", SQUARE, PLANES), ("two_squares.exo", SQUARES, ""),
                             ("two_squares_4.exo", SQUARES, ""), ("brick_20.exo", BRICK, ""), ("mixed.exo", BRICK, ""), ("mixed.inp", BRICK, "")):
        texts[f"{mesh.replace('.', '_')}.yaml"] = [deck.replace("MESH", mesh).replace("MORE", more), data / mesh]
    for mesh, deck, more in (("square.med", SQUARE, ""), ("square.vtk", SQUARE, PLANES)):
        texts[f"{mesh.replace('.', '_')}.yaml"] = [deck.replace("MESH", mesh).replace("MORE", more), data / mesh]
    for mesh, surfaces in (("cylinder.iges", (6, 5)), ("cylinder.brep", (2, 3))):
        deck = replaced(PIN, ("Size: 6", "Size Factor: 3.5"), (r"\[2\]", f"[{surfaces[0]}]"), (r"\[3\]", f"[{surfaces[1]}]"))
        texts[f"{mesh.replace('.', '_')}.yaml"] = [deck.replace("MESH", mesh), data / mesh]
    texts["pin_step.yaml"] = [PIN.replace("MESH", "pin.step"), source / "doc/tutorial/pin.step"]
    texts["box_stl.yaml"] = [BOX.replace("MESH", "box.stl"), ("box.stl", stl_of_box())]
    for mesh in sorted([*data.glob("*.msh"), *data.glob("*.geo")]):
        if mesh.name.startswith("square"):
            continue
        name = f"{mesh.stem}_geo.xml" if mesh.suffix == ".geo" else f"{mesh.stem}.xml"
        texts[name] = [mesh_decks[mesh.name.partition("_")[0].partition(".")[0]].replace("MESH", mesh.name), mesh]
    file = lambda given: (given.name, given.read_bytes()) if isinstance(given, pathlib.Path) else (given[0], given[1].encode())
    return {name: Scene(name, {name: text.encode(), **dict(map(file, files))}) for name, (text, *files) in texts.items()}
