"""Makes pliant/words.py of the JSON Schema of scene files, as scripts/python.sh does before it tests or builds the module:
`python3 make_words.py < ../docs/scene.schema.json > pliant/words.py`."""

import json
import keyword
import re
import sys
import textwrap

HEAD = '''"""Builders for the tables of scenes: one function for each, with all keys, their meanings, units and defaults.

Made by make_words.py of the table of keys, as the reference page of scene files is: do not edit. Each function returns a
dict without the keys that are left out; a dict with the same keys does as well.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Sequence

if TYPE_CHECKING:
    from .mesh import Mesh

#: The name of a node set, the number of a node (from 1), several numbers, or ``{"box": [[x, y], [x, y]]}``.
Nodes = Any
#: One number per dimension of space.
Vector = Sequence[float]
#: A number, or a function of time as a text: ``"2000 * sin(2*pi*3*t)"``.
Formula = Any


def _table(**keys):
    return {key.rstrip("_"): value for key, value in keys.items() if value is not None}
'''

SHARED = {
    "a vector": "Vector",
    "a number or a formula": "Formula",
    "a vector or formulas": "Sequence[Formula]",
    "numbers along axes": "float | Vector",
    "corners": "Sequence[Vector]",
    "nodes": "Nodes",
    "axes": "str | Sequence[str]",
}


def annotation(schema):
    """The type of a value, as Python writes it."""
    if "allOf" in schema:
        schema = schema["allOf"][0]
    if "$ref" in schema:
        name = schema["$ref"].removeprefix("#/definitions/")
        if name == "mesh":
            return "dict | Mesh"
        return SHARED.get(name, "dict")
    if "enum" in schema:
        return f"Literal[{', '.join(json.dumps(word) for word in schema['enum'])}]"
    if "anyOf" in schema:
        kinds = dict.fromkeys(annotation(inner) for inner in schema["anyOf"])
        return " | ".join(kinds)
    match schema.get("type"):
        case "array":
            return f"Sequence[{annotation(schema['items'])}]"
        case "number":
            return "float"
        case "integer":
            return "int"
        case "boolean":
            return "bool"
        case "string":
            return "str"
        case "object":
            return "dict"
    raise SystemExit(f"no type for {schema}")


def parameter(key):
    return key + "_" if keyword.iskeyword(key) else key


def wrapped(text, indent):
    return textwrap.fill(text, 118, initial_indent=indent, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)


def function(name, about, table, kind=None):
    properties = {key: value for key, value in table["properties"].items() if key != "kind" and not value.get("description", "").startswith("Old name")}
    required = [key for key in table.get("required", []) if key != "kind"]
    keys = required + [key for key in properties if key not in required]
    lines = [f"\n\ndef {name}("]
    if keys:
        lines.append("    *,")
    for key in keys:
        default = "" if key in required else " | None = None"
        lines.append(f"    {parameter(key)}: {annotation(properties[key])}{default},")
    lines.append(") -> dict:")
    lines.append('    r"""' + wrapped(about[0].upper() + about[1:].rstrip(".") + ".", "    ").lstrip())
    if keys:
        lines += ["", "    Parameters", "    ----------"]
    for key in keys:
        lines.append(f"    {parameter(key)}")
        lines.append(wrapped(properties[key]["description"].replace("....", "..."), "        "))
    lines.append('    """')
    given = ([f'kind="{kind}"'] if kind else []) + [f"{parameter(key)}={parameter(key)}" for key in keys]
    lines.append("    return _table(")
    lines += [f"        {one}," for one in given]
    lines.append("    )")
    return "\n".join(lines)


def main():
    schema = json.load(sys.stdin)
    out, names = [HEAD.rstrip("\n")], []
    for title, table in schema["definitions"].items():
        if title in SHARED:
            continue
        name = re.sub(r"\W+", "_", title).strip("_")
        name = name.removeprefix("body_") if name == "body_region" else name
        for one in table.get("oneOf", [None]):
            if one is None:
                full, about, kind, table_of = name, table["description"], None, table
            else:
                kind, about = one["properties"]["kind"]["const"], one["properties"]["kind"]["description"]
                full, table_of = f"{name}_{kind.replace('-', '_')}", one
                about = f"{title.strip('[]')} of the kind \"{kind}\": {about}"
            full = parameter(full)
            out.append(function(full, about, table_of, kind))
            names.append(full)
    print("\n".join(out))
    listed = "\n".join(f'    "{name}",' for name in sorted(names))
    print(f"\n\n__all__ = [\n{listed}\n]")


main()
