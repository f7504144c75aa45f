"""Writes bowl.stl (binary, in millimetres): a profile turned about z, in 12 steps."""

import math
import struct

# radius and height, from the middle of the foot around the rim to the middle of the inside
PROFILE = [(0, 0), (12, 0), (22, 6), (28, 16), (30, 26), (27, 26), (25, 17), (19, 9), (10, 4), (0, 3)]
STEPS = 12


def point(place, step):
    radius, height = PROFILE[place]
    angle = 2 * math.pi * (step % STEPS) / STEPS
    return radius * math.cos(angle), radius * math.sin(angle), height


triangles = []
for step in range(STEPS):
    for place in range(len(PROFILE) - 1):
        a, b = point(place, step), point(place, step + 1)
        c, d = point(place + 1, step + 1), point(place + 1, step)
        triangles += [t for t in ((a, b, c), (a, c, d)) if len(set(t)) == 3]
with open("bowl.stl", "wb") as file:
    file.write(b"bowl, mm".ljust(80) + struct.pack("<I", len(triangles)))
    for triangle in triangles:
        numbers = [x for corner in triangle for x in corner]
        file.write(struct.pack("<12fH", 0, 0, 0, *numbers, 0))
