# SPDX-License-Identifier: BSD-3-Clause
"""The arrows between packages: what the code includes and what CMake links, against the table below.

    python3 structure.py [<root of the sources>]

Prints each arrow that is not allowed, each line of the program that launches a kernel or works on a matrix, each name that differs
between Trilinos versions outside VERSION_HEADERS, each parameter of a contact law that is read outside its folder, each kernel in a
private member function, which nvcc refuses, each source file that is longer than MOST_LINES, each file of GoogleTests outside a
namespace of its own, each constant that two sources of a package define, each number at namespace scope that is neither a rule nor has a
subject in NO_RULES, each package with more rules (core/rule.hpp) than MOST_RULES, each equation or
measurement that a rule names and the documents lack, each source, script and CMake file without the line that
names its licence, each script that begins with #! and is not executable, each place that names another version of the program than CMakeLists.txt,
and each use of gmsh outside the program rpc_gmsh; the exit code is 1 if there is one. Then the number of rules of each package.

    python3 structure.py --add-licence [<root of the sources>]

puts that line into the files that lack it, and prints their names.
"""

import os
import pathlib
import re
import sys

# What each package may include; src is the program.
ALLOWED = {
    "core": "",
    "algebra": "core",
    "mesh": "core",
    "fem": "core algebra mesh",
    "contact": "core algebra mesh fem",
    "solver": "core algebra",
    "io": "core mesh",
    "analysis": "core algebra mesh fem contact solver",
    "bound": "core algebra mesh fem contact solver analysis",
    "adapt": "core algebra mesh fem contact solver analysis bound",
    "src": "core algebra mesh fem contact solver io analysis bound adapt",
}
# Who may include headers of Trilinos that begin so.
LIBRARIES = {
    "NOX": "solver analysis",
    "Belos": "solver",
    "MueLu": "core solver",
    "Ifpack2": "solver",
    "Amesos2": "solver",
}
# Names that differ between Trilinos versions, doc/trilinos_versions.md, and the only place where they may stand.
VERSION_NAMES = re.compile(r"""
    \b(?: getNode(?:Num|Element)\w*                           # of Tpetra's and Xpetra's maps and matrices: getLocal...
        | getLocal(?:NumElements|ElementList|NumRows|NumCols|NumEntries)
        | TRILINOS_\w*VERSION | KOKKOS_VERSION | HAVE_MUELU_\w+
        | [A-Z]\w*_kokkos | (?:Get|Set)KokkosRefactor          # MueLu's factories that 13.2 has twice
        | MueLu::(?:LW)?Graph(?:Base)?                         # gone or merged
        | MueLu::Utilities | MV2(?:NonConst)?TpetraMV2? | Op2(?:NonConst)?Tpetra\w+ | Tpetra\w+_To_Xpetra\w+
        | Kokkos::Experimental | Kokkos::atomic_(?:increment|decrement|assign)
    )\b""", re.VERBOSE)
VERSION_HEADERS = "packages/core/include/rpc/core"
GMSH_VERSION_NAME = "setSizeCallback"  # gmsh's arguments and the meaning of the answer have changed
GMSH_VERSION_HEADER = "packages/mesh/src/gmsh_size_callback.hpp"
# Headers that a package may not include though they belong to one below it: a run gets its mesh from mesh/make_mesh.hpp.
HIDDEN = {"analysis": ["rpc/mesh/gmsh"]}
# What the program, which is left with command line, files and exit codes, does not do.
NOT_IN_PROGRAM = {
    "a kernel": re.compile(r"Kokkos::parallel_"),
    "work on a matrix": re.compile(r"\b\w*(Matrix|Graph|Operator)\b|fillComplete|sumIntoLocal|replaceLocal"),
}
# Numbers of a contact law at a point, which the functions of law/ alone read; who fills them.
LAW_PARAMETERS = re.compile(r"(?:\.|->)(?:yield|hardening|compliance)\b(?!_)")
LAW_FOLDER = "packages/contact/include/rpc/contact/law"
LAW_FILLERS = {"packages/contact/src/gap_reading.cpp", "packages/contact/src/contact_nodes.cpp", "packages/contact/src/contact_options.cpp",
               "packages/analysis/src/body/problem.cpp"}  # options of the deck, and the points' views
MOST_LINES = 450  # of a source file of a package or the program, tests included
FOR_TESTS = {"mesh", "fem"}  # a package's tests may make their bodies with these

