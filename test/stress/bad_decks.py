# SPDX-License-Identifier: BSD-3-Clause
"""Decks as people get them wrong: slips of the finger, decimal commas, units, lists and words of other programs, tags that do not
close. Each is to be refused with exit code 2 in one line, which names place, value, rule and remedy.

    bad_decks.py --rpc=build/rpc [--seed=1] [--count=300] [--only=17] [--print]

Deck K depends on the seed and K alone. --print shows each message, for a reader to judge. The exit code is 1 if a message lacks something.
"""

import argparse
import collections
import concurrent.futures
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BASES = [SOURCE / "input" / name for name in ("beam.xml", "shear.xml", "block.xml", "manufactured.xml")]
BASES += [SOURCE / "input" / "templates" / f"{name}.xml" for name in ("footing", "load-steps", "friction", "axisymmetric", "springs", "adaptive")]

RULE = re.compile(r"must|does not read|is no |names (the side|a block)|unknown (parameter|type)|lacks|clos|given twice|has no |is written|has typographic|no quotes"
                  r"|stands between|is a list|not a number|is indented|a tab stands|there is no file|is not read|not go with|is missing|needs a value|are open|is open|is wanted|is no comment|does not end|syntax error|=")
REMEDY = re.compile(r"Write |write |Did you mean|In a deck that is|another list|Remove|End it|Valid here|Its sides|Give all|name the file|Leave out|is written|are written"
                    r"|such as|must be in|must be >|one of |Add it|Variables|takes its mesh|does not read\.|name it|None of|It knows"
                    r"|Name the entry|Look for|close \"|take one of|belongs? into|lie within|is prescribed in|is read|the weight is|is named by")


NOT = "not: "  # before a part that a message must not have


class Unfit(Exception):
    """A base without what a kind of mistake needs."""


def line_of(text, at):
    return text.count("\n", 0, at) + 1


def pick(rng, text, pattern):
    found = list(re.finditer(pattern, text))
    if not found:
        raise Unfit
    return rng.choice(found)


def put(text, match, new, group=1):
    """The text with a group of a match replaced, and the line of that."""
    return text[:match.start(group)] + new + text[match.end(group):], line_of(text, match.start(group))


def slip(rng, word):
    """A slip of the finger."""
    for _ in range(50):
        k = rng.randrange(len(word) - 1)
        slips = [word[:k] + word[k + 1] + word[k] + word[k + 2:], word[:k] + word[k + 1:], word[:k] + word[k] + word[k:],
                 word.lower(), word.upper(), word.replace(" ", "_"), word.replace("'", ""), word[:k] + rng.choice("aeinrst") + word[k + 1:]]
        wrong = rng.choice(slips)
        if wrong != word and wrong.strip() == wrong and len(wrong) > 1:
            return wrong
    raise Unfit


NUMBER = r'name="([^"]+)" type="double" value="(-?[\d.e]+)"'
EXPRESSION = r'name="(?:X|Y|Z|Gap|Yield Stress)" type="string" value="([^"]*[xyt*][^"]*)"'
PARAMETER = r'<Parameter name="([^"]+)"'
LISTS = r'<ParameterList name="(Mesh|Material|Dirichlet|Traction|Contact|Steps|Units|Body Force|Adapt)"'
FREE_NAMES = {"X", "Y", "Z"}


# Each returns the deck's text, the line of the mistake (None: no line is told) and what the message is to hold; then other files beside the deck,
# and the exit code where it is not 2.

def decimal_comma(rng, text):
    m = pick(rng, text, r'type="double" value="(-?\d+\.\d+)"')
    wrong = m[1].replace(".", ",")
    return *put(text, m, wrong), [f'"{wrong}"', m[1].rstrip("0")]


def unit(rng, text):
    m = pick(rng, text, NUMBER)
    name = rng.choice(["GPa", "MPa", "kN/m^2", "N/mm2", "mm", "kN", "psi", "kN/m3"])
    wrong = m[2] + rng.choice([" ", ""]) + name
    new, line = put(text, m, wrong, 2)
    no_unit = "is a number without a unit: write "
    return new, line, [f'"{wrong}"', (f'without "{name}"', f'"{name}" is a unit of', no_unit), ("with mm and N", "is wanted [", no_unit, f'"{name}": 0.')]


def unit_in_expression(rng, text):
    m = pick(rng, text, r'name="(?:Y|X|Z|Yield Stress|Gap)" type="(?:double|string)" value="([\d.]+)"')
    new, line = put(text, m, m[1] + " MPa")
    return new.replace('type="double" value="' + m[1] + " MPa", 'type="string" value="' + m[1] + " MPa"), line, [m[1] + " MPa", ('without "MPa"', '"MPa" is a unit of pressure, where')]


