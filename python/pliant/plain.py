"""Values of Python as those of JSON, which scenes are read from."""

import json
import math

from .mesh import Mesh


def plain(value):
    """`value` without arrays, meshes and other classes: numbers, texts, lists and dicts."""
    if isinstance(value, Mesh):
        return plain(value.to_dict())
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items() if item is not None}
    if hasattr(value, "tolist"):  # arrays and numbers of NumPy
        return plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, (bool, int, str)):
        return value
    if isinstance(value, float):
        if not math.isfinite(value):
            raise ValueError(f"{value} is no number of a scene")
        return value
    raise TypeError(f"a scene holds numbers, texts, lists, dicts, arrays and meshes, not {type(value).__name__}")


def as_json(value):
    """`value` as text in JSON."""
    return json.dumps(plain(value), ensure_ascii=False)