CLASS = re.compile(r"^(?:class|struct) (\w+)[^;\n]*\n\{\n(.*?)^\};", re.MULTILINE | re.DOTALL)
HIDDEN_PART = re.compile(r"^(?:private|protected):\n(.*?)(?=^public:|\Z)", re.MULTILINE | re.DOTALL)
NAME_OF_FUNCTION = re.compile(r"\b(\w+)\(")
MEMBER = re.compile(r"^\S[^\n]*?\b(\w+)::(~?\w+)\((?:[^\n]*\n)+?\{\n(.*?)^\}", re.MULTILINE | re.DOTALL)

CONSTANT = re.compile(r"^(?:static |inline )*constexpr [^\n;({]*;", re.MULTILINE)
NAME_OF_CONSTANT = re.compile(r"(\w+)(?:\[\w*\])? = ")

# Numbers that steer a decision are rules, in rules.hpp of their package: what else is a number at namespace scope, by subject.
NUMBER = re.compile(r"^(?:static |inline )*constexpr (?:int|unsigned|float|double|LO|GO|std::size_t|std::u?int\d+_t) (?!\w+\()[^;({]*=[^;]*;",
                    re.MULTILINE)
NAME_OF_NUMBER = re.compile(r"(\w+)(?:\[\w+\])* =")
NO_RULES = {
    "numbers of formats and protocols: bytes, tags, types of cells": """
        packages/core/src/exchange.cpp packages/core/src/halo.cpp packages/core/src/message.cpp packages/core/src/units.cpp
        packages/io/src/checkpoint.cpp packages/io/src/mesh_picture.cpp packages/mesh/src/gmsh_wire.cpp packages/mesh/src/gmsh_wire.hpp
        packages/mesh/src/gmsh_size_callback.hpp packages/solver/src/factor/mumps_factor.cpp
        src/checkpoint.cpp src/output/paths.cpp""",
    "numbers of shapes": """
        packages/mesh/include/rpc/mesh/size_field.hpp packages/mesh/src/element.cpp packages/mesh/src/topology.cpp""",
    "numbers that are known to mathematics, or to stand for none": """
        packages/algebra/include/rpc/algebra/alike_nodes.hpp packages/analysis/src/history/load_history.cpp packages/analysis/src/options.cpp
        packages/analysis/src/history/take_back_results.cpp packages/core/src/bounds.cpp packages/core/src/finite.cpp
        packages/core/src/memory.cpp packages/fem/src/materials.cpp packages/io/src/expression_bounds.cpp
        packages/solver/src/factor/band_factor.cpp packages/solver/src/multigrid/mesh_multigrid.cpp""",
    "blocks of kernels and leaves of trees": """
        packages/algebra/src/repeated_rows.cpp packages/algebra/src/several_vectors.cpp packages/contact/src/surface/facets.cpp
        packages/mesh/src/canonical_order.cpp packages/mesh/src/size_tree.cpp packages/solver/src/factor/low_rank_update.cpp""",
    "what input may be": """
        packages/contact/src/contact_nodes.cpp packages/fem/src/hinges.cpp packages/io/src/deck.cpp packages/mesh/src/gmsh_mesher.cpp
        packages/mesh/include/rpc/mesh/mesh_data.hpp packages/mesh/src/make_mesh.cpp packages/solver/src/multigrid/gathered_solver.cpp""",
    "what notes and results tell, and in how many digits": """
        packages/contact/src/between_nodes.cpp packages/contact/src/gap_search.cpp packages/io/src/error_bar.cpp src/notes.cpp
        src/output/points.cpp src/deck_notes.cpp""",
    "estimates of errors and what their bars cover": """
        packages/adapt/src/cycle.cpp packages/adapt/src/observed_error.cpp packages/adapt/src/size_plan.cpp""",
    "rounding": """
        packages/algebra/src/updated_operator.cpp packages/fem/include/rpc/fem/rigid_motion.hpp packages/fem/src/congruent_cells.cpp
        packages/fem/src/discretization.cpp packages/fem/src/rigid_motion.cpp packages/fem/src/rounding.cpp packages/fem/src/surface.cpp
        packages/mesh/src/gmsh_boundary.cpp packages/mesh/src/side_places.cpp src/continuation.cpp packages/analysis/src/step/active_set.cpp""",
    "contact law": """
        packages/contact/include/rpc/contact/law/foundation.hpp packages/contact/include/rpc/contact/law/interpolated.hpp""",
}
RULE = re.compile(r"^ *Rule<", re.MULTILINE)
MOST_RULES = {"src": 3, "core": 1, "algebra": 3, "mesh": 10, "contact": 18, "bound": 1, "adapt": 25, "analysis": 46, "solver": 59}  # of a package; 130 are wanted in all

