# SPDX-License-Identifier: BSD-3-Clause
"""Whatever is wrong with the input: one message that names the parameter, the value and the rule, the right exit code,
and no file left. On several ranks only what has to be agreed upon among them."""

import re
import unittest

from rpc_run import BEAM, RANKS, SMALL, SOURCE, RpcTestCase, files, run_all

LEVELS = "Linear Solver->MueLu->coarse: max size=20"  # small meshes are solved directly by default

BAD_INPUT, BAD_MESH, NO_SOLUTION = 2, 3, 5

# (assignments, parts of the message)
ASSIGNMENTS = [
    # names
    (["Material->Youngs Modulus=3"], ['"Material->Youngs Modulus"', 'Did you mean "Young\'s Modulus"?']),
    (["Materail->Poisson's Ratio=0.2"], ['"Materail"', 'Did you mean "Material"?']),
    (["Yield Stress=3"], ['"Yield Stress"', "Valid here: Time, Kinematics, Units, Mesh, Material"]),
    (["Dirichlet->left->W=0"], ['"Dirichlet->left->W"', "X, Y, Z"]),
    (["Output=3"], ['"Output" is a sublist']),
    (["Dirichlet->left=3"], ['"Dirichlet->left" is a sublist']),
    (["Mesh->Type->A=3"], ['"Mesh->Type" is a parameter, not a sublist']),
    (["Contact"], ['"Sublist->Parameter=value"', 'got "Contact"']),
    (["=3"], ['"Sublist->Parameter=value"']),
    # types
    (["Material->Young's Modulus=stiff"], ['"Material->Young\'s Modulus" must be a double', '"stiff"']),
    (["Material->Young's Modulus="], ['"Material->Young\'s Modulus" must be a double', 'got ""']),
    (["Material->Young's Modulus=nan"], ['"Material->Young\'s Modulus" must be a double, and finite', '"nan"']),
    (["Material->Poisson's Ratio=nan"], ['"Material->Poisson\'s Ratio" must be a double, and finite']),
    (["Uzawa->Tolerance=nan"], ['"Uzawa->Tolerance" must be a double, and finite']),
    (["Uzawa->Maximum Iterations=2.5"], ['"Uzawa->Maximum Iterations" must be an int', '"2.5"']),
    (["Output->JSON=maybe"], ['"Output->JSON" must be a bool', '"maybe"']),
    (["Mesh->Cells=20"], ['"Mesh->Cells" must be an array of int, such as {160, 32}', '"20"']),
    (["Mesh->Cells={20,4"], ['"Mesh->Cells" must be an array of int', '"{20,4"']),
    (["Mesh->Cells={2.5,4}"], ['"Mesh->Cells" must be an array of int', '"{2.5,4}"']),
    (["Mesh->Cells={20000000000,4}"], ['"Mesh->Cells" must be an array of int']),
    (["Mesh->Lower={0,zero}"], ['"Mesh->Lower" must be an array of double', '"{0,zero}"']),
    (["Mesh->Upper={nan,1}"], ['"Mesh->Upper" must be an array of double', "all finite", '"{nan,1}"']),
    # units
    (["Units->Length=m m"], ['"Units->Length" must be a name of 1 to 12 characters without blanks', 'got "m m"', "such as mm"]),
    (["Units->Force=k,N"], ['"Units->Force" must be a name', 'got "k,N"', "such as kN"]),
    (["Units->Stress=MPa"], ['"Units->Stress"', "Length, Force"]),
    # mesh
    (["Mesh->Type=mesh"], ['"Mesh->Type" must be one of box, gmsh', '"mesh"']),
    (["Mesh->Type=gmsh"], ['"Mesh->Lower" does not go with "Mesh->Type" = gmsh']),
    (["Mesh->File=hertz.geo"], ['"Mesh->File" does not go with "Mesh->Type" = box']),
    (["Mesh->Element=Q7"], ['"Mesh->Element" must be one of', "Q1", '"Q7"']),
    (["Mesh->Cells={0,4}"], ['"Mesh->Cells" must be > 0', "got 0 in direction 1"]),
    (["Mesh->Cells={20,-4}"], ['"Mesh->Cells" must be > 0', "got -4 in direction 2"]),
    (["Mesh->Cells={2000000000,2000000000}"], ['"Mesh->Cells"', "nodes; at most"]),
    (["Mesh->Cells={20}"], ['"Mesh->Cells" must hold as many numbers as "Lower" and "Upper", 2, got 1']),
    (["Mesh->Upper={0,1}"], ['"Mesh->Upper" must be above "Mesh->Lower"', "0 and 0 in direction 1"]),
    (["Mesh->Upper={1e308,1}"], ['"Mesh->Upper" must be above "Mesh->Lower" by 1e-50 to 1e+50 [m]', "got 1e+308"]),
    (["Mesh->Lower={1e10,0}", "Mesh->Upper={10000000000.001,1}"], ['"Mesh->Cells": nodes must be at least 1e-12 times']),
    (["Mesh->Upper={5,-1}"], ['"Mesh->Upper" must be above "Mesh->Lower"', "0 and -1 in direction 2"]),
    # material
    (["Material->Young's Modulus=0"], ['"Material->Young\'s Modulus" must be > 0', "[Pa]", "got 0"]),
    (["Material->Young's Modulus=-1"], ['"Material->Young\'s Modulus" must be > 0', "got -1"]),
    (["Material->Poisson's Ratio=0.5"], ['"Material->Poisson\'s Ratio" must be in (-1, 0.5)', "got 0.5"]),
    (["Material->Poisson's Ratio=-1"], ['"Material->Poisson\'s Ratio" must be in (-1, 0.5)', "got -1"]),
    # kinematics
    (["Kinematics=plane"], ['"Kinematics" must be one of plane strain, plane stress, axisymmetric', '"plane"']),
    (["Kinematics=axisymmetric", "Mesh->Lower={0,0,0}", "Mesh->Upper={5,1,1}", "Mesh->Cells={4,4,4}"],
     ['"Kinematics" = axisymmetric is for plane meshes', "Remove it"]),
    # fields
    (["Contact->Yield Stress=0"], ['"Contact->Yield Stress" must be > 0 [Pa]', "got 0"]),
    (["Contact->Yield Stress=-inf"], ['"Contact->Yield Stress" must be > 0 [Pa]', "got -inf"]),
    (["Contact->Yield Stress=nan"], ['"Contact->Yield Stress"', "not a number"]),
    (["Contact->Yield Stress="], ['"Contact->Yield Stress"', "empty"]),
    (["Contact->Yield Stress=16+*2"], ['"Contact->Yield Stress" = "16+*2"', "at character 4", "Variables: x, y, z"]),
    (["Contact->Yield Stress=2*s"], ['"Contact->Yield Stress" = "2*s"', '"s"', "Variables: x, y, z, t"]),
    (["Contact->Gap=inf"], ['"Contact->Gap" = "inf" must be a finite number']),
    (["Contact->Obstacle->Centre={2.6,-3}", "Contact->Obstacle->Radius=0.05"],
     ['"Contact->Obstacle" has a "Centre" and no "Type"', "no obstacle", "none, plane, "]),
    (["Time=2", "Steps->Times={1, 2}"], ['"Time" = 2 does not go with "Steps"']),
    (["Kinematics=axisymmetric", "Traction->left->Y=1"], ['"Traction->left" acts nowhere', '"left" lies on the axis']),
    (["Steps->Times={1}", "Steps->Energy Tolerance=0"], ['"Steps->Energy Tolerance" must be > 0', "got 0"]),
    (["Steps->From=1", "Steps->To=2"], ['"Steps->From", "To" and "Step" belong together', "got 1, 2 and nan"]),
    (["Steps->From=1", "Steps->To=1", "Steps->Step=1"], ['"Steps->To" must be finite and > "From" = 1', "got 1"]),
    (["Steps->From=1", "Steps->To=2", "Steps->Step=-1"], ['"Steps->Step" must be > 0', "got -1"]),
    (["Steps->From=1", "Steps->To=2", "Steps->Step=1", "Steps->Times={1}"], ['"Steps" has "Times" and "From"']),
    (["Contact->Penalty=0"], ['"Contact->Penalty" must be `auto` or a finite number > 0', "[Pa/m]", "got 0"]),
    (["Dirichlet->left->Z=0"], ['"Dirichlet->left->Z"', "2D", "It has X and Y"]),
    (["Traction->top->Z=3"], ['"Traction->top->Z" must be 0 in 2D', "got 3. A plane mesh has X and Y"]),
    # adaptive meshes
    (["Adapt->Target Relative Error=1"], ['"Adapt->Target Relative Error" must be in (0, 1), or 0 for none', "got 1"]),
    (["Adapt->Target Relative Error=-0.1"], ['"Adapt->Target Relative Error" must be in (0, 1)', "got -0.1"]),
    (["Adapt->Max Dofs=0"], ['"Adapt->Max Dofs" must be > 0', "got 0"]),
    (["Adapt->Max Cycles=-2"], ['"Adapt->Max Cycles" must be > 0', "got -2"]),
    (["Adapt->Meshes=fine"], ['"Adapt->Meshes" must be one of automatic, gmsh, nested', '"fine"']),
    (["Adapt->Exact Energy=inf"], ['"Adapt->Exact Energy" must be a double, and finite', '"inf"']),
    # solvers
    (["Uzawa->Tolerance=-1"], ['"Uzawa->Tolerance" must be in (0, 1)', "got -1"]),
    (["Uzawa->Maximum Iterations=0"], ['"Uzawa->Maximum Iterations" must be > 0', "got 0"]),
    (["Uzawa->Stopping Test=none"], ['"Uzawa->Stopping Test" must be one of optimality, multiplier change', '"none"']),
    (["NOX->Step Tolerance=-1"], ['"NOX->Step Tolerance" must be > 0', "got -1"]),
    (["NOX->Residual Tolerance=0"], ['"NOX->Residual Tolerance" must be > 0', "got 0"]),
    (["NOX->Maximum Iterations=0"], ['"NOX->Maximum Iterations" must be > 0', "got 0"]),
    (["NOX->Direction->Method=Broyden"], ['"NOX->Direction->Method" must be one of Active Set, Sweep, Newton', '"Broyden"', "Jacobian"]),
    (["NOX->Direction->Method=Steepest Descent"], ['"NOX->Direction->Method" must be one of', '"Steepest Descent"']),
    (["NOX->Line Search->Method=Safeguarded Step"],
     ['"NOX->Line Search->Method" must be one of Exact, Full Step, Backtrack', '"Safeguarded Step"', "vector"]),
    (["Linear Solver->Tolerance=-1e-8"], ['"Linear Solver->Tolerance" must be in (0, 1)', "got -1e-08"]),
    (["Linear Solver->Maximum Iterations=0"], ['"Linear Solver->Maximum Iterations" must be > 0', "got 0"]),
    (["Linear Solver->Reuse=all"], ['"Linear Solver->Reuse" must be one of tP, none, RP', '"all"']),
    (["Linear Solver->Method=Gauss"], ['"Linear Solver->Method"', '"Gauss"', "It knows:", "PSEUDOBLOCK CG"]),
    (["Linear Solver->Method=LSQR"], ['"Linear Solver->Method" cannot be "LSQR"', "no bound on the residual"]),
    (["Linear Solver->Method=Hybrid Block GMRES"],
     ['"Linear Solver->Method" cannot be "Hybrid Block GMRES"', "no bound on the residual", "BICGSTAB"]),
    (["Linear Solver->Belos->Verbose=3"], ['"Linear Solver->Belos->Verbose"', 'Did you mean "Verbosity"?']),
    (["Linear Solver->Belos->Verbosity=abc"], ['"Linear Solver->Belos"', '"Verbosity"', '"string"']),
    (["Linear Solver->Belos->Orthogonalisation=DGKS"],
     ['"Linear Solver->Belos->Orthogonalisation"', 'Did you mean "Orthogonalization"?']),
    (["Linear Solver->Belos->Orthogonalization=QR"], ['"Linear Solver->Belos"', "Invalid orthogonalization manager name"]),
    (["Linear Solver->Belos->Num Blocks=0"], ['"Linear Solver->Belos"', '"Num Blocks" must be strictly positive']),
    (["Linear Solver->Method=BiCGStab", "Linear Solver->Belos->Orthogonalization=DGKS"],
     ['unknown parameter "Linear Solver->Belos->Orthogonalization"']),
    (["Linear Solver->Method=Block CG", "Linear Solver->Belos->Block Size=-3"],
     ['"Linear Solver->Belos"', '"Block Size" must be strictly positive']),
    (["Linear Solver->MueLu->smoother: tipe=RELAXATION"],
     ['"Linear Solver->MueLu->smoother: tipe"', 'Did you mean "smoother: type"?']),
    (["Linear Solver->MueLu->smoother: params->chebyshev: degre=3"],
     ['"Linear Solver->MueLu->smoother: params->chebyshev: degre"', 'Did you mean "chebyshev: degree"?']),
    (["Linear Solver->MueLu->smoother: params->chebyshev: degree=two"],
     ['"Linear Solver->MueLu->smoother: params"', '"chebyshev: degree"', '"int"']),
    (["Linear Solver->MueLu->coarse: params->fix nulspace=true"],
     ['"Linear Solver->MueLu->coarse: params->fix nulspace"', 'Did you mean "fix nullspace"?']),
    (["Linear Solver->MueLu->max levels=many"], ['"Linear Solver->MueLu"', '"max levels"', 'correct type is "int"']),
    (["Linear Solver->MueLu->max levels=0"], ['"Linear Solver->MueLu->max levels" must be > 0', "got 0"]),
    (["NOX->Line Serach->Method=Exact"], ['"NOX->Line Serach"', 'Did you mean "Line Search"?']),
]