def other_number(rng, text):
    m = pick(rng, text, NUMBER)
    wrong = rng.choice(["2.1d5", "210 000", "210'000", "2.1*10^5", "2,1e5", "1,000,000", "\u22125.5", "210.000,0"])
    new, line = put(text, m, wrong, 2)
    return new, line, [f'"{wrong}"', "Write "]


def comma_in_expression(rng, text):
    m = pick(rng, text, EXPRESSION)
    return *put(text, m, "0,5*(" + m[1] + ")"), ["a point: 0.5"]


def name_in_expression(rng, text):
    m = pick(rng, text, EXPRESSION)
    wrong, right = rng.choice([("Sin(x)", '"sin"'), ("PI", '"pi"'), ("2*X", '"x"'), ("time", "write t"), ("pow(x, 2)", "a^b"), ("np.sin(x)", 'Leave out "np."'),
                               ("fabs(x)", "write abs"), ("x**2", "written ^"), ("sqroot(x)", '"sqrt"'), ("r", "sqrt(x^2")])
    return *put(text, m, wrong), [wrong, right]


def bracket_in_expression(rng, text):
    m = pick(rng, text, EXPRESSION)
    return *put(text, m, "2*(" + m[1]), ['")" is missing']


def parameter_name(rng, text):
    m = pick(rng, text, PARAMETER)
    if m[1] in FREE_NAMES:
        raise Unfit
    wrong = slip(rng, m[1])
    new, line = put(text, m, wrong)
    if wrong == wrong.upper() and len(m[1]) < 3:
        raise Unfit
    return new, line, [f'{wrong}"', f'"{m[1]}"']


def component_name(rng, text):
    m = pick(rng, text, r'<Parameter name="([XYZ])"')
    wrong = rng.choice([m[1].lower(), m[1].lower() + " ", str(1 + "XYZ".index(m[1]))])
    return *put(text, m, wrong), [f'{wrong}"', f'Did you mean "{m[1]}"?']


def list_name(rng, text):
    m = pick(rng, text, LISTS)
    wrong = slip(rng, m[1])
    return *put(text, m, wrong), [f'"{wrong}"', f'Did you mean "{m[1]}"?']


def other_name(rng, text):
    old, new, right = rng.choice([("Young's Modulus", "E", "Young's Modulus"), ("Poisson's Ratio", "nu", "Poisson's Ratio"), ("Contact", "Foundation", "Contact"),
                                  ("Dirichlet", "Boundary Conditions", "Dirichlet"), ("Traction", "Loads", "Traction"), ("Mesh", "Geometry", "Mesh"),
                                  ("Yield Stress", "xi", "Yield Stress"), ("Cells", "nx", "Cells"), ("Steps", "Load Steps", "Steps"),
                                  ("Friction Coefficient", "mu", "Friction Coefficient"), ("Element", "Element Type", "Element")])
    m = pick(rng, text, f'name="({old})"')
    return *put(text, m, new), [f'{new}"', right]


def side_name(rng, text):
    m = pick(rng, text, r'name="Side" type="string" value="([^"]+)"')
    wrong = rng.choice([m[1].capitalize(), m[1].upper(), slip(rng, m[1])])
    return *put(text, m, wrong), [f'"{wrong}"', f'Did you mean "{m[1]}"?']


def entry_name(rng, text):
    part = pick(rng, text, r'(?s)<ParameterList name="(?:Dirichlet|Traction)">(.*?\n  </ParameterList>)')
    m = pick(rng, part[1], r'<ParameterList name="([a-z]+)"')
    wrong = rng.choice([m[1].capitalize(), slip(rng, m[1])])
    at = part.start(1)
    return text[:at + m.start(1)] + wrong + text[at + m.end(1):], line_of(text, at + m.start(1)), [f'"{wrong}"', "Its sides: ", f'Did you mean "{m[1]}"?']


def word(rng, text):
    name, right = rng.choice([("Element", "Q1"), ("Kinematics", "axisymmetric"), ("Element", "Q2"), ("Element", "P2")])
    m = pick(rng, text, f'name="{name}" type="string" value="({right})"')
    wrong = rng.choice([right.lower() if right[0].isupper() else right.capitalize(), "CPE4", "quad", right + " "[:0] + "x"])
    return *put(text, m, wrong), [f'"{wrong}"', "must be one of "]


