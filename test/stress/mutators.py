# SPDX-License-Identifier: BSD-3-Clause
"""Kinds of damage to a scene. Each is a function of a random generator, a scene and its other files' texts."""

import re
import struct

NUMBER = re.compile(rb"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
TOKEN = re.compile(rb"[A-Za-z_][A-Za-z_0-9']*|" + NUMBER.pattern)
ATTRIBUTE = re.compile(rb'(name|type|value)="([^"]*)"')
EXTREMES = [b"nan", b"inf", b"-inf", b"1e308", b"-1e308", b"1e-308", b"0", b"-0", b"-1", b"2147483647", b"2147483648",
            b"-2147483648", b"9e18", b"9223372036854775808", b"1e-16", b"1e30", b"0x10", b"1e999", b"1.5", b"3", b""]
TYPES = [b"double", b"int", b"bool", b"string", b"Array(double)", b"Array(int)", b"Array(string)", b"float", b"long",
         b"TwoDArray(double)", b"", b"Array(", b"object"]
CELLS = [b"{100000, 100000}", b"{2147483647, 1}", b"{1, 2147483647}", b"{30000, 30000}", b"{1, 1}", b"{1000, 1000, 1000}",
         b"{2147483647, 2147483647, 2147483647}", b"{10000, 3000}", b"{0, 0}", b"{}", b"{1}", b"{1, 1, 1, 1}", b"{2000000, 2}"]
EXPRESSIONS = [b"((x", b"x)", b"x/0", b"0/0", b"1/x", b"foo(x)", b"x y", b"x++", b"sqrt(-1-x)", b"1e308*10*x", b"x=3",
               b"1,2", b"x ?", b"x ? 1", b"log(x)", b"-inf*x", b"y^(-1e308)", b"z", b"t", b"rnd()", b"_pi", b"min()",
               b"&quot;x&quot;", b"inf", b"-inf", b"nan", b"inf-inf+x", b"x%2", b"0*x", b"1e-320*x",
               b"(" * 200 + b"x" + b")" * 200, b"(" * 20000 + b"x" + b")" * 20000, b"-" * 5000 + b"x",
               b"+".join([b"x"] * 5000), b"sin(" * 500 + b"x" + b")" * 500, b"x" + b"?1:x" * 3000, b"x" * 100000]
STRINGS = [b"", b" ", b"\xff\xfe", b"\x01\x02\x1b[31m", b"a" * 33, b"b" * 300, b"n" * 100000, "naïve-Ω".encode(), b"../../x",
           b"/dev/null", b"/", b".", b"a\nb", b"%s%n", b"&lt;&amp;", b"&#0;", b"\x00", b"->", b"*", b"**", b"top", b"left",
           b"bottom", b"nowhere", b"a, b", b"0, 1", b"0, -1", b"1e308, 1e308", b"{" + b"0, " * 100000 + b"0}", b"{0}", b"{nan, 0}",
           b"{1e308, -1e308}", b"{{0}}", b"true", b"no"]


OBSTACLES = [f'<ParameterList name="Obstacle">{"".join(given)}</ParameterList>'.encode() for given in [
    ['<Parameter name="Type" type="string" value="sphere"/>', '<Parameter name="Radius" type="double" value="1"/>'],
    ['<Parameter name="Type" type="string" value="sphere"/>', '<Parameter name="Centre" type="Array(double)" value="{0.5, 0.5, 0.5}"/>',
     '<Parameter name="Radius" type="double" value="0.3"/>'],
    ['<Parameter name="Type" type="string" value="sphere"/>', '<Parameter name="Centre" type="Array(double)" value="{0, 0, 0}"/>',
     '<Parameter name="Radius" type="double" value="1e-9"/>', '<Parameter name="Encloses Body" type="bool" value="true"/>'],
    ['<Parameter name="Type" type="string" value="sphere"/>', '<Parameter name="Centre" type="Array(double)" value="{0, -1e6}"/>',
     '<Parameter name="Radius" type="double" value="1e6"/>'],
    ['<Parameter name="Type" type="string" value="cylinder"/>', '<Parameter name="Point" type="Array(double)" value="{0, -2, 0}"/>',
     '<Parameter name="Axis" type="Array(double)" value="{0, 0, 0}"/>', '<Parameter name="Radius" type="double" value="2"/>'],
    ['<Parameter name="Type" type="string" value="cylinder"/>', '<Parameter name="Point" type="Array(double)" value="{0.5, 0, 0.5}"/>',
     '<Parameter name="Axis" type="Array(double)" value="{0, 1, 0}"/>', '<Parameter name="Radius" type="double" value="3"/>'],
    ['<Parameter name="Type" type="string" value="cylinder"/>', '<Parameter name="Point" type="Array(double)" value="{0.5, -2, 0.5}"/>',
     '<Parameter name="Axis" type="Array(double)" value="{1, 0, 1e-300}"/>', '<Parameter name="Radius" type="double" value="2"/>'],
    ['<Parameter name="Type" type="string" value="plane"/>', '<Parameter name="Point" type="Array(double)" value="{0, 0, 0}"/>',
     '<Parameter name="Normal" type="Array(double)" value="{0, -1, 0}"/>'],
    ['<Parameter name="Type" type="string" value="plane"/>', '<Parameter name="Point" type="Array(double)" value="{0, 0, 0}"/>',
     '<Parameter name="Normal" type="Array(double)" value="{1, 0, 0}"/>'],
]]
KINEMATICS = [b"axisymmetric", b"plane stress", b"plane strain", b"spherical", b""]
# gmsh's number of each kind of cell or facet: its nodes. Among them what rpc refuses: prisms, pyramids, 20-node hexahedra.
MSH_NODES = {1: 2, 2: 3, 3: 4, 4: 4, 5: 8, 6: 6, 7: 5, 8: 3, 9: 6, 10: 9, 11: 10, 12: 27, 13: 18, 14: 14, 15: 1, 16: 8, 17: 20, 18: 15, 19: 13, 29: 20}


def replace_at(data, match, piece, group=0):
    return data[:match.start(group)] + piece + data[match.end(group):]


def pick(rng, pattern, data):
    """A random match of a pattern, None if there is none."""
    matches = list(pattern.finditer(data))
    return rng.choice(matches) if matches else None


def swap(items, i, j):
    items[i], items[j] = items[j], items[i]


# Of any file's bytes: (rng, data, pool) -> data, where pool holds the data of all other files of the same kind.


def flip_bytes(rng, data, pool):
    data = bytearray(data)
    for _ in range(rng.choice([1, 1, 1, 3, 10])):
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return bytes(data)


def insert_bytes(rng, data, pool):
    at = rng.randrange(len(data) + 1)
    return data[:at] + rng.choice([rng.randbytes(rng.randint(1, 8)), b"\0", b"\n", b"<", b'"', b"-", b"9"]) + data[at:]


def delete_bytes(rng, data, pool):
    at = rng.randrange(len(data))
    return data[:at] + data[at + rng.choice([1, 1, 2, 8, 50]):]


def truncate(rng, data, pool):
    return data[:rng.randrange(len(data))]


def lines(rng, data, pool):
    """Duplicated, swapped, dropped."""
    parts = data.split(b"\n")
    i, j = rng.randrange(len(parts)), rng.randrange(len(parts))
    choice = rng.choice(["duplicate", "swap", "drop", "move"])
    if choice == "duplicate":
        parts.insert(j, parts[i])
    elif choice == "swap":
        swap(parts, i, j)
    elif choice == "drop":
        del parts[i]
    else:
        parts.insert(j, parts.pop(i))
    return b"\n".join(parts)


def number(rng, data, pool):
    match = pick(rng, NUMBER, data)
    return replace_at(data, match, rng.choice(EXTREMES)) if match else data


def token(rng, data, pool):
    """A token of another file, or of the same, in the place of one."""
    match, other = pick(rng, TOKEN, data), pick(rng, TOKEN, rng.choice(pool + [data]))
    return replace_at(data, match, other[0]) if match and other else data


# Of decks


def attribute(rng, data, name, pieces):
    matches = [match for match in ATTRIBUTE.finditer(data) if match[1] == name]
    return replace_at(data, rng.choice(matches), rng.choice(pieces), 2) if matches else data


def xml_type(rng, data, pool):
    return attribute(rng, data, b"type", TYPES)


def xml_string(rng, data, pool):
    return attribute(rng, data, b"value", STRINGS)


def xml_value(rng, data, pool):
    """A value of another parameter."""
    values = [match[2] for match in ATTRIBUTE.finditer(rng.choice(pool + [data])) if match[1] == b"value"]
    return attribute(rng, data, b"value", values or [b"1"])


def xml_name(rng, data, pool):
    names = [match[2] for match in ATTRIBUTE.finditer(rng.choice(pool + [data])) if match[1] == b"name"]
    return attribute(rng, data, b"name", STRINGS + 2 * names)


def xml_expression(rng, data, pool):
    places = [match for match in re.finditer(rb'name="(?:X|Y|Z|Gap|Yield Stress)" type="(\w+)" value="([^"]*)"', data)]
    if not places:
        return data
    place = rng.choice(places)
    data = replace_at(data, place, rng.choice(EXPRESSIONS), 2)
    return replace_at(data, place, b"string", 1)


def xml_cells(rng, data, pool):
    places = list(re.finditer(rb'type="Array\(int\)" value="([^"]*)"|Cells: (.*)', data))
    if not places:
        return data
    place = rng.choice(places)
    return replace_at(data, place, rng.choice(CELLS), 1 if place[1] is not None else 2)


def xml_extreme(rng, data, pool):
    """A number in a value."""
    matches = [match for match in ATTRIBUTE.finditer(data) if match[1] == b"value" and NUMBER.search(match[2])]
    if not matches:
        return number(rng, data, pool)
    match = rng.choice(matches)
    return replace_at(data, match, number(rng, match[2], pool), 2)


def xml_obstacle(rng, data, pool):
    """Another foundation, of the wrong dimension perhaps, within the body, without a normal, or one that the body does not face."""
    match = pick(rng, re.compile(rb'<ParameterList name="Obstacle">.*?</ParameterList>', re.DOTALL), data)
    if match:
        return replace_at(data, match, rng.choice(OBSTACLES))
    begin = data.find(b'<ParameterList name="Contact">')
    return data if begin < 0 else data[:begin + 30] + rng.choice(OBSTACLES) + data[begin + 30:]


def xml_kinematics(rng, data, pool):
    begin = data.find(b"<ParameterList name=\"Mesh\">")
    given = b'<Parameter name="Kinematics" type="string" value="' + rng.choice(KINEMATICS) + b'"/>\n'
    return data if begin < 0 else data[:begin] + given + data[begin:]


def subtrees(data):
    """(begin, end) of every element, with the blanks before it."""
    found, open_lists = [], []
    for tag in re.finditer(rb"\s*<(/?)(ParameterList|Parameter)\b([^>]*?)(/?)>", data):
        if tag[1]:
            if open_lists:
                found.append((open_lists.pop(), tag.end()))
        elif tag[4]:
            found.append((tag.start(), tag.end()))
        else:
            open_lists.append(tag.start())
    return found


def xml_subtree(rng, data, pool):
    """Duplicated, swapped, dropped, put elsewhere, or one of another deck."""
    parts = subtrees(data)
    if not parts:
        return lines(rng, data, pool)
    a, b = sorted([rng.choice(parts), rng.choice(parts)])
    one, two = data[a[0]:a[1]], data[b[0]:b[1]]
    choice = rng.choice(["duplicate", "swap", "drop", "into", "foreign"])
    if choice == "drop":
        return data[:b[0]] + data[b[1]:]
    if choice == "swap" and a[1] <= b[0]:
        return data[:a[0]] + two + data[a[1]:b[0]] + one + data[b[1]:]
    other = rng.choice(pool + [data])
    if choice == "foreign" and subtrees(other):
        begin, end = rng.choice(subtrees(other))
        return data[:b[0]] + other[begin:end] + data[b[1]:]
    return data[:b[0]] + one + data[b[0]:]


def xml_nested(rng, data, pool):
    """A list within a list within a list ..."""
    depth = rng.choice([10, 1000, 20000, 200000])
    end = data.rfind(b"</ParameterList>")
    if end < 0:
        return data
    return data[:end] + b'<ParameterList name="n">' * depth + b"</ParameterList>" * depth + data[end:]


# Of meshes


def msh_rows(data, section):
    """(begin, end) of the lines of a section, without its first two."""
    begin, end = data.find(b"$" + section + b"\n"), data.find(b"$End" + section)
    if begin < 0 or end < 0:
        return []
    rows, at = [], begin
    for line in data[begin:end].splitlines(keepends=True):
        rows.append((at, at + len(line)))
        at += len(line)
    return rows[2:]


def msh_node_number(rng, data, pool):
    """Another node in an element: out of range, of elsewhere, twice the same."""
    rows = msh_rows(data, b"Elements")
    if not rows:
        return number(rng, data, pool)
    begin, end = rng.choice(rows)
    words = data[begin:end].split()
    if not words:
        return data
    words[rng.randrange(len(words))] = rng.choice([b"0", b"-1", b"1", b"2", b"30", b"999999", b"99999999999", words[-1]])
    return data[:begin] + b" ".join(words) + b"\n" + data[end:]


def msh_inverted(rng, data, pool):
    """Two nodes of an element swapped."""
    rows = msh_rows(data, b"Elements")
    if not rows:
        return flip_bytes(rng, data, pool)
    begin, end = rng.choice(rows)
    words = data[begin:end].split()
    if len(words) > 2:
        swap(words, -1, -2)
    return data[:begin] + b" ".join(words) + b"\n" + data[end:]


def msh_extra(rng, data, pool):
    """A row of nodes or elements more, with the count raised in some cases."""
    section = rng.choice([b"Nodes", b"Elements"])
    rows = msh_rows(data, section)
    if not rows:
        return number(rng, data, pool)
    begin, end = rng.choice(rows)
    words = data[begin:end].split()
    if words and rng.random() < 0.7:
        words[0] = b"%d" % rng.randint(1, 60)
    data = data[:begin] + b" ".join(words) + b"\n" + data[begin:]
    count = re.compile(rb"\$" + section + rb"\n(\d+)\n").search(data)
    return replace_at(data, count, b"%d" % (int(count[1]) + 1), 1) if count and rng.random() < 0.8 else data


def msh_coordinate(rng, data, pool):
    rows = msh_rows(data, b"Nodes")
    if not rows:
        at = rng.randrange(len(data) - 8)
        value = rng.choice([float("nan"), float("inf"), 1e308, -1e308, 1e-308, 0., -1., 1e30])
        return data[:at] + struct.pack("<d", value) + data[at + 8:]
    begin, end = rng.choice(rows)
    return data[:begin] + number(rng, data[begin:end], pool) + data[end:]


def msh_elements(data):
    """(begin, end, words, place of its first node) of the elements of an ASCII file of version 2.2."""
    found = []
    for begin, end in msh_rows(data, b"Elements") if b"2.2 0 8" in data else []:
        words = data[begin:end].split()
        if len(words) > 3 and words[2].isdigit() and 3 + int(words[2]) < len(words):
            found.append((begin, end, words, 3 + int(words[2])))
    return found


def with_row(data, begin, end, words):
    return data[:begin] + b" ".join(words) + b"\n" + data[end:]


def msh_kind(rng, data, pool):
    """A cell or facet of another kind, with as many nodes as that has, and at times of a kind that does not fit its nodes."""
    elements = msh_elements(data)
    if not elements:
        return msh_node_number(rng, data, pool)
    begin, end, words, first = rng.choice(elements)
    kind = rng.choice(list(MSH_NODES))
    nodes = words[first:]
    if rng.random() < 0.8:
        nodes = [nodes[k % len(nodes)] for k in range(MSH_NODES[kind])]
    return with_row(data, begin, end, [words[0], b"%d" % kind] + words[2:first] + nodes)


def msh_turned(rng, data, pool):
    """The nodes of some elements in the opposite order: of a facet no fault, of a cell one."""
    for _ in range(rng.choice([1, 1, 5])):
        elements = msh_elements(data)
        if not elements:
            return msh_inverted(rng, data, pool)
        begin, end, words, first = rng.choice(elements)
        data = with_row(data, begin, end, words[:first] + words[first:][::-1])
    return data


def msh_inside(rng, data, pool):
    """The nodes of another element for a facet: one that lies inside of the body, or belongs to no cell, or stands there twice."""
    elements = msh_elements(data)
    if not elements:
        return msh_extra(rng, data, pool)
    (begin, end, words, first), (_, _, other, start) = elements[rng.randrange(max(1, len(elements) // 2))], rng.choice(elements)
    nodes = rng.sample(other[start:], min(len(words), len(other)) - first) if rng.random() < 0.5 else other[start:start + len(words) - first]
    return with_row(data, begin, end, words[:first] + nodes)


def msh_places(rng, data, pool):
    """Coordinates of many nodes: mirrored, moved, flattened, or the last nodes of a cell, its middle ones, moved on their own."""
    rows = msh_rows(data, b"Nodes") if b"2.2 0 8" in data else []
    rows = [(begin, end) for begin, end in rows if len(data[begin:end].split()) == 4]
    if not rows:
        return msh_coordinate(rng, data, pool)
    places = {words[0]: [float(word) for word in words[1:]] for words in (data[begin:end].split() for begin, end in rows)}
    kind, c = rng.choice(["mirror", "move", "flatten", "middle", "middle", "far"]), rng.randrange(3)
    chosen = list(places)
    if kind == "middle":
        elements = msh_elements(data)
        _, _, words, first = rng.choice(elements)
        chosen = [node for node in words[max(first, len(words) - rng.randint(1, 4)):] if node in places]
    for node in chosen:
        place = places[node]
        place[c] = {"mirror": -place[c], "move": place[c] - 0.5, "flatten": 0.0, "middle": place[c] + rng.uniform(-0.4, 0.4),
                    "far": place[c] + 1e9}[kind]
    text = b"".join(node + b" " + b" ".join(repr(v).encode() for v in place) + b"\n" for node, place in places.items())
    return data[:rows[0][0]] + text + data[rows[-1][1]:]


def msh_byte_order(rng, data, pool):
    """All words of the sections turned around, as another kind of machine writes them."""
    one = data.find(struct.pack("<i", 1), data.find(b"$MeshFormat"))
    if b"2.2 1 8" not in data and b"4.1 1 8" not in data:
        return data[::-1]
    mode, width = rng.choice(["mark", "rest", "all"]), rng.choice([4, 8])
    if mode != "rest":
        data = data[:one] + struct.pack(">i", 1) + data[one + 4:]
    if mode != "mark":
        begin = data.find(b"\n", data.find(b"$Nodes") + 7) + 1 if width == 4 else data.find(b"$Nodes") + 7
        end = data.find(b"$EndNodes")
        body = data[begin:end]
        turned = b"".join(body[k:k + width][::-1] for k in range(0, len(body), width))
        data = data[:begin] + turned + data[end:]
    return data


def exodus_number(rng, data, pool):
    """Another number of 4 bytes in NetCDF's order, in the header or in the arrays."""
    if len(data) < 8:
        return data
    at = rng.randrange(len(data) // 4) * 4
    return data[:at] + struct.pack(">i", rng.choice([0, -1, 1, 2, 7, 33, 1000000, 2**31 - 1, -2**31])) + data[at + 4:]


ANY = {"flip": flip_bytes, "insert": insert_bytes, "delete": delete_bytes, "truncate": truncate, "lines": lines,
       "number": number, "token": token}
DECK = {"xml type": xml_type, "xml string": xml_string, "xml value": xml_value, "xml name": xml_name,
        "xml expression": xml_expression, "xml cells": xml_cells, "xml extreme": xml_extreme, "xml subtree": xml_subtree,
        "xml nested": xml_nested, "xml obstacle": xml_obstacle, "xml kinematics": xml_kinematics}
MSH = {"msh node number": msh_node_number, "msh inverted": msh_inverted, "msh extra": msh_extra,
       "msh coordinate": msh_coordinate, "msh byte order": msh_byte_order, "msh kind": msh_kind, "msh turned": msh_turned,
       "msh inside": msh_inside, "msh places": msh_places}
EXODUS = {"exodus number": exodus_number}
# gmsh's language can start programs: only words of the corpus in new places, and no new ones.
GEO = {"geo lines": lines, "geo number": number, "geo token": token, "geo truncate": truncate}


def kinds_for(name):
    """The kinds of damage that suit a file, each with its weight."""
    if name.endswith(".geo"):
        return {kind: 2 for kind in GEO} | {"geo number": 4}
    weights = {kind: 2 for kind in ANY} | {"empty": 0.5, "missing": 0.5, "folder": 0.5}
    own = MSH if name.endswith(".msh") else DECK if name.endswith(".xml") else EXODUS if name.endswith(".exo") else \
        {"xml cells": xml_cells} if name.endswith(".yaml") else {}
    return weights | {kind: 5 for kind in own} | ({"xml extreme": 12, "xml nested": 1, "xml kinematics": 2} if own is DECK else {})


ALL = ANY | DECK | MSH | EXODUS | GEO
