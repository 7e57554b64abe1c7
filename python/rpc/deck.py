# SPDX-License-Identifier: BSD-3-Clause
"""Decks as dicts: sublists are dicts, parameters are int, float, bool, str and lists of these."""
import copy
import numbers
import os
import pathlib
import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping

import numpy as np

from .errors import Error

DEEPEST = 100  # lists within lists, as the program has it
BOOLS = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}


def read_deck(path):
    """A deck's file as a dict, without the name of its root list.

    XML, or YAML if the name ends in .yaml or .yml, which takes PyYAML. A file that is not there is looked for as the program does: in the folder
    $RPC_INPUT_DIR, then among the decks that come with the program. The "File" of a mesh or an obstacle that lies beside the deck becomes an
    absolute path, for the dict has no place of its own. Types survive: int, double, bool, string and arrays of these; an array is a list.

    @throws Error if there is no such file, it does not read, or a parameter has another type
    """
    found = _find(path)
    try:
        text = found.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise Error(f'deck: cannot read "{found}": {getattr(error, "strerror", None) or "not a text in UTF-8"}') from None
    deck = _read_yaml(found, text) if found.suffix.lower() in (".yaml", ".yml") else _read_xml(found, text)
    for entry in lists_with_files(deck):
        if isinstance(entry["File"], str) and entry["File"] and (found.parent / entry["File"]).is_file():
            entry["File"] = str((found.parent / entry["File"]).resolve())
    return deck


def lists_with_files(deck):
    """The lists of a deck with a parameter "File": its mesh, and obstacles that are given by one."""
    if isinstance(deck, Mapping):
        if "File" in deck:
            yield deck
        for entry in deck.values():
            yield from lists_with_files(entry)


def write_deck(deck, path):
    """Writes a dict as a deck in XML. numpy's numbers and arrays, and tuples, will do too.

    @param path  its stem is the name of the results; must not end in .yaml or .yml, which the program would read as YAML
    @throws Error that names the parameter if a value is none that a deck can have; OSError if the file cannot be written
    """
    path = pathlib.Path(path)
    if path.suffix.lower() in (".yaml", ".yml"):
        raise Error(f'write_deck: "{path}" must be a name for XML, such as "{path.with_suffix(".xml").name}": decks are written in XML only')
    path.write_text(xml_of(deck, path.stem), encoding="utf-8")


def with_settings(deck, settings):
    """A copy of a deck with parameters set by their paths, as --set does.

    with_settings(deck, {"Contact->Yield Stress": 12, "Mesh->Cells": [80, 16], "Contact->Gap": "0.01*x^2"}). Lists that are missing are made. A value may
    be a dict, which replaces the whole list.

    @throws Error if a path leads through a parameter
    """
    if not isinstance(deck, Mapping):
        raise Error(f"deck: must be a dict, got {type(deck).__name__}; read_deck(path) makes one of a file")
    result = copy.deepcopy(dict(deck))
    for path, value in settings.items():
        names = [name.strip() for name in path.split("->")] if isinstance(path, str) else []
        if not all(names) or not names:
            raise Error(f'settings: a name must be a path such as "Contact->Yield Stress", got {path!r}')
        place = result
        for depth, name in enumerate(names[:-1], 1):
            place = place.setdefault(name, {})
            if not isinstance(place, dict):
                raise Error(f'settings: "{path}" leads through "{"->".join(names[:depth])}", which is a parameter and no list')
        place[names[-1]] = copy.deepcopy(value)
    return result


def xml_of(deck, name="deck"):
    """A deck as a text in XML."""
    if not isinstance(deck, Mapping):
        raise Error(f"deck: must be a dict, got {type(deck).__name__}")
    root = _element(deck, name, "")
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode") + "\n"


def text_of(value, path):
    """A value as --set takes it.  @param path  its name, for the message of an Error"""
    return _typed(value, path)[1]


def _find(path):
    path = pathlib.Path(path)
    places = [path]
    if not path.is_absolute():
        from .program import deck_folders
        places += [folder / path for folder in deck_folders()]
    for place in places:
        if place.is_file():
            return place
    raise Error(f'deck: there is no file "{path}"; searched: {", ".join(map(str, places))}')


def _element(deck, name, path):
    if path.count("->") >= DEEPEST:
        raise Error(f"deck: lists within lists must not be deeper than {DEEPEST}")
    element = ElementTree.Element("ParameterList", name=name)
    for key, value in deck.items():
        full = f"{path}->{key}" if path else key
        if not isinstance(key, str) or not key:
            raise Error(f'deck: names must be texts, got {key!r} in "{path or name}"')
        _printable(key, full)
        if isinstance(value, dict):
            element.append(_element(value, key, full))
        else:
            kind, text = _typed(value, full)
            ElementTree.SubElement(element, "Parameter", name=key, type=kind, value=text)
    return element


def _printable(text, path):
    if not text.isprintable():  # Teuchos reads no numbered characters, and XML has no others for these
        raise Error(f'deck: "{path}" must be of one line without control characters, got {text!r}')
    return text