# The same, where the ranks have to agree on what is wrong: what each of them finds by itself, and what those alone find that have the node.
EACH_RANK_FINDS = [
    (["Kinematics=plane stress", "Material->Dilatation=projected"],
     ['"Material->Dilatation" = projected', "plane stress", "Take auto or full"]),
    (["Contact->Side=" + "n" * 10000], ['"Contact->Side" names the side "nnn', "nnn [...] nnn", "left, right, bottom, top"]),
    (["Contact->Side=a\nb\x1b[31mc"], ['names the side "a?b?[31mc"']),
    (["Material->Young's Modulus=-3"], ['"Material->Young\'s Modulus" must be > 0', "got -3"]),
    (["Adapt->Error Bound=guaranteed", "Traction->top->Y=x > 0.6 ? -20 : 0"], ['"Traction->top" is not, at (0.', "smooth within each cell"]),
    (["Adapt->Error Bound=guaranteed", "Traction->top->Y=x > 4.4 ? -20 : 0"], ['"Traction->top" is not, at (4.', "smooth within each cell"]),
    (["Contact->Obstacle->Type=circle", "Contact->Obstacle->Centre={2.6/t,-1}", "Contact->Obstacle->Radius=1",
      "Contact->Friction Coefficient=0.3"],
     ['"Contact->Obstacle": the motion along the side counts from t = 0', '"Centre" is inf [m]', "finite at t = 0"]),
    (["Contact->Side=nowhere"], ['"Contact->Side"', '"nowhere"', "left, right, bottom, top"]),
    (["Traction->roof->Y=3"], ['"Traction->roof" names the side "roof"', '"roof"', "left, right, bottom, top"]),
    (["Dirichlet->hinge->Y=0"], ['"Dirichlet->hinge" names the side "hinge"', '"hinge"', "left, right, bottom, top"]),
    (["Mesh->Upper={1e200,1e200}"], ['"Mesh->Upper" must be above "Mesh->Lower" by 1e-50 to 1e+50 [m]', "got 1e+200 in direction 1"]),
    (["NOX->Line Search->Method=Guess"], ['"NOX->Line Search->Method" must be one of Exact', 'got "Guess"']),
    (["NOX->Line Search->Metod=Exact"], ['"NOX->Line Search->Metod"']),
    (["NOX->Line Search->Method=3"], ['"NOX->Line Search->Method" must be one of Exact', 'got "3"']),
    (["NOX->Printing->Output Information=much"], ['"NOX"', '"Output Information"']),
    (["NOX->Status Tests->Test Type=Guess"], ['"NOX"', '"Guess"']),
    ([LEVELS, "Linear Solver->MueLu->smoother: type=SANDPAPER"], ['"Linear Solver->MueLu"', "'SANDPAPER'"]),
    ([LEVELS, "Linear Solver->MueLu->multigrid algorithm=guess"], ['"Linear Solver->MueLu"', '"guess"']),
]
SOME_RANKS_FIND = [
    (["Kinematics=axisymmetric", "Dirichlet->left->X=1"], ['"Dirichlet->left->X" must be 0 on the axis', "got 1", "(0, "]),
    (["Mesh->Lower={0,0,0}", "Mesh->Upper={5,1,1}", "Mesh->Cells={880,880,880}"],
     ['"Mesh->Cells" give a rank', "nodes, which take at least", "GiB", "Use fewer cells"]),
    (["Contact->Obstacle->Type=circle", "Contact->Obstacle->Centre={2.6,-3}", "Contact->Obstacle->Radius=0.05",
      "Contact->Normal=0, -1"],
     ['"Contact"', 'of side "bottom"', "does not lead into the obstacle, nor from any other node", '"Normal" = foundation']),
    (["Dirichlet->top->X=1"], ['"Dirichlet->left" and "Dirichlet->top" prescribe different X', "(0, 1)", "0 and 1 [m]"]),
    (["Dirichlet->right->Y=y/0"], ['"Dirichlet->right->Y" = "y/0" must be a finite number', "got nan at (5, 0)"]),
    (["Contact->Yield Stress=4-x"], ['"Contact->Yield Stress" must be > 0 [Pa]', '"4-x" at (4, 0)', "got 0"]),
    (["Contact->Yield Stress=sqrt(4.1-x)"], ['"sqrt(4.1-x)"', "got nan at (4.25, 0)"]),
    (["Contact->Gap=1/x"], ['"Contact->Gap" = "1/x" must be a finite number', "got inf at (0, 0)"]),
    (["Traction->top->Y=log(4.5-x)"], ['"Traction->top->Y" = "log(4.5-x)" must be a finite number', "got nan at (4.", ", 1)"]),
    (["Traction->top->Y=1/(x>4)"], ['"Traction->top->Y" = "1/(x>4)" must be a finite number', "got inf at (0.", ", 1)"]),
    (["Body Force->Y=1/(x<4)"], ['"Body Force->Y" = "1/(x<4)" must be a finite number', "got inf at (4."]),
    (["Traction->top->Y=-1e300"], ['the forces of "Traction->top": ', "in direction Y of the node at (", "units"]),
    (["Body Force->Y=-1e300*(1+x)"], ['the forces of "Body Force": ', "in direction Y of the node at ("]),
    (["Material->Young's Modulus=1e308"], ["not finite appeared first in the stiffness matrix", "node at (", "units"]),
    (["Material->Young's Modulus=1e300"], ["squares overflow appeared first in the stiffness matrix", "node at ("]),
    (["Dirichlet->left->X=1e300"], ['the displacements that "Dirichlet" prescribes', "1e+300 in direction X of the node at (0, "]),
    (["Dirichlet->left->X=1e153", "Material->Young's Modulus=1e10"], ["forces of prescribed displacements"]),
]