def unclosed_parameter(rng, text):
    m = pick(rng, text, r'<Parameter name="[^"]+" type="[^"]+" value="[^"]*"(/>)')
    return *put(text, m, ">"), ["is not closed", '"/>"']


def unclosed_list(rng, text):
    m = pick(rng, text, r"\n +(</ParameterList>)")
    opening = re.findall(r"(?m)^" + text[m.start() + 1:m.start(1)] + r'<ParameterList name="([^"]+)"', text[:m.start()])
    return put(text, m, "")[0], None, [f'<ParameterList name="{opening[-1]}"> of line', "Write </ParameterList>"]


def wrong_closing(rng, text):
    m = pick(rng, text, r"(</ParameterList>)")
    wrong = rng.choice(["</Parameter>", "</parameterlist>", "</List>"])
    return *put(text, m, wrong), [wrong, "Write </ParameterList>"]


def quote(rng, text):
    m = pick(rng, text, r'<Parameter name="[^"]+" type="[^"]+" value="[^"<>]*(")/>')
    return *put(text, m, ""), ["does not close", "behind the value"]


def no_quotes(rng, text):
    m = pick(rng, text, r' type=("[^"]+")')
    kind, wrong = m[1][1:-1], rng.choice(["{}", "\u201c{}\u201d", "\u00ab{}\u00bb"])
    return *put(text, m, wrong.format(kind)), [f'Write type="{kind}"' if "(" not in kind or wrong != "{}" else "Write type="]


def less_than(rng, text):
    m = pick(rng, text, r'value="[^"]*(&lt;)')
    return *put(text, m, "<"), ["&lt;"]


def ampersand(rng, text):
    m = pick(rng, text, EXPRESSION)
    return *put(text, m, "x > 1 && y > 1 ? 1 : 0"), ["&amp;"]


def type_name(rng, text):
    m = pick(rng, text, r' type="([^"]+)"')
    return *put(text, m, slip(rng, m[1])), ["unknown type", "Types are double, int"]


def no_type(rng, text):
    m = pick(rng, text, r'<Parameter name="[^"]*"( type="(?:double|string|int)")')
    return *put(text, m, rng.choice(["", m[1].replace("type", "typ")])), ["has no type=", 'rite type="']


def tag(rng, text):
    m = pick(rng, text, r"<(Parameter) ")
    wrong = rng.choice(["parameter", "Paramter", "Param"])
    return *put(text, m, wrong), [f"<{wrong}>", 'Did you mean "Parameter"?']


def list_of_another_program(rng, text):
    m = pick(rng, text, r'type="Array\((?:int|double)\)" value="\{([^}"]*)\}"')
    items = [item.strip() for item in m[1].split(",")]
    wrong = rng.choice(["[{}]", "({})", "{}"]).format(rng.choice([" ", "; ", ";"]).join(items))
    new = text[:m.start(1) - 1] + wrong + text[m.end(1) + 1:]
    return new, line_of(text, m.start(1)), [f'"{wrong}"', "Write {" + ", ".join(f"{float(item):g}" for item in items[:2])]


def scalar_for_list(rng, text):
    m = pick(rng, text, r'name="Cells" type="(Array\(int\)" value="\{[^"]*\})"')
    return *put(text, m, 'int" value="20'), ['"Mesh->Cells" must be an array of int, such as {160, 32}', "got 20", "{20, 20} in the plane, {20, 20, 20} in space"]


def whole_number(rng, text):
    m = pick(rng, text, r'name="(?:Cells|Max Dofs|Write Every)" type="[^"]*int[^"]*" value="\{?(\d+)')
    wrong = m[1] + rng.choice([".5", ",5"]) if "Cells" not in m[0] else m[1] + ".5"
    return *put(text, m, wrong), [wrong, "Write "]


def ratio(rng, text):
    m = pick(rng, text, r'name="Poisson\'s Ratio" type="double" value="([^"]+)"')
    wrong, right = rng.choice([("0.5", "write 0.4999"), ("30", "not a percentage"), ("-2", "must be in (-1, 0.5)")])
    return *put(text, m, wrong), [f"got {wrong}", right]


def modulus(rng, text):
    m = pick(rng, text, r'name="Young\'s Modulus" type="double" value="([^"]+)"')
    return *put(text, m, rng.choice(["0", "-1"])), ["must be > 0"]


def twice(rng, text):
    m = pick(rng, text, r"\n( +<Parameter [^\n]*/>)")
    return put(text, m, m[1] + "\n" + m[1])[0], line_of(text, m.start(1)) + 1, ["is given twice", "Remove"]


