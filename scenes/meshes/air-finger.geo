// A finger with a chamber for air, which lies nearer to its outer side (-x): air makes that longer, so that the finger
// bends towards +x. A grid of bricks; the chamber is those left out. Lengths here are in millimetres, in the mesh in metres.
//
// gmsh -3 air-finger.geo

SetFactory("OpenCASCADE");
Mesh.ScalingFactor = 0.001;
Mesh.MshFileVersion = 4.1;
Mesh.ElementOrder = 2;
Mesh.SecondOrderIncomplete = 1; // hexahedra of 20 nodes

x[] = {0, 2, 7, 12};            // outer wall, chamber, inner wall
y[] = {-7, -4, 4, 7};           // side walls and the chamber between them
z[] = {-50, -46, -4, 0};        // tip, chamber, root
layers = 6;                     // of cells along the chamber

For i In {0 : 2}
  For j In {0 : 2}
    For k In {0 : 2}
      If (!(i == 1 && j == 1 && k == 1))
        Box(newv) = {x[i], y[j], z[k], x[i + 1] - x[i], y[j + 1] - y[j], z[k + 1] - z[k]};
      EndIf
    EndFor
  EndFor
EndFor
Coherence;

Transfinite Curve {:} = 2;
along[] = Curve In BoundingBox {-1, -8, -46.1, 13, 8, -3.9};
Transfinite Curve {along[]} = layers + 1;
across[] = Curve In BoundingBox {-1, -8, -46.1, 13, 8, -45.9};
Transfinite Curve {across[]} = 2;
across[] = Curve In BoundingBox {-1, -8, -4.1, 13, 8, -3.9};
Transfinite Curve {across[]} = 2;
Transfinite Surface {:};
Recombine Surface {:};
Transfinite Volume {:};

Physical Volume("finger") = Volume{:};
Physical Surface("root") = Surface In BoundingBox {-1, -8, -0.1, 13, 8, 0.1};
Physical Surface("pad") = Surface In BoundingBox {11.9, -8, -51, 12.1, 8, 1};
Physical Surface("chamber") = Surface In BoundingBox {1.9, -4.1, -46.1, 7.1, 4.1, -3.9};
