// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace rpc::mesh
{

/// Python that reads the mesh of an Abaqus or CalculiX file, with what it includes. meshio's reader takes a set that stands in two places, or that
/// names other sets, for another one, reads no *SURFACE, and refuses a file for one spring in it. read_abaqus() takes the path and what
/// takes notes, and returns points, blocks of cells and of facets, sets of them and sets of points.
inline constexpr const char *abaqus_script = R"py(
import os
import re
import sys

# Kinds of cells by the number of their nodes, and types of elements with the table of their kinds.
SOLIDS = {4: "tetra", 5: "pyramid", 6: "wedge", 8: "hexahedron", 10: "tetra10", 13: "pyramid13", 15: "wedge15", 20: "hexahedron20", 27: "hexahedron27"}
FACES = {3: "triangle", 4: "quad", 6: "triangle6", 8: "quad8", 9: "quad9"}
KINDS = ((r"[AD]?C?C3D(\d+)\w*", SOLIDS), (r"[AD]?C?(?:CPS|CPE|CPEG|CAX|GAX|C2D|AX)(\d+)\w*", FACES),
         (r"(?:DS|S|STRI|M3D|SFM3D|R3D|MAX|SC)(\d+)\w*", FACES), (r"[CD]?T[23]D(\d)\w*", {2: "line", 3: "line3"}), (r"B[23](\d)\w*", {1: "line", 2: "line3"}))
NODES = {kind: count for kinds in (SOLIDS, FACES, {2: "line", 3: "line3"}) for count, kind in kinds.items()}
# Facets of a cell by Abaqus' numbers, and the edges whose middles are its other nodes.
TETRAHEDRON = ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)), ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
HEXAHEDRON = (((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
              ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)))
WEDGE = (((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
         ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)))
PYRAMID = (((0, 1, 2, 3), (0, 4, 1), (1, 4, 2), (2, 4, 3), (3, 4, 0)),
           ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)))
TRIANGLE = ((0, 1), (1, 2), (2, 0)), ((0, 1), (1, 2), (2, 0))
QUADRILATERAL = ((0, 1), (1, 2), (2, 3), (3, 0)), ((0, 1), (1, 2), (2, 3), (3, 0))
CELLS = {"tetra": TETRAHEDRON, "tetra10": TETRAHEDRON, "hexahedron": HEXAHEDRON, "hexahedron20": HEXAHEDRON, "wedge": WEDGE, "wedge15": WEDGE,
         "pyramid": PYRAMID, "pyramid13": PYRAMID, "triangle": TRIANGLE, "triangle6": TRIANGLE, "quad": QUADRILATERAL, "quad8": QUADRILATERAL}
FACETS = {(2, 2): "line", (3, 2): "line3", (3, 3): "triangle", (6, 3): "triangle6", (4, 4): "quad", (8, 4): "quad8"}
MAKERS = ("NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SUBMODEL", "TRANSLATE")

class Piece:
    """A keyword with its parameters, its lines of data and where it stands."""

    def __init__(self, word, parameters, where, level):
        self.word, self.parameters, self.where, self.level, self.lines = word, parameters, where, level, []

    def refuse(self, where, text):
        sys.exit(f"{where}: *{self.word}: {text}")

    def rows(self):
        """(where, words) of each line of data."""
        for where, text in self.lines:
            words = [word.strip() for word in text.split(",")]
            while words and not words[-1]:
                words.pop()
            yield where, words

    def integer(self, where, word):
        if not re.fullmatch(r"[+-]?\d{1,15}", word):
            self.refuse(where, f'a whole number was expected, got "{word[:40]}"')
        return int(word)

    def real(self, where, word):
        try:
            return float(re.sub("[dD]", "e", word))
        except ValueError:
            self.refuse(where, f'a number was expected, got "{word[:40]}"')

def abaqus_lines(path, shown, depth):
    """(where, text) of a file and of those that it includes."""
    if depth > 20:
        sys.exit(f'*INCLUDE of "{shown}": files include each other')
    with open(path, errors="replace") as file:
        number = 0
        for text in file:
            number += 1
            where = f"line {number}" + (f' of "{shown}"' if depth else "")
            text = text.strip()
            if not text or text.startswith("**"):
                continue
            while text.startswith("*") and text.endswith(","):  # the keyword goes on
                number += 1
                more = next(file, "").strip()
                if not more:
                    break
                text += more
            found = re.match(r'\*INCLUDE\s*,.*?INPUT\s*=\s*"?([^",]+)', text, re.IGNORECASE)
            if not found:
                yield where, text
                continue
            name = found[1].strip()
            inner = os.path.join(os.path.dirname(path), name)
            if not os.path.isfile(inner):
                sys.exit(f'{where}: *INCLUDE: there is no file "{name}" beside it: put it there, or give the file that has the nodes and cells')
            yield from abaqus_lines(inner, name, depth + 1)