def beam(old="", new=""):
    """The beam's deck with a piece replaced."""
    text = BEAM.read_text()
    assert old in text, old
    return text.replace(old, new).encode()


E = """name="Young's Modulus" type="double" value="2000\""""

NU = """<Parameter name="Poisson's Ratio" type="double" value="0.3"/>"""

# (file name, content, parts of the message)
DECKS = [
    ("empty.xml", b"", ['empty.xml" is empty']),
    ("truncated.xml", BEAM.read_bytes()[:700], ["truncated.xml"]),
    ("binary.xml", bytes(range(256)), ["binary.xml"]),
    ("zeros.xml", bytes(300), ["zeros.xml"]),
    ("words.xml", b"hello", ["words.xml", "line 1"]),
    ("html.xml", b"<html></html>", ["html.xml", "expected tag ParameterList"]),
    ("empty.yaml", b"", ['empty.yaml" is empty']),
    ("binary.yaml", bytes(range(256)), ["binary.yaml"]),
    ("open.yaml", b"beam:\n  Mesh: {Type: box", ["open.yaml"]),
    ("deep.xml", b'<ParameterList name="n">' * 20000, ['deep.xml": lists within lists must not be deeper than 100']),
    ("deep.yaml", b"a: " + b"{a: " * 20000, ['deep.yaml": lists within lists must not be deeper than 100']),
    ("twice.xml", beam("Upper", "Lower"), ['"Mesh->Lower" is given twice']),
    ("misspelt.xml", beam("Yield Stress", "Yeild Stress"), ['"Contact->Yeild Stress"', 'Did you mean "Yield Stress"?']),
    ("comma.xml", beam('"0.3"', '"0,3"'), ['comma.xml", line 12: "Material->Poisson\'s Ratio" = "0,3"', "Write 0.3: decks have a decimal point"]),
    ("unit.xml", beam('value="2000"', 'value="210 GPa"'), ['unit.xml", line 11:', '"210 GPa"', 'without "GPa"', "2.1e+11 with m and N, 210000 with mm and N"]),
    ("half.xml", beam('"0.3"', '"0.5"'), ['half.xml", line 12: "Material->Poisson\'s Ratio" must be in (-1, 0.5), got 0.5', "write 0.4999", "Q2 or Q1"]),
    ("side.xml", beam('"bottom"', '"Bottom"'), ['side.xml", line 30: "Contact->Side" names the side "Bottom"', 'Did you mean "bottom"?']),
    ("other.xml", beam("Young's Modulus", "E"), ['other.xml", line 11: unknown parameter "Material->E"', 'Did you mean "Young\'s Modulus"?']),
    ("place.xml", beam("Poisson's Ratio", "Yield Stress"), ['place.xml", line 12:', 'parameter of another list: "Contact->Yield Stress"']),
    ("tag.xml", beam('value="bottom"/>', 'value="bottom">'), ['tag.xml", line 30: <Parameter name="Side"> is not closed', 'End it with "/>"']),
    ("tabs.yaml", b"beam:\n\tMesh:\n", ['tabs.yaml", line 2: a tab', "two for each level"]),
    ("sideless.xml", beam('<Parameter name="Side" type="string" value="bottom"/>'), ['"Contact->Yield Stress" acts nowhere', 'no "Side"']),
    ("text.xml", beam(E, E.replace("2000", "stiff")), ['"Material->Young\'s Modulus" = "stiff"', "double"]),
    ("nan.xml", beam(E, E.replace("2000", "nan")), ['"Material->Young\'s Modulus" must be a double, and finite', "nan"]),
    ("type.xml", beam(E, E.replace("double", "string")), ['"Material->Young\'s Modulus" must be a double', "string"]),
    ("flat.xml", beam(E, E.replace("double", "Array(double)").replace("2000", "{2000}")), ["Young's", "array of double"]),
    ("cells.xml", beam("{160, 32}", "{160, 3.2}"), ['"Mesh->Cells" = "{160, 3.2}"', "Array(int)"]),
    ("modulus.xml", beam("<Parameter " + E + "/>"), ['"Material->Young\'s Modulus" must be given, > 0 and finite [Pa]', 'Add it to "Material"']),
    ("ratio.xml", beam(NU), ['"Material->Poisson\'s Ratio" must be given, in (-1, 0.5)']),
    ("immaterial.xml", re.sub(rb'<ParameterList name="Material">.*?</ParameterList>', b"", BEAM.read_bytes(), flags=re.S),
     ['"Material->Young\'s Modulus" must be given']),
    ("block.xml", beam(NU, NU + '<ParameterList name="Blocks"><ParameterList name="body"><Parameter ' + E + "/></ParameterList></ParameterList>"),
     ['"Material->Blocks->body->Poisson\'s Ratio" must be given']),
    ("forceless.xml", beam('<ParameterList name="Traction">', '<ParameterList name="Traction"><ParameterList name="bottom"/>'),
     ['"Traction->bottom" has no force', "[Pa]"]),
    ("nothing.xml", beam('<Parameter name="X" type="double" value="0"/>', "").replace(
        b'<Parameter name="Y" type="double" value="0"/>', b""), ['"Dirichlet->left" prescribes nothing']),
]


