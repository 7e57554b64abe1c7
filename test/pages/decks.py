# SPDX-License-Identifier: BSD-3-Clause
"""Decks in pages: whole ones, and lists of parameters that go into one."""

import re
import xml.etree.ElementTree as ET

BASES = {"hertz.geo": "hertz.xml"}  # where a part names a mesh, the deck that has it
BASE = "beam.xml"


class DeckFault(Exception):
    pass


def is_whole(text, language):
    """Whether it is a deck by itself: one root list that has a mesh or a material in it."""
    if language == "yaml":
        return bool(re.search(r"^\S[^\n]*:\s*(#.*)?$", text, re.MULTILINE)) and bool(re.search(r"^\s+(Mesh|Material):", text, re.MULTILINE))
    lists = parsed(text)
    return len(lists) == 1 and any(child.get("name") in ("Mesh", "Material") for child in lists[0])


def name_of(text, language):
    """Of a whole deck: that of its root list."""
    if language == "yaml":
        return re.search(r"^([^\s#][^:\n]*):", text, re.MULTILINE)[1]
    return parsed(text)[0].get("name")


def parsed(text):
    try:
        return list(ET.fromstring(f"<page>{text}</page>"))
    except ET.ParseError as error:
        raise DeckFault(f"it is not XML: {error}") from error


def completed(text, base):
    """A deck of XML with lists of parameters in place, or on top of, what it has."""
    root = ET.fromstring(base)
    merge(root, parsed(text))
    return ET.tostring(root, encoding="unicode")


def merge(into, entries):
    for entry in entries:
        same = next((child for child in into if child.get("name") == entry.get("name")), None)
        if same is not None and entry.tag == "ParameterList" == same.tag:
            merge(same, list(entry))
            continue
        if same is not None:
            into.remove(same)
        into.append(entry)


def base_of(text):
    return next((deck for mesh, deck in BASES.items() if mesh in text), BASE)
