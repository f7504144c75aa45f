"""The table of `cosserat.md` from the results of cosseratbench: `python table.py RESULTS`."""

import json
import sys
from pathlib import Path

#: Metrics that compare with a reference, or say what is looked at.
SHOWN = {
    "cantilever": ["tip_deflection_error"],
    "catenary": ["shape_error", "sag_error"],
    "crossing": ["shape_error", "lift_error"],
    "pendulum": ["period_error", "amplitude_change"],
    "twist": ["critical_twist_error"],
    "capstan": ["slide"],
    "pile": ["pile_height", "contacts", "settling_residual"],
}


def lines(results: Path):
    for experiment, metrics in SHOWN.items():
        for path in sorted(results.glob(f"{experiment}/*/*/result.json")):
            found = json.loads(path.read_text())
            variant = path.parent.parent.name
            name = found["solver"] if variant == "default" else f"{found['solver']}, {variant}"
            if found["outcome"] != "completed":
                told = found["failure"] or "no " + ", ".join(found["missing"])
                yield f"| `{experiment}` | {name} | {found['n_elements']} | | {told} |"
                continue
            values = (f"{metric} {found['metrics'][metric] or float('nan'):.1e}" for metric in metrics)
            yield f"| `{experiment}` | {name} | {found['n_elements']} | {found['wall_time']:.1f} | {', '.join(values)} |"


print("| experiment | solver | elements | time (s) | measured |\n| --- | --- | --- | --- | --- |")
print("\n".join(lines(Path(sys.argv[1]))))
