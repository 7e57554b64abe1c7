# SPDX-License-Identifier: BSD-3-Clause
"""structure.py finds what it is there to find, in small trees, and nothing in this project."""

import contextlib
import pathlib
import tempfile
import unittest

import structure

SOURCE = pathlib.Path(__file__).parents[2]


def test_file(text="", stem="a_test"):
    """What a file of GoogleTests has around it."""
    return f"{text}\nnamespace {stem}\n{{\nnamespace\n{{\n\n}} // namespace\n}} // namespace {stem}\n"


class Structure(unittest.TestCase):
    @contextlib.contextmanager
    def tree(self, **files):
        """The root of a tree of mesh, contact and the program, and these files: names with / written as __."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            tree = {"packages/mesh/CMakeLists.txt": "rpc_add_package(mesh DEPENDS rpc::core)",
                    "packages/contact/CMakeLists.txt": "rpc_add_package(contact\n  DEPENDS rpc::fem PRIVATE_DEPENDS rpc::metis)",
                    "src/main.cpp": '#include "rpc/adapt/new_mesh.hpp"\n'}
            for name, text in {**tree, **{name.replace("__", "/"): text for name, text in files.items()}}.items():
                path = root / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            yield root

    def violations(self, **files):
        """Of such a tree, whose files do not name their licence."""
        with self.tree(**files) as root:
            return [each for each in structure.violations(root) if "SPDX" not in each]

    def test_of_this_project_is_sound(self):
        self.assertGreater(len(structure.code(SOURCE / "packages")), 100)
        self.assertEqual(list(structure.violations(SOURCE)), [])

    def test_arrows_of_the_table_run_one_way(self):
        def below(package):
            return structure.allowed(package).union(*map(below, structure.allowed(package)))
        for package in structure.ALLOWED:
            self.assertNotIn(package, below(package))

    def test_allowed_arrows_pass(self):
        self.assertEqual(self.violations(**{"packages__contact__src__a.cpp": '#include "rpc/fem/b.hpp"\n#include "a.hpp"\n'}), [])

    def test_finds_an_include_that_runs_back(self):
        found = self.violations(**{"packages__mesh__include__rpc__mesh__a.hpp": '#pragma once\n#include "rpc/contact/b.hpp"\n'})
        self.assertEqual(found, ["packages/mesh/include/rpc/mesh/a.hpp:2: mesh includes rpc/contact/b.hpp"])

    def test_tests_may_make_bodies_but_not_run_back(self):
        self.assertEqual(self.violations(**{"packages__mesh__test__a_test.cpp": test_file('#include "rpc/fem/b.hpp"\n')}), [])
        self.assertEqual(len(self.violations(**{"packages__mesh__test__a_test.cpp": test_file('#include "rpc/solver/b.hpp"\n')})), 1)

    def test_finds_a_link_that_runs_back(self):
        found = self.violations(**{"packages__mesh__CMakeLists.txt": "rpc_add_package(mesh DEPENDS rpc::core rpc::io)"})
        self.assertEqual(found, ["packages/mesh/CMakeLists.txt: mesh links rpc::io"])

    def test_finds_a_library_in_the_wrong_place(self):
        found = self.violations(**{"packages__contact__src__a.cpp": "#include <NOX_Abstract_Group.H>\n"})
        self.assertEqual(found, ["packages/contact/src/a.cpp:1: contact includes NOX_Abstract_Group.H"])

    def test_finds_a_package_that_the_table_lacks(self):
        self.assertEqual(len(self.violations(**{"packages__friction__CMakeLists.txt": "rpc_add_package(friction)"})), 1)

    def test_finds_a_kernel_in_the_program(self):
        found = self.violations(**{"src__output.cpp": "void f()\n{\n  Kokkos::parallel_for(3, g);\n}\n"})
        self.assertEqual(found, ["src/output.cpp:3: a kernel in the program"])

    def test_finds_a_name_of_one_trilinos_version_outside_core(self):
        for line in ("map.getNodeNumElements()", "map->getLocalElementList()", "#if TRILINOS_MAJOR_MINOR_VERSION >= 130400",
                     "MueLu::Aggregates_kokkos<LO> a;", "#include MUELU_HEADER(Aggregates_kokkos)", "MueLu::GraphBase<LO> &g",
                     "MueLu::TpetraCrs_To_XpetraMatrix<double>(A)", "Kokkos::Experimental::sqrt(x)", "Kokkos::atomic_increment(&n)"):
            for where in ("packages__mesh__src__a.cpp", "packages__mesh__test__a_test.cpp", "src__a.cpp", "test__support__a.hpp"):
                found = [each for each in self.violations(**{where: "\n" + line + "\n"}) if "versions" in each]
                self.assertEqual(len(found), 1, line)
                self.assertTrue(found[0].startswith(where.replace("__", "/") + ":2: "), found)
            self.assertEqual(self.violations(**{"packages__core__include__rpc__core__a.hpp": line}), [])

    def test_finds_what_differs_between_versions_of_gmsh(self):
        line = "gmsh::model::mesh::setSizeCallback(size);"
        self.assertEqual(len(self.violations(**{"packages__mesh__src__a.cpp": line})), 1)
        self.assertEqual(self.violations(**{"packages__mesh__src__gmsh_size_callback.hpp": line}), [])

    def test_finds_gmsh_outside_its_program(self):
        files = {"packages__mesh__CMakeLists.txt": "add_executable(rpc_gmsh src/a.cpp src/b.cpp)\nrpc_add_package(mesh SOURCES c.cpp)\n",
                 "packages__mesh__src__a.cpp": "#include <gmsh.h>\n", "packages__mesh__src__callback.hpp": "#include <gmsh.h>\n",
                 "packages__mesh__src__b.cpp": '#include "callback.hpp"\n', "packages__mesh__src__c.cpp": "\n"}
        self.assertEqual(self.violations(**files), [])
        for name in ("a", "b"):
            files["packages__mesh__CMakeLists.txt"] = f"rpc_add_package(mesh\n  SOURCES c.cpp {name}.cpp)\n"
            self.assertEqual(self.violations(**files), [f"packages/mesh/src/{name}.cpp: mesh includes gmsh.h, which rpc_gmsh alone may"])
        files["packages__mesh__CMakeLists.txt"] = "rpc_add_package(mesh SOURCES c.cpp PRIVATE_DEPENDS ${GMSH_LIBRARY})\n"
        self.assertEqual(self.violations(**files), ["packages/mesh/CMakeLists.txt: mesh links gmsh, which rpc_gmsh alone may"])
        self.assertEqual(len(self.violations(**{"src__a.cpp": "#include <gmsh.h>\n"})), 1)

    def test_takes_other_names_for_those_of_any_version(self):
        for line in ("start_kokkos(arguments)", "num_local(map)", "getNodeSmootherComplexity()", "x; // MueLu::GraphBase is gone"):
            self.assertEqual(self.violations(**{"packages__mesh__src__a.cpp": line}), [])

    def test_finds_a_matrix_in_the_program(self):
        found = self.violations(**{"src__report.cpp": "void f(const rpc::CrsMatrix &K)\n{\n  K.apply(x, y);\n}\n"})
        self.assertEqual(found, ["src/report.cpp:1: work on a matrix in the program"])

    def test_vectors_are_no_matrix(self):
        self.assertEqual(self.violations(**{"src__film.cpp": "const MultiVector &v = *s.u;\n"}), [])

    def test_indicators_do_not_write_files_and_runs_do_not_know_gmsh(self):
        self.assertEqual(len(self.violations(**{
            "packages__adapt__CMakeLists.txt": "rpc_add_package(adapt DEPENDS rpc::analysis)",
            "packages__adapt__src__a.cpp": '#include "rpc/io/exodus.hpp"\n'})), 1)
        found = self.violations(**{"packages__analysis__CMakeLists.txt": "rpc_add_package(analysis DEPENDS rpc::contact)",
                                   "packages__analysis__src__run.cpp": '#include "rpc/mesh/make_mesh.hpp"\n#include "rpc/mesh/gmsh.hpp"\n'})
        self.assertEqual(found, ["packages/analysis/src/run.cpp:2: analysis includes rpc/mesh/gmsh.hpp"])

    def test_finds_a_parameter_of_the_law_that_is_read_outside_its_folder(self):
        line = "const double most = c.law(i).yield;"
        self.assertEqual(len(self.violations(**{"packages__contact__src__result.cpp": line})), 1)
        self.assertEqual(self.violations(**{"packages__contact__include__rpc__contact__law__a.hpp": line}), [])
        self.assertEqual(self.violations(**{"packages__contact__test__a_test.cpp": test_file(line)}), [])
        self.assertEqual(self.violations(**{"packages__contact__src__result.cpp": "peak.yield_jump = sums.yielded_length > 0;"}), [])

    def test_finds_a_kernel_in_a_private_member(self):
        header = "class Path : public Way\n{\npublic:\n  void walk();\n\n%s  void measure(int x) const;\n};\n"
        source = "\nvoid Path::measure(const int x) const\n{\n  Kokkos::parallel_for(KOKKOS_LAMBDA(int i) { f(i); });\n}\n"
        files = {"packages__solver__include__rpc__solver__path.hpp": header % "private:\n", "packages__solver__src__path.cpp": source}
        self.assertEqual(self.violations(**files), ["packages/solver/src/path.cpp:2: nvcc refuses the kernel of a private Path::measure"])
        files["packages__solver__include__rpc__solver__path.hpp"] = header % ""
        self.assertEqual(self.violations(**files), [])

    def test_finds_a_source_file_that_is_too_long(self):
        for where in ("packages__mesh__src__a.cpp", "packages__mesh__include__rpc__mesh__a.hpp", "packages__mesh__test__a.hpp", "src__a.cpp"):
            found = self.violations(**{where: "\n" * 451})
            self.assertEqual(found, [where.replace("__", "/") + ": 451 lines, more than 450"])
            self.assertEqual(self.violations(**{where: "\n" * 450}), [])

    def test_finds_tests_outside_a_namespace_of_their_own(self):
        where = "packages__mesh__test__a_test.cpp"
        self.assertEqual(self.violations(**{where: test_file()}), [])
        for text in ("TEST(A, b) {}\n", test_file(stem="b_test"), test_file("TEST(A, b) {}"), test_file() + "TEST(A, b) {}\n"):
            self.assertEqual(self.violations(**{where: text}), ["packages/mesh/test/a_test.cpp: is not within namespace a_test and an unnamed one"])

    def test_finds_a_constant_that_two_sources_define(self):
        files = {"packages__mesh__src__a.cpp": "constexpr const char *tiny = \"a\"; // small\n",
                 "packages__mesh__src__sub__b.cpp": "constexpr bool huge = true, tiny = false;\n"}
        self.assertEqual(self.violations(**files), ["packages/mesh/src/sub/b.cpp: tiny is also a constant of packages/mesh/src/a.cpp"])
        files["packages__mesh__src__sub__b.cpp"] = "void f()\n{\n  constexpr double tiny = 1e-3;\n}\n"
        self.assertEqual(self.violations(**files), [])

    def test_finds_a_number_that_is_no_rule(self):
        for line in ("constexpr double enough = 0.3;", "inline constexpr int patience =\n    4;", "static constexpr std::size_t most = 7, least = 1;"):
            for where in ("packages__mesh__src__a.cpp", "packages__contact__include__rpc__contact__a.hpp", "src__a.cpp"):
                found = self.violations(**{where: f"namespace\n{{\n{line}\n}}\n"})
                self.assertEqual(len(found), 1, line)
                self.assertIn("is a number at namespace scope", found[0])
        for text in ("struct Rounding {\n  static constexpr double place = 1e-9;\n};\n", "void f()\n{\n  constexpr int a = 3;\n}\n",
                     "constexpr int nodes(const int dim)\n{\n  return dim;\n}\n", "constexpr const char *name = \"a\";\n"):
            self.assertEqual(self.violations(**{"packages__mesh__src__a.cpp": text}), [])
        self.assertEqual(self.violations(**{"packages__mesh__test__a.hpp": "constexpr double enough = 0.3;\n"}), [])

    def test_subjects_are_those_of_files_with_numbers(self):
        self.assertEqual(self.violations(**{"packages__mesh__src__topology.cpp": "constexpr int most_vertices = 4;\n"}), [])
        for name in " ".join(structure.NO_RULES.values()).split():
            self.assertTrue(structure.NUMBER.search((SOURCE / name).read_text()), name)

    def test_finds_a_rule_more(self):
        rule = '  Rule<int> a{1, "mesh.a", "cells [-]", "measured"};\n'
        for number in (structure.MOST_RULES["mesh"], structure.MOST_RULES["mesh"] + 1):
            found = self.violations(**{"packages__mesh__include__rpc__mesh__rules.hpp": f"struct MeshRules {{\n{number * rule}}};\n"})
            self.assertEqual(len(found), number - structure.MOST_RULES["mesh"], found)

    def test_finds_a_source_of_a_rule_that_is_not_there(self):
        rules = "".join(f'  Rule<int> a{{1, "mesh.a", "cells (9.9) [-]", "{source}"}};\n' for source in (
            "not measured", "theory.md (4.1)", "theory.md (4.2)", "measurements.md: Meshes", "measurements.md: Cells"))
        found = self.violations(**{
            "packages__mesh__include__rpc__mesh__rules.hpp": rules, "doc__theory.md": "(4.1)", "doc__measurements.md": "## Meshes (2026-11-29)\n"})
        self.assertEqual([each.partition(": ")[2] for each in found], ['no "(4.2)" in doc/theory.md', 'no "## Cells" in doc/measurements.md'])

    def test_counts_the_rules_of_packages(self):
        rules = structure.rules(SOURCE)
        self.assertEqual({package: rules[package] for package in structure.MOST_RULES}, structure.MOST_RULES)  # fewer: the bound falls, too

    def test_finds_a_file_that_does_not_name_its_licence_and_adds_the_line(self):
        line = structure.LICENCE
        files = {"src__main.cpp": f"// {line}\nint main()\n", "packages__mesh__CMakeLists.txt": "rpc_add_package(mesh)\n",
                 "packages__contact__CMakeLists.txt": f"# {line}\n", "cmake__a.sh": "#!/bin/bash\nls\n", "doc__a.md.in": "",
                 "cmake__b.sh": f"#!/bin/bash\n# {line}\n", "doc__a.py": f'"""Text."""\n\n# {line}\n', "test__a.hpp": f"# {line}\n"}
        with self.tree(**files) as root:
            lack = [each.split(":")[0] for each in structure.violations(root) if "SPDX" in each]
            self.assertEqual(lack, ["packages/mesh/CMakeLists.txt", "test/a.hpp", "cmake/a.sh", "doc/a.py"])
            self.assertEqual(list(structure.add_licences(root)), lack)
            self.assertEqual(list(structure.unlicensed(root)), [])
            self.assertEqual((root / "cmake/a.sh").read_text(), f"#!/bin/bash\n# {line}\nls\n")
            self.assertEqual((root / "packages/mesh/CMakeLists.txt").read_text(), f"# {line}\nrpc_add_package(mesh)\n")

    def test_finds_a_script_that_cannot_be_started(self):
        with self.tree(**{"cmake__b.sh": f"#!/bin/bash\n# {structure.LICENCE}\n"}) as root:
            script = root / "cmake/b.sh"
            self.assertEqual(list(structure.check_scripts(root)), ["cmake/b.sh: begins with #!, but is not executable: chmod +x"])
            script.chmod(0o755)
            self.assertEqual(list(structure.check_scripts(root)), [])

    def test_finds_a_citation_of_another_version(self):
        for version, wrong in (("1.2.3", 0), ("1.2.2", 1)):
            found = self.violations(**{"CMakeLists.txt": "project(rpc VERSION 1.2.3 LANGUAGES CXX)\n", "CITATION.cff": f"version: {version}\n"})
            self.assertEqual(len(found), wrong, found)


if __name__ == "__main__":
    unittest.main()