def abaqus_pieces(path):
    pieces, levels = [], []
    for where, text in abaqus_lines(path, os.path.basename(path), 0):
        if not text.startswith("*"):
            if pieces:
                pieces[-1].lines.append((where, text))
            continue
        words = [word.strip() for word in text[1:].split(",")]
        name = " ".join(words[0].upper().split())
        parameters = {}
        for word in words[1:]:
            key, _, value = word.partition("=")
            parameters[key.strip().upper()] = value.strip().strip('"')
        if name in ("PART", "ASSEMBLY", "INSTANCE"):
            levels.append(name)
        if name.startswith("END ") and levels and name[4:] == levels[-1]:
            levels.pop()
        pieces.append(Piece(name, parameters, where, levels[-1] if levels else ""))
    return pieces

def read_abaqus(path, say):
    import numpy
    pieces = abaqus_pieces(path)
    if sum(each.word == "PART" for each in pieces) > 1:
        sys.exit("there is more than one *PART: write each part into a file of its own, or one mesh of all (in Abaqus an orphan mesh)")
    if sum(each.word == "INSTANCE" for each in pieces) > 1:
        sys.exit("there is more than one *INSTANCE: write one mesh of all of them (in Abaqus an orphan mesh)")
    for each in pieces:
        if each.word in MAKERS or each.word == "NODE" and each.parameters.get("SYSTEM", "R").upper() != "R" or each.word == "SYSTEM":
            each.refuse(each.where, "nodes and cells that the program makes itself are not read: write the mesh out in full")
        if each.word == "INSTANCE" and any(True for _ in each.rows()):
            say("*INSTANCE moves the part: it stays where its own nodes are")
    coords, names = {}, {}  # of nodes; the first spelling of names, which do not depend on case
    members = {"ELSET": {}, "NSET": {}}  # name -> numbers and names

    def of_set(word, name):
        key = name.upper()
        return members[word].setdefault(names.setdefault((word, key), name), [])

    blocks, ids, at = [], [], {}  # kind and nodes of cells; their numbers; number -> block and place
    left_out = {}
    for each in pieces:
        if each.word not in ("NODE", "ELEMENT"):
            continue
        if each.level == "ASSEMBLY":
            say(f"{each.where}: nodes and elements of *ASSEMBLY, such as reference points, are left out")
            continue
        if each.word == "NODE":
            for where, words in each.rows():
                node = each.integer(where, words[0]) if words else 0
                place = [each.real(where, word or "0") for word in words[1:4]]
                if not place:
                    each.refuse(where, "a number and two or three coordinates were expected")
                place += [0.0] * (3 - len(place))
                if coords.setdefault(node, place) != place:
                    each.refuse(where, f"there are two nodes {node}")
                if each.parameters.get("NSET"):
                    of_set("NSET", each.parameters["NSET"]).append(node)
            continue
        kind, width, type_name = "", 0, each.parameters.get("TYPE", "").upper()
        for pattern, kinds in KINDS:
            found = re.fullmatch(pattern, type_name)
            if found and int(found[1]) in kinds:
                kind, width = kinds[int(found[1])], NODES[kinds[int(found[1])]]
        if not kind:
            left_out[type_name] = left_out.get(type_name, 0) + len(each.lines)
            continue
        numbers = [(where, each.integer(where, word)) for where, words in each.rows() for word in words]
        if len(numbers) % (width + 1):
            each.refuse(numbers[-1][0], f"an element of type {type_name} has a number and {width} nodes: the last one is not whole")
        cells = []
        for first in range(0, len(numbers), width + 1):
            number = numbers[first][1]
            for where, node in numbers[first + 1:first + width + 1]:
                if node not in coords:
                    each.refuse(where, f"element {number} uses node {node}, which the file lacks")
            if number in at:
                each.refuse(numbers[first][0], f"there are two elements {number}")
            at[number] = (len(blocks), len(cells))
            cells.append([node for _, node in numbers[first + 1:first + width + 1]])
            if kind == "line3":  # Abaqus has the middle node in the middle, gmsh at the end
                centre = numpy.mean([coords[node] for node in cells[-1]], axis=0)
                cells[-1].sort(key=lambda node: -numpy.linalg.norm(numpy.array(coords[node]) - centre))
            if each.parameters.get("ELSET"):
                of_set("ELSET", each.parameters["ELSET"]).append(number)
        if cells:
            blocks.append((kind, cells))
    for type_name, count in left_out.items():
        say(f"*ELEMENT of type {type_name or 'none'} in {count} lines is left out: it is no cell of a body")
    for each in pieces:
        if each.word not in members:
            continue
        name = each.parameters.get(each.word, "")
        if not name:
            each.refuse(each.where, f"it has no {each.word}=name")
        if each.level == "ASSEMBLY" and "INSTANCE" not in each.parameters:
            say(f'*{each.word} "{name}" of *ASSEMBLY names no instance: it is left out')
            continue
        own = of_set(each.word, name)
        for where, words in each.rows():
            if "GENERATE" in each.parameters:
                first, last, step = ([each.integer(where, word) for word in words] + [1])[:3] if len(words) in (2, 3) else (1, 0, 0)
                if step < 1 or last < first or last - first > 10**8:
                    each.refuse(where, "GENERATE takes first, last and step")
                own += range(first, last + 1, step)
            else:
                own += [int(word) if re.fullmatch(r"\d{1,15}", word) else word for word in words if word]

    def resolved(word, name, known, depth=0):
        """Numbers of a set, without those that there are not."""
        found = set()
        for item in members[word].get(names.get((word, name.upper())), []):
            if isinstance(item, int):
                found.add(item)
            elif depth > 20:
                sys.exit(f"*{word} {name}: sets name each other")
            else:
                inner = item.rpartition(".")[2]
                if (word, inner.upper()) not in names:
                    say(f'*{word} "{name}" names "{item}", which there is not')
                found |= resolved(word, inner, known, depth + 1)
        return {number for number in found if number in known}

    order = {node: k for k, node in enumerate(coords)}
    sets, point_sets = {}, {}
    given = {each.parameters.get("ELSET", "").upper() for each in pieces if each.word == "ELSET"}  # before those of *ELEMENT
    for name, own in sorted(members["ELSET"].items(), key=lambda item: item[0].upper() not in given):
        numbers = resolved("ELSET", name, at)
        if any(isinstance(item, int) and item not in at for item in own):
            say(f'*ELSET "{name}" names elements that there are not, or that are left out')
        if numbers:
            sets[name] = [numpy.array(sorted(at[n][1] for n in numbers if at[n][0] == b), dtype=int) for b in range(len(blocks))]
    for name, own in members["NSET"].items():
        numbers = resolved("NSET", name, order)
        if any(isinstance(item, int) and item not in order for item in own):
            say(f'*NSET "{name}" names nodes that there are not')
        if len(numbers) == len(order):
            say(f'*NSET "{name}" has all nodes: it is left out')
        elif numbers:
            point_sets[name] = [order[n] for n in sorted(numbers)]
    sides = {}  # name and kind -> nodes of facets
    for each in pieces:
        if each.word != "SURFACE":
            continue
        name, of_nodes = each.parameters.get("NAME", ""), each.parameters.get("TYPE", "").upper() == "NODE"
        for where, words in each.rows():
            item, side = (words + ["", ""])[:2]
            inner, numeric = item.rpartition(".")[2], re.fullmatch(r"\d{1,15}", item)
            if of_nodes:
                nodes = {int(item)} & order.keys() if numeric else resolved("NSET", inner, order)
                point_sets[name] = sorted(set(point_sets.get(name, [])) | {order[n] for n in nodes})
                continue
            numbers = {int(item)} & at.keys() if numeric else resolved("ELSET", inner, at)
            taken = 0
            for number in sorted(numbers):
                kind, cell = blocks[at[number][0]][0], blocks[at[number][0]][1][at[number][1]]
                facets, edges = CELLS.get(kind, ((), ()))
                face = int(side[1:]) if re.fullmatch("[Ss][1-6]", side) else 0
                if not 0 < face <= len(facets):
                    continue
                corners = facets[face - 1]
                nodes = [cell[c] for c in corners]
                curved = len(cell) - len(edges)  # corners of a curved cell; fewer where it has straight edges
                if curved > max(map(max, edges)):
                    around = [corners] if len(corners) == 2 else zip(corners, corners[1:] + corners[:1])
                    nodes += [cell[curved + next(k for k, e in enumerate(edges) if set(e) == set(pair))] for pair in around]
                sides.setdefault((name, FACETS[len(nodes), len(corners)]), []).append(nodes)
                taken += 1
            if taken < max(len(numbers), 1):
                say(f'{where}: *SURFACE "{name}": of {len(numbers)} elements of "{item}" {len(numbers) - taken} have no facet "{side}": they are left out')
    if not blocks:
        sys.exit("there are no cells of a body in it, such as *ELEMENT, TYPE=C3D8: give the file that has them")
    cells = len(blocks)
    for (name, kind), nodes in sides.items():
        of_set = sets.setdefault(name, [numpy.array([], dtype=int)] * cells)
        of_set += [numpy.array([], dtype=int)] * (len(blocks) - len(of_set)) + [numpy.arange(len(nodes))]
        blocks.append((kind, nodes))
    for of_set in sets.values():
        of_set += [numpy.array([], dtype=int)] * (len(blocks) - len(of_set))
    width = 2 if all(place[2] == 0 for place in coords.values()) else 3
    points = numpy.array(list(coords.values()), dtype=float)[:, :width]
    return points, [(kind, numpy.array([[order[n] for n in cell] for cell in nodes])) for kind, nodes in blocks], sets, point_sets
)py";

} // namespace rpc::mesh