LICENCE = "SPDX-License-Identifier: BSD-3-Clause"  # of LICENSE; within the first two lines, behind the marks of a comment
COMMENTS = {".cpp": "//", ".hpp": "//", ".c": "//", ".py": "#", ".sh": "#", ".cmake": "#", ".in": "#", ".def": "#"}
LICENSED_NAMES = {"CMakeLists.txt", "Dockerfile", ".ci/run"}  # that COMMENTS does not tell: # in all of them
LICENSED_FOLDERS = ("packages", "src", "test", "cmake", "doc", "python", ".ci")
VERSION = re.compile(r"^project\(rpc VERSION ([0-9.]+)", re.MULTILINE)

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
PACKAGE = re.compile(r"rpc_add_package\(\s*(\w+)(.*?)\)", re.DOTALL)


def allowed(package):
    return set(ALLOWED[package].split())


def code(folder):
    """The C++ files below a folder, in order."""
    return sorted(path for path in folder.rglob("*") if path.suffix in (".cpp", ".hpp"))


def includes(file):
    """(line number, header) of each #include."""
    for number, line in enumerate(file.read_text().splitlines(), 1):
        found = INCLUDE.match(line)
        if found:
            yield number, found.group(1)


def check_includes(root, package, folder):
    for file in code(folder):
        in_test = "test" in file.relative_to(folder).parts
        may = allowed(package) | {package} | (FOR_TESTS if in_test else set())
        for number, header in includes(file):
            where = f"{file.relative_to(root)}:{number}: {package} includes {header}"
            parts = header.split("/")
            if parts[0] == "rpc" and len(parts) > 2 and parts[1] not in may:
                yield where
            if not in_test and any(header.startswith(hidden) for hidden in HIDDEN.get(package, [])):
                yield where
            for library, users in LIBRARIES.items():
                if header.startswith(library + "_") or header.startswith(library.lower() + "_"):
                    if package not in users.split() and not in_test:
                        yield where


def linked(text):
    """Packages behind rpc:: in a piece of CMake."""
    return {name for name in re.findall(r"\brpc::(\w+)", text) if name in ALLOWED}


def check_links(root):
    for file in sorted(root.glob("packages/*/CMakeLists.txt")):
        for name, text in PACKAGE.findall(re.sub(r"#.*", "", file.read_text())):
            for other in sorted(linked(text) - allowed(name) if name in ALLOWED else []):
                yield f"{file.relative_to(root)}: {name} links rpc::{other}"


def check_program(root):
    for file in code(root / "src"):
        for number, line in enumerate(file.read_text().splitlines(), 1):
            for what, pattern in NOT_IN_PROGRAM.items():
                if pattern.search(line):
                    yield f"{file.relative_to(root)}:{number}: {what} in the program"


def check_versions(root):
    for top in ("packages", "src", "test"):
        for file in code(root / top):
            if file.parent == root / VERSION_HEADERS:
                continue
            for number, line in enumerate(file.read_text().splitlines(), 1):
                text = line.split("//")[0]
                for name in VERSION_NAMES.findall(text):
                    yield f"{file.relative_to(root)}:{number}: {name} differs between Trilinos versions: it belongs into {VERSION_HEADERS}"
                if GMSH_VERSION_NAME in text and file != root / GMSH_VERSION_HEADER:
                    yield f"{file.relative_to(root)}:{number}: {GMSH_VERSION_NAME} differs between gmsh's versions: it belongs into {GMSH_VERSION_HEADER}"


def check_gmsh(root):
    """gmsh is GPL: what includes its header belongs to the program rpc_gmsh alone, and no package links it (doc/licences.md)."""
    users = {file for file in code(root / "packages") + code(root / "src") if "gmsh.h" in [header for _, header in includes(file)]}
    users |= {file for file in code(root / "packages") if {header for _, header in includes(file)} & {user.name for user in users}}
    for file in sorted(root.glob("packages/*/CMakeLists.txt")):
        for name, text in PACKAGE.findall(re.sub(r"#.*", "", file.read_text())):
            for user in sorted(users):
                if user.is_relative_to(file.parent) and re.search(rf"(?<!\S){re.escape(user.name)}(?!\S)", text):
                    yield f"{user.relative_to(root)}: {name} includes gmsh.h, which rpc_gmsh alone may"
            if "GMSH" in text:
                yield f"{file.relative_to(root)}: {name} links gmsh, which rpc_gmsh alone may"
    for user in sorted(users):
        if not user.is_relative_to(root / "packages/mesh/src"):
            yield f"{user.relative_to(root)}: gmsh.h outside the sources of rpc_gmsh"


