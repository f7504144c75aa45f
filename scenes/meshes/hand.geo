// A soft hand, cut lengthwise: a palm with two fingers. Each finger is a row of bellows on its outer side and a
// stiff layer on its inner one, which keeps its length: air in the rooms of the bellows bends the fingers
// towards each other. Lengths here are in millimetres, in the mesh in metres.
//
//    __             __
//   |  ||         ||  |
//   |__||         ||__|
//    __||         ||__       bellows and their rooms, layers beside the ball
//   |  ||         ||  |
//   |__||_________||__|
//     |             |        palm
//     |_____________|        wrist
//
// gmsh -2 hand.geo

SetFactory("OpenCASCADE");
Mesh.ScalingFactor = 0.001;
Mesh.MshFileVersion = 4.1;
Mesh.MeshSizeMax = 2.6;

bellows = 4;
pitch = 8;                      // from bellow to bellow
width = 6.5;                    // of a bellow
wall = 1.5;                     // of its sides
palm = 10;                      // height of the palm
block = 3;                      // from the palm to the first bellow
half = 17;                      // from the middle to a finger
// the following from the inner side of a finger: the stiff layer, the floor of the rooms, the bottom of the
// gaps between bellows, the top of the rooms, that of the bellows
layer = 1;
floor = 3;
shoulder = 5;
room = 11.5;
top = 13;
length = block + (bellows - 1) * pitch + width;
e = 0.01;

Rectangle(1) = {-half - shoulder, 0, 0, 2 * (half + shoulder), palm};
solids[] = {1};
rooms[] = {};
layers[] = {};
For s In {0 : 1}
  side = 2 * s - 1;
  // a rectangle from a to b beside the middle begins at the lower of side * a and side * b
  t = news;
  Rectangle(t) = {side * (half + layer) - (1 - s) * (shoulder - layer), palm, 0, shoulder - layer, length};
  solids[] += {t};
  t = news;
  Rectangle(t) = {side * half - (1 - s) * layer, palm, 0, layer, length};
  layers[] += {t};
  For i In {0 : bellows - 1}
    y = palm + block + i * pitch;
    t = news;
    Rectangle(t) = {side * (half + floor) - (1 - s) * (top - floor), y, 0, top - floor, width};
    solids[] += {t};
    t = news;
    Rectangle(t) = {side * (half + floor) - (1 - s) * (room - floor), y + wall, 0, room - floor, width - 2 * wall};
    rooms[] += {t};
  EndFor
EndFor
whole[] = BooleanUnion{ Surface{solids[0]}; Delete; }{ Surface{solids[{1 : #solids[] - 1}]}; Delete; };
rubber[] = BooleanDifference{ Surface{whole[]}; Delete; }{ Surface{rooms[]}; Delete; };
BooleanFragments{ Surface{rubber[]}; Delete; }{ Surface{layers[]}; Delete; }

chamber[] = {};
For s In {0 : 1}
  side = 2 * s - 1;
  left = side * (half + floor) - (1 - s) * (room - floor);
  For i In {0 : bellows - 1}
    y = palm + block + i * pitch + wall;
    chamber[] += Curve In BoundingBox {left - e, y - e, -e, left + room - floor + e, y + width - 2 * wall + e, e};
  EndFor
EndFor
stiff[] = Surface In BoundingBox {-half - layer - e, palm - e, -e, -half + e, palm + length + e, e};
stiff[] += Surface In BoundingBox {half - e, palm - e, -e, half + layer + e, palm + length + e, e};
soft[] = Surface{:};
soft[] -= stiff[];

Physical Surface("rubber") = {soft[]};
Physical Surface("layers") = {stiff[]};
Physical Curve("chamber") = {chamber[]};
Physical Curve("wrist") = Curve In BoundingBox {-half - shoulder - e, -e, -e, half + shoulder + e, e, e};