def _typed(value, path):
    """Type and text of a value in Teuchos' XML."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        items = [_typed(item, path) for item in value]
        kinds = {kind for kind, _ in items}
        if kinds != {"string"} and not kinds <= {"int", "double"}:
            raise Error(f'deck: "{path}" must have items of one kind, all numbers or all texts, got {value!r}')
        kind = "string" if "string" in kinds else "double" if "double" in kinds else "int"  # an empty array of int is one of double, too
        texts = [text for _, text in items]
        if kind == "string" and [item.strip() for item in _items(", ".join(texts))] != texts:
            raise Error(f'deck: "{path}": texts in a list must have commas within parentheses only, and no blanks around them, got {value!r}')
        return f"Array({kind})", "{" + ", ".join(texts) + "}"
    if isinstance(value, (bool, np.bool_)):
        return "bool", "true" if value else "false"
    if isinstance(value, numbers.Integral):
        if not -2**31 <= value < 2**31:
            raise Error(f'deck: "{path}" must be below 2^31 in size or a double, such as {float(value)!r}, got {value}')
        return "int", str(int(value))
    if isinstance(value, numbers.Real):
        return "double", repr(float(value))
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, str):
        return "string", _printable(value, path)
    raise Error(f'deck: "{path}" must be a number, a text, a bool, or a list of numbers or texts, got {value!r} ({type(value).__name__})')


def _read_xml(path, text):
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise Error(f'deck: "{path}", line {error.position[0]}: {str(error).split(":")[0]}') from None
    if root.tag != "ParameterList":
        raise Error(f'deck: "{path}": the outermost element must be ParameterList, got {root.tag}')
    return _list_of(root, path, "")


def _list_of(element, file, path):
    if path.count("->") >= DEEPEST:
        raise Error(f'deck: "{file}": lists within lists must not be deeper than {DEEPEST}')
    result = {}
    for child in element:
        name = child.get("name")
        full = f"{path}->{name}" if path else name
        if child.tag not in ("ParameterList", "Parameter") or name is None:
            raise Error(f'deck: "{file}": "{path or "the root list"}" must have elements ParameterList and Parameter with names, got {child.tag}')
        if name in result:
            raise Error(f'deck: "{file}": "{full}" is given twice')
        result[name] = _list_of(child, file, full) if child.tag == "ParameterList" else _value_of(child, file, full)
    return result


def _value_of(element, file, path):
    kind, text = element.get("type"), element.get("value")
    if kind is None or text is None:
        raise Error(f'deck: "{file}": "{path}" needs a type and a value')
    array = re.fullmatch(r"Array\((int|double|string)\)", kind)
    if not array and kind not in ("int", "double", "bool", "string"):
        raise Error(f'deck: "{file}": "{path}" has the type {kind}; a dict has int, double, bool, string and arrays of int, double and string; '
                    "run the file itself with run(path)")
    try:
        if not array:
            return _read_as(kind, text)
        inside = re.fullmatch(r"\s*\{(.*)\}\s*", text)
        if inside:
            return [_read_as(array[1], item.strip()) for item in _items(inside[1])]
    except ValueError:
        pass
    raise Error(f'deck: "{file}": "{path}" = "{text}" does not read as {kind}')


def _read_as(kind, text):
    if kind == "string":
        return text
    if kind == "bool" and text.strip().lower() not in BOOLS or "_" in text:
        raise ValueError
    return BOOLS[text.strip().lower()] if kind == "bool" else int(text) if kind == "int" else float(text)


def _items(text):
    """The texts between commas that stand in no parentheses: "0, min(t, 1)" are two."""
    items, depth, begin = [], 0, 0
    for place, letter in enumerate(text):
        depth += (letter == "(") - (letter == ")")
        if letter == "," and depth == 0:
            items.append(text[begin:place])
            begin = place + 1
    return items + [text[begin:]] if text.strip() else []


def _read_yaml(path, text):
    try:
        import yaml
    except ImportError:
        raise Error(f'deck: "{path}": to read YAML as a dict takes PyYAML (on Debian: apt-get install python3-yaml); '
                    "or write it in XML, or run the file itself with run(path)") from None

    class Loader(yaml.SafeLoader):
        """Takes for numbers and bools what Teuchos does: 1e-8 is a number, on is a text."""
        yaml_implicit_resolvers = {}

        def construct_mapping(self, node, deep=False):
            names = set()
            for key, _ in node.value:
                if key.value in names:
                    raise yaml.constructor.ConstructorError(None, None, f'"{key.value}" is given twice', key.start_mark)
                names.add(key.value)
            return super().construct_mapping(node, deep)

    number = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
    Loader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile(r"^(?:true|True|TRUE|yes|Yes|YES|false|False|FALSE|no|No|NO)$"), list("tTyYfFnN"))
    Loader.add_implicit_resolver("tag:rpc,int", re.compile(r"^[-+]?\d+$"), list("-+0123456789"))
    Loader.add_implicit_resolver("tag:rpc,double", re.compile(rf"^(?:{number}|[-+]?\.(?:inf|Inf|INF))$"), list("-+.0123456789"))
    Loader.add_constructor("tag:rpc,int", lambda loader, node: int(node.value))
    Loader.add_constructor("tag:rpc,double", lambda loader, node: float(re.sub(r"\.inf$", "inf", node.value, flags=re.IGNORECASE)))
    try:
        deck = yaml.load(text, Loader=Loader)
    except (yaml.YAMLError, ValueError) as error:
        mark = getattr(error, "problem_mark", None)
        line = f", line {mark.line + 1}" if mark else ""
        raise Error(f'deck: "{path}"{line}: {getattr(error, "problem", None) or error}') from None
    if isinstance(deck, dict) and len(deck) == 1 and isinstance(next(iter(deck.values())), dict):
        deck = next(iter(deck.values()))
    if not isinstance(deck, dict):
        raise Error(f'deck: "{path}" must have names and values, got {type(deck).__name__}')
    _element(deck, "deck", "")  # refuses what no deck has
    return deck