def check_law(root):
    for top in ("packages", "src"):
        for file in code(root / top):
            if file.parent == root / LAW_FOLDER or "test" in file.parts or str(file.relative_to(root)) in LAW_FILLERS:
                continue
            for number, line in enumerate(file.read_text().splitlines(), 1):
                if LAW_PARAMETERS.search(line.split("//")[0]):
                    yield f"{file.relative_to(root)}:{number}: a parameter of the contact law is read outside {LAW_FOLDER}"


def check_kernels(root):
    """nvcc wants the function around an extended lambda to be public."""
    hidden = set()  # (class, function)
    for file in code(root / "packages"):
        for name, body in CLASS.findall(file.read_text()):
            for part in HIDDEN_PART.findall(body):
                hidden |= {(name, function) for line in part.splitlines() for function in NAME_OF_FUNCTION.findall(line.split("//")[0])}
    for file in code(root / "packages"):
        text = file.read_text()
        for member in MEMBER.finditer(text):
            if member.group(1, 2) in hidden and "KOKKOS_LAMBDA" in member.group(3):
                line = text.count("\n", 0, member.start()) + 1
                yield f"{file.relative_to(root)}:{line}: nvcc refuses the kernel of a private {member.group(1)}::{member.group(2)}"


def check_lengths(root):
    for top in ("packages", "src"):
        for file in code(root / top):
            lines = len(file.read_text().splitlines())
            if lines > MOST_LINES:
                yield f"{file.relative_to(root)}: {lines} lines, more than {MOST_LINES}"


def check_namespaces_of_tests(root):
    """Several are compiled as one file: what a_test.cpp defines lies in an unnamed namespace within a_test."""
    for top in ("packages", "test"):
        for file in sorted((root / top).rglob("*_test.cpp")):
            begin, end = f"\nnamespace {file.stem}\n{{\nnamespace\n{{\n", f"\n}} // namespace\n}} // namespace {file.stem}\n"
            text = "\n" + file.read_text()
            inside = text.partition(begin)[2]
            if not inside.endswith(end) or re.search(r"^(?:namespace|TEST)", text.partition(begin)[0], re.MULTILINE):
                yield f"{file.relative_to(root)}: is not within namespace {file.stem} and an unnamed one"


def check_constants(root):
    """Several sources of a package may be compiled as one file: no two of them define the same constant."""
    for folder in [*sorted(root.glob("packages/*/src")), root / "src"]:
        first = {}
        for file in sorted(folder.rglob("*.cpp")):
            names = [name for line in CONSTANT.findall(file.read_text()) for name in NAME_OF_CONSTANT.findall(line)]
            for name in names:
                other = first.setdefault(name, file)
                if other != file:
                    yield f"{file.relative_to(root)}: {name} is also a constant of {other.relative_to(root)}"


def check_numbers(root):
    """Numbers that steer a decision are rules."""
    subjects = {name for files in NO_RULES.values() for name in files.split()}
    for folder in [*sorted(root.glob("packages/*")), root / "src"]:
        for file in code(folder):
            name = str(file.relative_to(root))
            numbers = [] if "test" in file.relative_to(folder).parts else NUMBER.findall(file.read_text())
            if numbers and file.name != "rules.hpp" and name not in subjects:
                yield (f"{name}: {NAME_OF_NUMBER.search(numbers[0]).group(1)} is a number at namespace scope: a rule belongs into rules.hpp of "
                       "its package, a bound of rounding into a struct, another subject into NO_RULES of test/structure/structure.py")


def rules(root):
    """{package: number of its rules}"""
    files = {file.parts[-5]: file for file in sorted(root.glob("packages/*/include/rpc/*/rules.hpp"))}
    files["src"] = root / "src/rules.hpp"
    return {package: len(RULE.findall(file.read_text())) for package, file in files.items() if file.exists()}


