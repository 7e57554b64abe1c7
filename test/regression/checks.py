# SPDX-License-Identifier: BSD-3-Clause
"""What a run says of decks that are right and seldom meant, on the console and in the summary; and what --check finds without a solve."""

import json
import shutil
import subprocess
import unittest

from rpc_run import RANKS, SMALL, SOURCE, RpcTestCase, errors, files

BODY = """
  Mesh: {Lower: [0.0, 0.0], Upper: [1.0, 1.0], Cells: [4, 4]}
  Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.3}
  Output: {Exodus: false, CSV: false}
"""
PRESSED = BODY + "  Dirichlet: {top: {X: 0.0, Y: -0.01}}\n"
HELD = BODY + "  Dirichlet: {top: {X: 0.0, Y: 0.0}}\n"
RISING = '  Contact: {Side: bottom, Obstacle: {Type: plane, Point: ["0", "3*(t - 1)"], Normal: [0.0, 1.0]}}\n  Steps: {Times: [1.0, 1.1, 2.0, 3.0]}\n'
NOTHING = "nothing happens"
OVERLAP, PATH = "overlaps the body by", "friction depends on the path"


class Seldom(RpcTestCase):
    def notes(self, text, *arguments):
        """Those of a deck's run, each of which the console has told once too."""
        (self.folder / "deck.yaml").write_text("deck:" + text)
        result = self.rpc("--input=deck.yaml", "--output=out", *arguments)
        notes = json.loads((self.folder / "out" / "deck.json").read_text())["notes"]
        told = [line for line in result.stdout.splitlines() if line.startswith("note: ")]
        for line in told:
            self.assertIn(line[len("note: "):], notes)
        self.assertEqual(len(told), len(set(told)))
        self.told = told
        if RANKS == 1:
            self.checked()
        return notes

    def checked(self):
        """What the check of the last deck tells: of the notes of its run those that need no solve."""
        told = self.rpc("--check", "--input=deck.yaml").stdout
        for line in told.splitlines():
            if line.startswith("note: "):
                self.assertIn(line, self.told)
        return told

    def test_nothing_touches(self):
        self.assertEqual(self.notes(PRESSED + "  Contact: {Side: bottom, Gap: 1.0}\n"), ["no point touches: the smallest gap that is left is 0.99 [m]"])
        self.assertEqual(len(self.told), 1)
        self.assertEqual(self.notes(PRESSED + "  Contact: {Side: bottom, Gap: 1.0}\n  Units: {Length: mm, Force: N}\n"),
                         ["no point touches: the smallest gap that is left is 0.99 [mm]"])
        self.assertEqual(self.notes(PRESSED + "  Contact: {Side: bottom, Gap: 0.005}\n"), [])

    def test_nothing_touches_at_any_of_several_steps(self):
        steps = "  Contact: {Side: bottom, Gap: GAP}\n  Steps: {Times: [1.0, 2.0, 3.0]}\n"
        down_and_up = BODY + '  Dirichlet: {top: {X: 0.0, Y: "-0.01*(2 - abs(t - 2))"}}\n' + steps
        self.assertIn("no point touches at any step: the smallest gap that is left is 0.08 [m]", self.notes(down_and_up.replace("GAP", "0.1")))
        self.assertNotIn("no point touches", str(self.notes(down_and_up.replace("GAP", "0.015"))))  # the second step does

    def test_contact_that_the_mesh_misses_in_a_part_of_a_step_or_before_a_restart(self):
        """Half-way through its one step a narrow bump reaches into the body, which touches beside it before and after."""
        deck = """
  Mesh: {Lower: [0.0, 0.0], Upper: [1.0, 1.0], Cells: [4, 4], Element: P2}
  Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.3}
  Dirichlet: {top: {X: 0.0, Y: "-0.02*t"}}
  Contact: {Side: bottom, Normal: "0, -1", Gap: "(x > 0.749 ? 0.004 : 0.05) - 0.07*max(0, 1 - 4*abs(t - 0.5))*exp(-((x - 0.3125)/0.02)^2)"}
  Output: {Exodus: false, CSV: false}
"""
        missed = "at t = 0.5: unseen contact: "
        self.assertIn(missed + "at (0.3125, 0)", str(self.notes(deck + "  Steps: {Times: [1.0], Energy Tolerance: 0.1}\n")))
        self.assertNotIn("unseen contact", str(self.notes(deck + "  Steps: {Times: [0.25, 1.0]}\n")))  # nobody has looked
        steps = deck + "  Steps: {Times: [0.5, 0.9], Checkpoint Every: 1}\n"
        self.assertIn(missed + "at (0.3125, 0)", str(self.notes(steps)))
        (self.folder / "deck.yaml").write_text("deck:" + steps.replace("0.9]", "0.9, 1.0]"))
        again = self.rpc("--input=deck.yaml", "--output=out", "--restart").stdout
        self.assertIn(missed + "a contact side lay 0.03 [m] inside the foundation", again)
        self.assertIn("the run before the restart says where", again)

    def test_nothing_loads_the_body(self):
        for gap in ("0.1", "0.0"):
            notes = self.notes(HELD + f"  Contact: {{Side: bottom, Gap: {gap}}}\n  Traction: {{right: {{X: 0.0}}}}\n")
            self.assertEqual(notes, ["no load, no prescribed displacement but 0 and no contact point in a foundation: nothing happens"])
        notes = self.notes(HELD + '  Contact: {Side: bottom}\n  Body Force: {Y: "0*t"}\n  Steps: {Times: [1.0, 2.0]}\n')
        self.assertEqual(len(notes), 1)
        self.assertIn(NOTHING, notes[0])
        for loaded in ("  Contact: {Side: bottom, Gap: -0.001}\n", "  Contact: {Side: bottom}\n  Body Force: {Y: -1.0}\n",
                       '  Contact: {Side: bottom}\n  Traction: {left: {X: "t - 1"}}\n  Steps: {Times: [1.0, 2.0]}\n'):
            self.assertNotIn(NOTHING, str(self.notes(HELD + loaded)))

    def test_an_obstacle_reaches_through_the_body(self):
        plane = "  Contact: {Side: bottom, Obstacle: {Type: plane, Point: [0.0, HEIGHT], Normal: [0.0, 1.0]}}\n"
        notes = self.notes(HELD + plane.replace("HEIGHT", "5.0"))
        self.assertEqual([note for note in notes if OVERLAP in note],
                         ['the obstacle of "Contact" overlaps the body by 5 [m], more than the body is thick along the contact normal (1 [m]): '
                          "does it lie where it should?"])
        self.assertIn(OVERLAP, self.checked())
        self.assertNotIn(OVERLAP, str(self.notes(HELD + plane.replace("HEIGHT", "0.9"))))
        self.assertIn('the foundation of "Contact" overlaps the body by 1.5 [m]', str(self.notes(HELD + "  Contact: {Side: bottom, Gap: -1.5}\n")))

    def test_an_obstacle_that_moves_reaches_through_the_body_at_one_of_the_steps(self):
        notes = [note for note in self.notes(HELD + RISING) if OVERLAP in note]
        self.assertEqual(len(notes), 1)
        self.assertTrue(notes[0].startswith('at t = 2: the obstacle of "Contact" overlaps the body by 3 [m]'), notes)
        lifted = BODY + '  Dirichlet: {top: {X: 0.0, Y: "3*(t - 1) - 0.001"}}\n' + RISING
        self.assertNotIn(OVERLAP, str(self.notes(lifted)))

    def test_one_step_does_not_know_the_path_of_friction(self):
        for law in ("Friction Coefficient: 0.3", "Friction Bound: 0.1"):
            contact = f"  Contact: {{Side: bottom, {law}}}\n"
            notes = self.notes(PRESSED + contact)
            self.assertEqual(len(notes), 1)
            self.assertIn(PATH, notes[0])
            self.assertIn('"Steps->Times"', notes[0])
            self.assertEqual(self.notes(PRESSED + contact + "  Steps: {Times: [0.5, 1.0]}\n"), [])
        self.assertEqual(self.notes(PRESSED + "  Contact: {Side: bottom}\n"), [])

    def test_a_list_of_conditions_has_none(self):
        notes = self.notes(BODY + "  Dirichlet: {}\n  Traction: {}\n  Contact: {Side: bottom, Stiffness: 1.0e+5, Friction Bound: 1.0}\n"
                           "  Body Force: {Y: -1.0}\n")
        self.assertIn('"Dirichlet" of the deck has no entries: nothing is held by it', notes)
        self.assertIn('"Traction" of the deck has no entries: nothing is loaded by it', notes)

    def test_no_contact_is_asked_for(self):
        self.assertEqual(self.notes(PRESSED), ['the deck has no "Contact": the body meets no foundation. "Contact->Side" names the side that may touch one'])
        self.assertEqual(self.notes(PRESSED + '  Contact: {Side: ""}\n'), [])  # switched off

    def test_a_foundation_yields_beyond_what_a_body_bears(self):
        contact = "  Units: {Length: mm, Force: N}\n  Contact: {Side: bottom, Yield Stress: LIMIT}\n"
        (note,) = self.notes(PRESSED + contact.replace("LIMIT", "80.0e+6"))
        self.assertTrue(note.startswith('"Contact->Yield Stress" = 8e+07 [MPa] is 80000 of the body\'s Young\'s modulus, 1000 [MPa]'), note)
        for limit in ("99.0", "inf", "'1.0e+6 + x'"):
            self.assertEqual(self.notes(PRESSED + contact.replace("LIMIT", limit)), [])

    def test_a_support_takes_the_load(self):
        contact = "  Contact: {Side: bottom}\n"
        held = 'the load of "Traction->top" along Y goes into supports'
        self.assertIn(held, str(self.notes(PRESSED + "  Traction: {top: {Y: -2.0}}\n" + contact)))
        self.assertIn(held, str(self.notes(PRESSED + "  Traction: {top: {Force Y: '-2*t'}}\n  Steps: {Times: [1.0, 2.0]}\n" + contact)))
        self.assertEqual(self.notes(PRESSED + "  Traction: {right: {X: 2.0, Y: 1.0}}\n" + contact), [])
        self.assertEqual(self.notes(BODY + "  Dirichlet: {top: {X: 0.0}}\n  Traction: {top: {Y: -2.0}}\n" + contact), [])

    def test_a_force_per_area_that_may_be_a_force(self):
        deck = BODY + "  Dirichlet: {left: {X: 0.0}}\n  Traction: {top: {LOAD}}\n  Contact: {Side: bottom}\n"
        per_area = '"Traction->top->Y" = -300 [Pa] is a force per area (a force on the whole side is "Force Y")'
        notes = self.notes(deck.replace("LOAD", "Y: -300.0"))
        self.assertIn(per_area + ", more than a tenth of the body's Young's modulus, 1000 [Pa]: strains will not be small", notes)
        self.assertIn("strains reach 0.27", notes[-1])
        self.assertIn(per_area, notes[-1])
        (note,) = self.notes(deck.replace("LOAD", "Force Y: -300.0"))
        self.assertTrue(note.startswith("strains reach 0.27") and note.endswith("are rough"), note)
        self.assertEqual(self.notes(deck.replace("LOAD", "Y: -99.0")), [])
        (self.folder / "deck.yaml").write_text("deck:" + deck.replace("LOAD", "Y: -99.0").replace("Side: bottom", "Side: bottom, Yield Stress: 9.0"))
        told = self.rpc("--check", "--input=deck.yaml", code=5).stderr
        self.assertIn('carries at most 9 [N/m], where all of it yields. Lower the load, or raise "Contact->Yield Stress". "Traction->top->Y" = -99 [Pa]', told)
        (self.folder / "deck.yaml").write_text("deck:" + deck.replace("LOAD", "Y: -99.0").replace("  Dirichlet: {left: {X: 0.0}}\n", ""))
        self.assertNotIn("per area", self.rpc("--check", "--input=deck.yaml", code=5).stderr)

    @unittest.skipIf(shutil.which("gmsh") is None, "gmsh is not there")
    def test_a_round_foundation_for_a_round_side(self):
        deck = PRESSED.replace("Lower: [0.0, 0.0], Upper: [1.0, 1.0], Cells: [4, 4]", f"Type: gmsh, File: {SOURCE}/input/hertz.geo, Size Factor: 9.0")
        (note,) = self.notes(deck + "  Contact: {Side: contact}\n")
        self.assertIn('side "contact" is bent, and "Contact" has neither an "Obstacle" nor a "Gap"', note)
        self.assertNotIn("is bent", str(self.notes(deck + "  Contact: {Side: contact, Gap: 0.001}\n")))
        self.assertNotIn("is bent", str(self.notes(deck + "  Contact: {Side: contact, Obstacle: {Type: plane, Point: [0.0, 0.0], Normal: [0.0, 1.0]}}\n")))
        self.assertNotIn("is bent", str(self.notes(deck + "  Contact: {Side: top}\n")))
        (self.folder / "ring.geo").write_text("""Mesh.MeshSizeMax = 0.5;
Point(1) = {1, 0, 0}; Point(2) = {2, 0, 0}; Point(3) = {0, 2, 0}; Point(4) = {0, 1, 0}; Point(5) = {0, 0, 0};
Line(1) = {1, 2}; Circle(2) = {2, 5, 3}; Line(3) = {3, 4}; Circle(4) = {4, 5, 1}; Curve Loop(1) = {1 : 4}; Plane Surface(1) = {1};
Physical Surface("ring") = {1}; Physical Curve("held") = {1}; Physical Curve("side 1") = {2}; Physical Curve("side 2") = {4};
""")
        ring = "\n  Mesh: {Type: gmsh, File: ring.geo}\n  Material: {Young's Modulus: 1.0e+3, Poisson's Ratio: 0.3}\n  Dirichlet: {held: {X: 0.0, Y: 0.01}}\n"
        notes = self.notes(ring + "  Contact: {Sides: {1: {Side: side 1, Stiffness: 10.0}, 2: {Side: side 2, Stiffness: 10.0}}}\n")
        self.assertEqual([note[:9] for note in notes if "is bent" in note], ['side "sid'] * 2, notes)  # names that differ by a number alone

    def test_other_notes_are_in_the_summary_too(self):
        body = PRESSED.replace("Cells: [4, 4]", "Cells: [4, 4], Element: P1").replace("0.3", "0.45").replace("-0.01", "-0.5")
        notes = self.notes(body + "  Contact: {Side: bottom, Yield Stress: 1.0e+4}\n")
        for part in ("P1 triangles lock", "strains reach"):
            self.assertIn(part, str(notes))