def stray_words(rng, text):
    m = pick(rng, text, r'<ParameterList name="[^"]+">(\n)')
    return put(text, m, "\n    nu = 0.3\n")[0], line_of(text, m.start(1)) + 1, ['"nu = 0.3" stands between tags']


def wrong_list(rng, text):
    m = pick(rng, text, r'<ParameterList name="Material">(\n)')
    name, kind, value, place = rng.choice([("Yield Stress", "double", "3", "Contact->Yield Stress"), ("Cells", "Array(int)", "{3, 3}", "Mesh->Cells"),
                                           ("Side", "string", "top", "Side"), ("Kinematics", "string", "plane stress", "Kinematics")])
    return put(text, m, f'\n    <Parameter name="{name}" type="{kind}" value="{value}"/>\n')[0], line_of(text, m.start(1)) + 1, [f'"Material->{name}"', "Valid here" if name == "Side" else f'"{place}"']


def switch(rng, text):
    m = pick(rng, text, r'(<ParameterList name="Contact">)')
    wrong = rng.choice(["on", "off", "oui", "T"])
    return *put(text, m, f'<ParameterList name="Output"><Parameter name="JSON" type="bool" value="{wrong}"/></ParameterList>' + m[1]), [f'"{wrong}"', "Write "]


ENTRY = r'(?s)<ParameterList name="{}">\s*(<ParameterList name="([a-z ]+)">\s*<Parameter name="[^"]+" type="[^"]+" value="[^"]+"/>)'


def fraction(rng, text):
    m = pick(rng, text, NUMBER)
    value, result = rng.choice([("-500/120", "-4.166666667"), ("2*(3 + 4)", "14"), ("1/3", "0.3333333333"), ("2^0.5", "1.414213562")])
    return *put(text, m, value, 2), [f'"{value}"', f"Write its value, {result}"]


def fraction_in_list(rng, text):
    m = pick(rng, text, r'name="(?:Lower|Upper)" type="Array\(double\)" value="\{([\d.-]+)')
    return *put(text, m, "500/100"), ["{500/100", "Write {5, "]


def value_of_entry(rng, text, kind, value):
    m = pick(rng, text, ENTRY.format(kind))
    parameter = re.search(r'name="([XYZ])" type="(\w+)" value="([^"]+)"', m[1])
    if not parameter:
        raise Unfit
    start = m.start(1)
    new = text[:start + parameter.start(3)] + value + text[start + parameter.end(3):]
    return new, line_of(text, start + parameter.start(3)), parameter[1]


def force_for_pressure(rng, text):
    value = rng.choice(["-500 N", "-5 kN", "20N"])
    new, line, component = value_of_entry(rng, text, "Traction", value)
    return new, line, [f'"{value}"', "is a unit of force, where a pressure is wanted [Pa]", f'write "Force {component}" instead of "{component}"']


def stress_for_length(rng, text):
    value, remedy = rng.choice([("0MPa", "Write 0."), ("0 N", "Write 0."), ("-500 N", 'belong into "Traction"'), ("5 MPa", 'belong into "Traction"')])
    new, line, _ = value_of_entry(rng, text, "Dirichlet", value)
    return new, line, [f'"{value}"', ", where a length is wanted [m]", remedy]


def load_name(rng, text):
    kind, right = rng.choice([("Traction", 'Did you mean "Force {0}", the force on the whole side, or "{0}"'), ("Dirichlet", 'A load belongs into "Traction"')])
    m = pick(rng, text, ENTRY.format(kind))
    component = re.search(r'name="([XYZ])"', m[1])
    if not component:
        raise Unfit
    at, wrong = m.start(1) + component.start(1), rng.choice(["F", "F_", "CF"]) + component[1].lower()
    return text[:at] + wrong + text[at + 1:], line_of(text, at), [f'{wrong}"', right.format(component[1])]


def load_without_component(rng, text):
    m = pick(rng, text, ENTRY.format("Traction"))
    component = re.search(r'name="([XYZ])"', m[1])
    if not component:
        raise Unfit
    at = m.start(1) + component.start(1)
    wrong, right = rng.choice([("Force", "Force X, Force Y, Force Z"), ("Total Force", "Force X, Force Y, Force Z"), ("Pressure", "a pressure p on a side")])
    return text[:at] + wrong + text[at + 1:], line_of(text, at), [f'{wrong}"', right]