def check_sources_of_rules(root):
    """Equations and measurements that rules name as their sources are there."""
    texts = {name: (root / "doc" / name).read_text() if (root / "doc" / name).exists() else "" for name in ("theory.md", "linear_solvers.md", "bounds.md", "measurements.md")}
    texts["theory.md"] += texts["linear_solvers.md"] + texts["bounds.md"]  # parts of it, with its numbers
    for file in [*sorted(root.glob("packages/*/include/rpc/*/rules.hpp")), *root.glob("src/rules.hpp")]:
        for line, text in enumerate(file.read_text().splitlines(), 1):
            named = [("theory.md", equation) for equation in re.findall(r'"[^"]*(\(\d+\.\d+[a-z]?\))[^"]*"\};', text)]
            named += [("measurements.md", f"## {heading}") for heading in re.findall(r"measurements\.md: ([^\";]+)", text)]
            yield from (f"{file.relative_to(root)}:{line}: no \"{what}\" in doc/{name}" for name, what in named if what not in texts[name])


def check_rules(root):
    for package, number in rules(root).items():
        most = MOST_RULES.get(package, 0)
        if number > most:
            yield f"packages/{package}: {number} rules, more than the {most} of MOST_RULES: a new rule takes the place of another one"


def licensed(root):
    """Each file that names its licence, with the mark of its comments."""
    files = [root / "CMakeLists.txt", *(path for top in LICENSED_FOLDERS for path in sorted((root / top).rglob("*")))]
    for file in files:
        name = str(file.relative_to(root))
        if file.is_file() and (file.name in LICENSED_NAMES or name in LICENSED_NAMES or file.suffix in COMMENTS) and file.suffixes[-2:] != [".md", ".in"]:
            yield file, COMMENTS.get(file.suffix, "#")


def unlicensed(root):
    for file, mark in licensed(root):
        if f"{mark} {LICENCE}" not in file.read_text().splitlines()[:2]:
            yield file, mark


def check_licences(root):
    for file, mark in unlicensed(root):
        yield (f"{file.relative_to(root)}: the line \"{mark} {LICENCE}\" is not among the first two; "
               "remedy: python3 test/structure/structure.py --add-licence")


def add_licences(root):
    for file, mark in list(unlicensed(root)):
        lines = file.read_text().splitlines(keepends=True)
        lines.insert(1 if lines and lines[0].startswith("#!") else 0, f"{mark} {LICENCE}\n")
        file.write_text("".join(lines))
        yield str(file.relative_to(root))


def check_scripts(root):
    """What names its interpreter can be started."""
    for file, _ in licensed(root):
        if file.read_bytes().startswith(b"#!") and not os.access(file, os.X_OK):
            yield f"{file.relative_to(root)}: begins with #!, but is not executable: chmod +x"


def check_version(root):
    """CITATION.cff cites the version that CMakeLists.txt builds."""
    if (root / "CITATION.cff").exists():
        built = VERSION.findall((root / "CMakeLists.txt").read_text())
        cited = re.findall(r"^version: *([0-9.]+)", (root / "CITATION.cff").read_text(), re.MULTILINE)
        if built != cited:
            yield f"CITATION.cff: version {' '.join(cited) or 'missing'}, but CMakeLists.txt builds {' '.join(built)}"


def violations(root):
    folders = sorted(path.parent for path in root.glob("packages/*/CMakeLists.txt"))
    for folder in folders:
        if folder.name in ALLOWED:
            yield from check_includes(root, folder.name, folder)
        else:
            yield f"packages/{folder.name}: not in the table of test/structure/structure.py"
    yield from check_includes(root, "src", root / "src")
    yield from check_links(root)
    yield from check_program(root)
    yield from check_versions(root)
    yield from check_gmsh(root)
    yield from check_law(root)
    yield from check_kernels(root)
    yield from check_lengths(root)
    yield from check_namespaces_of_tests(root)
    yield from check_constants(root)
    yield from check_numbers(root)
    yield from check_rules(root)
    yield from check_sources_of_rules(root)
    yield from check_licences(root)
    yield from check_scripts(root)
    yield from check_version(root)


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--add-licence"]
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parents[2]).resolve()
    if "--add-licence" in sys.argv:
        for name in add_licences(root):
            print(name)
        return 0
    found = list(violations(root))
    for line in found:
        print(line)
    numbers = rules(root)
    print(f"rules: {', '.join(f'{package} {number}' for package, number in numbers.items())}; in all {sum(numbers.values())}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
