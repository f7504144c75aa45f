"""Error against time as an SVG drawing, both axes logarithmic."""

import math

COLOURS = ["#1b6ca8", "#6aa9d8", "#c0392b", "#e67e22", "#f1b27a", "#8e44ad", "#c39bd3", "#27ae60", "#7f8c8d"]
WIDTH, HEIGHT, LEFT, TOP, PLOT = 760, 420, 60, 20, (440, 340)


def write(path, lines):
    """`lines` by name, each a list of (seconds, error in mm)."""
    points = [point for line in lines.values() for point in line]
    ranges = [(math.floor(3 * math.log10(min(p[k] for p in points))) / 3, math.ceil(3 * math.log10(max(p[k] for p in points))) / 3) for k in (0, 1)]

    def place(value, k):
        part = (math.log10(value) - ranges[k][0]) / (ranges[k][1] - ranges[k][0])
        return LEFT + part * PLOT[0] if k == 0 else TOP + (1 - part) * PLOT[1]

    text = lambda x, y, of, anchor="middle": f'<text x="{x:.0f}" y="{y:.0f}" text-anchor="{anchor}">{of}</text>'
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" font-size="12">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
        f'<rect x="{LEFT}" y="{TOP}" width="{PLOT[0]}" height="{PLOT[1]}" fill="none" stroke="#444"/>',
        text(LEFT + PLOT[0] / 2, HEIGHT - 15, "processor time (s)"),
        f'<g transform="translate(16 {TOP + PLOT[1] / 2}) rotate(-90)">{text(0, 0, "error (mm)")}</g>',
    ]
    for k in (0, 1):
        for decade in range(-4, 4):
            for step in (1, 2, 5):
                value = step * 10.0**decade
                if not ranges[k][0] <= math.log10(value) <= ranges[k][1]:
                    continue
                at = place(value, k)
                ends = (at, TOP, at, TOP + PLOT[1]) if k == 0 else (LEFT, at, LEFT + PLOT[0], at)
                out.append('<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="#ddd"/>'.format(*ends))
                out.append(text(at, TOP + PLOT[1] + 16, f"{value:g}") if k == 0 else text(LEFT - 6, at + 4, f"{value:g}", "end"))
    for number, (name, line) in enumerate(lines.items()):
        colour = COLOURS[number % len(COLOURS)]
        at = [(place(seconds, 0), place(error, 1)) for seconds, error in sorted(line)]
        out.append(f'<polyline points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in at)}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" fill="{colour}"/>' for x, y in at]
        out.append(f'<circle cx="{LEFT + PLOT[0] + 20}" cy="{TOP + 12 + 20 * number}" r="4" fill="{colour}"/>')
        out.append(text(LEFT + PLOT[0] + 32, TOP + 16 + 20 * number, name.replace("`", ""), "start"))
    with open(path, "w") as file:
        file.write("\n".join(out) + "\n</svg>\n")