def long_minus(rng, text):
    m = pick(rng, text, r'type="(?:double|string)" value="(-)[\d.]')
    mark = rng.choice(["\u2212", "\u2013"])
    return *put(text, m, mark), [mark, "rite"]


def entry_without_side(rng, text):
    kind = rng.choice(["Traction", "Dirichlet"])
    m = pick(rng, text, ENTRY.format(kind))
    at = m.start(1) + len('<ParameterList name="')
    wrong = rng.choice(["Load 1", "load", "support", "BC-3"])
    return text[:at] + wrong + text[at + len(m[2]):], line_of(text, at), [f'"{kind}->{wrong}" names the side "{wrong}"', "Name the entry after a side", "Its sides: "]


def flat_entry(rng, text):
    kind = rng.choice(["Traction", "Dirichlet"])
    m = pick(rng, text, f'(<ParameterList name="{kind}">)')
    new, line = put(text, m, m[1] + '<Parameter name="Y" type="double" value="-5"/>')
    return new, line, [f'"{kind}->Y" must be a sublist', "named after a side", '<ParameterList name="top">']


def list_in_a_list(rng, text):
    m = pick(rng, text, r'(?s)\n  </ParameterList>(\s*(?:<!--(?:(?!-->).)*-->\s*)*<ParameterList name="(?:Material|Contact|Traction|Dirichlet)">)')
    outer = re.findall(r'(?m)^  <ParameterList name="([^"]+)">', text[:m.start()])[-1]
    inner = re.search(r'name="([^"]+)">$', m[1])[1]
    end = text.rindex("</ParameterList>")
    return text[:m.start()] + m[1] + text[m.end():end] + "  </ParameterList>\n" + text[end:], None, [f'"{outer}', f'"{inner}" is a list of the outermost level: close "{outer}" before it']


def comment(rng, text):
    m = pick(rng, text, r'\n( *)<ParameterList name="(?:Material|Contact)">')
    wrong = rng.choice(["<!- steel ->", "<!- steel -->", "<! steel >", "<! -- steel -->"])
    return put(text, m, wrong + "\n" + m[1])[0], line_of(text, m.start(1)), ["is no comment and no tag", "Write a comment as <!-- ... -->"]


def open_comment(rng, text):
    m = pick(rng, text, r'\n( *)<ParameterList name="(?:Mesh|Material)">')
    wrong = rng.choice(["<!-- steel ->", "<!-- steel", "<!-- steel -- >"])
    new = text[:m.start(1)] + wrong + "\n" + text[m.start(1):].replace('<ParameterList name="Contact">', '<!-- below --><ParameterList name="Contact">')
    return new, line_of(text, m.start(1)), ["the comment that begins here does not end", "Write -->"]


def no_mesh(rng, text):
    m = pick(rng, text, r'(?s)\n(  <ParameterList name="Mesh">.*?  </ParameterList>\n)')
    return put(text, m, "")[0], None, ['"Mesh" is missing', "Lower, Upper and Cells", "Type = gmsh and File"]


def mesh_type(rng, text):
    m = pick(rng, text, r'<ParameterList name="Mesh">(\n)')
    wrong, right = rng.choice([("step", "gmsh"), ("STL", "gmsh"), ("STEP", "gmsh"), ("inp", "gmsh"), ("rectangle", "box"), ("cube", "box")])
    if 'name="Type" type="string" value="box"' in text:
        m = pick(rng, text, r'name="Type" type="string" value="(box)"')
        return *put(text, m, wrong), [f'"{wrong}"', f"write {right}."]
    return put(text, m, f'\n    <Parameter name="Type" type="string" value="{wrong}"/>\n')[0], line_of(text, m.start(1)) + 1, [f'"{wrong}"', f"write {right}."]


def percentage(rng, text):
    m = pick(rng, text, r'name="Target Relative Error" type="double" value="([^"]+)"')
    wrong, right = rng.choice([("8", "0.08"), ("5.5", "0.055"), ("1", "0.01")])
    return *put(text, m, wrong), [f"got {wrong}", "must be in (0, 1)", f"Write {right} for {wrong} %"]


def with_obstacle(rng, text, *parameters):
    m = pick(rng, text, r'(<Parameter name="Side" type="string" value="bottom"/>)\s*(?:<!--[^>]*-->\s*)*<Parameter name="(?:Yield|Gap|Stiff)')
    if "Obstacle" in text or 'name="Gap"' in text:
        raise Unfit
    return put(text, m, m[1] + '<ParameterList name="Obstacle">' + "".join(f'<Parameter name="{name}" type="{kind}" value="{value}"/>' for name, kind, value in parameters) +
               "</ParameterList>")


