// A bending actuator, cut lengthwise: bellows on a flat finger. Air in their rooms (which a channel
// joins, beside this cut) pushes the walls of each bellow apart; the stiff layer at the bottom keeps
// its length, so that the finger curls downward. Lengths here are in millimetres, in the mesh in
// metres.
//
//        __    __    __
//       |  |  |  |  |  |         rooms in the bellows, gaps between them
//   ____|  |__|  |__|  |
//  |    |__|  |__|  |__|         floor of the rooms
//  |____________________|        strain limiting layer
//
// gmsh -2 bending-actuator.geo

Mesh.ElementOrder = 2;          // linear triangles lock in bending
Mesh.ScalingFactor = 0.001;
Mesh.MshFileVersion = 4.1;

bellows = 6;
pitch = 8;                      // from bellow to bellow
width = 6.5;                    // of a bellow
wall = 1.5;                     // of its sides
block = 5;                      // at the clamped end
top = 14;                       // of the bellows
room = 12.5;                    // top of the rooms
shoulder = 5;                   // bottom of the gaps
floor = 3;                      // of the rooms
layer = 1;                      // top of the stiff layer
end = block + (bellows - 1) * pitch + width;
size = 1.6;                     // of the triangles

// outside of the rubber, clockwise from the clamp
p = newp;
Point(p) = {0, layer, 0, size};
Point(p + 1) = {0, shoulder, 0, size};
outside[] = {p, p + 1};
For i In {0 : bellows - 1}
  x = block + i * pitch;
  p = newp;
  Point(p) = {x, shoulder, 0, size};
  Point(p + 1) = {x, top, 0, size};
  Point(p + 2) = {x + width, top, 0, size};
  outside[] += {p, p + 1, p + 2};
  If (i < bellows - 1)
    Point(p + 3) = {x + width, shoulder, 0, size};
    outside[] += {p + 3};
  EndIf
EndFor
p = newp;
Point(p) = {end, layer, 0, size};
outside[] += {p};
around[] = {};
For i In {0 : #outside[] - 1}
  l = newl;
  Line(l) = {outside[i], outside[(i + 1) % #outside[]]};
  around[] += {l};
EndFor

// the rooms
walls[] = {};
loops[] = {};
For i In {0 : bellows - 1}
  left = block + i * pitch + wall;
  right = left + width - 2 * wall;
  p = newp;
  Point(p) = {left, floor, 0, size};
  Point(p + 1) = {right, floor, 0, size};
  Point(p + 2) = {right, room, 0, size};
  Point(p + 3) = {left, room, 0, size};
  l = newl;
  Line(l) = {p, p + 1};
  Line(l + 1) = {p + 1, p + 2};
  Line(l + 2) = {p + 2, p + 3};
  Line(l + 3) = {p + 3, p};
  walls[] += {l, l + 1, l + 2, l + 3};
  c = newll;
  Curve Loop(c) = {l, l + 1, l + 2, l + 3};
  loops[] += {c};
EndFor

// the stiff layer
p = newp;
Point(p) = {0, 0, 0, size};
Point(p + 1) = {end, 0, 0, size};
tip = p + 1;
l = newl;
Line(l) = {p, p + 1};
Line(l + 1) = {p + 1, outside[#outside[] - 1]};
Line(l + 2) = {outside[0], p};
glue = around[#around[] - 1];   // from the tip back to the clamp

c = newll;
Curve Loop(c) = around[];
Curve Loop(c + 1) = {l, l + 1, glue, l + 2};
Plane Surface(1) = {c, loops[]};
Plane Surface(2) = {c + 1};

Physical Surface("rubber") = {1};
Physical Surface("strain limiting layer") = {2};
Physical Curve("chamber") = walls[];
Physical Curve("clamp") = {around[0], l + 2};
Physical Point("tip") = {tip};
