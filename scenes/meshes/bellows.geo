// Bellows, cut lengthwise: rooms with zig-zag walls one above the other, with webs between them, which keep the walls
// from being sucked in sideways. Lengths here are in millimetres, in the mesh in metres.
//
// gmsh -2 bellows.geo

Mesh.ScalingFactor = 0.001;
Mesh.MshFileVersion = 4.1;

rooms = 4;
height = 8;                     // of a room
web = 1.2;                      // height of a web
plate = 4;                      // that of bottom and lid
narrow = 6;                     // from the middle to the walls where they are near to each other,
wide = 15;                      // and where they are far apart
wall = 2;                       // thickness of the walls along x
size = 1.8;                     // of the triangles

right[] = {};
left[] = {};
walls[] = {};
loops[] = {};
For i In {0 : rooms - 1}
  y = plate + i * (height + web);
  p = newp;
  Point(p) = {-narrow, y, 0, size};
  Point(p + 1) = {narrow, y, 0, size};
  Point(p + 2) = {wide, y + height / 2, 0, size};
  Point(p + 3) = {narrow, y + height, 0, size};
  Point(p + 4) = {-narrow, y + height, 0, size};
  Point(p + 5) = {-wide, y + height / 2, 0, size};
  l = newl;
  For k In {0 : 5}
    Line(l + k) = {p + k, p + (k + 1) % 6};
    walls[] += {l + k};
  EndFor
  c = newll;
  Curve Loop(c) = {l : l + 5};
  loops[] += {c};
  For k In {0 : 2}
    x = k == 1 ? wide + wall : narrow + wall;
    p = newp;
    Point(p) = {x, y + k * height / 2, 0, size};
    Point(p + 1) = {-x, y + k * height / 2, 0, size};
    right[] += {p};
    left[] += {p + 1};
  EndFor
EndFor
end = plate + rooms * (height + web) - web + plate;
p = newp;
Point(p) = {-narrow - wall, 0, 0, size};
Point(p + 1) = {narrow + wall, 0, 0, size};
Point(p + 2) = {narrow + wall, end, 0, size};
Point(p + 3) = {-narrow - wall, end, 0, size};
outside[] = {p, p + 1, right[], p + 2, p + 3};
For k In {1 : #left[]}
  outside[] += {left[#left[] - k]};
EndFor
around[] = {};
For i In {0 : #outside[] - 1}
  l = newl;
  Line(l) = {outside[i], outside[(i + 1) % #outside[]]};
  around[] += {l};
EndFor
c = newll;
Curve Loop(c) = around[];
Plane Surface(1) = {c, loops[]};

Physical Surface("rubber") = {1};
Physical Curve("chamber") = walls[];
Physical Curve("bottom") = {around[0]};
Physical Curve("lid") = {around[2 + #right[]]};