def place_of_obstacle(rng, text):
    zeros = "{0, -1, 0}" if re.search(r'name="Cells"[^{]*\{\d+, *\d+, *\d+', text) else "{0, -1}"
    kind, wrong, right = rng.choice([("sphere", "Point", "Centre"), ("plane", "Centre", "Point")])
    return *with_obstacle(rng, text, ("Type", "string", kind), (wrong, "Array(double)", zeros), ("Radius" if kind == "sphere" else "Normal", *(
        ("double", "1") if kind == "sphere" else ("Array(double)", zeros.replace("-1", "1"))))), [f'"Contact->Obstacle->{wrong}" does not go with', f'Write "{right}" for "{wrong}"']


def axis_by_name(rng, text):
    wrong, right = rng.choice([("z", "{0, 0, 1}"), ("y", "{0, 1} in the plane"), ("-y", "{0, -1, 0}"), ("X", "{1, 0, 0}")])
    return *with_obstacle(rng, text, ("Type", "string", "plane"), ("Point", "Array(double)", "{0, 0}"), ("Normal", "string", wrong)), ['"Contact->Obstacle->Normal"', f"got {wrong} ", right]


def two_sides(rng, text):
    m = pick(rng, text, r'name="Side" type="string" value="(bottom|left|right|top)"')
    other = rng.choice([name for name in ("bottom", "left", "right", "top") if name != m[1]])
    wrong = rng.choice(["{}, {}", "{};{}", "{} and {}", "{} {}", "{}, nose and {}"]).format(m[1], other)
    if wrong in ("left bottom", "right bottom", "left top", "right top", "bottom left", "bottom right", "top left", "top right"):
        raise Unfit
    return *put(text, m, wrong), [f'"{wrong}"', f'One entry has one side: write an entry each for "{m[1]}"', f'"{other}"']


def density(rng, text):
    m = pick(rng, text, r'<ParameterList name="Material">(\n)')
    wrong = rng.choice(["Density", "rho", "Mass Density", "Gravity", "g"])
    return put(text, m, f'\n    <Parameter name="{wrong}" type="double" value="7850"/>\n')[0], line_of(text, m.start(1)) + 1, [
        f'"Material->{wrong}"', 'the weight is "Body Force", the density times gravity']


def path_as_name(rng, text):
    m = pick(rng, text, r'\n( *)<ParameterList name="Material">')
    wrong = rng.choice(["Contact.Yield Stress", "Contact.Yield", "Contact/Yield Stress", "Contact->Yield Stress", "contact.yield stress", "Contact::Yield"])
    return put(text, m, f'<Parameter name="{wrong}" type="double" value="3"/>\n' + m[1])[0], line_of(text, m.start(1)), [
        f'"{wrong}"', 'write "Yield Stress" into the list "Contact"']


def far_name(rng, text):
    wrong, right = rng.choice([("Name", "named by its file"), ("Title", "named by its file"), ("Damping", "linear elastic"), ("Threads", "OMP_NUM_THREADS"), ("Symmetry", "a side that does not move along its normal")])
    m = pick(rng, text, r'\n( *)<ParameterList name="Material">')
    return put(text, m, f'<Parameter name="{wrong}" type="string" value="1"/>\n' + m[1])[0], line_of(text, m.start(1)), [f'"{wrong}"', right, NOT + "Did you mean"]


SQUARE = """Point(1) = {0, 0, 0, 0.5};
Point(2) = {1, 0, 0, 0.5};
Point(3) = {1, 1, 0, 0.5};
Point(4) = {0, 1, 0, 0.5};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Curve("bottom") = {1};
Physical Curve("top") = {3};
Physical Surface("body") = {1};
"""
MESHED = """<ParameterList name="meshed">
  <ParameterList name="Mesh">
    <Parameter name="Type" type="string" value="gmsh"/>
    <Parameter name="File" type="string" value="%s"/>
  </ParameterList>
  <ParameterList name="Material">
    <Parameter name="Young's Modulus" type="double" value="2000"/>
    <Parameter name="Poisson's Ratio" type="double" value="0.3"/>
  </ParameterList>
  <ParameterList name="Dirichlet">
    <ParameterList name="top"><Parameter name="X" type="double" value="0"/><Parameter name="Y" type="double" value="-0.01"/></ParameterList>
  </ParameterList>
  <ParameterList name="Contact"><Parameter name="Side" type="string" value="bottom"/></ParameterList>
</ParameterList>
"""