class ForceOnAWholeSide(RpcTestCase):
    def test_is_the_same_as_its_share_per_area_on_each_mesh_and_at_each_time(self):
        results = {}
        for name, load in (("whole", 'Force Y: "-8*t"'), ("share", 'Y: "-2*t"')):
            (self.folder / f"{name}.yaml").write_text(f"""deck:
  Mesh: {{Lower: [0.0, 0.0], Upper: [4.0, 1.0], Cells: [16, 4]}}
  Material: {{Young's Modulus: 1000.0, Poisson's Ratio: 0.3}}
  Dirichlet: {{left: {{X: 0.0, Y: 0.0}}, right: {{X: 0.0, Y: 0.0}}}}
  Traction: {{top: {{{load}}}}}
  Contact: {{Side: bottom, Yield Stress: 1.5}}
  Steps: {{Times: [0.5, 1.0]}}
  Adapt: {{Target Relative Error: 0.1, Meshes: nested}}
  Output: {{Exodus: false, CSV: false}}
""")
            self.rpc(f"--input={name}.yaml", "--output=out")
            results[name] = json.loads((self.folder / "out" / f"{name}.json").read_text())
        whole, share = results["whole"], results["share"]
        self.assertEqual(whole["cells"], share["cells"])
        self.assertLess(abs(whole["energy_J"] - share["energy_J"]), 1e-11 * abs(share["energy_J"]))


