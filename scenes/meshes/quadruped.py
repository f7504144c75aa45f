"""Writes quadruped.msh (bricks, in metres): a plate on four legs with two chambers each, one behind the other. Lengths here are in millimetres."""

# of a leg, from its rear: walls and two chambers, from its right side: wall, chamber, wall; heights of layers, above the foot
LEG_X, LEG_Y = [0, 1.5, 5, 6.5, 10, 11.5], [0, 1.5, 8.5, 10]
LEG_Z = [0, 3, 15, 27]
# where legs begin, and the thickness of the plate
REAR, FRONT, RIGHT, LEFT, PLATE = -25, 13.5, -20, 10, 3

xs = [*(REAR + x for x in LEG_X), *(FRONT + x for x in LEG_X)]
ys = [*(RIGHT + y for y in LEG_Y), *(LEFT + y for y in LEG_Y)]
zs = [*LEG_Z, LEG_Z[-1] + PLATE]
corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
faces = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
nodes, groups = {}, {}


def node(place):
    return nodes.setdefault(tuple(place), len(nodes) + 1)


def brick(i, j, k):
    return [node((xs[i + a], ys[j + b], zs[k + c])) for a, b, c in corners]


# cells of the plate, then of each leg, and the faces of their chambers and feet
plate = len(zs) - 2
groups[3, "plate"] = [brick(i, j, plate) for i in range(len(xs) - 1) for j in range(len(ys) - 1)]
groups[3, "legs"] = []
for leg, x, y in [("left front", FRONT, LEFT), ("right front", FRONT, RIGHT), ("left hind", REAR, LEFT), ("right hind", REAR, RIGHT)]:
    i, j = xs.index(x), ys.index(y)
    hollows = {a: f"{leg}, {where}" for a, where in [(1, "rear"), (3, "fore")]}
    for name in hollows.values():
        groups[2, name] = []
    for k in range(plate):
        for a in range(5):
            for b in range(3):
                cell = brick(i + a, j + b, k)
                if k > 0 and b == 1 and a in hollows:
                    walls = faces[2:] + ([faces[0]] if k == 1 else []) + ([faces[1]] if k == plate - 1 else [])
                    groups[2, hollows[a]] += [[cell[n] for n in wall] for wall in walls]
                else:
                    groups[3, "legs"].append(cell)
    groups[2, f"{leg} foot"] = [[brick(i + a, j + b, 0)[n] for n in faces[0]] for a in range(5) for b in range(3)]

text = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", f"{len(groups)}"]
text += [f'{dim} {tag} "{name}"' for tag, (dim, name) in enumerate(groups, 1)]
text += ["$EndPhysicalNames", "$Entities"]
tagged = [(dim, tag, cells) for tag, ((dim, _), cells) in enumerate(groups.items(), 1)]
text.append(f"0 0 {sum(dim == 2 for dim, *_ in tagged)} {sum(dim == 3 for dim, *_ in tagged)}")
for wanted in (2, 3):
    text += [f"{tag} 0 0 0 0 0 0 1 {tag} 0" for dim, tag, _ in tagged if dim == wanted]
text += ["$EndEntities", "$Nodes", f"1 {len(nodes)} 1 {len(nodes)}", f"3 {tagged[0][1]} 0 {len(nodes)}"]
text += [str(number) for number in nodes.values()]
text += [" ".join(f"{x / 1000:g}" for x in place) for place in nodes]
count = sum(len(cells) for *_, cells in tagged)
text += ["$EndNodes", "$Elements", f"{len(tagged)} {count} 1 {count}"]
number = 0
for dim, tag, cells in tagged:
    text.append(f"{dim} {tag} {5 if dim == 3 else 3} {len(cells)}")
    for cell in cells:
        number += 1
        text.append(" ".join(map(str, [number, *cell])))
text += ["$EndElements", ""]
with open("quadruped.msh", "w") as file:
    file.write("\n".join(text))