def geometry(rng, _):
    old, new, parts = rng.choice([("4) = {0, 1, 0, 0.5};", "4) = {0, 1, 0, 0.5}", ["line 5: syntax error", 'Write ";" at the end of line 4']),
                                  ('Physical Curve("top")', 'Physcal Curve("top")', ["line 12: syntax error", 'Physcal Curve', "Look for a word, a bracket"]),
                                  ("Line(2) = {2, 3};", "Line(2) = {2, 3;", ["line 6: syntax error", "Look for a word, a bracket"]),
                                  ("Point(3) = {1, 1, 0, 0.5};", "Point(3) = {1, 1, 0, size};", ["line 3: Unknown variable 'size'", "Write size = ...; before it is used"])])
    return MESHED % "square.geo", None, ['mesh: "square.geo": gmsh: ', *parts], {"square.geo": SQUARE.replace(old, new)}, 3


def missing_file(rng, _):
    wrong = rng.choice(["squar.geo", "Square.geo", "sqaure.geo", "square.msh", "parts/square.geo"])
    right = "square.geo" if "/" not in wrong else 'There is no folder "parts"'
    return MESHED % wrong, 4, [f'there is no file "{wrong}"', right], {"square.geo": SQUARE}


def other_program(rng, _):
    text, right = rng.choice([("*HEADING\n*NODE\n1, 0, 0\n", "Abaqus"), ("beam:\n  Mesh:\n    Cells: [2, 2]\n", "name the file .yaml"),
                              ('{"Mesh": {"Cells": [2, 2]}}', "JSON"), ("/PREP7\nET,1,182\n", "ANSYS"), ("subsection Mesh\nend\n", "deal.II"),
                              ("[Mesh]\n  type = GeneratedMesh\n[]\n", "MOOSE"), ("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", "Mesh->File")])
    return text, 1, [right]


XML_KINDS = [decimal_comma, unit, unit_in_expression, other_number, comma_in_expression, name_in_expression, bracket_in_expression, parameter_name,
             component_name, list_name, other_name, side_name, entry_name, word, unclosed_parameter, unclosed_list, wrong_closing, quote, no_quotes, less_than,
             ampersand, type_name, no_type, tag, list_of_another_program, scalar_for_list, whole_number, ratio, modulus, twice, stray_words, wrong_list,
             switch, other_program, fraction, fraction_in_list, force_for_pressure, stress_for_length, load_name, load_without_component, long_minus,
             entry_without_side, flat_entry, list_in_a_list, comment, open_comment, no_mesh, mesh_type, percentage, place_of_obstacle, axis_by_name, two_sides,
             density, path_as_name, far_name, geometry, missing_file]


def yaml_lines(element, indent=""):
    for child in element:
        name, kind, value = (child.get(key) for key in ("name", "type", "value"))
        if child.tag == "ParameterList":
            yield f"{indent}{name}:"
            yield from yaml_lines(child, indent + "  ")
        elif kind.startswith("Array"):
            yield f"{indent}{name}: [{value.strip()[1:-1]}]"
        else:
            yield f"{indent}{name}: " + (f'"{value}"' if kind == "string" and re.search(r"[^A-Za-z0-9 ]", value) else value)


def tabs(rng, text):
    m = pick(rng, text, r"\n( +)\S")
    return *put(text, m, "\t"), ["a tab stands before", "blanks"]


def indentation(rng, text):
    m = pick(rng, text, r"\n +[^\n]*: [^\n]*\n( +)[^\n]*: ")
    if len(m[0].split("\n")[1]) - len(m[0].split("\n")[1].lstrip()) != len(m[1]):
        raise Unfit
    return *put(text, m, m[1] + " "[:1] if rng.random() < 0.5 else m[1][1:]), ["is indented by", "same indentation"]


def colon(rng, text):
    m = pick(rng, text, r"\n +[A-Z][A-Za-z' ]*(: )[^\n]+")
    return *put(text, m, rng.choice([" ", ":", " = "])), ["lacks a colon with a blank behind it. Write "]


def open_bracket(rng, text):
    m = pick(rng, text, r"\[[^\]]*(\])")
    return *put(text, m, rng.choice(["", "}"])), ['"["', "rite ]"]


def yaml_comma(rng, text):
    m = pick(rng, text, r"(?:Modulus|Ratio): ([\d.e]+)")
    return *put(text, m, "0,3"), ["0,3", "Write 0.3"]


def yaml_unit(rng, text):
    m = pick(rng, text, r"Modulus: ([\d.e]+)")
    return *put(text, m, "210 GPa"), ["210 GPa", "2.1e+11 with m and N"]