class Check(RpcTestCase):
    def expect(self, found, *arguments, notes=False, code=0):
        result = self.rpc("--check", *arguments, "--output=out", code=code)
        self.assertIn(f"{'a run refuses nothing of it; see the note above' if notes else 'nothing wrong with it'}: {found}\n", result.stdout)
        self.assertNotIn("newton", result.stdout)
        self.assertNotIn("Newton", result.stdout)
        self.assertEqual(files(self.folder), [])

    def test_it_tells_what_there_is_to_solve(self):
        self.expect("210 dofs, 21 contact points", "--input=beam.xml", SMALL)
        self.expect("210 dofs, 21 contact points", "--input=beam.xml", SMALL, "--set=Steps->Times={1,2}")
        self.expect("210 dofs, 21 contact points", "--input=beam.xml", SMALL, "--set=Adapt->Target Relative Error=0.1")
        self.expect("210 dofs, 21 contact points", "--input=beam.xml", SMALL, "--set=Adapt->Target Relative Error=0.1", "--set=Steps->Times={1,2}")
        self.expect("210 dofs, 0 contact points", "--input=beam.xml", SMALL, "--set=Contact->Side=")

    def test_contact_nodes_that_supports_hold_too_are_nothing_wrong_unless_all_are(self):
        told = self.rpc("--check", "--input=beam.xml", SMALL).stdout
        self.assertIn("the normal displacement of 2 of 21 contact nodes is prescribed", told)
        self.assertIn("nothing wrong with it", told)
        held = PRESSED + '  Contact: {Side: top}\n'
        (self.folder / "deck.yaml").write_text("deck:" + held)
        told = self.rpc("--check", "--input=deck.yaml").stdout
        self.assertIn("the foundation holds nothing", told)
        self.assertIn("see the note above", told)
        (self.folder / "deck.yaml").write_text("deck:" + held.replace("Dirichlet", "Rigid").replace("Y: -0.01", "Y: -0.01, Rotation Z: 0.0"))
        self.assertIn('note: "Rigid" prescribes the normal displacement of all', self.rpc("--check", "--input=deck.yaml").stdout)

    def test_it_sends_to_the_notes_that_it_tells(self):
        (self.folder / "deck.yaml").write_text("deck:" + PRESSED)
        told = self.rpc("--check", "--input=deck.yaml").stdout.splitlines()
        self.assertIn('note: the deck has no "Contact"', told[0])
        self.assertEqual(told[-1], "deck.yaml: a run refuses nothing of it; see the note above: 50 dofs, 0 contact points")

    def test_it_looks_where_results_would_go(self):
        (self.folder / "file").write_text("")
        for folder in ("file", "file/below/it"):
            told = self.rpc("--check", "--input=beam.xml", SMALL, f"--output={folder}", code=2).stderr
            self.assertIn("output: cannot create the folder", told)
        self.rpc("--check", "--input=beam.xml", SMALL, "--output=new/folder")
        self.assertEqual(files(self.folder), ["file"])

    @unittest.skipIf(shutil.which("gmsh") is None, "gmsh is not there")
    def test_it_tells_that_no_mesh_can_follow_one_of_hexahedra(self):
        (self.folder / "cube.geo").write_text("""SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Physical Surface("bottom") = {5}; Physical Surface("top") = {6}; Physical Volume("body") = {1};
Transfinite Curve "*" = 3; Transfinite Surface "*"; Transfinite Volume "*"; Recombine Surface "*";
""")
        subprocess.run(["gmsh", "-3", "cube.geo", "-o", "cube.msh"], cwd=self.folder, check=True, capture_output=True)
        (self.folder / "deck.yaml").write_text("""deck:
  Mesh: {Type: gmsh, File: cube.msh}
  Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.3}
  Dirichlet: {top: {X: 0.0, Y: 0.0, Z: -0.01}}
  Contact: {Side: bottom}
  Adapt: {Target Relative Error: 0.001}
""")
        note = '"Adapt->Target Relative Error" finds no mesh after the first one: only triangles and tetrahedra are halved'
        told = self.rpc("--check", "--input=deck.yaml").stdout
        self.assertIn(note, told)
        self.assertNotIn("nothing wrong", told)
        told = self.rpc("--input=deck.yaml", code=4).stdout
        self.assertLess(told.index(note), told.index("newton"))  # before the solve

    def understood(self, text, *arguments):
        """The lines of the block that --check prints, without the blanks at their ends."""
        (self.folder / "deck.yaml").write_text("deck:" + text)
        lines = self.rpc("--check", "--input=deck.yaml", *arguments).stdout.splitlines()
        return [line.strip() for line in lines[next(k for k, line in enumerate(lines) if line.startswith("  body")):-1]]

    def test_it_tells_what_it_understood_in_the_plane(self):
        self.assertEqual(self.understood("""
  Mesh: {Lower: [-1.0, 2.0], Upper: [3.0, 4.0], Cells: [8, 4]}
  Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.3}
  Units: {Length: mm, Force: N}
  Dirichlet: {left: {X: 0.0}, right bottom: {X: "0.1*t", Y: -0.25}}
  Traction: {top: {Y: "-3*x*t"}, right: {X: 5.0, Y: 1.0}, shear: {Side: top, X: 2.0}}
  Body Force: {Y: -0.5}
  Contact: {Side: bottom, Gap: 0.01, Yield Stress: 16.0, Stiffness: 500.0, Friction Coefficient: 0.3}
  Steps: {Times: [0.5, 1.0, 2.0]}
"""), ["body        32 cells of Q1, plane strain; x from -1 to 3, y from 2 to 4 mm", "area 8 mm^2",
       "material    E = 1000 MPa, nu = 0.3",
       'sides       "left": length 2 mm, normal (-1, 0); held: X = 0',
       '"right": length 2 mm, normal (1, 0); loaded',
       '"bottom": length 4 mm, normal (0, -1); contact',
       '"top": length 4 mm, normal (0, 1); loaded; loaded',
       'points      "right bottom": held: X = "0.1*t", Y = -0.25',
       'loads       "top": in all (0, -6) N/mm at t = 0.5, (0, -24) N/mm at t = 2',
       '"right": in all (10, 2) N/mm', '"top": in all (8, 0) N/mm', "body force: in all (0, -4) N/mm",
       'foundation  "bottom": springs of 500 MPa/mm until it yields at 16 MPa; friction: coefficient 0.3; gap 0.01 mm',
       "steps       3, t = 0.5 to 2", "unknowns    90, 9 contact points",
       "a run takes less than 1 s of one core and about 0.1 GB; thin and nearly incompressible bodies take several times as long"])

    def test_it_tells_what_it_understood_of_other_bodies(self):
        told = self.understood("""
  Mesh: {Lower: [0.0, 0.0, 0.0], Upper: [2.0, 3.0, 1.0], Cells: [2, 3, 4], Element: P2}
  Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.3}
  Dirichlet: {back: {X: 0.0, Y: 0.0, Z: 0.0}}
  Traction: {front: {Z: -2.0}}
""")
        for line in ("volume 6 m^3", '"left": area 3 m^2, normal (-1, 0, 0); free', '"front": area 6 m^2, normal (0, 0, 1); loaded',
                     'loads       "front": in all (0, 0, -12) N', "foundation  none: nothing touches"):
            self.assertIn(line, [each.replace("sides       ", "") for each in told])
        told = self.understood("""
  Kinematics: axisymmetric
  Mesh: {Lower: [0.0, 0.0], Upper: [1.0, 2.0], Cells: [2, 4], Element: Q2}
  Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.3}
  Traction: {top: {Y: -1.0}}
  Contact: {Side: bottom, Yield Stress: "10 + x"}
  Adapt: {Target Relative Error: 0.01, Max Dofs: 5000}
""")
        for line in ("volume 6.28319 m^3 of the whole body of revolution", '"right": area 12.5664 m^2, normal (1, 0); free',
                     'loads       "top": in all (0, -3.14159) N', 'foundation  "bottom": rigid until it yields at "10 + x" Pa; no friction; gap 0: it has the shape of the side',
                     "then meshes are refined until the relative error is below 0.01, to at most 5000 unknowns"):
            self.assertIn(line, told)

    def test_it_tells_forces_on_whole_sides(self):
        told = self.understood(PRESSED + """
  Traction: {right: {Force X: "3*t"}, left: {Force Y: -2.0}}
  Steps: {Times: [0.5, 2.0]}
""")
        for line in ('loads       "right": in all (1.5, 0) N/m at t = 0.5, (6, 0) N/m at t = 2', '"left": in all (0, -2) N/m'):
            self.assertIn(line, told)
        told = self.understood(HELD + "  Contact: {Side: bottom, Obstacle: {Type: plane, Point: [0.0, 0.0], Normal: [0.0, 1.0], Force Y: 2.0}}\n")
        self.assertIn('loads       none but what "Dirichlet" prescribes and the force on the obstacle', told)

    def test_it_leaves_a_run_and_its_results_alone(self):
        self.solve("--set=Steps->Times={1,2}", "--set=Steps->Checkpoint Every=1")
        before = {file: (self.folder / "out" / file).stat().st_mtime_ns for file in files(self.folder / "out")}
        more = ["--input=beam.xml", SMALL, "--output=out", "--set=Steps->Times={1,2,3}", "--set=Steps->Checkpoint Every=1", "--restart"]
        result = self.rpc("--check", *more)
        self.assertIn("note: goes on after ", result.stdout)
        self.assertIn("nothing wrong with it: 210 dofs, 21 contact points", result.stdout)
        other = self.rpc("--check", *more, "--set=Material->Young's Modulus=2001", code=2)
        self.assertIn("Material->Young's Modulus", errors(other)[0])
        after = {file: (self.folder / "out" / file).stat().st_mtime_ns for file in files(self.folder / "out")}
        self.assertEqual(after, before)

    @unittest.skipIf(RANKS > 1, "needs one rank: rank 0 reads the file")
    def test_it_makes_the_mesh(self):
        (self.folder / "body.geo").write_text('Rectangle(1) = {0, 0, 0, 1, 1}; Physical Surface("body") = {1};\n')
        (self.folder / "deck.yaml").write_text("deck:\n  Mesh: {Type: gmsh, File: body.geo}\n  Material: {Young's Modulus: 1.0, Poisson's Ratio: 0.3}\n")
        asked, checked = self.rpc("--input=deck.yaml", code=3), self.rpc("--check", "--input=deck.yaml", code=3)
        self.assertEqual(errors(asked), errors(checked))


if __name__ == "__main__":
    unittest.main()