CHECKS = ([], ["--check"]) if RANKS == 1 else ([],)


def every(several):
    """All cases on one rank, on several ranks each so-many-th, for there they are found in the same way."""
    return 1 if RANKS == 1 else several


class BadInput(RpcTestCase):
    def expect_refusals(self, cases):
        """Runs (name, arguments, code, parts) and expects a refusal of each that leaves nothing behind."""
        jobs = []
        for index, (_, arguments, _, _) in enumerate(cases):
            folder = self.folder / f"run{index}"
            folder.mkdir()
            jobs.append((arguments, folder))
        for (name, _, code, parts), (_, folder), result in zip(cases, jobs, run_all(jobs)):
            with self.subTest(name):
                self.expect_refusal(result, code, parts)
                self.assertEqual(files(folder), [])

    def expect_bad_assignments(self, cases, *options):
        self.expect_refusals([(", ".join(assignments),
                               [*options, "--input=beam.xml", SMALL, "--output=out", *(f"--set={a}" for a in assignments)],
                               BAD_INPUT, parts) for assignments, parts in cases])

    @unittest.skipIf(RANKS > 1, "needs one rank: found before anything is shared")
    def test_assignment_is_refused(self):
        self.expect_bad_assignments(ASSIGNMENTS)

    def test_assignment_is_refused_on_all_ranks(self):
        self.expect_bad_assignments([*EACH_RANK_FINDS[::every(3)], *SOME_RANKS_FIND])

    def test_check_finds_what_a_run_finds_before_its_first_solve(self):
        cases = [case for case in [*EACH_RANK_FINDS, *SOME_RANKS_FIND] if LEVELS not in case[0]]
        self.expect_bad_assignments(cases[::every(5)], "--check")

    def test_deck_is_refused(self):
        cases = []
        for name, content, parts in DECKS if RANKS == 1 else DECKS[:4]:
            (self.folder / name).write_bytes(content)
            cases.append((name, [f"--input={self.folder / name}", "--output=out"], BAD_INPUT, parts))
        self.expect_refusals(cases)

    def test_deck_that_cannot_be_read_is_refused(self):
        cases = [("missing", ["--input=missing.xml"], BAD_INPUT, ['there is no file "missing.xml"', "searched:"]),
                 ("folder", [f"--input={self.folder}"], BAD_INPUT, [f'"{self.folder}" is a folder'])]
        self.expect_refusals(cases if RANKS == 1 else cases[:1])

    def test_output_below_a_file_is_refused_before_the_run(self):
        (self.folder / "file").write_text("")
        for name in ["file", "file/below"]:
            result = self.rpc("--input=beam.xml", SMALL, f"--output={name}", code=BAD_INPUT)
            self.expect_refusal(result, BAD_INPUT, ["output:", f'"{name}"', "--output=DIR"])
            self.assertNotIn("newton", result.stdout)
        self.assertEqual(files(self.folder), ["file"])

    def test_pressing_into_a_rigid_foundation_has_no_solution(self):
        self.expect_refusals([("press", [*check, "--input=beam.xml", SMALL, "--set=Contact->Yield Stress=inf",
                                         "--set=Dirichlet->right->Y=-0.1", "--output=out"],
                               NO_SOLUTION, ['side "bottom"', "rigid", "(5, 0)", "0.1 [m]"]) for check in CHECKS])

    def test_what_nothing_holds_has_no_solution(self):
        free = self.folder / "free.xml"
        free.write_bytes(re.sub(rb'  <ParameterList name="Dirichlet">.*?\n  </ParameterList>\n', b"", BEAM.read_bytes(),
                                flags=re.S))
        block = f"--input={SOURCE / 'test' / 'verification' / 'decks' / 'block.xml'}"
        cases = [
            ([f"--input={free}", SMALL], ['nothing holds the body against translation along (1, 0). Prescribe']),
            ([block, "--set=Traction->top->Y=-10.1"],
             ['the load pushes the body against side "bottom" with a resultant of 10.1 [N/m] along (0, -1)',
              "carries at most 10 [N/m]", '"Contact->Yield Stress"']),
            ([block, "--set=Traction->top->Y=1"], ["pulls the body away from the foundation", "1 [N/m] along (0, 1)"]),
            ([block, "--set=Traction->top->Y=0", "--set=Contact->Gap=0.1"],
             ["nothing presses the body on the foundation against a translation along (0, 1)", '"Dirichlet"']),
            ([block, "--set=Contact->Side="], ["nothing holds the body against translation along (0, 1)", "-4 [N/m]"]),
        ]
        self.expect_refusals([(parts[0], [*check, *arguments, "--output=out"], NO_SOLUTION, parts)
                              for arguments, parts in cases for check in CHECKS])

    @unittest.skipIf(RANKS == 1, "needs several ranks: there are to be more of them than cells")
    def test_more_ranks_than_cells_is_a_bad_mesh(self):
        self.expect_refusals([("mesh", [*check, "--input=beam.xml", "--set=Mesh->Cells={1,1}", "--output=out"], BAD_MESH,
                               ["1 x 1 cells cannot be divided among", "Use fewer ranks or more cells"]) for check in CHECKS])

    @unittest.skipIf(RANKS > 1, "needs one rank: every rank reads the deck")
    def test_nodes_beyond_the_axis_are_a_bad_mesh(self):
        self.expect_refusals([("axis", ["--input=beam.xml", SMALL, "--set=Kinematics=axisymmetric", "--set=Mesh->Lower={-1,0}",
                                        "--output=out"], BAD_MESH, ["node at (-1, ", "beyond the axis", "x >= 0"])])

    @unittest.skipIf(RANKS > 1, "needs one rank: every rank reads the deck")
    def test_a_mesh_of_surfaces_in_space_is_no_body(self):
        (self.folder / "skin.msh").write_text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 1\n$EndNodes\n"
                                              "$Elements\n1\n1 2 2 1 0 1 2 3\n$EndElements\n")
        (self.folder / "skin.yaml").write_text("skin:\n  Mesh: {Type: gmsh, File: skin.msh}\n"
                                               "  Material: {Young's Modulus: 1.0, Poisson's Ratio: 0.3}\n  Dirichlet: {top: {Z: 0.0}}\n")
        self.expect_refusals([("skin", [f"--input={self.folder / 'skin.yaml'}", "--output=out"], BAD_MESH,
                               ['skin.msh": has no volumes', "node 3 at (0, 1, 1) is off the plane", 'Physical Volume("body")'])])

    @unittest.skipIf(RANKS > 1, "needs one rank: every rank reads the deck")
    def test_truncated_deck_is_never_an_internal_error(self):
        whole = BEAM.read_bytes()
        jobs = []
        for length in range(0, len(whole) + 97, 97):
            path = self.folder / f"{length}.xml"
            path.write_bytes(whole[:length])
            jobs.append((["--check", f"--input={path}"], self.folder))
        results = run_all(jobs)
        for result in results[:-1]:
            with self.subTest(result.args):
                self.expect_refusal(result, BAD_INPUT, [".xml"])
        self.assertEqual(results[-1].returncode, 0, results[-1].stderr)

    @unittest.skipIf(RANKS > 1, "needs one rank: every rank reads the deck")
    def test_damaged_deck_is_never_an_internal_error(self):
        whole = BEAM.read_bytes()
        jobs = []
        for place in range(60, len(whole), 97):  # another character each time, over markup and values alike
            path = self.folder / f"{place}.xml"
            path.write_bytes(whole[:place] + bytes([33 + place % 90]) + whole[place + 1:])
            jobs.append((["--check", f"--input={path}"], self.folder))
        for result in run_all(jobs):
            with self.subTest(result.args):
                self.assertIn(result.returncode, (0, BAD_INPUT, BAD_MESH, NO_SOLUTION), result.stderr)
                if result.returncode:
                    self.expect_refusal(result, result.returncode, [])


if __name__ == "__main__":
    unittest.main()