def yaml_name(rng, text):
    m = pick(rng, text, r"\n +([A-Z][A-Za-z' ]{4,}): ")
    wrong = slip(rng, m[1])
    return *put(text, m, wrong), [f'{wrong}"', f'"{m[1]}"']


def yaml_twice(rng, text):
    m = pick(rng, text, r"\n( +[A-Z][^\n]*: [^\n]+)")
    return put(text, m, m[1] + "\n" + m[1])[0], line_of(text, m.start(1)) + 1, ["is given twice, first in line"]


def xml_as_yaml(rng, text):
    return '<ParameterList name="a">\n' + text, 1, ["name the file .xml"]


YAML_KINDS = [tabs, indentation, colon, open_bracket, yaml_comma, yaml_unit, yaml_name, yaml_twice, xml_as_yaml]


class BadDeck:
    def __init__(self, seed, number):
        kinds = XML_KINDS + YAML_KINDS
        self.number, self.kind = number, kinds[number % len(kinds)]
        self.yaml = self.kind in YAML_KINDS
        rng = random.Random(f"{seed}/{number}")
        for _ in range(200):
            base = rng.choice(BASES)
            text = base.read_text()
            if self.yaml:
                text = "\n".join(["deck:", *yaml_lines(xml.etree.ElementTree.fromstring(text), "  ")]) + "\n"
            try:
                made = self.kind(rng, text)
                self.text, self.line, self.parts = made[:3]
                self.files, self.code = made[3] if len(made) > 3 else {}, made[4] if len(made) > 4 else 2
                break
            except Unfit:
                continue
        else:
            raise SystemExit(f"no base suits {self.kind.__name__}")

    def complaints(self, program, folder):
        name = f"{self.number}." + ("yaml" if self.yaml else "xml")
        folder = folder / str(self.number) if self.files else folder
        folder.mkdir(exist_ok=True)
        for file, text in {name: self.text, **self.files}.items():
            (folder / file).write_text(text)
        result = subprocess.run([program, "--check", f"--input={name}"], cwd=folder, capture_output=True, text=True, timeout=120,
                                env={**os.environ, "OMPI_MCA_orte_tmpdir_base": str(folder), "PRTE_MCA_prte_tmpdir_base": str(folder)})
        self.message = result.stderr.strip() or result.stdout.strip()[-300:]
        if "built without gmsh" in self.message:
            return []
        place = f'deck: "{name}"' if self.code == 2 else "mesh: "
        wanted = [(result.returncode == self.code, f"exit code {result.returncode}"), (self.message.startswith("rpc: error: " + place), "no refusal of the deck"),
                  ("\n" not in self.message, "several lines"),
                  (self.line is None or f"line {self.line}:" in self.message, f"not line {self.line}"),
                  (RULE.search(self.message), "no rule"), (REMEDY.search(self.message), "no remedy")]
        return [fault for good, fault in wanted if not good] + [
            fault for part in self.parts if (fault := self.fault_of(part))]

    def fault_of(self, part):
        """What is wrong with a message as to a part, of which one is wanted where there are several."""
        if isinstance(part, str) and part.startswith(NOT):
            return f"has {part[len(NOT):]}" if part[len(NOT):] in self.message else None
        parts = (part,) if isinstance(part, str) else part
        return None if any(each in self.message for each in parts) else "lacks " + " or ".join(parts)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rpc", required=True)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--only", type=int)
    parser.add_argument("--print", action="store_true")
    options = parser.parse_args()
    numbers = range(options.count) if options.only is None else [options.only]
    decks = [BadDeck(options.seed, number) for number in numbers]
    faults = collections.Counter()
    with tempfile.TemporaryDirectory(prefix="rpc_bad_decks_") as folder, concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        program = os.path.abspath(options.rpc)
        for deck, complaints in zip(decks, pool.map(lambda deck: deck.complaints(program, pathlib.Path(folder)), decks)):
            if options.print:
                print(f"{deck.number} {deck.kind.__name__}: {deck.message}")
            if complaints:
                faults[deck.kind.__name__] += 1
                print(f"{deck.number} {deck.kind.__name__}: {'; '.join(complaints)}: {deck.message}")
    kinds = len({deck.kind for deck in decks})
    print(f"{len(decks)} bad decks of {kinds} kinds, {sum(faults.values())} of them without place, value, rule or remedy" +
          "".join(f"; {kind}: {count}" for kind, count in faults.items()))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
