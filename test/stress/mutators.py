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


ANY = {"flip": flip_bytes, "insert": insert_bytes, "delete": delete_bytes, "truncate": truncate, "lines": lines,
       "number": number, "token": token}
DECK = {"xml type": xml_type, "xml string": xml_string, "xml value": xml_value, "xml name": xml_name,
        "xml expression": xml_expression, "xml cells": xml_cells, "xml extreme": xml_extreme, "xml subtree": xml_subtree,
        "xml nested": xml_nested}
MSH = {"msh node number": msh_node_number, "msh inverted": msh_inverted, "msh extra": msh_extra,
       "msh coordinate": msh_coordinate, "msh byte order": msh_byte_order}
# gmsh's language can start programs: only words of the corpus in new places, and no new ones.
GEO = {"geo lines": lines, "geo number": number, "geo token": token, "geo truncate": truncate}


def kinds_for(name):
    """The kinds of damage that suit a file, each with its weight."""
    if name.endswith(".geo"):
        return {kind: 2 for kind in GEO} | {"geo number": 4}
    weights = {kind: 2 for kind in ANY} | {"empty": 0.5, "missing": 0.5, "folder": 0.5}
    own = MSH if name.endswith(".msh") else DECK if name.endswith(".xml") else {"xml cells": xml_cells}
    return weights | {kind: 5 for kind in own} | ({"xml extreme": 12, "xml nested": 1} if own is DECK else {})


ALL = ANY | DECK | MSH | GEO
